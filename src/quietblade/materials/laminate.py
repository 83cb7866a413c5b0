# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stacks of plies: effective stiffness in three dimensions, and classical laminate theory.

The axes of a laminate are 1 along the span, 2 chordwise, 3 through the thickness; the angle of a
ply turns its axis 1 from the span towards the trailing edge.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from quietblade.errors import MaterialError
from quietblade.materials.isotropic import IsotropicSVK
from quietblade.materials.orthotropic import OrthotropicSVK
from quietblade.materials.protocols import require, require_loss_factor, require_positive
from quietblade.materials.voigt import in_plane_rotation, turned_stiffness
from quietblade.typing import FloatArray

Drape = Literal["symmetric", "through"]
"""``symmetric``: the stack is laid from each face to the mid-surface, its first ply outside.
``through``: it is laid once, from the lower to the upper face."""

IN_PLANE, OUT_OF_PLANE = (0, 1, 5), (2, 3, 4)
"""Components 11, 22, 12 and 33, 23, 13 among the six."""

_WHOLE = 1e-6


@dataclass(frozen=True, eq=False)
class Ply:
    """One ply of a stack.

    Attributes
    ----------
    material : OrthotropicSVK or IsotropicSVK
        Constants; the axes of the material itself do not count, only the angle.
    angle : float
        From the span to axis 1 of the ply, positive towards the trailing edge [rad].
    thickness : float or None
        Thickness [m].
    fraction : float or None
        Share of the stack's thickness, 0 to 1.  One of thickness and fraction is given.

    Raises
    ------
    MaterialError
        If not exactly one of thickness and fraction is given, or it is not positive.
    """

    material: OrthotropicSVK | IsotropicSVK
    angle: float
    thickness: float | None = None
    fraction: float | None = None

    def __post_init__(self) -> None:
        name = f"ply of {self.material.name}"
        require(
            (self.thickness is None) != (self.fraction is None),
            name,
            "either a thickness or a fraction",
            f"thickness = {self.thickness}, fraction = {self.fraction}",
            "Give one of them.",
        )
        require(
            bool(np.isfinite(self.angle)),
            name,
            "a finite angle",
            f"angle = {self.angle:g}",
            "Give it in rad.",
        )
        require_positive(name, **{"thickness or fraction": self.measure})

    @property
    def measure(self) -> float:
        """The thickness [m] or the fraction, whichever is given."""
        given = self.thickness if self.thickness is not None else self.fraction
        return float("nan") if given is None else given

    @cached_property
    def stiffness(self) -> FloatArray:
        """Stiffness (6, 6) [Pa] in the axes of the laminate."""
        return turned_stiffness(self.material.stiffness, in_plane_rotation(self.angle))


