# SPDX-License-Identifier: LGPL-2.1-or-later
"""A laminate inside a blade: one effective solid, or each ply in its place."""

from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise
from typing import Any, TypeVar

import ngsolve as ngs
import numpy as np

from quietblade.materials.anisotropic import AnisotropicSVK
from quietblade.materials.axes import Axes
from quietblade.materials.cells import fit_in_cells
from quietblade.materials.laminate import (
    IN_PLANE,
    OUT_OF_PLANE,
    Laminate,
    out_of_plane,
    reduced_stiffness,
)
from quietblade.materials.surface import Depth
from quietblade.typing import FloatArray, IntArray

_Value = TypeVar("_Value")

# Second-order stiffness times linear strains twice, in tetrahedra of order 2.
_EXTRA_ORDER = 1


def homogenised(laminate: Laminate, axes: Axes) -> AnisotropicSVK:
    """One effective solid for the whole stack, the model ``homogenised``.

    Stretching, shear and twist of many thin repeats are exact; the order of the plies does not
    enter, so that the bending stiffness of few plies is wrong by `Laminate.bending_error`.

    Parameters
    ----------
    laminate : Laminate
    axes : (3, 3) array or CoefficientFunction
        Columns: span, chordwise and thickness directions, as from `surface_axes`.
    """
    return AnisotropicSVK(laminate.name, laminate.density, laminate.stiffness, axes, laminate.loss)


def layered(laminate: Laminate, axes: Axes, depth: Depth) -> AnisotropicSVK:
    """Each ply in its place, the model ``plies`` (theory: S1-47).

    In the plane the stiffness follows the plies, through its moments in each cell, so that a few
    cells across the thickness, or one, bend as the stack does.  Out of the plane (thickness, and
    shear across the plies) it is the effective one of the local stack.

    Fractions are shares of the local thickness (``through``) or half thickness (``symmetric``).
    Thicknesses are laid off from the lower face, or from both faces; the last ply of the list
    fills what remains, and plies for which the blade is too thin are left out there.

    Parameters
    ----------
    laminate : Laminate
    axes : (3, 3) array or CoefficientFunction
        Columns: span, chordwise and thickness directions, as from `surface_axes`.
    depth : Depth
        From `surface_depth`.
    """
    stack = _Stack(laminate, depth)
    densities = np.array([kind.material.density for kind in stack.kinds])
    uniform = bool(np.ptp(densities) == 0.0)
    return AnisotropicSVK(
        laminate.name,
        float(densities[0]) if uniform else stack.in_cells(densities[:, None])[0],
        _stiffness(stack),
        axes,
        laminate.loss,
        extra_order=_EXTRA_ORDER,
    )


def ply_number(laminate: Laminate, depth: Depth) -> ngs.CoefficientFunction:
    """Position in the laminate's list (from 0) of the ply at a place, for the model ``plies``."""
    stack = _Stack(laminate, depth)
    return sum((ngs.IfPos(stack.entered - end, 1.0, 0.0) for end in stack.ends), ngs.CF(0.0))


