# SPDX-License-Identifier: LGPL-2.1-or-later
r"""Between the wetted surface of the structure and the sections of the flow.

Displacement, surface to sections
    Each section node goes to the closest point of the surface, and from there on follows it. The
    short way from that point to the exact section turns with the section as a rigid body, so that
    a rigid motion of the blade moves the sections rigidly, however coarse the elements at the
    nose are.

Pressure, sections to surface
    The pressure of the sections is projected to the nodes by least squares (see
    `quietblade.propulsion.section_pressure`). The smallest change of the nodal values then makes
    the loads of both descriptions equal. It is the smallest in the mean square over the area and
    relative to the mean square pressure around each node: what the projection lost is the suction
    peak, so the change belongs there and not on the trailing edge. With bell-shaped weights
    :math:`w_k(s)` (cubic B-splines, which sum to 1) and the deformed wetted surface,

    .. math::
        -\int w_k\, p\, n\, dS &= \int w_k f\, d\ell \quad \text{(across the span)}, \\
        -\int w_k\, T_k \cdot ((x - \hat x) \times p\, n)\, dS
            &= \int w_k\, T_k \cdot (m + (x_r - \hat x) \times f)\, d\ell,

    with the sections' force f and moment m per length of the deformed reference line
    :math:`x_r(\ell)`, its tangent :math:`T_k`, and its least-squares fit
    :math:`\hat x(s) = \sum_k x_k w_k(s)`. Because the weights sum to 1, the total force across
    the span and the total moment about the reference line are conserved too. Sections know no
    force along the span. What the pressure makes of it on a tapered or bent blade (the suction of
    the nose, the tip face) is real and stays, reported as leftover. (To remove it by pressure
    would take changes as large as the pressure itself.) The moments across the span are conserved
    as well as the weights resolve the span; what is left is reported. Any conservative transfer
    needs such conditions; compare Farhat, Lesoinne and Le Tallec, Comput. Methods Appl. Mech.
    Engrg. 157 (1998) 95-114. These conditions are (theory: S1-12); which work is
conserved with the loads: (theory: S1-90, S1-91).

The root face is clamped and no part of the surface. The tip face and the trailing-edge face take
the pressures between the upper and the lower side, see `quietblade.propulsion.section_pressure`.
"""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline, CubicSpline
from scipy.linalg import LinAlgError, cho_factor, cho_solve
from scipy.sparse import csr_array, diags_array, vstack

from quietblade.errors import GeometryError, MeshError
from quietblade.flow.loads import SectionLoads, integrate
from quietblade.flow.sections import DeformedSections
from quietblade.geometry import Blade
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.propulsion.section_pressure import SectionPressure
from quietblade.typing import FloatArray, IntArray

_DEGREE = 3
_LARGEST_GAP = 0.05  # of the chord, between exact sections and surface
_LEAST_FREEDOM = 0.01  # of the mean square pressure: nodes in weak pressure may change a little
_GAUSS_POINTS, _GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(4)


@dataclass(frozen=True, eq=False)
class SurfacePressure:
    """Pressure on the wetted surface, and how well it carries the sections' loads.

    Attributes
    ----------
    values : ndarray, shape (N,)
        p - p_inf at the nodes [Pa] (theory: S1-2); 0 off the wetted surface.
    correction : float
        Size of the correction relative to the projected pressure (root mean square by area). It
        falls with the element size at the nose; at 20 mm on a chord of 75 to 250 mm it is 0.4.
    force, moment : ndarray, shape (3,)
        Load on the deformed wetted surface [N], moment about the origin [N m].
    force_error, moment_error : ndarray, shape (3,)
        These less the sections' load (`quietblade.flow.loads.integrate`) [N, N m]. The force error
        is the leftover, along the span.
    leftover : ndarray, shape (K,)
        Force along the span beside each weight function that the sections do not have [N].
    mismatch : float
        Largest difference left in the conserved loads, relative to the largest of its kind.
    """

    values: FloatArray
    correction: float
    force: FloatArray
    moment: FloatArray
    leftover: FloatArray
    mismatch: float
    force_error: FloatArray
    moment_error: FloatArray


