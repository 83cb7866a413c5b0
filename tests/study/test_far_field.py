# SPDX-License-Identifier: LGPL-2.1-or-later
"""Far field of a sphere with prescribed motion, from all unknowns and from coordinates."""

from functools import cache
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.study.far_field import FarField, Samples, solve_far_field
from quietblade.study.far_outcome import directivity_result, far_field_result
from quietblade.study.vibration import Vibration
from quietblade.vibroacoustics.dtn import Dtn
from quietblade.vibroacoustics.fluid import normal_motion_matrix
from quietblade.vibroacoustics.radiation import Bgt1, RadiationCondition
from verification import acoustics_closed_forms as closed
from verification.acoustics_models import SOFT, WATER, SphereModel, ball

OMEGA = np.array([1200.0, 1500.0])
ASKED = {"far_field": {"points": [["0 m", "0 m", "0.8 m"], ["0 m", "3 m", "4 m"]]}}


@cache
def sphere(condition: RadiationCondition) -> SphereModel:
    return SphereModel(ball().fem, 0.5, 1.0, {"blade": SOFT}, condition=condition)


def solved(
    condition: RadiationCondition,
    degree: int,
    *,
    reduced: bool = False,
    peaks: int = 1,
    parts: int = 1,
) -> FarField:
    """Far field of a sphere of 0.5 m that moves with v_r = P_l(cos theta)."""
    model = sphere(condition)
    vibration = cast(
        Vibration,
        SimpleNamespace(
            name="C0",
            operators=model.operators,
            sources=model.sources,
            normal_motion=normal_motion_matrix(model.fem, "wet"),
            excited=SimpleNamespace(root=None),
        ),
    )
    rows = np.array([model.forced_by_motion(degree, w) for w in OMEGA])
    sources, columns = model.sources, None
    if reduced:  # the columns of a reduced model are real
        columns = np.concatenate([rows.real, rows.imag])
        rows = np.block([np.eye(2), 1j * np.eye(2)])
        sources = sources.on(columns)
    case = Case.parse(preset_text("paper-aluminium")).varied(ASKED)
    spectrum = Samples(OMEGA, parts * (rows,), sources, columns)
    patterns = Samples(OMEGA[1:], parts * (rows[1:],), sources, columns)
    return solve_far_field(case, vibration, spectrum, patterns, peaks)


@pytest.mark.parametrize("degree", [0, 1, 2])
def test_measures_are_those_of_the_closed_form(degree: int) -> None:
    far = solved(Dtn(4), degree)
    result = far_field_result(1.0, far)
    assert result.origin == "sphere"
    power = closed.moving_sphere(degree, 0.8, 0.5, 1.0, 1.0, None).power(1000.0, OMEGA[0])
    level = 10.0 * np.log10(1000.0 * 1500.0 * power / (4.0 * np.pi * 1e-12))
    assert result.source_level[0] == pytest.approx(level, abs=0.05)
    # the mean square of P_l is 1/(2 l + 1)
    plane = 0.5 * 1000.0 * 1500.0 * np.pi / (2 * degree + 1)
    assert result.efficiency[0] == pytest.approx(power / plane, rel=0.01)
    np.testing.assert_allclose(result.share[degree], 1.0, atol=1e-3)
    np.testing.assert_allclose(result.share.sum(axis=0), 1.0)
    np.testing.assert_allclose(result.kr, OMEGA / 1500.0)
    assert far.reason == ("peak",)
    assert far.notices == ()


@pytest.mark.parametrize("condition", [Dtn(4), Bgt1()], ids=["DtN", "BGT-1"])
def test_coordinates_give_what_all_unknowns_give(condition: RadiationCondition) -> None:
    whole, part = solved(condition, 1), solved(condition, 1, reduced=True)
    np.testing.assert_allclose(part.spectrum.waves.power, whole.spectrum.waves.power, rtol=1e-9)
    np.testing.assert_allclose(part.spectrum.efficiency, whole.spectrum.efficiency, rtol=1e-9)
    np.testing.assert_allclose(part.pressure, whole.pressure, rtol=1e-9)
    np.testing.assert_allclose(part.condition_error, whole.condition_error, atol=1e-9)


def test_an_approximate_condition_does_not_spoil_what_leaves() -> None:
    far = solved(Bgt1(), 1)
    assert far.origin == "multipoles"
    assert np.all(far.condition_error > 1.0)  # dB, of a dipole at kR = 0.8 and 1
    model = sphere(Bgt1())
    assert far.spectrum.waves.water == model.water == WATER


def test_powers_of_independent_parts_add() -> None:
    one, two = (far_field_result(1.0, solved(Dtn(4), 1, parts=n)) for n in (1, 2))
    np.testing.assert_allclose(two.source_level - one.source_level, 10.0 * np.log10(2.0))
    np.testing.assert_allclose(two.efficiency, one.efficiency)
    np.testing.assert_allclose(two.share, one.share)
    np.testing.assert_allclose(two.pressure_level - one.pressure_level, 10.0 * np.log10(2.0))
    case = Case.parse(preset_text("paper-aluminium"))
    single, double = (directivity_result(case, solved(Dtn(4), 1, parts=n)) for n in (1, 2))
    np.testing.assert_allclose(double.index, single.index, atol=1e-9)
    np.testing.assert_allclose(double.cut_level[0, 1].max(), single.cut_level[0, 1].max() + 3.0103)


def test_pressure_at_points_near_and_far() -> None:
    far = solved(Dtn(4), 1)
    field = closed.moving_sphere(1, OMEGA[1] / 1500.0, 0.5, 1.0, 1.0, None)
    for number, (x, y, z) in enumerate(far.points):
        r = float(np.sqrt(x * x + y * y + z * z))
        exact = -1j * OMEGA[1] * 1000.0 * field.potential(r) * z / r
        assert far.pressure[number, 1] == pytest.approx(exact, rel=0.01)


def test_patterns_of_a_dipole() -> None:
    case = Case.parse(preset_text("paper-aluminium"))
    found = directivity_result(case, solved(Dtn(4), 1, peaks=0))
    assert found.reason == ("given",)
    assert found.index[0] == pytest.approx(10.0 * np.log10(3.0), abs=0.02)
    assert abs(found.loudest[0, 2]) == pytest.approx(1.0)
    # the mean over the sphere is the source level
    weight = np.sin(found.polar)[:, None] * np.ones(len(found.azimuth))
    mean = np.sum(weight * 10.0 ** (found.level[0] / 10.0)) / weight.sum()
    assert 10.0 * np.log10(mean) == pytest.approx(found.source_level[0], abs=0.02)
    # planes and grid meet: +x, +y and +z
    cuts = dict(zip(found.cut, found.cut_level[0], strict=True))
    quarter, half = len(found.angle) // 4, len(found.polar) // 2
    assert cuts["xz"][quarter] == pytest.approx(found.level[0, 0, 0], abs=1e-9)
    assert cuts["yz"][quarter] == pytest.approx(found.level[0, 0, 0], abs=1e-9)
    place = (0, half, len(found.azimuth) // 4)
    assert 10.0 ** (cuts["xy"][quarter] / 20.0) == pytest.approx(
        10.0 ** (found.level[place] / 20.0), rel=1e-6
    )
    largest = np.abs(found.product[0]).max() / np.sqrt(2.0) / 1e-6
    assert 20.0 * np.log10(largest) == pytest.approx(found.level[0].max(), abs=1e-9)
