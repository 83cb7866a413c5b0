# SPDX-License-Identifier: LGPL-2.1-or-later
"""From loads and transfer functions of a run to their records."""

from collections.abc import Sequence

import numpy as np

from quietblade.case import AnyCase
from quietblade.case.excitation import PressureWords
from quietblade.results.excitations import ExcitationTable, TransferTable
from quietblade.study.excitations import Excited
from quietblade.study.sound import Sound
from quietblade.study.transfer import Transfer
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.bands import band_mean
from quietblade.vibroacoustics.multipoles import Multipoles
from quietblade.vibroacoustics.power import level


def excitation_table(excited: Excited, sound: Sound) -> ExcitationTable:
    """List the loads of a case and what each of them does."""
    random, drives = excited.correlation is not None, excited.drives
    solved = np.isfinite(sound.budget.radiated)
    frequency = sound.frequency[solved]
    ends = float(frequency[0]), float(frequency[-1])
    means = [
        band_mean(frequency, power, ends) if len(frequency) > 1 else float(power[0])
        for power in sound.loads.radiated[solved].T
    ]
    return ExcitationTable(
        signal="random" if random else "harmonic",
        correlation=excited.correlation or "",
        name=tuple(drive.load.name for drive in drives),
        kind=tuple(drive.kind for drive in drives),
        unit=tuple(drive.unit for drive in drives),
        size=np.array([drive.size for drive in drives]),
        amplitude=excited.amplitude(sound.frequency).T,
        radiated=sound.loads.radiated.T,
        injected=sound.loads.injected.T,
        mean_level=level(np.array(means)),
    )


def transfer_table(transfer: Transfer | None) -> TransferTable:
    """Transfer functions of a case; without rows if it asks for none."""
    if transfer is None:
        none, at_root = np.zeros((0, 0)), np.zeros((0, 3, 0), dtype=complex)
        nowhere = np.zeros((3, 0))
        return TransferTable(
            (),
            np.full(3, np.nan),
            none.astype(complex),
            none,
            at_root,
            at_root,
            nowhere,
            nowhere,
            np.zeros(0),
        )
    blocked = transfer.blocked.transpose(1, 2, 0)
    return TransferTable(
        functions=transfer.functions,
        about=transfer.about,
        mobility=transfer.mobility.T,
        power_per_force=transfer.power_per_force.T,
        blocked_force=blocked[:, :3],
        blocked_moment=blocked[:, 3:],
        root_force=transfer.on_root.T[:3],
        root_moment=transfer.on_root.T[3:],
        shaft_power=transfer.shaft_power,
    )


def first_pressure(case: AnyCase) -> float:
    """Constant amplitude of the first load if it is a harmonic pressure, else nan [Pa]."""
    words = case.excitation[0]
    if not isinstance(words, PressureWords) or words.table or case.acoustics.signal == "random":
        return float("nan")
    return 1.0 if words.pressure is None else words.pressure


def first_area(excited: Excited) -> float:
    """Area of the first load if it is a pressure, else nan [m2]."""
    first = excited.drives[0]
    return first.size if first.kind == "pressure" else float("nan")


def outgoing_by_degree(waves: Sequence[Multipoles]) -> FloatArray:
    """Power of each degree of all independent parts together, (degrees, f) [W]."""
    each = [part.power_by_degree.T for part in waves]
    most = max(map(len, each))
    return np.asarray(sum(np.pad(part, ((0, most - len(part)), (0, 0))) for part in each))
