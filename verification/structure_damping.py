# SPDX-License-Identifier: LGPL-2.1-or-later
"""Modal loss of a sandwich beam at rest against the Mead-Markus sandwich theory."""

from functools import cache

import numpy as np

from quietblade.materials import IsotropicSVK, MooneyRivlin
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.tangent import compute_tangent
from quietblade.typing import FloatArray
from verification.registry import check
from verification.structure_models import box_mesh, dry_modes

_LENGTH, _WIDTH, _FACE, _CORE = 0.1778, 0.0127, 1.524e-3, 0.127e-3
_LOSS = 0.1
_THEORY = "Ritz solution of the Mead-Markus sandwich beam (data of Rao, Soni, Leibowitz and Lifson)"


@cache
def sandwich_modes() -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and loss factors over that of the core, three lowest bending modes.

    The sides only slide, and the faces have no Poisson's effect: a beam, not a plate.
    """
    planes = np.array([0.0, _FACE, _FACE + _CORE, 2 * _FACE + _CORE])
    mesh = box_mesh(
        np.array([0.0, _WIDTH]),
        planes,
        np.linspace(0.0, _LENGTH, 49),
        in_film=lambda centres: np.abs(centres[:, 1] - planes.mean()) < _CORE,
    )
    shear, bulk = 1.794e6 / 2.6, 1.794e6 / (3 * 0.4)
    materials = {
        "blade": IsotropicSVK("face", 2766.0, 69e9, 0.0),
        "film": MooneyRivlin("core", 968.1, shear / 2, 0.0, bulk, _LOSS),
    }
    structure = Structure(mesh, materials, wetted="upper", guided={"x": "left|right"})
    tangent = compute_tangent(structure, structure.rest())
    modes = dry_modes(tangent, 3)
    return modes.omega / (2 * np.pi), modes.loss_factors(tangent, "isochoric") / _LOSS


# The theory has faces without shear and a core without bending; 3 mm cells, 23 times the core.
for _mode, (_frequency, _ratio) in enumerate(
    ((64.08, 0.2815), (296.59, 0.2424), (744.28, 0.1541)), start=1
):

    @check(f"structure/sandwich-frequency-{_mode}",
           quantity=f"frequency {_mode} of the sandwich without loss [Hz]", reference=_frequency,
           source=_THEORY, tolerance=3e-3 * _frequency)  # fmt: skip
    def _frequencies(mode: int = _mode) -> float:
        return float(sandwich_modes()[0][mode - 1])

    @check(f"structure/sandwich-loss-{_mode}",
           quantity=f"loss factor {_mode} over the core's", reference=_ratio, source=_THEORY,
           tolerance=1e-2 * _ratio)  # fmt: skip
    def _losses(mode: int = _mode) -> float:
        return float(sandwich_modes()[1][mode - 1])
