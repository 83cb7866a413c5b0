# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frequencies of stretched, pressed and rotating beams against beam theory."""

from functools import cache

import numpy as np

from quietblade.materials import find_material
from quietblade.propulsion.loading import Spin
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.tangent import compute_tangent
from quietblade.typing import FloatArray
from verification.registry import check
from verification.structure_beam_theory import (
    axially_loaded_cantilever,
    rotating_cantilever,
    simply_supported_beam,
    southwell,
)
from verification.structure_models import SURFACE, Beam, DryModes, box_mesh, dry_modes

_BEAM = Beam(cells=32)

# -- rotating cantilever --------------------------------------------------------------------------


@cache
def flap_and_edge(
    speed: float, *, hub_ratio: float = 0.0, beam: Beam = _BEAM
) -> tuple[FloatArray, FloatArray]:
    """Frequencies out of and in the plane of rotation, three each, times ``sqrt(m L^4/EI)``.

    Parameters
    ----------
    speed : float
        ``Omega sqrt(m L^4/EI)``, about the x axis.
    hub_ratio : float
        Radius of the root over the length.
    beam : Beam
    """
    structure = beam.structure(Spin(speed / beam.time_scale), root=hub_ratio * beam.length)
    state = structure.solve(np.zeros(len(structure.basis.points)))
    modes = dry_modes(compute_tangent(structure, state), 6)
    free = np.flatnonzero(structure.forms.free)
    n = structure.forms.n_displacement // 3
    across = (modes.shapes[free < n] ** 2).sum(axis=0)
    along = (modes.shapes[(free >= n) & (free < 2 * n)] ** 2).sum(axis=0)
    flap = across > along
    omega = modes.omega * beam.time_scale
    return omega[flap], omega[~flap]


_ROTATING = "Euler-Bernoulli cantilever by Ritz' method (Wright, Smith, Thresher, Wang 1982)"

# Slenderness 100: shear, rotary inertia and 32 cells change the third frequency by 6e-4.
for _speed in (0, 1, 2, 3, 4, 5, 10):
    for _plane, _values in zip(("flap", "edge"), rotating_cantilever(_speed), strict=True):
        for _mode, _value in enumerate(_values, start=1):
            _name = f"structure/rotating-beam-{_speed}" + ("" if _plane == "flap" else "-edge")

            @check(_name + (f"-mode-{_mode}" if _mode > 1 else ""),
                   quantity=f"{_plane} frequency {_mode} at Omega = {_speed}, times sqrt(m L^4/EI)",
                   reference=_value, source=_ROTATING, tolerance=1.5e-3 * _value,
                   quick=_speed in (0, 3, 10))  # fmt: skip
            def _rotating(
                speed: float = _speed, plane: bool = _plane == "edge", mode: int = _mode
            ) -> float:
                return float(flap_and_edge(speed)[plane][mode - 1])


for _mode, _value in enumerate(rotating_cantilever(3.0, hub_ratio=0.2)[0], start=1):

    @check(f"structure/rotating-beam-on-hub-mode-{_mode}",
           quantity=f"flap frequency {_mode} at Omega = 3, root at 0.2 L, times sqrt(m L^4/EI)",
           reference=_value, source=_ROTATING, tolerance=1.5e-3 * _value, quick=False)  # fmt: skip
    def _on_hub(mode: int = _mode) -> float:
        return float(flap_and_edge(3.0, hub_ratio=0.2)[0][mode - 1])


@check("structure/rotating-beam-in-plane",
       quantity="flap^2 - edge^2 at Omega = 3, first mode, times m L^4/EI", reference=9.0,
       source=_ROTATING, tolerance=2e-3)  # fmt: skip
def _in_plane() -> float:
    flap, edge = flap_and_edge(3.0)
    return float(flap[0] ** 2 - edge[0] ** 2)


# The coefficients are those of a slow rotation: at Omega = 1 they have changed by 1e-3.
for _mode, _value in enumerate(southwell(), start=1):

    @check(f"structure/southwell-{_mode}",
           quantity=f"(flap^2 - flap(0)^2) / Omega^2 at Omega = 1, mode {_mode}", reference=_value,
           source="Southwell's coefficient of a uniform cantilever, zero hub radius",
           tolerance=3e-3 * _value, quick=False)  # fmt: skip
    def _southwell(mode: int = _mode) -> float:
        slow, rest = flap_and_edge(1)[0][mode - 1], flap_and_edge(0)[0][mode - 1]
        return float(slow**2 - rest**2)


# -- axial force ----------------------------------------------------------------------------------


@cache
def axial_squares(force: float, *, hinged: bool = False, beam: Beam = _BEAM) -> FloatArray:
    """Squares of bending frequencies under a dead axial force, times ``m L^4/EI``.

    Parameters
    ----------
    force : float
        ``N L^2/EI``, tension positive.
    hinged : bool
        A cantilever, whose modes come in pairs (two planes), or a beam on two hinges: half of it
        between a plane of symmetry and a hinge, its symmetric modes only.
    beam : Beam
    """
    length = beam.length * (2.0 if hinged else 1.0)
    structure = (
        beam.structure(clamped=None, guided={"x": "left|right", "y": "tip", "z": "root"})
        if hinged
        else beam.structure()
    )
    size = force * beam.bending_stiffness / length**2
    load = beam.tip_load(structure, np.array([0.0, 0.0, size]))
    state = structure.solve(np.zeros(len(structure.basis.points)), dead_load=load)
    modes = dry_modes(compute_tangent(structure, state), 2 if hinged else 4)
    return modes.squares * beam.time_scale**2 * (length / beam.length) ** 4


