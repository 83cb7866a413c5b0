# SPDX-License-Identifier: LGPL-2.1-or-later
"""Picture of a body that is no blade: its surface, where it is excited, and its wall."""

import numpy as np
import pyvista as pv
from matplotlib.figure import Figure

from quietblade.results.store import RunFolder
from quietblade.results.vtk import read_fields, region
from quietblade.typing import AnyArray
from quietblade.view.edges import outer_edges
from quietblade.view.render import Stage, View, cropped, curved_surface
from quietblade.view.scenes import BLADE, EXCITED, LINES, show, solid_of
from quietblade.view.style import WIDTH, new_figure, styled

_VIEW = View((0.8, 0.9, 0.7), (0.0, 0.0, 1.0))
"""From the side and above: z up."""


@styled
def draw_body_mesh(folder: RunFolder) -> Figure:
    """Draw the surface mesh with the excited parts, and the half of the wall behind a cut."""
    grid = read_fields(folder.mesh_fields)
    pictures = cropped([_surface(grid), _cut(grid)])
    shape = pictures[0].shape
    figure = new_figure(0.4 + 0.5 * WIDTH * shape[0] / shape[1])
    panels = figure.subplots(1, 2)
    excited = "; excited part red" if region(grid, "excited").n_cells else ""
    show(panels[0], pictures[0], f"Surface mesh{excited}")
    show(panels[1], pictures[1], "Cells of the wall behind a cut; nothing inside")
    return figure


def _surface(grid: pv.UnstructuredGrid) -> AnyArray:
    stage = Stage((1200, 1200))
    solid = solid_of(grid)
    stage.add(curved_surface(solid), color=BLADE)
    excited = region(grid, "excited")
    if excited.n_cells:
        surface = curved_surface(excited)
        stage.add(surface.scale(1.002, inplace=False), color=EXCITED)
    stage.add_lines(outer_edges(solid), _VIEW, color=LINES, line_width=1.5)
    return stage.picture(_VIEW)


def _cut(grid: pv.UnstructuredGrid) -> AnyArray:
    """Whole cells behind a plane through the middle, which the camera looks on to."""
    solid = solid_of(grid)
    towards = np.array(_VIEW.place) * [1.0, 1.0, 0.0]
    behind = solid.cell_centers().points @ towards < 0.0
    half = solid.extract_cells(np.flatnonzero(behind))
    stage = Stage((1200, 1200))
    stage.add(curved_surface(half), color=BLADE)
    stage.add_lines(outer_edges(half), _VIEW, color=LINES, line_width=1.5)
    return stage.picture(_VIEW, solid.bounds)
