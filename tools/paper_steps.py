# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections of the paper's page beyond the paper: what each part of the model does."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np

from quietblade.results.alternatives import AlternativeTable
from quietblade.results.claims import BLADES
from quietblade.results.model import ConfigurationResult, Result
from quietblade.study.decomposition import ALL, BOTH, LOAD, REST, SHAPE, SHARES, STRESS
from quietblade.study.water_check import ANEW, MOVED
from quietblade.view.alternatives import draw_costs, draw_shift, modes_drawn, modes_with_peak
from quietblade.view.paper import save
from quietblade.view.spectra import draw_sound_power_of
from tools.paper_runs import ModeFigures, PaperRuns, modes_in_band
from tools.paper_sections import changes_of, markdown, number

_WATER = 0.1  # %, by which moved and re-meshed water may differ in the peaks
_BEYOND = "beyond/"
_COSTS = {
    "lifting-line": "lifting line in place of blade elements",
    "bgt1": "first-order BGT on the same sphere",
    "whole-loss": "loss factor on the film's whole tangent",
    "no-load": "no stiffness of the loads",
    "zener": "fractional Zener film, the same loss at one frequency",
    "stream": "damping by the stream",
}
_FILMS = {
    "base": "as in the study",
    "short-film": "1. shortened to the inner part of the span",
    "outer-film": "2. the same length, moved to the outer end",
    "thin-film": "3. there, and thinner",
}
_SHIFT_TEXT = """\
The load changes shape and stress. `quietblade.study.decomposition.decompose_shift` adds one
after the other: the deformed shape of blade and water, the geometric stiffness of the stress
([S2-2](#S2-2)), the stiffness of the pressure, which turns with the surface, and
spin softening ([S2-1](#S2-1)). Modes are matched by MAC. The diamond is the stress
by itself, with its loads, on the shape at rest: where it is not as high as the other steps are
together, shape and stress do not simply add up.
"""

# --- from C0 to C1 -----------------------------------------------------------------------------


def shift(runs: PaperRuns, pictures: Path) -> Iterator[str]:
    """Where the change from C0 to C1 comes from."""
    yield "## Where the shift from C0 to C1 comes from\n"
    tables = {b: t for b in BLADES if (t := runs.table(b, "shift")) is not None}
    if not tables:
        yield _absent("tools.paper_beyond")
        return
    yield _SHIFT_TEXT
    save(draw_shift({b.capitalize(): t for b, t in tables.items()}), pictures, "shift")
    yield "![From C0 to C1, step by step](gallery/shift.png)\n"
    for blade, table in tables.items():
        yield f"### {blade.capitalize()}\n"
        yield _mesh_of(table)
        yield _shift_table(table)
        yield "\n".join(_shift_sentences(table)) + "\n"
        far = [table.mode[k] for k in set(modes_with_peak(table)) - set(modes_drawn(table))]
        if far:
            yield f"Too far for the picture: {', '.join(far)}.\n"


def _shift_table(table: AlternativeTable) -> str:
    rows = []
    for k in modes_with_peak(table):
        for name in (REST, *SHARES):
            row = table.row(name)
            f, rest = table.frequency[row, k], table.frequency[0, k]
            rows.append(
                [
                    table.mode[k] if name == REST else "",
                    table.description[row],
                    f"{f:.2f}",
                    "" if name == REST else number(100.0 * (f / rest - 1.0), "+.2f"),
                    number(table.peak_level[row, k], ".1f"),
                    number(table.peak_level[row, k] - table.peak_level[0, k], "+.1f")
                    if name != REST
                    else "",
                    f"{table.assurance[row, k]:.3f}",
                ]
            )
    heads = ["Mode", "What counts", "f [Hz]", "[%]", "Peak [dB re 1 pW]", "[dB]", "MAC with C0"]
    return markdown(heads, rows)