@dataclass(frozen=True, eq=False)
class Laminate:
    """A named stack of plies.

    Attributes
    ----------
    name : str
        Name for messages and records.
    plies : tuple of Ply
        ``symmetric``: from a face inwards, the last ply at the mid-surface.  ``through``: from the
        lower to the upper face.  All have thicknesses, or all have fractions that sum to 1.
    drape : {"symmetric", "through"}
        How the stack lies in the blade.
    loss_factor : float or None
        Of the whole laminate; None takes that of the plies if they all have the same.

    Raises
    ------
    MaterialError
        If there is no ply, thicknesses and fractions are mixed, the fractions do not sum to 1, or
        the loss factors of the plies differ and the laminate has none of its own.
    """

    name: str
    plies: tuple[Ply, ...]
    drape: Drape = "symmetric"
    loss_factor: float | None = None

    def __post_init__(self) -> None:
        require(len(self.plies) > 0, self.name, "at least one ply", "it has none", "Add plies.")
        kinds = {ply.fraction is None for ply in self.plies}
        require(
            len(kinds) == 1,
            self.name,
            "thicknesses or fractions",
            "some plies have a thickness and some a fraction",
            "Give all plies the same.",
        )
        total = self.total
        if not self.has_thickness:
            require(
                abs(total - 1.0) < _WHOLE,
                self.name,
                "fractions that sum to 1",
                f"they sum to {total:.6g}",
                "Scale them, or give thicknesses.",
            )
        losses = {ply.material.loss_factor for ply in self.plies}
        require(
            self.loss_factor is not None or len(losses) == 1,
            self.name,
            "one loss factor",
            f"the plies have {', '.join(f'{x:g}' for x in sorted(losses))}",
            "Give the laminate a loss_factor of its own.",
        )
        require_loss_factor(self.name, self.loss)

    @property
    def has_thickness(self) -> bool:
        """Whether the plies have thicknesses (rather than fractions)."""
        return self.plies[0].fraction is None

    @property
    def total(self) -> float:
        """Sum of the plies' thicknesses [m] or fractions."""
        return sum(ply.measure for ply in self.plies)

    @property
    def loss(self) -> float:
        """Loss factor of the laminate."""
        own = self.loss_factor
        return self.plies[0].material.loss_factor if own is None else own

    @property
    def shares(self) -> FloatArray:
        """Share of each ply in the stack's thickness, (n,)."""
        return np.array([ply.measure for ply in self.plies]) / self.total

    @property
    def density(self) -> float:
        """Mean density [kg/m3]."""
        return float(self.shares @ [ply.material.density for ply in self.plies])

    @cached_property
    def stiffness(self) -> FloatArray:
        """Effective stiffness (6, 6) [Pa] of very many repeats, in the axes of the laminate."""
        return effective_stiffness([ply.stiffness for ply in self.plies], self.shares)

    def stack(self) -> tuple[Ply, ...]:
        """All plies from the lower to the upper face, as the drape lays them."""
        return self.plies if self.drape == "through" else (*self.plies, *reversed(self.plies))

    def abd(self, thickness: float | None = None) -> "PlateStiffness":
        """Membrane, coupling and bending stiffness of a plate with this stack.

        Parameters
        ----------
        thickness : float or None
            Thickness of the plate [m]; None takes the sum of the plies as they are draped.

        Raises
        ------
        MaterialError
            If the plies have fractions and no thickness is given.
        """
        stack = self.stack()
        heights = np.array([ply.measure for ply in stack])
        if thickness is not None:
            heights *= thickness / heights.sum()
        elif not self.has_thickness:
            raise MaterialError(
                f"material {self.name!r}: its plies have fractions; give the plate's thickness"
            )
        return plate_stiffness([ply.stiffness for ply in stack], heights)

    def bending_error(self) -> float:
        """Relative error of the homogenised model's bending stiffness for one draped stack.

        Of ``h^2/12 A`` against ``D - B A^-1 B``, the stiffness of a plate that is free to stretch:
        the largest difference over the largest entry.  Zero for a single material and angle.
        """
        plate = self.abd(1.0)
        bending = plate.D - plate.B @ np.linalg.solve(plate.A, plate.B)
        return float(np.abs(plate.A / 12.0 - bending).max() / np.abs(bending).max())


@dataclass(frozen=True, eq=False)
class PlateStiffness:
    """Classical laminate theory: ``N = A e + B k``, ``M = B e + D k``.

    Attributes
    ----------
    A, B, D : (3, 3) float arrays
        Of the components 11, 22, 12 (engineering shear and twist) [N/m], [N], [N m], about the
        middle of the stack.
    """

    A: FloatArray
    B: FloatArray
    D: FloatArray


@dataclass(frozen=True)
class BeamStiffness:
    """A strip of a laminate as a beam along axis 1.

    Attributes
    ----------
    bending, torsion : float
        EI and GJ [N m2].
    coupling : float
        K [N m2]: ``M = EI k + K t``, ``T = K k + GJ t`` for curvature k and twist rate t.
    """

    bending: float
    torsion: float
    coupling: float


def reduced_stiffness(stiffness: FloatArray) -> FloatArray:
    """Plane-stress stiffness (3, 3) [Pa] for 11, 22, 12 from a stiffness (6, 6).

    ``C_pp - C_pq C_qq^-1 C_qp``, p in the plane and q out of it: no stress out of the plane.
    Jones, Mechanics of Composite Materials, 2nd ed., section 2.5.
    """
    pp, pq, qq = _blocks(stiffness)
    reduced: FloatArray = pp - pq @ np.linalg.solve(qq, pq.T)
    return reduced


