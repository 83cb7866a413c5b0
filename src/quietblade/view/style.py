# SPDX-License-Identifier: LGPL-2.1-or-later
"""One look for every figure: legible in print, told apart by more than colour."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import wraps
from typing import Any, ParamSpec

import matplotlib as mpl
import matplotlib.style
from cycler import cycler
from matplotlib.figure import Figure

P = ParamSpec("P")

WIDTH = 6.3
"""Width of a figure in inches: the text width of an A4 page."""

DPI = 200

# Okabe and Ito, "Color universal design" (2008): apart for all common colour visions
BLACK, BLUE, VERMILION, GREEN = "#000000", "#0072B2", "#D55E00", "#009E73"
PURPLE, SKY, GREY = "#CC79A7", "#56B4E9", "#7F7F7F"

DIVERGING, SEQUENTIAL = "PuOr_r", "viridis"


@dataclass(frozen=True)
class Stroke:
    """How a curve is drawn."""

    color: str
    linestyle: str | tuple[int, tuple[float, ...]]
    linewidth: float = 1.4

    def options(self) -> dict[str, Any]:
        """Keyword arguments for ``Axes.plot``."""
        return {"color": self.color, "linestyle": self.linestyle, "linewidth": self.linewidth}


CONFIGURATION: Mapping[str, Stroke] = {
    "C0": Stroke(BLUE, "-", 1.5),
    "C1": Stroke(VERMILION, (0, (4.0, 1.5))),
}
"""At rest solid, under load dashed."""

STATE: Mapping[str, Stroke] = {
    "rigid": Stroke(GREY, "-", 1.1),
    "chained": Stroke(GREEN, (0, (1.2, 1.2))),
    "coupled": Stroke(VERMILION, "-", 1.6),
}

SERIES = (
    Stroke(BLUE, "-", 1.5),
    Stroke(VERMILION, (0, (4.0, 1.5))),
    Stroke(GREEN, (0, (5.0, 1.5, 1.0, 1.5))),
    Stroke(PURPLE, (0, (1.2, 1.2))),
)
"""Several blades in one figure."""

_SETTINGS: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 8.5,
    "axes.titlesize": 9.0,
    "axes.titlelocation": "left",
    "axes.labelsize": 8.5,
    "axes.linewidth": 0.7,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": cycler(color=[BLUE, VERMILION, GREEN, PURPLE, BLACK, SKY]),
    "grid.color": "0.88",
    "grid.linewidth": 0.6,
    "legend.frameon": True,
    "legend.framealpha": 0.9,
    "legend.edgecolor": "none",
    "legend.fontsize": 8.0,
    "legend.handlelength": 2.8,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "xtick.direction": "out",
    "ytick.direction": "out",
    "figure.dpi": DPI,
    "savefig.dpi": DPI,
    "mathtext.default": "regular",
}


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Draw a figure in this style, whatever the user's own settings are."""

    @wraps(draw)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> Figure:
        with mpl.style.context(["default", _SETTINGS]):
            return draw(*args, **kwargs)

    return drawn


def new_figure(height: float, width: float = WIDTH) -> Figure:
    """Empty figure that does not belong to any window; height and width in inches."""
    return Figure(figsize=(width, height), layout="constrained", dpi=DPI)
