# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids of blade, film and water sphere in gmsh's OpenCASCADE kernel."""

from collections.abc import Sequence
from dataclasses import dataclass

import gmsh
import numpy as np
from scipy.interpolate import make_interp_spline

from quietblade.errors import MeshError
from quietblade.geometry import Blade
from quietblade.typing import FloatArray

_CONTOUR_NODES = 81
_FILM_NODES = 9
_PATCH_NODES = 9
_RULED_TOLERANCE = 1e-9  # of the span
_LOFT_TOLERANCE = 2e-5


@dataclass(frozen=True)
class Patch:
    """Part of a blade face, bounded by span and chord fractions.

    Attributes
    ----------
    side : {+1, -1}
        Upper or lower face.
    span, chord : (2,) tuple of float
        Ranges of span and chord fraction.
    """

    side: int
    span: tuple[float, float]
    chord: tuple[float, float]


@dataclass(frozen=True)
class Solids:
    """Tags of the parts after they are made conforming.

    Attributes
    ----------
    blade, film, water : int or None
        Volumes (no film: None).
    outlines : tuple of list of int
        Curves of each excited patch, lying on the blade's face.
    """

    blade: int
    film: int | None
    water: int
    outlines: tuple[list[int], ...]

    def volumes(self) -> dict[str, int]:
        """Region name to volume."""
        named = {"blade": self.blade, "film": self.film, "water": self.water}
        return {name: tag for name, tag in named.items() if tag is not None}


def build_solids(
    blade: Blade, centre: FloatArray, radius: float, patches: Sequence[Patch]
) -> Solids:
    """Make conforming solids in the current gmsh model.

    Raises
    ------
    MeshError
        The kernel did not return one volume a region.
    """
    occ = gmsh.model.occ
    tools = _lofts(blade)
    sphere = (3, occ.addSphere(*centre, radius))
    _, mapping = occ.fragment([sphere], tools)
    outlines = tuple(_outlines(blade, patch) for patch in patches)
    occ.synchronize()
    film = {tag for _, tag in mapping[2]} if blade.film is not None else set()
    solid = {tag for _, tag in mapping[1]} - film
    water = {tag for _, tag in mapping[0]} - film - solid
    if len(solid) != 1 or len(water) != 1 or len(film) != len(tools) - 1:
        raise MeshError(
            f"the geometry kernel made {len(solid)} blade, {len(film)} film and {len(water)} "
            "water volumes where one of each is needed; does the film touch the blade's surface, "
            "or the blade the sphere?"
        )
    return Solids(solid.pop(), film.pop() if film else None, water.pop(), outlines)


def build_body(blade: Blade) -> dict[str, int]:
    """Make blade and film without water in the current gmsh model, conforming to each other.

    Returns
    -------
    dict of str to int
        Volume of each region.

    Raises
    ------
    MeshError
        The kernel did not return one volume a region.
    """
    occ = gmsh.model.occ
    solid, *films = _lofts(blade)
    if not films:
        occ.synchronize()
        return {"blade": solid[1]}
    _, (whole, film) = occ.fragment([solid], films)
    occ.synchronize()
    rest = set(whole) - set(film)
    if len(film) != 1 or len(rest) != 1:
        raise MeshError(
            f"the geometry kernel made {len(rest)} blade and {len(film)} film volumes where one of "
            "each is needed; does the film touch the blade's surface?"
        )
    return {"blade": rest.pop()[1], "film": film[0][1]}


def _lofts(blade: Blade) -> list[tuple[int, int]]:
    """Loft the whole blade, and the film if there is one."""
    stations = _stations(blade)
    lofts = [_loft([_section_edges(blade, s) for s in stations])]
    if blade.film is not None:
        first, last = blade.film.span
        inner = stations[(stations > first) & (stations < last)]
        lofts.append(_loft([_film_edges(blade, s) for s in (first, *inner, last)]))
    return lofts


