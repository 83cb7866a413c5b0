# SPDX-License-Identifier: LGPL-2.1-or-later
"""Universal files for modal test people: nodes, surface, mode shapes and functions of frequency.

Data sets 164 (units: SI), 2411 (nodes), 2412 (triangles of the surface), 55 (mode shapes) and 58
(functions), written by pyuff.
"""

from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv

from quietblade.results.files import ResultError, replacing
from quietblade.results.model import ConfigurationResult
from quietblade.results.quantities import LABELS, Quantity
from quietblade.results.record import Record
from quietblade.results.store import RunFolder
from quietblade.results.vtk import field_values, read_fields
from quietblade.typing import AnyArray, IntArray

_WIDTH = 80  # of a line of text
_GENERAL, _DISPLACEMENT, _REACTION, _VELOCITY = 1, 8, 9, 11
_FORCE, _PRESSURE, _FREQUENCY = 13, 15, 18
_KINDS = {"m/(s N)": (_VELOCITY, _FORCE), "Pa": (_PRESSURE, 0), "N": (_REACTION, 0)}
"""Specific data types of numerator and denominator by unit."""


def write_uff(folder: RunFolder, out: Path) -> tuple[Path, ...]:
    """Write one universal file for each configuration of a run: ``C0.uff``, ``C1.uff``.

    Mode shapes are those of the run's fields, complex, with a largest displacement of 1, at the
    corners of the surface's triangles. Their eigenvalue is ``2 pi f_n (i - eta_n / 2)``; modal A
    and B are not given (0). Functions are all registered arrays over frequency, at the frequencies
    where they are known.

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
        pyuff is not installed, or the run lacks its result or fields.
    """
    try:
        import pyuff  # noqa: PLC0415  # optional
    except ImportError:
        raise ResultError(
            "universal files need the package pyuff, which is not installed; install it with "
            '`pip install "quietblade[uff]"`'
        ) from None
    result = folder.load()
    out.mkdir(parents=True, exist_ok=True)
    files = []
    for name, found in result.configurations.items():
        grid = read_fields(folder.mode_fields(name))
        title = f"{result.title or 'quietblade'}, configuration {name}"
        sets = [*_surface(grid), *_shapes(grid, found, title), *_functions(found, title)]
        files.append(out / f"{name}.uff")
        with replacing(files[-1]) as temporary:
            pyuff.UFF(str(temporary)).write_sets(sets, mode="overwrite")
    return tuple(files)


def _surface(grid: pv.UnstructuredGrid) -> Iterator[dict[Any, Any]]:
    """Units, nodes and triangles."""
    yield {
        "type": 164, "units_code": 1, "units_description": "SI", "temp_mode": 1,
        "length": 1.0, "force": 1.0, "temp": 1.0, "temp_offset": 0.0,
    }  # fmt: skip
    triangles = _triangles(grid)
    nodes = np.unique(triangles)
    zeros = np.zeros(len(nodes), dtype=int)
    x, y, z = np.asarray(grid.points, dtype=float)[nodes].T
    yield {
        "type": 2411, "node_nums": 1 + nodes, "def_cs": zeros, "disp_cs": zeros,
        "color": 1 + zeros, "x": x, "y": y, "z": z,
    }  # fmt: skip
    linear_triangle = 91
    rows = [
        {
            "element_nums": number, "fe_descriptor": linear_triangle, "phys_table": 1,
            "mat_table": 1, "color": 1, "num_nodes": 3, "nodes_nums": (1 + corners).tolist(),
        }
        for number, corners in enumerate(triangles, 1)
    ]  # fmt: skip
    yield {"type": 2412, linear_triangle: rows}


def _triangles(grid: pv.UnstructuredGrid) -> IntArray:
    """Corners of the triangles of the surface, as points of the grid."""
    skin = grid.extract_surface(
        nonlinear_subdivision=0, pass_pointid=True, algorithm="dataset_surface"
    ).triangulate()
    own = np.asarray(skin.point_data["vtkOriginalPointIds"])
    return np.asarray(own[skin.faces.reshape(-1, 4)[:, 1:]], dtype=np.int64)


def _shapes(
    grid: pv.UnstructuredGrid, found: ConfigurationResult, title: str
) -> Iterator[dict[str, Any]]:
    nodes = np.unique(_triangles(grid))
    modes = found.modes
    for number, name in enumerate(modes.name):
        shape = field_values(grid, "mode_shape", name)[nodes]
        frequency, loss = modes.frequency[number], np.nan_to_num(modes.loss_factor[number])
        r1, r2, r3 = shape.T
        yield {
            "type": 55, "model_type": 1, "analysis_type": 3, "data_ch": 2,
            "spec_data_type": _DISPLACEMENT, "load_case": 1, "mode_n": number + 1,
            "eig": 2.0 * np.pi * frequency * (1j - 0.5 * loss),
            "id1": _line(title), "id2": _line(f"wet mode {name}, {frequency:.6g} Hz"),
            "id3": _line(f"loss factor {loss:.6g}; largest displacement 1"),
            "node_nums": 1 + nodes, "r1": r1, "r2": r2, "r3": r3,
        }  # fmt: skip


def _functions(found: ConfigurationResult, title: str) -> Iterator[dict[str, Any]]:
    frequency = found.spectrum.frequency
    records: tuple[Record, ...] = (
        found.spectrum, found.far_field, found.transfer, found.excitations, found.dissipation,
    )  # fmt: skip
    for record in records:
        for quantity, values in zip(record.quantities(), record.arrays().values(), strict=True):
            if quantity.name == "frequency" or "frequency" not in quantity.dims:
                continue
            registered = quantity.per_hertz() if found.random else quantity
            along = np.moveaxis(values, quantity.dims.index("frequency"), -1)
            others = [dim for dim in quantity.dims if dim != "frequency"]
            for place in product(*map(range, along.shape[:-1])):
                known = np.isfinite(along[place])
                if np.count_nonzero(known) > 1:
                    where = ", ".join(map(_place, others, place))
                    yield _function(registered, where, frequency[known], along[place][known], title)


def _function(
    quantity: Quantity, where: str, frequency: AnyArray, values: AnyArray, title: str
) -> dict[str, Any]:
    kind, below = _KINDS.get(quantity.unit, (_GENERAL, 0))
    response_function = 4
    name = f"{quantity.group.removeprefix('C*/')}/{quantity.name}"
    return {
        "type": 58, "func_type": response_function if below else 0,
        "rsp_node": 0, "rsp_dir": 0, "ref_node": 0, "ref_dir": 0,
        "id1": _line(f"{name} [{quantity.label}]"), "id2": _line(where or "-"),
        "id3": _line(quantity.description), "id4": _line(title),
        "abscissa_spec_data_type": _FREQUENCY, "abscissa_axis_lab": "Frequency",
        "abscissa_axis_units_lab": "Hz", "ordinate_spec_data_type": kind,
        "ordinate_axis_lab": quantity.name[:20], "ordinate_axis_units_lab": quantity.label[:20],
        "orddenom_spec_data_type": below, "x": np.array(frequency), "data": np.array(values),
    }  # fmt: skip


def _place(dim: str, index: int) -> str:
    return LABELS[dim][index] if dim in LABELS else f"{dim} {index + 1}"


def _line(text: str) -> str:
    return " ".join(text.split())[:_WIDTH]
