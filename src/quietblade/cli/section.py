# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade section``: pressure, polars and cavitation bucket of one section."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from quietblade.cli.common import ExitCode, console, show_json

if TYPE_CHECKING:  # numpy takes longer than help may
    from quietblade.cli.section_words import Section
    from quietblade.flow.polar import Polar
    from quietblade.typing import FloatArray

_COLUMNS = {
    "alpha_deg": "alpha [deg]",
    "cl": "C_L",
    "cm_quarter": "C_M",
    "suction": "-Cp_min",
    "cd": "C_D",
    "transition_upper": "x_tr up",
    "transition_lower": "x_tr low",
    "separation_upper": "x_sep up",
    "separation_lower": "x_sep low",
}


def section(
    shape: Annotated[
        str,
        typer.Argument(
            help="A family (naca-66-a08), a designation (naca2412, 23012) or a coordinate file."
        ),
    ],
    thickness: Annotated[
        str | None, typer.Option(help="Of a family or file, of the chord: 0.06 or '6 %'.")
    ] = None,
    camber: Annotated[
        str | None, typer.Option(help="Of a family or file, of the chord: 0.02 or '2 %'.")
    ] = None,
    trailing_edge: Annotated[
        str | None, typer.Option(help="Thickness of the edge, of the chord. [default: 0]")
    ] = None,
    angles: Annotated[
        str, typer.Option(help="Incidences of the polar: first:last:step unit.")
    ] = "-4:10:0.5 deg",
    at: Annotated[
        list[str] | None,
        typer.Option(help="Incidence of a pressure curve; several times for more. [0 and 4 deg]"),
    ] = None,
    reynolds: Annotated[
        list[float] | None,
        typer.Option(help="Adds a boundary layer at this Reynolds number; several times for more."),
    ] = None,
    n_crit: Annotated[float, typer.Option(help="Growth of disturbances at transition.")] = 9.0,
    nodes: Annotated[int, typer.Option(help="Nodes of the contour, odd.")] = 161,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Folder for tables and pictures.")
    ] = None,
    picture: Annotated[str, typer.Option("--format", help="png, svg or pdf.")] = "png",
    as_json: Annotated[bool, typer.Option("--json", help="Print the numbers as JSON.")] = False,
) -> ExitCode:
    """Draw pressure, polars and cavitation bucket of a section, and write them as tables."""
    from quietblade.cli.section_words import (  # noqa: PLC0415  # help must stay fast
        angle,
        angle_range,
        make_section,
    )

    if picture not in ("png", "svg", "pdf"):
        raise typer.BadParameter(f"--format {picture}: use png, svg or pdf")
    if any(not 1e3 <= value <= 1e10 for value in reynolds or ()):
        raise typer.BadParameter("--reynolds must lie between 1e3 and 1e10")
    if not 1.0 <= n_crit <= 20.0:
        raise typer.BadParameter("--n-crit must lie between 1 and 20")
    made = make_section(shape, thickness, camber, trailing_edge, nodes)
    shown = [angle(text) for text in at or ("0 deg", "4 deg")]
    polars, cp = _solve(made, angle_range(angles), shown, reynolds or [], n_crit)
    folder = out or Path(f"section-{made.slug}")
    files = _write(made, shown, cp, polars, folder, picture)
    if as_json:
        show_json(_data(made, shown, cp, polars, files))
    else:
        _show(made, polars)
        console.print(f"tables and pictures: {folder}", soft_wrap=True)
    return ExitCode.DONE


def _solve(
    made: Section,
    alpha: FloatArray,
    shown: list[float],
    reynolds: list[float],
    n_crit: float,
) -> tuple[list[Polar], FloatArray]:
    """Polars, and the pressure (A, N) at the incidences that are drawn."""
    import numpy as np  # noqa: PLC0415

    from quietblade.cli.section_words import refused  # noqa: PLC0415
    from quietblade.flow.panel import PanelSections  # noqa: PLC0415
    from quietblade.flow.polar import section_polar  # noqa: PLC0415

    with refused():
        numbers: list[float | None] = [*reynolds] or [None]
        polars = [section_polar(made.contour, alpha, re, n_crit=n_crit) for re in numbers]
        solution = PanelSections(made.contour[None]).solve(np.array(shown)[:, None])
    return polars, solution.cp[:, 0]