def _stations(blade: Blade) -> FloatArray:
    """Span fractions of the loft: two where the blade is ruled, else as many as it needs."""
    check = np.linspace(0.0, 1.0, 41)
    exact = _faces(blade, check)
    for count in (2, 7, 11, 15, 21):
        stations = np.linspace(0.0, 1.0, count)
        loft = make_interp_spline(stations, _faces(blade, stations), k=min(3, count - 1))
        tolerance = _RULED_TOLERANCE if count == 2 else _LOFT_TOLERANCE
        if np.abs(loft(check) - exact).max() < tolerance * blade.span:
            break
    return stations


def _faces(blade: Blade, s: FloatArray) -> FloatArray:
    """Points of both faces, one row a station."""
    xi = np.linspace(0.0, 1.0, 9)
    rows = [_face_points(blade, side, s[:, None], xi) for side in (1, -1)]
    return np.concatenate(rows, axis=1)


def _face_points(blade: Blade, side: int, s: FloatArray, xi: FloatArray) -> FloatArray:
    s, xi = np.broadcast_arrays(s, xi)
    return blade.place(s, np.stack([xi, blade.face_height(side, s, xi)], axis=-1))


def _section_edges(blade: Blade, s: float) -> list[int]:
    points = [_point(x) for x in blade.section(np.array([s]), _CONTOUR_NODES)[0]]
    nose = _CONTOUR_NODES // 2
    occ = gmsh.model.occ
    return [
        occ.addSpline(points[: nose + 1]),
        occ.addSpline(points[nose:]),
        occ.addLine(points[-1], points[0]),
    ]


def _film_edges(blade: Blade, s: float) -> list[int]:
    """Four edges: lower, rear, upper, front; straight where the blade has no camber."""
    assert blade.film is not None
    cambered = bool(np.any(blade.camber(np.linspace(0.0, 1.0, 11)) != 0.0))
    xi = np.linspace(*blade.film.chord, _FILM_NODES if cambered else 2)
    lower = [_point(x) for x in blade.film_surface(-1, s, xi)]
    upper = [_point(x) for x in blade.film_surface(+1, s, xi[::-1])]
    occ = gmsh.model.occ
    return [
        occ.addSpline(lower) if cambered else occ.addLine(*lower),
        occ.addLine(lower[-1], upper[0]),
        occ.addSpline(upper) if cambered else occ.addLine(*upper),
        occ.addLine(upper[-1], lower[0]),
    ]


def _loft(sections: list[list[int]]) -> tuple[int, int]:
    """Solid through closed sections, each a list of edges."""
    occ = gmsh.model.occ
    wires = [occ.addWire(edges) for edges in sections]
    solids = occ.addThruSections(wires, makeSolid=True, makeRuled=len(wires) == 2)
    # the loft has edges of its own: left in the model, these would be meshed beside them
    occ.remove([(1, edge) for edges in sections for edge in edges], recursive=True)
    return (3, int(solids[0][1]))


def _outlines(blade: Blade, patch: Patch) -> list[int]:
    """Outline the patch by four splines through points of the blade's face."""
    corners = [(s, xi) for s in patch.span for xi in patch.chord]
    loop = [corners[0], corners[1], corners[3], corners[2]]
    tags = [_point(_face_points(blade, patch.side, *np.array(c))) for c in loop]
    curves = []
    for k in range(4):
        a, b = np.array(loop[k]), np.array(loop[(k + 1) % 4])
        inner = a + (b - a) * np.linspace(0.0, 1.0, _PATCH_NODES)[1:-1, None]
        points = _face_points(blade, patch.side, inner[:, 0], inner[:, 1])
        middle = [_point(x) for x in points]
        curves.append(gmsh.model.occ.addSpline([tags[k], *middle, tags[(k + 1) % 4]]))
    return curves


def _point(x: FloatArray) -> int:
    return int(gmsh.model.occ.addPoint(*np.asarray(x, dtype=float)))
