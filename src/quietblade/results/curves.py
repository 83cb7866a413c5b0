# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every array of a result as CSV files: one a group and set of coordinates, made from the register.

Rows run over the dimensions that have lengths of their own (frequency, section, mode ...), the last
one fastest; dimensions with named entries (axis, state, path ...) become columns. Lines that begin
with ``#`` say what the columns are.
"""

import csv
from collections.abc import Iterator, Mapping
from functools import partial
from io import StringIO
from itertools import product
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeAlias

import numpy as np
import xarray as xr

from quietblade.results.dataset import to_tree
from quietblade.results.files import ResultError, write_text
from quietblade.results.model import Result
from quietblade.results.quantities import CONFIGURATIONS, DIMENSIONS, LABELS

PLACES: Mapping[str, str] = MappingProxyType(
    {
        "frequency": "C*/spectrum/frequency",
        "section": "static/sections/span_fraction",
        "mode": "C*/modes/name",
        "lossy": "C*/loss_shares/name",
        "response": "C*/participation/frequency",
        "dry_mode": "C*/dry_modes/name",
        "shaft": "campbell/rotation",
        "branch": "campbell/name",
        "order": "campbell/order",
        "peak": "C*/peaks/frequency",
        "grid": "C*/stepped/step",
        "band": "C*/bands/centre",
        "pattern": "C*/directivity/frequency",
        "cut": "C*/directivity/cut",
        "angle": "C*/directivity/angle",
        "polar": "C*/directivity/polar",
        "azimuth": "C*/directivity/azimuth",
        "limit": "C*/limits/name",
        "limit_row": "C*/limits/frequency",
        "sink": "C*/dissipation/sink",
        "modulus": "moduli/name",
        "sample": "moduli/frequency",
        "excitation": "C*/excitations/name",
        "part": "mesh/unknowns/part",
        "region": "mesh/quality/region",
        "solid": "static/stress/region",
        "stage": "run/timings/stage",
    }
)
"""What tells the places along a dimension; along the others they are counted from 0."""

_MARK = "# "
Groups: TypeAlias = Mapping[str, xr.Dataset]


def write_curves(result: Result, folder: Path) -> tuple[Path, ...]:
    """Write all arrays of a result.

    Parameters
    ----------
    result : Result
    folder : Path
        Made if need be; files of the same names are replaced.

    Returns
    -------
    tuple of Path
        The files, and ``index.csv``, which says what is in which.
    """
    nodes = to_tree(result).subtree
    groups = {node.path.strip("/"): node.to_dataset(inherit=False) for node in nodes}
    folder.mkdir(parents=True, exist_ok=True)
    rows, files = [["file", "rows", "columns"]], []
    for name, text, count, columns in _tables(groups):
        files.append(folder / f"{name}.csv")
        write_text(files[-1], text)
        rows.append([files[-1].name, str(count), "; ".join(columns)])
    index = folder / "index.csv"
    write_text(index, _lines(rows))
    return (*files, index)


def read_curves(file: Path) -> dict[str, list[str]]:
    """Read the columns of a file as texts, by their heads."""
    lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    body = csv.reader(line for line in lines if not line.startswith(_MARK))
    head, *rows = body
    if any(len(row) != len(head) for row in rows):
        raise ResultError(f"{file}: rows of different length")
    return {name: [row[k] for row in rows] for k, name in enumerate(head)}


def _tables(groups: Groups) -> Iterator[tuple[str, str, int, list[str]]]:
    """File name, text, number of rows and heads of each table that has any rows."""
    for path, data in groups.items():
        together: dict[tuple[str, ...], list[str]] = {}
        for name, variable in data.variables.items():
            if name not in LABELS:
                own = tuple(str(d) for d in variable.dims if d not in LABELS)
                together.setdefault(own, []).append(str(name))
        for dims, names in together.items():
            stem = "-".join([*(path.split("/") if path else ["case"]), *dims])
            make = partial(_table, groups, path, dims) if dims else _scalars
            comments, rows = make(data=data, names=names)
            if len(rows) > 1:
                text = "".join(f"{_MARK}{line}\n" for line in comments) + _lines(rows)
                yield stem, text, len(rows) - 1, rows[0]


def _scalars(data: xr.Dataset, names: list[str]) -> tuple[list[str], list[list[str]]]:
    """Single values, one a row; values with named entries, one an entry."""
    rows = [["name", "value", "unit", "meaning"]]
    for name in names:
        variable = data[name].variable
        for labels, at in _entries(variable):
            value = variable.isel(at).values[()]
            if "\n" in str(value):
                continue  # the text of the case, which is beside the result
            rows.append([f"{name}{labels}", _text(value), _unit(variable), _meaning(variable)])
    return ["single values"], rows


def _table(
    groups: Groups, path: str, dims: tuple[str, ...], data: xr.Dataset, names: list[str]
) -> tuple[list[str], list[list[str]]]:
    sizes = [data.sizes[d] for d in dims]
    places = [_places(groups, path, d, n) for d, n in zip(dims, sizes, strict=True)]
    first = PLACES.get(dims[0], "").replace("C*", path.split("/", maxsplit=1)[0]).rpartition("/")
    own = first[2] if len(dims) == 1 and first[0] == path else ""
    names = sorted(names, key=lambda name: name != own)  # what tells the places comes first
    heads, columns = [], []
    comments = [f"{d}: {DIMENSIONS[d]}" for d in dims]
    index = np.indices(sizes).reshape(len(dims), -1)
    for dim, (along, unit), number in zip(dims, places, index, strict=True):
        if own:
            continue
        heads.append(f"{dim} [{unit}]" if unit else dim)
        columns.append([_text(along[k]) for k in number])
    for name in names:
        variable = data[name].variable
        unit = _unit(variable)
        known = {"symbol": variable.attrs.get("symbol", ""), "unit": unit}
        said = "".join(f"; {what} {text}" for what, text in known.items() if text)
        comments.append(f"{name}: {_meaning(variable)}{said}")
        for labels, at in _entries(variable):
            values = variable.isel(at).transpose(*dims).values.ravel()
            heads.append(f"{name}{labels} [{unit}]" if unit else f"{name}{labels}")
            columns.append([_text(value) for value in values])
    return comments, [heads, *map(list, zip(*columns, strict=True))]


def _places(groups: Groups, path: str, dim: str, size: int) -> tuple[list[Any], str]:
    """Values that tell the places along a dimension, of the same configuration, and their unit."""
    first = path.split("/", maxsplit=1)[0]
    key = PLACES.get(dim, "").replace("C*", first if first in CONFIGURATIONS else "C*")
    group, _, name = key.rpartition("/")
    if key and group in groups:
        variable = groups[group][name].variable
        if variable.sizes[dim] == size:
            return list(variable.values), _unit(variable)
    return list(range(size)), ""


def _entries(variable: xr.Variable) -> Iterator[tuple[str, dict[str, int]]]:
    """Each combination of named entries: how a head names it, and where it is."""
    named = [str(d) for d in variable.dims if d in LABELS]
    for at in product(*(range(len(LABELS[d])) for d in named)):
        labels = "".join(f"({LABELS[d][k]})" for d, k in zip(named, at, strict=True))
        yield labels, dict(zip(named, at, strict=True))


def _unit(variable: xr.Variable) -> str:
    unit, reference = variable.attrs.get("units", ""), variable.attrs.get("reference", "")
    return f"{unit} re {reference}" if reference else str(unit)


def _meaning(variable: xr.Variable) -> str:
    meaning, equation = variable.attrs["long_name"], variable.attrs.get("equation", "")
    return f"{meaning}: {equation}" if equation else str(meaning)


def _text(value: Any) -> str:
    """Shortest text that is read back as the same value; empty for a number that is not known."""
    if isinstance(value, float | np.floating):
        return "" if np.isnan(value) else repr(float(value))
    return str(value)


def _lines(rows: list[list[str]]) -> str:
    out = StringIO()
    csv.writer(out, lineterminator="\n").writerows(rows)
    return out.getvalue()
