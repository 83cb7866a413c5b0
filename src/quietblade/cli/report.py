# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade report``: one HTML file to hand on, or a PDF."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from quietblade.cli.common import ExitCode, console, error_console
from quietblade.cli.progress import ProgressDisplay
from quietblade.cli.written import Written, show_written

if TYPE_CHECKING:
    from quietblade.results.model import RunRecord
    from quietblade.results.table import Table


def report(
    directory: Annotated[Path, typer.Argument(help="Folder of a run.")],
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", help="File; default report.html (or .pdf) in the folder."),
    ] = None,
    plain: Annotated[
        bool, typer.Option("--plain", "--no-3d", help="Without the interactive 3-D view.")
    ] = False,
    pdf: Annotated[
        bool, typer.Option("--pdf", help="Write a PDF instead; needs the extra quietblade[pdf].")
    ] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Show errors only.")] = False,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the file as JSON; progress goes to stderr.")
    ] = False,
) -> ExitCode:
    """Write a report of a run as one self-contained HTML file, or as a PDF."""
    from quietblade.results.files import replacing, write_text  # noqa: PLC0415  # help stays fast
    from quietblade.results.store import RunFolder  # noqa: PLC0415
    from quietblade.view.report import render_report  # noqa: PLC0415
    from quietblade.view.report_pdf import pdf_of, require_pdf  # noqa: PLC0415

    if pdf:
        require_pdf()  # before anything is drawn
    folder = RunFolder(directory)
    file = out or directory / ("report.pdf" if pdf else "report.html")
    result = folder.load()
    words, cited = case_words(folder.case, result.run)
    with ProgressDisplay(error_console if as_json else console, quiet=quiet) as progress:
        page = render_report(
            folder,
            result,
            progress,
            words=words,
            others=cited,
            interactive=not (plain or pdf),
        )
        if pdf:
            progress("pdf", None, "pages")
            with replacing(file) as temporary:
                temporary.write_bytes(pdf_of(page))
        else:
            write_text(file, page)
    if as_json:
        show_written([Written("report", file)])
    elif not quiet:
        console.print(f"report: {file} ({file.stat().st_size / 1e6:.1f} MB)", soft_wrap=True)
    return ExitCode.DONE


def case_words(file: Path, run: "RunRecord") -> "tuple[tuple[Table, ...], tuple[Table, ...]]":
    """Say a run's case in words, as ``check`` does, or why that cannot be; and what to cite."""
    from quietblade.case import InvalidCaseError, load_case  # noqa: PLC0415  # help must stay fast
    from quietblade.case.changes import read_changes  # noqa: PLC0415
    from quietblade.cli.describe import case_tables  # noqa: PLC0415
    from quietblade.results.table import Table  # noqa: PLC0415
    from quietblade.study.citations import citation_table  # noqa: PLC0415
    from quietblade.study.examine import examine  # noqa: PLC0415
    from quietblade.study.run import run_key  # noqa: PLC0415

    try:
        case = load_case(file).varied(read_changes(run.case_text))
        if run_key(case, run.code_version) == run.content_key:
            told = case_tables(case, examine(case))
            words = tuple(Table(title, (), tuple(rows)) for title, rows in told)
            return words, (citation_table(case, run.code_version),)
        why = "it is not the case of this result; the text of the result's own is at the end"
    except InvalidCaseError as error:
        why = str(error)  # for instance, a file beside the case is gone
    return (Table("In words", (), ((f"{file.name} cannot be told in words", why),)),), ()
