# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fields on second-order cells as VTU files that ParaView opens.

An array is called after its registered quantity and a label (a mode, a frequency), for instance
``displacement``, ``mode_shape B5 re`` and ``mode_shape B5 im``; its unit goes with it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

from quietblade.results.files import ResultError, replacing
from quietblade.results.quantities import QUANTITIES, Quantity
from quietblade.typing import AnyArray, FloatArray, IntArray

CELL_TYPES: Mapping[str, int] = {
    "triangle6": int(pv.CellType.QUADRATIC_TRIANGLE),
    "tetra10": int(pv.CellType.QUADRATIC_TETRA),
    "pyramid13": int(pv.CellType.QUADRATIC_PYRAMID),
    "hexahedron20": int(pv.CellType.QUADRATIC_HEXAHEDRON),
}
"""VTK's number of each kind of cell."""


class Cells(Protocol):
    """Cells of one kind, nodes in VTK's order."""

    @property
    def kind(self) -> str:
        """A key of `CELL_TYPES`."""
        ...

    @property
    def connectivity(self) -> IntArray:
        """Node numbers, (cells, nodes)."""
        ...


@dataclass(frozen=True, eq=False)
class PointField:
    """Nodal values of a registered field.

    Attributes
    ----------
    quantity : str
        Name in the group ``fields`` of the register.
    values : (n,) or (n, 3) array
        Values at all nodes of the mesh; NaN where the field is not defined.
    label : str
        Which of several: name of a mode, or a frequency with its unit.
    """

    quantity: str
    values: AnyArray
    label: str = ""

    @property
    def registered(self) -> Quantity:
        """Entry of the register.

        Raises
        ------
        ResultError
            There is none.
        """
        try:
            return QUANTITIES[f"fields/{self.quantity}"]
        except KeyError:
            raise ResultError(f"field {self.quantity!r} is not registered") from None

    def parts(self) -> dict[str, FloatArray]:
        """Real arrays by name: one, or real and imaginary part."""
        name = f"{self.quantity} {self.label}".strip()
        if self.registered.kind == "complex":
            values = np.asarray(self.values, dtype=np.complex128)
            return {f"{name} re": values.real, f"{name} im": values.imag}
        if np.iscomplexobj(self.values):
            raise ResultError(f"field {self.quantity!r} is registered as real, not complex")
        return {name: np.asarray(self.values, dtype=np.float64)}


def write_fields(
    path: Path,
    points: FloatArray,
    cells: Mapping[str, Sequence[Cells]],
    fields: Sequence[PointField] = (),
) -> None:
    """Write a VTU file, whole or not at all.

    Parameters
    ----------
    path : Path
        File to make.
    points : (n, 3) array
        Node positions [m]; nodes without cells are left out.
    cells : mapping
        Region name to its blocks of cells; several regions make one grid with the cell array
        ``region`` (an index) and the list of names ``regions``.
    fields : sequence of PointField
        Point data, with values at all ``n`` nodes.

    Raises
    ------
    ResultError
        A field is not registered, or has another shape.
    """
    grid, used = _grid(points, cells)
    for field in fields:
        shape = (len(points), 3) if field.registered.dims else (len(points),)
        for name, values in field.parts().items():
            if values.shape != shape:
                raise ResultError(f"field {name!r}: shape {values.shape}, expected {shape}")
            grid.point_data[name] = np.ascontiguousarray(values[used])
            array = grid.GetPointData().GetArray(name)
            array.GetInformation().Set(vtkDataArray.UNITS_LABEL(), field.registered.unit)
    with replacing(path) as temporary:
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetFileName(str(temporary))
        writer.SetInputData(grid)
        if not writer.Write():
            raise OSError("VTK could not write the file; the disk may be full")


def read_fields(path: Path) -> pv.UnstructuredGrid:
    """Read a VTU file.

    Raises
    ------
    ResultError
        The file is missing.
    """
    if not path.is_file():
        raise ResultError(f"{path} is missing; run the case again to have its fields")
    return pv.read(path)


def field_values(grid: pv.UnstructuredGrid, quantity: str, label: str = "") -> AnyArray:
    """Nodal values of a field of a grid, complex if it is registered so."""
    field = PointField(quantity, np.empty(0), label)
    parts = [np.asarray(grid.point_data[name]) for name in field.parts()]
    return parts[0] + 1j * parts[1] if len(parts) == 2 else parts[0]


def field_labels(grid: pv.UnstructuredGrid, quantity: str) -> tuple[str, ...]:
    """Labels under which a grid has a complex field, in the order of the file."""
    names = [name for name in grid.point_data if name.startswith(f"{quantity} ")]
    return tuple(name[len(quantity) + 1 : -3] for name in names if name.endswith(" re"))


def region(grid: pv.UnstructuredGrid, name: str) -> pv.UnstructuredGrid:
    """Cells of one region; empty if there are none."""
    names = [str(n) for n in grid.field_data["regions"]]
    wanted = grid.cell_data["region"] == (names.index(name) if name in names else -1)
    return grid.extract_cells(np.flatnonzero(wanted))


def _grid(
    points: FloatArray, cells: Mapping[str, Sequence[Cells]]
) -> tuple[pv.UnstructuredGrid, IntArray]:
    blocks = [(i, block) for i, members in enumerate(cells.values()) for block in members]
    nodes = [block.connectivity.ravel() for _, block in blocks]
    used = np.unique(np.concatenate(nodes)).astype(np.int64)
    new_number = np.zeros(len(points), dtype=np.int64)
    new_number[used] = np.arange(len(used))
    lists: list[AnyArray] = []
    types: list[AnyArray] = []
    regions: list[AnyArray] = []
    for index, block in blocks:
        n, width = block.connectivity.shape
        lists.append(np.c_[np.full(n, width), new_number[block.connectivity]].ravel())
        types.append(np.full(n, CELL_TYPES[block.kind], dtype=np.uint8))
        regions.append(np.full(n, index, dtype=np.int32))
    grid: Any = pv.UnstructuredGrid(
        np.concatenate(lists), np.concatenate(types), np.ascontiguousarray(points[used])
    )
    grid.cell_data["region"] = np.concatenate(regions)
    grid.field_data["regions"] = list(cells)
    return grid, used
