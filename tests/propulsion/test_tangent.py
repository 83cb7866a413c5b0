# SPDX-License-Identifier: LGPL-2.1-or-later
from dataclasses import replace
from functools import cache

import ngsolve as ngs
import numpy as np
import pytest
from scipy.sparse import csr_matrix

from quietblade.materials import find_material
from quietblade.mesh.assembly import csr_of
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.tangent import ELASTIC, FILM, Tangent, compute_tangent
from quietblade.typing import FloatArray
from tests.propulsion.solid_models import bent_plate, plate, plate_mesh
from verification.structure_models import SURFACE, Beam, box_mesh, dry_modes

PIECES = ("elastic", "film", "film_isochoric_material", "load", "spin", "mass")


@cache
def tangent() -> Tangent:
    return compute_tangent(plate(), bent_plate())


@cache
def rest_tangent() -> Tangent:
    return compute_tangent(plate(), plate().rest())


def largest(matrix: csr_matrix) -> float:
    return float(abs(matrix).max()) if matrix.nnz else 0.0


@pytest.mark.parametrize("piece", PIECES)
def test_every_piece_is_symmetric_and_not_empty(piece: str) -> None:
    matrix = getattr(tangent(), piece)
    assert largest(matrix) > 0.0
    assert largest(matrix - matrix.T) <= 1e-12 * largest(matrix)


def test_the_sum_is_the_derivative_of_equilibrium() -> None:
    structure, state, pieces = plate(), bent_plate(), tangent()
    forms = structure.forms
    forms.set_loading(state.loading)
    load = forms.linearise(forms.pressure_terms(), state.unknowns)
    exact = pieces.elastic + pieces.film + load + pieces.spin
    n, free = forms.n_displacement, pieces.free
    generator = np.random.default_rng(5)

    def unbalance(x: FloatArray) -> FloatArray:
        moved = replace(state, displacement=x[:n], film_pressure=x[n:])
        return structure.internal_force(moved) - structure.external_force(moved)

    for unknowns, step in ((slice(0, n), 1e-7), (slice(n, None), 1e2)):
        direction = np.zeros(forms.ndof)
        direction[unknowns] = np.where(free, generator.standard_normal(forms.ndof), 0)[unknowns]
        x = state.unknowns
        difference = unbalance(x + step * direction) - unbalance(x - step * direction)
        expected = exact @ direction
        error = np.linalg.norm((difference / (2 * step) - expected)[free])
        assert error < 1e-7 * np.linalg.norm(expected[free])


def test_load_stiffness_is_the_symmetric_part_and_the_rest_is_reported() -> None:
    structure, state, pieces = plate(), bent_plate(), tangent()
    structure.forms.set_loading(state.loading)
    whole = structure.forms.linearise(structure.forms.pressure_terms(), state.unknowns)
    assert largest(pieces.load - 0.5 * (whole + whole.T)) <= 1e-12 * largest(whole)
    assert 0.0 < pieces.dropped_load < 1.0


def test_a_uniform_pressure_has_a_symmetric_load_stiffness() -> None:
    structure = plate()
    n = len(structure.basis.points)
    state = structure.solve(np.full(n, 1e5))
    assert compute_tangent(structure, state).dropped_load < 1e-10


def test_sums_are_made_of_the_pieces() -> None:
    t = tangent()
    solid = t.elastic + t.film
    assert largest(t.stiffness("paper") - solid) <= 1e-15 * largest(solid)
    assert largest(t.stiffness("full") - solid - t.load - t.spin) <= 1e-15 * largest(solid)
    assert largest(t.loss("paper") - 0.21 * t.film) <= 1e-15 * largest(t.film)
    assert largest(t.loss() - 0.21 * t.film_isochoric_material) <= 1e-15 * largest(t.film)
    with pytest.raises(ValueError, match="'whole' is neither 'full' nor 'paper'"):
        t.stiffness("whole")
    with pytest.raises(ValueError, match="'all' is neither 'isochoric' nor 'paper'"):
        t.loss("all")


