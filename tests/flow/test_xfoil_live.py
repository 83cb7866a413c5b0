# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel method against the program XFOIL itself, on sections that no table holds."""

from pathlib import Path

import numpy as np
import pytest

from quietblade.flow import PanelSections
from tests.flow.shapes import naca
from tools.make_xfoil_tables import Xfoil, XfoilError

ALPHAS = [-3.0, 5.0]


@pytest.mark.live
@pytest.mark.parametrize("edge", [0.0, 0.004])
def test_bent_and_rippled_section(edge: float, tmp_path: Path) -> None:
    contour = naca(0.08, 0.02, edge)
    x = contour[:, :1]
    contour += [0.0, 1.0] * (0.01 * x * (1.0 - x) ** 2 + 1e-4 * np.sin(9.0 * x))
    contour = contour.round(8)
    try:
        theirs = Xfoil(tmp_path).inviscid(contour, ALPHAS)
    except XfoilError as error:
        pytest.skip(str(error))
    ours = PanelSections(contour[None]).solve(np.radians(ALPHAS)[:, None])
    np.testing.assert_allclose(ours.cp[:, 0], theirs.cp, atol=5.005e-6)
    np.testing.assert_allclose(ours.lift[:, 0], theirs.lift, atol=5.005e-5)
