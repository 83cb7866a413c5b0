# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs and tables of the paper's study, as the page finds them in their folder."""

import csv
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from quietblade.results.alternatives import AlternativeTable
from quietblade.results.claims import BLADES
from quietblade.results.files import ResultError
from quietblade.results.headline import summarise
from quietblade.results.model import ConfigurationResult, Result, path
from quietblade.results.peaks import find_peaks
from quietblade.results.store import RunFolder


@dataclass(frozen=True)
class PaperRuns:
    """Folder of the study.

    Attributes
    ----------
    root : Path
        Holds the runs ``BLADE-VARIANT``, and in ``beyond`` more of them and the tables.
    main : str
        Variant that figures and tables show.
    """

    root: Path
    main: str

    @property
    def calibration(self) -> Path:
        """Folder of the calibration, beside that of the study."""
        return self.root.parent / "paper-calibration"

    def folder(self, blade: str, variant: str) -> RunFolder:
        """Folder of a run of the study."""
        return RunFolder(self.root / f"{blade}-{variant}")

    def names(self) -> tuple[str, ...]:
        """Names of the finished runs of both blades, those beyond the paper last."""
        found = []
        for prefix in ("", "beyond/"):
            for blade in BLADES:
                folders = sorted((self.root / prefix).glob(f"{blade}-*/result.nc"))
                found += [f"{prefix}{file.parent.name}" for file in folders]
        return tuple(found)

    def result(self, name: str) -> Result:
        """Load the result of a run by its name."""
        if name not in self._loaded:
            self._loaded[name] = RunFolder(self.root / name).load()
        return self._loaded[name]

    def variant(self, blade: str, variant: str, where: str = "") -> Result | None:
        """Load the result of a variant of a blade; None if there is none."""
        name = f"{where}{blade}-{variant}"
        return self.result(name) if name in self.names() else None

    def variants(self) -> tuple[str, ...]:
        """Variants of the study that both blades have, the main one first."""
        names = [set(), set()]
        for known, blade in zip(names, BLADES, strict=True):
            runs = (n for n in self.names() if n.startswith(f"{blade}-"))
            known.update(n.removeprefix(f"{blade}-") for n in runs)
        both = sorted(names[0] & names[1])
        return (self.main, *(v for v in both if v != self.main)) if self.main in both else ()

    def table(self, blade: str, name: str) -> AlternativeTable | None:
        """Table of `tools.paper_beyond`; None if there is none."""
        try:
            return AlternativeTable.load(self.root / "beyond" / blade / f"{name}.nc")
        except ResultError:
            return None

    @cached_property
    def uncertainty(self) -> dict[tuple[str, str], float]:
        """Numerical uncertainty of the claims' figures by blade and claim, if it is known."""
        file = self.root / "claims.json"
        if not file.is_file():
            return {}
        rows: list[dict[str, Any]] = json.loads(file.read_text(encoding="utf-8"))["rows"]
        return {
            (row["case"], row["id"]): row["uncertainty"]["half_width"]
            for row in rows
            if row["uncertainty"] is not None
        }

    @cached_property
    def closest(self) -> dict[str, tuple[str, str]]:
        """Closest figure of each claim over all choices that were tried, and how many met it."""
        file = self.calibration / "closest.csv"
        if not file.is_file():
            return {}
        with file.open(encoding="utf-8", newline="") as lines:
            return {row["claim"]: (row["closest"], row["met by"]) for row in csv.DictReader(lines)}

    @cached_property
    def _loaded(self) -> dict[str, Result]:
        return {}


def headline(result: Result) -> dict[str, Any]:
    """Figures of a run that a change of the code should not change unnoticed."""
    static = summarise(result).static
    figures: dict[str, Any] = {
        "nodes": result.mesh.nodes,
        "tip_y_m": static.tip_displacement_m[1],
        "lift_n": static.lift_n,
        "film_shear_strain": static.max_film_shear_strain,
        "mid_camber": static.mid_camber,
    }
    for name, configuration in result.configurations.items():
        figures[name] = {
            mode.name: {"frequency_hz": mode.frequency, "peak_db": mode.level}
            for mode in modes_in_band(configuration)
        }
    return figures


@dataclass(frozen=True)
class ModeFigures:
    """A mode that makes a peak.

    Attributes
    ----------
    name : str
    frequency, loss_factor : float
        [Hz], and of the damped mode.
    peak, level, width : float
        Frequency of the peak [Hz], its level [dB re 1 pW] and half-power width [Hz].
    radiated : float
        Share of the injected power that is radiated at the peak.
    degrees : tuple of float
        Shares of monopole, dipole, quadrupole, ... in the radiated power.
    losses : mapping of str to float
        What each lossy part and the radiation have in the loss factor.
    stepped : mapping of float to (float, float)
        Levels [dB re 1 pW] that sweeps in even steps [Hz] show of the peak: from the band's lower
        end, and most unluckily placed.
    """

    name: str
    frequency: float
    loss_factor: float
    peak: float
    level: float
    width: float
    radiated: float
    degrees: tuple[float, ...]
    losses: Mapping[str, float]
    stepped: Mapping[float, tuple[float, float]]


def modes_in_band(configuration: ConfigurationResult) -> tuple[ModeFigures, ...]:
    """Modes that make a peak of the sound power, by frequency."""
    modes, spectrum = configuration.modes, configuration.spectrum
    share = spectrum.power[path("sphere")] / spectrum.injected
    by_degree = spectrum.power_by_degree
    shares, table = configuration.loss_shares, configuration.stepped
    found = []
    for name, peak in find_peaks(configuration).items():
        row = int(np.argmin(np.abs(configuration.peaks.frequency - peak.frequency)))
        k = modes.name.index(name)
        nearest = int(np.nanargmin(np.abs(spectrum.frequency - peak.frequency)))
        found.append(
            ModeFigures(
                name,
                float(modes.frequency[k]),
                float(modes.loss_factor[k]),
                peak.frequency,
                peak.level,
                peak.width,
                float(share[nearest]),
                tuple((by_degree[:, nearest] / by_degree[:, nearest].sum()).tolist()),
                dict(zip(shares.name, shares.share[k].tolist(), strict=True)),
                {
                    float(step): (
                        float(table.power_level[row, j]),
                        float(table.worst_level[row, j]),
                    )
                    for j, step in enumerate(table.step)
                },
            )
        )
    return tuple(found)
