# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws the conventions page: axes, section, planform, ply angle, normals (SVG in docs/_static).

python tools/draw_conventions.py [--format png] [--out DIRECTORY]
"""

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle, Polygon, Rectangle

from quietblade.geometry import section_family

OUT = Path(__file__).resolve().parent.parent / "docs" / "_static"
INK, WATER, BLADE, FILM, FORCE = "#24292f", "#0b6fa4", "#d9dee3", "#c2703d", "#a3262a"
Point = tuple[float, float]


def canvas(width: float, height: float) -> tuple[Figure, Axes]:
    """Empty drawing of equal scales, size in inches."""
    figure = Figure(figsize=(width, height), layout="tight")
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    axes.axis("off")
    return figure, axes


def arrow(axes: Axes, tail: Point, head: Point, color: str = INK, width: float = 1.4) -> None:
    """Straight arrow from tail to head."""
    axes.annotate(
        "",
        head,
        tail,
        arrowprops={"arrowstyle": "-|>", "color": color, "lw": width, "shrinkA": 0, "shrinkB": 0},
    )


def label(axes: Axes, at: Point, text: str, color: str = INK, align: str = "center") -> None:
    """Text at a point."""
    axes.text(*at, text, color=color, ha=align, va="center", fontsize=10)


def turn(axes: Axes, centre: Point, size: float, start: float, stop: float, color: str) -> None:
    """Circular arc with an arrow head at its end, angles in degrees, counter-clockwise."""
    axes.add_patch(Arc(centre, 2 * size, 2 * size, theta1=start, theta2=stop, color=color, lw=1.3))
    end, before = np.radians(stop), np.radians(stop - 4)
    tip = (centre[0] + size * np.cos(end), centre[1] + size * np.sin(end))
    tail = (centre[0] + size * np.cos(before), centre[1] + size * np.sin(before))
    arrow(axes, tail, tip, color, 1.3)


def dimension(axes: Axes, start: Point, stop: Point, text: str, offset: Point) -> None:
    """Dimension line with its text in the middle."""
    style = {"arrowstyle": "<->", "color": INK, "lw": 0.9, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", stop, start, arrowprops=style)
    middle = (0.5 * (start[0] + stop[0]) + offset[0], 0.5 * (start[1] + stop[1]) + offset[1])
    label(axes, middle, text)


def blade_axes() -> Figure:
    """Blade seen along +y: rotor axis, span, inflow and rotation."""
    figure, axes = canvas(6.2, 4.6)
    axes.add_patch(Rectangle((-0.75, -0.2), 1.6, 0.4, facecolor="#eef1f4", edgecolor=INK, lw=1))
    corners = [(-0.125, 0.2), (0.125, 0.2), (0.0375, 1.2), (-0.0375, 1.2)]
    axes.add_patch(Polygon(corners, facecolor=BLADE, edgecolor=INK, lw=1.2))
    arrow(axes, (0, 0), (1.25, 0))
    label(axes, (1.31, 0), "x")
    arrow(axes, (0, 0), (0, 1.45))
    label(axes, (0, 1.51), "z")
    axes.add_patch(Circle((0, 0), 0.035, facecolor="white", edgecolor=INK, lw=1.2))
    for slope in (1, -1):
        axes.plot([-0.025, 0.025], [-0.025 * slope, 0.025 * slope], color=INK, lw=1.2)
    label(axes, (-0.09, -0.09), "y")
    for height in (0.35, 0.7, 1.05):
        arrow(axes, (-1.15, height), (-0.75, height), WATER, 1.8)
    label(axes, (-0.95, 1.17), "V", WATER)
    label(axes, (-0.95, 0.23), "water", WATER)
    arrow(axes, (0.45, -0.36), (0.8, -0.36), FORCE, 1.8)
    label(axes, (0.84, -0.36), r"rotation vector  $\omega_p\,\mathbf{e}_x$", FORCE, "left")
    dimension(axes, (0.3, 0), (0.3, 0.2), "hub radius", (0.24, 0))
    dimension(axes, (0.3, 0.2), (0.3, 1.2), "span", (0.13, 0.0))
    label(axes, (-0.2, 0.27), "root", align="right")
    label(axes, (-0.1, 1.2), "tip", align="right")
    label(axes, (0.62, 1.05), r"$z = $ hub radius $+\ s\,\cdot$ span", align="left")
    label(axes, (0.62, 0.9), r"$s = 0$ root,  $s = 1$ tip", align="left")
    label(axes, (-0.72, -0.3), "hub, rotor axis", align="left")
    label(axes, (0.62, 0.62), "y points away from the reader;", align="left")
    label(axes, (0.62, 0.5), "the blade moves towards the reader", align="left")
    axes.set_xlim(-1.25, 2.0)
    axes.set_ylim(-0.5, 1.6)
    return figure


def section() -> Figure:
    """Section seen from the tip: chord, normal, blade angle, incidence, lift."""
    figure, axes = canvas(6.4, 4.6)
    theta, inflow = np.radians(14.0), np.radians(16.0)
    t, n = np.array([np.cos(theta), -np.sin(theta)]), np.array([np.sin(theta), np.cos(theta)])
    contour = section_family("naca-4").contour(0.12, 0.03, 0.004, 121)
    placed = 2.0 * ((contour[:, :1] - 0.5) * t + contour[:, 1:] * n)
    axes.add_patch(Polygon(placed, facecolor=BLADE, edgecolor=INK, lw=1.2))
    nose, edge = -1.0 * t, 1.0 * t
    axes.plot(
        *zip(nose - 0.35 * t, edge + 0.75 * t, strict=True), color=INK, lw=0.8, ls=(0, (6, 3))
    )
    arrow(axes, tuple(edge), tuple(edge + 0.6 * t))
    label(axes, tuple(edge + 0.68 * t + 0.1 * n), r"$\mathbf{t}$")
    arrow(axes, (0.0, 0.0), tuple(0.75 * n))
    label(axes, tuple(0.84 * n), r"$\mathbf{n}_s$")
    label(axes, tuple(0.3 * t + 0.3 * n), "upper side", align="left")
    label(axes, tuple(nose + 0.3 * n - 0.25 * t), "leading edge")
    label(axes, tuple(edge - 0.2 * n), "trailing edge")

    w = np.array([np.cos(inflow), np.sin(inflow)])
    tail = nose - 1.3 * w
    arrow(axes, tuple(tail), tuple(nose), WATER, 2.0)
    label(axes, tuple(tail + 0.42 * w + np.array([-0.08, 0.2])), r"$\mathbf{W}$", WATER)
    corner = (float(nose[0]), float(tail[1]))
    arrow(axes, tuple(tail), corner, WATER, 1.1)
    arrow(axes, corner, tuple(nose), WATER, 1.1)
    label(axes, (float(tail[0]) + 0.65, corner[1] - 0.1), r"$V$", WATER)
    label(
        axes, (corner[0] + 0.2, -0.06 + 0.5 * (corner[1] + float(nose[1]))), r"$\omega_p r$", WATER
    )
    axes.plot(*zip(nose, nose + 1.0 * w, strict=True), color=WATER, lw=0.8, ls=(0, (6, 3)))
    lift = np.array([-np.sin(inflow), np.cos(inflow)])
    quarter = nose + 0.5 * t
    arrow(axes, tuple(quarter), tuple(quarter + 1.0 * lift), FORCE, 2.0)
    label(axes, tuple(quarter + 1.08 * lift + np.array([-0.05, 0.0])), "lift", FORCE, "right")
    turn(axes, tuple(nose), 0.85, -14.0, 16.0, FORCE)
    label(axes, tuple(nose + np.array([0.93, 0.06])), r"$\alpha$", FORCE)
    axes.plot([edge[0], edge[0] - 1.1], [edge[1], edge[1]], color=INK, lw=0.6)
    axes.add_patch(Arc(tuple(edge), 1.7, 1.7, theta1=166, theta2=180, color=INK, lw=1.2))
    label(axes, tuple(edge + np.array([-0.97, 0.1])), r"$\theta$")

    origin = (1.35, 0.95)
    arrow(axes, origin, (origin[0] + 0.4, origin[1]))
    arrow(axes, origin, (origin[0], origin[1] + 0.4))
    label(axes, (origin[0] + 0.47, origin[1]), "x")
    label(axes, (origin[0], origin[1] + 0.48), "y")
    axes.add_patch(Circle(origin, 0.045, facecolor="white", edgecolor=INK, lw=1.1))
    axes.add_patch(Circle(origin, 0.012, facecolor=INK))
    label(axes, (origin[0] - 0.1, origin[1] - 0.13), "z")
    axes.set_xlim(-2.4, 2.0)
    axes.set_ylim(-0.75, 1.55)
    return figure


def planform() -> Figure:
    """Planform seen on the upper side: fractions of span and chord, film, excited patch."""
    figure, axes = canvas(6.4, 3.2)

    def place(s: float, xi: float) -> Point:
        chord = 0.25 + s * (0.075 - 0.25)
        return s, 1.6 * chord * (xi - 0.5)

    def patch(span: Point, chord: Point, **style: Any) -> None:
        corners = [
            place(span[0], chord[0]),
            place(span[1], chord[0]),
            place(span[1], chord[1]),
            place(span[0], chord[1]),
        ]
        axes.add_patch(Polygon(corners, **style))

    patch((0, 1), (0, 1), facecolor=BLADE, edgecolor=INK, lw=1.2)
    patch((0.05, 0.95), (0.15, 0.80), facecolor=FILM, alpha=0.45, edgecolor=FILM, lw=1)
    patch((0.90, 0.96), (0.30, 0.70), facecolor="none", edgecolor=FORCE, lw=1.4, hatch="////")
    axes.plot([-0.06, 1.08], [0, 0], color=INK, lw=0.8, ls=(0, (8, 3, 2, 3)))
    label(axes, (1.1, 0.0), "reference line", align="left")
    label(axes, (0.45, 0.035), "film (inside)")
    label(axes, (0.93, 0.135), "excited surface", FORCE)
    label(axes, (0.02, -0.235), "leading edge", align="left")
    label(axes, (0.02, 0.235), "trailing edge", align="left")
    dimension(axes, (0, -0.29), (1, -0.29), r"span fraction  $s$", (0, -0.04))
    dimension(axes, (-0.09, -0.2), (-0.09, 0.2), r"$\xi$", (-0.04, 0))
    label(axes, (-0.09, -0.24), "0")
    label(axes, (-0.09, 0.24), "1")
    arrow(axes, (1.12, -0.27), (1.28, -0.27))
    arrow(axes, (1.12, -0.27), (1.12, -0.11))
    label(axes, (1.305, -0.27), "z")
    label(axes, (1.12, -0.08), r"$\mathbf{t}$")
    axes.set_xlim(-0.2, 1.42)
    axes.set_ylim(-0.36, 0.28)
    return figure


def ply() -> Figure:
    """Ply angle seen on the upper side, thickness direction towards the reader."""
    figure, axes = canvas(4.6, 3.4)
    beta = np.radians(35.0)
    axes.add_patch(Rectangle((-1.2, -0.65), 2.9, 1.5, facecolor=BLADE, edgecolor="none"))
    for shift in np.arange(-1.5, 2.0, 0.16):
        line = axes.plot(
            [shift - 2 * np.cos(beta), shift + 2 * np.cos(beta)],
            [-2 * np.sin(beta), 2 * np.sin(beta)],
            color=FILM,
            lw=0.5,
            alpha=0.6,
        )
        line[0].set_clip_path(Rectangle((-1.2, -0.65), 2.9, 1.5, transform=axes.transData))
    arrow(axes, (0, 0), (1.35, 0))
    label(axes, (1.36, -0.13), "span, z")
    arrow(axes, (0, 0), (0, 0.72))
    label(axes, (-0.1, 0.7), r"$\mathbf{t}$")
    one = (1.0 * np.cos(beta), 1.0 * np.sin(beta))
    two = (-0.75 * np.sin(beta), 0.75 * np.cos(beta))
    arrow(axes, (0, 0), one, FORCE, 2.0)
    arrow(axes, (0, 0), two, FORCE, 2.0)
    label(axes, (one[0] + 0.09, one[1] + 0.06), "1", FORCE)
    label(axes, (two[0] - 0.07, two[1] + 0.04), "2", FORCE)
    turn(axes, (0, 0), 0.55, 0, 35, INK)
    label(axes, (0.63, 0.18), r"$\beta$")
    axes.add_patch(Circle((0, 0), 0.06, facecolor="white", edgecolor=FORCE, lw=1.2))
    axes.add_patch(Circle((0, 0), 0.015, facecolor=FORCE))
    label(axes, (-0.02, -0.16), r"$3 = \mathbf{n}_s$", FORCE)
    axes.set_xlim(-1.3, 1.8)
    axes.set_ylim(-0.75, 0.95)
    return figure


def domain() -> Figure:
    """Water sphere around the blade: regions, surfaces and the fluid's normal."""
    figure, axes = canvas(5.6, 4.6)
    axes.add_patch(Circle((0, 0), 1.3, facecolor="#e3f1f8", edgecolor=WATER, lw=1.4))
    corners = [(-0.16, -0.6), (0.16, -0.6), (0.08, 0.7), (-0.08, 0.7)]
    axes.add_patch(Polygon(corners, facecolor=BLADE, edgecolor=INK, lw=1.2))
    axes.plot([0, 0], [-0.5, 0.6], color=FILM, lw=3, solid_capstyle="butt")
    axes.plot([-0.16, 0.16], [-0.6, -0.6], color=INK, lw=3.5)
    axes.plot([0.096, 0.0845], [0.5, 0.63], color=FORCE, lw=4, solid_capstyle="butt")
    for angle in (20, 160, 250):
        a = np.radians(angle)
        foot = (1.3 * np.cos(a), 1.3 * np.sin(a))
        arrow(axes, foot, (1.22 * foot[0], 1.22 * foot[1]), WATER)
    label(axes, (1.6, 0.58), r"$\mathbf{n}$", WATER)
    for height in (-0.25, 0.15):
        half = 0.16 - 0.08 * (height + 0.6) / 1.3
        arrow(axes, (-half - 0.3, height), (-half, height), WATER)
        label(axes, (-half - 0.36, height), r"$\mathbf{n}$", WATER)
    label(axes, (-0.75, 0.6), "water", WATER)
    label(axes, (0.98, -1.0), "outer", WATER, "left")
    for text, at, end in (
        ("film", (0.55, 0.0), (0.01, 0.0)),
        ("blade", (0.55, -0.3), (0.11, -0.3)),
        ("root", (0.45, -0.72), (0.16, -0.61)),
        ("excited", (0.5, 0.62), (0.1, 0.57)),
        ("wet", (-0.5, 0.86), (-0.088, 0.6)),
    ):
        axes.annotate(text, end, at, fontsize=10, arrowprops={"arrowstyle": "-", "lw": 0.7})
    dimension(axes, (0, 0), (1.3 * np.cos(-0.62), 1.3 * np.sin(-0.62)), r"$R$", (0.1, 0.1))
    axes.set_xlim(-1.7, 1.85)
    axes.set_ylim(-1.62, 1.4)
    return figure


DRAWINGS: dict[str, Callable[[], Figure]] = {
    "axes": blade_axes,
    "section": section,
    "planform": planform,
    "ply": ply,
    "domain": domain,
}


def main() -> None:
    """Write every drawing."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--format", default="svg", choices=("svg", "png"))
    parser.add_argument("--out", type=Path, default=OUT)
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    # The same drawing must give the same file, and look alike whatever fonts there are.
    mpl.rcParams.update({"svg.hashsalt": "quietblade", "svg.fonttype": "path"})
    date = {"Date": None} if options.format == "svg" else None
    for name, draw in DRAWINGS.items():
        path = options.out / f"{name}.{options.format}"
        draw().savefig(path, metadata=date, dpi=110, bbox_inches="tight")
        print(path)


if __name__ == "__main__":
    main()
