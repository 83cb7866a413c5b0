# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tidy table of a study: one row a run, one column a figure, with unit and meaning."""

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import xarray as xr

from quietblade.results.files import ResultError, replacing, write_text
from quietblade.results.study_convergence import grid_convergence
from quietblade.results.study_figures import Figure
from quietblade.results.table import Table, number

FORMAT = "quietblade study"

SHOWN = ("nodes", "tip_displacement_y", "lift_gain", "film_shear_strain", "tip_blade_angle",
         "C0_mean_level", "C1_mean_level")  # fmt: skip
"""Figures of the printed table if the study file names none."""

_COSTS = ("nodes", "unknowns", "seconds", "passes")  # figures that no mesh makes more accurate


@dataclass(frozen=True)
class StudyRow:
    """One run of a study.

    Attributes
    ----------
    case, variant : str
        Names of the study file.
    changes : mapping
        Keys of the case that the variant changes to what it writes.
    state : {"finished", "not converged", "failed"}
    message : str
        Why a run failed.
    figures : tuple of Figure
        None of a failed run.
    """

    case: str
    variant: str
    changes: Mapping[str, str]
    state: str
    message: str = ""
    figures: tuple[Figure, ...] = ()

    @property
    def run(self) -> str:
        """Name of the run's folder."""
        return run_name(self.case, self.variant)

    def figure(self, name: str) -> float:
        """Value of a figure, nan if the run does not have it."""
        return next((f.value for f in self.figures if f.name == name), float("nan"))


def run_name(case: str, variant: str) -> str:
    """Name of the folder of a run inside that of the study."""
    return f"{case}-{variant}"


@dataclass(frozen=True)
class StudyTable:
    """All runs of a study.

    Attributes
    ----------
    title : str
    rows : tuple of StudyRow
    shown : tuple of str
        Figures of the printed table.
    """

    title: str
    rows: tuple[StudyRow, ...]
    shown: tuple[str, ...] = field(default=SHOWN)

    def columns(self) -> dict[str, Figure]:
        """Every figure that some run has, by name."""
        return {f.name: f for row in self.rows for f in row.figures}

    def keys(self) -> tuple[str, ...]:
        """Every key that some variant changes."""
        return tuple(dict.fromkeys(key for row in self.rows for key in row.changes))

    def to_dataset(self) -> xr.Dataset:
        """Labelled arrays along the dimension ``run``; changes are texts named ``set_KEY``."""
        labels = {
            "run": [row.run for row in self.rows],
            "case": ("run", [row.case for row in self.rows]),
            "variant": ("run", [row.variant for row in self.rows]),
            "state": ("run", [row.state for row in self.rows]),
            "message": ("run", [row.message for row in self.rows]),
        }
        labels |= {
            f"set_{key}": ("run", [row.changes.get(key, "") for row in self.rows])
            for key in self.keys()
        }
        variables = {
            name: xr.Variable(
                ("run",),
                np.array([row.figure(name) for row in self.rows]),
                {"units": figure.unit, "long_name": figure.meaning},
            )
            for name, figure in self.columns().items()
        }
        attributes = {"format": FORMAT, "title": self.title, "shown": " ".join(self.shown)}
        return xr.Dataset(variables, labels, attributes)

    @classmethod
    def from_dataset(cls, data: xr.Dataset) -> "StudyTable":
        """Inverse of `to_dataset`.

        Raises
        ------
        ResultError
            These are not the arrays of a study.
        """
        if data.attrs.get("format") != FORMAT:
            raise ResultError(f"not a {FORMAT}, but {data.attrs.get('format', 'something else')!r}")
        rows = []
        for k in range(data.sizes["run"]):
            text = {str(name): str(data[name].values[k]) for name in data.coords if name != "run"}
            changes = {
                name.removeprefix("set_"): value
                for name, value in text.items()
                if name.startswith("set_") and value
            }
            figures = tuple(
                Figure(
                    str(name),
                    float(array.values[k]),
                    array.attrs["units"],
                    array.attrs["long_name"],
                )
                for name, array in data.data_vars.items()
                if np.isfinite(array.values[k])
            )
            row = text["case"], text["variant"], changes, text["state"], text["message"], figures
            rows.append(StudyRow(*row))
        return cls(data.attrs["title"], tuple(rows), tuple(data.attrs["shown"].split()))

    def to_csv(self) -> str:
        """One row a run; heads carry the units."""
        columns, keys = self.columns(), self.keys()
        heads = [f"{f.name} [{f.unit}]" for f in columns.values()]
        rows = [
            [row.case, row.variant, row.state, *(row.changes.get(key, "") for key in keys),
             *(_digits(row.figure(name)) for name in columns)]
            for row in self.rows
        ]  # fmt: skip
        return as_csv(["case", "variant", "state", *keys, *heads], rows)

    def table(self) -> Table:
        """Table of the figures that are shown."""
        columns = self.columns()
        known = [
            n.replace("_", " ") + (f" [{columns[n].unit}]" if n in columns else "")
            for n in self.shown
        ]
        rows = tuple(
            (row.run, row.state, *(number(_finite(row.figure(n)), ".5g") for n in self.shown))
            for row in self.rows
        )
        missing = [name for name in self.shown if name not in columns]
        note = f"no run has {', '.join(missing)}; study.csv names the figures" if missing else ""
        return Table("Runs", ("run", "", *known), rows, note)

    def failures(self) -> Table:
        """Table of the runs that failed, and why."""
        rows = tuple((row.run, row.message) for row in self.rows if row.state == "failed")
        return Table("Failed", (), rows)


