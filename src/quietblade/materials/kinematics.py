# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strain measures, and the volumetric term that nearly incompressible solids share."""

import ngsolve as ngs


def green_lagrange(F: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
    """Green-Lagrange strain ``E = (F^T F - 1) / 2`` of a deformation gradient."""
    return 0.5 * (F.trans * F - ngs.Id(3))


def volumetric_energy(
    F: ngs.CoefficientFunction, p: ngs.CoefficientFunction, bulk_modulus: float
) -> ngs.CoefficientFunction:
    """``p (J - 1) - p^2 / (2 K)`` [J/m3], stationary for the mean stress ``p = K (J - 1)``."""
    return p * (ngs.Det(F) - 1) - p * p / (2 * bulk_modulus)
