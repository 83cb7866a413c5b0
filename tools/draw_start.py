# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compose the picture of the start page from the gallery: a case file in, shape and sound out.

The gallery is drawn from stored runs by tools/paper_page.py; run this after it.
"""

import re
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from quietblade.typing import AnyArray

DOCS = Path(__file__).resolve().parent.parent / "docs"
OUT = DOCS / "_static" / "start.png"
DPI = 100
INK, BLUE = "#333333", "#0072b2"

CASE = DOCS.parent / "cases" / "paper-composite.toml"
SHOWN = {
    "blade": ("span", "chord", "material"),
    "film": ("thickness", "material"),
    "flow": ("speed", "rotation"),
    "acoustics": ("band",),
}
"""Keys of the case that the picture shows, by table."""


def words() -> str:
    """Copy some lines of the case file, without their comments."""
    text, lines = CASE.read_text(encoding="utf-8"), []
    for table, keys in SHOWN.items():
        body = text.partition(f"[{table}]")[2].partition("\n[")[0]
        lines.append(f"[{table}]")
        for key in keys:
            found = re.search(rf"^{key} = (.*?)\s*(#.*)?$", body, re.MULTILINE)
            if found is None:
                raise SystemExit(f"{CASE.name} has no {table}.{key}")
            value = found[1].replace(', interpolation = "linear"', "")
            lines.append(f"{key:9} = {value}")
        lines.append("")
    return "\n".join(lines)


def picture(name: str) -> AnyArray:
    """Read a picture of the gallery, without its white border."""
    image: AnyArray = plt.imread(DOCS / "gallery" / f"{name}.png")[..., :3]
    ink = np.argwhere(image.min(axis=-1) < 0.98)
    (top, left), (bottom, right) = ink.min(axis=0), ink.max(axis=0) + 1
    return image[top:bottom, left:right]


def panel(ax: Axes, number: str, title: str) -> None:
    """Give a panel its heading."""
    ax.set_axis_off()
    ax.set_title(f"{number}  {title}", loc="left", fontsize=15, color=BLUE, weight="bold", pad=14)


def main() -> None:
    """Draw and write the picture."""
    figure, axes = plt.subplots(
        1, 3, figsize=(19.2, 6.2), width_ratios=[4.6, 6.9, 6.9], layout="constrained"
    )
    figure.get_layout_engine().set(w_pad=0.25, h_pad=0.1)
    panel(axes[0], "1", "Say what the blade is")
    axes[0].text(0.0, 0.97, words(), va="top", family="monospace", fontsize=11.5, color=INK)
    panel(axes[1], "2", "See how it bends under its own lift")
    axes[1].imshow(picture("figure-4"))
    panel(axes[2], "3", "Know how it rings, at rest and under load")
    axes[2].imshow(picture("figure-8"))
    for ax in axes[1:]:
        ax.set_anchor("N")
    figure.savefig(OUT, dpi=DPI)
    print(OUT.relative_to(DOCS.parent))


if __name__ == "__main__":
    main()
