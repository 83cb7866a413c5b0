# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of the blade: mesh and film, deformation under load, mode shapes.

They are made from the VTU files of a run.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pyvista as pv
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.results.vtk import CELL_TYPES, field_labels, field_values, read_fields, region
from quietblade.typing import AnyArray
from quietblade.view.edges import outer_edges
from quietblade.view.render import (
    FROM_ABOVE,
    FROM_UPSTREAM,
    Stage,
    View,
    cropped,
    curved_surface,
    moved,
    sharp_edges,
)
from quietblade.view.style import DIVERGING, SEQUENTIAL, WIDTH, new_figure, styled

BLADE, EXCITED, LINES = "#C9D3DC", "#D55E00", "#30363C"
"""Colours of a solid, of its excited part and of the edges of its cells."""

_FILM = "#E69F00"
_CELL_COLORS = {"tetra10": BLADE, "pyramid13": "#56B4E9", "hexahedron20": _FILM}
_MODE_AMPLITUDE = 0.12  # largest displacement in a picture of a mode, over the span
_COLUMNS, _ROUND_COLUMNS = 3, 5  # of the small pictures, and of those as wide as high
_STRETCH, _SLAB = 3.0, 0.02  # of the cut: thickness, and half its length along the span [m]
_FROM_CUT = View((-0.3, 0.5, 1.0), (0.0, 1.0, 0.0))


@styled
def draw_mesh(folder: RunFolder) -> Figure:
    """Planform with the film inside, surface mesh, and a cut through the film's layers."""
    grid = _with_level_chord(read_fields(folder.static_fields))
    planform, surface = cropped([_planform(grid), _surface_mesh(grid)])
    (cut,) = cropped([_cut(grid)])
    heights = [WIDTH * image.shape[0] / image.shape[1] for image in (planform, surface, cut)]
    figure = new_figure(sum(heights) + 0.9)
    panels = figure.subplots(3, 1, height_ratios=heights)
    show(panels[0], planform, _planform_title(grid))
    show(panels[1], surface, "Surface mesh")
    show(panels[2], cut, _cut_title(grid))
    return figure


@styled
def draw_deformed(folder: RunFolder, result: Result, largest: float | None = None) -> Figure:
    """Deformed blade with the film's shear strain, and the rigid blade.

    Parameters
    ----------
    folder, result
        The run.
    largest : float, optional
        Shear strain at the end of the colour scale, to compare blades; by default the run's own.
    """
    own = result.steady.max_film_shear_strain
    strained = np.isfinite(own)
    limits = (0.0, 100.0 * (own if largest is None else largest) if strained else 1.0)
    (image,) = cropped([deformed_picture(folder, limits)])
    figure = new_figure(1.15 + WIDTH * image.shape[0] / image.shape[1])
    axes = figure.subplots()
    tip = ", ".join(f"{1e3 * u:z.1f}" for u in result.steady.tip_displacement)
    show(axes, image, f"{result.title}: rigid and deformed\nTip displacement ({tip}) mm, to scale")
    if strained:
        strain_bar(figure, [axes], limits)
    return figure


@styled
def draw_deformed_blades(folders: Mapping[str, RunFolder], results: Mapping[str, Result]) -> Figure:
    """Deformed blades with the shear strain of their films, one below the other.

    Length and colour have the same scale in all pictures.

    Parameters
    ----------
    folders, results : mappings
        Of the runs, by the name that the picture gets.
    """
    largest = max(result.steady.max_film_shear_strain for result in results.values())
    limits = (0.0, 100.0 * largest)
    boxes = np.array([_reach(folder) for folder in folders.values()])
    bounds = np.where([True, False] * 3, boxes.min(axis=0), boxes.max(axis=0)).tolist()
    pictures = cropped([deformed_picture(f, limits, bounds) for f in folders.values()])
    pictures = [_without_empty_rows(picture) for picture in pictures]  # width: the scale
    heights = [WIDTH * picture.shape[0] / picture.shape[1] for picture in pictures]
    figure = new_figure(0.9 + sum(heights) + 0.3 * len(heights))
    panels = list(np.atleast_1d(figure.subplots(len(heights), 1, height_ratios=heights)))
    for panel, (name, result), picture in zip(panels, results.items(), pictures, strict=True):
        gamma = 100.0 * result.steady.max_film_shear_strain
        show(panel, picture, f"{name}: largest shear strain of the film {gamma:.2g} %")
    strain_bar(figure, panels, limits)
    return figure


