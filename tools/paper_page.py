# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write the page of the paper and its pictures from stored runs; no number is typed by hand.

    python -m tools.paper_page [--study runs/paper] [--out docs]

Reads the runs ``BLADE-VARIANT`` of the study, and beside them in ``beyond`` the tables of
`tools.paper_beyond` and the runs of ``cases/paper-beyond.toml``, and in ``../paper-calibration``
what the calibration found.  What is not there is left out of
the page, which says so.
"""

import argparse
import json
import re
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path

from quietblade.results.claims import BLADES
from quietblade.results.files import write_text
from quietblade.view.paper import CAPTIONS, draw_paper_figures
from tools.paper_open import unstated
from tools.paper_runs import PaperRuns, headline
from tools.paper_sections import claims, directions, losses, provenance, steps
from tools.paper_steps import costs, films, shift, water

ROOT = Path(__file__).resolve().parent.parent
_DIGITS = 5
_SECTIONS = (
    claims, unstated, steps, shift, water, losses, directions, costs, films, provenance,
)  # fmt: skip

_HEAD = """# The paper, claim by claim

<!-- Written by tools/paper_page.py from stored runs; change the script, not this page. -->

The two-step paper {cite}`TwoStep` computes the steady deformation of two blades, of aluminium and
of composite, and then the sound of their vibration at rest ($\\mathcal C_0$) and under load
($\\mathcal C_1$). This page repeats the study, says where the results differ, and adds what the
paper does not have. Each number on it comes from the files of the runs;

```sh
make paper        # the study, at its full size
make paper-page   # what goes beyond the paper, and this page
```

makes them and writes the page again.
"""


def main() -> None:
    """Write page, gallery and headline figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--study", type=Path, default=ROOT / "runs" / "paper")
    parser.add_argument("--out", type=Path, default=ROOT / "docs")
    parser.add_argument("--main", default="ours", help="variant that figures and tables show")
    options = parser.parse_args()
    write_page(PaperRuns(options.study, options.main), options.out)


def write_page(runs: PaperRuns, out: Path) -> None:
    """Write ``paper.md``, ``gallery.md``, ``gallery/*.png`` and ``paper.json`` into a folder.

    The pictures go to ``figures`` of the study too, as PDF and PNG.
    """
    pictures = runs.root / "figures"
    parts = [_HEAD, *_figures(runs, pictures)]
    for section in _SECTIONS:
        parts.extend(section(runs, pictures))
    write_text(out / "paper.md", "\n".join(parts).rstrip() + "\n")
    used = re.findall(r"!\[.*?\]\(gallery/(.*?)\)", "\n".join(parts))
    _copy([pictures / name for name in used], out / "gallery")
    write_text(out / "gallery.md", "\n".join(_gallery(used)) + "\n")
    figures = {run: headline(runs.result(run)) for run in runs.names()}
    text = json.dumps(_rounded(figures), indent=1, sort_keys=True)
    write_text(out / "paper.json", text + "\n")


def _figures(runs: PaperRuns, pictures: Path) -> Iterator[str]:
    aluminium, composite = (runs.folder(blade, runs.main) for blade in BLADES)
    files = draw_paper_figures(aluminium, composite, pictures)
    yield "## The figures\n"
    yield "Numbered as in the paper.\n"
    for number, file in files.items():
        yield f"### Figure {number}\n"
        yield f"![Figure {number}](gallery/{file.name})\n"
        yield f"{CAPTIONS[number]}\n"


def _copy(files: list[Path], folder: Path) -> None:
    """Put the pictures of the page into a folder, and no others."""
    for old in folder.glob("*.png"):
        old.unlink()
    folder.mkdir(parents=True, exist_ok=True)
    for file in files:
        shutil.copyfile(file, folder / file.name)


def _gallery(pictures: list[str]) -> Iterator[str]:
    yield "# Gallery\n"
    yield "<!-- Written by tools/paper_page.py. -->\n"
    yield "Pictures of [the paper's study](paper.md), drawn from its runs.\n"
    for name in pictures:
        yield f"![{name.removesuffix('.png')}](gallery/{name})\n"


def _rounded(value: object) -> object:
    if isinstance(value, float):
        return float(f"{value:.{_DIGITS}g}")
    if isinstance(value, Mapping):
        return {key: _rounded(inner) for key, inner in value.items()}
    return value


if __name__ == "__main__":
    main()