def _shift_sentences(table: AlternativeTable) -> Iterator[str]:
    shift_of = 100.0 * (table.frequency / table.frequency[0] - 1.0)
    order = (REST, SHAPE, BOTH, LOAD, ALL)
    words = ("the deformed shape", "the stress", "the stiffness of the pressure", "spin softening")
    for k in modes_with_peak(table):
        at = np.array([shift_of[table.row(name), k] for name in order])
        steps, whole = np.diff(at), at[-1]
        most = int(np.argmax(np.abs(steps)))
        against = [w for w, s in zip(words, steps, strict=True) if s * whole < -0.01 * abs(whole)]
        against = [w for w in against if abs(whole) > 0.05]
        text = (
            f"* **{table.mode[k]}** moves by {whole:+.2f} %; the largest step is that of "
            f"{words[most]} ({steps[most]:+.2f} %)"
        )
        opposed = (
            f", against {' and '.join(against)}" if against and words[most] not in against else ""
        )
        alone = shift_of[table.row(STRESS), k]
        yield f"{text}{opposed}. The stress alone would move it by {alone:+.2f} %."


def water(runs: PaperRuns, _: Path) -> Iterator[str]:
    """Compare moved with re-meshed water."""
    yield "## Moved against re-meshed water\n"
    tables = {b: t for b in BLADES if (t := runs.table(b, "water")) is not None}
    if not tables:
        yield _absent("tools.paper_beyond")
        return
    yield "On $\\mathcal C_1$ the water mesh of $\\mathcal C_0$ is moved with the blade"
    yield "([S2-30](#S2-30)). A mesh that is made anew around the deformed blade"
    yield "(`quietblade.study.water_check.compare_water`), whose cells have nothing in common with"
    yield "the moved ones, gives:\n"
    rows, worst = [], 0.0
    for blade, table in tables.items():
        old, new = table.row(MOVED), table.row(ANEW)
        for k in np.flatnonzero(np.isfinite(table.peak_level).all(axis=0)):
            change = 100.0 * (table.peak_frequency[new, k] / table.peak_frequency[old, k] - 1.0)
            worst = max(worst, abs(change))
            rows.append(
                [
                    blade,
                    table.mode[k],
                    f"{table.peak_frequency[old, k]:.3f}",
                    f"{table.peak_frequency[new, k]:.3f}",
                    f"{change:+.3f}",
                    f"{table.peak_level[old, k]:.2f}",
                    f"{table.peak_level[new, k] - table.peak_level[old, k]:+.2f}",
                ]
            )
    heads = ["Blade", "Mode", "Moved [Hz]", "Re-meshed [Hz]", "[%]", "Moved [dB]", "Change [dB]"]
    yield markdown(heads, rows)
    verdict = "within" if worst <= _WATER else "NOT within"
    yield f"The peaks agree to {worst:.2g} %, which is {verdict} the {_WATER:g} % asked for."
    yield _mesh_of(next(iter(tables.values())))


# --- what the steps of the model cost ----------------------------------------------------------


def costs(runs: PaperRuns, pictures: Path) -> Iterator[str]:
    """Effect of each modelling step on the levels of C1."""
    yield "## What each step of the model does\n"
    yield "Each line changes one thing of the base; the table and the bars are what that does to"
    yield "the peaks under load ($\\mathcal C_1$) and to the mean over the band.\n"
    missing = set(_COSTS)
    for blade in BLADES:
        base = runs.variant(blade, "base", _BEYOND)
        if base is None:
            continue
        first = base.configurations["C1"]
        reference = modes_in_band(first)
        changes, rows = {}, []
        for variant, text in _COSTS.items():
            found = _alternative(runs, blade, variant)
            if found is None:
                continue
            missing.discard(variant)
            levels, frequencies, mean = found(reference, first)
            changes[text] = np.array([*levels, mean])
            rows.append(
                [text, *(f"{number(level, '+.1f')} dB, {number(f, '+.2f')} %"
                         for level, f in zip(levels, frequencies, strict=True)),
                 f"{number(mean, '+.1f')} dB"]
            )  # fmt: skip
        if not changes:
            continue
        names = [*(m.name for m in reference), "band mean"]
        title = f"{blade.capitalize()} blade, C1"
        save(draw_costs(names, changes, title), pictures, f"costs-{blade}")
        yield f"### {blade.capitalize()}\n"
        yield f"![What each step does, {blade}](gallery/costs-{blade}.png)\n"
        yield markdown(["Change", *names], rows)
        mean = {text: values[-1] for text, values in changes.items()}
        largest = max(mean, key=lambda text: abs(mean[text]))
        yield f"Most of all the mean over the band depends on: {largest} ({mean[largest]:+.1f} dB)."
        yield f"The base has {base.mesh.nodes} nodes.\n"
    if missing:
        yield (
            "Not in these runs: " + "; ".join(t for v, t in _COSTS.items() if v in missing) + ".\n"
        )


