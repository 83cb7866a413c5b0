# SPDX-License-Identifier: LGPL-2.1-or-later
"""A report of a run as one HTML file that needs no network."""

from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from html import escape
from importlib.resources import files
from io import BytesIO
from pathlib import Path
from string import Template

from PIL import Image

from quietblade.results.answers import QUESTIONS, answers
from quietblade.results.evidence import evidence_tables
from quietblade.results.headline import summarise
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.results.table import Table
from quietblade.results.tables import summary_tables
from quietblade.typing import Progress, silent
from quietblade.view.figures import draw_figures
from quietblade.view.interactive import POLICY, interactive_view
from quietblade.view.report_order import (
    BODY_CAPTIONS,
    BODY_VIEW,
    CASE,
    SECTIONS,
    TRUST,
    VIEW,
    Section,
)


def render_report(
    folder: RunFolder,
    result: Result,
    progress: Progress = silent,
    *,
    words: Sequence[Table] = (),
    others: Sequence[Table] = (),
    interactive: bool = True,
) -> str:
    """Report of a run as HTML; missing figures are drawn first.

    Parameters
    ----------
    folder : RunFolder
        A finished run, for its figures and fields.
    result : Result
        What it holds.
    progress : callable
    words : sequence of Table
        The case in words.
    others : sequence of Table
        What else is told, each in the section that has a place for its title.
    interactive : bool
        Whether the page carries the view of the moving blade, about 3 MB; without it the page has
        no script at all.

    Raises
    ------
    ResultError
        A file of fields is missing.
    """
    place = BODY_VIEW if result.static is None else VIEW
    figures = _drawn(folder, place, progress)
    view = interactive_view(folder, result) if interactive else ""
    summary = summarise(result)
    page = Template(files("quietblade.view").joinpath("report.html").read_text(encoding="utf-8"))
    given = {table.title: table for table in summary_tables(summary)}
    given |= {table.title: table for table in evidence_tables(result)}
    given |= {table.title: table for table in others}
    captions = BODY_CAPTIONS if result.static is None else {}
    parts = []
    for section in (*SECTIONS, _rest(given, figures)):
        own = words if section.title == CASE else ()
        parts.append(
            _section(section, (*own, *_chosen(section, given)), figures, {place: view}, captions)
        )
    parts.append(f"<h3>Case file</h3>\n<pre>{escape(result.run.case_text)}</pre>")
    body = "\n".join(part for part in parts if part)
    return page.substitute(
        policy=POLICY,
        title=escape(summary.title),
        version=escape(summary.run.code_version),
        created=escape(summary.run.created),
        platform=escape(summary.run.platform),
        body=f"{_answers(answers(summary), body)}\n{body}",
    )


def _drawn(folder: RunFolder, place: str, progress: Progress) -> dict[str, Path]:
    figures = {file.stem: file for file in folder.figures.glob("*.png")}
    if place not in figures:
        figures = {file.stem: file for file in draw_figures(folder, progress)}
    return figures


def _answers(table: Table, body: str) -> str:
    """Answers, each with a link to its section if the body has one."""
    rows = []
    for question, text in table.rows:
        title = TRUST if question == QUESTIONS[-1] else question
        told = escape(question)
        if _heading(title) in body:
            told = f'<a href="#{_anchor(title)}">{told}</a>'
        rows.append(f"<tr><td>{told}</td><td>{escape(text)}</td></tr>")
    return f'<h2>{escape(table.title)}</h2>\n<table class="answers">{"".join(rows)}</table>'


def _chosen(section: Section, tables: Mapping[str, Table]) -> Iterable[Table]:
    return (tables[title] for title in section.tables if title in tables)


def _section(
    section: Section,
    tables: Sequence[Table],
    figures: Mapping[str, Path],
    views: Mapping[str, str],
    captions: Mapping[str, str],
) -> str:
    pictures = [
        _figure(figures[name], captions.get(name, caption), views.get(name, ""))
        for name, caption in section.figures.items()
        if name in figures
    ]
    # the body itself says first what its tables say in full
    first = 1 if views.keys() & section.figures.keys() else 0
    parts = [*pictures[:first], *(_table(t, section.title) for t in tables), *pictures[first:]]
    return "\n".join([_heading(section.title), *parts]) if parts else ""


def _rest(tables: Iterable[str], figures: Iterable[str]) -> Section:
    """Gather what has no place in the order, for instance figures that a user has added."""
    known_tables = {title for section in SECTIONS for title in section.tables}
    known_figures = {name for section in SECTIONS for name in section.figures}
    return Section(
        "More",
        tuple(title for title in tables if title not in known_tables),
        {name: name for name in sorted(set(figures) - known_figures)},
    )


def _heading(title: str) -> str:
    return f'<h2 id="{_anchor(title)}">{escape(title)}</h2>'


def _anchor(title: str) -> str:
    return "".join(c if c.isalnum() else "-" for c in title.lower()).strip("-")


def _table(table: Table, section: str) -> str:
    heading = f"<h3>{escape(table.title)}</h3>" if table.title != section else ""
    lines = [heading, '<div class="scroll"><table>']
    if table.columns:
        lines.append(_row("th", table.columns))
    lines += [_row("td", row) for row in table.rows]
    lines.append("</table></div>")
    if table.note:
        lines.append(f'<p class="note">{escape(table.note)}</p>')
    return "\n".join(lines)


def _row(tag: str, cells: tuple[str, ...]) -> str:
    return "<tr>" + "".join(_cell(tag, text) for text in cells) + "</tr>"


def _cell(tag: str, text: str) -> str:
    verdict = text in {"agrees", "DIFFERS", "not judged"}
    kind = f' class="{text.lower().replace(" ", "-")}"' if verdict else ""
    return f"<{tag}{kind}>{escape(text)}</{tag}>"


def _figure(file: Path, caption: str, view: str) -> str:
    still = (
        f'<img src="data:image/webp;base64,{_picture(file)}" alt="{escape(caption)}">'
        f"<figcaption>{escape(caption)}</figcaption>"
    )
    if not view:
        return f"<figure>{still}</figure>"
    # shown on paper, and where the browser cannot draw the view
    return f'<figure>{view}<div id="view3d-still">{still}</div></figure>'


def _picture(file: Path) -> str:
    """Picture in base64, pixel for pixel in about half the bytes of its PNG file."""
    packed = BytesIO()
    with Image.open(file) as image:
        image.convert("RGB").save(packed, "WEBP", lossless=True, method=1, quality=20)
    return b64encode(packed.getvalue()).decode("ascii")
