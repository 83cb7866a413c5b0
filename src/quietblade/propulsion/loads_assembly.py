# SPDX-License-Identifier: LGPL-2.1-or-later
"""What given loads do to a structure: nodal pressures, dead forces, and their totals."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import singledispatch

import ngsolve as ngs
import numpy as np
from scipy.interpolate import RegularGridInterpolator
from scipy.spatial import cKDTree

from quietblade.geometry import Blade
from quietblade.propulsion.forms import StructuralForms
from quietblade.propulsion.loading import Loading
from quietblade.propulsion.loads import (
    DeadLoad,
    Gravity,
    HydrostaticPressure,
    LineForce,
    Load,
    LoadError,
    PointForce,
    PressureAtPoints,
    PressureTable,
    UniformPressure,
)
from quietblade.propulsion.loads_places import SolidPlaces, SolidPoint
from quietblade.propulsion.structure import Structure
from quietblade.typing import FloatArray

# Parts of a line that are no longer than this share of the mean edge of the cells.
_LINE_PART = 0.5


@dataclass(frozen=True, eq=False)
class AppliedLoad:
    """One load on the mesh.

    Attributes
    ----------
    load : Load
        Its description.
    pressure : (nodes,) float array
        Pressure at the nodes [Pa], zero off the wetted surface; it follows the surface.
    dead_load : (displacement unknowns,) float array
        Forces of fixed direction [N], work-conjugate to the displacement unknowns.
    force, moment : (3,) float arrays
        Totals on the undeformed blade [N], [N m]; the moment is about the origin.
    distance : float
        Largest distance from a place that was asked for to the point that was taken [m].
    """

    load: Load
    pressure: FloatArray
    dead_load: FloatArray
    force: FloatArray
    moment: FloatArray
    distance: float = 0.0


@dataclass(frozen=True, eq=False)
class AppliedLoads:
    """All loads on the mesh, for ``structure.solve(loads.pressure, dead_load=loads.dead_load)``.

    Attributes
    ----------
    parts : tuple of AppliedLoad
        Each load by itself.
    pressure, dead_load : float arrays
        Their sums, see `AppliedLoad`.
    """

    parts: tuple[AppliedLoad, ...]
    pressure: FloatArray
    dead_load: FloatArray

    @property
    def force(self) -> FloatArray:
        """Total force on the undeformed blade, (3,) [N]."""
        return np.asarray(np.sum([np.zeros(3), *(part.force for part in self.parts)], axis=0))

    @property
    def moment(self) -> FloatArray:
        """Total moment about the origin, (3,) [N m]."""
        return np.asarray(np.sum([np.zeros(3), *(part.moment for part in self.parts)], axis=0))


def apply_loads(
    structure: Structure, loads: Sequence[Load], *, blade: Blade | None = None
) -> AppliedLoads:
    """Turn descriptions of loads into nodal pressures and dead forces.

    Parameters
    ----------
    structure : Structure
        Mesh, materials (for the weight) and wetted surface.
    loads : sequence of Load
        They add up.
    blade : Blade or None
        Shape that gives meaning to the span and chord fractions of a `PressureTable`.

    Raises
    ------
    LoadError
        If a load does not fit the blade; the message gives place and distance.
    """
    forms = structure.forms
    parts = tuple(_applied(load, forms, blade) for load in loads)
    return AppliedLoads(
        parts,
        np.sum([np.zeros(len(forms.basis.points)), *(p.pressure for p in parts)], axis=0),
        np.sum([np.zeros(forms.n_displacement), *(p.dead_load for p in parts)], axis=0),
    )


def resultant(
    forms: StructuralForms,
    forces: FloatArray,
    *,
    about: Sequence[float] = (0.0, 0.0, 0.0),
    displacement: FloatArray | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Force and moment of forces at the displacement unknowns (theory: S1-55).

    They are the work on unit translations and unit small rotations of the (deformed) body.

    Parameters
    ----------
    forms : StructuralForms
    forces : (displacement unknowns,) or (ndof,) float array
        Work-conjugate to the unknowns [N].
    about : three floats
        Point of reference of the moment [m].
    displacement : (displacement unknowns,) float array or None
        Displacement of the configuration; default undeformed.

    Returns
    -------
    force, moment : (3,) float arrays
        [N], [N m]
    """
    blocks = forces[: forms.n_displacement].reshape(3, -1)
    ones = forms.basis.to_dofs(np.ones(len(forms.basis.points)))
    places = forms.basis.to_dofs(forms.basis.points - np.asarray(about)).reshape(3, -1)
    if displacement is not None:
        places = places + displacement.reshape(3, -1)
    products = places @ blocks.T
    moment = [products[i, j] - products[j, i] for i, j in ((1, 2), (2, 0), (0, 1))]
    return blocks @ ones, np.array(moment)


def _applied(load: Load, forms: StructuralForms, blade: Blade | None) -> AppliedLoad:
    pressure, dead, distance = np.zeros(len(forms.basis.points)), None, 0.0
    if isinstance(load, DeadLoad):
        dead, distance = _dead_load(load, forms)
        total = dead
    else:
        nodes = forms.basis.nodes_of(forms.wetted, 1)
        pressure[nodes], distance = _pressure(load, forms.basis.points[nodes], blade)
        forms.set_loading(Loading(pressure, np.zeros(forms.n_displacement), 0.0))
        total = -forms.apply(forms.form(forms.pressure_terms()), np.zeros(forms.ndof))
    force, moment = resultant(forms, total)
    if dead is None:
        dead = np.zeros(forms.n_displacement)
    return AppliedLoad(load, pressure, dead, force, moment, distance)


