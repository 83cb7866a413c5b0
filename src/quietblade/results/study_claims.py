# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's claims, judged for several variants, with the numerical uncertainty beside."""

import html
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from quietblade.results.claims import Claim, judge_claims
from quietblade.results.files import ResultError, write_text
from quietblade.results.model import Result
from quietblade.results.study_convergence import GridConvergence, grid_convergence
from quietblade.results.table import Table

Verdict = Literal["agrees", "agrees within uncertainty", "differs", "not computed"]


@dataclass(frozen=True)
class Entry:
    """One claim in one variant.

    Attributes
    ----------
    variant, computed : str
        Which, and what was computed in words.
    value : float or None
    miss : float or None
        Distance of the value from the range that agrees, in its unit.
    verdict : str
        ``agrees within uncertainty``: the value is outside of the range that agrees, by less than
        its numerical uncertainty.
    """

    variant: str
    computed: str
    value: float | None
    miss: float | None
    verdict: Verdict


@dataclass(frozen=True)
class Uncertainty:
    """Numerical uncertainty of a claim's figure, from three meshes.

    Attributes
    ----------
    values : tuple of float
        On the finest mesh first.
    behaviour : str
        See `GridConvergence`.
    order, extrapolated : float or None
    half_width : float
        In the unit of the figure.
    """

    values: tuple[float, ...]
    behaviour: str
    order: float | None
    extrapolated: float | None
    half_width: float

    @classmethod
    def of(cls, found: GridConvergence) -> "Uncertainty":
        """Keep what the table tells."""
        return cls(
            found.values,
            found.behaviour,
            _finite(found.order),
            _finite(found.extrapolated),
            found.uncertainty,
        )


@dataclass(frozen=True)
class ClaimRow:
    """One claim about one blade: the paper's word, ours in several variants.

    Attributes
    ----------
    id, case, statement, paper, criterion : str
        See `Claim`; ``case`` is the study's name of the blade.
    entries : tuple of Entry
        One a variant, in the order of the study file.
    uncertainty : Uncertainty or None
        None if it is not known.
    """

    id: str
    case: str
    statement: str
    paper: str
    criterion: str
    entries: tuple[Entry, ...]
    uncertainty: Uncertainty | None


@dataclass(frozen=True)
class ClaimTable:
    """The paper's claims beside what was computed.

    Attributes
    ----------
    title : str
    variants : tuple of str
        Columns.
    rows : tuple of ClaimRow
    """

    title: str
    variants: tuple[str, ...]
    rows: tuple[ClaimRow, ...]

    def count(self, variant: str, case: str = "") -> tuple[int, int]:
        """Claims that agree, and all that were judged, of one blade or of all."""
        verdicts = [
            entry.verdict
            for row in self.rows
            if row.case == case or not case
            for entry in row.entries
            if entry.variant == variant and entry.verdict != "not computed"
        ]
        return sum(v != "differs" for v in verdicts), len(verdicts)

    def table(self) -> Table:
        """Table for the screen."""
        return Table("The paper's claims", self.heads(), tuple(self._texts()), self.note())

    def heads(self) -> tuple[str, ...]:
        """Heads of the columns."""
        pairs = (head for variant in self.variants for head in (variant, "agrees"))
        return ("Blade", "Claim", "Paper", *pairs, "± numerical")

    def note(self) -> str:
        """Say how many claims agree."""
        counts = (f"{v}: {'{} of {}'.format(*self.count(v))} agree" for v in self.variants)
        return "; ".join(counts)

    def _texts(self) -> list[tuple[str, ...]]:
        rows = []
        for row in self.rows:
            cells = [c for e in row.entries for c in (e.computed, _short(e.verdict))]
            width = "-" if row.uncertainty is None else f"{row.uncertainty.half_width:.2g}"
            rows.append((row.case, row.statement, row.paper, *cells, width))
        return rows

    def markdown(self) -> str:
        """Table for a documentation page."""
        lines = [self.heads(), tuple("---" for _ in self.heads()), *self._texts()]
        escaped = (" | ".join(cell.replace("|", "\\|") for cell in line) for line in lines)
        return "\n".join(f"| {line} |" for line in escaped) + f"\n\n{self.note()}\n"

    def html(self) -> str:
        """Table for a web page, one class a verdict."""
        head = "".join(f"<th>{html.escape(text)}</th>" for text in self.heads())
        body = []
        for row, texts in zip(self.rows, self._texts(), strict=True):
            verdicts = [e.verdict for e in row.entries]
            kinds = ["", "", "", *(k for v in verdicts for k in ("", v.split()[0])), ""]
            cells = "".join(
                f'<td class="{kind}">{html.escape(text)}</td>' if kind else
                f"<td>{html.escape(text)}</td>"
                for kind, text in zip(kinds, texts, strict=True)
            )  # fmt: skip
            body.append(f'<tr id="{html.escape(row.id)}">{cells}</tr>')
        note = html.escape(self.note())
        return (
            f'<table class="claims"><caption>{note}</caption><thead><tr>{head}</tr></thead>'
            f"<tbody>{''.join(body)}</tbody></table>\n"
        )


