# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bending, twist and their coupling of rectangular bars against laminate and torsion theory."""

from dataclasses import dataclass
from functools import cache

import ngsolve as ngs
import numpy as np

from quietblade.materials import (
    ElasticMaterial,
    Material,
    OrthotropicSVK,
    ply_axes,
    section_directions,
)
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.typing import FloatArray
from verification.registry import check
from verification.structure_models import box_mesh, traction_load, voigt_stiffness
from verification.structure_solid_theory import (
    BeamStiffness,
    laminate_beam,
    rectangle_torsion,
)

_STRAIN = 1e-5  # of the computed states: small enough that stiffness is that at rest


@dataclass(frozen=True)
class Bar:
    """A cantilever along z with a rectangular section: width along x, thickness along y.

    Attributes
    ----------
    length, width, thickness : float
        [m]
    cells : (3,) tuple of int
        Hexahedra along x, y, z; those of the length come in groups of five.
    """

    length: float = 1.0
    width: float = 0.1
    thickness: float = 0.012
    cells: tuple[int, int, int] = (8, 2, 10)

    @property
    def inertia(self) -> float:
        """Second moment of area of flapwise bending [m4]."""
        return self.width * self.thickness**3 / 12.0

    def structure(self, material: Material) -> Structure:
        """Clamp a bar of a material; pressure acts on its end."""
        nx, ny, nz = self.cells
        mesh = box_mesh(
            # short cells at the edges, where the shear of torsion turns round
            0.5 * np.sin(0.5 * np.pi * np.linspace(-1.0, 1.0, nx + 1)) * self.width,
            np.linspace(-0.5, 0.5, ny + 1) * self.thickness,
            np.linspace(0.0, 1.0, nz + 1) * self.length,
        )
        return Structure(mesh, {"blade": material}, wetted="tip")

    def compliance(self, material: Material, modulus: float) -> FloatArray:
        """Curvature and twist of a unit moment and a unit torque, (2, 2) [1/(N m2)].

        Measured between two sections inside, away from the clamp and from the loaded end.

        Parameters
        ----------
        material : Material
            Law of the bar, with its axes.
        modulus : float
            Young's modulus along the bar, about [Pa]: it sets the size of the load.
        """
        structure = self.structure(material)
        points = structure.basis.points
        nothing = np.zeros(len(points))
        moment = _STRAIN * modulus * self.inertia / (0.5 * self.thickness)
        tip = points[:, 2] > (1.0 - 1e-9) * self.length
        bent = structure.solve(moment / self.inertia * points[:, 1] * tip, tolerance=1e-9)
        polar = self.width * self.thickness * (self.width**2 + self.thickness**2) / 12.0
        spin = ngs.CF((-ngs.y, ngs.x, 0.0)) * (moment / polar)
        load = traction_load(structure, spin, "tip")
        turned = structure.solve(nothing, dead_load=load, tolerance=1e-9)
        columns = [self._rates(structure, state) for state in (bent, turned)]
        return np.stack(columns, axis=1) / moment

    def _rates(self, structure: Structure, state: StructureState) -> FloatArray:
        """Curvature of the deflection along y, and rate of rotation about z [1/m]."""
        near, far = (0.4 * self.length, 0.8 * self.length)
        points, values = structure.basis.points, structure.values(state)
        rotations = []
        for z in (near, far):
            section = np.abs(points[:, 2] - z) < 1e-9 * self.length
            x, y, _ = points[section].T
            u = values[section]
            design = np.stack([np.ones(len(x)), x, y], axis=1)
            slopes = np.linalg.lstsq(design, u, rcond=None)[0]
            # sections turn back by the slope of the deflection; u_y = x times the rotation
            rotations.append([-slopes[2, 2], slopes[1, 1]])
        return np.diff(rotations, axis=0)[0] / (far - near)


def bar_stiffness(
    material: OrthotropicSVK,
    angle: float,
    bar: Bar = Bar(),
) -> BeamStiffness:
    """Beam stiffness of a solid bar of one ply, its fibres at an angle from the axis towards +x."""
    turned = material.oriented(ply_axes(angle, *section_directions()))
    (bend, mix), (_, twist) = np.linalg.inv(bar.compliance(turned, material.e1))
    return BeamStiffness(float(bend), float(twist), float(mix))


# -- checks ---------------------------------------------------------------------------------------

# A carbon-epoxy strip from the tests of the open beam solver DCFoil
_PLY = {"e1": 117.8e9, "e2": 13.4e9, "g12": 3.9e9, "nu12": 0.25}
_STRIP = "plate strip of one ply (Jones, Mechanics of Composite Materials)"
_DCFOIL = "tests of the beam solver DCFoil (Akcabay and Young's strip)"
_SOLID = OrthotropicSVK(
    "carbon-epoxy", 1590.0, e1=117.8e9, e2=13.4e9, e3=13.4e9, g12=3.9e9, g23=4.9e9, g13=3.9e9,
    nu12=0.25, nu23=0.35, nu13=0.25,
)  # fmt: skip


