# SPDX-License-Identifier: LGPL-2.1-or-later
"""Transfer functions: mobility, sound per force, and the path through the root (theory: S2-78)."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from quietblade.typing import AnyArray, ComplexArray, FloatArray
from quietblade.vibroacoustics.root import RootedSystem

Solve = Callable[[AnyArray], ComplexArray]
"""Responses (f, k, n) to loads (k, n): of a direct sweep, or of a reduced model."""


def mobility(
    omega: FloatArray, response: ComplexArray, place: AnyArray, *, acceleration: bool = False
) -> ComplexArray:
    """Velocity at a place per unit load [m/(N s)], i omega b^T x (theory: S2-78).

    Parameters
    ----------
    omega : (f,) array
        [rad/s]
    response : (f, n) array
        To a load of unit force.
    place : (n,) array
        Load of a unit force at the place and in the direction where the velocity is wanted.  With
        the load of the response itself it is the drive-point mobility, whose real part cannot be
        negative; with two places it is the transfer mobility, the same in both directions.
    acceleration : bool
        Return the accelerance i omega times that [1/kg].
    """
    velocity = 1j * np.asarray(omega) * (response @ place)
    return np.asarray(1j * np.asarray(omega) * velocity if acceleration else velocity)


def power_per_force(power: FloatArray, force: float) -> FloatArray:
    """Radiated power per mean square of the force [W/N^2], of a peak amplitude ``force`` [N]."""
    return np.asarray(power / (0.5 * abs(force) ** 2))


@dataclass(frozen=True, eq=False)
class RootPath:
    """What the blade does to its support, and how it resists its motion.

    All about ``about``: three forces and moments, three translations and rotations.

    Attributes
    ----------
    omega : (f,) array
        [rad/s]
    blocked : (f, l, 6) array
        Force [N] and moment [N m] on a support at rest, of each load.
    stiffness : (f, 6, 6) array
        Dynamic stiffness: force on the root that moves it by a unit, with no other load; symmetric.
    response : (f, l, n) array
        To the loads, with the root at rest.
    carried : (f, 6, n) array
        Response to unit motions of the root.
    """

    omega: FloatArray
    blocked: ComplexArray
    stiffness: ComplexArray
    response: ComplexArray
    carried: ComplexArray

    def motion(self, impedance: ComplexArray) -> ComplexArray:
        """Motion of the root (f, l, 6) on a support with impedances (f, 6, 6) or (6, 6)."""
        omega = self.omega[:, None, None]
        total = self.stiffness + 1j * omega * _matrices(impedance, self.omega)
        return np.asarray(np.linalg.solve(total, self.blocked.transpose(0, 2, 1))).transpose(
            0, 2, 1
        )

    def power(self, impedance: ComplexArray) -> FloatArray:
        """Power into a support, 1/2 Re(v^H Z v), (f, l) [W]: the structure-borne path.

        (theory: S2-79)

        Parameters
        ----------
        impedance : (f, 6, 6), (6, 6), (f, 6) or (6,) array
            Force and moment over velocity; a vector is a diagonal, with infinity not allowed.
        """
        velocity = 1j * self.omega[:, None, None] * self.motion(impedance)
        force = np.einsum("fij,flj->fli", _matrices(impedance, self.omega), velocity)
        return np.asarray(0.5 * np.sum(velocity.conj() * force, axis=-1).real)

    def supported(self, impedance: ComplexArray) -> ComplexArray:
        """Response (f, l, n) to the loads with the root on that support."""
        moved = np.einsum("fli,fin->fln", self.motion(impedance), self.carried)
        return np.asarray(self.response + moved)


def root_path(system: RootedSystem, omega: FloatArray, loads: AnyArray, solve: Solve) -> RootPath:
    """Blocked forces and dynamic stiffness of the root from one set of solutions.

    Parameters
    ----------
    system : RootedSystem
        Whose root is held.
    omega : (f,) array
        Angular frequencies of the solutions [rad/s].
    loads : (l, n) array
        Excitations of the blade.
    solve : callable
        Gives the responses (f, l + 6, n) to the loads and the six unit motions of the root.
    """
    at = np.asarray(omega, dtype=float)
    every = solve(np.concatenate([np.atleast_2d(loads), system.base_motion(np.eye(6))]))
    count = len(np.atleast_2d(loads))
    response, carried = every[:, :count], every[:, count:]
    stiffness = system.reaction(carried).transpose(0, 2, 1)
    return RootPath(at, -system.reaction(response), stiffness, response, carried)


def _matrices(impedance: AnyArray, omega: FloatArray) -> ComplexArray:
    """Impedances (f, 6, 6)."""
    given = np.asarray(impedance, dtype=complex)
    if given.shape in {(6,), (len(omega), 6)} and given.shape != (6, 6):
        given = given[..., None] * np.eye(6)
    if given.shape not in {(6, 6), (len(omega), 6, 6)}:
        raise ValueError(
            f"an impedance of the support has the shape (6,), (f, 6), (6, 6) or (f, 6, 6) with "
            f"f = {len(omega)}, not {given.shape}"
        )
    return np.broadcast_to(given, (len(omega), 6, 6))
