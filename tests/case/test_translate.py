# SPDX-License-Identifier: LGPL-2.1-or-later
"""From words to physics: the same numbers arrive, and estimates are right."""

from math import pi
from typing import Any

import numpy as np
import pytest

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.study import translate
from quietblade.study.preflight import bending_wavelength, preflight


def preset(name: str) -> Case:
    return Case.parse(preset_text(name), f"{name}.toml")


def test_blade_and_film() -> None:
    blade = translate.build_blade(preset("paper-aluminium"))
    s = np.array([0.0, 0.5, 1.0])
    assert blade.chord(s) == pytest.approx([0.25, 0.1625, 0.075])
    assert blade.radius(s) == pytest.approx([0.2, 0.7, 1.2])
    assert blade.film is not None
    assert blade.film.thickness == pytest.approx(1.55e-3)


def test_twisted_blade() -> None:
    blade = translate.build_blade(preset("twisted"))
    assert np.degrees(blade.blade_angle(np.array([0.0, 1.0]))) == pytest.approx([-18.7, -53.1])
    assert blade.sweep(np.array([0.5])) == pytest.approx([0.015])
    assert blade.camber(np.array([0.5])) == pytest.approx([0.015])


def test_the_rest_arrives() -> None:
    case = preset("twisted").varied({"excitation.side": "lower", "mesh.water_size": "0.3 m"})
    spec = translate.mesh_spec(case)
    assert spec.size == 0.025
    assert spec.water_size == 0.3
    assert spec.centre == pytest.approx((0.0, 0.0, 0.7))
    (patch,) = spec.patches
    assert (patch.side, patch.span) == (-1, (0.85, 0.95))
    inflow = translate.inflow(case)
    assert (inflow.speed, inflow.density) == (5.0, 1025.0)
    assert inflow.rotation == pytest.approx(2 * pi)
    assert translate.spin(case).omega == inflow.rotation
    assert translate.water(case).sound_speed == 1500.0
    moved = case.varied({"acoustics.sphere_centre": ["0.1 m", "0 m", "0.6 m"]})
    assert translate.mesh_spec(moved).centre == (0.1, 0.0, 0.6)


@pytest.mark.parametrize(
    ("band", "step", "count"),
    [(("100 Hz", "200 Hz"), "2.5 Hz", 41), (("100 Hz", "200 Hz"), "30 Hz", 4)],
)
def test_base_frequencies(band: Any, step: str, count: int) -> None:
    case = preset("paper-aluminium").varied({"acoustics.band": list(band), "acoustics.step": step})
    frequencies = translate.base_frequencies(case)
    assert len(frequencies) == count
    assert (frequencies[0], frequencies[-1]) == (100.0, 200.0)


def test_numbers_of_the_paper() -> None:
    known = preflight(preset("paper-aluminium"))
    # atan(0.58 * 1.2 / 5) is the paper's "8 degrees at the tip"
    assert np.degrees(known.incidence) == pytest.approx([1.329, 7.925], abs=1e-3)
    assert known.kr == pytest.approx([2 * pi * 100 / 1500 * 0.8, 2 * pi * 220 / 1500 * 0.8])
    assert known.acoustic_wavelength == pytest.approx(1500 / 220)
    assert known.notices == ()
    first_order = preflight(preset("paper-aluminium").varied({"acoustics.radiation": "bgt1"}))
    assert [notice.where for notice in first_order.notices] == ["acoustics.radiation"]


def test_bending_wavelength_solves_its_dispersion_relation() -> None:
    case = preset("paper-aluminium")
    blade = translate.build_blade(case)
    k = 2 * pi / bending_wavelength(case, blade, 150.0)
    # mean thickness: area of the section by the shoelace formula, over its chord
    xy = blade.section(np.array([0.5]), 2001)[0]
    x, y = xy[:, 0], xy[:, 1]
    height = 0.5 * abs(float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))) / 0.1625
    left = 65e9 * height**3 / 12 * k**4
    right = (2 * pi * 150.0) ** 2 * (2500.0 * height + 2 * 1000.0 / k)
    assert left == pytest.approx(right, rel=1e-3)


@pytest.mark.parametrize(
    ("changes", "where", "fragment"),
    [
        ({"mesh.size": "120 mm"}, "mesh.size", "few elements per bending wavelength"),
        ({"mesh.water_size": "1.3 m", "acoustics.sphere_radius": "3 m"}, "mesh.water_size",
         "per acoustic wavelength"),
        ({"blade.material": "aluminium-paper"}, "materials.aluminium", "not used"),
        ({"materials.aluminium.E": "65 mPa"}, "blade.material", "very soft"),
        ({"materials.polymer.c10": "0 Pa", "materials.polymer.c01": "3 mPa"}, "film.material",
         "very soft"),
    ],
)  # fmt: skip
def test_notices(changes: dict[str, Any], where: str, fragment: str) -> None:
    notices = preflight(preset("paper-aluminium").varied(changes)).notices
    (found,) = [notice for notice in notices if notice.where == where]
    assert fragment in found.message
    assert found.remedy


def test_a_large_sphere_has_no_notice() -> None:
    case = preset("paper-aluminium").varied({"acoustics.sphere_radius": "8 m"})
    assert preflight(case).notices == ()
    assert translate.water_size(case) == pytest.approx(1500 / 220 / 6)  # of a wavelength
    assert translate.water_size(preset("paper-aluminium")) == 0.2  # a quarter of the radius