@dataclass(frozen=True, eq=False)
class _Balance:
    """The conserved loads: rows times nodal pressures [Pa] shall equal targets [N, N m]."""

    rows: csr_array
    targets: FloatArray
    kinds: IntArray
    """0 for forces, 1 for moments."""
    along_rows: csr_array
    along_targets: FloatArray


class LoadTransfer:
    """Displacement to the sections and pressure to the structure.

    Parameters
    ----------
    surface : SurfaceQuadrature
        Wetted surface, without the root face, in the undeformed configuration.
    blade : Blade
    s : ndarray, shape (M,)
        Span fractions of the sections, from 0 to 1.
    sections : ndarray, shape (M, n, 3)
        Undeformed sections ``blade.section(s, n)`` [m].
    weights : int
        Number K of weight functions along the span; not more than sections.

    Raises
    ------
    GeometryError
        Sections are not the blade's, do not run from 0 to 1, or are fewer than the weights.
    MeshError
        The surface is not the blade's, or contains the root face.
    """

    def __init__(
        self,
        surface: SurfaceQuadrature,
        blade: Blade,
        s: FloatArray,
        sections: FloatArray,
        *,
        weights: int = 20,
    ) -> None:
        _check_sections(blade, s, sections, weights)
        self.surface = surface.oriented()
        self.s = s
        self.sections = sections
        self._points = surface.points
        count = sections.shape[1]
        self._from_sections = SectionPressure(self.surface, blade, s, count)
        self._to_sections = self.surface.interpolation(sections.reshape(-1, 3))
        self._feet = (self._to_sections @ self._points).reshape(sections.shape)
        _check_gap(blade, s, sections, self._feet)
        nodes = self.surface.nodes
        self._nodes = nodes
        self._area = self.surface.nodal_areas()[nodes]
        self._operator = self.surface.operator()[:, nodes]
        # uniform knots, repeated at the ends: the weights sum to 1 on [0, 1]
        inner = np.linspace(0.0, 1.0, weights - _DEGREE + 1)
        self._knots = np.concatenate([np.zeros(_DEGREE), inner, np.ones(_DEGREE)])
        places = blade.locate(self.surface.positions(self._points).reshape(-1, 3))[0]
        self._on_surface = self._weights(places)
        self._on_stations = self._weights(s).toarray()
        self._greville = np.array(
            [self._knots[k + 1 : k + 1 + _DEGREE].mean() for k in range(weights)]
        )

    def displaced_sections(self, displacement: FloatArray) -> FloatArray:
        """Sections that move with the blade.

        Parameters
        ----------
        displacement : ndarray, shape (N, 3)
            At the nodes [m].

        Returns
        -------
        ndarray, shape (M, n, 3)
            Deformed section nodes [m].
        """
        moved = self._feet + (self._to_sections @ displacement).reshape(self._feet.shape)
        rotation = _rotations(self._feet, moved)
        gap = self.sections - self._feet
        return np.asarray(moved + np.einsum("mij,mnj->mni", rotation, gap))

    def projected_pressure(self, pressure: FloatArray) -> FloatArray:
        """Pressure of the sections projected to the surface's nodes, without correction.

        Parameters
        ----------
        pressure : ndarray, shape (M, n)
            At the section nodes [Pa].

        Returns
        -------
        ndarray, shape (N,)
            [Pa]; 0 off the wetted surface.
        """
        values = np.zeros(len(self._points))
        values[self._nodes] = self._from_sections.project(pressure)
        return values

    def pressure(
        self, sections: DeformedSections, loads: SectionLoads, displacement: FloatArray
    ) -> SurfacePressure:
        """Pressure on the surface that carries the loads of the sections.

        Parameters
        ----------
        sections : DeformedSections
            Arc length, reference points and tangents of the M deformed sections.
        loads : SectionLoads
            Pressure, and force and moment per unit length of the deformed span.
        displacement : ndarray, shape (N, 3)
            At the nodes [m].

        Returns
        -------
        SurfacePressure

        Raises
        ------
        MeshError
            The surface is too coarse for the number of weights.
        """
        first = self._from_sections.project(loads.pressure)
        square = self._from_sections.mean_square(loads.pressure)
        floor = _LEAST_FREEDOM * float(np.mean(square)) or 1.0
        positions = self._points + displacement
        where = self.surface.positions(positions).reshape(-1, 3)
        area = self.surface.area_vectors(positions).reshape(-1, 3)
        balance = self._balance(sections, loads, where, area)
        change, mismatch = _smallest_change(balance, first, self._area / (square + floor))
        corrected = first + change
        at_points = self._operator @ corrected
        values = np.zeros(len(self._points))
        values[self._nodes] = corrected
        size = float(np.sqrt(self._area @ first**2))
        force, moment = -at_points @ area, -at_points @ np.cross(where, area)
        total = integrate(sections, loads)
        return SurfacePressure(
            values=values,
            correction=float(np.sqrt(self._area @ change**2)) / size if size > 0.0 else 0.0,
            force=force,
            moment=moment,
            leftover=balance.along_rows @ corrected - balance.along_targets,
            mismatch=mismatch,
            force_error=force - total.force,
            moment_error=moment - total.moment,
        )

    def _balance(
        self, sections: DeformedSections, loads: SectionLoads, where: FloatArray, area: FloatArray
    ) -> _Balance:
        line, *_ = np.linalg.lstsq(self._on_stations, sections.reference)
        along = np.asarray(CubicSpline(self.s, sections.tangent)(self._greville))
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        across = _perpendicular(along)

        arms = np.cross(where - self._on_surface @ line, area)
        force_rows = [self._rows(-area[:, i]) for i in range(3)]
        moment_rows = [self._rows(-arms[:, i]) for i in range(3)]
        force, moment = self._targets(sections, loads, line)

        def component(rows: list[csr_array], direction: FloatArray) -> csr_array:
            parts = [diags_array(direction[:, i]) @ rows[i] for i in range(3)]
            return csr_array(parts[0] + parts[1] + parts[2])

        def dot(vectors: FloatArray, direction: FloatArray) -> FloatArray:
            return np.asarray(np.sum(vectors * direction, axis=1))

        rows = [*(component(force_rows, d) for d in across), component(moment_rows, along)]
        targets = [*(dot(force, d) for d in across), dot(moment, along)]
        return _Balance(
            csr_array(vstack(rows)),
            np.concatenate(targets),
            np.repeat([0, 0, 1], len(along)),
            component(force_rows, along),
            dot(force, along),
        )

    def _rows(self, factor: FloatArray) -> csr_array:
        """Integrals of weight times factor times nodal shape functions, (K, nodes)."""
        return csr_array(self._on_surface.T @ (diags_array(factor) @ self._operator))

    def _targets(
        self, sections: DeformedSections, loads: SectionLoads, line: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Weighted forces and moments about the fitted line, (K, 3) each, from cubic splines."""
        length = sections.arc_length
        step = np.diff(length)[:, None]
        ell = (length[:-1, None] + 0.5 * step * (1.0 + _GAUSS_POINTS)).ravel()
        measure = (0.5 * step * _GAUSS_WEIGHTS).ravel()[:, None]
        force, moment, reference, s = (
            np.asarray(CubicSpline(length, values)(ell))
            for values in (loads.force, loads.moment, sections.reference, self.s)
        )
        weights = self._weights(s)
        moment = moment + np.cross(reference - weights @ line, force)
        return weights.T @ (measure * force), weights.T @ (measure * moment)

    def _weights(self, s: FloatArray) -> csr_array:
        inside = np.clip(s, 0.0, 1.0)
        return csr_array(BSpline.design_matrix(inside, self._knots, _DEGREE))


def _check_sections(blade: Blade, s: FloatArray, sections: FloatArray, weights: int) -> None:
    if s[0] != 0.0 or s[-1] != 1.0 or not np.all(np.diff(s) > 0.0):
        raise GeometryError(
            f"load transfer: sections at span fractions {s[0]:g} ... {s[-1]:g} must increase "
            "from 0 to 1, so that every part of the surface lies between two"
        )
    if not _DEGREE < weights <= len(s):
        raise GeometryError(
            f"load transfer: {weights} weight functions with {len(s)} sections; use at least "
            f"{_DEGREE + 1} and not more than sections"
        )
    exact = blade.section(s, sections.shape[1])
    if not np.allclose(sections, exact, rtol=0.0, atol=1e-9 * blade.span):
        worst = float(np.max(np.linalg.norm(sections - exact, axis=-1)))
        raise GeometryError(
            f"load transfer: sections differ from the blade's by up to {1e3 * worst:.3g} mm; "
            "pass the undeformed blade.section(s, n)"
        )


def _check_gap(blade: Blade, s: FloatArray, sections: FloatArray, feet: FloatArray) -> None:
    gap = np.linalg.norm(sections - feet, axis=-1).max(axis=1)
    worst = int(np.argmax(gap / blade.chord(s)))
    if gap[worst] > _LARGEST_GAP * float(blade.chord(s)[worst]):
        raise MeshError(
            f"load transfer: the wetted surface is {1e3 * gap[worst]:.3g} mm away from the section "
            f"at span fraction {s[worst]:.3g}; refine the mesh at the nose, or check that mesh and "
            "blade belong together"
        )


def _perpendicular(along: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors across each unit vector (K, 3); any choice gives the same balance."""
    axis = np.eye(3)[np.argmin(np.abs(along), axis=1)]
    one = np.cross(along, axis)
    one /= np.linalg.norm(one, axis=1, keepdims=True)
    return one, np.cross(along, one)


def _rotations(before: FloatArray, after: FloatArray) -> FloatArray:
    """Rotations (M, 3, 3) that best move point sets (M, n, 3) (Kabsch 1976)."""
    a = before - before.mean(axis=1, keepdims=True)
    b = after - after.mean(axis=1, keepdims=True)
    left, _, right = np.linalg.svd(np.einsum("mni,mnj->mij", b, a))
    proper = np.ones(left.shape[:2])
    proper[:, 2] = np.sign(np.linalg.det(left @ right))
    return np.asarray((left * proper[:, None, :]) @ right)


def _smallest_change(
    balance: _Balance, pressure: FloatArray, weight: FloatArray
) -> tuple[FloatArray, float]:
    """Change of least weighted norm that meets the balance, and the mismatch left."""
    scaled = balance.rows @ diags_array(1.0 / weight)
    gram = (scaled @ balance.rows.T).toarray()
    scale = 1.0 / np.sqrt(np.diag(gram))
    try:
        factor = cho_factor(scale[:, None] * gram * scale)
    except LinAlgError as error:
        raise MeshError(
            f"load transfer: {int(np.sum(balance.kinds))} weight functions along the span are too "
            "many for the mesh of the wetted surface; use fewer, or a finer mesh"
        ) from error
    change = np.zeros_like(pressure)
    for _ in range(3):  # the repetitions remove the round-off of the first
        rest = balance.targets - balance.rows @ (pressure + change)
        change += scaled.T @ (scale * cho_solve(factor, scale * rest))
    rest = balance.targets - balance.rows @ (pressure + change)
    size = np.maximum(np.abs(balance.targets), abs(balance.rows) @ np.abs(pressure))
    mismatch = max(
        float(np.max(np.abs(rest[kind])) / max(np.max(size[kind]), np.finfo(float).tiny))
        for kind in (balance.kinds == 0, balance.kinds == 1)
    )
    return change, mismatch