def deformed_picture(
    folder: RunFolder, limits: tuple[float, float], bounds: Sequence[float] | None = None
) -> AnyArray:
    """Picture of the blade at rest and deformed, its film coloured by the shear strain [%]."""
    rigid = solid_of(read_fields(folder.static_fields))
    deformed = moved(rigid, field_values(rigid, "displacement"))
    film = region(deformed, "film")
    stage = Stage((2400, 1500))
    stage.add(curved_surface(rigid), color=BLADE, opacity=0.15)
    stage.add(sharp_edges(rigid), color=LINES, line_width=1.5)
    stage.add(curved_surface(deformed), color="#5B7083", opacity=0.25)
    stage.add(sharp_edges(deformed), color=LINES, line_width=2.5)
    if film.n_cells:
        film.point_data["percent"] = 100.0 * field_values(film, "film_shear_strain")
        stage.add(curved_surface(film), scalars="percent", cmap=SEQUENTIAL, clim=limits)
    return stage.picture(FROM_UPSTREAM, bounds)


def strain_bar(figure: Figure, axes: list[Axes], limits: tuple[float, float]) -> None:
    """Colour scale of the film's shear strain."""
    bar = _color_bar(figure, axes, limits, SEQUENTIAL, location="bottom", shrink=0.6, aspect=40)
    bar.set_label("Shear strain of the film, engineering $\\gamma$ [%]")


def _without_empty_rows(image: AnyArray) -> AnyArray:
    rows = np.flatnonzero(np.any(image != 255, axis=(1, 2)))
    return image[rows[0] : rows[-1] + 1] if rows.size else image


def _reach(folder: RunFolder) -> tuple[float, ...]:
    """Box around the blade at rest and deformed."""
    rigid = solid_of(read_fields(folder.static_fields))
    deformed = moved(rigid, field_values(rigid, "displacement"))
    both = np.array([rigid.bounds, deformed.bounds])
    return tuple(np.where([True, False] * 3, both.min(axis=0), both.max(axis=0)))


@styled
def draw_displacement(folder: RunFolder, result: Result) -> Figure:
    """Deformed blade coloured by its displacement, and the blade at rest."""
    rigid = solid_of(read_fields(folder.static_fields))
    displacement = field_values(rigid, "displacement")
    deformed = moved(rigid, displacement)
    millimetre = 1e3 * np.linalg.norm(displacement, axis=1)
    deformed.point_data["millimetre"] = millimetre
    limits = (0.0, float(millimetre.max()) or 1.0)
    stage = Stage((2400, 1500))
    stage.add(curved_surface(rigid), color=BLADE, opacity=0.35)
    stage.add(sharp_edges(rigid), color=LINES, line_width=1.5)
    stage.add(curved_surface(deformed), scalars="millimetre", cmap=SEQUENTIAL, clim=limits)
    stage.add(sharp_edges(deformed), color=LINES, line_width=1.5)
    (image,) = cropped([stage.picture(FROM_UPSTREAM)])
    figure = new_figure(1.15 + WIDTH * image.shape[0] / image.shape[1])
    axes = figure.subplots()
    show(axes, image, f"{result.title}: deformed and at rest\nLargest displacement "
          f"{millimetre.max():.1f} mm, to scale")  # fmt: skip
    bar = _color_bar(figure, axes, limits, SEQUENTIAL, location="bottom", shrink=0.6, aspect=40)
    bar.set_label("Displacement from C0 to C1 [mm]")
    return figure


@styled
def draw_stress(folder: RunFolder, result: Result) -> Figure:
    """Von Mises stress on both faces of the deformed blade."""
    rigid = solid_of(read_fields(folder.static_fields))
    blade = region(moved(rigid, field_values(rigid, "displacement")), "blade")
    stress = 1e-6 * field_values(blade, "von_mises_stress", "blade")
    limits = (0.0, float(np.nanmax(stress)))
    blade.point_data["megapascal"] = stress
    stage = Stage((2400, 1500))
    stage.add(curved_surface(blade), scalars="megapascal", cmap=SEQUENTIAL, clim=limits)
    stage.add(sharp_edges(blade), color=LINES, line_width=1.5)
    (image,) = cropped([stage.picture(FROM_UPSTREAM)])
    figure = new_figure(1.15 + WIDTH * image.shape[0] / image.shape[1])
    axes = figure.subplots()
    table = result.steady.stress
    row = table.region.index("blade")
    x, y, z = table.von_mises_place[row]
    show(
        axes, image,
        f"{result.title}: von Mises stress, deformed to scale\nLargest "
        f"{1e-6 * table.von_mises[row]:.0f} MPa at ({x:.3f}, {y:.3f}, {z:.3f}) m of the blade at "
        "rest",
    )  # fmt: skip
    bar = _color_bar(figure, axes, limits, SEQUENTIAL, location="bottom", shrink=0.6, aspect=40)
    bar.set_label("Von Mises stress of the blade [MPa]")
    return figure