_AXIAL = "Euler-Bernoulli beam under a constant axial force"

# A beam of slenderness 100, stretched by 2e-4 at most.
for _force in (-2, -1, 1, 5, 10, 20):
    for _mode, _square in enumerate(axially_loaded_cantilever(_force, 2), start=1):

        @check(f"structure/axial-force-{_force}" + (f"-mode-{_mode}" if _mode > 1 else ""),
               quantity=f"frequency {_mode} at N L^2/EI = {_force}, times sqrt(m L^4/EI)",
               reference=np.sqrt(_square), source=f"{_AXIAL}, by Ritz' method",
               tolerance=1e-3 * np.sqrt(_square), quick=_force in (-2, 5, 20))  # fmt: skip
        def _axial(force: float = _force, mode: int = _mode) -> float:
            return float(np.sqrt(axial_squares(force)[2 * (mode - 1)]))


for _force in (-5, 10):
    _squares = simply_supported_beam(_force, 3)
    for _mode in (1, 3):

        @check(f"structure/hinged-axial-force-{_force}-mode-{_mode}",
               quantity=f"frequency {_mode} on two hinges at N L^2/EI = {_force}, "
               "times sqrt(m L^4/EI)", reference=np.sqrt(_squares[_mode - 1]),
               source=f"{_AXIAL}, exact", tolerance=1e-3 * np.sqrt(_squares[_mode - 1]),
               quick=False)  # fmt: skip
        def _hinged(force: float = _force, mode: int = _mode) -> float:
            return float(np.sqrt(axial_squares(force, hinged=True)[mode // 2]))


def buckling_force(low: float, high: float, *, hinged: bool = False) -> float:
    """``N L^2/EI`` where the first frequency vanishes, from the squares at two forces around it.

    The square is almost linear in the force.  Beyond buckling the straight state is an
    equilibrium still, an unstable one.
    """
    a, b = (float(axial_squares(force, hinged=hinged)[0]) for force in (low, high))
    return low - a * (high - low) / (b - a)


@check("structure/axial-buckling", quantity="N L^2/EI where the first frequency vanishes",
       reference=-np.pi**2 / 4, source="Euler's column", tolerance=2.5e-3)  # fmt: skip
def _buckling() -> float:
    return buckling_force(-2.6, -2.3)


@check("structure/hinged-buckling", quantity="N L^2/EI where a hinged beam's frequency vanishes",
       reference=-np.pi**2, source="Euler's column", tolerance=1e-2, quick=False)  # fmt: skip
def _hinged_buckling() -> float:
    return buckling_force(-10.0, -9.7, hinged=True)


# -- depth ----------------------------------------------------------------------------------------


@cache
def submerged(pressure: float) -> tuple[DryModes, FloatArray]:
    """Solve six modes, and their loss, of a plate with a film under a pressure [Pa] all around.

    The pressure is part of the prestress; without the load's stiffness the plate would seem to
    buckle.
    """
    mesh = box_mesh(
        np.linspace(-0.03, 0.03, 4), np.array([0.0, 0.003, 0.0035, 0.0065]),
        np.linspace(0.0, 0.6, 13),
        in_film=lambda c: (abs(c[:, 1] - 0.00325) < 1e-3) & (abs(c[:, 0]) < 0.02) & (c[:, 2] > 0.1),
    )  # fmt: skip
    materials = {
        "blade": find_material("aluminium-paper"),
        "film": find_material("viscoelastic-paper"),
    }
    structure = Structure(mesh, materials, wetted=SURFACE)
    state = structure.solve(np.full(len(structure.basis.points), pressure))
    tangent = compute_tangent(structure, state)
    modes = dry_modes(tangent, 6)
    return modes, modes.loss_factors(tangent, "isochoric")


_DEPTH = 1000.0 * 9.81 * 100.0


@check("structure/depth-frequencies", reference=0.0, tolerance=1e-4, quick=False,
       quantity="largest relative change of six frequencies at 100 m of depth",
       source="a uniform pressure around a stiff solid is in equilibrium in every position",
       )  # fmt: skip
def _depth_frequencies() -> float:
    return float(np.abs(submerged(_DEPTH)[0].omega / submerged(0.0)[0].omega - 1.0).max())


# The film thins by p/K = 4.5e-4, since the metal holds its sides, and shears that much more.
@check("structure/depth-loss", reference=0.0, tolerance=1.5e-3, quick=False,
       quantity="largest relative change of six modal loss factors at 100 m of depth",
       source="a uniform pressure around a stiff solid is in equilibrium in every position",
       )  # fmt: skip
def _depth_loss() -> float:
    return float(np.abs(submerged(_DEPTH)[1] / submerged(0.0)[1] - 1.0).max())
