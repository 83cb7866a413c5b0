# SPDX-License-Identifier: LGPL-2.1-or-later
"""Errors that end a computation, and notices that accompany its result."""

from dataclasses import dataclass


class QuietbladeError(Exception):
    """Base of every error that quietblade raises on purpose."""


class CaseError(QuietbladeError):
    """The case file says something that cannot be understood or cannot be true."""


class GeometryError(QuietbladeError):
    """The blade, its film or a section is not a possible shape."""


class MaterialError(QuietbladeError):
    """A material's constants are not admissible."""


class MeshError(QuietbladeError):
    """The mesh cannot be built, or a cell is inverted."""


class InvertedCellError(MeshError):
    """A cell of a mesh is inverted; cells of another size may not be."""


class ConvergenceError(QuietbladeError):
    """An iteration ended without a solution."""


class SolverError(QuietbladeError):
    """No linear solver reached the wanted residual."""


@dataclass(frozen=True)
class Notice:
    """Something that the user should know about a result; it never stops a run.

    Attributes
    ----------
    where : str
        Part of the computation or place on the blade.
    message : str
        What is noticed.
    value, limit : float or None
        The value and the limit it is compared with, in SI units.
    remedy : str
        What can be done about it.
    """

    where: str
    message: str
    value: float | None = None
    limit: float | None = None
    remedy: str = ""

    def __str__(self) -> str:
        compared = ""
        if self.value is not None and self.limit is not None:
            compared = f" ({self.value:.4g} against {self.limit:.4g})"
        remedy = f". {self.remedy}" if self.remedy else ""
        return f"{self.where}: {self.message}{compared}{remedy}"
