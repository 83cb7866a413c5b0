# SPDX-License-Identifier: LGPL-2.1-or-later
"""Slender solid cantilevers at large bending against the elastica."""

from collections.abc import Sequence
from functools import cache

import numpy as np

from quietblade.propulsion.structure import StructureState
from quietblade.typing import FloatArray
from verification.registry import check
from verification.structure_beam_theory import Tip, elastica, follower_elastica, rolled
from verification.structure_models import Beam

LOADS = ("dead force", "dead line", "follower force", "follower line", "end moment")


def cantilever_path(load: str, sizes: Sequence[float], beam: Beam | None = None) -> list[Tip]:
    """Tip of a solid cantilever under growing loads, each solved from the one before.

    Parameters
    ----------
    load : str
        One of `LOADS`: tip force or uniform load per length, of fixed direction or following the
        beam, or a moment at the tip.
    sizes : sequence of float
        ``P L^2/EI``, ``q L^3/EI`` or ``M L/EI``.
    beam : Beam or None
        Default: slenderness 100, 40 hexahedra.

    Returns
    -------
    list of Tip
        To be compared with `elastica`, `follower_elastica` and `rolled`.
    """
    model = _Cantilever(load, Beam() if beam is None else beam)
    state, tips = None, []
    for size in sizes:
        state = model.solve(size, state)
        tips.append(model.tip(state))
    return tips


class _Cantilever:
    """A beam with one kind of load, of any size."""

    def __init__(self, load: str, beam: Beam) -> None:
        if load not in LOADS:
            raise ValueError(f"load {load!r} is none of {', '.join(LOADS)}")
        self._load, self._beam = load, beam
        # a follower force acts around the tip section: one more cell beyond it, without load
        beyond = 1 if load == "follower force" else 0
        wetted = "tip" if load == "end moment" else "lower|upper"
        # the sides slide, so that bending stays in its plane
        self._structure = beam.structure(beyond=beyond, wetted=wetted, guided={"x": "left|right"})
        points = self._structure.basis.points
        self._at_tip = np.abs(points[:, 2] - beam.length) < 1e-9 * beam.length
        self._upper = np.flatnonzero(self._at_tip & (points[:, 1] > 0.4 * beam.height))
        self._lower = np.flatnonzero(self._at_tip & (points[:, 1] < -0.4 * beam.height))

    def solve(self, size: float, start: StructureState | None) -> StructureState:
        return self._structure.solve(
            self._pressure(size), start, dead_load=self._dead(size), tolerance=1e-8
        )

    def tip(self, state: StructureState) -> Tip:
        """Displacement of the middle of the tip section, and rotation of its height."""
        length = self._beam.length
        moved = self._structure.basis.points + self._structure.values(state)
        upper, lower = moved[self._upper].mean(axis=0), moved[self._lower].mean(axis=0)
        middle, height = 0.5 * (upper + lower), upper - lower
        angle = float(np.arctan2(-height[2], height[1]))
        return Tip(float(1.0 - middle[2] / length), float(middle[1] / length), angle)

    def _dead(self, size: float) -> FloatArray:
        beam = self._beam
        force = size * beam.bending_stiffness / beam.length**2
        if self._load == "dead force":
            return beam.tip_load(self._structure, np.array([0.0, force, 0.0]))
        if self._load == "dead line":
            return beam.line_load(self._structure, np.array([0.0, force / beam.length, 0.0]))
        return np.zeros(self._structure.forms.n_displacement)

    def _pressure(self, size: float) -> FloatArray:
        """Nodal pressures [Pa]."""
        beam, y = self._beam, self._structure.basis.points[:, 1]
        # Half of a follower load pushes, half of it pulls on opposite faces: one face alone
        # changes its length in bending, and with it the load.
        faces = np.where(np.abs(y) > 0.4 * beam.height, -0.5 * np.sign(y), 0.0) / beam.height
        force = size * beam.bending_stiffness / beam.length**2
        if self._load == "follower line":
            return force / beam.length * faces
        if self._load == "follower force":
            # a nodal pressure at the vertices of one section has a third of a cell's length
            return force / (beam.length / beam.cells / 3.0) * faces * self._at_tip
        if self._load == "end moment":
            # stress of the bent strip to second order in the strain: a linear one would make
            # the end face uneven, and the pressure on it a shear force
            curvature = size / beam.length
            strain = -curvature * y - (curvature * beam.height) ** 2 / 8.0
            return -beam.youngs_modulus * (strain + 1.5 * strain**2) * self._at_tip
        return np.zeros(len(y))