def _write(
    made: Section,
    shown: list[float],
    cp: FloatArray,
    polars: list[Polar],
    folder: Path,
    picture: str,
) -> list[Path]:
    """Write tables and pictures and return their places."""
    import numpy as np  # noqa: PLC0415

    from quietblade.cli.section_words import refused, write_table  # noqa: PLC0415
    from quietblade.view import polars as view  # noqa: PLC0415

    angles = np.array(shown)
    figures = {
        "pressure": view.draw_pressure(made.contour, angles, cp, made.title),
        "polars": view.draw_polars(polars, made.title),
        "bucket": view.draw_bucket(polars, made.title),
    }
    rows = [row for polar in polars for row in _rows(polar)]
    heads = ["x", "y", *(f"cp_{np.degrees(a):.4g}deg" for a in angles)]
    with refused():
        folder.mkdir(parents=True, exist_ok=True)
        files = [folder / f"{name}.{picture}" for name in figures]
        for file, figure in zip(files, figures.values(), strict=True):
            figure.savefig(file)
        pressure, table = folder / "pressure.csv", folder / "polars.csv"
        write_table(pressure, heads, np.column_stack([made.contour, cp.T]).tolist())
        write_table(table, list(rows[0]), [list(row.values()) for row in rows])
    return [*files, pressure, table]


def _rows(polar: Polar) -> list[dict[str, Any]]:
    import numpy as np  # noqa: PLC0415

    fields = (
        np.degrees(polar.alpha),
        polar.lift_coefficient,
        polar.moment_coefficient,
        polar.minimum_pressure,
        polar.drag_coefficient,
        polar.transition_upper,
        polar.transition_lower,
        polar.separation_upper,
        polar.separation_lower,
    )
    rows = []
    for values, stalled in zip(zip(*fields, strict=True), polar.stalled, strict=True):
        figures = [None if np.isnan(value) else round(float(value), 8) for value in values]
        row = dict(zip(_COLUMNS, figures, strict=True))
        rows.append({"reynolds": polar.reynolds, **row, "stalled": bool(stalled)})
    return rows


def _show(made: Section, polars: list[Polar]) -> None:
    from rich.table import Table  # noqa: PLC0415
    from rich.text import Text  # noqa: PLC0415

    console.print(Text(made.title, style="bold"))
    console.print(
        f"thickness {made.thickness:.4g}, camber {made.camber:.4g}, trailing edge "
        f"{made.trailing_edge:.4g} of the chord; {len(made.contour)} nodes"
    )
    for polar in polars:
        viscous = polar.reynolds is not None
        names = list(_COLUMNS) if viscous else list(_COLUMNS)[:4]
        head = f"Reynolds number {polar.reynolds:.4g}, one-way boundary layer" if viscous else ""
        table = Table(title=head or "inviscid", title_justify="left", box=None, pad_edge=False)
        for name in names:
            table.add_column(Text(_COLUMNS[name], style="cyan"), justify="right")
        if viscous:
            table.add_column("")
        for row in _rows(polar):
            texts = [_figure(row[name], name) for name in names]
            table.add_row(*texts, *(["stalled" if row["stalled"] else ""] if viscous else []))
        console.print()
        console.print(table)


def _figure(value: float | None, name: str) -> str:
    if value is None:
        return "-"
    return (
        f"{value:.5f}"
        if name == "cd"
        else f"{value:.4g}"
        if name == "alpha_deg"
        else f"{value:.3f}"
    )


def _data(
    made: Section, shown: list[float], cp: FloatArray, polars: list[Polar], files: list[Path]
) -> dict[str, Any]:
    return {
        "section": made.title,
        "thickness": made.thickness,
        "camber": made.camber,
        "trailing_edge": made.trailing_edge,
        "contour": made.contour.tolist(),
        "pressure": [
            {"alpha_rad": a, "cp": row.tolist()} for a, row in zip(shown, cp, strict=True)
        ],
        "polars": [row for polar in polars for row in _rows(polar)],
        "files": [str(file) for file in files],
    }
