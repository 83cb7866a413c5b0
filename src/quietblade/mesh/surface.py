# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curved surfaces of six-node triangles: integrals, orientation and closest points.

Node order of a triangle: the three corners, then the middles of the edges 01, 12, 20. On the
reference triangle the corners are (0, 0), (1, 0) and (0, 1).
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from quietblade.errors import MeshError
from quietblade.typing import FloatArray, IntArray

_FLIPPED = (0, 2, 1, 5, 4, 3)
_EDGES = ((0, 1, 3), (1, 2, 4), (2, 0, 5))
_STEPS = 25
_CONVERGED = 1e-12  # of the reference triangle


def shape_functions(uv: FloatArray) -> FloatArray:
    """Values of the six quadratic shape functions.

    Parameters
    ----------
    uv : ndarray, shape (..., 2)
        Reference coordinates.

    Returns
    -------
    ndarray, shape (..., 6)
    """
    u, v = uv[..., 0], uv[..., 1]
    w = 1.0 - u - v
    corners = [w * (2.0 * w - 1.0), u * (2.0 * u - 1.0), v * (2.0 * v - 1.0)]
    return np.stack([*corners, 4.0 * u * w, 4.0 * u * v, 4.0 * v * w], axis=-1)


def shape_derivatives(uv: FloatArray) -> FloatArray:
    """Differentiate the shape functions by u and v.

    Parameters
    ----------
    uv : ndarray, shape (..., 2)

    Returns
    -------
    ndarray, shape (..., 2, 6)
    """
    u, v = uv[..., 0], uv[..., 1]
    w, zero = 1.0 - u - v, np.zeros_like(u)
    by_u = [1.0 - 4.0 * w, 4.0 * u - 1.0, zero, 4.0 * (w - u), 4.0 * v, -4.0 * v]
    by_v = [1.0 - 4.0 * w, zero, 4.0 * v - 1.0, -4.0 * u, 4.0 * u, 4.0 * (w - v)]
    return np.stack([np.stack(by_u, axis=-1), np.stack(by_v, axis=-1)], axis=-2)


def triangle_rule() -> tuple[FloatArray, FloatArray]:
    """Twelve-point rule, exact for polynomials of degree 6 (Dunavant 1985).

    Degree 6 integrates the force and the moment of a quadratic pressure on a curved six-node
    triangle without error.

    Returns
    -------
    uv : ndarray, shape (12, 2)
    weights : ndarray, shape (12,)
        Their sum is 1/2, the area of the reference triangle.
    """
    points: list[tuple[float, float]] = []
    weights: list[float] = []
    for a, weight in (
        (0.063089014491502, 0.050844906370207),
        (0.249286745170910, 0.116786275726379),
    ):
        points += [(a, a), (1.0 - 2.0 * a, a), (a, 1.0 - 2.0 * a)]
        weights += 3 * [weight]
    a, b, c = 0.053145049844817, 0.310352451033784, 0.636502499121399
    points += [(a, b), (b, a), (a, c), (c, a), (b, c), (c, b)]
    weights += 6 * [0.082851075618374]
    return np.array(points), 0.5 * np.array(weights) / sum(weights)


_UV, _WEIGHTS = triangle_rule()


@dataclass(frozen=True)
class SurfaceLocation:
    """Closest points of a surface.

    Attributes
    ----------
    triangle : ndarray, shape (P,)
        Index of the triangle.
    weights : ndarray, shape (P, 6)
        Values of its shape functions there; they sum to 1.
    distance : ndarray, shape (P,)
        Distance to the surface [m].
    """

    triangle: IntArray
    weights: FloatArray
    distance: FloatArray