Effect = Callable[
    [Sequence[ModeFigures], ConfigurationResult], tuple[list[float], list[float], float]
]
"""Change of the peaks' levels [dB] and frequencies [%], and of the mean level [dB]."""


def _alternative(runs: PaperRuns, blade: str, variant: str) -> Effect | None:
    """How a change of the model is known: from a run of its own, or from the decomposition."""
    if variant == "no-load":
        table = runs.table(blade, "shift")
        return None if table is None else lambda reference, _: _from_table(table, reference)
    result = runs.variant(blade, variant, _BEYOND)
    if result is None or "C1" not in result.configurations:
        return None
    return lambda reference, first: _from_run(result.configurations["C1"], reference, first)


def _from_run(
    other: ConfigurationResult, reference: Sequence[ModeFigures], first: ConfigurationResult
) -> tuple[list[float], list[float], float]:
    peaks = {m.name: m for m in modes_in_band(other)}
    nan = float("nan")
    levels = [peaks[m.name].level - m.level if m.name in peaks else nan for m in reference]
    frequencies = [
        100.0 * (peaks[m.name].peak / m.peak - 1.0) if m.name in peaks else nan for m in reference
    ]
    return levels, frequencies, other.bands.mean_level - first.bands.mean_level


def _from_table(
    table: AlternativeTable, reference: Sequence[ModeFigures]
) -> tuple[list[float], list[float], float]:
    without, whole = table.row(BOTH), table.row(ALL)
    rise = table.peak_level[without] - table.peak_level[whole]
    move = 100.0 * (table.peak_frequency[without] / table.peak_frequency[whole] - 1.0)
    at = [table.mode.index(m.name) if m.name in table.mode else -1 for m in reference]
    nan = float("nan")
    return (
        [float(rise[k]) if k >= 0 else nan for k in at],
        [float(move[k]) if k >= 0 else nan for k in at],
        float(table.mean_level[without] - table.mean_level[whole]),
    )


def films(runs: PaperRuns, pictures: Path) -> Iterator[str]:
    """Film that is moved and resized in three steps."""
    yield "## Another film\n"
    for blade in BLADES:
        found = {
            text: result
            for variant, text in _FILMS.items()
            if (result := runs.variant(blade, variant, _BEYOND)) is not None
        }
        if len(found) < 2:
            continue
        yield f"### {blade.capitalize()}\n"
        for configuration in ("C0", "C1"):
            members = {text: r.configurations[configuration] for text, r in found.items()}
            name = f"films-{blade}-{configuration}"
            title = f"{blade.capitalize()} blade, {configuration}: film moved and resized"
            save(draw_sound_power_of(members, title), pictures, name)
            yield f"![{title}](gallery/{name}.png)\n"
        yield markdown(["Film", "", "", "Peaks: frequency, level, loss factor"], _film_rows(found))


def _film_rows(found: dict[str, Result]) -> Iterator[list[str]]:
    for text, result in found.items():
        for name, configuration in result.configurations.items():
            peaks = "; ".join(
                f"{m.name} {m.peak:.1f} Hz, {m.level:.1f} dB, {m.loss_factor:.1e}"
                for m in modes_in_band(configuration)
            )
            first = name == next(iter(result.configurations))
            yield [text if first else "", changes_of(result) if first else "", name, peaks]


def _absent(tool: str) -> str:
    return f"Not computed yet: run `python -m {tool}`.\n"


def _mesh_of(table: AlternativeTable) -> str:
    return f"Cells of {1e3 * table.element_size:.3g} mm on the blade.\n"
