# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drawings that explain the method: the three configurations, and the order of the computations."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import pyvista as pv
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.results.vtk import field_labels, field_values, read_fields
from quietblade.typing import FloatArray
from quietblade.view.render import FROM_UPSTREAM, View, curved_surface, moved, sharp_edges
from quietblade.view.scenes import solid_of
from quietblade.view.style import BLACK, BLUE, GREY, VERMILION, WIDTH, new_figure, styled

_SHOWN_MODE = 1  # of the wet modes under load: few enough nodes to be seen at this size
_AMPLITUDE = 0.12  # of its largest displacement in the drawing, over the span
_LIGHT = np.array([-0.4, 0.8, 0.45])


@dataclass(frozen=True)
class _Projection:
    """Parallel projection along the direction of a view."""

    view: View

    def __call__(self, points: FloatArray) -> FloatArray:
        """Place in the picture, to the right and upwards, and depth towards the eye."""
        towards = np.array(self.view.place) / np.linalg.norm(self.view.place)
        right = np.cross(self.view.up, towards)
        right /= np.linalg.norm(right)
        return np.asarray(points @ np.stack([right, np.cross(towards, right), towards]).T)


@styled
def draw_configurations(folder: RunFolder) -> Figure:
    """Blade at rest, under load, and vibrating about that, from the run's own fields.

    Parameters
    ----------
    folder : RunFolder
        A run with C1; the vibration that is drawn is one of its wet modes, enlarged.
    """
    rest = solid_of(read_fields(folder.static_fields))
    loaded = moved(rest, field_values(rest, "displacement"))
    modes = solid_of(read_fields(folder.mode_fields("C1")))
    labels = field_labels(modes, "mode_shape")
    shape = np.real(field_values(modes, "mode_shape", labels[min(_SHOWN_MODE, len(labels) - 1)]))
    span = float(np.ptp(rest.points[:, 2]))
    largest = float(np.linalg.norm(shape, axis=1).max())
    # towards the blade at rest, so that it hides neither of the others
    towards = -np.sign(shape[np.argmax(modes.points[:, 2]), 1] or 1.0)
    vibrating = moved(modes, towards * _AMPLITUDE * span / largest * shape)
    project = _Projection(FROM_UPSTREAM)
    figure = new_figure(2.9)
    axes = figure.subplots()
    tips = []
    for grid, color, shade in (
        (rest, "#8A97A3", 0.75), (loaded, BLUE, 0.8), (vibrating, VERMILION, 0.55),
    ):  # fmt: skip
        _draw_solid(axes, project, grid, color, shade)
        tips.append(project(_tip(grid))[:2])
    _name(axes, tips[0], "$C_0$: at rest", "#5A656E", (0.04, -0.02))
    _name(axes, tips[1], "$C_1$: steady load", BLUE, (0.02, 0.04))
    _name(axes, tips[2], "$C_2$: vibrating\n(enlarged)", VERMILION, (0.05, -0.02))
    _arrow(axes, tips[0], tips[1], "$u_1$", "right")
    _arrow(axes, tips[1], tips[2], "$u_2$", "left")
    _draw_axis(axes, project, float(rest.points[:, 2].min()))
    axes.set_aspect("equal")
    axes.margins(0.02)
    right = axes.get_xlim()[1]
    axes.set_xlim(right=right + 0.3)
    axes.set_axis_off()
    return figure


