# SPDX-License-Identifier: LGPL-2.1-or-later
"""The viscoelastic film inside the blade."""

from dataclasses import dataclass

import numpy as np

from quietblade.errors import GeometryError


@dataclass(frozen=True)
class Film:
    """A film of constant thickness around the camber surface.

    Attributes
    ----------
    span, chord : tuple of float
        Span fractions and chord fractions between which the film lies.
    thickness : float
        Thickness along the section normal [m].
    """

    span: tuple[float, float]
    chord: tuple[float, float]
    thickness: float

    def check(self) -> None:
        """Check the film by itself.

        Raises
        ------
        GeometryError
            A range is reversed or not inside (0, 1), or the thickness is not positive.
        """
        for name, (first, last), ends in (
            ("span", self.span, "root and tip"),
            ("chord", self.chord, "leading and trailing edge"),
        ):
            if not first < last:
                raise GeometryError(
                    f"film: {name} range ({first:g}, {last:g}) is empty or reversed; "
                    "give the smaller fraction first"
                )
            if not (first > 0.0 and last < 1.0):
                raise GeometryError(
                    f"film: {name} range ({first:g}, {last:g}) must lie inside (0, 1), "
                    f"because the film is embedded: leave material at {ends}"
                )
        if not (np.isfinite(self.thickness) and self.thickness > 0.0):
            raise GeometryError(
                f"film: thickness {1e3 * self.thickness:g} mm; it must be positive "
                "(a blade without film has film = None)"
            )
