# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of solids, drawn off screen."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkLogger

from quietblade.typing import AnyArray, FloatArray

_SUBDIVISIONS = 2  # of a curved face: below a pixel at the size of these pictures
_AHEAD = 5e-4  # of the size of the object: enough to keep lines from sinking into their surface


@dataclass(frozen=True)
class View:
    """Where the camera looks from, in the axes of the blade.

    Attributes
    ----------
    place : tuple of float
        Direction from the blade to the camera.
    up : tuple of float
        Direction that is up in the picture.
    """

    place: tuple[float, float, float]
    up: tuple[float, float, float]


FROM_ABOVE = View((0.0, 1.0, 0.0), (1.0, 0.0, 0.0))
"""On the suction side: span to the right, chord upwards."""

FROM_UPSTREAM = View((-1.0, 0.45, 0.5), (0.0, 1.0, 0.0))
"""From ahead, above and the tip: span to the right, lift upwards."""

FROM_TIP = View((0.0, 0.0, 1.0), (0.0, 1.0, 0.0))
"""Along the span towards the hub: chord and section."""


def curved_surface(grid: pv.UnstructuredGrid) -> pv.PolyData:
    """Outer surface of second-order cells with its curvature."""
    return grid.extract_surface(
        nonlinear_subdivision=_SUBDIVISIONS, algorithm="dataset_surface"
    ).compute_normals(feature_angle=30.0, split_vertices=True)


def sharp_edges(grid: pv.UnstructuredGrid) -> pv.PolyData:
    """Edges at which the surface turns sharply: trailing edge, root and tip."""
    surface = grid.extract_surface(nonlinear_subdivision=_SUBDIVISIONS, algorithm="dataset_surface")
    return surface.extract_feature_edges(feature_angle=40.0)


def moved(grid: pv.UnstructuredGrid, displacement: FloatArray) -> pv.UnstructuredGrid:
    """Copy of a grid with its nodes displaced [m]."""
    copy = grid.copy()
    copy.points = grid.points + displacement
    return copy


class Stage:
    """An off-screen picture in the making; parallel projection on a white ground."""

    def __init__(self, size: tuple[int, int]) -> None:
        with _quiet_vtk():
            self.plotter = pv.Plotter(
                off_screen=True, window_size=list(size), theme=pv.themes.DocumentTheme()
            )
        self.plotter.enable_parallel_projection()
        self.plotter.enable_anti_aliasing("ssaa")
        self.plotter.enable_depth_peeling(10)

    def add(self, mesh: pv.DataSet, **options: Any) -> None:
        """Add a surface or lines; the options are those of ``pyvista.Plotter.add_mesh``."""
        if mesh.n_points == 0:
            return  # as of the sharp edges of a body that has none
        matt = {"ambient": 0.45, "diffuse": 0.6, "specular": 0.0, "show_scalar_bar": False}
        self.plotter.add_mesh(mesh, **{**matt, **options})

    def add_lines(self, lines: pv.PolyData, view: View, **options: Any) -> None:
        """Add lines that lie on a surface, drawn a little before it as seen from a view."""
        ahead = np.array(view.place) / np.linalg.norm(view.place)
        self.add(lines.translate(_AHEAD * lines.length * ahead), **options)

    def picture(self, view: View, bounds: Sequence[float] | None = None) -> AnyArray:
        """Take the picture, with what is around it.

        Parameters
        ----------
        view : View
        bounds : sequence of 6 floats, optional
            Box to show (xmin, xmax, ymin, ...) [m]; by default everything.

        Returns
        -------
        (rows, columns, 3) uint8 array
        """
        (image,) = self.pictures(view, bounds, [None])
        return image

    def pictures(
        self, view: View, bounds: Sequence[float] | None, changes: Iterable[object]
    ) -> list[AnyArray]:
        """Take one picture after each of some changes, with the camera in one place.

        Parameters
        ----------
        view, bounds
            As for `picture`.
        changes : iterable
            Whatever changes the added surfaces when its next item is taken.
        """
        images = []
        with _quiet_vtk():
            self.plotter.view_vector(view.place, viewup=view.up)
            self.plotter.reset_camera(bounds=bounds)
            for _ in changes:
                self.plotter.render()
                image = self.plotter.screenshot(None, return_img=True)
                images.append(np.asarray(image))
            self.plotter.close()
        return images


def cropped(images: Sequence[AnyArray]) -> list[AnyArray]:
    """Pictures of one size without the white margins that they have in common."""
    ink = np.any([np.any(image != 255, axis=2) for image in images], axis=0)
    rows, columns = np.flatnonzero(ink.any(axis=1)), np.flatnonzero(ink.any(axis=0))
    if rows.size == 0:
        return list(images)
    return [image[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1] for image in images]


@contextmanager
def _quiet_vtk() -> Iterator[None]:
    """Keep VTK from telling on standard error which displays it has tried."""
    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(before)
