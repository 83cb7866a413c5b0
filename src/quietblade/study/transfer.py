# SPDX-License-Identifier: LGPL-2.1-or-later
"""What each load does, and the transfer functions that a case asks for."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from quietblade.case import AnyCase
from quietblade.case.excitation import ShaftWords
from quietblade.study.excitations import Excited
from quietblade.typing import ComplexArray, FloatArray
from quietblade.vibroacoustics.combined import Combined
from quietblade.vibroacoustics.transfer_functions import RootPath, power_per_force


@dataclass(frozen=True, eq=False)
class LoadPowers:
    """Powers by load, over frequency.

    Attributes
    ----------
    radiated : (f, k) array
        Of each load acting alone [W], or [W/Hz].
    injected : (f, k) array
        Of each load while all act; their sum is the injected power.
    work : (f, k) complex array
        b^T x of a unit of each load [J].
    unit_radiated : (f, k) array
        Radiated power of a unit of each load [W].
    """

    radiated: FloatArray
    injected: FloatArray
    work: ComplexArray
    unit_radiated: FloatArray

    @classmethod
    def of(cls, combined: Combined) -> Self:
        """Take the powers of a combination."""
        unit = combined.radiated_by_unit
        return cls(
            np.asarray(np.sum(np.abs(combined.parts) ** 2, axis=0) * unit),
            combined.injected_by_load,
            combined.work,
            unit,
        )


@dataclass(frozen=True, eq=False)
class Transfer:
    """Transfer functions; what the case does not ask for is nan.

    Attributes
    ----------
    functions : tuple of str
    about : (3,) array
        Centre of the root, to which moments refer [m].
    mobility : (f, k) complex array
        Drive-point mobility [m/(s N)].
    power_per_force : (f, k) array
        Radiated power per mean square force [W/N^2].
    blocked : (f, k, 6) complex array
        Force and moment on the support per unit amplitude of each load.
    on_root : (f, 6) array
        Size of force and moment on the support of all loads: peak amplitude, or root of the
        density of random loads.
    shaft_power : (f,) array
        Power into the shaft [W], or [W/Hz].
    """

    functions: tuple[str, ...]
    about: FloatArray
    mobility: ComplexArray
    power_per_force: FloatArray
    blocked: ComplexArray
    on_root: FloatArray
    shaft_power: FloatArray


def drive_point_mobility(excited: Excited, omega: FloatArray, work: ComplexArray) -> ComplexArray:
    """Velocity over force where each load acts, (f, k) [m/(s N)] (theory: S2-78).

    For a patch the mean normal velocity over the whole force; for a moved root its velocity over
    the force that moves it, along the same direction.

    Parameters
    ----------
    omega : (f,) array
        [rad/s]
    work : (f, k) array
        b^T x of a unit of each load [J].
    """
    columns = []
    for drive, own in zip(excited.drives, work.T, strict=True):
        if drive.motion < 0:
            columns.append(1j * omega * own / drive.size**2)
        else:  # b^T x is minus the force for a unit of displacement
            columns.append(-1j * omega / own)
    return np.stack(columns, axis=1)


def force_of_unit(excited: Excited, work: ComplexArray) -> ComplexArray:
    """Force of a unit of each right-hand side, (f, k) [N]."""
    columns = [
        np.full(len(own), drive.size, dtype=complex) if drive.motion < 0 else -own
        for drive, own in zip(excited.drives, work.T, strict=True)
    ]
    return np.stack(columns, axis=1)


def solve_transfer(
    case: AnyCase, excited: Excited, combined: Combined, held: ComplexArray
) -> Transfer | None:
    """Find the transfer functions that the case asks for.

    Parameters
    ----------
    case : AnyCase
    excited : Excited
    combined : Combined
        Of the loads.
    held : (f, k or k + 6, 12) array
        Unknowns of the root in the responses to the loads and the probes; (f, ..., 0) without.
    """
    if case.transfer is None:
        return None
    functions, omega = case.transfer.functions, combined.omega
    count, work = len(excited.drives), combined.work
    shape = len(omega), count
    mobility = np.full(shape, np.nan, dtype=complex)
    per_force, shaft_power = np.full(shape, np.nan), np.full(len(omega), np.nan)
    blocked, on_root = np.full((*shape, 6), np.nan, dtype=complex), np.full((len(omega), 6), np.nan)
    if "mobility" in functions:
        mobility = drive_point_mobility(excited, omega, work)
    if "power-per-force" in functions:
        force = np.abs(force_of_unit(excited, work))
        per_force = power_per_force(combined.radiated_by_unit, 1.0) / force**2
    about = np.full(3, np.nan)
    if case.transfer.of_root:
        assert excited.root is not None  # needs_root
        about = excited.root.about
        reaction = excited.root.held_reaction(held)
        of_unit, factor = -reaction[:, :count], excited.per_amplitude(omega / (2.0 * np.pi))
        blocked = of_unit * factor[..., None]
        parts = np.einsum("jfk,fki->jfi", combined.parts, of_unit)
        # sqrt 2 between the peaks of the parts and the root of a density
        on_root = np.linalg.norm(parts, axis=0) * (1.0 if excited.correlation is None else 0.5**0.5)
        if case.transfer.shaft is not None:
            pushed = np.array([drive.motion < 0 for drive in excited.drives])
            shaft_power = _shaft_power(
                case.transfer.shaft,
                omega,
                np.einsum("jfk,fki->fji", combined.parts[..., pushed], of_unit[:, pushed]),
                reaction[:, count:].transpose(0, 2, 1),
            )
    return Transfer(functions, about, mobility, per_force, blocked, on_root, shaft_power)


def impedance(words: ShaftWords, omega: FloatArray) -> ComplexArray:
    """Force and moment over velocity at the end of the shaft, (f, 6, 6) (theory: S2-79)."""

    def both(along: tuple[float, ...] | None, about: tuple[float, ...] | None) -> FloatArray:
        return np.array([*(along or (0.0,) * 3), *(about or (0.0,) * 3)])

    stiffness = both(words.translation, words.rotation)
    damping = both(words.translation_damping, words.rotation_damping)
    mass = both(words.mass, words.inertia)
    at = omega[:, None]
    diagonal = damping + 1j * (at * mass - stiffness / at)
    return np.asarray(diagonal[..., None] * np.eye(6))


def _shaft_power(
    words: ShaftWords, omega: FloatArray, blocked: ComplexArray, stiffness: ComplexArray
) -> FloatArray:
    """Power of all parts (f,) into a shaft, from blocked forces (f, j, 6)."""
    nothing = np.zeros((len(omega), 0, 0), dtype=complex)
    path = RootPath(omega, blocked, stiffness, nothing, nothing)
    return np.asarray(path.power(impedance(words, omega)).sum(axis=1))
