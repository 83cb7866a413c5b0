# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts of the film's stiffness by its static shear."""

import ngsolve as ngs
import numpy as np
import pytest

from quietblade.propulsion.film_loss import equivalent_shear, prestrain_parts
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.tangent import compute_tangent
from tests.propulsion.solid_models import bent_plate, plate
from verification.structure_models import Beam


def test_parts_add_up_and_each_is_positive() -> None:
    structure, state = plate(), bent_plate()
    whole = compute_tangent(structure, state).film_isochoric_material
    gamma = equivalent_shear(structure, state)
    inside, fem = ngs.dx("film"), structure.forms.fem
    volume = ngs.Integrate(ngs.CF(1.0) * inside, fem)
    largest = float(np.sqrt(ngs.Integrate(gamma**2 * inside, fem) / volume))
    parts = prestrain_parts(structure, state, [0.0, 0.5 * largest, largest])
    assert abs(sum(parts) - whole).max() < 1e-12 * abs(whole).max()
    x = np.random.default_rng(0).standard_normal(whole.shape[0])
    shares = [float(x @ part @ x) / float(x @ whole @ x) for part in parts]
    assert min(shares) > 0.01
    assert sum(shares) == pytest.approx(1.0, rel=1e-12)


def test_at_rest_everything_has_the_first_strain() -> None:
    structure = plate()
    state = structure.rest()
    first, second = prestrain_parts(structure, state, [0.0, 0.1])
    whole = compute_tangent(structure, state).film_isochoric_material
    assert abs(first - whole).max() < 1e-6 * abs(whole).max()
    assert abs(second).max() < 1e-6 * abs(whole).max()


def test_simple_shear_and_change_of_volume() -> None:
    structure = plate()
    forms = structure.forms
    moved = forms.displacement(np.zeros(forms.n_displacement))
    moved.Set(ngs.CF((0.3 * ngs.y, 0.0, 0.0)))
    state = structure.rest()
    shifted = type(state)(np.array(moved.vec), state.film_pressure, state.loading)
    at = structure.forms.fem
    mean = ngs.Integrate(equivalent_shear(structure, shifted) * ngs.dx("film"), at)
    volume = ngs.Integrate(ngs.CF(1.0) * ngs.dx("film"), at)
    assert mean / volume == pytest.approx(0.3, rel=1e-9)
    moved.Set(0.2 * ngs.CF((ngs.x, ngs.y, ngs.z)))
    swollen = type(state)(np.array(moved.vec), state.film_pressure, state.loading)
    assert ngs.Integrate(equivalent_shear(structure, swollen) * ngs.dx("film"), at) < 1e-6 * volume


def test_what_is_refused() -> None:
    structure = plate()
    with pytest.raises(ValueError, match="must ascend"):
        prestrain_parts(structure, structure.rest(), [0.1, 0.1])
    bare: Structure = Beam(cells=2).structure()
    with pytest.raises(ValueError, match="no film"):
        prestrain_parts(bare, bare.rest(), [0.0])
