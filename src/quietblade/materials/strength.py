# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strengths of a ply, for failure indices."""

from dataclasses import dataclass, fields

from quietblade.materials.protocols import require_positive


@dataclass(frozen=True)
class PlyStrength:
    """Stresses [Pa] at which a ply fails under one stress alone; all are positive numbers.

    Attributes
    ----------
    xt, xc : float
        Tension and compression along axis 1, the fibres.
    yt, yc : float
        Tension and compression along axis 2, across the fibres in the ply.
    s12 : float
        Shear in the ply.

    Raises
    ------
    MaterialError
        If a strength is not positive.
    """

    xt: float
    xc: float
    yt: float
    yc: float
    s12: float

    def __post_init__(self) -> None:
        require_positive("strength", **{f.name: getattr(self, f.name) for f in fields(self)})
