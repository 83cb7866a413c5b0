# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frequencies of prestressed and rotating beams against beam theory."""

from functools import cache

import numpy as np

from quietblade.propulsion.structure import Spin
from quietblade.propulsion.tangent import compute_tangent
from quietblade.typing import FloatArray
from verification.registry import check
from verification.structure_models import Beam, DryModes, dry_modes

_BEAM = Beam(cells=32)
_ROTATING = "Euler-Bernoulli cantilever, zero hub radius (Wright, Smith, Thresher, Wang 1982)"
_AXIAL = "Euler-Bernoulli cantilever under a constant axial force, exact"


@cache
def rotating_modes(speed: float) -> DryModes:
    """Lowest modes of a beam that rotates about x; speed made dimensionless by `time_scale`."""
    structure = _BEAM.structure(Spin(speed / _BEAM.time_scale))
    state = structure.solve(np.zeros(len(structure.basis.points)))
    return dry_modes(compute_tangent(structure, state), 6)


def flap_and_edge(speed: float) -> tuple[FloatArray, FloatArray]:
    """Dimensionless frequencies out of and in the plane of rotation, three each."""
    modes = rotating_modes(speed)
    structure = _BEAM.structure()
    free = np.flatnonzero(structure.forms.free)
    n = structure.forms.n_displacement // 3
    across = (modes.shapes[free < n] ** 2).sum(axis=0)
    along = (modes.shapes[(free >= n) & (free < 2 * n)] ** 2).sum(axis=0)
    flap = across > along
    omega = modes.omega * _BEAM.time_scale
    return omega[flap], omega[~flap]


# Slenderness 100: shear and rotary inertia lower the third frequency by 1e-3.
_FLAP = {
    0: (3.51602, 22.03449, 61.69721),
    3: (4.79728, 23.32026, 62.98497),
    10: (11.20233, 33.64037, 74.64929),
}

for _speed, _frequencies in _FLAP.items():
    for _mode, _value in enumerate(_frequencies, start=1):
        _name = f"structure/rotating-beam-{_speed}" + (f"-mode-{_mode}" if _mode > 1 else "")

        @check(_name, quantity=f"flap frequency {_mode} at Omega = {_speed}, times sqrt(m L^4/EI)",
               reference=_value, source=_ROTATING, tolerance=2e-3 * _value)  # fmt: skip
        def _flap(speed: float = _speed, mode: int = _mode) -> float:
            return float(flap_and_edge(speed)[0][mode - 1])


@check("structure/rotating-beam-in-plane",
       quantity="flap^2 - edge^2 at Omega = 3, first mode, times m L^4/EI", reference=9.0,
       source=_ROTATING, tolerance=9e-3)  # fmt: skip
def _in_plane() -> float:
    flap, edge = flap_and_edge(3.0)
    return float(flap[0] ** 2 - edge[0] ** 2)


@cache
def axial_squares(force: float) -> FloatArray:
    """Squares of the dimensionless bending frequencies under an axial force N L^2 / EI."""
    structure = _BEAM.structure()
    size = force * _BEAM.bending_stiffness / _BEAM.length**2
    load = _BEAM.tip_load(structure, np.array([0.0, 0.0, size]))
    state = structure.solve(np.zeros(len(structure.basis.points)), dead_load=load)
    modes = dry_modes(compute_tangent(structure, state), 4)
    return modes.squares * _BEAM.time_scale**2


# A beam of slenderness 100, stretched by 1e-4 at most.
for _force, _value in {-2: 1.58091, 5: 5.76820, 20: 9.16082}.items():

    @check(f"structure/axial-force-{_force}",
           quantity=f"first frequency at N L^2/EI = {_force}, times sqrt(m L^4/EI)",
           reference=_value, source=_AXIAL, tolerance=3e-3 * _value)  # fmt: skip
    def _axial(force: float = _force) -> float:
        return float(np.sqrt(axial_squares(force)[0]))


# The square of the frequency is almost linear in the force between the two that are computed.
@check("structure/axial-buckling", quantity="N L^2/EI where the first frequency vanishes",
       reference=-np.pi**2 / 4, source="Euler's column", tolerance=5e-3)  # fmt: skip
def _buckling() -> float:
    # beyond buckling the straight state is an equilibrium still, an unstable one
    low, high = -2.6, -2.3
    a, b = axial_squares(low)[0], axial_squares(high)[0]
    return float(low - a * (high - low) / (b - a))
