# SPDX-License-Identifier: LGPL-2.1-or-later
"""Panel integrals against numerical quadrature and finite differences."""

import numpy as np
import pytest
from scipy.integrate import quad

from quietblade.flow.influence import (
    source_integrals,
    view_panels,
    vortex_gradients,
    vortex_integrals,
)

A, B = np.array([0.3, -0.2]), np.array([0.7, 0.4])
LENGTH = float(np.linalg.norm(B - A))
TANGENT = (B - A) / LENGTH
POINTS = [np.array(p) for p in ([0.1, 0.9], [0.9, -0.3], [0.35, 0.1], [-2.0, -1.0], [0.5, 0.1001])]


@pytest.mark.parametrize("point", POINTS)
def test_vortex_integrals_are_integrals(point: np.ndarray) -> None:
    def log(s: float) -> float:
        return float(np.log(np.linalg.norm(point - A - s * TANGENT)))

    near = float(np.clip((point - A) @ TANGENT, 0.0, LENGTH))
    plain, weighted = vortex_integrals(view_panels(point[None], np.array([A, B])))
    assert plain.item() == pytest.approx(quad(log, 0.0, LENGTH, points=[near])[0], abs=1e-10)
    moment = quad(lambda s: s / LENGTH * log(s), 0.0, LENGTH, points=[near])[0]
    assert weighted.item() == pytest.approx(moment, abs=1e-10)


@pytest.mark.parametrize("fraction", [0.0, 1.0, 0.3])
def test_vortex_integrals_on_the_panel_itself(fraction: float) -> None:
    point = A + fraction * (B - A)
    plain, weighted = vortex_integrals(view_panels(point[None], np.array([A, B])))
    x1, x2 = fraction * LENGTH, (fraction - 1.0) * LENGTH

    def xlogx(x: float) -> float:
        return x * np.log(abs(x)) if x else 0.0

    exact = xlogx(x1) - xlogx(x2) - LENGTH
    square = [0.5 * x * xlogx(x) - 0.25 * x * x for x in (x1, x2)]
    assert plain.item() == pytest.approx(exact, abs=1e-13)
    assert weighted.item() == pytest.approx(
        (x1 * exact - square[0] + square[1]) / LENGTH, abs=1e-13
    )


@pytest.mark.parametrize("point", POINTS)
def test_gradients_are_derivatives(point: np.ndarray) -> None:
    nodes, h = np.array([A, B]), 1e-5
    plain, weighted = vortex_gradients(view_panels(point[None], nodes))
    normal = np.array([-TANGENT[1], TANGENT[0]])
    for k, direction in enumerate((TANGENT, normal)):
        ahead = vortex_integrals(view_panels((point + h * direction)[None], nodes))
        behind = vortex_integrals(view_panels((point - h * direction)[None], nodes))
        for gradient, f1, f0 in zip((plain, weighted), ahead, behind, strict=True):
            assert gradient[k].item() == pytest.approx((f1 - f0).item() / (2.0 * h), abs=1e-6)


def test_source_integral_is_an_integral_up_to_a_constant() -> None:
    left = [A + 0.2 * TANGENT + d * np.array([-TANGENT[1], TANGENT[0]]) for d in (0.1, 0.7, 2.0)]
    values = source_integrals(view_panels(np.array(left), np.array([A, B])))[:, 0]

    def angle(point: np.ndarray) -> float:
        def theta(s: float) -> float:
            arm = point - A - s * TANGENT
            return float(np.arctan2(TANGENT[0] * arm[1] - TANGENT[1] * arm[0], arm @ TANGENT))

        return quad(theta, 0.0, LENGTH)[0]

    exact = np.array([angle(point) for point in left])
    np.testing.assert_allclose(values - values[0], exact - exact[0], atol=1e-10)


def test_a_panel_of_no_length_has_no_influence() -> None:
    point, nodes = np.array([[0.2, 0.1]]), np.array([A, A])
    view = view_panels(point, nodes)
    assert vortex_integrals(view)[0].item() == 0.0
    assert vortex_integrals(view)[1].item() == 0.0
    assert source_integrals(view).item() == 0.0
