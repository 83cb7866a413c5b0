# SPDX-License-Identifier: LGPL-2.1-or-later
"""Damping by the stream around the blade, strip by strip (theory: S2-72).

In the limit of high reduced frequency each strip of the blade loses the power of a dashpot
pi rho W b per span on the normal velocity at three quarters of its chord
(`flow.unsteady.damping_per_length`).  The added mass, which has no share of the stream, is in the
water's own equations already.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import coo_array, csr_matrix, diags_array, hstack

from quietblade.errors import Notice
from quietblade.flow.unsteady import SLOWEST, WHERE, damping_per_length
from quietblade.mesh.nodal import NodalBasis
from quietblade.typing import AnyArray, FloatArray
from quietblade.vibroacoustics.borders import bordered
from quietblade.vibroacoustics.loss import STREAM, Viscous
from quietblade.vibroacoustics.modes import WetModes, unknowns
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.point_loads import evaluation_matrix

_LEAST_NODES = 4


@dataclass(frozen=True, eq=False)
class Strips:
    """Sections of the blade in a stream, from root to tip, in the configuration that vibrates.

    Attributes
    ----------
    span : (k,) array
        Place of each section on the coordinate that the nodes have too, such as span fraction.
    length : (k,) array
        Distance along the span of each section from the first [m].
    middle : (k, 3) array
        Mid-chord points [m].
    chordwise, normal : (k, 3) arrays
        Unit vectors from nose to trailing edge, and to the upper side.
    chord, speed : (k,) arrays
        [m], and of the stream normal to the span [m/s].
    """

    span: FloatArray
    length: FloatArray
    middle: FloatArray
    chordwise: FloatArray
    normal: FloatArray
    chord: FloatArray
    speed: FloatArray

    @property
    def width(self) -> FloatArray:
        """Share of each section in the span (k,) [m], the integrals of its hat function."""
        step = np.diff(self.length)
        return np.asarray(0.5 * (np.append(step, 0.0) + np.append(0.0, step)))


def strip_motion(
    strips: Strips, points: FloatArray, span: FloatArray, areas: FloatArray
) -> csr_matrix:
    """Weights of nodal displacements in the normal motion at 3/4 chord of each strip.

    Heave and pitch of a strip are those of the rigid motion nearest to the normal displacements of
    its wetted nodes: least squares weighted with their areas and the strip's hat function of the
    span.

    Parameters
    ----------
    strips : Strips
    points : (N, 3) array
        Nodes in the same configuration [m].
    span : (N,) array
        Their place on the strips' coordinate of the span.
    areas : (N,) array
        Share of each node in the wetted surface [m2], zero off it.

    Returns
    -------
    (k, 3 N) csr_matrix
        On the x components of all nodes, then y, then z.

    Raises
    ------
    ValueError
        If a strip has too few nodes.
    """
    rows, columns, values = [], [], []
    order = np.arange(len(strips.span))
    for i in order:
        hat = np.interp(span, strips.span, (order == i).astype(float))
        weight = areas * hat
        own = np.flatnonzero(weight > 0.0)
        arm = (points[own] - strips.middle[i]) @ strips.chordwise[i]
        shapes = np.stack([np.ones(len(own)), arm / strips.chord[i]], axis=1)
        normal = shapes.T @ (weight[own, None] * shapes)
        if len(own) < _LEAST_NODES or np.linalg.cond(normal) > 1e8:
            raise ValueError(
                f"strip {i} of {len(order)} at {strips.span[i]:.4g} of the span has too few nodes "
                f"({len(own)}); take wider strips"
            )
        at = np.array([1.0, WHERE - 0.5])  # heave and pitch of mid-chord
        reading = weight[own] * (shapes @ np.linalg.solve(normal, at))
        for axis in range(3):
            rows.append(np.full(len(own), i))
            columns.append(own + axis * len(points))
            values.append(reading * strips.normal[i, axis])
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    return csr_matrix(coo_array(entries, shape=(len(order), 3 * len(points))))


def add_stream(
    operators: Operators, basis: NodalBasis, strips: Strips, motion: csr_matrix, density: float
) -> Operators:
    """Let a stream damp the blade: the lossy part "stream" of the operators.

    Parameters
    ----------
    operators : Operators
    basis : NodalBasis
        Nodes of the mesh.
    strips : Strips
    motion : (k, 3 N) csr_matrix
        `strip_motion`.
    density : float
        Of the water [kg/m3].

    Returns
    -------
    Operators
        With one unknown more for each strip, ``blocks.strips``, so that A(omega) stays sparse:
        i omega Y Y^T becomes i omega [[0, Y], [Y^T, -1]].

    Raises
    ------
    ValueError
        If there is a stream already.
    """
    blocks = operators.blocks
    if len(blocks.strips):
        raise ValueError("the operators have a stream already")
    damping = damping_per_length(strips.chord, strips.speed, density) * strips.width
    # nodal values of the unknowns: transposed, forces on the unknowns
    load = diags_array(np.sqrt(damping)) @ _on_unknowns(basis, motion)
    n, k = operators.size, len(damping)
    Y = coo_array(csr_matrix(load)[:, operators.free[blocks.u]])
    own = n + np.arange(k)
    rows, columns = blocks.u[Y.col], own[Y.row]
    places = np.concatenate([rows, columns, own]), np.concatenate([columns, rows, own])
    values = np.concatenate([Y.data, Y.data, -np.ones(k)])
    matrix = csr_matrix((values, places), shape=(n + k, n + k))
    return bordered(operators, replace(blocks, strips=own), {}, {STREAM: (matrix, Viscous())})


def stream_loss(operators: Operators, modes: WetModes) -> FloatArray:
    """Loss factor that the stream adds to real modes, (m,) (theory: S2-73).

    omega sum d_i |a_i|^2 over x^T K x, with the motion a_i of the strips.
    """
    omega = 2.0 * np.pi * np.abs(modes.frequency)
    lost = np.sum(np.abs(unknowns(modes, operators)[:, operators.blocks.strips]) ** 2, axis=1)
    return np.asarray(np.divide(lost, omega, out=np.full(len(omega), np.nan), where=omega > 0.0))


def stream_notices(strips: Strips, frequency: AnyArray) -> tuple[Notice, ...]:
    """Notice where the stream is too fast for the limit of high reduced frequency.

    Parameters
    ----------
    strips : Strips
    frequency : (m,) array
        Frequencies that matter [Hz]; the lowest one decides.
    """
    if np.size(frequency) == 0:
        return ()
    omega = 2.0 * np.pi * float(np.min(frequency))
    reduced = omega * 0.5 * strips.chord / np.maximum(strips.speed, np.finfo(float).tiny)
    least = int(np.argmin(reduced))
    if reduced[least] >= SLOWEST:
        return ()
    return (
        Notice(
            f"stream at {strips.span[least]:.3g} of the span",
            "reduced frequency omega b / W is low: Theodorsen's function is not one half there",
            float(reduced[least]),
            SLOWEST,
            "Take the flow's damping as an estimate below that frequency.",
        ),
    )


def _on_unknowns(basis: NodalBasis, motion: csr_matrix) -> csr_matrix:
    """Linear functionals (k, 3 N) of nodal values as functionals (k, 3 ndof) of the unknowns."""
    n = len(basis.points)
    values = evaluation_matrix(basis)
    parts = [motion[:, axis * n : (axis + 1) * n] @ values for axis in range(3)]
    return csr_matrix(hstack(parts))
