# SPDX-License-Identifier: LGPL-2.1-or-later
"""All figures of a run, and those that show several runs together, as files."""

from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from quietblade.results.files import replacing
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.typing import AnyArray, Progress, silent
from quietblade.view import (
    bands,
    bodies,
    directivity,
    far_spectra,
    losses,
    scenes,
    sections,
    spectra,
    transfer,
)
from quietblade.view.campbell import draw_campbell
from quietblade.view.style import DPI

Drawing = Callable[[], Figure]


def draw_figures(
    folder: RunFolder, progress: Progress = silent, formats: Sequence[str] = ("png",)
) -> tuple[Path, ...]:
    """Draw every figure of a run into its folder ``figures``.

    Parameters
    ----------
    folder : RunFolder
        A finished run; its result and its VTU files are read, nothing is computed.
    progress : callable
    formats : sequence of str
        Endings of the files: ``png``, and ``pdf`` or ``svg`` for curves as lines.

    Returns
    -------
    tuple of Path
        The files.

    Raises
    ------
    ResultError
        The result or one of its fields is missing.
    """
    return _save(folder.figures, _drawings(folder, folder.load()), progress, formats)


def draw_joint_figures(
    folders: Sequence[RunFolder],
    out: Path,
    progress: Progress = silent,
    formats: Sequence[str] = ("png",),
) -> tuple[Path, ...]:
    """Draw the figures that compare several runs.

    Parameters
    ----------
    folders : sequence of RunFolder
        At least two finished runs.
    out : Path
        Folder to draw into.
    progress : callable
    formats : sequence of str
        Endings of the files: ``png``, and ``pdf`` or ``svg`` for curves as lines.

    Returns
    -------
    tuple of Path
        The files.
    """
    results = [folder.load() for folder in folders]
    blades = {f: result for f, result in zip(folders, results, strict=True) if result.static}
    strains = [result.steady.max_film_shear_strain for result in blades.values()]
    largest = float(np.nanmax(strains)) if np.any(np.isfinite(strains)) else None
    drawings = _section_drawings(list(blades.values())) if blades else {}
    drawings["sound-power-at-rest"] = lambda: spectra.draw_sound_power_at_rest(results)
    for folder, result in blades.items():
        drawings[f"deformed-{folder.root.resolve().name}"] = _deformed(folder, result, largest)
    return _save(out, drawings, progress, formats)


def _drawings(folder: RunFolder, result: Result) -> Mapping[str, Drawing]:
    drawings = _body(folder) if result.static is None else _steady(folder, result)
    if result.campbell.name:
        drawings["campbell"] = lambda: draw_campbell(result)
    if not result.configurations:
        return drawings
    pictures = cache(partial(scenes.mode_pictures, folder))
    for name in result.configurations:
        drawings[f"mode-shapes-{name}"] = _mode_shapes(result, name, pictures)
    # the pictures above the peaks are those of the first configuration, at rest as a rule
    first = next(iter(result.configurations))
    drawings["sound-power"] = lambda: spectra.draw_sound_power(result, pictures(first))
    drawings["power-paths"] = lambda: spectra.draw_power_paths(result)
    drawings["power-shares"] = lambda: losses.draw_power_shares(result)
    if result.moduli.name:
        drawings["moduli"] = lambda: losses.draw_moduli(result)
    return drawings | _far_field(result) | dict(transfer.drawings(result))


def _body(folder: RunFolder) -> dict[str, Drawing]:
    return {"mesh": lambda: bodies.draw_body_mesh(folder)}


def _steady(folder: RunFolder, result: Result) -> dict[str, Drawing]:
    """Figures of a blade and of its steady load."""
    return {
        "mesh": lambda: scenes.draw_mesh(folder),
        "displacement": lambda: scenes.draw_displacement(folder, result),
        "deformed": _deformed(folder, result, None),
        "stress": lambda: scenes.draw_stress(folder, result),
        **_section_drawings([result]),
        "cavitation": lambda: sections.draw_cavitation(result),
        "convergence": lambda: sections.draw_convergence(result),
    }


def _far_field(result: Result) -> dict[str, Drawing]:
    first = next(iter(result.configurations.values()))
    drawings: dict[str, Drawing] = {"source-level": lambda: spectra.draw_source_level(result)}
    if bands.has_bands(result):
        drawings["bands"] = lambda: bands.draw_bands(result)
    if any(len(c.directivity.frequency) for c in result.configurations.values()):
        for plane in first.directivity.cut:
            drawings[f"directivity-{plane}"] = partial(directivity.draw_polar, result, plane)
        drawings["directivity"] = lambda: directivity.draw_balloons(result)
    drawings["multipoles"] = lambda: far_spectra.draw_multipoles(result)
    drawings["radiation-efficiency"] = lambda: far_spectra.draw_efficiency(result)
    return drawings


def _section_drawings(results: Sequence[Result]) -> dict[str, Drawing]:
    return {
        "mid-section-normalised": lambda: sections.draw_normalised_section(results),
        "mid-section": lambda: sections.draw_mid_section(results),
        "blade-angle": lambda: sections.draw_blade_angle(results),
        "lift-coefficient": lambda: sections.draw_lift_coefficient(results),
    }


def _deformed(folder: RunFolder, result: Result, largest: float | None) -> Drawing:
    return lambda: scenes.draw_deformed(folder, result, largest)


def _mode_shapes(
    result: Result, name: str, pictures: Callable[[str], Mapping[str, AnyArray]]
) -> Drawing:
    return lambda: scenes.draw_mode_shapes(result, name, pictures(name))


def _save(
    out: Path, drawings: Mapping[str, Drawing], progress: Progress, formats: Sequence[str]
) -> tuple[Path, ...]:
    files = []
    for done, (name, draw) in enumerate(drawings.items()):
        progress("figures", done / len(drawings), name)
        figure = draw()
        for kind in formats:
            file = out / f"{name}.{kind}"
            with replacing(file) as temporary:
                figure.savefig(temporary, dpi=DPI)
            files.append(file)
    progress("figures", 1.0, f"{len(files)} files in {out}")
    return tuple(files)
