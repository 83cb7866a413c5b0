# SPDX-License-Identifier: LGPL-2.1-or-later
"""The symmetric system (u, p, psi) of the vibrating blade in water, as affine terms (theory: S2-7).

Unknowns are those of the product space V * P * Q: displacement of order 2, film pressure of order
1 and velocity potential of order 2, with p = -i omega rho psi and exp(+i omega t).  Only the free
ones are kept: the solid's nodes away from the clamped root, the film's and the water's.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import ngsolve as ngs
import numpy as np
from scipy.sparse import coo_array, csr_matrix

from quietblade.errors import MeshError
from quietblade.materials.viscoelastic import ModulusRatio
from quietblade.mesh.boundaries import boundary, held_boundary
from quietblade.mesh.model import INTERFACE
from quietblade.typing import AnyArray, FloatArray, IntArray
from quietblade.vibroacoustics.fluid import (
    FLUID,
    Water,
    compressibility_matrix,
    coupling_matrix,
    kinetic_matrix,
    potential_space,
)
from quietblade.vibroacoustics.loss import Loss, loss_term, lossy_parts
from quietblade.vibroacoustics.pattern import CommonPattern
from quietblade.vibroacoustics.radiation import (
    Bgt1,
    RadiationCondition,
    check_sphere,
    static_exterior,
)

SOLID = "blade|film|body"
FILM = "film"
CLAMPED = "root"
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Blocks:
    """Positions of displacement, film pressure and potential among the unknowns.

    Behind them are the auxiliary unknowns of the radiation condition, h = Y^T psi (theory: S2-44),
    and those that a moving root (theory: S2-74) and a stream (theory: S2-72) add.

    Attributes
    ----------
    u, p, psi, harmonics : int arrays
        Displacement, film pressure, potential, h.
    root, reaction : int arrays
        Sums and differences of the six rigid motions of the root and of what holds it.
    strips : int array
        Motion that the stream damps, one a strip.
    """

    u: IntArray
    p: IntArray
    psi: IntArray
    harmonics: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    root: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    reaction: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    strips: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))

    @property
    def water(self) -> IntArray:
        """Potential and harmonics: what belongs to the water."""
        return np.concatenate([self.psi, self.harmonics])

    @property
    def held(self) -> IntArray:
        """Motion of the root and its reaction."""
        return np.concatenate([self.root, self.reaction])

    @property
    def solid(self) -> IntArray:
        """Everything that does not belong to the water."""
        return np.concatenate([self.u, self.p, self.held, self.strips])


@dataclass(frozen=True)
class Operators:
    """A(omega) = K + sum_r (g_r - 1) D_r - omega^2 M + i omega C - H + omega^2 G + radiation.

    For first-order BGT the radiation is -(i omega + c/R) Q.  A term of low rank,
    g Y Y^T on psi, enters with the unknowns h = Y^T psi as g [[0, Y], [Y^T, -1]] on (psi, h):
    eliminating h gives it back, energies x^H A x are the same, and A(omega) stays sparse and
    symmetric (theory: S2-44).

    Attributes
    ----------
    terms : mapping of name to (n, n) csr_matrix
        Real symmetric matrices on the unknowns: stiffness K (tangent), D of each lossy region
        (`loss_term`), mass M, both coupling blocks C, and of the water H and G (positive), and
        those of the radiation condition (Q, ...).
    blocks : Blocks
        Where u, p, psi and h are among the unknowns.
    free : (n - m,) int array
        Numbers in V * P * Q, uncompressed, of all unknowns but the m last, h.
    first_potential : int
        Number of the first potential unknown in V * P * Q.
    sound_speed, density : float
        c [m/s] and rho [kg/m3] of the water.
    radius : float
        R of the outer sphere [m].
    condition : RadiationCondition
        What is required on the sphere.
    moduli : mapping of name to ModulusRatio
        g of each lossy region.  A viscous part, which has i omega D, is one with g = 1 + i omega.
    exterior : (n, n) csr_matrix or None
        Static exterior of the sphere, which real wet modes add to H; not a part of A(omega).
    center : (3,) array
        Centre of the outer sphere [m].
    """

    terms: Mapping[str, csr_matrix]
    blocks: Blocks
    free: IntArray
    first_potential: int
    sound_speed: float
    density: float
    radius: float
    condition: RadiationCondition = field(default_factory=Bgt1)
    moduli: Mapping[str, ModulusRatio] = field(default_factory=dict)
    exterior: csr_matrix | None = None
    center: FloatArray = field(default_factory=lambda: np.zeros(3))

    @property
    def size(self) -> int:
        """Number of unknowns n, the auxiliary ones included."""
        return int(self.terms["K"].shape[0])

    @cached_property
    def pattern(self) -> CommonPattern:
        """One sparsity pattern for all terms."""
        return CommonPattern.of(self.terms)

    def factors(self, omega: complex) -> dict[str, complex]:
        """Factor of each term at an angular frequency [rad/s]."""
        return {
            "K": 1.0,
            **{loss_term(region): ratio(omega) - 1.0 for region, ratio in self.moduli.items()},
            "M": -(omega**2),
            "C": 1.0j * omega,
            "H": -1.0,
            "G": omega**2,
            **self.condition.factors(omega, self.sound_speed, self.radius),
        }

    def stiffness(self, omega: float = 0.0) -> csr_matrix:
        """Storage stiffness K + sum_r (Re g_r - 1) D_r at an angular frequency [rad/s]."""
        parts = [
            (complex(ratio(omega)).real - 1.0) * self.terms[loss_term(region)]
            for region, ratio in self.moduli.items()
        ]
        return csr_matrix(sum(parts, start=self.terms["K"]))

    def loss(self, omega: float) -> csr_matrix:
        """Loss stiffness L = sum_r Im g_r D_r at an angular frequency [rad/s]."""
        parts = [
            complex(ratio(omega)).imag * self.terms[loss_term(region)]
            for region, ratio in self.moduli.items()
        ]
        return csr_matrix(sum(parts, start=csr_matrix(self.terms["K"].shape)))

    def at(self, omega: complex) -> csr_matrix:
        """A(omega), complex symmetric, always on the same pattern (theory: S2-7)."""
        return self.pattern.combine(self.factors(omega))

    def right_hand_side(self, force: AnyArray) -> AnyArray:
        """Free part of a force on the structure.

        Parameters
        ----------
        force : (m,) or (m, k) array
            Forces on the unknowns of V, in full numbering; m is at least ``V.ndof``.

        Returns
        -------
        (n,) or (n, k) array
        """
        rhs = np.zeros((self.size, *force.shape[1:]), dtype=force.dtype)
        rhs[self.blocks.u] = force[self.free[self.blocks.u]]
        return rhs


def product_space(fem: ngs.Mesh) -> ngs.ProductSpace:
    """V * P * Q of displacement, film pressure and potential, uncompressed."""
    displacement = ngs.VectorH1(fem, order=2)
    pressure = ngs.H1(fem, order=1, definedon=FILM)
    return displacement * pressure * potential_space(fem)


def free_unknowns(fem: ngs.Mesh, clamped: str | None = CLAMPED) -> tuple[IntArray, Blocks]:
    """Numbers of the free unknowns in V * P * Q, and where each field is among them.

    Parameters
    ----------
    fem : ngsolve.Mesh
    clamped : str or None
        Name pattern of the faces that do not move; None if all do.

    Raises
    ------
    MeshError
        If the mesh has no solid, no water or no face of a name in ``clamped``.
    """
    space = product_space(fem)
    displacement, pressure, potential = space.components
    moving = _dofs(displacement, fem.Materials(SOLID))
    if clamped is not None:
        moving &= ~_dofs(displacement, held_boundary(fem, clamped))
    squeezed = _dofs(pressure, fem.Materials(FILM))
    wet = _dofs(potential, fem.Materials(FLUID))
    for name, mask in ((SOLID, moving), (FLUID, wet)):
        if not mask.any():
            raise MeshError(
                f"no free unknown in the material {name!r}; "
                f"the mesh has {sorted(set(fem.GetMaterials()))}"
            )
    free = np.flatnonzero(np.concatenate([moving, squeezed, wet]))
    n_u, n_p = np.count_nonzero(moving), np.count_nonzero(squeezed)
    u, p, psi = np.split(np.arange(len(free)), [n_u, n_u + n_p])
    return free, Blocks(u, p, psi)


def build_operators(
    fem: ngs.Mesh,
    *,
    stiffness: csr_matrix,
    mass: csr_matrix,
    loss: Loss = None,
    water: Water,
    radius: float,
    motion: ngs.GridFunction | None = None,
    clamped: str | None = CLAMPED,
    wetted: str = INTERFACE,
    outer: str = "outer",
    condition: RadiationCondition | None = None,
) -> Operators:
    """Assemble the water's matrices and put them beside the structure's.

    Parameters
    ----------
    fem : ngsolve.Mesh
        Materials "blade", "film" (may be absent) and "water".
    stiffness, mass : csr_matrix
        K (tangent) and M of the structure in the full numbering of V * P, or of V if there is no
        film pressure; mass is that of C0.
    loss : csr_matrix, mapping of name to csr_matrix or Lossy, or None
        Lossy regions, numbered likewise: a `Lossy`, or L with a constant loss factor included.
        One matrix without a name is the region "all".
    water : Water
        Density and sound speed.
    radius : float
        R of the outer sphere [m].
    motion : ngsolve.GridFunction or None
        Displacement of the whole mesh, ``VectorH1(order=2)``, from C0 to C1 [m]: water and
        coupling are then integrated on C1.  It vanishes on the sphere.
    clamped : str or None
        Name pattern of the faces that do not move; None where springs in the stiffness hold the
        structure.
    wetted, outer : str
        Name patterns of the moving wetted surface and of the sphere.
    condition : RadiationCondition or None
        None takes first-order BGT.

    Raises
    ------
    MeshError
        If a region is missing, the outer boundary is not the sphere, or it moves.
    """
    condition = Bgt1() if condition is None else condition
    center = check_sphere(fem, radius, outer)
    if motion is not None:
        _check_still(fem, motion, outer, radius)
    free, blocks = free_unknowns(fem, clamped)
    space = product_space(fem)
    loads = condition.loads(fem, water, outer, radius)
    blocks = replace(
        blocks,
        harmonics=len(free) + np.arange(sum(load.shape[1] for load in loads.values())),
    )
    place = _Placement(space.ndof, free, len(blocks.harmonics))
    first_psi = space.Range(2).start
    sizes = (space.Range(1).start, first_psi)
    losses = lossy_parts(loss)
    coupling = place(coupling_matrix(fem, water, wetted, motion), columns=first_psi)
    fluid = {
        "H": kinetic_matrix(fem, water, motion),
        "G": compressibility_matrix(fem, water, motion),
        **condition.matrices(fem, water, outer),
    }
    terms = {
        "K": place(_symmetric("K", stiffness, sizes)),
        **{
            loss_term(name): place(_symmetric(f"loss {name}", part.matrix, sizes))
            for name, part in losses.items()
        },
        "M": place(_symmetric("M", mass, sizes)),
        "C": csr_matrix(coupling + coupling.T),
        **{
            name: place(_symmetric(name, part), first_psi, first_psi)
            for name, part in fluid.items()
        },
        **place.borders(loads, first_psi),
    }
    if loads:
        at_rest = condition.factors(0.0, water.sound_speed, radius)
        parts = [-complex(factor).real * terms[name] for name, factor in at_rest.items()]
        exterior = csr_matrix(sum(parts[1:], start=parts[0]))
    else:
        static = _symmetric("E", static_exterior(fem, water, radius, outer))
        exterior = place(static, first_psi, first_psi)
    return Operators(
        terms,
        blocks,
        free,
        first_psi,
        water.sound_speed,
        water.density,
        radius,
        condition,
        {name: part.ratio for name, part in losses.items()},
        exterior,
        center,
    )


@dataclass(frozen=True)
class _Placement:
    """Puts a block of the full numbering into the matrix of the unknowns."""

    full: int
    free: IntArray
    harmonics: int

    @property
    def size(self) -> int:
        return len(self.free) + self.harmonics

    @cached_property
    def position(self) -> IntArray:
        position = np.full(self.full, -1, dtype=np.int64)
        position[self.free] = np.arange(len(self.free))
        return position

    def __call__(self, matrix: csr_matrix, rows: int = 0, columns: int = 0) -> csr_matrix:
        """Free part of a block whose first entry is at (rows, columns)."""
        entries = coo_array(matrix)
        row, column = self.position[entries.row + rows], self.position[entries.col + columns]
        # Forms on a product space store zeros between fields that do not meet.
        kept = (row >= 0) & (column >= 0) & (entries.data != 0.0)
        shape = (self.size, self.size)
        return csr_matrix((entries.data[kept], (row[kept], column[kept])), shape=shape)

    def borders(self, loads: Mapping[str, csr_matrix], rows: int) -> dict[str, csr_matrix]:
        """[[0, Y], [Y^T, -1]] of each Y, whose first row is at ``rows``, on unknowns of its own."""
        terms, first = {}, len(self.free)
        for name, load in loads.items():
            entries = coo_array(load)
            row = self.position[entries.row + rows]
            kept = (row >= 0) & (entries.data != 0.0)
            row, column, value = row[kept], first + entries.col[kept], entries.data[kept]
            own = first + np.arange(load.shape[1])
            places = np.concatenate([row, column, own]), np.concatenate([column, row, own])
            values = np.concatenate([value, value, -np.ones(len(own))])
            terms[name] = csr_matrix((values, places), shape=(self.size, self.size))
            first += load.shape[1]
        return terms


def _symmetric(name: str, matrix: csr_matrix, sizes: tuple[int, ...] | None = None) -> csr_matrix:
    """Exactly symmetric copy of a matrix that is symmetric up to rounding."""
    if sizes is not None and matrix.shape not in [(size, size) for size in sizes]:
        raise ValueError(
            f"matrix {name!r} has shape {matrix.shape}; the displacement has {sizes[0]} unknowns, "
            f"with the film pressure {sizes[1]}, the fixed ones included"
        )
    scale = abs(matrix).max() if matrix.nnz else 0.0
    asymmetry = abs(matrix - matrix.T).max() if matrix.nnz else 0.0
    if asymmetry > _ROUNDING * scale:
        raise ValueError(
            f"matrix {name!r} is not symmetric: largest difference {asymmetry:.3g} beside entries "
            f"of {scale:.3g}; give its symmetric part"
        )
    return csr_matrix(0.5 * (matrix + matrix.T))


def _dofs(space: ngs.FESpace, region: ngs.Region) -> AnyArray:
    return np.array(space.GetDofs(region), dtype=bool)


def _check_still(fem: ngs.Mesh, motion: ngs.GridFunction, outer: str, radius: float) -> None:
    surface = ngs.ds(definedon=boundary(fem, outer))
    squared = ngs.Integrate(ngs.InnerProduct(motion, motion) * surface, fem)
    mean = float(np.sqrt(squared / (4.0 * np.pi))) / radius
    if mean > 1e-9 * radius:
        raise MeshError(
            f"the outer sphere moves by {mean:.3g} m (mean) between C0 and C1; "
            "the mesh motion must vanish on it"
        )
