# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stiffness of the paper's woven laminate along the span, by lamination theory."""

import numpy as np

from quietblade.materials import OrthotropicSVK, find_material, ply_axes, section_directions
from quietblade.typing import FloatArray
from verification.registry import check
from verification.structure_models import voigt_stiffness

_THEORY = "transformed compliance of a woven ply at 45 degrees (Jones, Mechanics of Composites)"


def laminate_compliance() -> FloatArray:
    """Compliance (6, 6) [1/Pa] of the woven ply at 45 degrees, in the blade frame."""
    weave = find_material("woven-carbon-paper")
    assert isinstance(weave, OrthotropicSVK)
    turned = weave.oriented(ply_axes(np.pi / 4, *section_directions()))
    return np.linalg.inv(voigt_stiffness(turned))


# References are given to four or five digits.
@check("structure/laminate-modulus", quantity="modulus of the laminate along the span [GPa]",
       reference=17.426, source=_THEORY, tolerance=1e-3)  # fmt: skip
def _modulus() -> float:
    return float(1e-9 / laminate_compliance()[2, 2])


@check("structure/laminate-poisson", quantity="Poisson's ratio, span to chord", reference=0.7426,
       source=_THEORY, tolerance=1e-4)  # fmt: skip
def _poisson() -> float:
    S = laminate_compliance()
    return float(-S[0, 2] / S[2, 2])
