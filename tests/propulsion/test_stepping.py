# SPDX-License-Identifier: LGPL-2.1-or-later
from dataclasses import replace

import ngsolve as ngs
import numpy as np
import pytest

from quietblade.materials import IsotropicSVK
from quietblade.propulsion.contact import SurfaceCrossing, crossing_pairs
from quietblade.propulsion.newton import Tolerance
from quietblade.propulsion.structure import Spin, Structure
from quietblade.propulsion.supports import ElasticBed
from quietblade.typing import FloatArray
from tests.propulsion.solid_models import lift, plate
from verification.structure_elastica import _Cantilever
from verification.structure_models import SURFACE, Beam, box_mesh

COLUMN = Beam(length=1.0, height=0.02, cells=6, youngs_modulus=70e9)


def axial(beam: Beam, structure: Structure, force: float) -> FloatArray:
    """Tip load of ``force`` times E I / L^2 along the axis."""
    size = force * beam.bending_stiffness / beam.length**2
    return beam.tip_load(structure, np.array([0.0, 0.0, size]))


def rolled_strip(points: FloatArray, radius: float) -> FloatArray:
    """Displacement of a bar along z that is bent to an arc."""
    angle = points[:, 2] / radius
    moved = points.copy()
    moved[:, 1] = radius - (radius - points[:, 1]) * np.cos(angle)
    moved[:, 2] = (radius - points[:, 1]) * np.sin(angle)
    return moved - points


def nothing(structure: Structure) -> FloatArray:
    return np.zeros(len(structure.basis.points))


def test_a_failure_may_be_returned_with_the_last_good_state() -> None:
    bar = Beam(length=0.3, cells=1)
    structure = bar.structure()
    capacity = bar.youngs_modulus * bar.height**2 / (3 * np.sqrt(3))
    load = bar.tip_load(structure, np.array([0.0, 0.0, -1.3 * capacity]))
    state = structure.solve(nothing(structure), dead_load=load, on_failure="return")
    assert not state.converged
    assert state.fraction == pytest.approx(1 / 1.3, abs=0.01)
    assert state.loading.dead_load == pytest.approx(state.fraction * load)
    assert "not converged" in str(state.notices[0])
    assert state.notices[0].value == state.fraction
    assert not state.steps[-1].converged
    assert state.steps[-1].reason
    # it is an equilibrium of the load that it carries
    again = structure.solve(nothing(structure), state, dead_load=state.loading.dead_load)
    assert again.converged
    assert again.displacement == pytest.approx(state.displacement, rel=2e-2)


def test_buckling_is_seen_by_the_pivots_and_noticed() -> None:
    structure = COLUMN.structure()
    safe = structure.solve(nothing(structure), dead_load=axial(COLUMN, structure, -2.3))
    assert safe.unstable_from is None
    assert safe.notices == ()
    state = structure.solve(nothing(structure), safe, dead_load=axial(COLUMN, structure, -2.7))
    assert state.converged  # straight is an equilibrium still
    assert state.unstable_from == 1.0
    assert [step.negative_pivots for step in state.steps] == [2]
    assert "unstable from 1 of the load" in str(state.notices[0])


def test_film_pressure_does_not_count_as_instability() -> None:
    structure = plate()
    state = structure.solve(lift(structure, 1e3))
    assert structure.forms.n_pressure > 0
    assert [step.negative_pivots for step in state.steps] == [0]


def test_tolerances_may_have_units() -> None:
    structure = plate()
    fine = structure.solve(lift(structure), tolerance=1e-9)
    rough = structure.solve(
        lift(structure), tolerance=Tolerance(1e-15, 1e-15, force=1e-2, motion=1e-5)
    )
    last = rough.newton[-1]
    assert rough.converged
    assert last.force <= 1e-2 < rough.newton[-2].force
    assert rough.newton[-2].motion <= 1e-5
    assert len(rough.newton) < len(fine.newton)
    assert structure.values(rough) == pytest.approx(structure.values(fine), abs=1e-7)


def test_the_table_has_sizes_in_units() -> None:
    structure = plate()
    state = structure.solve(lift(structure))
    first, last = state.newton[0], state.newton[-1]
    n, free = structure.forms.n_displacement, structure.forms.free
    structure.equations.set_loading(state.loading)
    start = structure.equations.external(structure.rest().unknowns)
    assert first.force == pytest.approx(np.linalg.norm(start[:n][free[:n]]), rel=1e-12)
    assert first.motion == pytest.approx(np.linalg.norm(structure.values(state), axis=1).max(), 0.1)
    assert first.energy > 1e3 * state.newton[2].energy
    for word in ("residual", " N ", "increment", " m ", "energy", " J"):
        assert word in str(first)
    assert " m " not in str(last)


def test_the_linear_system_is_the_derivative_of_the_residual_under_all_loads() -> None:
    base = plate()
    structure = Structure(
        base.forms.fem, base.forms.materials, wetted=SURFACE, spin=Spin(20.0), clamped=None,
        support=ElasticBed(1e10), basis=base.basis,
    )  # fmt: skip
    forms, equations = structure.forms, structure.equations
    generator = np.random.default_rng(4)
    dead = generator.standard_normal(forms.n_displacement)
    loading = replace(structure.rest().loading, pressure=lift(structure), dead_load=dead,
                      spin_squared=400.0)  # fmt: skip
    equations.set_loading(loading)
    free, n = forms.free, forms.n_displacement
    x = 1e-4 * generator.standard_normal(forms.ndof) * free
    x[n:] *= 1e8
    equations.begin(x)
    solve = equations.tangent(x)
    for part, step in ((slice(0, n), 1e-8), (slice(n, None), 1e2)):
        direction = np.zeros(forms.ndof)
        direction[part] = (generator.standard_normal(forms.ndof) * free)[part]
        ahead, behind = (equations.residual(x + sign * step * direction)[0] for sign in (1.0, -1.0))
        found = solve((ahead - behind) / (2.0 * step))
        wanted = direction[free]
        scale = np.where(np.arange(len(wanted)) < free[:n].sum(), 1.0, 1e10)
        error = np.linalg.norm((found - wanted) / scale)
        assert error < 1e-5 * np.linalg.norm(wanted / scale)


