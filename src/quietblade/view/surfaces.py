# SPDX-License-Identifier: LGPL-2.1-or-later
"""Surfaces of a run's solids with their motions: what moving pictures are made of."""

from dataclasses import dataclass

import numpy as np
import pyvista as pv

from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.results.vtk import field_values, read_fields, region
from quietblade.typing import ComplexArray, FloatArray, IntArray
from quietblade.view.scenes import solid_of


@dataclass(frozen=True, eq=False)
class Motion:
    """Displacement of the nodes of a surface.

    Attributes
    ----------
    name : str
        Name of the mode, or empty for the steady deformation.
    shape : (n, 3) array
        Displacement [m] of the steady deformation; complex amplitude of a mode, whose largest
        norm is one.
    frequency, loss_factor : float
        Of a mode; NaN otherwise.
    """

    name: str
    shape: ComplexArray
    frequency: float = float("nan")
    loss_factor: float = float("nan")

    @property
    def amplitude(self) -> FloatArray:
        """Norm of the displacement of each node, (n,)."""
        return np.asarray(np.linalg.norm(np.abs(self.shape), axis=1))


@dataclass(frozen=True, eq=False)
class MovingSurface:
    """Surface of blade and film in one configuration, with its motions.

    Attributes
    ----------
    configuration : str
        ``C0`` or ``C1``: where the points are.
    points : (n, 3) array
        Corner nodes of the cells [m].
    blade, film : (m, 3) array of int
        Triangles of the outer surface, and of the surface of the film inside (maybe none).
    motions : tuple of Motion
    """

    configuration: str
    points: FloatArray
    blade: IntArray
    film: IntArray
    motions: tuple[Motion, ...]


def moving_surfaces(folder: RunFolder, result: Result) -> tuple[MovingSurface, ...]:
    """Surface of a blade with its steady deformation, and one a configuration with its modes.

    Raises
    ------
    ResultError
        A file of fields is missing.
    """
    modes = (mode_surface(folder, result, name) for name in result.configurations)
    return *((steady_surface(folder),) if result.static else ()), *modes


def steady_surface(folder: RunFolder) -> MovingSurface:
    """Surface at rest, with the deformation under the steady load as its only motion."""
    grid = solid_of(read_fields(folder.static_fields))
    displacement = np.asarray(field_values(grid, "displacement"), dtype=np.complex128)
    nodes, blade, film = _faces(grid)
    return MovingSurface(
        "C0", np.asarray(grid.points)[nodes], blade, film, (Motion("", displacement[nodes]),)
    )


def mode_surface(folder: RunFolder, result: Result, configuration: str) -> MovingSurface:
    """Surface of one configuration with its wet modes."""
    grid = read_fields(folder.mode_fields(configuration))
    nodes, blade, film = _faces(grid)
    table = result.configurations[configuration].modes
    motions = []
    for name, frequency, loss in zip(table.name, table.frequency, table.loss_factor, strict=True):
        shape = field_values(grid, "mode_shape", name)[nodes]
        largest = np.max(np.linalg.norm(np.abs(shape), axis=1))
        motions.append(Motion(name, shape / largest, float(frequency), float(loss)))
    return MovingSurface(configuration, np.asarray(grid.points)[nodes], blade, film, tuple(motions))


def _faces(grid: pv.UnstructuredGrid) -> tuple[IntArray, IntArray, IntArray]:
    """Nodes of the surfaces in the grid, and the triangles of outer surface and film."""
    numbered = grid.copy(deep=False)
    numbered.clear_data()
    numbered.point_data["node"] = np.arange(grid.n_points)
    numbered.cell_data["region"] = grid.cell_data["region"]
    numbered.field_data["regions"] = [str(name) for name in grid.field_data["regions"]]
    outer, film = _triangles(numbered), _triangles(region(numbered, "film"))
    nodes, numbers = np.unique(np.concatenate([outer, film]), return_inverse=True)
    numbers = numbers.reshape(-1, 3)
    return nodes, numbers[: len(outer)], numbers[len(outer) :]


def _triangles(grid: pv.UnstructuredGrid) -> IntArray:
    """Corners of the surface's triangles; straight edges are enough where pictures move."""
    if grid.n_cells == 0:
        return np.empty((0, 3), dtype=np.int64)
    surface = grid.extract_surface(nonlinear_subdivision=0, algorithm="dataset_surface")
    faces = surface.triangulate().regular_faces
    return np.asarray(np.asarray(surface.point_data["node"])[faces], dtype=np.int64)