class _Stack:
    """The plies of a laminate in the cells of a mesh; plies of the same kind are one."""

    def __init__(self, laminate: Laminate, depth: Depth) -> None:
        self.laminate, self.depth = laminate, depth
        self.ends = [float(end) for end in np.cumsum([p.measure for p in laminate.plies])[:-1]]
        constants = [[*p.stiffness.ravel(), p.material.density] for p in laminate.plies]
        _, first, kind = np.unique(constants, axis=0, return_index=True, return_inverse=True)
        self.kinds = [laminate.plies[k] for k in first]
        self.kind_of: IntArray = np.asarray(kind).ravel()
        symmetric = laminate.drape == "symmetric"
        self.whole = (depth.below + depth.above) * (0.5 if symmetric else 1.0)
        nearest = ngs.IfPos(depth.above - depth.below, depth.below, depth.above)
        self.laid = nearest if symmetric else depth.below
        self.scale = 1.0 if laminate.has_thickness else 1.0 / self.whole
        self.entered = self.laid * self.scale

    def in_cells(self, values: FloatArray) -> ngs.CoefficientFunction:
        """Values (kinds, n) of the ply at a place, by their moments in each cell."""
        return _sum(self._moments, values)

    def on_average(self, values: FloatArray) -> ngs.CoefficientFunction:
        """Mean of values (kinds, n) over the local thickness."""
        if not self.laminate.has_thickness:
            shares = [ngs.CF(share) for share in self._by_kind(self.laminate.shares.tolist())]
        else:
            # a ply has what is left of the thickness, at most its own
            left = [ngs.IfPos(self.whole - end, end / self.whole, 1.0) for end in self.ends]
            bounds = [ngs.CF(0.0), *left, ngs.CF(1.0)]
            shares = self._by_kind([b - a for a, b in pairwise(bounds)])
        return _sum(shares, values)

    @cached_property
    def _moments(self) -> list[ngs.GridFunction]:
        """Which kind of ply is where: 1 or 0, fitted in each cell."""
        levels, jumps = [], np.zeros((len(self.kinds), 1))
        jumps[self.kind_of[0], 0] = 1.0
        for before, after, end in zip(self.kind_of[:-1], self.kind_of[1:], self.ends, strict=True):
            change = np.zeros((len(self.kinds), 1))
            change[after] += 1.0
            change[before] -= 1.0
            # deeper than the end of a ply: by a plane, or between two of them
            planes = self.planes(end)
            levels += planes
            jumps = np.concatenate([jumps, *[change] * len(planes)], axis=1)
            jumps[:, :1] -= change * (len(planes) - 1)
        return fit_in_cells(self.depth.fem, self.depth.region, levels, jumps)

    def planes(self, end: float) -> list[ngs.CoefficientFunction]:
        """Levels that are positive deeper than the end of a ply, from each face it is laid from."""
        depth = end * (1.0 if self.laminate.has_thickness else self.whole)
        if self.laminate.drape == "through":
            return [self.depth.below - depth]
        # where the blade is too thin for the ply, both planes are in the middle
        reached = ngs.IfPos(self.whole - depth, depth, self.whole)
        return [self.depth.below - reached, self.depth.above - reached]

    def _by_kind(self, of_plies: Sequence[_Value]) -> list[_Value]:
        """Sum of what belongs to the plies of each kind."""
        sums: list[Any] = [0.0] * len(self.kinds)
        for kind, value in zip(self.kind_of, of_plies, strict=True):
            sums[kind] = sums[kind] + value
        return sums


def _stiffness(stack: _Stack) -> ngs.CoefficientFunction:
    """``Q + R K R^T``, ``R K`` and ``K`` in the blocks of the plane and out of it."""
    reduced = np.array([reduced_stiffness(kind.stiffness).ravel() for kind in stack.kinds])
    couplings, compliances = zip(
        *(out_of_plane(kind.stiffness) for kind in stack.kinds), strict=True
    )
    Q = stack.in_cells(reduced).Reshape((3, 3))
    R = stack.on_average(np.array([c.ravel() for c in couplings])).Reshape((3, 3))
    K = ngs.Inv(stack.on_average(np.array([c.ravel() for c in compliances])).Reshape((3, 3)))
    RK = R * K
    pp = Q + RK * R.trans
    p, q = list(IN_PLANE), list(OUT_OF_PLANE)
    blocks = {}
    for a in range(3):
        for b in range(3):
            blocks[p[a], p[b]] = pp[a, b]
            blocks[p[a], q[b]] = RK[a, b]
            blocks[q[b], p[a]] = RK[a, b]
            blocks[q[a], q[b]] = K[a, b]
    return ngs.CF(tuple(blocks[i, j] for i in range(6) for j in range(6)), dims=(6, 6))


def _sum(weights: Sequence[ngs.CoefficientFunction], values: FloatArray) -> ngs.CoefficientFunction:
    """Weighted sum of values (kinds, n); the weights sum to 1."""
    total = ngs.CF(tuple(values[0]))
    for weight, row in zip(weights[1:], values[1:], strict=True):
        total = total + weight * ngs.CF(tuple(row - values[0]))
    return total