@styled
def draw_mode_shapes(
    result: Result, configuration: str, pictures: Mapping[str, AnyArray]
) -> Figure:
    """All wet modes as small pictures of one scale, coloured by the motion that makes sound.

    Parameters
    ----------
    result : Result
        The run.
    configuration : str
        ``C0`` or ``C1``.
    pictures : mapping
        What `mode_pictures` makes of that configuration.
    """
    modes = result.configurations[configuration].modes
    shape = next((p.shape for p in pictures.values()), (1, 2))
    slim = shape[1] > 1.5 * shape[0]
    columns, head = (_COLUMNS, 0.2) if slim else (_ROUND_COLUMNS, 0.5)
    first, then = ("  ", ", ") if slim else ("\n", "\n")
    rows = max(1, -(-len(modes.name) // columns))
    figure = new_figure(0.5 + rows * (head + 0.9 * WIDTH / columns * shape[0] / shape[1]))
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for panel in panels:
        panel.set_axis_off()
    numbers = zip(modes.name, modes.frequency, modes.loss_factor, strict=True)
    for panel, (name, frequency, loss) in zip(panels, numbers, strict=False):
        told = f"$\\eta$ = {loss:.1e}" if np.isfinite(loss) else "rigid motion"
        digits = 1 if frequency < 1000.0 else 0  # as wide as a picture
        show(panel, pictures[name], f"{name}{first}{frequency:z.{digits}f} Hz{then}{told}")
    bar = _color_bar(figure, list(panels), (-1.0, 1.0), DIVERGING, shrink=0.8, aspect=30)
    # as short as one row of pictures is low
    bar.set_label("Displacement normal\nto the surface over\nthe largest [–]")
    title = f"Wet modes in {configuration}: {result.title}"
    figure.suptitle(title, x=0.01, ha="left", fontsize=9.0)
    return figure


def mode_pictures(folder: RunFolder, configuration: str) -> dict[str, AnyArray]:
    """Pictures of all mode shapes of a configuration by name, of one size and scale."""
    grid = read_fields(folder.mode_fields(configuration))
    names = field_labels(grid, "mode_shape")
    pictures = cropped([_mode_picture(grid, name) for name in names]) if names else []
    return dict(zip(names, pictures, strict=True))


def _mode_picture(grid: pv.UnstructuredGrid, name: str) -> AnyArray:
    shape = np.real(field_values(grid, "mode_shape", name))
    solid = pv.UnstructuredGrid(grid)
    solid.point_data["shape"] = shape / np.max(np.linalg.norm(shape, axis=1))
    surface = curved_surface(solid)
    motion, normal = surface.point_data["shape"], surface.point_data["Normals"]
    hollow = region(grid, "body").n_cells > 0
    # of either side the normal that points to the suction side, so that both show one colour
    upwards = normal if hollow else normal * np.sign(normal[:, 1:2])
    surface.point_data["across"] = np.sum(motion * upwards, axis=1)
    amplitude = _MODE_AMPLITUDE * float(np.ptp(grid.points[:, 2]))
    surface.points = surface.points + amplitude * motion
    stage = Stage((900, 600))
    stage.add(sharp_edges(grid), color="#9AA0A6", line_width=1.5)
    stage.add(surface, scalars="across", cmap=DIVERGING, clim=(-1.0, 1.0))
    box = np.array(grid.bounds) + amplitude * np.array([-1, 1, -1, 1, -1, 1])
    return stage.picture(FROM_UPSTREAM, box.tolist())


def _with_level_chord(grid: pv.UnstructuredGrid) -> pv.UnstructuredGrid:
    """Turn a blade about its span until the chord at mid-span is level.

    A blade with the pitch of a propeller would else be seen from its edge.
    """
    points = np.asarray(solid_of(grid).points)
    near = np.abs(points[:, 2] - np.mean(grid.bounds[4:])) < _SLAB
    section = points[near, :2] - points[near, :2].mean(axis=0)
    chord = np.linalg.svd(section, full_matrices=False)[2][0]
    x, y = chord * (1.0 if chord[0] > 0.0 else -1.0)
    return grid.rotate_z(-np.degrees(np.arctan2(y, x)), inplace=False)


def _planform(grid: pv.UnstructuredGrid) -> AnyArray:
    stage = Stage((2400, 700))
    film = region(grid, "film")
    if film.n_cells:
        stage.add(curved_surface(film), color=_FILM)
        stage.add_lines(outer_edges(film), FROM_ABOVE, color=LINES, line_width=1.5)
    stage.add(curved_surface(solid_of(grid)), color=BLADE, opacity=0.35)
    stage.add(sharp_edges(solid_of(grid)), color=LINES, line_width=2.5)
    excited = region(grid, "excited")
    if excited.n_cells:
        stage.add(excited.extract_surface(algorithm="dataset_surface"), color=EXCITED)
    return stage.picture(FROM_ABOVE)


def _surface_mesh(grid: pv.UnstructuredGrid) -> AnyArray:
    stage = Stage((2400, 700))
    solid = solid_of(grid)
    stage.add(curved_surface(solid), color=BLADE)
    stage.add_lines(outer_edges(solid), FROM_ABOVE, color=LINES, line_width=2.0)
    return stage.picture(FROM_ABOVE)


def _cut(grid: pv.UnstructuredGrid) -> AnyArray:
    """Cells of a slice, so that the layers are seen from its end."""
    heights = grid.cell_centers().points[:, 2]
    inside = np.abs(heights - _cut_height(grid)) < _SLAB
    pyramids = inside & (grid.celltypes == CELL_TYPES["pyramid13"])
    if pyramids.any():  # the tetrahedra before them would hide them all
        inside &= (heights <= heights[pyramids].max()) | (grid.celltypes != CELL_TYPES["tetra10"])
    slab = grid.extract_cells(np.flatnonzero(inside))
    slab.points = slab.points * [1.0, _STRETCH, 1.0]
    stage = Stage((2400, 900))
    for kind, color in _CELL_COLORS.items():
        part = slab.extract_cells(np.flatnonzero(slab.celltypes == CELL_TYPES[kind]))
        if part.n_cells:
            stage.add(curved_surface(part), color=color)
            stage.add_lines(outer_edges(part), _FROM_CUT, color=LINES, line_width=2.5)
    return stage.picture(_FROM_CUT)


def _cut_height(grid: pv.UnstructuredGrid) -> float:
    """Place of the cut along the span [m]: the middle, but that of a film which ends before it."""
    middle = float(np.mean(grid.bounds[4:]))
    film = region(grid, "film")
    if not film.n_cells or film.bounds[4] < middle - _SLAB < middle + _SLAB < film.bounds[5]:
        return middle
    return float(np.mean(film.bounds[4:]))


def _cut_title(grid: pv.UnstructuredGrid) -> str:
    low, high = grid.bounds[4:]
    share = 100.0 * (_cut_height(grid) - low) / (high - low)
    film = "; hexahedra of the film orange, pyramids blue" if region(grid, "film").n_cells else ""
    return f"Cells at {share:.0f} % span, thickness drawn {_STRETCH:g} times{film}"


def _planform_title(grid: pv.UnstructuredGrid) -> str:
    excited = "; excited patch red" if region(grid, "excited").n_cells else ""
    return f"From the suction side: root left, leading edge below{excited}"


def solid_of(grid: pv.UnstructuredGrid) -> pv.UnstructuredGrid:
    """Take blade and film as one body: the surface of the blade alone has the film's bed."""
    return grid.extract_cells(np.flatnonzero(grid.celltypes != CELL_TYPES["triangle6"]))


def _color_bar(
    figure: Figure,
    axes: Axes | list[Axes],
    limits: tuple[float, float],
    colors: str,
    **options: Any,
) -> Colorbar:
    return figure.colorbar(ScalarMappable(Normalize(*limits), colors), ax=axes, **options)


def show(axes: Axes, image: AnyArray, title: str) -> None:
    """Put a picture and its title into a panel."""
    axes.imshow(image, interpolation="antialiased")
    axes.set_anchor("W")
    axes.set_axis_off()
    axes.set_title(title)