def as_csv(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Write comma-separated values."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(heads)
    writer.writerows(rows)
    return out.getvalue()


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _digits(value: float) -> str:
    return f"{value:.10g}" if np.isfinite(value) else ""


def convergence_csv(table: StudyTable, variants: Sequence[str]) -> str:
    """Uncertainty of every figure that the three finest of some meshes have.

    Parameters
    ----------
    table : StudyTable
    variants : sequence of str
        Names of the meshes, the finest first.
    """
    lines = []
    for case in dict.fromkeys(row.case for row in table.rows):
        meshes = [
            row
            for variant in variants
            for row in table.rows
            if (row.case, row.variant) == (case, variant) and row.figures
        ][:3]
        sizes = [row.figure("nodes") ** (-1.0 / 3.0) for row in meshes]
        if len(meshes) < 3 or not sizes[0] < sizes[1] < sizes[2]:
            continue
        for figure in table.columns().values():
            values = [row.figure(figure.name) for row in meshes]
            if figure.name in _COSTS or not np.all(np.isfinite(values)):
                continue
            found = grid_convergence(sizes, values)
            numbers = (*values, found.order, found.extrapolated, found.uncertainty, found.index)
            lines.append([case, figure.name, figure.unit, *map(_digits, numbers), found.behaviour])
    heads = ("case", "figure", "unit", "fine", "medium", "coarse", "order", "extrapolated",
             "uncertainty", "index", "behaviour")  # fmt: skip
    return as_csv(heads, lines)


def write_study(table: StudyTable, root: Path) -> None:
    """Write ``study.csv`` and, last, ``study.nc`` into a folder."""
    write_text(root / "study.csv", table.to_csv())
    with replacing(root / "study.nc") as temporary:
        content = io.BytesIO()
        table.to_dataset().to_netcdf(content, engine="h5netcdf")
        temporary.write_bytes(content.getbuffer())  # see `quietblade.results.dataset.write`


def is_study(root: Path) -> bool:
    """Tell whether a folder is that of a study."""
    return (root / "study.nc").is_file()


def read_study(root: Path) -> StudyTable:
    """Read the table of a study's folder.

    Raises
    ------
    ResultError
        There is none, or it cannot be read.
    """
    file = root / "study.nc"
    if not file.is_file():
        raise ResultError(f"{root}: no study.nc here; make one with `quietblade study FILE.toml`")
    try:
        with xr.open_dataset(file, engine="h5netcdf") as data:
            return StudyTable.from_dataset(data.load())
    except (OSError, ValueError) as error:
        raise ResultError(f"{file}: not a readable netCDF file ({error})") from error