def _draw_solid(
    axes: Axes, project: _Projection, grid: pv.UnstructuredGrid, color: str, opacity: float
) -> None:
    surface = curved_surface(grid).triangulate()
    corners = np.asarray(surface.points)[surface.faces.reshape(-1, 4)[:, 1:]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    placed = project(corners)
    facing = (normals @ np.array(FROM_UPSTREAM.place)) > 0.0
    order = np.argsort(placed[facing].mean(axis=1)[:, 2])
    light = 0.72 + 0.28 * np.abs(normals[facing] @ (_LIGHT / np.linalg.norm(_LIGHT)))
    rgb = np.array([int(color[k : k + 2], 16) for k in (1, 3, 5)]) / 255.0
    shaded = 1.0 - (1.0 - rgb) * opacity
    faces = PolyCollection(
        placed[facing][order][:, :, :2],
        facecolors=np.clip(shaded * light[order][:, None], 0.0, 1.0),
        edgecolors="none",
        antialiaseds=False,
        rasterized=True,
    )
    axes.add_collection(faces)
    axes.update_datalim(placed[..., :2].reshape(-1, 2))
    edges = sharp_edges(grid)
    lines = project(np.asarray(edges.points)[edges.lines.reshape(-1, 3)[:, 1:]])
    axes.plot(lines[:, :, 0].T, lines[:, :, 1].T, color=color, linewidth=0.8)


def _tip(grid: pv.UnstructuredGrid) -> FloatArray:
    """Middle of the nodes that are farthest along the span of the blade at rest."""
    heights = np.asarray(grid.points)[:, 2]
    return np.asarray(grid.points[heights > heights.max() - 0.02 * np.ptp(heights)].mean(axis=0))


def _write(axes: Axes, at: FloatArray, offset: tuple[float, float], text: str, **look: Any) -> None:
    x, y = (at + offset).tolist()
    axes.text(x, y, text, **look)


def _point(axes: Axes, ends: FloatArray, color: str = BLACK) -> None:
    """Arrow from the first point to the second, (2, 2)."""
    (x0, y0), (x1, y1) = ends.tolist()
    axes.add_patch(
        FancyArrowPatch(
            (x0, y0), (x1, y1), arrowstyle="-|>", mutation_scale=9.0, color=color,
            linewidth=1.2, zorder=5,
        )
    )  # fmt: skip


def _name(axes: Axes, at: FloatArray, text: str, color: str, offset: tuple[float, float]) -> None:
    _write(axes, at, offset, text, color=color, fontsize=9.0, va="center", fontweight="bold")


def _arrow(
    axes: Axes, start: FloatArray, end: FloatArray, text: str, side: Literal["left", "right"]
) -> None:
    """Arrow with its name beside it; ``side`` is that of the text which faces the arrow."""
    _point(axes, np.array([start, end]))
    offset = (0.025 if side == "left" else -0.02, 0.01)
    _write(axes, 0.5 * (start + end), offset, text, ha=side, va="center", zorder=6)


def _draw_axis(axes: Axes, project: _Projection, root: float) -> None:
    """Rotor axis below the root, with the stream and the sense of rotation."""
    ends = project(np.array([[-0.35, 0.0, 0.0], [0.35, 0.0, 0.0]]))[:, :2]
    axes.plot(*ends.T, color=GREY, linewidth=0.9, linestyle=(0, (8, 2, 1, 2)))
    arm = project(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, root]]))[:, :2]
    axes.plot(*arm.T, color=GREY, linewidth=0.9)
    stream = project(np.array([[-0.35, 0.0, 0.28], [-0.12, 0.0, 0.28]]))[:, :2]
    _point(axes, stream, GREY)
    _write(axes, stream[0], (0.0, 0.04), r"$v_\infty$", color="#5A656E", ha="center")
    turn = np.linspace(0.6, 2.2, 25) * np.pi
    circle = np.stack([np.zeros_like(turn), 0.07 * np.cos(turn), 0.07 * np.sin(turn)], axis=1)
    curve = project(circle)[:, :2]
    axes.plot(*curve.T, color=GREY, linewidth=1.2)
    _point(axes, curve[-2:], GREY)
    axes.text(float(curve[:, 0].min()) - 0.02, 0.0, r"$\omega_p$", color="#5A656E", ha="right")


# --- the algorithm -----------------------------------------------------------------------------


