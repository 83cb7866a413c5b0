# SPDX-License-Identifier: LGPL-2.1-or-later
"""Moving spheres under the exact condition and under both BGT conditions, degrees 0 to 4.

The sphere of water is close: R = 1.24 a.  One mesh of 29 000 potentials, whose edges are 0.055 m on
a sphere of 0.5 m; the error is that of the motion of degree 4 on these edges and, at kR = 10, of
three layers of cells for a wave of 0.39 m.  Weak multipoles at low frequency are not compared by
their total power: a rounding of 1e-7 of the motion that is a monopole radiates more than they do.
"""

from dataclasses import replace
from functools import cache, partial

import numpy as np

from quietblade.typing import FloatArray
from quietblade.vibroacoustics.dtn import Dtn
from quietblade.vibroacoustics.farfield import sphere_waves
from quietblade.vibroacoustics.power import radiated_power, surface_power
from quietblade.vibroacoustics.radiation import Bgt1, Bgt2, RadiationCondition
from verification.acoustics_closed_forms import Bgt, bgt1, bgt2, moving_sphere
from verification.acoustics_models import SOFT, WATER, SphereModel, layered_mesh
from verification.registry import check

JUNGER = "Junger and Feit 1986, spherical waves"
BODY, OUTER = 0.5, 0.62
KR = (0.1, 0.5, 1.0, 3.0, 10.0)
DEGREES = (0, 1, 2, 3, 4)


@cache
def model() -> SphereModel:
    """Thin solid shell in a close sphere of water, under the exact condition."""
    mesh = layered_mesh((0.44, BODY, 0.54, 0.58, OUTER), (0.3, 0.055, 0.065, 0.065, 0.065), BODY)
    return SphereModel(mesh, BODY, OUTER, {"blade": SOFT}, condition=Dtn(6))


@cache
def powers(kr: float) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Powers of unit motions of degrees 0 to 4 under DtN [W].

    Returns
    -------
    exact, driven, total, surface : (5,) arrays
        Closed form; of the driven degree; through the sphere; from the wetted surface.
    """
    operators = model().operators
    omega = kr / OUTER * WATER.sound_speed
    response = model().forced_by_motions(DEGREES, omega)
    at = np.full(len(DEGREES), omega)
    by_degree = sphere_waves(operators, at, response).power_by_degree
    exact = [
        moving_sphere(n, kr / OUTER, BODY, OUTER, 1.0, None).power(WATER.density, omega)
        for n in DEGREES
    ]
    return (
        np.array(exact),
        by_degree[np.arange(len(DEGREES)), DEGREES],
        radiated_power(operators, at, response),
        surface_power(operators, at, response),
    )


def driven_ratio(degree: int, kr: float) -> float:
    """Power of the driven degree over the closed form's."""
    return float(powers(kr)[1][degree] / powers(kr)[0][degree])


def driven_error(degree: int) -> float:
    """Largest relative error of the power of the driven degree over kR."""
    return max(abs(powers(kr)[1][degree] / powers(kr)[0][degree] - 1.0) for kr in KR)


def total_error(degree: int) -> float:
    """Largest relative error of the total power where kR is above half the degree."""
    used = [kr for kr in KR if kr > 0.5 * degree]
    return max(abs(powers(kr)[2][degree] / powers(kr)[0][degree] - 1.0) for kr in used)


def leakage(kr: float) -> float:
    """Largest share of the power in other degrees than the driven one, where kR > degree/2."""
    _, driven, total, _ = powers(kr)
    used = np.array(DEGREES) < 2.0 * kr
    return float(np.max(np.abs(1.0 - driven / total)[used]))


for _degree in DEGREES:
    check(
        f"acoustics/dtn-sphere-n{_degree}-driven",
        quantity=f"largest error of the power in degree {_degree}, sphere moving with P{_degree}, "
        "DtN at R = 1.24 a, kR = 0.1, 0.5, 1, 3, 10",
        reference=0.0,
        source=f"{JUNGER}, infinite water",
        tolerance=1e-3,  # the aim; 6e-5 to 4e-4 measured
        quick=False,
    )(partial(driven_error, _degree))
    check(
        f"acoustics/dtn-sphere-n{_degree}-total",
        quantity=f"largest error of the total power, sphere moving with P{_degree}, DtN at "
        f"R = 1.24 a, those of the kR above {_degree / 2:g}",
        reference=0.0,
        source=f"{JUNGER}, infinite water",
        tolerance=1e-3,
        quick=False,
    )(partial(total_error, _degree))

for _degree in DEGREES:
    for _kr in KR:
        check(
            f"acoustics/sphere-dtn-n{_degree}-kr{_kr:g}",
            quantity=f"power in degree {_degree} over the closed form, sphere moving with "
            f"P{_degree}, DtN at R = 1.24 a, kR = {_kr:g}",
            reference=1.0,
            source=f"{JUNGER}, infinite water",
            tolerance=1e-3,
            quick=False,
        )(partial(driven_ratio, _degree, _kr))

for _kr in KR:
    check(
        f"acoustics/dtn-sphere-leakage-kr{_kr:g}",
        quantity=f"largest share of the power in degrees that are not driven, kR = {_kr:g} above "
        "half the driven degree",
        reference=0.0,
        source="symmetry",
        tolerance=1e-3,
        quick=False,
    )(partial(leakage, _kr))


@check(
    "acoustics/dtn-surface-power",
    quantity="largest difference of the powers from the wetted surface and of the outgoing waves",
    reference=0.0,
    source="conservation of energy",
    tolerance=1e-8,  # rounding, relative to the reactive power of degree 4 at kR = 0.1
    quick=False,
)
def surface() -> float:
    """Over all degrees and kR."""
    return max(float(np.abs(powers(kr)[3] / powers(kr)[2] - 1.0).max()) for kr in KR)


@cache
def truncated_error(condition: RadiationCondition, form: Bgt, kr: float) -> FloatArray:
    """Relative errors (5,) of the power through the sphere, degrees 0 to 4."""
    local = replace(model(), condition=condition)
    omega = kr / OUTER * WATER.sound_speed
    response = local.forced_by_motions(DEGREES, omega)
    found = radiated_power(local.operators, np.full(len(DEGREES), omega), response)
    exact = np.array(
        [
            moving_sphere(n, kr / OUTER, BODY, OUTER, 1.0, form).power_through(
                OUTER, form, WATER.density, omega
            )
            for n in DEGREES
        ]
    )
    return np.asarray(np.abs(found / exact - 1.0))


def truncated(condition: RadiationCondition, form: Bgt, kr: float) -> float:
    """Largest relative error over the degrees."""
    return float(truncated_error(condition, form, kr).max())


for _name, _condition, _form in (("bgt1", Bgt1(), bgt1), ("bgt2", Bgt2(), bgt2)):
    for _kr in (0.1, 1.0, 4.0, 10.0):
        check(
            f"acoustics/{_name}-sphere-kr{_kr:g}",
            quantity=f"largest error of the power through the sphere, {_condition.name} at "
            f"R = 1.24 a, kR = {_kr:g}, degrees 0 to 4"
            + (" (negative powers for 2 to 4)" if _name == "bgt2" and _kr <= 1.0 else ""),
            reference=0.0,
            source=f"{JUNGER}, with the wave that the condition reflects at R",
            tolerance=1e-3,  # 5e-4 measured, for degree 4
            quick=False,
        )(partial(truncated, _condition, _form, _kr))