def out_of_plane(stiffness: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Coupling ``R = C_pq C_qq^-1`` and compliance ``S = C_qq^-1`` [1/Pa], (3, 3) each.

    ``s_p = Q e_p + R s_q`` and ``e_q = S s_q - R^T e_p``, p in the plane and q out of it
    (theory: S1-43).
    """
    _, pq, qq = _blocks(stiffness)
    S = np.asarray(np.linalg.inv(qq), dtype=float)
    return np.asarray(pq @ S), S


def plate_stiffness(
    stiffnesses: Sequence[FloatArray], thicknesses: Sequence[float] | FloatArray
) -> PlateStiffness:
    """Matrices A, B, D of classical laminate theory (theory: S1-45).

    Parameters
    ----------
    stiffnesses : sequence of (6, 6) arrays
        Of the plies in the axes of the laminate [Pa], from the lower to the upper face.
    thicknesses : sequence of float
        Their thicknesses [m].
    """
    h = np.asarray(thicknesses, dtype=float)
    z = np.concatenate([[0.0], np.cumsum(h)]) - 0.5 * h.sum()
    Q = np.array([reduced_stiffness(C) for C in stiffnesses])
    A, B, D = (np.einsum("k,kij->ij", (z[1:] ** n - z[:-1] ** n) / n, Q) for n in (1, 2, 3))
    return PlateStiffness(A, B, D)


def effective_stiffness(
    stiffnesses: Sequence[FloatArray], shares: Sequence[float] | FloatArray
) -> FloatArray:
    """Stiffness of a solid of very many thin repeats of a stack (theory: S1-44).

    Strains in the plane and stresses out of it are the same in all plies; the others are averaged.
    Sun and Li, Three-dimensional effective elastic constants for thick laminates, J. Composite
    Materials 22 (1988) 629-639.  Exact for homogeneous averages; the order of the plies does not
    enter, so that the bending stiffness of few plies is not that of the stack.

    Parameters
    ----------
    stiffnesses : sequence of (6, 6) arrays
        Of the plies in the axes of the laminate [Pa].
    shares : sequence of float
        Their shares of the thickness; they sum to 1.

    Returns
    -------
    (6, 6) float array
        [Pa].
    """
    plane, coupling, compliance = np.zeros((3, 3)), np.zeros((3, 3)), np.zeros((3, 3))
    for share, C in zip(shares, stiffnesses, strict=True):
        R, S = out_of_plane(C)
        plane += share * reduced_stiffness(C)
        coupling += share * R
        compliance += share * S
    qq = np.linalg.inv(compliance)
    pq = coupling @ qq
    effective = np.zeros((6, 6))
    effective[np.ix_(IN_PLANE, IN_PLANE)] = plane + pq @ coupling.T
    effective[np.ix_(IN_PLANE, OUT_OF_PLANE)] = pq
    effective[np.ix_(OUT_OF_PLANE, IN_PLANE)] = pq.T
    effective[np.ix_(OUT_OF_PLANE, OUT_OF_PLANE)] = qq
    return 0.5 * (effective + effective.T)


def beam_stiffness(D: FloatArray, width: float) -> BeamStiffness:
    """Bending, torsion and coupling of a strip that is free to curve across (theory: S1-48).

    Parameters
    ----------
    D : (3, 3) float array
        Bending stiffness of the plate for 11, 22, 12 [N m].
    width : float
        Width of the strip [m], much larger than its thickness.

    Notes
    -----
    The chordwise moment is zero.  Weisshaar and Foist, Vibration tailoring of advanced composite
    lifting surfaces, J. Aircraft 22 (1985) 141-147.
    """
    (d11, d12, d16), (_, d22, d26), (_, _, d66) = D
    return BeamStiffness(
        bending=float(width * (d11 - d12**2 / d22)),
        torsion=float(4 * width * (d66 - d26**2 / d22)),
        coupling=float(2 * width * (d16 - d12 * d26 / d22)),
    )


def _blocks(stiffness: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    return (
        stiffness[np.ix_(IN_PLANE, IN_PLANE)],
        stiffness[np.ix_(IN_PLANE, OUT_OF_PLANE)],
        stiffness[np.ix_(OUT_OF_PLANE, OUT_OF_PLANE)],
    )