def _strip(angle: float) -> BeamStiffness:
    return laminate_beam(0.1, 0.012, angle, **_PLY)


def _scan() -> list[BeamStiffness]:
    return [_strip(angle) for angle in np.radians(np.linspace(-90.0, 90.0, 181))]


@check("structure/strip-bending-across", quantity="EI of the strip, fibres at 90 degrees [N m2]",
       reference=192.96, source=_DCFOIL, tolerance=5e-3)  # fmt: skip
def _across() -> float:
    return _strip(np.pi / 2).bending


# The published value is the largest of a set of angles that leaves out zero itself.
@check("structure/strip-bending-along", quantity="EI of the strip, fibres near the axis [N m2]",
       reference=1695.34, source=_DCFOIL, tolerance=1.0)  # fmt: skip
def _along() -> float:
    return _strip(0.0).bending


@check("structure/strip-torsion-across", quantity="GJ of the strip, fibres at 90 degrees [N m2]",
       reference=224.64, source=_DCFOIL, tolerance=5e-3)  # fmt: skip
def _torsion_across() -> float:
    return _strip(np.pi / 2).torsion


# Largest values over the angle, in steps of a degree.
@check("structure/strip-torsion-most", quantity="largest GJ over the ply angle [N m2]",
       reference=1055.22, source=_DCFOIL, tolerance=0.1)  # fmt: skip
def _torsion_most() -> float:
    return max(strip.torsion for strip in _scan())


@check("structure/strip-coupling-most", quantity="largest |K| over the ply angle [N m2]",
       reference=778.83, source=_DCFOIL, tolerance=0.1)  # fmt: skip
def _coupling_most() -> float:
    return max(abs(strip.coupling) for strip in _scan())


@cache
def _solid(degrees: int) -> FloatArray:
    """Compliance of the solid bar, over what theory gives."""
    turned = _SOLID.oriented(ply_axes(np.radians(degrees), *section_directions()))
    return Bar().compliance(turned, _SOLID.e1)


def along_axis(material: ElasticMaterial) -> tuple[float, float]:
    """Curvature and twist by a unit bending moment times inertia, [1/Pa].

    Of an anisotropic bar of any section: its stress is that of Euler and Bernoulli, and twist
    comes with it (S. G. Lekhnitskii, Theory of Elasticity of an Anisotropic Body).
    """
    S = np.linalg.inv(voigt_stiffness(material))
    return float(S[2, 2]), float(0.5 * S[4, 2])


_LEKHNITSKII = "Lekhnitskii, Theory of Elasticity of an Anisotropic Body"
_BAR = Bar()

for _degrees in (0, 30, 45, 90):
    _turned = _SOLID.oriented(ply_axes(np.radians(_degrees), *section_directions()))
    _curvature, _twist = along_axis(_turned)

    # Exact inside the bar; what is left is the end's influence, which decays along the fibres.
    @check(f"structure/bar-bending-{_degrees}", quick=False,
           quantity=f"moment over curvature of a solid bar, fibres at {_degrees} degrees [N m2]",
           reference=_BAR.inertia / _curvature, source=_LEKHNITSKII,
           tolerance=5e-3 * _BAR.inertia / _curvature)  # fmt: skip
    def _bending(degrees: int = _degrees) -> float:
        return float(1.0 / _solid(degrees)[0, 0])

    if _twist != 0.0:

        @check(f"structure/bar-twist-{_degrees}", quick=False,
               quantity=f"twist over curvature under a moment, fibres at {_degrees} degrees",
               reference=_twist / _curvature, source=_LEKHNITSKII,
               tolerance=5e-3 * abs(_twist / _curvature))  # fmt: skip
        def _coupling(degrees: int = _degrees) -> float:
            compliance = _solid(degrees)
            return float(compliance[1, 0] / compliance[0, 0])


for _degrees in (0, 90):
    _moduli = (3.9e9, 3.9e9) if _degrees == 0 else (3.9e9, 4.9e9)
    _torsion = rectangle_torsion(_BAR.width, _BAR.thickness, *_moduli)

    @check(f"structure/bar-torsion-{_degrees}", quick=False,
           quantity=f"GJ of a solid bar, fibres at {_degrees} degrees [N m2]",
           reference=_torsion, source=f"{_LEKHNITSKII}, torsion of a rectangle",
           tolerance=5e-3 * _torsion)  # fmt: skip
    def _bar_torsion(degrees: int = _degrees) -> float:
        return float(1.0 / _solid(degrees)[1, 1])