# -- pressures ------------------------------------------------------------------------------------


@singledispatch
def _pressure(load: Load, points: FloatArray, blade: Blade | None) -> tuple[FloatArray, float]:
    """Pressure at points of the wetted surface, and the largest distance from what is known."""
    raise LoadError(f"a load of type {type(load).__name__} is not known")


@_pressure.register
def _(load: UniformPressure, points: FloatArray, blade: Blade | None) -> tuple[FloatArray, float]:
    return np.full(len(points), load.pressure), 0.0


@_pressure.register
def _(
    load: HydrostaticPressure, points: FloatArray, blade: Blade | None
) -> tuple[FloatArray, float]:
    gravity = np.array(load.gravity)
    if load.position == "mean":
        gravity[1:] = 0.0  # turns with the blade
    weight = load.water_density * np.linalg.norm(load.gravity)
    pressure = load.surface_pressure + weight * load.depth + load.water_density * points @ gravity
    depth = (pressure - load.surface_pressure) / weight if weight > 0.0 else pressure
    if depth.min(initial=0.0) < 0.0:
        place = points[int(np.argmin(depth))]
        raise LoadError(
            f"hydrostatic pressure: the point {np.round(place, 4)} m is {-depth.min():.3g} m above "
            "the free surface; increase the depth"
        )
    return pressure, 0.0


@_pressure.register
def _(load: PressureAtPoints, points: FloatArray, blade: Blade | None) -> tuple[FloatArray, float]:
    found = cKDTree(load.points).query(points)
    distance, nearest = np.asarray(found[0]), np.asarray(found[1])
    worst = int(np.argmax(distance))
    if distance[worst] > load.reach:
        raise LoadError(
            f"pressure at points: the node at {np.round(points[worst], 4)} m is "
            f"{distance[worst]:.3g} m from the nearest point, more than the reach "
            f"{load.reach:.3g} m; add points there or increase the reach"
        )
    return load.pressure[nearest], float(distance[worst])


@_pressure.register
def _(load: PressureTable, points: FloatArray, blade: Blade | None) -> tuple[FloatArray, float]:
    if blade is None:
        raise LoadError("pressure table: span and chord fractions need the blade's shape")
    s, xi, height = blade.locate(points)
    at = np.stack([np.clip(s, 0.0, 1.0), np.clip(xi, 0.0, 1.0)], axis=-1)
    faces = [blade.face_height(side, at[:, 0], at[:, 1]) for side in (1, -1)]
    above = height > 0.5 * (faces[0] + faces[1])
    upper, lower = (
        RegularGridInterpolator((load.s, load.xi), values)(at)
        for values in (load.upper, load.lower)
    )
    return np.where(above, upper, lower), 0.0


# -- dead forces ----------------------------------------------------------------------------------


@singledispatch
def _dead_load(load: DeadLoad, forms: StructuralForms) -> tuple[FloatArray, float]:
    """Return forces at the displacement unknowns, and the largest distance from the blade."""
    raise LoadError(f"a load of type {type(load).__name__} is not known")


@_dead_load.register
def _(load: Gravity, forms: StructuralForms) -> tuple[FloatArray, float]:
    work = ngs.LinearForm(forms.V)
    v = forms.V.TestFunction()
    for region, material in forms.materials.items():
        weight = material.density * ngs.CF(load.acceleration)
        work += ngs.InnerProduct(weight, v) * ngs.dx(region)
    return np.array(work.Assemble().vec), 0.0


@_dead_load.register
def _(load: PointForce, forms: StructuralForms) -> tuple[FloatArray, float]:
    point = _find(SolidPlaces(forms), np.array(load.place), load.tolerance, "point force")
    return _forces(forms, [point], np.array([load.force])), point.distance


@_dead_load.register
def _(load: LineForce, forms: StructuralForms) -> tuple[FloatArray, float]:
    places = SolidPlaces(forms)
    ends = forms.basis.points[forms.basis.edge_ends]
    mean_edge = float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).mean())
    density = np.broadcast_to(load.force, load.path.shape)
    abscissae, weights = np.polynomial.legendre.leggauss(3)
    points: list[SolidPoint] = []
    forces: list[FloatArray] = []
    for k in range(len(load.path) - 1):
        along = load.path[k + 1] - load.path[k]
        length = float(np.linalg.norm(along))
        parts = int(np.ceil(length / (_LINE_PART * mean_edge)))
        for part in range(parts):
            for abscissa, weight in zip(abscissae, weights, strict=True):
                share = (part + 0.5 * (1.0 + abscissa)) / parts
                place = load.path[k] + share * along
                points.append(_find(places, place, load.tolerance, "line force"))
                local = (1.0 - share) * density[k] + share * density[k + 1]
                forces.append(0.5 * weight * length / parts * local)
    return _forces(forms, points, np.array(forces)), max(point.distance for point in points)


def _find(places: SolidPlaces, place: FloatArray, tolerance: float, load: str) -> SolidPoint:
    point = places.find(place)
    if point.distance > tolerance:
        raise LoadError(
            f"{load}: the place {np.round(place, 5)} m is {point.distance:.3g} m off the blade, "
            f"more than the tolerance {tolerance:.3g} m; the nearest point is "
            f"{np.round(point.place, 5)} m"
        )
    return point


def _forces(forms: StructuralForms, points: Sequence[SolidPoint], forces: FloatArray) -> FloatArray:
    """Work-conjugate forces ``shape(point) force`` at the displacement unknowns."""
    dead = np.zeros((3, forms.n_displacement // 3))
    for point, force in zip(points, forces, strict=True):
        dead[:, point.unknowns] += np.outer(force, point.shape)
    return dead.ravel()
