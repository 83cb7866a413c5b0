# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reading the netCDF files of results, which have many small arrays in many groups.

xarray asks of each variable all that a file of anybody's might say about it, which takes ten times
as long. A netCDF file is an HDF5 file whose dimensions are dimension scales, and of ours nothing
but values and dimensions is wanted: what they mean is in the register.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import xarray as xr

from quietblade.typing import AnyArray

_NO_VARIABLE = b"This is a netCDF dimension but not a netCDF variable"
"""How netCDF calls the scale of a dimension without coordinates."""


def read_tree(path: Path) -> xr.DataTree:
    """Read values and dimensions of a netCDF file, and the attributes of the file itself.

    Parameters
    ----------
    path : Path
        As xarray writes it, complex values apart.

    Raises
    ------
    OSError, ValueError
        The file is not HDF5, or is damaged.
    """
    with h5py.File(path) as file:
        tree = xr.DataTree.from_dict(dict(_datasets(file, {})))
        tree.attrs.update({k: _attribute(v) for k, v in file.attrs.items() if k[0] != "_"})
    return tree


def _datasets(group: h5py.Group, known: Mapping[Any, str]) -> Iterator[tuple[str, xr.Dataset]]:
    """Go through the groups; a dimension is known in its group and in those inside it."""
    members = dict(group.items())
    arrays = {name: m for name, m in members.items() if isinstance(m, h5py.Dataset)}
    scales = dict(known) | {array: name for name, array in arrays.items() if array.is_scale}
    yield (
        group.name,
        xr.Dataset(
            {
                name: xr.Variable(_dims(array, scales), _values(array))
                for name, array in arrays.items()
                if not bytes(array.attrs.get("NAME", b"")).startswith(_NO_VARIABLE)
            }
        ),
    )
    for member in members.values():
        if isinstance(member, h5py.Group):
            yield from _datasets(member, scales)


def _dims(array: h5py.Dataset, scales: Mapping[Any, str]) -> tuple[str, ...]:
    if array in scales:
        return (scales[array],)
    references = array.attrs.get("DIMENSION_LIST", ())
    return tuple(scales[array.file[first]] for first, *_ in references)


def _values(array: h5py.Dataset) -> AnyArray:
    values = array.asstr()[()] if h5py.check_string_dtype(array.dtype) else array[()]
    # netCDF has no flags: xarray writes bytes, and says so
    return np.asarray(values, dtype=bool if array.attrs.get("dtype") == "bool" else None)


def _attribute(value: Any) -> Any:
    return value.item() if getattr(value, "size", 0) == 1 else value
