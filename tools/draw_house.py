# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draw the house: the rooms in their order, from the layers that ``make lint`` checks."""

import re
import tomllib
from pathlib import Path
from textwrap import wrap

from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle

ROOT = Path(__file__).resolve().parent.parent
OUT = ROOT / "docs" / "_static" / "house.svg"
INK, WALL, STEP1, STEP2 = "#333333", "#f3f5f7", "#dcecf7", "#fbe6d8"
LEFT, RIGHT, HEIGHT = 0.0, 10.0, 1.0
OWN = {"propulsion": STEP1, "vibroacoustics": STEP2}


def layers() -> list[list[str]]:
    """Rooms from the roof down, neighbours of one storey together."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    contract = project["tool"]["importlinter"]["contracts"][0]
    return [
        [name.strip().removeprefix("quietblade.") for name in layer.split("|")]
        for layer in contract["layers"]
    ]


def contents() -> dict[str, str]:
    """Return what each room holds, from the table of the architecture page."""
    text = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(\w+)` \| (.*?) \|$", text, re.M)
    return {name: holds.partition(";")[0] for name, holds in rows}


def room(ax: Axes, x: float, y: float, width: float, name: str, holds: str) -> None:
    """Draw one room with its name and what it holds."""
    colour = OWN.get(name, WALL)
    ax.add_patch(Rectangle((x, y), width, HEIGHT, facecolor=colour, edgecolor=INK, linewidth=1.1))
    ax.text(x + 0.15, y + 0.63, name, fontsize=11, weight="bold", color=INK)
    lines = "\n".join(wrap(holds, int(9 * width)))
    ax.text(x + 0.15, y + 0.5, lines, fontsize=7.6, color=INK, va="top", linespacing=1.1)


def main() -> None:
    """Draw and write the picture."""
    rcParams.update(
        {"svg.hashsalt": "quietblade", "svg.fonttype": "none", "font.family": "sans-serif"}
    )
    storeys, holds = layers(), contents()
    top = len(storeys) * HEIGHT
    figure = Figure(figsize=(9.2, 8.4))
    ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    ax.set(xlim=(-0.4, 14.4), ylim=(-1.5, top + 1.5), aspect="equal")
    ax.set_axis_off()
    roof = [(LEFT - 0.3, top), (RIGHT + 0.3, top), (0.5 * (LEFT + RIGHT), top + 1.2)]
    ax.add_patch(Polygon(roof, facecolor="#e6e8eb", edgecolor=INK, linewidth=1.1))
    ax.text(5.0, top + 0.3, "you: terminal, notebook", ha="center", fontsize=9.5, color=INK)
    for number, names in enumerate(storeys):
        width = (RIGHT - LEFT) / len(names)
        for place, name in enumerate(names):
            y = top - (number + 1) * HEIGHT
            room(ax, LEFT + place * width, y, width, name, holds[name])
    ax.add_patch(
        Rectangle((LEFT - 0.2, -1.0), RIGHT + 0.4, 0.9, facecolor="#e6e8eb", edgecolor=INK)
    )
    ax.text(0.15, -0.48, "errors  typing  card", fontsize=11, weight="bold", color=INK)
    ax.text(0.15, -0.82, "ground: every room may stand on it", fontsize=7.6, color=INK)
    study = top - (1 + next(k for k, names in enumerate(storeys) if "study" in names)) * HEIGHT
    room(ax, 11.1, study, 3.1, "case", holds["case"])
    for y in (study + 0.5, top - 0.5 * HEIGHT):
        ax.annotate(
            "", (11.1, study + 0.5), (RIGHT, y), arrowprops={"arrowstyle": "->", "color": INK}
        )
    ax.text(
        11.1, study - 0.4, "only cli and study know\nwhat a case file says", fontsize=8, va="top"
    )
    ax.annotate(
        "",
        (10.6, 0.2),
        (10.6, study - 1.6),
        arrowprops={"arrowstyle": "->", "color": INK, "lw": 1.4},
    )
    ax.text(10.8, 2.3, "imports go\ndown only", fontsize=9, color=INK)
    figure.savefig(OUT, metadata={"Date": None})
    print(OUT.relative_to(ROOT))


if __name__ == "__main__":
    main()
