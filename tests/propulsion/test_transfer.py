# SPDX-License-Identifier: LGPL-2.1-or-later
from dataclasses import replace
from functools import cache

import ngsolve as ngs
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quietblade.errors import GeometryError, MeshError
from quietblade.flow.contours import contour_loads
from quietblade.flow.inflow import BladeFlow, StripInflow, strip_loads
from quietblade.flow.sections import section_frames
from quietblade.geometry import Blade
from quietblade.mesh import INTERFACE, Mesh
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.propulsion.transfer import LoadTransfer, SurfacePressure
from tests.conftest import make_paper_blade, make_twisted_blade
from verification.flow_coupling import work_ratio

STATIONS = np.linspace(0.0, 1.0, 31)
NODES = 61
INFLOW = StripInflow(speed=5.0, rotation=0.58)
PAPER = make_paper_blade()


def patch(points: np.ndarray) -> np.ndarray:
    """Six-node triangles, as points (n, 6, 3), of a grid of nodes (2 I + 1, 2 J + 1, 3)."""
    a = points
    corner = {(i, j): a[i : i + a.shape[0] - 2 : 2, j : j + a.shape[1] - 2 : 2] for i in range(3)
              for j in range(3)}  # fmt: skip
    one = [(0, 0), (2, 0), (2, 2), (1, 0), (2, 1), (1, 1)]
    two = [(0, 0), (2, 2), (0, 2), (1, 1), (1, 2), (0, 1)]
    return np.concatenate(
        [np.stack([corner[k] for k in t], axis=2).reshape(-1, 6, 3) for t in (one, two)]
    )


def cap(section: np.ndarray) -> np.ndarray:
    """Triangles of the face inside a section's contour nodes (2 J + 1, 3), nose in the middle."""
    half = len(section) // 2
    upper, lower = section[: half + 1][::-1], section[half:]  # from the nose
    middle = 0.5 * (upper + lower)
    strips = np.stack([upper, middle, lower], axis=1)
    at_nose = [upper[0], upper[2], lower[2], upper[1], middle[2], lower[1]]
    return np.concatenate([patch(strips[2:]), np.array(at_nose)[None]])


@cache
def blade_surface(
    blade: Blade, along: int = 12, around: int = 16, *, root: bool = False
) -> SurfaceQuadrature:
    """Exact nodes on the blade's faces: ``around`` triangle edges from edge to edge."""
    nodes = blade.section(np.linspace(0.0, 1.0, 2 * along + 1), 2 * around + 1)
    edge = np.stack([nodes[:, 0], 0.5 * (nodes[:, 0] + nodes[:, -1]), nodes[:, -1]], axis=1)
    parts = [patch(nodes), patch(edge), cap(nodes[-1])] + ([cap(nodes[0])] if root else [])
    points = np.concatenate(parts).reshape(-1, 3)
    _, first, number = np.unique(
        np.round(points, 10), axis=0, return_index=True, return_inverse=True
    )
    return SurfaceQuadrature(points[first], number.reshape(-1, 6))


@cache
def transfer(blade: Blade, along: int = 12, around: int = 16) -> LoadTransfer:
    sections = blade.section(STATIONS, NODES)
    return LoadTransfer(blade_surface(blade, along, around), blade, STATIONS, sections)


def arc(points: np.ndarray, radius: float = 1.5, shear: float = 0.1) -> np.ndarray:
    """Bend the blade to a circular arc, sections stay plane; and twist it a little."""
    z = points[..., 2] - 0.2
    twist = shear * z
    x = points[..., 0] * np.cos(twist) + points[..., 1] * np.sin(twist)
    y = points[..., 1] * np.cos(twist) - points[..., 0] * np.sin(twist)
    angle = z / radius
    return np.stack(
        [
            x,
            radius * (1 - np.cos(angle)) + y * np.cos(angle),
            0.2 + radius * np.sin(angle) - y * np.sin(angle),
        ],
        axis=-1,
    )


