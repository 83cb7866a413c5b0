# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results as labelled arrays: an xarray tree with the unit and meaning of every variable."""

from collections.abc import Iterator, Mapping
from dataclasses import fields
from io import BytesIO
from pathlib import Path
from types import UnionType
from typing import Any, TypeVar, get_args, get_origin, get_type_hints

import numpy as np
import xarray as xr

from quietblade.results.files import ResultError
from quietblade.results.model import ConfigurationResult, Result
from quietblade.results.netcdf import read_tree
from quietblade.results.quantities import CONFIGURATIONS, LABELS, QUANTITIES, Quantity
from quietblade.results.record import Record
from quietblade.typing import AnyArray

FORMAT = "quietblade result"
FORMAT_VERSION = 1

AnyRecord = TypeVar("AnyRecord", bound=Record)


def to_tree(result: Result) -> xr.DataTree:
    """Make an xarray tree of a result; complex values get a dimension ``complex`` of re and im."""
    tree = xr.DataTree.from_dict(dict(_datasets(result, "")))
    tree.attrs.update(format=FORMAT, format_version=FORMAT_VERSION)
    return tree


def from_tree(tree: xr.DataTree) -> Result:
    """Inverse of `to_tree`.

    Raises
    ------
    ResultError
        The tree is not a result, or lacks a variable, or has one that is not registered.
    """
    if tree.attrs.get("format") != FORMAT or tree.attrs.get("format_version") != FORMAT_VERSION:
        raise ResultError(
            f"not a {FORMAT} of version {FORMAT_VERSION}, but "
            f"{tree.attrs.get('format', 'something else')!r} of version "
            f"{tree.attrs.get('format_version', 'unknown')}; run the case again"
        )
    check_registered(tree)
    return _read(Result, tree)


def record_tree(record: Record) -> xr.DataTree:
    """Make a tree of a record that stands beside the results of runs, in the group of its name."""
    return xr.DataTree.from_dict(dict(_datasets(record, f"/{record.group}")))


def read_record(cls: type[AnyRecord], tree: xr.DataTree) -> AnyRecord:
    """Inverse of `record_tree`.

    Raises
    ------
    ResultError
        The tree holds no such record, or lacks a variable, or has one that is not registered.
    """
    check_registered(tree)
    return _read(cls, _member(tree.children, cls.group, ""))


def write(tree: xr.DataTree, path: Path) -> None:
    """Write a tree of registered variables as netCDF.

    Raises
    ------
    ResultError
        A variable is not registered.
    """
    check_registered(tree)
    content = BytesIO()
    tree.to_netcdf(content, engine="h5netcdf")
    # not by HDF5 itself, which ends the process on a full disk
    path.write_bytes(content.getbuffer())


def read(path: Path) -> xr.DataTree:
    """Read a netCDF file into memory.

    Raises
    ------
    ResultError
        The file is not netCDF.
    """
    try:
        return read_tree(path)
    except (OSError, ValueError, LookupError, RuntimeError) as error:
        raise ResultError(f"{path}: not a readable netCDF file ({error})") from error


def check_registered(tree: xr.DataTree) -> None:
    """Refuse variables that nobody has registered, and registered ones of other dimensions.

    Raises
    ------
    ResultError
        Names the variable.
    """
    for node in tree.subtree:
        for name, variable in node.to_dataset(inherit=False).variables.items():
            key = _key(node.path, str(name))
            if name in LABELS:
                known = variable.dims == (name,) and tuple(variable.values) == LABELS[str(name)]
            else:
                known = key in QUANTITIES and variable.dims == _dims(QUANTITIES[key])
            if not known:
                raise ResultError(
                    f"variable {key!r} with dimensions {variable.dims} is not registered in "
                    "quietblade.results.quantities"
                )


def _datasets(
    record: Record, path: str, *, random: bool = False
) -> Iterator[tuple[str, xr.Dataset]]:
    random = random or (isinstance(record, ConfigurationResult) and record.random)
    yield path or "/", _dataset(record, random=random)
    for field in fields(record):
        value = getattr(record, field.name)
        if isinstance(value, Record):
            yield from _datasets(value, f"{path}/{field.name}", random=random)
        elif isinstance(value, Mapping):
            for name, member in value.items():
                yield from _datasets(member, f"{path}/{name}")


def _dataset(record: Record, *, random: bool = False) -> xr.Dataset:
    arrays = record.arrays()
    variables = {
        q.name: _variable(q.per_hertz() if random else q, arrays[q.name])
        for q in record.quantities()
    }
    dims = {dim for variable in variables.values() for dim in variable.dims}
    labels = {str(dim): list(LABELS[str(dim)]) for dim in sorted(map(str, dims)) if dim in LABELS}
    return xr.Dataset(variables, coords=labels)


def _variable(quantity: Quantity, array: AnyArray) -> xr.Variable:
    if quantity.kind == "complex":
        array = np.stack([array.real, array.imag], axis=-1)
    attributes = {
        "long_name": quantity.description,
        "units": quantity.unit,
        "reference": quantity.reference,
        "symbol": quantity.symbol,
        "equation": quantity.equation,
    }
    return xr.Variable(_dims(quantity), array, {k: v for k, v in attributes.items() if v})


def _dims(quantity: Quantity) -> tuple[str, ...]:
    return (*quantity.dims, "complex") if quantity.kind == "complex" else quantity.dims


def _key(path: str, name: str) -> str:
    first, *rest = path.strip("/").split("/")
    group = "/".join(["C*" if first in CONFIGURATIONS else first, *rest])
    return f"{group}/{name}".lstrip("/")


def _read(cls: type[AnyRecord], node: xr.DataTree) -> AnyRecord:
    hints = get_type_hints(cls)
    values: dict[str, Any] = {}
    for field in fields(cls):
        hint = hints[field.name]
        if get_origin(hint) is Mapping:
            member = get_args(hint)[1]
            present = [name for name in CONFIGURATIONS if name in node.children]
            values[field.name] = {name: _read(member, node.children[name]) for name in present}
        elif type(None) in get_args(hint) and field.name not in node.children and _of_body(node):
            values[field.name] = None  # step 1, which only a blade has
        elif issubclass(_record_type(hint), Record):
            values[field.name] = _read(
                _record_type(hint), _member(node.children, field.name, node.path)
            )
        else:
            variable = _member(node.variables, field.name, node.path)
            values[field.name] = _value(QUANTITIES[_key(node.path, field.name)], variable.values)
    return cls(**values)


def _record_type(hint: Any) -> Any:
    """Take the first of a type that may be None, and what a mapping is of."""
    return get_args(hint)[0] if get_origin(hint) is UnionType else get_origin(hint) or hint


def _of_body(node: xr.DataTree) -> bool:
    """Whether the solid of a result is a body that is no blade, which has no step 1."""
    return "body" in _member(node.children, "mesh", "")["cells"]["region"].values


def _member(members: Mapping[Any, Any], name: str, path: str) -> Any:
    try:
        return members[name]
    except KeyError:
        raise ResultError(
            f"the result lacks {path.rstrip('/')}/{name}; run the case again"
        ) from None


def _value(quantity: Quantity, array: AnyArray) -> AnyArray:
    if quantity.kind == "complex":
        return array[..., 0] + 1j * array[..., 1]
    if quantity.kind == "text":
        return array.astype(str)
    return array
