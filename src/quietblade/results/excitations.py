# SPDX-License-Identifier: LGPL-2.1-or-later
"""Records of what sets the blade in motion, and of transfer functions."""

from dataclasses import dataclass
from typing import ClassVar

from quietblade.results.record import Record
from quietblade.typing import ComplexArray, FloatArray

RANDOM = "random"
"""Word of the signal whose powers are per hertz."""


def of_signal(label: str, *, random: bool) -> str:
    """Return a label with the references of levels as they are: per hertz for random loads."""
    if not random:
        return label
    per_hertz = {"1 pW": "1 pW/Hz", "1 uPa m": "1 uPa m/sqrt(Hz)", "1 µPa m": "1 µPa m/√Hz"}
    for reference, density in per_hertz.items():
        label = label.replace(reference, density)
    return label


@dataclass(frozen=True, eq=False, repr=False)
class ExcitationTable(Record):
    """Loads in the order of the case, and their powers."""

    group: ClassVar[str] = "C*/excitations"
    signal: str
    correlation: str
    name: tuple[str, ...]
    kind: tuple[str, ...]
    unit: tuple[str, ...]
    size: FloatArray
    amplitude: ComplexArray
    radiated: FloatArray
    injected: FloatArray
    mean_level: FloatArray

    @property
    def power_unit(self) -> str:
        """Unit of powers: that of random loads is per hertz."""
        return "W/Hz" if self.signal == RANDOM else "W"

    @property
    def level_reference(self) -> str:
        """Reference of power levels."""
        return "1 pW/Hz" if self.signal == RANDOM else "1 pW"


@dataclass(frozen=True, eq=False, repr=False)
class TransferTable(Record):
    """Transfer functions that the case asks for; the others are NaN, or without rows."""

    group: ClassVar[str] = "C*/transfer"
    functions: tuple[str, ...]
    about: FloatArray
    mobility: ComplexArray
    power_per_force: FloatArray
    blocked_force: ComplexArray
    blocked_moment: ComplexArray
    root_force: FloatArray
    root_moment: FloatArray
    shaft_power: FloatArray
