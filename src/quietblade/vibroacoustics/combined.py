# SPDX-License-Identifier: LGPL-2.1-or-later
"""What several loads do together, from the responses to each one alone (theory: S2-76)."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from quietblade.typing import AnyArray, ComplexArray, FloatArray
from quietblade.vibroacoustics.power import (
    PowerBudget,
    System,
    dissipated_by_region,
    power_budget,
    radiated_power,
)


@dataclass(frozen=True, eq=False)
class Combined:
    """Responses to several loads, and amplitudes of the loads.

    Attributes
    ----------
    system : System
        Operators, or those of a reduced model.
    omega : (f,) array
        [rad/s]
    each : (f, k, n) array
        Responses to a unit of each load.
    loads : (k, n) array
        The loads.
    parts : (j, f, k) array
        Amplitudes of the independent parts, whose powers add (`loads.independent_parts`); peaks,
        or for random loads peaks per root of a hertz.
    """

    system: System
    omega: FloatArray
    each: ComplexArray
    loads: AnyArray
    parts: ComplexArray

    @cached_property
    def responses(self) -> ComplexArray:
        """Response of each part, (j, f, n)."""
        return np.asarray(np.einsum("jfk,fkn->jfn", self.parts, self.each))

    @property
    def budget(self) -> PowerBudget:
        """Powers of all parts together (f,) [W], or [W/Hz] of random loads."""
        budgets = [
            power_budget(self.system, self.omega, response, amplitude @ self.loads)
            for amplitude, response in zip(self.parts, self.responses, strict=True)
        ]
        return sum(budgets[1:], start=budgets[0])

    @property
    def lost(self) -> Mapping[str, FloatArray]:
        """Dissipated power by lossy part (f,)."""
        parts = [dissipated_by_region(self.system, self.omega, x) for x in self.responses]
        return {name: np.sum([part[name] for part in parts], axis=0) for name in parts[0]}

    @property
    def radiated(self) -> FloatArray:
        """Power through the sphere (f,)."""
        parts = (radiated_power(self.system, self.omega, x) for x in self.responses)
        return np.asarray(np.sum(list(parts), axis=0))

    @property
    def radiated_by_unit(self) -> FloatArray:
        """Power through the sphere of a unit of each load alone, (f, k) [W]."""
        beside = np.broadcast_to(self.omega[:, None], self.each.shape[:2])
        return radiated_power(self.system, beside, self.each)

    @property
    def injected_by_load(self) -> FloatArray:
        """Power that each load puts in while all act, (f, k): the sum is the injected power."""
        work = np.einsum("jfk,jfn,kn->fk", self.parts.conj(), self.responses, self.loads.conj(),
                         optimize=True)  # fmt: skip
        return np.asarray(-0.5 * self.omega[:, None] * work.imag)

    @property
    def work(self) -> ComplexArray:
        """b_k^T x_k of a unit of each load alone, (f, k) [J per unit squared]."""
        return np.asarray(np.einsum("fkn,kn->fk", self.each, self.loads))