@styled
def draw_algorithm(results: Mapping[str, Result]) -> Figure:
    """Loop of flow and structure (step 1), and the vibration about its result (step 2).

    Parameters
    ----------
    results : mapping of str to Result
        Runs by name, whose numbers of sections, unknowns and passes stand in the boxes.
    """
    figure = new_figure(3.1)
    axes = figure.subplots()
    axes.set(xlim=(0.0, WIDTH), ylim=(0.0, 2.9))
    axes.set_axis_off()
    first = next(iter(results.values()))
    sections = len(first.steady.sections.span_fraction)
    passes = ", ".join(
        f"{name.lower()} {result.steady.iterations}" for name, result in results.items()
    )
    methods = ", ".join(dict.fromkeys(r.steady.coupling_method for r in results.values()))
    tolerance = first.steady.tolerance
    _title(axes, 0.1, "Step 1: propulsion, steady and nonlinear", BLUE)
    _title(axes, 4.4, "Step 2: vibration, linear", VERMILION)
    start = _box(axes, (0.55, 2.14), (0.9, 0.3), "$u_1^0 = 0$", BLUE)
    flow = _box(
        axes, (2.3, 1.95), (1.75, 0.68),
        f"flow $p_1^k = \\mathcal{{F}}(u_1^{{k-1}})$\n{sections} sections", BLUE,
    )  # fmt: skip
    solid = _box(
        axes, (2.3, 0.95), (1.75, 0.68),
        "structure $u_1^k = \\mathcal{S}(p_1^k)$\nfinite strain", BLUE,
    )  # fmt: skip
    test = _box(
        axes, (0.65, 0.95), (1.1, 0.62), f"converged\nto {tolerance:.0e}?", BLUE, fill="white"
    )
    unknowns = int(first.mesh.unknowns.count.sum())
    about = _box(
        axes, (5.35, 1.95), (1.7, 0.62),
        "tangent, loss and water\nabout $C_0$ and $C_1$", VERMILION,
    )  # fmt: skip
    sound = _box(
        axes, (5.35, 0.95), (1.7, 0.62),
        f"wet modes, sound power\n{unknowns:_} unknowns".replace("_", " "), VERMILION,
    )  # fmt: skip
    left = flow["left"][0]
    _link(axes, start, "right", {"left": (left, start["right"][1])}, "left")
    _link(axes, flow, "bottom", solid, "top")
    _link(axes, solid, "left", test, "right")
    axes.add_patch(
        FancyArrowPatch(
            test["top"], (left, flow["left"][1] - 0.17),
            arrowstyle="-|>", mutation_scale=9.0, color=BLACK, shrinkA=0.0, shrinkB=0.0,
            connectionstyle="angle,angleA=90,angleB=0,rad=4",
        )
    )  # fmt: skip
    axes.text(test["top"][0] + 0.05, 1.45, "no: $k+1$", fontsize=8.0, ha="left")
    low = test["bottom"][1] - 0.24
    axes.plot(
        [test["bottom"][0], test["bottom"][0], 3.75, 3.75],
        [test["bottom"][1], low, low, about["left"][1]],
        color=BLACK, linewidth=1.0,
    )  # fmt: skip
    axes.add_patch(
        FancyArrowPatch(
            (3.75, about["left"][1]), about["left"], arrowstyle="-|>", mutation_scale=9.0,
            color=BLACK, shrinkA=0.0, shrinkB=0.0,
        )
    )  # fmt: skip
    axes.text(2.3, low + 0.05, "yes: shape $u_1$, stress, load", fontsize=8.0, ha="center")
    _link(axes, about, "bottom", sound, "top")
    note = f"Passes here: {passes} ({methods}). The first pass is the chained computation."
    axes.text(0.1, 0.08, note, fontsize=8.0, color="#5A656E")
    return figure


def _title(axes: Axes, x: float, text: str, color: str) -> None:
    axes.text(x, 2.62, text, color=color, fontsize=9.0, fontweight="bold")


def _box(
    axes: Axes,
    middle: tuple[float, float],
    size: tuple[float, float],
    text: str,
    color: str,
    fill: str = "#F4F6F8",
) -> dict[str, tuple[float, float]]:
    """Box with text; returns the middles of its sides."""
    (x, y), (w, h) = middle, size
    axes.add_patch(
        FancyBboxPatch(
            (x - 0.5 * w, y - 0.5 * h), w, h,
            boxstyle="round,pad=0,rounding_size=0.08", edgecolor=color, facecolor=fill,
            linewidth=1.2,
        )
    )  # fmt: skip
    axes.text(x, y, text, ha="center", va="center", fontsize=8.5)
    return {
        "left": (x - 0.5 * w, y), "right": (x + 0.5 * w, y),
        "top": (x, y + 0.5 * h), "bottom": (x, y - 0.5 * h),
    }  # fmt: skip


def _link(
    axes: Axes,
    start: Mapping[str, tuple[float, float]],
    leave: str,
    end: Mapping[str, tuple[float, float]],
    enter: str,
) -> None:
    axes.add_patch(
        FancyArrowPatch(
            start[leave], end[enter], arrowstyle="-|>", mutation_scale=9.0, color=BLACK,
            shrinkA=0.0, shrinkB=0.0,
        )
    )  # fmt: skip
