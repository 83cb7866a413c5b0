# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draw the pictures of docs/tutorial.md from the two runs that the page makes.

    python tools/draw_tutorial.py runs/my-hydrofoil runs/my-hydrofoil-acrylic

Without the folders the runs are made first, in two minutes.
"""

import sys
from pathlib import Path

from matplotlib.figure import Figure

import quietblade as qb
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.view import scenes, spectra

ROOT = Path(__file__).resolve().parents[1]
OUT = ROOT / "docs" / "_static"
RUNS = ROOT / "runs"
DPI = 110
NEAR = (174.0, 196.0)
"""Frequencies [Hz] around B2: in the whole band the peaks of both films look the same."""

ACRYLIC = {"film.material": "acrylic-film-isd112-like", "title": "Acrylic film"}


def make_runs() -> tuple[Path, Path]:
    """Compute both cases of the page, or take what is stored."""
    case = qb.Case.load(ROOT / "cases" / "my-hydrofoil.toml")
    places = RUNS / "my-hydrofoil", RUNS / "my-hydrofoil-acrylic"
    for place, words in zip(places, (case, case.varied(ACRYLIC)), strict=True):
        qb.run(words, place)
    return places


def drawings(folders: list[RunFolder], results: list[Result]) -> dict[str, Figure]:
    """Draw the bent foil, its sound at rest and under load, and that of both films."""
    (folder, _), (result, _) = folders, results
    pictures = scenes.mode_pictures(folder, "C0")
    films = spectra.draw_sound_power_at_rest(results)
    (ax,) = films.axes
    ax.set(xlim=NEAR, ylim=(42.0, 78.0))
    for text in ax.texts:
        text.set_visible(NEAR[0] < text.get_position()[0] < NEAR[1])
    return {
        "tutorial-deformed": scenes.draw_deformed(folder, result, None),
        "tutorial-sound": spectra.draw_sound_power(result, pictures),
        "tutorial-films": films,
    }


def main() -> None:
    """Draw and write the pictures."""
    places = [Path(name) for name in sys.argv[1:3]] or [*make_runs()]
    folders = [RunFolder(place) for place in places]
    for name, figure in drawings(folders, [folder.load() for folder in folders]).items():
        file = OUT / f"{name}.png"
        figure.savefig(file, dpi=DPI)
        print(file.relative_to(ROOT))


if __name__ == "__main__":
    main()
