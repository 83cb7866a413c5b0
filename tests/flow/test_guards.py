# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every refusal of a contour, by name, with section and remedy."""

from collections.abc import Callable

import numpy as np
import pytest

from quietblade.errors import GeometryError
from quietblade.flow import PanelSections, check_contours
from quietblade.flow.crossing import crossing_panels
from quietblade.flow.guards import (
    ClockwiseContourError,
    ClusteredNodesError,
    ContourError,
    CrossingContourError,
    KinkedContourError,
    LostNodesError,
    OpenContourError,
    TooFewNodesError,
    UnresolvedNoseError,
)
from quietblade.typing import FloatArray
from tests.flow.shapes import naca, turn


def with_nodes(*changes: tuple[int, float, float]) -> FloatArray:
    contour = naca(0.12, edge=0.002)
    for node, x, y in changes:
        contour[node] = (x, y)
    return contour


def self_crossing() -> FloatArray:
    contour = naca(0.12)
    contour[:, 1] += np.where(np.arange(161) < 80, -0.1, 0.0) * np.sin(np.pi * contour[:, 0]) ** 2
    return contour


WRONG: dict[str, Callable[[], FloatArray]] = {
    "clockwise": lambda: naca()[::-1],
    "open contour": lambda: naca()[20:],
    "nearly coincide": lambda: with_nodes((30, *naca(0.12, edge=0.002)[31] + 1e-9)),
    "unresolved nose": lambda: naca(n=41),
    "kink": lambda: with_nodes((35, 0.6, 0.2)),
    "cross": self_crossing,
    "not finite": lambda: with_nodes((35, np.nan, 0.0)),
}

KINDS: dict[str, type[ContourError]] = {
    "clockwise": ClockwiseContourError,
    "open contour": OpenContourError,
    "nearly coincide": ClusteredNodesError,
    "unresolved nose": UnresolvedNoseError,
    "kink": KinkedContourError,
    "cross": CrossingContourError,
    "not finite": LostNodesError,
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_contours_are_refused_by_name(name: str) -> None:
    wrong = WRONG[name]()
    right = naca(0.12, n=len(wrong)) if len(wrong) > 60 else wrong
    with pytest.raises(KINDS[name], match=name) as caught:
        PanelSections(np.array([right, wrong, wrong]))
    first = 1 if len(wrong) > 60 else 0
    assert f"section {first} of 3" in str(caught.value)
    assert "Remedy:" in str(caught.value)


def test_shape_and_number_of_nodes() -> None:
    with pytest.raises(TooFewNodesError, match="19 nodes"):
        check_contours(naca()[None, :19])
    with pytest.raises(GeometryError, match="expected \\(sections, nodes, 2\\)"):
        check_contours(naca())


@pytest.mark.parametrize("edge", [0.0, 0.002])
@pytest.mark.parametrize("n", [81, 161, 321])
@pytest.mark.parametrize("angle", [0.0, 0.3, 1.6, -2.5])
def test_right_contours_pass_in_any_position(edge: float, n: int, angle: float) -> None:
    check_contours(turn(naca(0.12, 0.04, edge, n), angle)[None])


def test_corners_of_a_sharp_edge_may_be_exchanged_by_rounding() -> None:
    contour = naca(0.12)
    contour[[0, -1], 1] = (-1e-16, 1e-16)
    check_contours(contour[None])


def test_crossing_of_polygons() -> None:
    square = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    assert crossing_panels(square) is None
    assert crossing_panels(square[[0, 2, 1, 3]]) == (0, 2)
    star = np.array([[np.cos(a), np.sin(a)] for a in 0.8 * np.pi * np.arange(5)])
    assert crossing_panels(star) is not None
    # A polygon that turns back in x but does not cross: no two graphs, still simple.
    hook = np.array(
        [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 3.0],
            [1.0, 3.0],
            [1.0, 2.0],
            [3.0, 2.0],
            [3.0, 1.0],
            [0.0, 1.0],
        ]
    )
    assert crossing_panels(hook) is None
    hook[5, 1] = -0.5
    assert crossing_panels(hook) is not None


def test_noise_of_a_displacement_field_is_accepted() -> None:
    noise = np.random.default_rng(3).normal(scale=1e-5, size=(161, 2))
    noise[0] = noise[-1] = 0.0
    check_contours((naca() + noise)[None])
