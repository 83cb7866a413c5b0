# SPDX-License-Identifier: LGPL-2.1-or-later
"""Peaks are assigned to modes, and the paper's claims are judged by their criteria."""

from dataclasses import replace

import numpy as np
import pytest

from quietblade.results.claims import BLADES, Claim, judge_claims
from quietblade.results.model import Result
from quietblade.results.peaks import find_peaks, partner_of
from tests.results.synthetic import SHAPES, make_result, with_static


def claims(result: Result, blade: str | None = None) -> dict[str, Claim]:
    return {claim.id.rpartition("/")[2]: claim for claim in judge_claims(result, blade)}


@pytest.mark.parametrize("blade", BLADES)
def test_peaks_are_where_the_modes_are(blade: str) -> None:
    c0 = make_result(blade).configurations["C0"]
    expected = {n: f for n, (_, f, _, _) in SHAPES[blade].modes.items() if 100.0 < f < 200.0}
    peaks = find_peaks(c0)
    assert set(peaks) == set(expected)
    for name, peak in peaks.items():
        assert peak.frequency == pytest.approx(expected[name], rel=1e-4)
        row = np.flatnonzero(c0.spectrum.frequency == peak.frequency)
        assert peak.level == c0.spectrum.power_level[0, row]


def test_a_flank_is_no_peak() -> None:
    c0 = make_result("aluminium").configurations["C0"]
    modes = c0.modes
    # a mode on the flank of B5, where the level only rises
    on_flank = replace(
        modes, frequency=np.where(np.array(modes.name) == "E2", 141.0, modes.frequency)
    )
    assert "E2" not in find_peaks(replace(c0, modes=on_flank))


def test_partners() -> None:
    c0 = make_result("aluminium").configurations["C0"]
    assert partner_of(c0, "T2") == ("T2", 0.97)
    assert partner_of(c0, "T9") is None
    alone = replace(c0, modes=replace(c0.modes, partner=("",) * len(c0.modes.name)))
    assert partner_of(alone, "T2") is None


@pytest.mark.parametrize("blade", BLADES)
def test_a_result_like_the_paper_agrees_with_it(blade: str) -> None:
    judged = judge_claims(make_result(blade))
    assert [c.id for c in judged if not c.agrees] == []
    assert len({c.id for c in judged}) == len(judged) == 19
    assert all(c.id.startswith(f"paper/{blade}/") for c in judged)
    assert all(c.statement and c.paper and c.computed and c.criterion for c in judged)


def test_each_blade_contradicts_the_other_blades_claims() -> None:
    as_composite = claims(make_result("aluminium"), "composite")
    for key in ("film-shear-strain", "camber", "blade-angle", "lift-coefficient", "peak-3"):
        assert as_composite[key].agrees is False, key
    as_aluminium = claims(make_result("composite"), "aluminium")
    for key in ("film-shear-strain", "camber", "blade-angle", "lift-coefficient", "shift-2"):
        assert as_aluminium[key].agrees is False, key
    for key in ("rigid-lift-slope", "rigid-lift-linear"):
        assert as_aluminium[key].agrees, key


def test_other_blades_have_no_claims() -> None:
    assert judge_claims(replace(make_result(), blade="")) == ()


@pytest.mark.parametrize(
    ("strain", "agrees"), [(0.0141, False), (0.0143, True), (0.0237, True), (0.0238, False)]
)
def test_the_shear_strain_has_a_quarter_of_tolerance(strain: float, agrees: bool) -> None:
    claim = claims(with_static(make_result(), max_film_shear_strain=strain))["film-shear-strain"]
    assert claim.agrees is agrees
    assert claim.value == pytest.approx(100 * strain)


def test_what_was_not_computed_is_not_judged() -> None:
    result = with_static(make_result(), max_film_shear_strain=np.nan)
    rest_only = replace(result, configurations={"C0": result.configurations["C0"]})
    found = claims(rest_only)
    for key in ("film-shear-strain", "film-strained-most", "shift-1", "level-2"):
        assert found[key].agrees is None, key
        assert found[key].value is None
        assert found[key].computed == "not computed"
    assert found["peak-1"].agrees
    neither = claims(replace(result, configurations={}))
    assert neither["peak-1"].agrees is None
    assert neither["shape-1"].agrees is None


def test_a_peak_that_is_not_there_differs() -> None:
    result = make_result("composite")
    c0 = result.configurations["C0"]
    names = tuple("B9" if name == "B7" else name for name in c0.modes.name)
    renamed = replace(c0, modes=replace(c0.modes, name=names))
    found = claims(replace(result, configurations={**result.configurations, "C0": renamed}))
    assert found["peak-3"].agrees is False
    assert found["peak-3"].computed == "no such peak"
    assert found["shift-3"].agrees is None


def test_a_mode_that_changes_its_name_is_followed() -> None:
    result = make_result("composite")
    c0, c1 = (result.configurations[name] for name in ("C0", "C1"))
    swap = {"B6": "T2", "T2": "B6"}
    loaded = tuple(swap.get(name, name) for name in c1.modes.name)
    partner = tuple(swap.get(name, name) for name in c0.modes.partner)
    swapped = replace(
        result,
        configurations={
            "C0": replace(c0, modes=replace(c0.modes, partner=partner)),
            "C1": replace(c1, modes=replace(c1.modes, name=loaded)),
        },
    )
    found, before = claims(swapped), claims(result)
    assert found["shift-1"].value == before["shift-1"].value
    assert "MAC 0.970 with T2" in found["shape-1"].computed
