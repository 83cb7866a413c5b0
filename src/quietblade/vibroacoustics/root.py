# SPDX-License-Identifier: LGPL-2.1-or-later
"""A root that moves as a rigid body: base motion, reactions, and a shaft (theory: S2-74).

The clamped nodes move by u = R q with six rigid motions q: displacement and rotation about a point.
What holds the root is a multiplier: the constraint s (q - q0) = 0 belongs to the unknowns lambda,
and the force and moment on the blade are -s lambda.  Prescribed motion is then a load that does not
depend on frequency, and every solver, sweep and power works as before.  In the system stand
a = (q + lambda)/sqrt 2 and b = (q - lambda)/sqrt 2 instead: their diagonal is +s and -s, where
lambda would have a zero that no solver with a fixed order of pivots gets past.
"""

from dataclasses import dataclass, replace

import ngsolve as ngs
import numpy as np
from scipy.sparse import coo_array, csr_matrix

from quietblade.mesh.boundaries import held_boundary
from quietblade.mesh.model import INTERFACE
from quietblade.mesh.nodal import NodalBasis
from quietblade.typing import AnyArray, ComplexArray, FloatArray
from quietblade.vibroacoustics.borders import bordered
from quietblade.vibroacoustics.fluid import Water, coupling_matrix
from quietblade.vibroacoustics.loss import Loss, Viscous, loss_term, lossy_parts
from quietblade.vibroacoustics.operators import CLAMPED, Operators

SHAFT = "shaft"
"""Name of the lossy part that a shaft makes."""

_TURN = np.kron([[1.0, 1.0], [1.0, -1.0]], np.eye(6)) / np.sqrt(2.0)
"""From (q, lambda) to (a, b), and back."""


@dataclass(frozen=True, eq=False)
class RootedSystem:
    """A blade whose root can be moved.

    Attributes
    ----------
    operators : Operators
        With the unknowns ``blocks.root`` (a) and ``blocks.reaction`` (b) behind the others.
    rigid : (V.ndof, 6) array
        R: displacement unknowns of the root for translations along x, y, z [1] and rotations about
        x, y, z [m], about ``about``.
    about : (3,) array
        Point of reference of rotations and moments [m].
    scale : (6,) array
        s [N/m, N m].
    """

    operators: Operators
    rigid: FloatArray
    about: FloatArray
    scale: FloatArray

    def right_hand_side(self, force: AnyArray) -> AnyArray:
        """Load (n,) or (n, k) of forces (V.ndof,) or (V.ndof, k); those on the root count too."""
        load = self.operators.right_hand_side(force)
        share = self.rigid.T @ force[: len(self.rigid)]
        load[self.operators.blocks.held] = np.tensordot(_TURN[:, :6], share, 1)
        return load

    def base_motion(self, motion: AnyArray) -> AnyArray:
        """Load of prescribed motions of the root.

        Parameters
        ----------
        motion : (6,) or (k, 6) array
            Amplitudes of translation [m] and rotation [rad].

        Returns
        -------
        (n,) or (k, n) array
        """
        motion = np.asarray(motion)
        load = np.zeros((*motion.shape[:-1], self.operators.size), dtype=motion.dtype)
        load[..., self.operators.blocks.held] = (self.scale * motion) @ _TURN[6:]
        return load

    def reaction(self, response: ComplexArray) -> ComplexArray:
        """Force [N] and moment [N m] that hold the root, on the blade, (..., 6).

        Minus it is what the blade does to its support: the blocked force, if the root is at rest.
        """
        return self.held_reaction(response[..., self.operators.blocks.held])

    def held_reaction(self, held: ComplexArray) -> ComplexArray:
        """Force and moment (..., 6) from the twelve unknowns of the root alone, (..., 12)."""
        return np.asarray(-self.scale * (held @ _TURN[:, 6:]))

    def motion(self, response: ComplexArray) -> ComplexArray:
        """Read the translation [m] and rotation [rad] of the root, (..., 6)."""
        return np.asarray(response[..., self.operators.blocks.held] @ _TURN[:, :6])

    @property
    def carried(self) -> csr_matrix:
        """Displacement unknowns of the root (V.ndof, n) from all unknowns."""
        return _carried(self.rigid @ _TURN[:6], self.operators)


