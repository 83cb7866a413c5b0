# SPDX-License-Identifier: LGPL-2.1-or-later
"""The shift from C0 to C1 taken apart, and the water of C1 meshed anew, on a coarse blade."""

from dataclasses import replace

import numpy as np
import pytest

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.results.alternatives import AlternativeTable
from quietblade.study.alternatives import Alternative, LoadedBlade, load_blade, tabulate, vibrate
from quietblade.study.decomposition import (
    ALL,
    BOTH,
    LOAD,
    REST,
    SHAPE,
    SHARES,
    STRESS,
    decompose_shift,
)
from quietblade.study.water_check import ANEW, MOVED, compare_water
from quietblade.typing import silent

COARSE = {
    "film.span": [0.1, 0.9],
    "film.chord": [0.25, 0.65],
    "film.thickness": "1 mm",
    "mesh.size": "50 mm",
    "acoustics.band": ["15 Hz", "40 Hz"],
    "acoustics.step": "25 Hz",
    "acoustics.points_per_mode": 0,
    "static.tolerance": 1e-3,
    "flow.sections": 21,
    "flow.section_nodes": 81,
}


@pytest.fixture(scope="module")
def loaded() -> LoadedBlade:
    return load_blade(Case.parse(preset_text("paper-aluminium")).varied(COARSE))


@pytest.fixture(scope="module")
def shift(loaded: LoadedBlade) -> AlternativeTable:
    return decompose_shift(loaded.case, loaded=loaded)


def moved(table: AlternativeTable, name: str) -> np.ndarray:
    """Relative change of the squared frequencies against the first alternative."""
    return (table.frequency[table.row(name)] / table.frequency[0]) ** 2 - 1.0


def test_every_share_is_there_and_its_modes_are_found(shift: AlternativeTable) -> None:
    assert shift.name == (REST, *SHARES)
    assert len(shift.mode) >= 2
    assert np.all(np.isfinite(shift.frequency))
    # the water's mass takes a solve, exact to 1e-10
    np.testing.assert_allclose(shift.assurance[0], 1.0, rtol=1e-9)
    assert np.all(shift.assurance > 0.5)


def test_last_alternative_is_the_ordinary_problem(
    loaded: LoadedBlade, shift: AlternativeTable
) -> None:
    whole = vibrate(loaded, progress=silent)
    found = np.sort(shift.frequency[shift.row(ALL)])
    # the sums are added up in another order, which the lowest mode shows to 1e-8
    np.testing.assert_allclose(whole.modes.frequency, found, rtol=1e-7)


def test_steps_are_what_the_load_does(shift: AlternativeTable) -> None:
    stress, load = moved(shift, BOTH) - moved(shift, SHAPE), moved(shift, LOAD) - moved(shift, BOTH)
    spin = moved(shift, ALL) - moved(shift, LOAD)
    # omega_p^2 M_perp lowers omega^2 by omega_p^2 at most: nothing here
    first = 2.0 * np.pi * shift.frequency[0, 0]
    assert -1.01 * (0.58 / first) ** 2 < spin[0] <= 0.0
    assert abs(stress[0]) > 10.0 * abs(spin[0])
    assert np.abs(load).max() > 0.0
    assert not np.allclose(moved(shift, STRESS), stress, rtol=1e-3, atol=0.0)


def test_without_load_nothing_moves(loaded: LoadedBlade) -> None:
    rest = loaded.statics.structure.rest()
    state = replace(
        loaded.statics.state,
        structure=rest,
        displacement=np.zeros_like(loaded.statics.state.displacement),
    )
    motion = replace(loaded.motion, displacement=np.zeros_like(loaded.motion.displacement))
    still = replace(loaded, statics=replace(loaded.statics, state=state), motion=motion)
    at_rest = vibrate(still, at_rest=True, progress=silent)
    for _, share in list(SHARES.values())[:2]:
        again = vibrate(still, share, progress=silent)
        np.testing.assert_allclose(again.modes.frequency, at_rest.modes.frequency, rtol=1e-7)


def test_water_meshed_anew_gives_the_same_modes(loaded: LoadedBlade) -> None:
    table = compare_water(loaded.case, loaded=loaded)
    assert table.name == (MOVED, ANEW)
    np.testing.assert_allclose(table.frequency[1], table.frequency[0], rtol=5e-3)
    assert np.all(table.frequency[1] != table.frequency[0])
    assert np.all(table.assurance[1] > 0.99)


def test_nothing_to_tabulate(loaded: LoadedBlade) -> None:
    none: list[Alternative] = []
    with pytest.raises(ValueError, match="no alternative"):
        tabulate("nothing", loaded, none)
