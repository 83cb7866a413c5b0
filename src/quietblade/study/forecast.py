# SPDX-License-Identifier: LGPL-2.1-or-later
"""How large the mesh and the systems of a case will be, without a mesh.

Cells of edge length h have nodes in proportion to the volume over h^3, thin bodies to the surface
over h^2.  The proportions were fitted to meshes of `quietblade.mesh.build`;
``tests/study/test_forecast.py`` holds them against a mesh, and against the sizes of others.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree
from scipy.stats import qmc

from quietblade.geometry import Blade
from quietblade.mesh.growth import GROWTH
from quietblade.typing import FloatArray

UNCERTAINTY = 0.15
"""A mesh has so many nodes and unknowns more or less, as a share of the forecast."""

_GRADED = 9.95
_UNIFORM = 5.0
_OUTER = 8.2
_PER_VOLUME = 10.6
_PER_SURFACE = 6.6
_PER_EDGE = 5.8
_THICK_PER_SURFACE = 2.5
_PER_FILM_CELL = 25.0
_PER_FILM_RIM = 28.0
_WETTED_PER_SURFACE = 4.8
_PER_LAYER, _PER_DEPTH, _LAYERS = 11.5, 3.8, (15.0, 19.0)
_AROUND_SHELL = 0.9

_NEAR = 1.5
"""Layer around the blade, in sizes of its cells, whose volume follows from the surface."""

_SAMPLES = 14  # power of two: three digits of the water's integral


@dataclass(frozen=True)
class Size:
    """What a mesh will have, within `UNCERTAINTY`.

    Attributes
    ----------
    nodes : int
        Of solid and water.
    statics, vibration : int
        Unknowns of step 1, 0 without one, and of step 2.
    """

    nodes: int
    statics: int
    vibration: int


def forecast(
    blade: Blade, size: float, centre: FloatArray, radius: float, water_size: float
) -> Size:
    """Estimate nodes and unknowns of a mesh.

    Parameters
    ----------
    blade : Blade
    size, water_size : float
        Edge length of the cells on the blade and at the sphere [m].
    centre : (3,) float array
        Centre of the water sphere [m].
    radius : float
        Its radius [m].
    """
    points = blade.section(np.linspace(0.0, 1.0, 101), 81)
    surface, edge = _surface(points), _edge(points)
    water = _water(points, surface, size, centre, radius, water_size)
    sheet = _PER_SURFACE * surface / size**2 + _PER_EDGE * edge / size
    thick = _PER_VOLUME * blade.volume() / size**3 + _THICK_PER_SURFACE * surface / size**2
    solid = max(sheet, thick)
    along, across = _film_cells(blade, size)
    film, rim = along * across, along + across
    solid += _PER_FILM_CELL * film + _PER_FILM_RIM * rim
    # a quadratic hexahedron of NGSolve has unknowns inside and on its faces too
    displacement = 3.0 * (solid + 5 * film + rim)
    pressure = 2 * (along + 1) * (across + 1) if film else 0
    statics = displacement + pressure
    wetted = _WETTED_PER_SURFACE * surface / size**2
    return Size(round(solid + water - wetted), round(statics), round(statics + water))


def forecast_shell(
    outer: float,
    thickness: float,
    size: float,
    centre: FloatArray,
    radius: float,
    water_size: float,
) -> Size:
    """Estimate nodes and unknowns of a spherical shell about the origin, in a sphere of water.

    Parameters
    ----------
    outer, thickness : float
        Outer radius of the wall, and its thickness [m].
    size, centre, radius, water_size
        As of `forecast`.
    """
    inner = outer - thickness
    surface = 4.0 * np.pi * outer**2
    volume = 4.0 / 3.0 * np.pi * (outer**3 - inner**3)
    # a layer of cells however thin the wall is; inside a thick one they grow
    each = float(np.clip(_PER_LAYER + _PER_DEPTH * thickness / size, *_LAYERS))
    solid = each * volume / thickness / size**2
    density = _density(size, water_size)
    far = radius + float(np.linalg.norm(centre))
    r = np.linspace(outer, far, 4001)
    shell = float(np.trapezoid(density(r - outer) * 4.0 * np.pi * r**2, r))
    inside = 4.0 * np.pi * (far**3 - outer**3) / 3.0
    water = _AROUND_SHELL * shell * 4.0 * np.pi * (radius**3 - outer**3) / 3.0 / inside
    water += _OUTER * 4.0 * np.pi * (radius / water_size) ** 2
    wetted = _WETTED_PER_SURFACE * surface / size**2
    return Size(round(solid + water - wetted), 0, round(3.0 * solid + water))


def _density(size: float, water_size: float) -> Callable[[FloatArray], FloatArray]:
    """Nodes of the water by its volume, at a distance from the body: of cells that grow."""

    def density(distance: FloatArray) -> FloatArray:
        h = np.maximum(size + GROWTH * (distance - 0.5 * size), size)
        graded = h < water_size
        nodes = np.where(graded, _GRADED, _UNIFORM) / np.minimum(h, water_size) ** 3
        return np.asarray(nodes, dtype=np.float64)

    return density


def _surface(points: FloatArray) -> float:
    """Area of both faces [m^2]."""
    across, along = np.diff(points[:-1], axis=1), np.diff(points[:, :-1], axis=0)
    return float(np.linalg.norm(np.cross(across, along), axis=-1).sum())


def _edge(points: FloatArray) -> float:
    """Length of nose, trailing edge, root and tip [m]."""
    nose, tail = points[:, points.shape[1] // 2], points[:, 0]
    along = sum(np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in (nose, tail))
    return float(along + np.linalg.norm(nose[[0, -1]] - tail[[0, -1]], axis=1).sum())


def _water(
    points: FloatArray,
    surface: float,
    size: float,
    centre: FloatArray,
    radius: float,
    water_size: float,
) -> float:
    """Nodes of the water: the integral of 1 / h^3 with the sizes h that the mesher is given.

    Where the size grows, cells are smaller than they are asked to be.
    """
    density = _density(size, water_size)
    layer = np.linspace(0.0, _NEAR * size, 101)
    near = surface * float(np.trapezoid(density(layer), layer))
    u = qmc.Sobol(3, seed=0).random_base2(_SAMPLES)
    r, z, turn = radius * np.cbrt(u[:, 0]), 2.0 * u[:, 1] - 1.0, 2.0 * np.pi * u[:, 2]
    flat = np.sqrt(1.0 - z**2)
    places = centre + r[:, None] * np.stack([flat * np.cos(turn), flat * np.sin(turn), z], axis=1)
    distance = np.asarray(cKDTree(points.reshape(-1, 3)).query(places)[0])
    far = np.where(distance > layer[-1], density(distance), 0.0)
    inside = 4.0 / 3.0 * np.pi * radius**3 * float(np.mean(far))
    return near + inside + _OUTER * 4.0 * np.pi * (radius / water_size) ** 2


def _film_cells(blade: Blade, size: float) -> tuple[int, int]:
    """Hexahedra of the film along span and chord."""
    if blade.film is None:
        return 0, 0
    (s0, s1), (c0, c1) = blade.film.span, blade.film.chord
    width = float(np.mean(blade.chord(np.linspace(s0, s1, 11)))) * (c1 - c0)
    return max(2, round(blade.span * (s1 - s0) / size)), max(3, round(width / size))