def add_root(
    operators: Operators,
    fem: ngs.Mesh,
    basis: NodalBasis,
    *,
    stiffness: csr_matrix,
    mass: csr_matrix,
    loss: Loss = None,
    water: Water | None = None,
    about: FloatArray | None = None,
    motion: ngs.GridFunction | None = None,
    wetted: str = INTERFACE,
    wet_root: bool = True,
    root: str = CLAMPED,
) -> RootedSystem:
    """Let the clamped root of a system move.

    Parameters
    ----------
    operators : Operators
        The system with a clamped root, in water or in vacuo.
    fem : ngsolve.Mesh
    basis : NodalBasis
        Nodes of the mesh.
    stiffness, mass, loss
        What the operators were made from, in full numbering.
    water : Water or None
        That of the operators; None in vacuo.
    about : (3,) array or None
        Point of reference of rotations and moments [m]; the origin by default.
    motion : ngsolve.GridFunction or None
        Displacement from C0 to C1 [m] that the operators have.
    wetted : str
        Name pattern of the moving wetted surface.
    wet_root : bool
        Whether the root's face pushes water, as it does where it is a face of the water's mesh.
    root : str
        Name pattern of the clamped boundaries.

    Raises
    ------
    MeshError
        If no face of the mesh has a name in ``root``.
    ValueError
        If a stream has been added already, or the lossy regions are not those of the operators.
    """
    blocks = operators.blocks
    parts = lossy_parts(loss)
    if len(blocks.strips) or len(blocks.root):
        raise ValueError("the root comes before the stream, and once")
    if set(parts) != set(operators.moduli):
        raise ValueError(
            f"lossy regions {sorted(parts)} are given, the operators have "
            f"{sorted(operators.moduli)}"
        )
    centre = np.zeros(3) if about is None else np.asarray(about, dtype=float)
    rigid = _rigid_motions(fem, basis, root, centre, motion)
    full = np.zeros((stiffness.shape[0], 6))
    full[: len(rigid)] = rigid
    # u and p rows; in vacuo and in water alike they come first
    rows = np.concatenate([blocks.u, blocks.p])
    columns: dict[str, tuple[FloatArray, FloatArray]] = {}
    matrices = {"K": stiffness, "M": mass}
    matrices |= {loss_term(region): part.matrix for region, part in parts.items()}
    for name, matrix in matrices.items():
        # the mean with the transpose, as in the operators
        product = 0.5 * np.asarray(matrix @ full + matrix.T @ full)
        side = np.zeros((operators.size, 6))
        side[rows] = product[operators.free[rows]]
        columns[name] = side, full.T @ product
    if water is not None:
        faces = f"{wetted}|{root}" if wet_root else wetted
        flux = np.asarray(coupling_matrix(fem, water, faces, motion).T @ rigid)
        side = np.zeros((operators.size, 6))
        side[blocks.psi] = flux[operators.free[blocks.psi] - operators.first_potential]
        columns["C"] = side, np.zeros((6, 6))
    scale = np.abs(np.diag(columns["K"][1]))
    own = operators.size + np.arange(6)
    grown = bordered(
        operators,
        replace(blocks, root=own, reaction=own + 6),
        {
            name: _border(side, corner, scale if name == "K" else np.zeros(6))
            for name, (side, corner) in columns.items()
        },
    )
    return RootedSystem(grown, rigid, centre, scale)


@dataclass(frozen=True, eq=False)
class ShaftSystem:
    """A blade on an elastic shaft.

    Attributes
    ----------
    operators : Operators
        With the motion of the root, ``blocks.root``, and the lossy part "shaft".
    rigid, about
        As in `RootedSystem`.
    """

    operators: Operators
    rigid: FloatArray
    about: FloatArray

    def right_hand_side(self, force: AnyArray) -> AnyArray:
        """Load (n,) or (n, k) of forces (V.ndof,) or (V.ndof, k); those on the root count too."""
        load = self.operators.right_hand_side(force)
        load[self.operators.blocks.root] = self.rigid.T @ force[: len(self.rigid)]
        return load

    def motion(self, response: ComplexArray) -> ComplexArray:
        """Read the translation [m] and rotation [rad] of the root, (..., 6)."""
        return np.asarray(response[..., self.operators.blocks.root])

    @property
    def carried(self) -> csr_matrix:
        """Displacement unknowns of the root (V.ndof, n) from all unknowns."""
        return _carried(self.rigid, self.operators)