@dataclass(frozen=True, eq=False)
class SurfaceQuadrature:
    """Six-node triangles with a quadrature rule, for any positions of their nodes.

    Attributes
    ----------
    points : ndarray, shape (N, 3)
        Undeformed nodes [m]; may hold nodes that are not on the surface.
    triangles : ndarray, shape (n, 6)
        Node numbers; counter-clockwise seen from the side to which area vectors point.
    """

    points: FloatArray
    triangles: IntArray

    @property
    def shape(self) -> FloatArray:
        """Shape functions at the quadrature points, (12, 6)."""
        return shape_functions(_UV)

    @cached_property
    def nodes(self) -> IntArray:
        """Sorted numbers of the nodes on the surface."""
        return np.unique(self.triangles)

    def positions(self, nodal: FloatArray) -> FloatArray:
        """Interpolate nodal values to the quadrature points.

        Parameters
        ----------
        nodal : ndarray, shape (N, k) or (N,)
            Positions, or any field.

        Returns
        -------
        ndarray, shape (n, 12, k) or (n, 12)
        """
        return np.asarray(np.einsum("qa,na...->nq...", self.shape, nodal[self.triangles]))

    def area_vectors(self, nodal: FloatArray) -> FloatArray:
        """Vectors n dS: unit normal times area times quadrature weight.

        Parameters
        ----------
        nodal : ndarray, shape (N, 3)
            Positions of the nodes [m], deformed or not.

        Returns
        -------
        ndarray, shape (n, 12, 3)
            They sum to the surface's vector area [m^2].
        """
        tangents = np.einsum("qda,nak->nqdk", shape_derivatives(_UV), nodal[self.triangles])
        normal = np.cross(tangents[:, :, 0], tangents[:, :, 1])
        return np.asarray(_WEIGHTS[:, None] * normal)

    def nodal_areas(self) -> FloatArray:
        """Share of each node in the undeformed area [m^2], (N,); positive on the surface.

        From the squared shape functions (the plain ones integrate to 0 at flat corners).
        """
        area = np.linalg.norm(self.area_vectors(self.points), axis=-1)
        squares = np.einsum("nq,qa->na", area, self.shape**2)
        share = squares * (area.sum(axis=1) / squares.sum(axis=1))[:, None]
        areas = np.zeros(len(self.points))
        np.add.at(areas, self.triangles, share)
        return areas

    def operator(self) -> csr_array:
        """Matrix from nodal values to values at the quadrature points, (12 n, N)."""
        n, rule = len(self.triangles), len(_WEIGHTS)
        columns = np.repeat(self.triangles, rule, axis=0).ravel()
        places = (np.repeat(np.arange(n * rule), 6), columns)
        data = np.tile(self.shape, (n, 1)).ravel()
        return csr_array((data, places), shape=(n * rule, len(self.points)))

    def enclosed_volume(self) -> float:
        """Signed volume [m^3] that the surface encloses; positive if it is oriented outwards.

        Openings with a plane rim count as closed by a plane face.
        """
        return float(np.sum(self._volumes(self.triangles, self._rim_centre(self.triangles))))

    def oriented(self) -> "SurfaceQuadrature":
        """Return the same surface with all area vectors outward.

        Neighbours are made to agree across their common edge; then each connected part is
        turned so that it encloses a positive volume (openings closed by plane faces).

        Raises
        ------
        MeshError
            An edge belongs to more than two triangles, or a part has only one side (Moebius).
        """
        n = len(self.triangles)
        first, second, agree = self._neighbours()
        # two copies of each triangle, as given and flipped: edges join copies that agree
        a = np.concatenate([first, first + n])
        b = np.concatenate(
            [np.where(agree, second, second + n), np.where(agree, second + n, second)]
        )
        graph = coo_array((np.ones(len(a)), (a, b)), shape=(2 * n, 2 * n))
        _, label = connected_components(graph, directed=False)
        if np.any(label[:n] == label[n:]):
            raise MeshError("surface: it has only one side; check the boundary triangles")
        triangles = self.triangles.copy()
        flip = label[:n] > label[n:]  # one consistent copy of each part
        triangles[flip] = triangles[flip][:, _FLIPPED]
        part = np.minimum(label[:n], label[n:])
        for number in np.unique(part):
            members = part == number
            chosen = triangles[members]
            if np.sum(self._volumes(chosen, self._rim_centre(chosen))) < 0.0:
                triangles[members] = chosen[:, _FLIPPED]
        return replace(self, triangles=triangles)

    def locate(self, points: FloatArray) -> SurfaceLocation:
        """Closest points of the undeformed surface.

        Parameters
        ----------
        points : ndarray, shape (P, 3)

        Returns
        -------
        SurfaceLocation
        """
        point, triangle, least = self._candidates(points)
        nodes, targets = self.points[self.triangles[triangle]], points[point]
        uv, distance = _closest_inside(nodes, targets)
        reached = np.full(len(points), np.inf)
        np.minimum.at(reached, point, distance)
        open_pairs = np.flatnonzero(least < reached[point])  # an edge may be closer there
        on_edge, edge_distance = _closest_on_edges(nodes[open_pairs], targets[open_pairs])
        closer = edge_distance < distance[open_pairs]
        uv[open_pairs[closer]] = on_edge[closer]
        distance[open_pairs[closer]] = edge_distance[closer]
        order = np.lexsort((distance, point))
        best = order[np.searchsorted(point[order], np.arange(len(points)))]
        return SurfaceLocation(triangle[best], shape_functions(uv[best]), distance[best])

    def interpolation(self, points: FloatArray) -> csr_array:
        """Matrix H that moves points with the surface: x = X + H u.

        Parameters
        ----------
        points : ndarray, shape (P, 3)
            Points on (or close to) the undeformed surface [m].

        Returns
        -------
        csr_array, shape (P, N)
            Rows sum to 1.
        """
        found = self.locate(points)
        places = (np.repeat(np.arange(len(points)), 6), self.triangles[found.triangle].ravel())
        shape = (len(points), len(self.points))
        return csr_array((found.weights.ravel(), places), shape=shape)

    def _volumes(self, triangles: IntArray, centre: FloatArray) -> FloatArray:
        part = replace(self, triangles=triangles)
        arm = part.positions(self.points) - centre
        return np.asarray(np.einsum("nqk,nqk->n", arm, part.area_vectors(self.points)) / 3.0)

    def _rim_centre(self, triangles: IntArray) -> FloatArray:
        ends = np.sort(np.concatenate([triangles[:, e[:2]] for e in _EDGES]), axis=1)
        edges, count = np.unique(ends, axis=0, return_counts=True)
        rim = np.unique(edges[count == 1])
        return np.asarray(self.points[rim if len(rim) else triangles].reshape(-1, 3).mean(axis=0))

    def _neighbours(self) -> tuple[IntArray, IntArray, IntArray]:
        """Pairs of triangles with a common edge, and whether they agree about its direction."""
        ends = np.concatenate([self.triangles[:, e[:2]] for e in _EDGES])
        owner = np.tile(np.arange(len(self.triangles)), 3)
        forward = ends[:, 0] < ends[:, 1]
        ends = np.sort(ends, axis=1)
        order = np.lexsort((ends[:, 1], ends[:, 0]))
        same = np.all(ends[order[1:]] == ends[order[:-1]], axis=1)
        if np.any(same[1:] & same[:-1]):
            edge = ends[order[1:-1]][same[1:] & same[:-1]][0]
            where = self.points[edge].mean(axis=0)
            raise MeshError(
                f"surface: more than two triangles share the edge at {np.round(where, 4)} m; "
                "pass one boundary only"
            )
        i, j = order[:-1][same], order[1:][same]
        return owner[i], owner[j], forward[i] != forward[j]

    def _candidates(self, points: FloatArray) -> tuple[IntArray, IntArray, FloatArray]:
        """Pairs (point, triangle) that hold the closest ones, and lower bounds of the distance."""
        nodes = self.points[self.triangles]
        fine = np.einsum("csa,nak->ncsk", shape_functions(_CELLS), nodes).reshape(-1, 6, 3)
        # a Bezier triangle lies inside the hull of its control points
        control = fine.copy()
        for i, j, middle in _EDGES:
            control[:, middle] = 2.0 * fine[:, middle] - 0.5 * (fine[:, i] + fine[:, j])
        centre = control.mean(axis=1)
        radius = np.linalg.norm(control - centre[:, None], axis=-1).max(axis=1)
        samples, tree = cKDTree(fine.reshape(-1, 3)), cKDTree(centre)
        reach = np.asarray(samples.query(points)[0])
        near = tree.query_ball_point(points, reach + radius.max())
        point = np.repeat(np.arange(len(points)), [len(found) for found in near])
        cell = np.concatenate([np.asarray(found, dtype=np.int64) for found in near])
        least = np.linalg.norm(points[point] - centre[cell], axis=1) - radius[cell]
        keep = least <= reach[point] * (1.0 + 1e-12)
        point, triangle, least = point[keep], cell[keep] // len(_CELLS), least[keep]
        order = np.lexsort((least, triangle, point))
        point, triangle, least = point[order], triangle[order], least[order]
        _, first = np.unique(point * len(nodes) + triangle, return_index=True)
        return point[first], triangle[first], least[first]