def carry(
    blade: Blade, displacement: np.ndarray, along: int = 12, around: int = 16
) -> tuple[BladeFlow, SurfacePressure]:
    room = transfer(blade, along, around)
    flow = strip_loads(room.displaced_sections(displacement), INFLOW)
    return flow, room.pressure(flow.sections, flow.loads, displacement)


def integrated(surface: SurfaceQuadrature, points: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Force and moment about the origin of a nodal pressure, six figures."""
    load = -surface.positions(p)[..., None] * surface.area_vectors(points)
    arm = surface.positions(points)
    return np.concatenate([load.sum((0, 1)), np.cross(arm, load).sum((0, 1))])


@pytest.mark.parametrize("blade", [PAPER, make_twisted_blade()], ids=["paper", "twisted"])
def test_closed_blade_surface_has_no_vector_area_and_the_right_volume(blade: Blade) -> None:
    closed = blade_surface(blade, 12, 16, root=True).oriented()
    area = closed.area_vectors(closed.points)
    np.testing.assert_allclose(area.sum(axis=(0, 1)), 0.0, atol=1e-15)
    assert closed.enclosed_volume() == pytest.approx(blade.volume(), rel=2e-3)


def test_sections_at_rest_are_exact() -> None:
    room = transfer(PAPER)
    still = room.displaced_sections(np.zeros_like(room.surface.points))
    np.testing.assert_allclose(still, room.sections, atol=1e-15)


@pytest.mark.parametrize("around", [4, 16])
def test_sections_follow_a_rigid_motion_exactly(around: int) -> None:
    """Also where the surface is far from the exact nose (around = 4)."""
    room = transfer(PAPER, 6, around)
    c, s = np.cos(0.7), np.sin(0.7)
    turn = np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ np.array(
        [[c, s, 0], [-s, c, 0], [0, 0, 1]]
    )
    points = room.surface.points
    moved = room.displaced_sections(points @ turn.T + [0.1, -0.2, 0.3] - points)
    np.testing.assert_allclose(moved, room.sections @ turn.T + [0.1, -0.2, 0.3], atol=2e-14)


def test_sections_follow_bending() -> None:
    room = transfer(PAPER)
    points = room.surface.points
    slope = np.zeros_like(points)
    slope[:, 1] = 0.05 * (points[:, 2] - 0.2)  # linear: exact up to the square of the slope
    exact = room.sections + np.stack(
        [
            0 * room.sections[..., 2],
            0.05 * (room.sections[..., 2] - 0.2),
            0 * room.sections[..., 2],
        ],
        axis=-1,
    )
    np.testing.assert_allclose(room.displaced_sections(slope), exact, atol=5e-7)
    moved = room.displaced_sections(arc(points) - points)
    chord = PAPER.chord(STATIONS)[:, None, None]
    assert np.abs((moved - arc(room.sections)) / chord).max() < 5e-5


@pytest.mark.parametrize("factor", [1.0, -3.0])
def test_constant_and_linear_pressures_are_projected_exactly(factor: float) -> None:
    room = transfer(PAPER)
    values = factor * np.tile((2.0 + STATIONS)[:, None], (1, NODES))
    p = room.projected_pressure(values)
    s = PAPER.locate(room.surface.points)[0]
    np.testing.assert_allclose(p, factor * (2.0 + s), atol=1e-11)


def test_constant_pressure_needs_no_correction() -> None:
    """Sections in a constant pressure feel no load, nor does the closed surface."""
    room = transfer(PAPER)
    none = np.zeros_like(room.surface.points)
    flow = strip_loads(room.sections, INFLOW)
    zero = np.zeros((len(STATIONS), 3))
    uniform = replace(
        flow.loads, pressure=np.full((len(STATIONS), NODES), 1e3), force=zero, moment=zero
    )
    result = room.pressure(flow.sections, uniform, none)
    # the rest is the quadrature of the weights on elements of 83 mm
    np.testing.assert_allclose(result.values, 1e3, rtol=2e-4)
    assert result.correction < 2e-5
    assert result.mismatch < 1e-13


def test_no_pressure_gives_no_pressure() -> None:
    room = transfer(PAPER)
    flow = strip_loads(room.sections, replace(INFLOW, density=0.0))
    result = room.pressure(flow.sections, flow.loads, np.zeros_like(room.surface.points))
    assert np.all(result.values == 0.0)
    assert result.correction == 0.0


def test_faces_between_the_sides_take_the_pressure_between() -> None:
    room = transfer(PAPER)
    upper = np.arange(NODES) < NODES // 2
    sides = np.where(upper, -1.0, 1.0)
    sides[NODES // 2] = 0.0
    p = room.projected_pressure(np.tile(sides, (len(STATIONS), 1)))
    s, xi, eta = PAPER.locate(room.surface.points)
    aft = (xi > 0.3) & (np.abs(eta) > 1e-9)
    np.testing.assert_allclose(p[aft], -np.sign(eta[aft]), atol=0.02)
    between = (np.abs(eta) < 1e-9) & (xi > 0.3)
    tip = between & (xi < 0.99)
    assert tip.sum() >= 8 and np.all(s[tip] > 0.999)
    np.testing.assert_allclose(p[between], 0.0, atol=0.03)


def test_loads_of_the_straight_blade_are_conserved() -> None:
    room = transfer(PAPER)
    flow, result = carry(PAPER, np.zeros_like(room.surface.points))
    total = np.concatenate([flow.total.force, flow.total.moment])
    surface = integrated(room.surface, room.surface.points, result.values)
    size = np.linalg.norm(flow.total.force)
    np.testing.assert_allclose(surface[:2], total[:2], atol=1e-12 * size)
    # moments: about the straight mid-chord line (the z axis) exactly, bending by the weights
    np.testing.assert_allclose(surface[5], total[5], rtol=1e-12)
    np.testing.assert_allclose(surface[3], total[3], rtol=1e-4)
    np.testing.assert_allclose(np.concatenate([result.force, result.moment]), surface, rtol=1e-12)
    assert result.mismatch < 1e-13
    # the rest is the pull of the nose suction and of the tip along the span
    assert result.leftover.sum() == pytest.approx(surface[2], rel=1e-12)
    assert abs(surface[2]) < 0.02 * size


def test_loads_of_the_bent_blade_are_conserved_but_for_the_pull_along_the_span() -> None:
    room = transfer(PAPER)
    points = room.surface.points
    flow, result = carry(PAPER, arc(points) - points)
    surface = integrated(room.surface, arc(points), result.values)
    assert result.mismatch < 1e-13
    # places of the 20 cubic weights: means of three neighbouring knots
    knots = np.concatenate([np.zeros(3), np.linspace(0.0, 1.0, 18), np.ones(3)])
    place = np.array([knots[k + 1 : k + 4].mean() for k in range(20)])
    angle = place / 1.5
    tangent = np.stack([0 * angle, np.sin(angle), np.cos(angle)], axis=1)
    size = np.linalg.norm(flow.total.force)
    np.testing.assert_allclose(
        surface[:3], flow.total.force + result.leftover @ tangent, atol=1e-9 * size
    )
    assert np.abs(result.leftover).sum() < 0.02 * size
    np.testing.assert_allclose(surface[3], flow.total.moment[0], rtol=0.01)


def test_loads_of_a_bent_swept_twisted_blade_are_conserved() -> None:
    blade = make_twisted_blade()
    room = transfer(blade)
    points = room.surface.points
    flow, result = carry(blade, arc(points) - points)
    surface = integrated(room.surface, arc(points), result.values)
    assert result.mismatch < 1e-13
    size = np.linalg.norm(flow.total.force)
    assert np.linalg.norm(surface[:3] - flow.total.force) < 0.05 * size
    np.testing.assert_allclose(surface[3], flow.total.moment[0], rtol=0.05)


def test_loads_are_conserved_on_an_unstructured_mesh(
    coarse_mesh: Mesh, small_film_blade: Blade
) -> None:
    surface = SurfaceQuadrature(coarse_mesh.nodes, coarse_mesh.interface)
    sections = small_film_blade.section(STATIONS, NODES)
    room = LoadTransfer(surface, small_film_blade, STATIONS, sections)
    flow = strip_loads(sections, INFLOW)
    result = room.pressure(flow.sections, flow.loads, np.zeros_like(coarse_mesh.nodes))
    size = np.linalg.norm(flow.total.force)
    np.testing.assert_allclose(result.force[:2], flow.total.force[:2], atol=1e-12 * size)
    np.testing.assert_allclose(result.moment[2], flow.total.moment[2], rtol=1e-12)
    off = np.setdiff1d(np.arange(len(coarse_mesh.nodes)), surface.nodes)
    assert np.all(result.values[off] == 0.0)


def test_finite_elements_integrate_the_same_force(
    coarse_mesh: Mesh, small_film_blade: Blade
) -> None:
    """The follower pressure in NGSolve, on the deformed surface, against the sections' loads."""
    fem, basis, points = coarse_mesh.fem, coarse_mesh.basis, coarse_mesh.nodes
    sections = small_film_blade.section(STATIONS, NODES)
    room = LoadTransfer(
        SurfaceQuadrature(points, coarse_mesh.interface), small_film_blade, STATIONS, sections
    )
    bent = 0.05 * (points[:, 2] - 0.2) ** 2  # of every node, so that no cell turns over
    displacement = np.stack([0 * bent, bent, 0 * bent], axis=1)
    flow = strip_loads(room.displaced_sections(displacement), INFLOW)
    result = room.pressure(flow.sections, flow.loads, displacement)

    pressure = ngs.GridFunction(ngs.H1(fem, order=2))
    pressure.vec.FV().NumPy()[:] = basis.to_dofs(result.values)
    u = ngs.GridFunction(ngs.VectorH1(fem, order=2))
    u.vec.FV().NumPy()[:] = basis.to_dofs(displacement)
    F = ngs.Id(3) + ngs.Grad(u)
    normal = ngs.specialcf.normal(3)
    wet = ngs.ds(INTERFACE, bonus_intorder=6)
    load = -pressure * (ngs.Cof(F) * normal)
    force = np.array([ngs.Integrate(load[i] * wet, fem) for i in range(3)])
    sign = np.sign(force @ result.force)  # the direction of NGSolve's normal is the mesh's affair
    size = np.linalg.norm(flow.total.force)
    np.testing.assert_allclose(sign * force, result.force, atol=1e-9 * size)
    np.testing.assert_allclose(result.force[0], flow.total.force[0], atol=1e-6 * size)


def test_pressure_converges_to_the_sections() -> None:
    corrections = []
    for along, around in ((10, 8), (14, 16), (20, 32)):
        room = transfer(PAPER, along, around)
        _, result = carry(PAPER, np.zeros_like(room.surface.points), along, around)
        corrections.append(result.correction)
    coarse, middle, fine = corrections
    assert fine < 0.4 * middle < 0.4 * coarse
    assert fine < 0.03
    # the pressure at the nodes of the fine surface, away from the nose and the edges
    flow = strip_loads(room.sections, INFLOW)
    s, xi, eta = PAPER.locate(room.surface.points)
    k = np.flatnonzero((np.abs(s - 0.5) < 1e-9) & (xi > 0.05) & (xi < 0.95) & (eta > 0))
    phi = PAPER.family.parameter_at(1, xi[k], 0.06, 0.0, 0.006)
    exact = np.interp(phi, np.linspace(-1, 1, NODES), flow.loads.pressure[15])
    np.testing.assert_allclose(result.values[k], exact, atol=0.02 * flow.loads.dynamic_pressure[15])


def test_orientation_of_the_given_triangles_does_not_matter() -> None:
    surface = blade_surface(PAPER)
    flipped = replace(surface, triangles=surface.triangles[:, [0, 2, 1, 5, 4, 3]])
    sections = PAPER.section(STATIONS, NODES)
    flow, result = carry(PAPER, np.zeros_like(surface.points))
    again = LoadTransfer(flipped, PAPER, STATIONS, sections).pressure(
        flow.sections, flow.loads, np.zeros_like(surface.points)
    )
    np.testing.assert_allclose(again.force, result.force, rtol=1e-12)


def test_errors() -> None:
    surface, sections = blade_surface(PAPER), PAPER.section(STATIONS, NODES)
    with pytest.raises(MeshError, match="root face"):
        LoadTransfer(blade_surface(PAPER, root=True), PAPER, STATIONS, sections)
    with pytest.raises(GeometryError, match="0 to 1"):
        LoadTransfer(surface, PAPER, STATIONS[1:], sections[1:])
    with pytest.raises(GeometryError, match="differ from the blade's by up to 1 mm"):
        LoadTransfer(surface, PAPER, STATIONS, sections + np.array([1e-3, 0.0, 0.0]))
    with pytest.raises(GeometryError, match="60 weight functions with 31 sections"):
        LoadTransfer(surface, PAPER, STATIONS, sections, weights=60)
    moved = replace(surface, points=surface.points + np.array([0.0, 0.02, 0.0]))
    with pytest.raises(MeshError, match="away from the section"):
        LoadTransfer(moved, PAPER, STATIONS, sections)


@pytest.mark.parametrize("blade", [PAPER, make_twisted_blade()], ids=["paper", "twisted"])
def test_errors_of_force_and_moment_are_reported(blade: Blade) -> None:
    points = transfer(blade).surface.points
    for displacement in (np.zeros_like(points), arc(points) - points):
        flow, result = carry(blade, displacement)
        np.testing.assert_allclose(result.force_error, result.force - flow.total.force, atol=1e-9)
        np.testing.assert_allclose(
            result.moment_error, result.moment - flow.total.moment, atol=1e-9
        )
        assert np.linalg.norm(result.moment_error) < 0.03 * np.linalg.norm(flow.total.moment)
    assert np.linalg.norm(result.force_error) > 0.0  # along the bent span, not across it


@settings(max_examples=10, deadline=None)
@given(
    seed=st.integers(0, 2**31),
    level=st.floats(-1e4, 1e4, allow_nan=False),
    size=st.floats(1.0, 1e4),
)
def test_random_smooth_pressures_keep_force_and_moment(
    seed: int, level: float, size: float
) -> None:
    """Whatever the pressure of the sections: loads that they integrate to arrive."""
    room = transfer(PAPER)
    random = np.random.default_rng(seed)
    around = np.linspace(-np.pi, np.pi, NODES)
    waves = sum(
        random.normal() * np.cos(k * around + random.normal()) / (1 + k * k) for k in range(6)
    )
    along = np.polynomial.Polynomial(random.normal(size=4))(STATIONS)
    pressure = level + size * along[:, None] * waves
    frames = section_frames(room.sections)
    flow = INFLOW.loads(frames)
    plane, turn = contour_loads(frames.contours, pressure, np.array([0.5, 0.0]))
    chord = frames.chord[:, None]
    axes = np.stack([frames.chord_direction, frames.normal], axis=1)
    loads = replace(
        flow,
        pressure=pressure,
        force=chord * np.einsum("md,mdx->mx", plane, axes),
        moment=chord**2 * turn[:, None] * frames.tangent,
    )
    result = room.pressure(frames, loads, np.zeros_like(room.surface.points))
    whole = np.sqrt(np.mean(pressure**2)) * 0.16
    assert result.mismatch < 1e-11
    assert np.abs(result.force_error[:2]).max() < 1e-11 * whole
    assert abs(result.moment_error[2]) < 1e-11 * whole


@pytest.mark.parametrize("seed", [11, 12])
def test_work_of_section_wise_rigid_motions_is_conserved(seed: int) -> None:
    assert work_ratio(seed) == pytest.approx(1.0, abs=1e-5)
