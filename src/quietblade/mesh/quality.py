# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shape figures of cells; inverted cells are refused."""

from collections.abc import Mapping

import gmsh
import numpy as np

from quietblade.errors import InvertedCellError, Notice
from quietblade.mesh.model import Quality
from quietblade.typing import FloatArray, IntArray

TETRA_EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
"""Corners of the mid-edge nodes 4 to 9 of a second-order tetrahedron, VTK node order."""

POOR_SHAPE = 1e-3
"""Signed inverse condition number below which a notice is given."""

POOR_JACOBIAN = 0.05
"""Ratio of least to mean Jacobian below which a notice is given."""


def region_quality(name: str, volume: int, position: FloatArray) -> Quality:
    """Quality of one volume of the current gmsh model.

    Parameters
    ----------
    name : str
        Region, for the message.
    volume : int
        gmsh tag.
    position : (n, 3) float array
        Node positions by gmsh tag [m].

    Raises
    ------
    InvertedCellError
        A Jacobian determinant is not positive at a quadrature point.
    """
    shape, ratio = [], []
    mesh = gmsh.model.mesh
    for kind, elements, nodes in zip(*mesh.getElements(3, volume), strict=True):
        points, _ = mesh.getIntegrationPoints(kind, "Gauss4")
        _, determinants, _ = mesh.getJacobians(kind, points, volume)
        det = determinants.reshape(len(elements), -1)
        _refuse_inverted(name, det, nodes.reshape(len(elements), -1).astype(np.int64), position)
        ratio.append(det.min(axis=1) / det.mean(axis=1))
        shape.append(mesh.getElementQualities(elements, "minSICN"))
    shapes = np.concatenate(shape)
    return Quality(float(shapes.min()), float(shapes.mean()), float(np.concatenate(ratio).min()))


def tetrahedron_jacobians(nodes: FloatArray, connectivity: IntArray) -> FloatArray:
    """Jacobian determinants of ten-node tetrahedra at four Gauss points and the four corners.

    Parameters
    ----------
    nodes : (n, 3) float array
        Node positions [m].
    connectivity : (m, 10) int array
        VTK node order.

    Returns
    -------
    (m, 8) float array
        Six times the local volume [m^3].
    """
    return np.asarray(np.linalg.det(_tangents(nodes, connectivity)))


def tetrahedron_quality(nodes: FloatArray, connectivity: IntArray) -> Quality:
    """Quality of ten-node tetrahedra by the same points, without gmsh.

    The inverse condition number is 3/(|T| |T^-1|) for the map T from a regular tetrahedron, in
    Frobenius' norm (P. M. Knupp, SIAM J. Sci. Comput. 23 (2001) 193-218), with the sign of det T.
    """
    tangents = _tangents(nodes, connectivity)
    determinants = np.linalg.det(tangents)
    maps = np.linalg.solve(_REGULAR, tangents)
    squared = np.sum(maps**2, axis=(2, 3))
    # |T^-1| |det T| is the norm of the cofactors: of the products of the rows
    rows = [np.cross(maps[..., i, :], maps[..., (i + 1) % 3, :]) for i in range(3)]
    cofactors = np.sum(np.square(rows), axis=(0, 3))
    shape = 3.0 * np.linalg.det(maps) / np.sqrt(squared * cofactors)
    worst = shape.min(axis=1)
    ratio = determinants.min(axis=1) / determinants.mean(axis=1)
    return Quality(float(worst.min()), float(worst.mean()), float(ratio.min()))


def jacobian_derivatives(
    nodes: FloatArray, connectivity: IntArray, weights: FloatArray
) -> FloatArray:
    """Differentiate a weighted sum of Jacobian determinants by the places of each cell's nodes.

    Parameters
    ----------
    nodes, connectivity
        As in `tetrahedron_jacobians`.
    weights : (m, 8) float array
        Of the determinants.

    Returns
    -------
    (m, 10, 3) float array
        [m^2]
    """
    tangents = _tangents(nodes, connectivity)
    cofactors = np.stack(
        [np.cross(tangents[..., a - 2, :], tangents[..., a - 1, :]) for a in range(3)], axis=-2
    )
    weighted = weights[..., None, None] * cofactors
    return np.asarray(np.einsum("qka,mqai->mki", _DERIVATIVES, weighted))


# Edges of a regular tetrahedron, one a row
_REGULAR = np.array([[1.0, 0.0, 0.0], [0.5, 0.75**0.5, 0.0], [0.5, 12.0**-0.5, (2 / 3) ** 0.5]])


def _tangents(nodes: FloatArray, connectivity: IntArray) -> FloatArray:
    """Differentiate the position along the three local axes, (m, 8, 3, 3)."""
    return np.asarray(np.einsum("qka,mki->mqai", _DERIVATIVES, nodes[connectivity]))


def _tetra10_derivatives(barycentric: FloatArray) -> FloatArray:
    """Differentiate the ten shape functions along the three local axes, (10, 3)."""
    gradients = np.array([[-1.0, -1, -1], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    corner = [(4 * lam - 1) * g for lam, g in zip(barycentric, gradients, strict=True)]
    middle = [
        4 * (barycentric[i] * gradients[j] + barycentric[j] * gradients[i]) for i, j in TETRA_EDGES
    ]
    return np.array(corner + middle)


_GAUSS = (0.58541019662496852, *3 * (0.13819660112501050,))
_POINTS = np.array([np.roll(_GAUSS, k) for k in range(4)] + list(np.eye(4)))
_DERIVATIVES = np.array([_tetra10_derivatives(point) for point in _POINTS])  # (q, 10, 3)


def _refuse_inverted(
    name: str, determinants: FloatArray, cells: IntArray, position: FloatArray
) -> None:
    worst = int(determinants.min(axis=1).argmin())
    if determinants[worst].min() <= 0.0:
        x, y, z = position[cells[worst]].mean(axis=0)
        raise InvertedCellError(
            f"a cell of the {name} is inverted at x = {x:.4f} m, y = {y:.4f} m, z = {z:.4f} m. "
            "Use a smaller mesh size, a thinner film or more cover above it."
        )


def poor_cell_notices(quality: Mapping[str, Quality]) -> tuple[Notice, ...]:
    """Notices for regions whose worst cell is poor."""
    notices = []
    for name, figures in quality.items():
        remedy = "Results near that cell are less accurate; try another mesh size"
        if figures.worst < POOR_SHAPE:
            notices.append(
                Notice(f"mesh of the {name}", "flat cell", figures.worst, POOR_SHAPE, remedy)
            )
        if figures.least_jacobian < POOR_JACOBIAN:
            notices.append(
                Notice(
                    f"mesh of the {name}", "strongly curved cell",
                    figures.least_jacobian, POOR_JACOBIAN, remedy,
                )
            )  # fmt: skip
    return tuple(notices)
