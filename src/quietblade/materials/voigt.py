# SPDX-License-Identifier: LGPL-2.1-or-later
"""Strains and stiffnesses as six components: 11, 22, 33, 23, 13, 12, shear strains engineering."""

import ngsolve as ngs
import numpy as np

from quietblade.typing import FloatArray

PAIRS = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))
"""Indices of the tensor for each of the six components."""


def strain_components(E: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
    """Six components of a symmetric strain field; ``2 E_ij`` for the shears."""
    return ngs.CF(tuple(E[i, j] if i == j else E[i, j] + E[j, i] for i, j in PAIRS))


def strain_transformation(axes: FloatArray) -> FloatArray:
    """Matrix T of ``e' = T e`` for ``E' = A^T E A`` (theory: S1-42).

    Parameters
    ----------
    axes : (3, 3) float array
        Its columns are the new axes in the old ones.

    Returns
    -------
    (6, 6) float array
    """
    A = np.asarray(axes, dtype=float)
    columns = []
    for i, j in PAIRS:
        unit = np.zeros((3, 3))
        unit[i, j] += 0.5
        unit[j, i] += 0.5
        turned = A.T @ unit @ A
        columns.append([turned[p, q] * (1.0 if p == q else 2.0) for p, q in PAIRS])
    return np.array(columns).T


def turned_stiffness(stiffness: FloatArray, axes: FloatArray) -> FloatArray:
    """Stiffness in the blade frame of a solid with given stiffness in its own axes.

    Parameters
    ----------
    stiffness : (6, 6) float array
        [Pa], in the material axes.
    axes : (3, 3) float array
        Its columns are the material axes.

    Returns
    -------
    (6, 6) float array
        ``T^T C T`` [Pa] (theory: S1-42).
    """
    T = strain_transformation(axes)
    turned: FloatArray = T.T @ stiffness @ T
    return turned


def in_plane_rotation(angle: float) -> FloatArray:
    """Axes (3, 3) of a ply in those of the laminate (span, chordwise, thickness).

    Parameters
    ----------
    angle : float
        [rad], from axis 1 towards axis 2, about axis 3.
    """
    c, s = float(np.cos(angle)), float(np.sin(angle))
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