def elastic_shaft(
    system: RootedSystem, stiffness: AnyArray, damping: AnyArray, mass: AnyArray
) -> ShaftSystem:
    """Put the blade on a shaft whose end has the impedance C + i (omega M - K / omega).

    The power into it is the lossy part "shaft" of the balance.

    Parameters
    ----------
    system : RootedSystem
    stiffness, damping, mass : (6, 6) or (6,) arrays
        K, C and M, symmetric; of translation and rotation about ``system.about``; (6,) is a
        diagonal.
    """
    held = system.operators
    n = held.size - 12
    own = n + np.arange(6)
    # lambda = 0: a = b = q / sqrt 2
    share = np.full(6, np.sqrt(0.5))
    places = np.concatenate([np.arange(n), own, own + 6]), np.concatenate([np.arange(n), own, own])
    values = np.concatenate([np.ones(n), share, share])
    onto = csr_matrix((values, places), shape=(n + 12, n + 6))
    exterior = held.exterior
    free = replace(
        held,
        terms={name: csr_matrix(onto.T @ term @ onto) for name, term in held.terms.items()},
        blocks=replace(held.blocks, root=own, reaction=own[:0]),
        exterior=None if exterior is None else csr_matrix(onto.T @ exterior @ onto),
    )
    K, C, M = (_placed(n, part) for part in (stiffness, damping, mass))
    operators = bordered(free, free.blocks, {"K": K, "M": M}, {SHAFT: (C, Viscous())})
    return ShaftSystem(operators, system.rigid, system.about)


def _carried(motion: FloatArray, operators: Operators) -> csr_matrix:
    """Put displacement unknowns of the held ones into the columns of all."""
    entries, held = coo_array(motion), operators.blocks.held
    shape = (len(motion), operators.size)
    return csr_matrix((entries.data, (entries.row, held[entries.col])), shape=shape)


def _placed(n: int, part: AnyArray) -> csr_matrix:
    """Put a symmetric (6, 6) matrix behind n unknowns."""
    block = _symmetric(part)
    rows, columns = (at.ravel() for at in np.meshgrid(*2 * [n + np.arange(6)], indexing="ij"))
    return csr_matrix((block.ravel(), (rows, columns)), shape=(n + 6, n + 6))


def _symmetric(part: AnyArray) -> FloatArray:
    block = np.asarray(part, dtype=float)
    block = np.diag(block) if block.ndim == 1 else block
    if block.shape != (6, 6) or np.abs(block - block.T).max() > 1e-12 * np.abs(block).max():
        raise ValueError("a shaft's stiffness, damping and mass must be symmetric (6, 6) or (6,)")
    return block


def _rigid_motions(
    fem: ngs.Mesh, basis: NodalBasis, root: str, about: FloatArray, motion: ngs.GridFunction | None
) -> FloatArray:
    """Displacement unknowns (V.ndof, 6) of the root's nodes, all others zero."""
    space = ngs.VectorH1(fem, order=2)
    points = basis.points
    if motion is not None:
        points = points + basis.to_values(np.array(motion.vec))
    arm, columns = points - about, []
    for axis in np.eye(3):
        columns.append(basis.to_dofs(np.tile(axis, (len(points), 1))))
    for axis in np.eye(3):
        columns.append(basis.to_dofs(np.cross(axis, arm)))
    clamped = np.array(space.GetDofs(held_boundary(fem, root)), dtype=bool)
    return np.where(clamped[:, None], np.stack(columns, axis=1), 0.0)


def _border(side: FloatArray, corner: FloatArray, hold: FloatArray) -> csr_matrix:
    """Matrix of 2 x^T side q + q^T corner q + 2 sum hold q lambda on x, a and b."""
    n = len(side)
    block = np.block([[corner, np.diag(hold)], [np.diag(hold), np.zeros((6, 6))]])
    block = _TURN @ block @ _TURN
    edge = coo_array(side @ _TURN[:6])
    rows, columns = (part.ravel() for part in np.meshgrid(*2 * [n + np.arange(12)], indexing="ij"))
    places = (
        np.concatenate([edge.row, n + edge.col, rows]),
        np.concatenate([n + edge.col, edge.row, columns]),
    )
    values = np.concatenate([edge.data, edge.data, block.ravel()])
    return csr_matrix((values, places), shape=(n + 12, n + 12))
