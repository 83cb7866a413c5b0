# SPDX-License-Identifier: LGPL-2.1-or-later
"""Records of the modes: count, losses, participation, dry modes, Campbell diagram."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from quietblade.results.record import Record
from quietblade.typing import FloatArray, IntArray


@dataclass(frozen=True, eq=False, repr=False)
class ModeCount(Record):
    """How many wet modes there are, and of what kind."""

    group: ClassVar[str] = "C*/mode_count"
    counted: int
    highest: float
    character: tuple[str, ...]
    family_share: FloatArray
    residual: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class LossShares(Record):
    """Where each wet mode loses its energy."""

    group: ClassVar[str] = "C*/loss_shares"
    name: tuple[str, ...]
    share: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class Participation(Record):
    """Shares of the wet modes in the response at some frequencies."""

    group: ClassVar[str] = "C*/participation"
    frequency: FloatArray
    share: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class DryModes(Record):
    """Modes without water; none unless the case asks for them."""

    group: ClassVar[str] = "C*/dry_modes"
    name: tuple[str, ...]
    frequency: FloatArray
    loss_factor: FloatArray
    purity: FloatArray
    partner: tuple[str, ...]
    partner_mac: FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class CampbellDiagram(Record):
    """Wet modes under load over the speed of the shaft; empty unless the case asks for it."""

    group: ClassVar[str] = "campbell"
    advance: str
    blades: int
    rotation: FloatArray
    advance_speed: FloatArray
    tip_displacement: FloatArray
    order: IntArray
    name: tuple[str, ...]
    frequency: FloatArray
    crossing_mode: tuple[str, ...]
    crossing_order: IntArray
    crossing_rotation: FloatArray
    crossing_frequency: FloatArray

    @classmethod
    def none(cls) -> "CampbellDiagram":
        """Return a diagram without speeds and modes."""
        nothing, no_count = np.zeros(0), np.zeros(0, dtype=np.int64)
        return cls(
            "", 0, nothing, nothing, np.zeros((0, 3)), no_count, (), np.zeros((0, 0)),
            (), no_count, nothing, nothing,
        )  # fmt: skip

    @property
    def blade_rate(self) -> FloatArray:
        """Frequency of the blade rate's multiples, (orders, speeds) [Hz]."""
        return np.outer(self.order * self.blades, self.rotation) / (2.0 * np.pi)
