# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fields of a run as VTKHDF files: the same grids and names as the VTU files, in HDF5."""

from pathlib import Path
from typing import Any

import h5py
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkDataArray

from quietblade.results.files import ResultError, replacing
from quietblade.results.store import RunFolder
from quietblade.results.vtk import read_fields

_COMPRESSION = 4
"""Of 9; more takes longer and gains little."""


def write_vtkhdf(folder: RunFolder, out: Path) -> tuple[Path, ...]:
    """Write every file of fields of a run as VTKHDF: ``static.vtkhdf``, ``modes-C0.vtkhdf`` ...

    The format has no dots in names: ``response 136.52 Hz re`` becomes ``response 136_52 Hz re``.
    VTK keeps no units in it; they are the attribute ``units`` of each array in HDF5.

    Parameters
    ----------
    folder : RunFolder
        A finished run.
    out : Path
        Folder to write into; made if need be.

    Returns
    -------
    tuple of Path
        The files.

    Raises
    ------
    ResultError
        The installed VTK cannot write such files, or the run lacks its result or fields.
    """
    make = _writer()
    folder.load()  # whose errors say what is wrong with the folder
    sources = sorted(folder.static_fields.parent.glob("*.vtu")) or [folder.static_fields]
    files = []
    for source in sources:
        grid = read_fields(source)
        units = {}
        for array in map(grid.GetPointData().GetArray, grid.point_data.keys()):
            array.SetName(array.GetName().replace(".", "_"))
            units[array.GetName()] = array.GetInformation().Get(vtkDataArray.UNITS_LABEL())
        file = out / f"{source.stem}.vtkhdf"
        with replacing(file) as temporary:
            writer = make()
            writer.SetFileName(str(temporary))
            writer.SetInputData(grid)
            writer.SetCompressionLevel(_COMPRESSION)
            if not writer.Write():
                raise OSError("VTK could not write the file; the disk may be full")
            del writer  # which would hold the file
            with h5py.File(temporary, "r+") as content:
                for name, unit in units.items():
                    content["VTKHDF/PointData"][name].attrs["units"] = unit
        files.append(file)
    return tuple(files)


def _writer() -> Any:
    try:
        from vtkmodules.vtkIOHDF import vtkHDFWriter  # noqa: PLC0415  # not in every VTK
    except ImportError:
        version = ".".join(map(str, pv.vtk_version_info))
        raise ResultError(
            f"VTKHDF files are written by VTK 9.4 and later, here is {version}; install another "
            'with `pip install --upgrade "vtk>=9.4"`'
        ) from None
    return vtkHDFWriter