def _split(uv: FloatArray, times: int) -> FloatArray:
    """Six-node sub-triangles, (4^times, 6, 2), of a triangle with corners uv (3, 2)."""
    a, b, c = uv
    ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
    if times == 0:
        return np.array([[a, b, c, ab, bc, ca]])
    parts = ([a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab])
    return np.concatenate([_split(np.array(part), times - 1) for part in parts])


_CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
_CELLS = _split(_CORNERS, 2)
_STARTS = _CELLS[:, :3].mean(axis=1)  # not on an edge, where the slope may vanish
_EDGE_STARTS = np.linspace(0.1, 0.9, 5)[:, None]
_SECOND_DERIVATIVES = np.array(
    [
        [[4.0, 4.0, 0.0, -8.0, 0.0, 0.0], [4.0, 0.0, 0.0, -4.0, 4.0, -4.0]],
        [[4.0, 0.0, 0.0, -4.0, 4.0, -4.0], [4.0, 0.0, 4.0, 0.0, 0.0, -8.0]],
    ]
)


def _gap(nodes: FloatArray, points: FloatArray, uv: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("pa,pak->pk", shape_functions(uv), nodes) - points)


def _closest_inside(nodes: FloatArray, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Closest points (P, 2) in triangles (P, 6, 3) as seen from inside, and distances (P,)."""
    uv = _descend(nodes, points, np.zeros(2), np.eye(2), _STARTS)
    return uv, np.linalg.norm(_gap(nodes, points, uv), axis=1)


def _closest_on_edges(nodes: FloatArray, points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Closest points (P, 2) on the rims of triangles (P, 6, 3), and distances (P,)."""
    best_uv, best = np.zeros((len(points), 2)), np.full(len(points), np.inf)
    for i, j, _ in _EDGES:
        along = (_CORNERS[j] - _CORNERS[i])[None]
        uv = _descend(nodes, points, _CORNERS[i], along, _EDGE_STARTS)
        distance = np.linalg.norm(_gap(nodes, points, uv), axis=1)
        closer = distance < best
        best_uv[closer], best[closer] = uv[closer], distance[closer]
    return best_uv, best


def _descend(
    nodes: FloatArray, points: FloatArray, origin: FloatArray, axes: FloatArray, starts: FloatArray
) -> FloatArray:
    """Minimise the distance over uv = origin + q axes, q >= 0, sum q <= 1; returns uv (P, 2).

    Newton from the best of the starts (S, d); damped as by Levenberg and Marquardt, which is
    needed where a mid-edge node is far from the middle of its edge.
    """
    samples = np.einsum("sa,pak->psk", shape_functions(origin + starts @ axes), nodes)
    q = starts[np.argmin(np.sum((samples - points[:, None]) ** 2, axis=-1), axis=1)]
    damping, todo = np.zeros(len(points)), np.arange(len(points))
    curvature = np.einsum("di,ija,ej->dea", axes, _SECOND_DERIVATIVES, axes)
    for _ in range(_STEPS):
        x, p, at = nodes[todo], points[todo], q[todo]
        uv = origin + at @ axes
        gap = _gap(x, p, uv)
        tangents = np.einsum("di,pia,pak->pdk", axes, shape_derivatives(uv), x, optimize=True)
        normal = tangents @ tangents.transpose(0, 2, 1)
        size = np.trace(normal, axis1=1, axis2=2) + np.finfo(float).tiny
        hessian = normal + np.einsum("dea,pa->pde", curvature, np.einsum("pak,pk->pa", x, gap))
        convex = np.linalg.eigvalsh(hessian)[:, 0] > 1e-6 * size
        hessian = np.where(convex[:, None, None], hessian, normal)
        hessian += ((damping[todo] + 1e-15) * size)[:, None, None] * np.eye(len(axes))
        step = np.linalg.solve(hessian, tangents @ gap[:, :, None])[..., 0]
        trial = np.clip(at - step, 0.0, 1.0)
        trial -= 0.5 * np.maximum(trial.sum(axis=1, keepdims=True) - 1.0, 0.0)
        after = np.sum(_gap(x, p, origin + trial @ axes) ** 2, axis=1)
        better = after <= np.sum(gap**2, axis=1)
        q[todo[better]] = trial[better]
        raised = np.maximum(10.0 * damping[todo], 1e-3)
        damping[todo] = np.where(better, 0.1 * damping[todo], raised)
        todo = todo[np.max(np.abs(trial - at), axis=1) > _CONVERGED]
        if len(todo) == 0:
            break
    return np.asarray(origin + q @ axes)
