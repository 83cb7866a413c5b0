# SPDX-License-Identifier: LGPL-2.1-or-later
"""Likeness of modes in the mass with the water's, and participation."""

from dataclasses import replace

import numpy as np
import pytest

from quietblade.vibroacoustics.matching import assurance, match, participation, wet_mass
from quietblade.vibroacoustics.modes import wet_modes
from quietblade.vibroacoustics.vacuum import dry_operators
from tests.vibroacoustics.small_systems import condensed, random_operators


def test_wet_mass_is_the_dense_one() -> None:
    operators = random_operators()
    _, mass = condensed(operators, water=True)
    u = operators.blocks.u
    x = np.random.default_rng(0).standard_normal((operators.size, 3))
    complex_x = x + 1j * x[::-1]
    product = wet_mass(operators)
    for columns in (x, complex_x):
        found = product @ columns
        np.testing.assert_allclose(found[u], mass @ columns[u], rtol=1e-9, atol=1e-9)
        rest = np.delete(found, u, axis=0)
        assert np.abs(rest).max() == 0.0
    np.testing.assert_allclose((product @ x[:, 0])[u], mass @ x[u, 0], rtol=1e-9, atol=1e-9)
    with pytest.raises(ValueError, match="static exterior"):
        wet_mass(replace(operators, exterior=None))


def test_wet_modes_are_orthogonal_in_it_and_nothing_else() -> None:
    operators = random_operators()
    modes = wet_modes(operators, 60.0)
    table = assurance(modes.vectors, modes.vectors, wet_mass(operators))
    np.testing.assert_allclose(table, np.eye(modes.count), atol=1e-9)
    dry = assurance(modes.vectors, modes.vectors, operators.terms["M"])
    assert np.abs(dry - np.eye(modes.count)).max() > 1e-3


def test_modes_find_their_partners_in_another_order() -> None:
    operators = random_operators()
    modes = wet_modes(operators, 60.0)
    order = np.random.default_rng(1).permutation(modes.count)
    found = match(modes.vectors, 1j * modes.vectors[order], wet_mass(operators))
    np.testing.assert_array_equal(order[found.partner], np.arange(modes.count))
    np.testing.assert_allclose(found.assurance, 1.0, rtol=1e-9)


def test_participation_adds_up() -> None:
    operators = random_operators()
    modes = wet_modes(operators, 100.0)
    weights = np.array([0.6, 0.8j]) @ modes.vectors[[1, 4]]
    shares = participation(weights[None], modes.vectors, wet_mass(operators))[0]
    assert shares[1] == pytest.approx(0.36, rel=1e-9)
    assert shares[4] == pytest.approx(0.64, rel=1e-9)
    assert shares.sum() == pytest.approx(1.0, rel=1e-9)


def test_in_vacuo_it_is_the_mass() -> None:
    wet = random_operators()
    u = wet.blocks.u
    K, M = (wet.terms[name][u][:, u] for name in "KM")
    dry = dry_operators(stiffness=K, mass=M, free=np.ones(len(u), dtype=bool), displacements=len(u))
    x = np.random.default_rng(0).standard_normal(len(u))
    np.testing.assert_allclose(wet_mass(dry) @ x, M @ x, rtol=1e-12)
