# SPDX-License-Identifier: LGPL-2.1-or-later
"""Small solid models of beams, blocks and rings, for the checks and for the tests."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import combinations

import ngsolve as ngs
import numpy as np
from netgen.meshing import FaceDescriptor
from netgen.meshing import Mesh as NetgenMesh
from scipy.sparse.linalg import LinearOperator, eigsh

from quietblade.linalg import make_solver
from quietblade.materials import ElasticMaterial, IsotropicSVK
from quietblade.mesh.nodal import NodalBasis
from quietblade.propulsion.loading import Spin
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.propulsion.tangent import Tangent
from quietblade.typing import BoolArray, FloatArray

SIDES = "left|right|lower|upper"
SURFACE = f"{SIDES}|tip"

# From the first corner of a hexahedron to the opposite one along three edges, all positive.
_KUHN = ((0, 1, 2, 6), (0, 5, 1, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 4, 5, 6), (0, 7, 4, 6))


def box_mesh(
    x: FloatArray,
    y: FloatArray,
    z: FloatArray,
    *,
    in_film: Callable[[FloatArray], BoolArray] | None = None,
    move: Callable[[FloatArray], FloatArray] | None = None,
    tetrahedra: bool = False,
) -> ngs.Mesh:
    """Mesh a box with hexahedra between the given planes, or with six tetrahedra in each.

    Boundaries: ``root`` and ``tip`` (least and greatest z), ``left`` and ``right`` (x), ``lower``
    and ``upper`` (y).

    Parameters
    ----------
    x, y, z : arrays
        Planes, increasing.
    in_film : callable or None
        Says of cell centres (n, 3) whether they belong to the material ``film`` (else ``blade``).
    move : callable or None
        Maps the vertices (n, 3) to other places.
    tetrahedra : bool
        Kuhn's division of the hexahedra.
    """
    shape = (len(x), len(y), len(z))
    points = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(points)).reshape(shape)

    def corner(i: int, j: int, k: int) -> FloatArray:
        return number[i : shape[0] - 1 + i, j : shape[1] - 1 + j, k : shape[2] - 1 + k].ravel()

    ring = ((0, 0), (1, 0), (1, 1), (0, 1))
    cells = np.stack([corner(i, j, k) for k in (0, 1) for i, j in ring], axis=1)
    centres = points[cells].mean(axis=1)
    film = np.zeros(len(cells), dtype=bool) if in_film is None else in_film(centres)
    netgen = NetgenMesh(dim=3)
    netgen.AddPoints(np.ascontiguousarray(points if move is None else move(points)))
    regions = [(n, part) for n, part in (("blade", ~film), ("film", film)) if part.any()]
    for index, (name, part) in enumerate(regions, start=1):
        _add(netgen, 3, index, cells[part][:, _KUHN].reshape(-1, 4) if tetrahedra else cells[part])
        netgen.SetMaterial(index, name)
    sides = {
        "root": number[:, :, 0], "tip": number[:, :, -1], "left": number[0], "right": number[-1],
        "lower": number[:, 0], "upper": number[:, -1],
    }  # fmt: skip
    for index, (name, grid) in enumerate(sides.items(), start=1):
        netgen.Add(FaceDescriptor(surfnr=index, domin=1, domout=0, bc=index))
        netgen.SetBCName(index - 1, name)
        faces = np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=-1)
        quads = faces.reshape(-1, 4)
        halves = quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
        _add(netgen, 2, index, halves if tetrahedra else quads)
    return ngs.Mesh(netgen)


def _add(netgen: NetgenMesh, dimension: int, index: int, nodes: FloatArray) -> None:
    data = np.ascontiguousarray(nodes, dtype=np.int32)
    netgen.AddElements(dim=dimension, index=index, data=data, base=0)


@dataclass(frozen=True)
class Beam:
    """A slender cantilever along z with a square section, without Poisson's effect.

    Attributes
    ----------
    length, height : float
        Length and side of the section [m].
    cells : int
        Hexahedra along the length.
    youngs_modulus, density : float
        E [Pa], rho [kg/m3].
    """

    length: float = 10.0
    height: float = 0.1
    cells: int = 40
    youngs_modulus: float = 1.2e6
    density: float = 1000.0

    @property
    def bending_stiffness(self) -> float:
        """E I [N m2]."""
        return self.youngs_modulus * self.height**4 / 12

    @property
    def time_scale(self) -> float:
        """``sqrt(m L^4 / E I)`` [s], makes frequencies dimensionless."""
        mass = self.density * self.height**2
        return float(np.sqrt(mass * self.length**4 / self.bending_stiffness))

    def mesh(self, *, root: float = 0.0, beyond: int = 0) -> ngs.Mesh:
        """One hexahedron across the section, whose centre is on the z axis, from z = root on.

        ``beyond`` cells more continue the beam past its length.
        """
        side = np.array([-0.5, 0.5]) * self.height
        planes = root + np.arange(self.cells + beyond + 1) * self.length / self.cells
        return box_mesh(side, side, planes)

    def structure(
        self,
        spin: Spin = Spin(),  # noqa: B008  # frozen
        *,
        wetted: str = SURFACE,
        root: float = 0.0,
        beyond: int = 0,
        clamped: str | None = "root",
        guided: Mapping[str, str] | None = None,
    ) -> Structure:
        """Clamp the beam at z = root; pressure may act on all other faces, or those named."""
        material = IsotropicSVK("beam", self.density, self.youngs_modulus, 0.0)
        return Structure(
            self.mesh(root=root, beyond=beyond), {"blade": material}, wetted=wetted, spin=spin,
            clamped=clamped, guided=guided,
        )  # fmt: skip

    def tip_load(self, structure: Structure, force: FloatArray) -> FloatArray:
        """Dead load of a force [N] spread evenly over the tip face."""
        return traction_load(structure, np.asarray(force) / self.height**2, "tip")

    def line_load(self, structure: Structure, force: FloatArray) -> FloatArray:
        """Dead load of a force per length [N/m] spread evenly over the volume."""
        space = structure.forms.V
        body = ngs.CF(tuple(np.asarray(force, dtype=float) / self.height**2))
        work = ngs.LinearForm(ngs.InnerProduct(body, space.TestFunction()) * ngs.dx)
        return np.array(work.Assemble().vec)


def traction_load(
    structure: Structure, traction: FloatArray | ngs.CoefficientFunction, boundary: str
) -> FloatArray:
    """Dead load of a traction [Pa], three numbers or a function of place, on a boundary."""
    space = structure.forms.V
    field = traction if isinstance(traction, ngs.CoefficientFunction) else ngs.CF(tuple(traction))
    work = ngs.LinearForm(ngs.InnerProduct(field, space.TestFunction()) * ngs.ds(boundary))
    return np.array(work.Assemble().vec)


def voigt_stiffness(material: ElasticMaterial) -> FloatArray:
    """Stiffness (6, 6) [Pa] for engineering strains 11, 22, 33, 23, 13, 12, from the energy."""
    plane = np.array([0.0, 1.0])
    mesh = box_mesh(plane, plane, plane)
    pairs = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))

    def energy(strain: FloatArray) -> float:
        E = np.zeros((3, 3))
        for value, (i, j) in zip(strain, pairs, strict=True):
            E[i, j] += 0.5 * value
            E[j, i] += 0.5 * value
        field = ngs.CF(tuple(E.ravel()), dims=(3, 3))
        return float(material.energy_of_strain(field)(mesh(0.5, 0.5, 0.5)))

    unit = np.eye(6)
    single = [energy(e) for e in unit]
    stiffness = np.diag([2 * w for w in single])
    for a, b in combinations(range(6), 2):
        stiffness[a, b] = stiffness[b, a] = energy(unit[a] + unit[b]) - single[a] - single[b]
    return stiffness


def piola_stress(material: ElasticMaterial, F: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
    """First Piola-Kirchhoff stress [Pa] of a law at a deformation gradient, from its energy."""
    gradient = F.MakeVariable()
    return material.energy(gradient).Diff(gradient)


def cauchy_stress(
    structure: Structure, state: StructureState, region: str
) -> ngs.CoefficientFunction:
    """Cauchy stress [Pa] of an equilibrium in a region, a function of the undeformed place."""
    forms = structure.forms
    F = forms.gradient(forms.displacement(state.displacement)).MakeVariable()
    if region in forms.mixed:
        film_pressure = ngs.GridFunction(forms.P)
        film_pressure.vec.FV().NumPy()[:] = state.film_pressure
        energy = forms.mixed[region].energy(F, film_pressure)
    else:
        energy = forms.elastic[region].energy(F)
    return energy.Diff(F) * F.trans / ngs.Det(F)


def uniform_pressure(basis: NodalBasis, boundary: str, pressure: float) -> FloatArray:
    """Nodal pressures [Pa], uniform on a boundary and zero elsewhere."""
    values = np.zeros(len(basis.points))
    values[basis.nodes_of(boundary, 1)] = pressure
    return values


@dataclass(frozen=True)
class DryModes:
    """Real modes without water.

    Attributes
    ----------
    squares : (k,) float array
        Squares of the angular frequencies, increasing [rad2/s2]; negative if unstable.
    shapes : (free unknowns, k) float array
        Displacements and film pressures.
    """

    squares: FloatArray
    shapes: FloatArray

    @property
    def omega(self) -> FloatArray:
        """Angular frequencies [rad/s], NaN for an unstable mode."""
        return np.sqrt(np.where(self.squares >= 0.0, self.squares, np.nan))

    def loss_factors(self, tangent: Tangent, form: str, stiffness: str = "full") -> FloatArray:
        """Modal loss factors ``phi.L phi / phi.K phi`` of a loss form."""
        part = np.ix_(tangent.free, tangent.free)
        loss, stiff = tangent.loss(form)[part], tangent.stiffness(stiffness)[part]
        lost = np.einsum("ik,ik->k", self.shapes, loss @ self.shapes)
        return lost / np.einsum("ik,ik->k", self.shapes, stiff @ self.shapes)


def dry_modes(tangent: Tangent, count: int, form: str = "full") -> DryModes:
    """Lowest dry modes of a tangent (nearest to zero frequency)."""
    part = np.flatnonzero(tangent.free)
    stiffness = tangent.stiffness(form)[part][:, part]
    mass = tangent.mass[part][:, part]
    factor = make_solver(precision="double").factor(stiffness)
    inverse = LinearOperator(stiffness.shape, matvec=factor.solve, dtype=float)
    start = np.random.default_rng(1).standard_normal(len(part))
    squares, vectors = eigsh(stiffness, count, mass, sigma=0.0, OPinv=inverse, v0=mass @ start)
    # the film pressures have no mass: one more step makes them fit their displacements
    shapes = factor.solve(mass @ vectors) * squares
    order = np.argsort(squares)
    return DryModes(squares[order], shapes[:, order])
