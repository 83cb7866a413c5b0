# SPDX-License-Identifier: LGPL-2.1-or-later
"""Outgoing waves from the sphere of the exact condition, and what they say of its degree."""

import numpy as np

from quietblade.errors import Notice
from quietblade.typing import AnyArray, ComplexArray, FloatArray
from quietblade.vibroacoustics.dtn import Dtn
from quietblade.vibroacoustics.fluid import Water
from quietblade.vibroacoustics.harmonics import outgoing
from quietblade.vibroacoustics.multipoles import Multipoles
from quietblade.vibroacoustics.operators import Operators


def sphere_waves(
    operators: Operators,
    omega: FloatArray,
    response: ComplexArray,
    columns: AnyArray | None = None,
) -> Multipoles:
    """Outgoing waves about the sphere's centre from the harmonics on the sphere (theory: S2-46).

    The auxiliary unknowns are h_lm = sqrt(rho) R psi_lm, so that a_lm = psi_lm / h_l(k R).  Their
    power is the power through the sphere, exactly.

    Parameters
    ----------
    operators : Operators
        With the condition `Dtn`.
    omega : (f,) array
        Angular frequencies [rad/s].
    response : (f, n) array
        Unknowns, or coordinates (f, k).
    columns : (k, n) array or None
        Vectors that the coordinates are factors of, those of a reduced model.

    Raises
    ------
    ValueError
        If the condition is another one: its sphere also carries reflected waves.
    """
    condition = _exact(operators)
    omega = np.atleast_1d(np.asarray(omega, dtype=np.float64))
    on_sphere = _on_sphere(operators, response, columns)
    kr = omega * operators.radius / operators.sound_speed
    degrees = np.arange(condition.degree + 1)
    radial = np.stack([outgoing(int(degree), kr) for degree in degrees], axis=1)
    scale = np.sqrt(operators.density) * operators.radius
    amplitudes = on_sphere / (scale * np.repeat(radial, 2 * degrees + 1, axis=1))
    water = Water(operators.density, operators.sound_speed)
    return Multipoles(operators.center, omega, amplitudes, water, operators.radius)


def near_field_tail(
    operators: Operators, response: ComplexArray, columns: AnyArray | None = None
) -> FloatArray:
    """Share of the two highest degrees in the near field at the sphere, (f,).

    The field of degree l is weighed by the added mass of the water outside, (l + 1) |psi_lm|^2.

    Raises
    ------
    ValueError
        If the condition is not `Dtn`.
    """
    degree = _exact(operators).degree
    size = np.abs(_on_sphere(operators, response, columns)) ** 2
    each = np.add.reduceat(size, np.arange(degree + 1) ** 2, axis=1) * np.arange(1, degree + 2)
    return np.asarray(each[:, -2:].sum(axis=1) / each.sum(axis=1))


def degree_error(
    operators: Operators,
    omega: FloatArray,
    response: ComplexArray,
    columns: AnyArray | None = None,
) -> FloatArray:
    """Estimate, from the solution, of the share that the degrees above N may have wrong, (f,).

    The larger one of the share of degree N in the radiated power, and of the share of degrees
    N - 1 and N in the near field (`near_field_tail`) times q^(2N + 5), which is what would be left
    at the body of degree N + 2, the first one that is reflected at rest, if it were as strong; q is
    the body's size over R (theory: S2-43).
    """
    condition = _exact(operators)
    at_body = condition.size_ratio ** (2 * condition.degree + 5)
    near = near_field_tail(operators, response, columns) * at_body
    leaving = sphere_waves(operators, omega, response, columns).share[:, -1]
    return np.asarray(np.maximum(near, leaving))


def degree_notices(
    operators: Operators,
    omega: FloatArray,
    response: ComplexArray,
    columns: AnyArray | None = None,
) -> list[Notice]:
    """Says where the highest degree of the condition is too low for the field that came out."""
    condition = _exact(operators)
    error = degree_error(operators, omega, response, columns)
    worst = int(np.argmax(error))
    if error[worst] <= condition.accuracy:
        return []
    frequency = np.atleast_1d(omega)[worst] / (2.0 * np.pi)
    return [
        Notice(
            f"radiation condition DtN at {frequency:.4g} Hz",
            f"its degree, {condition.degree}, is too low for the field on the sphere",
            float(error[worst]),
            condition.accuracy,
            "Ask for more accuracy, or take a larger sphere.",
        )
    ]


def _on_sphere(
    operators: Operators, response: ComplexArray, columns: AnyArray | None
) -> ComplexArray:
    """Auxiliary unknowns (f, h) of a response."""
    rows, own = np.atleast_2d(response), operators.blocks.harmonics
    return np.asarray(rows[:, own] if columns is None else rows @ columns[:, own])


def _exact(operators: Operators) -> Dtn:
    if not isinstance(operators.condition, Dtn):
        raise ValueError(
            f"outgoing waves on the sphere need the condition DtN, not {operators.condition.name}; "
            "use SurfaceSources.multipoles"
        )
    return operators.condition
