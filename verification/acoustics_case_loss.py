# SPDX-License-Identifier: LGPL-2.1-or-later
"""Models of the loss in case files: whole runs against runs that must give the same."""

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.materials.viscoelastic import FractionalZener
from quietblade.results.model import ConfigurationResult, Result
from quietblade.results.store import RunFolder
from quietblade.study.run import run_case
from verification.registry import check

COARSE = {
    "film.span": [0.1, 0.9], "film.chord": [0.25, 0.65], "film.thickness": "1 mm",
    "mesh.size": "60 mm", "acoustics.sphere_radius": "1.0 m",
    "acoustics.band": ["80 Hz", "150 Hz"], "acoustics.step": "35 Hz",
    "acoustics.points_per_mode": 1, "flow.sections": 21, "flow.section_nodes": 81,
    "static.tolerance": 1e-2,
}  # fmt: skip
"""Keys of the paper's composite blade that make it small."""

RUBBER = FractionalZener(stiffening=12.0, tau=2e-4, alpha=0.7)
ZENER = {
    "model": "fractional-zener", "stiffening": 12.0, "relaxation_time": "0.2 ms", "exponent": 0.7,
}  # fmt: skip
LOSS = "materials.polymer.loss_factor"


def run(changes: dict[str, object]) -> Result:
    """Run the coarse blade with some keys changed."""
    case = Case.parse(preset_text("paper-composite")).varied(COARSE | changes)
    with TemporaryDirectory() as folder:
        return run_case(case, RunFolder(Path(folder) / "run"))


@cache
def zener() -> Result:
    """Run with a fractional Zener film, at rest and under load."""
    return run({LOSS: ZENER})


@cache
def sheared() -> Result:
    """Run the same blade with that model at each of some static shears."""
    return run({LOSS: ZENER | {"prestrain": [{"shear": 0.02}, {"shear": 0.05}, {"shear": 0.1}]}})


@cache
def constants() -> tuple[ConfigurationResult, int]:
    """Run with the constants of the Zener model at the frequency of one mode, and say which."""
    modes = zener().configurations["C0"].modes
    k = int(np.argmax(modes.frequency > 100.0))
    g = complex(RUBBER(2.0 * np.pi * float(modes.frequency[k])))
    film = Case.parse(preset_text("paper-composite")).material("film")
    changes: dict[str, object] = {
        f"materials.polymer.{key}": f"{g.real * getattr(film, key)} Pa" for key in ("c10", "c01")
    }
    changes |= {LOSS: g.imag / g.real, "acoustics.configurations": ["C0"]}
    return run(changes).configurations["C0"], k


@check("acoustics/case-zener-peak-frequency", quantity="peak, Zener film / film of its constants",
       reference=1.0, source="constants at the frequency of the mode", tolerance=2e-5,
       quick=False)  # fmt: skip
def peak_frequency() -> float:
    """Compare the peak of that mode, the first in the band."""
    first, second = _peaks()
    return float(first.peaks.frequency[0] / second.peaks.frequency[0])


@check("acoustics/case-zener-loss-factor", quantity="loss factor, Zener film / its constants",
       reference=1.0, source="constants at the frequency of the mode", tolerance=5e-3,
       quick=False)  # fmt: skip
def loss_factor() -> float:
    """Compare its loss factor, which the complex frequency changes a little."""
    k = constants()[1]
    first, second = _peaks()
    return float(first.modes.loss_factor[k] / second.modes.loss_factor[k])


@check("acoustics/case-prestrain-same", quantity="change of loss factors on C1 by prestrain",
       reference=0.0, source="the same model at every static shear", tolerance=1e-6,
       quick=False)  # fmt: skip
def same_at_all_shears() -> float:
    """Find the largest relative change under load, with shears up to 0.05."""
    first, second = (
        result.configurations["C1"].modes.loss_factor for result in (zener(), sheared())
    )
    return float(np.max(np.abs(second / first - 1.0)))


@check("acoustics/case-zener-balance", quantity="|injected - radiated - dissipated| / injected",
       reference=0.0, source="conservation of energy", tolerance=1e-8, quick=False)  # fmt: skip
def balance() -> float:
    """Find the worst frequency of all spectra."""
    return max(
        float(configuration.spectrum.balance_residual.max())
        for result in (zener(), sheared())
        for configuration in result.configurations.values()
    )


def _peaks() -> tuple[ConfigurationResult, ConfigurationResult]:
    return zener().configurations["C0"], constants()[0]