def test_mass_knows_the_weight_of_both_materials() -> None:
    structure, t = plate(), tangent()
    nv, n = structure.forms.fem.nv, structure.forms.n_displacement
    rigid = np.zeros(structure.forms.ndof)
    rigid[n // 3 : n // 3 + nv] = 1.0
    layers = compute_tangent(structure, structure.rest()).mass
    volume_film = 0.0012 * 0.1 * 0.3
    volume = 0.1 * 0.01 * 0.5
    expected = 1500 * (volume - volume_film) + 1400 * volume_film
    assert rigid @ (t.mass @ rigid) == pytest.approx(expected, rel=2e-3)
    assert largest(t.mass - layers) == 0.0  # it is that of C0
    assert rigid @ (t.spin @ rigid) == pytest.approx(-400.0 * (rigid @ (t.mass @ rigid)))
    along = np.zeros_like(rigid)
    along[:nv] = 1.0
    assert along @ (t.spin @ along) == 0.0


def test_at_rest_the_isochoric_part_is_the_films_displacement_block() -> None:
    t, n = rest_tangent(), plate().forms.n_displacement
    displacement_block = t.film[:n][:, :n]
    isochoric = t.film_isochoric_material
    assert largest(displacement_block - isochoric[:n][:, :n]) <= 1e-12 * largest(isochoric)
    assert largest(isochoric[n:]) == 0.0
    assert largest(t.load) == 0.0


def test_isochoric_loss_is_never_negative() -> None:
    loss = tangent().loss()
    vectors = np.random.default_rng(8).standard_normal((plate().forms.ndof, 20))
    powers = np.einsum("ik,ik->k", vectors, loss @ vectors)
    assert powers.min() > 0.0


def test_rigid_rotation_stores_no_isochoric_energy_at_rest() -> None:
    structure, t = plate(), rest_tangent()
    spin = structure.basis.points @ np.array([[0, 1, 2], [-1, 0, 3], [-2, -3, 0]])
    turned = structure.basis.to_dofs(spin.astype(float))
    rotation = np.append(turned, np.zeros(structure.forms.n_pressure))
    stretched = np.abs(t.film_isochoric_material) @ np.abs(rotation)
    force = t.film_isochoric_material @ rotation
    assert np.abs(force).max() < 1e-12 * stretched.max()


# -- uniform pressure -----------------------------------------------------------------------------


@cache
def sandwich(pressure: float) -> Tangent:
    """A slender clamped plate with a film, under a uniform pressure on all wetted faces."""
    structure = _sandwich()
    state = structure.solve(np.full(len(structure.basis.points), pressure))
    return compute_tangent(structure, state)


@cache
def _sandwich() -> Structure:
    mesh = box_mesh(
        np.linspace(-0.03, 0.03, 4), np.array([0.0, 0.003, 0.0035, 0.0065]),
        np.linspace(0.0, 0.6, 13),
        in_film=lambda c: (abs(c[:, 1] - 0.00325) < 1e-3) & (abs(c[:, 0]) < 0.02) & (c[:, 2] > 0.1),
    )  # fmt: skip
    materials = {
        "blade": find_material("aluminium-paper"),
        "film": find_material("viscoelastic-paper"),
    }
    return Structure(mesh, materials, wetted=SURFACE)


def test_a_uniform_pressure_leaves_the_frequencies_unchanged() -> None:
    free = dry_modes(sandwich(0.0), 6)
    pressed = dry_modes(sandwich(1e6), 6)
    assert pressed.omega == pytest.approx(free.omega, rel=1e-4)
    # what is left is the law's own change of modulus, of order p / E, so it grows like p
    deep = dry_modes(sandwich(1e7), 6)
    assert deep.omega / free.omega - 1 == pytest.approx(10 * (pressed.omega / free.omega - 1), 0.02)
    assert deep.omega == pytest.approx(free.omega, rel=1e-3)


def test_without_the_load_stiffness_it_would_seem_to_buckle() -> None:
    assert dry_modes(sandwich(1e6), 3, "paper").squares[0] < 0.0


def test_a_uniform_pressure_leaves_the_modal_loss_unchanged() -> None:
    free, pressed = dry_modes(sandwich(0.0), 6), dry_modes(sandwich(1e6), 6)
    before = free.loss_factors(sandwich(0.0), "isochoric")
    after = pressed.loss_factors(sandwich(1e6), "isochoric")
    # the film thins by p / K = 4.5e-4, since the metal holds its sides
    assert after == pytest.approx(before, rel=2e-3)
    # the paper's form counts film pressure and rotation as if they lost energy
    paper = pressed.loss_factors(sandwich(1e6), "paper")
    assert np.abs(paper / before - 1).max() > 1.0


def test_a_body_of_film_alone_keeps_its_loss_at_depth() -> None:
    planes = np.linspace(0.0, 1.0, 3)
    mesh = box_mesh(
        0.2 * planes, 0.1 * planes, planes, in_film=lambda c: np.ones(len(c), dtype=bool)
    )
    structure = Structure(mesh, {"film": find_material("viscoelastic-paper")}, wetted=SURFACE)
    losses = []
    for pressure in (0.0, 1e6):
        state = structure.solve(np.full(len(structure.basis.points), pressure))
        t = compute_tangent(structure, state)
        losses.append(dry_modes(t, 4).loss_factors(t, "isochoric"))
    assert losses[0] == pytest.approx(0.21, rel=1e-3)
    assert losses[1] == pytest.approx(0.21, rel=1e-3)


def test_a_beam_without_film_has_no_loss() -> None:
    beam = Beam(cells=3)
    structure = beam.structure()
    t = compute_tangent(structure, structure.rest())
    assert t.loss().nnz == 0
    assert t.loss("paper").shape == t.mass.shape


# -- pieces by name -------------------------------------------------------------------------------


def whole(form: str) -> csr_matrix:
    """Second variation of the energy of a part of the bent plate, assembled at once."""
    forms, state = plate().forms, bent_plate()
    terms = {"elastic": forms.elastic_terms(), "film": forms.mixed_terms()}[form]
    return forms.linearise(terms, state.unknowns)


@pytest.mark.parametrize(("form", "names"), [("elastic", ELASTIC), ("film", FILM)])
def test_pieces_add_up_to_the_second_variation_of_the_energy(
    form: str, names: tuple[str, ...]
) -> None:
    exact = whole(form)
    assert largest(tangent().sum(names) - exact) <= 1e-11 * largest(exact)
    assert all(largest(tangent().pieces[name]) > 0.0 for name in names)


def test_a_name_that_is_no_piece_is_refused() -> None:
    with pytest.raises(ValueError, match="no piece 'rubber' of the tangent; it has elastic_mat"):
        tangent().sum(["rubber"])


def test_material_pieces_store_no_negative_energy() -> None:
    vectors = np.random.default_rng(8).standard_normal((plate().forms.ndof, 10))
    for name in ("elastic_material", "film_isochoric_material"):
        matrix = tangent().pieces[name]
        assert np.einsum("ik,ik->k", vectors, matrix @ vectors).min() > 0.0


def test_geometric_stiffness_is_the_work_of_the_stress_on_second_order_strain() -> None:
    forms, state = plate().forms, bent_plate()
    u, v = forms.X.TnT()[0][0], forms.X.TnT()[1][0]
    F = ngs.Id(3) + ngs.Grad(forms.displacement(state.displacement))
    E = (0.5 * (F.trans * F - ngs.Id(3))).MakeVariable()
    stress = forms.elastic["blade"].energy_of_strain(E).Diff(E)
    stress = 0.5 * (stress + stress.trans)  # the energy is differentiated by all nine components
    term = ngs.InnerProduct(ngs.Grad(u) * stress, ngs.Grad(v)) * ngs.dx("blade")
    form = forms.form([term])
    form.Assemble()
    exact, piece = csr_of(form), tangent().pieces["elastic_geometric"]
    material = tangent().pieces["elastic_material"]
    assert largest(piece - exact) <= 1e-13 * largest(material)
    assert largest(piece - exact) <= 1e-9 * largest(exact)


def test_shape_and_stress_can_be_taken_alone() -> None:
    structure, state = plate(), bent_plate()
    shape = compute_tangent(structure, state, prestress=False)
    stress = compute_tangent(structure, state, shape=False)
    neither = compute_tangent(structure, state, shape=False, prestress=False)
    both, rest = tangent(), rest_tangent()
    assert largest(neither.stiffness() - rest.stiffness()) <= 1e-12 * largest(rest.stiffness())
    for name in ("elastic_material", "film_isochoric_material", "film_constraint"):
        assert largest(shape.pieces[name] - both.pieces[name]) == 0.0
        assert largest(stress.pieces[name] - rest.pieces[name]) == 0.0
        assert largest(shape.pieces[name] - rest.pieces[name]) > 0.0
    for name in ("elastic_geometric", "film_geometric"):
        assert largest(shape.pieces[name]) == 0.0
        # the material stiffness is what its rounding scales with
        size = largest(both.pieces["elastic_material"])
        assert largest(stress.pieces[name] - both.pieces[name]) <= 1e-12 * size
    assert largest(shape.load) == largest(shape.spin) == largest(shape.pieces["film_pressure"]) == 0
    assert largest(stress.load) > 0.0
    # a bent plate under lift: each of the two moves the frequencies by itself
    squares = [dry_modes(t, 2).squares for t in (rest, shape, stress, both)]
    for changed in squares[1:]:
        assert np.abs(changed / squares[0] - 1.0).max() > 1e-4


def test_each_material_with_a_loss_factor_has_its_own_loss() -> None:
    mesh = plate_mesh()
    metal = replace(find_material("aluminium-paper"), loss_factor=0.01)
    film = find_material("viscoelastic-paper")
    structure = Structure(mesh, {"blade": metal, "film": film}, wetted=SURFACE)
    t = compute_tangent(structure, structure.rest())
    losses = t.losses()
    assert set(losses) == {"blade", "film"}
    assert largest(losses["blade"] - 0.01 * t.pieces["elastic_material"]) == 0.0
    assert largest(losses["film"] - t.loss()) == 0.0
    assert largest(t.losses("paper")["film"] - t.loss("paper")) == 0.0
    assert set(tangent().losses()) == {"film"}


def test_a_large_dropped_part_is_noticed() -> None:
    assert tangent().notices == ()
    large = replace(tangent(), dropped_load=0.9)
    assert "skew part of the load stiffness" in str(large.notices[0])
    assert large.notices[0].value == 0.9
