# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cells that are small enough for the faces of the blade to stay clear of the film."""

from collections.abc import Callable

import numpy as np

from quietblade.geometry import Blade
from quietblade.typing import FloatArray

_STATIONS = 41
_CLEAR = 0.2
"""Share of the cover that the edge of a cell may cut off a face: with half of it most meshes of the
paper's blade from 30 to 60 mm have an inverted cell, with this one in ten."""


def clear_size(blade: Blade) -> Callable[[float], float]:
    """Return the largest cells [m] on the faces by the span fraction; infinite without a film.

    An edge of length h, straight as the mesher first draws it, leaves a face of curvature k by
    k h^2 / 8, which must be less than the cover of the film below it.

    Parameters
    ----------
    blade : Blade
    """
    if blade.film is None:
        return lambda _: float("inf")
    s = np.linspace(*blade.film.span, _STATIONS)
    sizes = _clear_sizes(blade, s)
    return lambda at: float(np.interp(at, s, sizes))


def _clear_sizes(blade: Blade, s: FloatArray) -> FloatArray:
    assert blade.film is not None
    xi = np.linspace(*blade.film.chord, _STATIONS)
    covers = blade.film_cover(s[:, None], xi)
    h = 0.25 * (xi[1] - xi[0])
    least = np.full(len(s), np.inf)
    for side, cover in zip((+1, -1), covers, strict=True):
        there, before, after = (blade.face_height(side, s[:, None], xi + d) for d in (0.0, -h, h))
        bulge = np.maximum(-side * (before - 2.0 * there + after) / h**2, 1e-9)
        curvature = bulge / blade.chord(s)[:, None]
        allowed = np.sqrt(8.0 * _CLEAR * np.maximum(cover, 0.0) / curvature)
        least = np.minimum(least, allowed.min(axis=1))
    return least
