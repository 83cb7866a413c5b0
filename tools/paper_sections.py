# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections of the paper's page: tables, and sentences that follow from their numbers."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np

from quietblade.case.changes import read_changes
from quietblade.results.claims import BLADES, Claim, judge_claims
from quietblade.results.model import Result
from quietblade.view.directivity import draw_polar
from quietblade.view.paper import save
from tools.paper_runs import PaperRuns, modes_in_band

_ACROSS = "xy"  # plane of the polar diagrams: normal to the span


def markdown(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Markdown table; the first column to the left, the others to the right if they are short."""
    lines = [f"| {' | '.join(heads)} |", f"|{'|'.join('---' for _ in heads)}|"]
    lines += [f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in row)} |" for row in rows]
    return "\n".join(lines) + "\n"


def number(value: float, form: str) -> str:
    """Format a number; a dash if it is not known."""
    return format(value, form) if np.isfinite(value) else "–"


def percent(share: float) -> str:
    """Format a share; the least that is told is 0.01 %."""
    return "< 0.01 %" if share < 1e-4 else f"{100.0 * share:.3g} %"


# --- claims ------------------------------------------------------------------------------------


def claims(runs: PaperRuns, _: Path) -> Iterator[str]:
    """Each claim of the paper in the variants of the study."""
    yield "## The claims\n"
    judged = {
        (blade, variant): {c.id: c for c in judge_claims(result, blade)}
        for variant in runs.variants()
        for blade in BLADES
        if (result := runs.variant(blade, variant)) is not None and result.configurations
    }
    # the other meshes are told by the uncertainty
    meshes = tuple(v for v in runs.variants() if v.startswith(f"{runs.main}-"))
    shown = [
        v
        for v in runs.variants()
        if v not in meshes and all((blade, v) in judged for blade in BLADES)
    ]
    yield _choices(runs, shown)
    for variant in shown:
        every = [c for blade in BLADES for c in judged[blade, variant].values()]
        agreed, known = (
            sum(c.agrees is True for c in every),
            sum(c.agrees is not None for c in every),
        )
        yield f"With the variant *{variant}* {agreed} of {known} claims agree."
    yield "\n✓ agrees, ✗ differs, by the criterion in the last column (quietblade's own: the paper"
    yield "gives no tolerances).\n"
    for blade in BLADES:
        yield f"### {blade.capitalize()}\n"
        heads = ["Claim", "Paper", *shown, "± mesh", "Agrees if"]
        rows = [
            [
                claim.statement,
                claim.paper,
                *(verdict(judged[blade, v].get(claim.id)) for v in shown),
                number(runs.uncertainty.get((blade, claim.id), np.nan), ".2g"),
                claim.criterion,
            ]
            for claim in judged[blade, shown[0]].values()
        ]
        yield markdown(heads, rows)
    yield from _misses(judged, shown, runs.closest)


def verdict(claim: Claim | None) -> str:
    """Tell what was computed, and whether it agrees."""
    if claim is None or claim.agrees is None:
        return "–"
    return f"{'✓' if claim.agrees else '✗'} {claim.computed}"


def _choices(runs: PaperRuns, shown: Sequence[str]) -> str:
    rows = []
    for variant in shown:
        result = runs.result(f"{BLADES[1]}-{variant}")
        c = next(iter(result.configurations.values()))
        rows.append(
            [
                variant,
                {"none": "blade elements"}.get(
                    result.static.performance.inflow, result.static.performance.inflow
                ),
                f"{c.radiation_condition}, R = {c.outer_radius:.3g} m",
                changes_of(result) or "–",
            ]
        )
    heads = ["Variant", "Flow", "Condition on the sphere", "Changed in the case file"]
    return markdown(heads, rows)


def changed(result: Result, key: str) -> str:
    """Value that a run gave to a key of its case file; a dash if it did not."""
    found = read_changes(result.run.case_text)
    return repr(found[key]) if key in found else "–"


def changes_of(result: Result) -> str:
    """Tell what a run changed in its case file."""
    found = read_changes(result.run.case_text)
    return ", ".join(f"`{key}` = {value!r}" for key, value in found.items())


def _misses(
    judged: dict[tuple[str, str], dict[str, Claim]],
    shown: Sequence[str],
    closest: dict[str, tuple[str, str]],
) -> Iterator[str]:
    """Claims that no variant meets, and how near the other choices come to them."""
    missed = [
        f"{blade}: {claim.statement} (paper: {claim.paper}; here: {claim.computed}"
        f"{_tried(closest.get(key))})"
        for blade in BLADES
        for key, claim in judged[blade, shown[0]].items()
        if all(judged[blade, v].get(key, claim).agrees is False for v in shown)
    ]
    if not missed:
        yield "Every claim agrees in one of the variants at least.\n"
        return
    yield f"{len(missed)} claims agree in none of these variants:\n"
    yield "\n".join(f"* {text}" for text in missed) + "\n"
    if closest:
        yield "The closest are those of all choices within their bounds that were tried, on coarse"
        yield "meshes ([which moves what](#which-open-choice-moves-which-claim)).\n"


def _tried(closest: tuple[str, str] | None) -> str:
    if closest is None:
        return ""
    value, met = closest
    count, _, of = met.partition(" of ")
    return f"; closest of {of} other runs: {value}, {'none' if count == '0' else count} met it"


# --- loss --------------------------------------------------------------------------------------


def losses(runs: PaperRuns, _: Path) -> Iterator[str]:
    """Loss factor of each mode and where the power goes."""
    yield "## Loss of each mode, and where the power goes\n"
    yield "The loss factor of a damped mode ([S2-16](#S2-16)), and what the lossy materials and the"
    yield "radiation have in it ([S2-55](#S2-55)).\n"
    for blade in BLADES:
        result = runs.result(f"{blade}-{runs.main}")
        parts = next(iter(result.configurations.values())).loss_shares.name
        rows = [
            [blade, name, m.name, f"{m.peak:.2f}", f"{m.level:.1f}", f"{m.loss_factor:.1e}",
             *(number(m.losses[part], ".1e") for part in parts),
             number(m.width, ".2g"), percent(m.radiated)]
            for name, configuration in result.configurations.items()
            for m in modes_in_band(configuration)
        ]  # fmt: skip
        heads = ["Blade", "", "Mode", "Peak [Hz]", "[dB re 1 pW]", "Loss factor", *parts,
                 "Width [Hz]", "Power that is radiated"]  # fmt: skip
        yield markdown(heads, rows)


def steps(runs: PaperRuns, _: Path) -> Iterator[str]:
    """Tell what sweeps in even steps would have shown of the peaks."""
    yield "## What the frequency step shows of a peak\n"
    yield "The peaks are narrower than the steps of a sweep, so that the level it shows is a matter"
    yield "of where its frequencies lie: in brackets, where they lie most unluckily. All levels are"
    yield "in dB re 1 pW.\n"
    rows, at = [], ()
    for blade in BLADES:
        for name, configuration in runs.result(f"{blade}-{runs.main}").configurations.items():
            for m in modes_in_band(configuration):
                at = tuple(m.stepped)
                shown = (f"{level:.1f} ({worst:.1f})" for level, worst in m.stepped.values())
                rows.append([blade, name, m.name, f"{m.level:.1f}", *shown])
    yield markdown(["Blade", "", "Mode", "True peak", *(f"{step:g} Hz" for step in at)], rows)


def directions(runs: PaperRuns, pictures: Path) -> Iterator[str]:
    """Tell where the sound goes: degrees of the waves at the peaks, and polar diagrams."""
    yield "## Where the sound goes\n"
    yield "Shares of the outgoing waves in the radiated power at each peak"
    yield "([S2-9](#S2-9)). A dipole has the directivity of a figure of eight about"
    yield "the direction in which the blade pushes the water; a monopole has none.\n"
    kinds = ("Monopole", "Dipole", "Quadrupole", "Higher")
    for blade in BLADES:
        result = runs.result(f"{blade}-{runs.main}")
        picture = f"directivity-{blade}"
        save(draw_polar(result, _ACROSS), pictures, picture)
        yield f"![Directivity of the {blade} blade across the span](gallery/{picture}.png)\n"
        rows, least = [], 1.0
        for name, configuration in result.configurations.items():
            for mode in modes_in_band(configuration):
                shares = [*mode.degrees[:3], sum(mode.degrees[3:])]
                least = min(least, shares[1])
                rows.append([blade, name, mode.name, *map(percent, shares)])
        yield markdown(["Blade", "", "Mode", *kinds], rows)
        if least > 0.5:
            yield f"Every peak of the {blade} blade is a dipole, to {percent(least)} at least.\n"


# --- runs --------------------------------------------------------------------------------------


def provenance(runs: PaperRuns, _: Path) -> Iterator[str]:
    """List the runs behind the page."""
    yield "## The runs\n"
    rows = []
    for name in runs.names():
        result = runs.result(name)
        run = result.run
        rows.append(
            [
                name,
                str(result.mesh.nodes),
                str(int(result.mesh.unknowns.count.sum())),
                f"{float(run.timings.seconds.sum()):.0f}",
                str(run.threads),
                f"{run.solvers.peak_memory.max() / 1e9:.2f}",
                run.code_version,
                run.created[:10],
            ]
        )
    heads = ["Run", "Nodes", "Unknowns", "Time [s]", "Threads", "Largest factor [GB]", "quietblade",
             "Made"]  # fmt: skip
    yield markdown(heads, rows)
