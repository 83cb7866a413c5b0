# SPDX-License-Identifier: LGPL-2.1-or-later
"""No force on the blade draws power from the water or from the materials: C0, C1, both conditions.

Forces are random, complex and on all unknowns of the solid.  A finite number of them says it of
every combination of theirs: the powers are Hermitian forms, and their least eigenvalue is tested.
"""

from dataclasses import dataclass
from functools import cache, cached_property, partial

import numpy as np

from quietblade.linalg import make_solver
from quietblade.typing import ComplexArray, FloatArray
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.power import dissipated_by_region, injected_power, radiated_power
from verification.acoustics_sweep import STATES, blade
from verification.registry import check

FREQUENCY = 137.0
FORCES = 8
PART = "powers of the radiation condition and of the materials are never negative"


@dataclass(frozen=True, eq=False)
class ForcedSystem:
    """Responses of a system to random forces at one frequency.

    Attributes
    ----------
    operators : Operators
    frequency : float
        [Hz]
    count : int
        Number of forces.
    seed : int
    """

    operators: Operators
    frequency: float
    count: int = FORCES
    seed: int = 0

    @property
    def omega(self) -> float:
        """Angular frequency [rad/s]."""
        return 2.0 * np.pi * self.frequency

    @cached_property
    def loads(self) -> ComplexArray:
        """Right-hand sides (count, n)."""
        rng = np.random.default_rng(self.seed)
        u = self.operators.blocks.u
        loads = np.zeros((self.count, self.operators.size), dtype=np.complex128)
        parts = rng.standard_normal((2, self.count, len(u)))
        loads[:, u] = parts[0] + 1j * parts[1]
        return loads

    @cached_property
    def responses(self) -> ComplexArray:
        """Solutions (count, n)."""
        factor = make_solver(precision="double").factor(self.operators.at(self.omega))
        return np.asarray(factor.solve(self.loads.T).T)

    def powers(self, amplitude: ComplexArray) -> tuple[float, float, float]:
        """Injected, radiated and dissipated power [W] of the forces times amplitudes (count,)."""
        response, load = amplitude @ self.responses, amplitude @ self.loads
        omega = np.array(self.omega)
        dissipated = dissipated_by_region(self.operators, omega, response)
        return (
            float(injected_power(load, omega, response)),
            float(radiated_power(self.operators, omega, response)),
            float(sum(dissipated.values())),
        )

    def forms(self) -> FloatArray:
        """Least eigenvalues of the radiated and of the dissipated power, over the trace (2,)."""
        least = []
        for part in (1, 2):
            form = _hermitian(lambda a, part=part: self.powers(a)[part], self.count)
            values = np.linalg.eigvalsh(form)
            least.append(values[0] / values.sum())
        return np.array(least)


def _hermitian(power, count: int) -> ComplexArray:  # type: ignore[no-untyped-def]
    """Matrix of a Hermitian form by polarisation."""
    unit = np.eye(count, dtype=np.complex128)
    own = np.array([power(row) for row in unit])
    form = np.diag(own).astype(np.complex128)
    for i in range(count):
        for j in range(i):
            real = 0.5 * (power(unit[i] + unit[j]) - own[i] - own[j])
            imag = 0.5 * (power(unit[i] + 1j * unit[j]) - own[i] - own[j])
            # (a + i b)^H F (a + i b): the mixed term is 2 Re(i F_ij)
            form[i, j] = real - 1j * imag
            form[j, i] = np.conj(form[i, j])
    return form


@cache
def least_share(state: str, exact: bool) -> float:
    """Most negative eigenvalue of both powers, over their traces; zero if there is none."""
    body = blade(state)
    system = body.system(body.exact_condition() if exact else None)
    return float(min(0.0, ForcedSystem(system, FREQUENCY).forms().min()))


for _state, (_, _, _where) in STATES.items():
    for _exact, _condition in ((True, "dtn"), (False, "bgt1")):
        check(
            f"acoustics/blade-passivity-{_condition}{_state}",
            quantity="least eigenvalue of the radiated and of the dissipated power over all "
            f"combinations of {FORCES} random forces, over the trace, composite blade {_where}, "
            f"{_condition}, {FREQUENCY:g} Hz",
            reference=0.0,
            source=PART,
            tolerance=1e-12,  # rounding
            quick=False,
        )(partial(least_share, _state, _exact))
