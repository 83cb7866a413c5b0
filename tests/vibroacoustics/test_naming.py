# SPDX-License-Identifier: LGPL-2.1-or-later
"""Names of synthetic modes of a tapered beam, and partners between two sets."""

import numpy as np
import pytest
import scipy.sparse as sp

from quietblade.typing import FloatArray
from quietblade.vibroacoustics.matching import assurance, match
from quietblade.vibroacoustics.naming import count_nodes, name_modes

CLAMPED_FREE = (1.875104, 4.694091, 7.854757, 10.995541, 14.137168, 17.278760, 20.420352, 23.561945)


def nodes(count: int = 3000, seed: int = 0) -> tuple[FloatArray, FloatArray]:
    rng = np.random.default_rng(seed)
    return rng.random(count), rng.random(count)


def bending(s: FloatArray, order: int) -> FloatArray:
    """Clamped-free beam shape, larger towards the tip as on a tapered blade."""
    k = CLAMPED_FREE[order - 1]
    ratio = (np.cosh(k) + np.cos(k)) / (np.sinh(k) + np.sin(k))
    shape = np.cosh(k * s) - np.cos(k * s) - ratio * (np.sinh(k * s) - np.sin(k * s))
    return np.asarray(shape * (1.0 + 2.0 * s**2))


def torsion(s: FloatArray, order: int) -> FloatArray:
    return np.asarray(np.sin((order - 0.5) * np.pi * s) * (1.0 + s))


def motion(
    s: FloatArray, xi: FloatArray, *, B: int = 0, T: int = 0, E: int = 0, C: int = 0
) -> FloatArray:
    shape = np.zeros((len(s), 3))
    if B:
        shape[:, 1] += bending(s, B)
    if T:
        shape[:, 1] += 2.0 * (xi - 0.5) * torsion(s, T)
    if E:
        shape[:, 0] += bending(s, E)
    if C:
        shape[:, 1] += 4.0 * ((xi - 0.5) ** 2 - 1.0 / 12.0) * torsion(s, C)
    return shape


@pytest.mark.parametrize("family", ["B", "T", "E", "C"])
def test_pure_modes_are_named_by_their_nodes(family: str) -> None:
    s, xi = nodes()
    orders = range(1, 9 if family in "BE" else 5)
    shapes = np.array([motion(s, xi, **{family: order}) for order in orders])
    naming = name_modes(s, xi, shapes)
    assert naming.name == tuple(f"{family}{order}" for order in orders)
    assert naming.purity.min() > 0.85
    assert naming.shares.sum(axis=1).max() <= 1.0 + 1e-12


def test_a_blades_modes_with_twist_axis_off_the_middle() -> None:
    # torsion about the quarter chord moves the middle too, bending carries some twist
    s, xi = nodes(seed=1)
    rng = np.random.default_rng(2)
    wanted = ["B1", "B2", "E1", "B3", "T1", "B4", "B5", "T2", "B6", "T3", "B7"]
    shapes = []
    for name in wanted:
        shape = motion(s, xi, **{name[0]: int(name[1:])})
        if name[0] == "T":
            shape[:, 1] += 0.3 * torsion(s, int(name[1:]))
        if name[0] == "B":
            shape[:, 1] += 0.4 * (xi - 0.5) * bending(s, int(name[1:]))
        shape += 0.02 * np.abs(shape).max() * rng.standard_normal(shape.shape)
        shapes.append(-3.0 * shape)
    mass = 0.5 + rng.random(len(s))
    naming = name_modes(s, xi, np.array(shapes), mass)
    assert naming.name == tuple(wanted)
    assert naming.purity.min() > 0.6


def test_coupled_pair_gets_two_names() -> None:
    # B5 and T2 mixed so that bending is the larger part of both
    s, xi = nodes(seed=3)
    b, t = motion(s, xi, B=5), motion(s, xi, T=2)
    b, t = b / np.linalg.norm(b), t / np.linalg.norm(t)
    naming = name_modes(s, xi, np.array([0.78 * b + 0.62 * t, 0.74 * b - 0.67 * t]))
    assert naming.shares[0, 0] > naming.shares[0, 1]
    assert naming.shares[1, 0] > naming.shares[1, 1]
    assert naming.name == ("B5", "T2")


def test_two_modes_of_equal_count_are_told_apart() -> None:
    s, xi = nodes(seed=4)
    first = motion(s, xi, B=3)
    second = first + 0.2 * motion(s, xi, E=1)
    naming = name_modes(s, xi, np.array([first, second]))
    assert naming.name[0] == "B3"
    assert len(set(naming.name)) == 2


def test_few_nodes_coarse_mesh_and_none() -> None:
    s, xi = nodes(500, seed=5)
    assert name_modes(s, xi, motion(s, xi, B=3)[None]).name == ("B3",)
    with pytest.raises(ValueError, match="refine the mesh"):
        name_modes(s[:20], xi[:20], motion(s, xi, B=1)[None, :20])
    empty = name_modes(s, xi, np.zeros((0, len(s), 3)))
    assert empty.name == ()
    assert empty.shares.shape == (0, 4)


def test_count_of_nodes_ignores_wiggles() -> None:
    s = np.linspace(0.0, 1.0, 60)
    assert count_nodes(np.sin(np.pi * s) + 0.3) == 0
    assert count_nodes(np.cos(3.0 * np.pi * s)) == 3
    line = s**3 + 0.002 * np.cos(40.0 * s)
    assert count_nodes(line) == 0
    assert count_nodes(np.zeros(5)) == 0


def test_partners_despite_order_and_sign() -> None:
    rng = np.random.default_rng(0)
    n = 60
    mass = sp.csr_matrix(sp.diags(0.5 + rng.random(n)))
    modes, _ = np.linalg.qr(rng.standard_normal((n, 6)))
    a = modes.T / np.sqrt(mass.diagonal())
    b = np.array([-2.0 * a[3], a[0] + 0.1 * a[1], 1j * a[2]])
    found = match(a, b, mass)
    np.testing.assert_array_equal(found.partner, [1, -1, 2, 0, -1, -1])
    np.testing.assert_allclose(found.assurance[[2, 3]], 1.0)
    assert found.assurance[0] == pytest.approx(1.0 / 1.01)
    np.testing.assert_allclose(found.table, assurance(a, b, mass))
    assert match(a, b[:0], mass).partner.tolist() == [-1] * 6
