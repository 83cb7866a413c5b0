# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strain measures."""

import ngsolve as ngs


def green_lagrange(F: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
    """Green-Lagrange strain ``E = (F^T F - 1) / 2`` of a deformation gradient."""
    return 0.5 * (F.trans * F - ngs.Id(3))
