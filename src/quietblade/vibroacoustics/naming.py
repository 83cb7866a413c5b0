# SPDX-License-Identifier: LGPL-2.1-or-later
"""Names of modes by counting: B5 is the bending mode with four nodes between root and tip.

Along the span the blade is cut into stations.  In each of them the motion of the section is split
by least squares, weighted with mass: motion along the section's normal into translation h, rotation
theta and camber, motion along the chord into translation e.  The split is orthogonal in the
kinetic energy, so that the shares of bending (h), torsion (theta), chordwise bending (camber) and
edgewise motion (e) add up to one with what is left over.  The nodes of h, theta, camber and e along
the span give the number in the family.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from scipy.optimize import linear_sum_assignment

from quietblade.typing import FloatArray, IntArray

Family = Literal["B", "T", "E", "C"]
FAMILIES: tuple[Family, ...] = get_args(Family)
"""Bending, torsion, edgewise, chordwise bending."""

WORDS: Mapping[str, str] = {"B": "bending", "T": "torsion", "E": "edgewise", "C": "chordwise"}
"""What the families are called."""

MIXED = 0.6
"""Purity below which a mode is called mixed."""

_NODES_A_STATION = 24
_STATIONS = (8, 60)  # fewest and most
_QUIET = 0.01  # amplitude relative to the largest below which a change of sign is noise
_WRONG_NUMBER = 0.25  # worth of a name whose number is off by one against one that fits


@dataclass(frozen=True, eq=False)
class Naming:
    """Names of a set of modes.

    Attributes
    ----------
    name : tuple of str, length m
        Family and number, no two alike.
    purity : (m,) array
        Share of the kinetic energy in the family of the name.
    shares : (m, 4) array
        Shares of the families B, T, E, C; less than one by what no family holds.
    orders : (m, 4) int array
        Nodes between root and tip, plus one, of the motion of each family.
    """

    name: tuple[str, ...]
    purity: FloatArray
    shares: FloatArray
    orders: IntArray

    @property
    def character(self) -> tuple[str, ...]:
        """Word for the family of each mode, or ``mixed`` where less than `MIXED` is in it."""
        return tuple(
            WORDS[name[0]] if purity >= MIXED else "mixed"
            for name, purity in zip(self.name, self.purity, strict=True)
        )


@dataclass(frozen=True, eq=False)
class SpanMotion:
    """Motion of the sections along the span in one mode.

    Attributes
    ----------
    s : (k,) array
        Stations, span fractions.
    amplitude : (4, k) array
        h, theta (times the chord fraction's unit), camber, e, at the stations.
    energy : (4,) array
        Twice the kinetic energy of each family at unit angular frequency.
    total : float
        That of the whole motion.
    """

    s: FloatArray
    amplitude: FloatArray
    energy: FloatArray
    total: float


def name_modes(
    s: FloatArray, xi: FloatArray, shapes: FloatArray, mass: FloatArray | None = None
) -> Naming:
    """Name modes by the motion of the blade's sections.

    Parameters
    ----------
    s, xi : (n,) arrays
        Span and chord fractions of nodes of the solid, undeformed.
    shapes : (m, n, 3) array
        Displacement of the nodes in the axes of their section: along the chord, along the normal,
        along the span.  Real.
    mass : (n,) array, optional
        Mass that each node stands for; even if left out.

    Raises
    ------
    ValueError
        If there are too few nodes to tell the sections' motions apart.
    """
    weight = np.ones(len(s)) if mass is None else mass
    motions = [span_motion(s, xi, shape, weight) for shape in shapes]
    shares = np.array([motion.energy / motion.total for motion in motions]).reshape(-1, 4)
    orders = np.array(
        [[count_nodes(line) + 1 for line in motion.amplitude] for motion in motions],
        dtype=np.int64,
    ).reshape(-1, 4)
    chosen = _distinct(shares, orders)
    return Naming(
        name=tuple(f"{FAMILIES[family]}{order}" for family, order in chosen),
        purity=np.array([share[family] for share, (family, _) in zip(shares, chosen, strict=True)]),
        shares=shares,
        orders=orders,
    )


def span_motion(s: FloatArray, xi: FloatArray, shape: FloatArray, mass: FloatArray) -> SpanMotion:
    """Split a motion (n, 3) station by station; see `name_modes`."""
    count = int(np.clip(len(s) // _NODES_A_STATION, *_STATIONS))
    edges = np.linspace(s.min(), s.max(), count + 1)
    station = np.clip(np.searchsorted(edges, s, side="right") - 1, 0, count - 1)
    places, lines, energy = [], [], np.zeros(4)
    for number in range(count):
        here = station == number
        middle = 0.5 * (edges[number] + edges[number + 1])
        if np.sum(here) < 8 or np.ptp(xi[here]) < 0.3:
            continue
        amplitude, part = _section_motion(s[here] - middle, xi[here], shape[here], mass[here])
        places.append(middle)
        lines.append(amplitude)
        energy += part
    if len(places) < 4:
        raise ValueError(
            f"names of modes: {len(s)} nodes give {len(places)} sections with enough of them, "
            "at least 4 are needed; refine the mesh"
        )
    # Rotations and edgewise motion turn the section about its other axes too; that part of the
    # spanwise displacement belongs to no family.
    total = float(np.sum(mass[:, None] * shape**2))
    return SpanMotion(np.array(places), np.array(lines).T, energy, max(total, 1e-300))


def _section_motion(
    along: FloatArray, xi: FloatArray, shape: FloatArray, mass: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Amplitudes (4,) at the middle of a station and energies (4,) of its families.

    Each amplitude may vary linearly along the station.
    """
    root = np.sqrt(mass)
    x = xi - 0.5
    one = np.ones_like(x)
    columns = np.stack([one, along, x, x * along, x**2, x**2 * along], axis=1)
    basis, triangle = np.linalg.qr(root[:, None] * columns)
    normal = basis.T @ (root * shape[:, 1])
    chordwise = basis[:, :2].T @ (root * shape[:, 0])
    # A coefficient of the orthogonal basis, divided by its diagonal, is that of the column when
    # the later ones are left out: translation of the mass centre, rotation about it, camber.
    diagonal = np.diagonal(triangle)
    safe = np.where(np.abs(diagonal) > 1e-12 * np.abs(diagonal).max(), diagonal, np.inf)
    families = normal.reshape(3, 2)
    amplitude = np.array(
        [
            (families[0, 0] - triangle[0, 1] * families[0, 1] / safe[1]) / safe[0],
            (families[1, 0] - triangle[2, 3] * families[1, 1] / safe[3]) / safe[2],
            (families[2, 0] - triangle[4, 5] * families[2, 1] / safe[5]) / safe[4],
            (chordwise[0] - triangle[0, 1] * chordwise[1] / safe[1]) / safe[0],
        ]
    )
    bending, torsion, camber = (families**2).sum(axis=1)
    energy = np.array([bending, torsion, float((chordwise**2).sum()), camber])
    return amplitude[[0, 1, 3, 2]], energy


def count_nodes(line: FloatArray) -> int:
    """Count the changes of sign along a line, small wiggles left out of account."""
    largest = float(np.abs(line).max(initial=0.0))
    loud = line[np.abs(line) > _QUIET * largest]
    return int(np.sum(np.sign(loud[1:]) != np.sign(loud[:-1])))


def _distinct(shares: FloatArray, orders: IntArray) -> Sequence[tuple[int, int]]:
    """Family and number of each mode, no two alike, with the largest sum of worths.

    A mode is worth its share in a family under the number that was counted, and less under others.
    """
    modes = len(shares)
    if modes == 0:
        return []
    highest = int(orders.max()) + modes
    numbers = np.arange(1, highest + 1)
    off = np.abs(orders[:, :, None] - numbers)
    worth = shares[:, :, None] * _WRONG_NUMBER**off
    rows, columns = linear_sum_assignment(worth.reshape(modes, -1), maximize=True)
    chosen = dict(zip(rows.tolist(), columns.tolist(), strict=True))
    return [(chosen[row] // highest, chosen[row] % highest + 1) for row in range(modes)]