def claim_table(
    title: str,
    results: Mapping[tuple[str, str], Result],
    variants: Sequence[str],
    meshes: Sequence[str] = (),
) -> ClaimTable:
    """Judge the paper's claims for variants of its blades.

    Parameters
    ----------
    title : str
    results : mapping
        Results by case and variant; those that are missing count as not computed.
    variants : sequence of str
        Columns of the table.
    meshes : sequence of str
        Variants on ever coarser meshes, the finest first; three or more give the uncertainty.
    """
    judged = {key: {c.id: c for c in judge_claims(result)} for key, result in results.items()}
    rows = []
    for case in dict.fromkeys(case for case, _ in results):
        about = [judged[key] for key in judged if key[0] == case]
        for name, claim in {id_: c for claims in about for id_, c in claims.items()}.items():
            doubt = _uncertainty(case, name, results, judged, meshes)
            entries = tuple(
                _entry(variant, judged.get((case, variant), {}).get(name), doubt)
                for variant in variants
            )
            rows.append(
                ClaimRow(name, case, claim.statement, claim.paper, claim.criterion, entries, doubt)
            )
    return ClaimTable(title, tuple(variants), tuple(rows))


def _entry(variant: str, claim: Claim | None, doubt: Uncertainty | None) -> Entry:
    if claim is None or claim.agrees is None:
        return Entry(variant, "-", None, None, "not computed")
    verdict: Verdict = "agrees" if claim.agrees else "differs"
    close = doubt is not None and claim.miss is not None and claim.miss <= doubt.half_width
    if not claim.agrees and close:
        verdict = "agrees within uncertainty"
    return Entry(variant, claim.computed, claim.value, claim.miss, verdict)


def _uncertainty(
    case: str,
    claim: str,
    results: Mapping[tuple[str, str], Result],
    judged: Mapping[tuple[str, str], Mapping[str, Claim]],
    meshes: Sequence[str],
) -> Uncertainty | None:
    known = []
    for variant in meshes:
        found = judged.get((case, variant), {}).get(claim)
        if found is not None and found.value is not None:
            known.append((results[case, variant].mesh.nodes ** (-1.0 / 3.0), found.value))
    if len(known) < 3:
        return None
    sizes, values = zip(*known[:3], strict=True)
    try:
        return Uncertainty.of(grid_convergence(sizes, values))
    except ValueError as error:
        raise ResultError(f"convergence of {case}: {error}; name the finest mesh first") from error


@dataclass(frozen=True)
class Closest:
    """The run that comes closest to a claim.

    Attributes
    ----------
    claim : Claim
        As that run judges it.
    run : str
    met : int
        Runs that agree with the claim.
    runs : int
        Runs that judged it.
    """

    claim: Claim
    run: str
    met: int
    runs: int


def closest_runs(results: Iterable[tuple[str, Result]]) -> tuple[Closest, ...]:
    """Find for each claim the run that comes closest to it, of runs by name."""
    judged: dict[str, list[tuple[float, str, Claim]]] = {}
    for run, result in results:
        for claim in judge_claims(result):
            if claim.agrees is not None:
                far = 0.0 if claim.agrees else np.inf
                miss = far if claim.miss is None else claim.miss
                judged.setdefault(claim.id, []).append((miss, run, claim))
    found = []
    for entries in judged.values():
        _, run, claim = min(entries, key=lambda entry: entry[0])
        met = sum(bool(entry[2].agrees) for entry in entries)
        found.append(Closest(claim, run, met, len(entries)))
    return tuple(found)


def closest_table(found: Iterable[Closest]) -> Table:
    """Table of the closest runs."""
    rows = tuple(
        (c.claim.id, c.claim.paper, c.claim.computed, f"{c.met} of {c.runs}", c.run) for c in found
    )
    note = "a claim with 0 is not met by any evaluation: its closest value is given"
    return Table(
        "Closest to each claim", ("claim", "paper", "closest", "met by", "run"), rows, note
    )


def _short(verdict: Verdict) -> str:
    shorts = {"agrees": "yes", "agrees within uncertainty": "yes, within ±", "differs": "NO"}
    return shorts.get(verdict, "-")


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def write_claims(table: ClaimTable, root: Path) -> None:
    """Write ``claims.json``, ``claims.md`` and ``claims.html`` into a folder."""
    write_text(root / "claims.md", table.markdown())
    write_text(root / "claims.html", table.html())
    text = json.dumps(asdict(table), indent=1, ensure_ascii=False, allow_nan=False)
    write_text(root / "claims.json", text)


def read_claims(root: Path) -> ClaimTable:
    """Read the table of claims of a study's folder.

    Raises
    ------
    ResultError
        There is none, or it cannot be read.
    """
    file = root / "claims.json"
    try:
        data = json.loads(file.read_text(encoding="utf-8"))
        rows = tuple(
            ClaimRow(
                **{
                    **row,
                    "entries": tuple(Entry(**entry) for entry in row["entries"]),
                    "uncertainty": _read_uncertainty(row["uncertainty"]),
                }
            )
            for row in data["rows"]
        )
        return ClaimTable(data["title"], tuple(data["variants"]), rows)
    except FileNotFoundError:
        raise ResultError(f"{root}: no claims.json here; the study makes one") from None
    except (ValueError, KeyError, TypeError) as error:
        raise ResultError(f"{file}: cannot be read ({error})") from error


def _read_uncertainty(data: Mapping[str, object] | None) -> Uncertainty | None:
    if data is None:
        return None
    values = data["values"]
    if not isinstance(values, list):
        raise TypeError("values of an uncertainty are a list")
    return Uncertainty(**{**data, "values": tuple(values)})  # type: ignore[arg-type]
