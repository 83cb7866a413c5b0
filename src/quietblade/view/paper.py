# SPDX-License-Identifier: LGPL-2.1-or-later
"""The eight figures of the two-step paper, drawn again from the runs of its two blades."""

from collections.abc import Mapping
from functools import partial
from io import BytesIO
from pathlib import Path

from matplotlib.figure import Figure
from PIL import Image

from quietblade.results.files import replacing
from quietblade.results.model import Result, state
from quietblade.results.store import RunFolder
from quietblade.typing import Progress, silent
from quietblade.view import paper_drawings, scenes, sections, spectra
from quietblade.view.figures import Drawing
from quietblade.view.style import BLUE, GREY, VERMILION, Stroke, new_figure, styled

CAPTIONS: Mapping[str, str] = {
    "1": "The three configurations: at rest (C0), under the steady load (C1), and vibrating about "
    "it (C2).",
    "2": "The iteration between flow and structure, and the vibration that follows.",
    "3": "The blade, its film, and the mesh.",
    "4": "Shear strain of the film and deformation of both blades, on the same scales.",
    "5a": "The mid section over its chord: what is left of the deformation without bending and "
    "twist of the blade.",
    "5b": "The mid section in space.",
    "5c": "Blade angle along the span.",
    "5d": "Lift coefficient along the span: rigid, chained and coupled.",
    "6": "Sound power of both blades at rest, with the modes that make the peaks.",
    "7": "Sound power of the aluminium blade at rest and under load.",
    "8": "Sound power of the composite blade at rest and under load.",
}
"""What each figure of the paper shows, by the paper's number."""

DPI = 110
"""Of the pictures on a page: at the width of a column they are sharp, and small enough to keep."""

_HEAVY = 130_000  # bytes beyond which a picture gets few colours: a third of the size
_COLORS = 160


def draw_paper_figures(
    aluminium: RunFolder, composite: RunFolder, out: Path, progress: Progress = silent
) -> Mapping[str, Path]:
    """Draw the figures of the paper as PNG and PDF.

    Parameters
    ----------
    aluminium, composite : RunFolder
        Finished runs with C0 and C1; nothing is computed.
    out : Path
        Folder of the files ``figure-1.png``, ``figure-1.pdf``, ...
    progress : callable

    Returns
    -------
    mapping of str to Path
        PNG files by the number of the figure.

    Raises
    ------
    ResultError
        A result or one of its fields is missing.
    """
    drawings = paper_drawings_of(aluminium, composite)
    return {
        number: save(draw(), out, f"figure-{number}", progress) for number, draw in drawings.items()
    }


def save(figure: Figure, out: Path, name: str, progress: Progress = silent) -> Path:
    """Write a figure as PDF, and as PNG; returns the PNG."""
    pdf, png = (out / f"{name}.{suffix}" for suffix in ("pdf", "png"))
    with replacing(pdf) as temporary:
        figure.savefig(temporary)
    with BytesIO() as buffer:
        figure.savefig(buffer, format="png", dpi=DPI)
        picture = Image.open(buffer).convert("RGB")
    with replacing(png) as temporary:
        picture.save(temporary, optimize=True)
        if temporary.stat().st_size > _HEAVY:
            picture.quantize(_COLORS, dither=Image.Dither.NONE).save(temporary, optimize=True)
    progress("figures", None, name)
    return png


def paper_drawings_of(aluminium: RunFolder, composite: RunFolder) -> dict[str, Drawing]:
    """Functions that draw the figures, by the paper's number."""
    folders = {"Aluminium": aluminium, "Composite": composite}
    results = {name: folder.load() for name, folder in folders.items()}
    both = list(results.values())
    at_rest = [partial(scenes.mode_pictures, folder, "C0") for folder in folders.values()]
    return {
        "1": lambda: paper_drawings.draw_configurations(composite),
        "2": lambda: paper_drawings.draw_algorithm(results),
        "3": lambda: scenes.draw_mesh(composite),
        "4": lambda: scenes.draw_deformed_blades(folders, results),
        "5a": lambda: sections.draw_normalised_section(both),
        "5b": lambda: sections.draw_mid_section(both),
        "5c": lambda: sections.draw_blade_angle(both),
        "5d": lambda: draw_lift(results),
        "6": lambda: spectra.draw_sound_power_at_rest(both, [draw() for draw in at_rest]),
        "7": lambda: spectra.draw_sound_power(both[0], at_rest[0]()),
        "8": lambda: spectra.draw_sound_power(both[1], at_rest[1]()),
    }


@styled
def draw_lift(results: Mapping[str, Result]) -> Figure:
    """Lift coefficient along the span of several blades: rigid, chained and coupled.

    Parameters
    ----------
    results : mapping of str to Result
        At most two, by the name that the curves get.
    """
    figure = new_figure(3.2)
    axes = figure.subplots()
    first = next(iter(results.values())).steady.sections
    rigid = first.lift_coefficient[state("rigid")]
    axes.plot(first.span_fraction, rigid, color=GREY, linewidth=1.1, label="rigid")
    for (name, result), color in zip(results.items(), (BLUE, VERMILION), strict=False):
        curves = result.steady.sections
        for label, stroke in _PASSES.items():
            axes.plot(
                curves.span_fraction,
                curves.lift_coefficient[state(label)],
                label=f"{name.lower()}, {label}",
                **Stroke(color, *stroke).options(),
            )
    axes.set(
        xlabel="Span fraction $s$ [–]",
        ylabel="Lift coefficient $C_L$ [–]",
        title="Lift coefficient",
        xlim=(0.0, 1.0),
    )
    axes.legend(loc="best")
    return figure


_PASSES: Mapping[str, tuple[str | tuple[int, tuple[float, ...]], float]] = {
    "chained": ((0, (1.2, 1.2)), 1.2),
    "coupled": ("-", 1.6),
}
