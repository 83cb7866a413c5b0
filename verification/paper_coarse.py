# SPDX-License-Identifier: LGPL-2.1-or-later
"""Headline figures of the paper's blades on a coarse mesh, against those that were stored.

They guard the page of the paper: what changes them changes the page too.  After a change that is
meant, ``python -m verification.paper_coarse`` stores them anew.
"""

import json
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from quietblade.case import Case
from quietblade.results.claims import BLADES
from quietblade.results.files import write_text
from quietblade.results.store import RunFolder
from quietblade.study.run import run_case
from tools.paper_runs import headline
from verification.registry import check

ROOT = Path(__file__).parents[1]
STORED = Path(__file__).with_suffix(".json")
COARSE = {
    "mesh.size": "42 mm",
    "flow.sections": 41,
    "flow.section_nodes": 121,
    "acoustics.step": "20 Hz",
    "acoustics.points_per_mode": 0,
}

TOLERANCES = {
    "tip_y_m": 0.005,
    "lift_n": 0.005,
    "film_shear_strain": 0.02,
    "frequency_hz": 0.002,
}
"""Relative; a mesher of another version makes another mesh."""

LEVEL = 0.5
"""Absolute tolerance of the levels of peaks [dB]."""

SOURCE = "the same study when the page was written"


@cache
def figures(blade: str) -> dict[str, Any]:
    """Headline figures of a blade on the coarse mesh."""
    case = Case.load(ROOT / "cases" / f"paper-{blade}.toml").varied(COARSE)
    with TemporaryDirectory() as folder:
        return headline(run_case(case, RunFolder(Path(folder))))


def flat(tree: dict[str, Any], prefix: str = "") -> dict[str, float]:
    """Figures by path, such as ``C0/B5/peak_db``."""
    found: dict[str, float] = {}
    for key, value in tree.items():
        if isinstance(value, dict):
            found |= flat(value, f"{prefix}{key}/")
        elif isinstance(value, float):
            found[f"{prefix}{key}"] = value
    return found


def _register(blade: str, path: str, stored: float) -> None:
    name = path.rsplit("/", 1)[-1]
    if name not in TOLERANCES and name != "peak_db":
        return
    tolerance = LEVEL if name == "peak_db" else TOLERANCES[name] * abs(stored)
    check(
        f"paper/coarse-{blade}-{path.replace('/', '-').replace('_', '-')}",
        quantity=f"{path} on a coarse mesh",
        reference=stored,
        source=SOURCE,
        tolerance=tolerance,
        quick=False,
    )(lambda: flat(figures(blade)).get(path, np.nan))


def store() -> None:
    """Compute the figures and store them."""
    made = {blade: {k: round(v, 6) for k, v in flat(figures(blade)).items()} for blade in BLADES}
    write_text(STORED, json.dumps(made, indent=1) + "\n")


if __name__ == "__main__":
    store()
else:
    for _blade, _figures in json.loads(STORED.read_text(encoding="utf-8")).items():
        for _path, _stored in _figures.items():
            _register(_blade, _path, _stored)
