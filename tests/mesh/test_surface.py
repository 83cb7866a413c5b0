# SPDX-License-Identifier: LGPL-2.1-or-later
from math import factorial

import numpy as np
import pytest
from scipy.spatial import cKDTree

from quietblade.errors import MeshError
from quietblade.mesh.surface import (
    SurfaceQuadrature,
    shape_derivatives,
    shape_functions,
    triangle_rule,
)

RNG = np.random.default_rng(20240501)


def grid(nu: int, nv: int, closed: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Parameters (u, v) in [0, 1]^2 of a grid of nodes, and its six-node triangles."""
    columns = 2 * nv if closed else 2 * nv + 1
    u, v = np.meshgrid(np.linspace(0, 1, 2 * nu + 1), np.arange(columns) / (2 * nv), indexing="ij")
    number = np.arange(u.size).reshape(u.shape)

    def node(i: np.ndarray, j: np.ndarray) -> np.ndarray:
        return number[i, j % columns]

    i, j = (2 * a.ravel() for a in np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij"))
    one = [(0, 0), (2, 0), (2, 2), (1, 0), (2, 1), (1, 1)]
    two = [(0, 0), (2, 2), (0, 2), (1, 1), (1, 2), (0, 1)]
    triangles = [np.stack([node(i + a, j + b) for a, b in t], axis=1) for t in (one, two)]
    return np.stack([u.ravel(), v.ravel()], axis=1), np.concatenate(triangles)


def tube(nu: int = 6, nv: int = 12) -> SurfaceQuadrature:
    """Half a torus (bent tube) with two open plane ends."""
    uv, triangles = grid(nu, nv, closed=True)
    along, around = np.pi * uv[:, 0], 2 * np.pi * uv[:, 1]
    ring = 1.0 + 0.3 * np.cos(around)
    points = np.stack([ring * np.cos(along), ring * np.sin(along), 0.3 * np.sin(around)], axis=1)
    return SurfaceQuadrature(points, triangles)


def saddle(n: int) -> SurfaceQuadrature:
    """The surface z = 0.3 x^2 - 0.2 x y + 0.1 y on a slanted grid: exactly quadratic."""
    uv, triangles = grid(n, n)
    x, y = uv[:, 0] + 0.3 * uv[:, 1], uv[:, 1]
    return SurfaceQuadrature(np.stack([x, y, 0.3 * x**2 - 0.2 * x * y + 0.1 * y], 1), triangles)


@pytest.mark.parametrize(("i", "j"), [(i, d - i) for d in range(7) for i in range(d + 1)])
def test_rule_is_exact_to_degree_six(i: int, j: int) -> None:
    uv, weights = triangle_rule()
    exact = factorial(i) * factorial(j) / factorial(i + j + 2)
    assert weights @ (uv[:, 0] ** i * uv[:, 1] ** j) == pytest.approx(exact, rel=1e-13)


def test_shape_derivatives_reproduce_linear_fields() -> None:
    nodes = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0], [0.5, 0.5], [0, 0.5]])
    np.testing.assert_allclose(
        shape_derivatives(RNG.random((9, 2))) @ nodes, np.tile(np.eye(2), (9, 1, 1)), atol=1e-14
    )


def test_pressure_on_a_curved_surface_is_integrated_exactly() -> None:
    """int p n dS and int p x x n dS with n dS = (-f_x, -f_y, 1) dx dy; p quadratic in x, y."""
    surface = saddle(1)
    x, y = surface.points[:, 0], surface.points[:, 1]
    where = surface.positions(surface.points)
    p = surface.positions(1.0 + x * y - y**2)
    got = np.sum(p[..., None] * surface.area_vectors(surface.points), axis=(0, 1))
    moment = np.sum(
        p[..., None] * np.cross(where, surface.area_vectors(surface.points)), axis=(0, 1)
    )
    # reference: Gauss-Legendre, 8 x 8 on the parallelogram x = a + 0.3 b, y = b
    g, w = np.polynomial.legendre.leggauss(8)
    a, b = (q.ravel() for q in np.meshgrid(0.5 + 0.5 * g, 0.5 + 0.5 * g, indexing="ij"))
    ww = 0.25 * np.outer(w, w).ravel()
    X, Y = a + 0.3 * b, b
    P = 1.0 + X * Y - Y**2
    normal = np.stack([-(0.6 * X - 0.2 * Y), 0.2 * X - 0.1, np.ones_like(X)], axis=1)
    Z = 0.3 * X**2 - 0.2 * X * Y + 0.1 * Y
    np.testing.assert_allclose(got, (ww * P) @ normal, rtol=1e-13)
    arm = np.stack([X, Y, Z], axis=1)
    np.testing.assert_allclose(moment, (ww * P) @ np.cross(arm, normal), rtol=1e-12)


def test_torus_area_and_volume_converge() -> None:
    exact_volume, exact_area = np.pi * np.pi * 0.3**2, np.pi * 2 * np.pi * 0.3
    errors = []
    for n in (6, 12):
        surface = tube(n, 2 * n).oriented()
        area = np.linalg.norm(surface.area_vectors(surface.points), axis=-1).sum()
        errors.append([surface.enclosed_volume() / exact_volume - 1, area / exact_area - 1])
        assert surface.nodal_areas().sum() == pytest.approx(area, rel=1e-14)
        assert surface.nodal_areas().min() > 0.0
    coarse, fine = np.abs(errors)
    assert np.all(fine < coarse / 12) and np.all(fine < 1e-3)  # fourth order


def test_orientation_is_restored_after_random_flips() -> None:
    surface = tube()
    mixed = surface.triangles.copy()
    flip = RNG.random(len(mixed)) < 0.5
    mixed[flip] = mixed[flip][:, (0, 2, 1, 5, 4, 3)]
    other = surface.points + np.array([0.0, 0.0, 5.0])  # a second, separate part
    both = SurfaceQuadrature(
        np.concatenate([surface.points, other]),
        np.concatenate([mixed, mixed[::-1] + len(other)]),
    ).oriented()
    single = surface.oriented().enclosed_volume()
    assert single > 0.0
    for part, shift in ((slice(0, len(mixed)), 0.0), (slice(len(mixed), None), 5.0)):
        one = SurfaceQuadrature(both.points - [0, 0, shift], both.triangles[part])
        assert one.enclosed_volume() == pytest.approx(single, rel=1e-12)
        # outward: away from the tube's middle line
        where = one.positions(one.points).reshape(-1, 3)
        middle = where * [1, 1, 0]
        middle /= np.linalg.norm(middle, axis=1)[:, None]
        assert np.all(np.sum((where - middle) * one.area_vectors(one.points).reshape(-1, 3), 1) > 0)


def test_closed_surface_has_no_vector_area() -> None:
    uv, triangles = grid(1, 1)
    square = np.column_stack([uv, 0 * uv[:, 0]]) - 0.5 * np.array([1, 1, 0])
    faces, nodes = [], []
    for k in range(3):
        for sign in (-0.5, 0.5):
            face = np.roll(square + np.array([0, 0, sign]), k, axis=1)
            faces.append(triangles + 9 * len(nodes))
            nodes.append(face + 0.05 * face**2)  # bulged, still closed
    points, inverse = np.unique(np.round(np.concatenate(nodes), 12), axis=0, return_inverse=True)
    cube = SurfaceQuadrature(points, inverse.ravel()[np.concatenate(faces)]).oriented()
    assert cube.enclosed_volume() > 0.9
    np.testing.assert_allclose(cube.area_vectors(cube.points).sum(axis=(0, 1)), 0.0, atol=1e-14)


def test_moebius_strip_and_branching_surface_are_refused() -> None:
    uv, triangles = grid(2, 8)
    strip = triangles.copy()
    number = np.arange(len(uv)).reshape(5, 17)
    swap = {int(number[i, 16]): int(number[4 - i, 0]) for i in range(5)}
    strip = np.vectorize(lambda k: swap.get(int(k), int(k)))(strip)
    points = np.column_stack([uv, uv[:, 0]])
    with pytest.raises(MeshError, match="one side"):
        SurfaceQuadrature(points, strip).oriented()
    with pytest.raises(MeshError, match="more than two triangles"):
        SurfaceQuadrature(
            points, np.concatenate([triangles, triangles[:4], triangles[:4]])
        ).oriented()


def test_closest_points_of_an_exactly_quadratic_surface() -> None:
    surface = saddle(5)
    a, b = RNG.random(400), RNG.random(400)
    x, y = a + 0.3 * b, b
    on = np.stack([x, y, 0.3 * x**2 - 0.2 * x * y + 0.1 * y], axis=1)
    normal = np.stack([-(0.6 * x - 0.2 * y), 0.2 * x - 0.1, np.ones_like(x)], axis=1)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    height = RNG.uniform(-0.02, 0.02, 400)
    inside = np.abs(a - 0.5) + np.abs(b - 0.5) < 0.45  # away from the rim
    found = surface.locate(on + height[:, None] * normal)
    np.testing.assert_allclose(found.distance[inside], np.abs(height[inside]), atol=1e-12)
    foot = np.einsum("pa,pak->pk", found.weights, surface.points[surface.triangles[found.triangle]])
    np.testing.assert_allclose(foot[inside], on[inside], atol=1e-9)


def test_interpolation_reproduces_linear_fields_and_the_surface() -> None:
    surface = tube(8, 16)
    u, v = np.pi * RNG.random(500), 2 * np.pi * RNG.random(500)
    ring = 1 + 0.3 * np.cos(v)
    points = np.stack([ring * np.cos(u), ring * np.sin(u), 0.3 * np.sin(v)], axis=1)
    H = surface.interpolation(points)
    np.testing.assert_allclose(H.sum(axis=1), 1.0, rtol=1e-14)
    np.testing.assert_allclose(H @ surface.points, points, atol=2e-3)  # facets of 22 degrees
    foot = H @ surface.points
    slope, shift = RNG.random((3, 3)), RNG.random(3)
    np.testing.assert_allclose(
        H @ (surface.points @ slope.T + shift), foot @ slope.T + shift, atol=1e-13
    )
    np.testing.assert_allclose(
        surface.interpolation(surface.points) @ surface.points, surface.points, atol=1e-12
    )


def test_closest_points_against_a_fine_sampling() -> None:
    """Also where mid-edge nodes sit at a quarter of the edge and the surface is thin."""
    uv, triangles = grid(3, 3)
    x = np.sin(0.5 * np.pi * uv[:, 0]) ** 2  # clustered at both ends
    top = np.stack([x, uv[:, 1], 0.02 + 0.1 * x * (1 - x)], axis=1)
    thin = SurfaceQuadrature(
        np.concatenate([top, top * [1, 1, -1]]), np.concatenate([triangles, triangles + len(top)])
    )
    points = RNG.random((300, 3)) * [1.2, 1.2, 0.2] - [0.1, 0.1, 0.1]
    a, b = (q.ravel() for q in np.meshgrid(np.linspace(0, 1, 81), np.linspace(0, 1, 81)))
    fine = np.stack([a, b], axis=1)[a + b <= 1 + 1e-12]
    samples = shape_functions(fine) @ thin.points[thin.triangles]
    reached = cKDTree(samples.reshape(-1, 3)).query(points)[0]
    distance = thin.locate(points).distance
    assert np.all(distance <= reached + 1e-12)
    np.testing.assert_allclose(distance, reached, atol=5e-3)


def test_points_beyond_the_rim_go_to_the_rim() -> None:
    uv, triangles = grid(3, 3)
    plate = SurfaceQuadrature(np.column_stack([uv, 0 * uv[:, 0]]), triangles)
    points = np.array([[-0.2, 0.4, 0.1], [1.3, 1.2, 0.0], [0.5, 0.5, -3.0]])
    foot = plate.interpolation(points) @ plate.points
    np.testing.assert_allclose(foot, [[0, 0.4, 0], [1, 1, 0], [0.5, 0.5, 0]], atol=1e-12)


def test_operator_agrees_with_positions() -> None:
    surface = tube()
    field = RNG.random((len(surface.points), 2))
    np.testing.assert_allclose(
        (surface.operator() @ field).reshape(len(surface.triangles), 12, 2),
        surface.positions(field),
        rtol=1e-13,
    )