# -- rough waypoints, and tolerances below rounding ------------------------------------------------


def test_the_last_quarter_of_a_rolled_strip_is_reached() -> None:
    # Waypoints that were far from balance made it fail, however small the step.
    cantilever = _Cantilever("end moment", Beam(cells=60))
    structure = cantilever._structure
    bent = rolled_strip(structure.basis.points, 10.0 / (1.5 * np.pi))
    guess = replace(structure.rest(), displacement=structure.basis.to_dofs(bent))
    start = cantilever.solve(1.5 * np.pi, guess)
    assert len(start.steps) == 1
    state = cantilever.solve(2.0 * np.pi, start)
    assert not all(step.converged for step in state.steps)
    assert {step.fraction for step in state.steps if step.converged} > {1.0}
    tip = cantilever.tip(state)
    assert tip.u == pytest.approx(1.0, abs=5e-4)
    assert tip.w == pytest.approx(0.0, abs=5e-4)


def test_rounding_ends_an_iteration_with_a_notice() -> None:
    beam = Beam(length=1.0, height=0.01, cells=10)
    structure = beam.structure()
    load = beam.tip_load(structure, np.array([0.0, 1e-6 * beam.bending_stiffness, 0.0]))
    state = structure.solve(nothing(structure), dead_load=load, tolerance=1e-12)
    assert state.converged
    assert len(state.steps) == 1
    assert len(state.newton) < 10
    assert 1e-12 < state.newton[-1].residual < 1e-4
    notice = state.notices[0]
    assert "double precision" in notice.message
    assert (notice.value, notice.limit) == (state.newton[-1].residual, 1e-12)
    assert structure.values(state)[:, 1].max() == pytest.approx(1e-6 / 3, rel=1e-2)
    relaxed = structure.solve(nothing(structure), dead_load=load, tolerance=1e-4)
    assert relaxed.notices == ()


def test_an_honest_tolerance_is_reached_without_a_notice() -> None:
    structure = plate()
    state = structure.solve(lift(structure), tolerance=1e-9)
    assert state.newton[-1].residual <= 1e-9
    assert state.notices == ()
    assert structure.equations.rounding(state.unknowns) < 1e-6


# -- surfaces that cross --------------------------------------------------------------------------


def test_triangles_that_cross_are_found_and_neighbours_are_not() -> None:
    points = np.array(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.0], [0.2, 0.2, -1], [0.3, 0.2, 1],
         [0.2, 0.3, 1], [5, 5, 5], [6, 5, 5], [5, 6, 5]], dtype=float,
    )  # fmt: skip
    triangles = np.array([[0, 1, 2], [1, 3, 2], [4, 5, 6], [7, 8, 9]])
    assert crossing_pairs(points, triangles).tolist() == [[0, 2]]
    points[4:7, 2] += 3.0
    assert len(crossing_pairs(points, triangles)) == 0


@pytest.mark.parametrize("tetrahedra", [False, True])
def test_the_surface_of_any_cells_is_made_of_triangles(tetrahedra: bool) -> None:
    unit, law = np.array([0.0, 0.5, 1.0]), IsotropicSVK("solid", 1.0, 1e3, 0.3)
    mesh = box_mesh(unit, unit, unit, tetrahedra=tetrahedra)
    surface = SurfaceCrossing(Structure(mesh, {"blade": law}, wetted=SURFACE).forms)
    corners = surface.points[surface.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert len(surface.triangles) == 5 * 4 * 2
    assert np.linalg.norm(normals, axis=1).sum() / 2 == pytest.approx(5.0)
    assert surface.find(np.zeros(3 * ngs.H1(mesh, order=2).ndof)) is None


def test_a_plate_that_is_folded_onto_itself_is_noticed() -> None:
    beam = Beam(length=1.0, height=0.02, cells=40)
    structure = beam.structure()
    surface = SurfaceCrossing(structure.forms)
    points = structure.basis.points
    area = np.cross(
        *(surface.points[surface.triangles[:, k]] - surface.points[surface.triangles[:, 0]]
          for k in (1, 2)),
    )  # fmt: skip
    assert np.linalg.norm(area, axis=1).sum() / 2 == pytest.approx(4 * 0.02 + 0.02**2)

    def rolled(turns: float) -> FloatArray:
        """Displacement unknowns of a bar bent to an arc of some turns."""
        return structure.basis.to_dofs(rolled_strip(points, 1.0 / (2 * np.pi * turns)))

    assert surface.find(rolled(0.9)) is None
    crossing = surface.find(rolled(1.03))
    assert crossing is not None
    assert crossing.pairs > 0
    # the ends meet
    assert sorted(crossing.places[:, 2]) == pytest.approx([0.0, 1.0], abs=0.1)
    state = replace(structure.rest(), displacement=rolled(1.03))
    notice = structure._crossing(state)[0]
    assert "crosses itself" in str(notice)