_THEORY = "inextensible elastica, integrated from the tip"
_EIGHTHS = tuple(np.pi / 4 * n for n in range(1, 9))
_SIZES = {
    "dead force": (0.2, 0.4, 0.8, 1.2, 1.6, 2.0, 2.4, 2.8, 3.2, 3.6, 4.0, 10.0),
    "dead line": (1.0, 2.0, 4.0, 10.0),
    "follower line": (1.0, 2.0, 4.0, 10.0),
    "follower force": (1.0, 2.0, 4.0, 10.0),
    "end moment": _EIGHTHS,  # the strip rolls up in steps of 45 degrees
}


@cache
def _path(load: str) -> dict[float, Tip]:
    beam = Beam(cells=60) if load == "end moment" else Beam()
    sizes = _SIZES[load]
    return dict(zip(sizes, cantilever_path(load, sizes, beam), strict=True))


def _rows(name: str, load: str, size: float, reference: Tip, *, tolerance: float) -> None:
    """Rows for deflection w/L, shortening u/L and the tip's angle, with a relative tolerance."""
    for suffix, part in {"": "w", "-shortening": "u", "-angle": "angle"}.items():
        value = getattr(reference, part)
        quantity = f"tip {part}" + ("/L" if part != "angle" else " [rad]")
        check(
            f"structure/{name}{suffix}",
            quantity=f"{quantity}, {load} of size {size:g}",
            reference=value,
            source=_THEORY,
            tolerance=tolerance * value,
            quick=load in ("dead force", "follower line"),
        )(lambda part=part: float(getattr(_path(load)[size], part)))


# Slenderness 100 and 40 cells: stretch, shear and cells change the elastica by up to 5.1e-4 under
# dead loads and 1.1e-3 under the follower loads that bend furthest.
_DEAD, _FOLLOWER = 6e-4, 1.5e-3
for _k in _SIZES["dead force"]:
    _rows(f"elastica-k{_k:g}", "dead force", _k, elastica(_k), tolerance=_DEAD)
for _k in _SIZES["dead line"]:
    _rows(f"dead-line-K{_k:g}", "dead line", _k, elastica(line=_k), tolerance=_DEAD)
for _k in _SIZES["follower line"]:
    _load = follower_elastica(line=_k)
    _rows(f"follower-pressure-K{_k:g}", "follower line", _k, _load, tolerance=_FOLLOWER)
for _k in _SIZES["follower force"]:
    _load = follower_elastica(_k)
    _rows(f"follower-force-k{_k:g}", "follower force", _k, _load, tolerance=_FOLLOWER)
for _turns, _moment in ((0.25, _EIGHTHS[1]), (0.5, _EIGHTHS[3]), (1, _EIGHTHS[7])):
    for _part in ("u", "w"):

        @check(f"structure/end-moment-{_turns:g}-turns-{_part}",
               quantity=f"{_part}/L, end moment that bends the strip by {_turns:g} turns",
               reference=getattr(rolled(_moment), _part), source="arc of a circle",
               tolerance=5e-4, quick=False)  # fmt: skip
        def _roll(moment: float = _moment, part: str = _part) -> float:
            return float(getattr(_path("end moment")[moment], part))
