# SPDX-License-Identifier: LGPL-2.1-or-later
"""Exported decks, solved by CalculiX itself."""

import numpy as np
import pytest

from quietblade.propulsion.deck import write_deck
from tests.propulsion.solid_models import bent_plate, plate
from verification.calculix import is_installed, run_calculix
from verification.structure_calculix import compare_blade, twisting_fibres

pytestmark = [
    pytest.mark.live,
    pytest.mark.skipif(not is_installed(), reason="the program ccx (CalculiX) is not installed"),
]


def test_blade_with_turning_fibres_bends_alike() -> None:
    found = compare_blade(twisting_fibres(), 2e4, size=0.08, omega=20.0)
    assert found.deflection > 0.1
    assert found.displacement < 1e-3
    assert found.stress < 0.02
    assert found.reaction < 1e-3


def test_sandwich_with_a_film_bends_alike(tmp_path) -> None:
    # 20-node hexahedra, in the film with reduced integration, against 27 functions and a pressure
    write_deck(tmp_path / "plate.inp", plate(), bent_plate(), tolerance=1e-6)
    theirs = run_calculix(tmp_path / "plate.inp")
    ours = plate().values(bent_plate())[theirs.nodes - 1]
    assert np.abs(ours - theirs.fields["DISP"]).max() < 0.01 * np.abs(ours).max()
