# SPDX-License-Identifier: LGPL-2.1-or-later
"""Names of a sphere's modes from motions whose harmonics are known."""

import numpy as np
import pytest

from quietblade.mesh.shell import ShellSpec, build_shell
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.vibroacoustics.degree_naming import HIGHEST, degree_shares, name_by_degree
from quietblade.vibroacoustics.harmonics import solid_harmonics


@pytest.fixture(scope="module")
def surface() -> SurfaceQuadrature:
    mesh = build_shell(ShellSpec(2.0, 0.6, 0.6, 0.9, (0.0, 0.0, 0.0), 3.0))
    nodes, triangles = np.unique(mesh.interface, return_inverse=True)
    return SurfaceQuadrature(mesh.nodes[nodes], triangles.reshape(-1, 6))


def motions(surface: SurfaceQuadrature, degree: int, order: int) -> tuple[np.ndarray, ...]:
    """Motion across the surface, along and around it, (nodes, 3)."""
    outward = surface.points / np.linalg.norm(surface.points, axis=1)[:, None]
    values, gradients = solid_harmonics(outward, degree)
    across = values[order][:, None] * outward
    along = gradients[order].T - degree * across
    return across, along, np.cross(outward, along)


def test_names_and_purity(surface: SurfaceQuadrature) -> None:
    across, along, _ = motions(surface, 2, 1)
    _, _, around = motions(surface, 3, 4)
    other = motions(surface, 2, 3)[0]
    shift = np.broadcast_to([0.0, 1.0, 0.0], surface.points.shape)
    shapes = np.array([shift, across, other + 0.3 * motions(surface, 2, 3)[1], around, along])
    found = name_by_degree(surface, shapes, np.array([True, False, False, False, False]))
    assert found.name == ("rigid.1", "n2.1", "n2.2", "t3.1", "n2.3")
    assert found.character == ("rigid", "degree 2", "degree 2", "torsion 3", "degree 2")
    # in and out, and the part along the surface that has the same degree, are one whole
    np.testing.assert_allclose(found.purity[[0, 1, 3, 4]], 1.0, atol=2e-3)


def test_a_mixture_is_called_so(surface: SurfaceQuadrature) -> None:
    shapes = np.array([motions(surface, 2, 0)[0] + 0.95 * motions(surface, 3, 0)[0]])
    found = name_by_degree(surface, shapes, np.array([False]))
    assert found.character == ("mixed",)
    assert found.purity[0] == pytest.approx(1.0 / (1.0 + 0.95**2), abs=5e-3)


def test_a_shift_and_a_turn_are_of_degree_one(surface: SurfaceQuadrature) -> None:
    shift = np.broadcast_to([1.0, -2.0, 0.5], surface.points.shape)
    turn = np.cross([0.3, 0.4, -1.0], surface.points)
    shares = degree_shares(surface, np.array([shift, turn]))
    assert shares.shape == (2, 2 * (HIGHEST + 1))
    # of a shift a third is across the surface, and the rest along it is of degree one too
    assert shares[0, 1] == pytest.approx(1.0, abs=1e-3)
    assert shares[1, HIGHEST + 2] == pytest.approx(1.0, abs=1e-3)
    assert np.all(shares.sum(axis=1) < 1.0 + 1e-3)


def test_no_modes(surface: SurfaceQuadrature) -> None:
    found = name_by_degree(surface, np.zeros((0, len(surface.points), 3)), np.zeros(0, dtype=bool))
    assert found.name == ()
    assert found.shares.shape == (0, 4)
