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
    """Ply angle: seen on the upper side (planform), and in a section seen from the tip."""
    figure, axes = canvas(9.4, 3.6)
    _ply_planform(axes)
    _ply_section(axes)
    axes.set_xlim(-1.75, 5.2)
    axes.set_ylim(-1.35, 1.45)
    return figure


def _ply_planform(axes: Axes) -> None:
    """Swept blade seen on its upper side, thickness direction towards the reader."""
    beta, sweep = np.radians(30.0), np.radians(14.0)
    e = np.array([np.cos(sweep), np.sin(sweep)])  # tangent of the reference line

    def place(s: float, xi: float) -> Point:
        chord = 1.5 - 0.5 * s
        return -1.5 + 3.0 * s, 0.75 * s + chord * (xi - 0.5) - 0.375

    outline = [place(0, 0), place(1, 0), place(1, 1), place(0, 1)]
    blade = Polygon(outline, facecolor=BLADE, edgecolor=INK, lw=1.2)
    axes.add_patch(blade)
    fibre = np.array([np.cos(sweep + beta), np.sin(sweep + beta)])
    across = np.array([-fibre[1], fibre[0]])
    for shift in np.arange(-2.0, 2.0, 0.13):
        line = axes.plot(
            *zip(shift * across - 3 * fibre, shift * across + 3 * fibre, strict=True),
            color=FILM, lw=0.5, alpha=0.6,
        )  # fmt: skip
        line[0].set_clip_path(blade)
    axes.plot(*zip(place(-0.08, 0.5), place(1.1, 0.5), strict=True), color=INK, lw=0.8,
              ls=(0, (8, 3, 2, 3)))  # fmt: skip
    start = np.array(place(0.3, 0.5))
    arrow(axes, tuple(start), tuple(start + 1.25 * e), INK, 1.8)
    label(axes, tuple(start + np.array([1.3, 0.16])), r"$\beta = 0$")
    t = np.array([-e[1], e[0]])
    arrow(axes, tuple(start), tuple(start + 0.6 * t))
    label(axes, tuple(start + 1.02 * t + np.array([-0.12, 0.0])), "chordwise")
    arrow(axes, tuple(start), tuple(start + 1.0 * fibre), FORCE, 2.0)
    label(axes, tuple(start + 1.1 * fibre), "1", FORCE)
    arrow(axes, tuple(start), tuple(start + 0.5 * across), FORCE, 2.0)
    label(axes, tuple(start + 0.6 * across), "2", FORCE)
    turn(axes, tuple(start), 0.62, 14.0, 44.0, FORCE)
    label(axes, tuple(start + 0.72 * np.array([np.cos(0.5), np.sin(0.5)])), r"$\beta$", FORCE)
    axes.add_patch(Circle(tuple(start), 0.06, facecolor="white", edgecolor=FORCE, lw=1.2))
    axes.add_patch(Circle(tuple(start), 0.016, facecolor=FORCE))
    label(axes, tuple(start + np.array([0.03, -0.17])), "3", FORCE)
    label(axes, (0.1, -0.86), "leading edge")
    label(axes, (0.45, 0.86), "trailing edge")
    label(axes, (-1.7, -0.75), "root")
    label(axes, (1.66, 0.1), "tip")
    label(axes, (0.0, -1.22), "planform, seen on the upper side")


def _ply_section(axes: Axes) -> None:
    """Cambered section seen from the tip: normal of the camber surface, and both drapes."""
    family = section_family("naca-4")
    origin, scale = np.array([2.15, -0.25]), 2.9
    contour = family.contour(0.16, 0.08, 0.02, 121)
    axes.add_patch(
        Polygon(origin + scale * contour, facecolor=BLADE, edgecolor=INK, lw=1.2, zorder=1)
    )
    xi = np.linspace(0.0, 1.0, 81)
    height, _ = family.camber_line(xi, 0.08)
    half = family.half_thickness(xi, 0.16, 0.02)
    for share in (1 / 3, 2 / 3):
        for side in (1, -1):
            layer = np.stack([xi, height + side * share * half], axis=-1)
            axes.plot(*(origin + scale * layer).T, color=FILM, lw=0.8, alpha=0.8)
    middle = np.stack([xi, height], axis=-1)
    axes.plot(*(origin + scale * middle).T, color=INK, lw=1.0, ls=(0, (6, 3)))
    at, slope = (float(v) for v in family.camber_line(0.75, 0.08))
    foot = origin + scale * np.array([0.75, at])
    tangent = np.array([1.0, slope]) / np.hypot(1.0, slope)
    normal = np.array([-tangent[1], tangent[0]])
    arrow(axes, tuple(foot), tuple(foot + 0.75 * normal), FORCE, 2.0)
    label(axes, tuple(foot + 0.86 * normal), "3 = surface normal", FORCE)
    arrow(axes, tuple(foot), tuple(foot + 0.6 * tangent), INK, 1.8)
    label(axes, tuple(foot + 0.72 * tangent + np.array([0.12, -0.2])), "chordwise")
    axes.add_patch(Circle(tuple(foot), 0.06, facecolor="white", edgecolor=INK, lw=1.2, zorder=4))
    axes.add_patch(Circle(tuple(foot), 0.016, facecolor=INK, zorder=5))
    for end, text, place in (
        (origin + scale * np.array([0.4, 0.147]), "first ply (symmetric)", (2.9, 0.75)),
        (origin + scale * np.array([0.3, 0.077]), "last ply, camber surface", (2.75, -0.75)),
        (origin + scale * np.array([0.62, 0.004]), "first ply (symmetric and through)",
         (4.0, -0.55)),
    ):  # fmt: skip
        axes.annotate(text, tuple(end), place, fontsize=9, ha="center",
                      arrowprops={"arrowstyle": "-", "lw": 0.7})  # fmt: skip
    label(axes, (3.6, -1.22), r"section, seen from the tip; $\beta = 0$ towards the reader")


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
