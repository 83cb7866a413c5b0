# SPDX-License-Identifier: LGPL-2.1-or-later
"""The hydrofoil of the tutorial with both of its films: the figures that the page tells.

``python -m verification.tutorial`` prints them.
"""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

import quietblade as qb
from quietblade.mesh import Mesh
from quietblade.results.headline import summarise
from verification.registry import check

CASE = Path(__file__).parents[1] / "cases" / "my-hydrofoil.toml"
FILMS = {"rubber": "neoprene-60", "acrylic": "acrylic-film-isd112-like"}
PAGE = "docs/tutorial.md, from an earlier run of the same case"


@dataclass(frozen=True)
class Answers:
    """What the page reads from a run, under load.

    Attributes
    ----------
    tip : float
        Displacement along y [mm].
    lift : float
        [N].
    shear : float
        Largest shear strain of the film [%].
    frequency, loss, level : dict
        Of each mode: wet frequency [Hz], loss factor, level of its peak [dB re 1 pW].
    """

    tip: float
    lift: float
    shear: float
    frequency: dict[str, float]
    loss: dict[str, float]
    level: dict[str, float]


@cache
def answers(film: str) -> Answers:
    """Compute the case with one of the films, deformed only, in some twenty seconds."""
    changes = {"film.material": FILMS[film], "acoustics.configurations": ["C1"]}
    case = qb.Case.load(CASE).varied(changes)
    mesh = _mesh()
    static = qb.solve_static(case, qb.make_blade(case), mesh)
    modes = qb.solve_modes(case, qb.make_blade(case), mesh, static, "C1")
    result = qb.collect(case, mesh, static, [modes], [qb.solve_response(case, modes)])
    summary = summarise(result)
    found = summary.modes.C1
    return Answers(
        1e3 * float(result.static.tip_displacement[1]),
        float(summary.static.lift_n or np.nan),
        100.0 * result.static.max_film_shear_strain,
        {m.name: float(m.frequency_hz or np.nan) for m in found},
        {m.name: float(m.loss_factor or np.nan) for m in found},
        {m.name: float(m.peak_level_db or np.nan) for m in found},
    )


@cache
def _mesh() -> Mesh:
    case = qb.Case.load(CASE)  # the films differ in their material only
    return qb.make_mesh(case, qb.make_blade(case))


@check("structure/tutorial-tip", quantity="tip displacement of the tutorial's hydrofoil [mm]",
       reference=8.85, source=PAGE, tolerance=0.05, quick=False)  # fmt: skip
def _tip() -> float:
    return answers("rubber").tip


@check("flow/tutorial-lift", quantity="lift of the tutorial's hydrofoil [N]",
       reference=733.5, source=PAGE, tolerance=1.0, quick=False)  # fmt: skip
def _lift() -> float:
    return answers("rubber").lift


for _name, _frequency in {"B1": 43.4, "B2": 185.3, "T1": 305.0, "B3": 483.2}.items():

    @check(f"acoustics/tutorial-{_name}",
           quantity=f"{_name} of the tutorial's loaded hydrofoil in water [Hz]",
           reference=_frequency, source=PAGE, tolerance=2e-3 * _frequency,
           quick=False)  # fmt: skip
    def _wet(name: str = _name) -> float:
        return answers("rubber").frequency[name]


for _name, _gain in {"B1": 1.7, "B2": 5.9, "B3": 4.2}.items():

    @check(f"acoustics/tutorial-film-{_name}",
           quantity=f"fall of the peak {_name} by the tutorial's acrylic film [dB]",
           reference=_gain, source=PAGE, tolerance=0.1, quick=False)  # fmt: skip
    def _fall(name: str = _name) -> float:
        return answers("rubber").level[name] - answers("acrylic").level[name]


@check("acoustics/tutorial-film-law", reference=1.0, tolerance=0.01, quick=False,
       quantity="amplitude of the peak B2 times its loss factor, with one film over the other",
       source="a lone resonance is as high as one over its loss factor")  # fmt: skip
def _law() -> float:
    rubber, acrylic = answers("rubber"), answers("acrylic")
    ratio: float = 10.0 ** ((acrylic.level["B2"] - rubber.level["B2"]) / 20.0)
    return ratio * acrylic.loss["B2"] / rubber.loss["B2"]


if __name__ == "__main__":
    for _film in FILMS:
        print(_film, answers(_film))
