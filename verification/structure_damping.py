# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frequencies and modal loss of sandwich beams at rest against the Mead-Markus theory.

Faces bend and stretch, the thin core only shears, and only across the thickness; inertia is that of
the deflection (D. J. Mead, S. Markus, J. Sound Vib. 10 (1969) 163-175).
"""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
import scipy.linalg
from numpy.polynomial import Legendre
from numpy.polynomial.legendre import leggauss

from quietblade.linalg import make_solver
from quietblade.materials import IsotropicSVK, MooneyRivlin
from quietblade.materials.viscoelastic import ConstantLoss
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.tangent import compute_tangent
from quietblade.typing import ComplexArray, FloatArray
from quietblade.vibroacoustics.complex_modes import complex_modes
from quietblade.vibroacoustics.loss import Lossy
from quietblade.vibroacoustics.modes import dry_modes
from quietblade.vibroacoustics.vacuum import dry_operators
from verification.registry import check
from verification.structure_models import box_mesh


@dataclass(frozen=True)
class Sandwich:
    """Symmetric three-layer beam; the data are those of a beam that many authors use.

    Attributes
    ----------
    length, width, face, core : float
        Length, width, thickness of each face and of the core [m].
    young, face_density : float
        Of the faces, E [Pa] and [kg/m3].
    shear, core_density : float
        Of the core, G at rest [Pa] and [kg/m3].
    loss : float
        Loss factor of the core.
    """

    length: float = 0.1778
    width: float = 0.0127
    face: float = 1.524e-3
    core: float = 0.127e-3
    young: float = 69e9
    face_density: float = 2766.0
    shear: float = 1.794e6 / 2.6
    core_density: float = 968.1
    loss: float = 0.1

    @property
    def _distance(self) -> float:
        return self.face + self.core

    @property
    def _stretch(self) -> float:
        """Y: bending stiffness of the faces' stretching, per width [N m]."""
        return 0.5 * self.young * self.face * self._distance**2

    @property
    def _bending(self) -> float:
        """D: of the faces on their own, per width [N m]."""
        return self.young * self.face**3 / 6.0

    @property
    def _mass(self) -> float:
        """Mass per area [kg/m2]."""
        return 2.0 * self.face_density * self.face + self.core_density * self.core

    def supported(self, count: int) -> ComplexArray:
        """Squares of the complex angular frequencies of the beam on two simple supports."""
        k = np.arange(1, count + 1) * np.pi / self.length
        g = 2.0 * self.shear * (1.0 + 1j * self.loss) / (self.core * self.young * self.face)
        stiffness = self._bending + self._stretch * g / (g + k**2)
        return np.asarray(k**4 * stiffness / self._mass)

    def cantilever(self, count: int, terms: int = 22) -> ComplexArray:
        """Squares of the complex angular frequencies of the beam clamped at one end.

        Ritz's method: deflection x^2 P_j(x) and rotation x P_j(x) of the faces' stretching, with
        Legendre polynomials over the length.
        """
        x, weights = leggauss(2 * terms + 4)
        x, weights = 0.5 * (x + 1.0), 0.5 * weights * self.length
        rows = []
        for j in range(terms):
            series = Legendre.basis(j, domain=(0.0, 1.0)).convert(kind=np.polynomial.Polynomial)
            rows.append((series * np.polynomial.Polynomial([0.0, 0.0, 1.0]),
                         series * np.polynomial.Polynomial([0.0, 1.0])))  # fmt: skip
        w = np.array([row[0](x) for row in rows])
        slope = np.array([row[0].deriv(1)(x) for row in rows]) / self.length
        curve = np.array([row[0].deriv(2)(x) for row in rows]) / self.length**2
        turn = np.array([row[1](x) for row in rows])
        bend = np.array([row[1].deriv(1)(x) for row in rows]) / self.length
        none = np.zeros_like(w)
        sheared = np.concatenate([slope, -turn])
        curved, bent = np.concatenate([curve, none]), np.concatenate([none, bend])
        moved = np.concatenate([w, none])
        core = self.shear * (1.0 + 1j * self.loss) * self._distance**2 / self.core
        stiffness = (
            self._bending * (curved * weights) @ curved.T
            + self._stretch * (bent * weights) @ bent.T
            + core * (sheared * weights) @ sheared.T
        )
        mass = self._mass * (moved * weights) @ moved.T
        # the rotation has no inertia: condense it
        a, b = slice(0, terms), slice(terms, None)
        stiffness = stiffness[a, a] - stiffness[a, b] @ np.linalg.solve(
            stiffness[b, b], stiffness[b, a]
        )
        # to an orthonormal basis, or rounding decides
        root = np.linalg.cholesky(mass[a, a])
        inner = scipy.linalg.solve_triangular(root, stiffness, lower=True)
        inner = scipy.linalg.solve_triangular(root, inner.T, lower=True)
        values = np.linalg.eigvals(inner)
        return np.asarray(values[np.argsort(values.real)][:count])

    def solid(self, *, clamped: bool, cells: int = 64) -> "SolidSandwich":
        """Make the solid model of it."""
        return SolidSandwich(self, clamped, cells)


@dataclass(frozen=True)
class SolidSandwich:
    """The sandwich as a solid: hexahedra, one layer in the core, a nearly incompressible film.

    The sides only slide, and the faces have no Poisson's effect: a beam, not a plate.
    """

    beam: Sandwich
    clamped: bool
    cells: int

    @cached_property
    def structure(self) -> Structure:
        """Mesh, materials and supports."""
        beam = self.beam
        planes = np.cumsum([0.0, beam.face, beam.core, beam.face])
        mesh = box_mesh(
            np.array([0.0, beam.width]),
            planes,
            np.linspace(0.0, beam.length, self.cells + 1),
            in_film=lambda centres: np.abs(centres[:, 1] - planes.mean()) < 0.5 * beam.core,
        )
        materials = {
            "blade": IsotropicSVK("face", beam.face_density, beam.young, 0.0),
            "film": MooneyRivlin(
                "core", beam.core_density, 0.5 * beam.shear, 0.0, 13.0 / 6.0 * beam.shear
            ),
        }
        guided = {"x": "left|right"} if self.clamped else {"x": "left|right", "y": "root|tip"}
        return Structure(
            mesh, materials, wetted="upper", guided=guided,
            clamped="root" if self.clamped else None,
        )  # fmt: skip

    def modes(self, count: int, highest: float) -> tuple[FloatArray, FloatArray]:
        """Frequencies [Hz] and loss factors of the lowest complex modes with elastic energy.

        They obey lambda = omega^2 (1 + i eta), as those of the theory.
        """
        tangent = compute_tangent(self.structure, self.structure.rest())
        film = Lossy(tangent.film_isochoric_material, ConstantLoss(self.beam.loss))
        operators = dry_operators(
            stiffness=tangent.stiffness(), mass=tangent.mass, free=tangent.free,
            displacements=self.structure.forms.n_displacement, loss={"film": film},
        )  # fmt: skip
        solver = make_solver(precision="double", tolerance=1e-11)
        real = dry_modes(operators, highest, solver=solver)
        # on two supports the beam is free along its axis
        lowest = 1.0
        modes = complex_modes(operators, real, (lowest, highest), solver=solver, tolerance=1e-6)
        squares = modes.omega[modes.converged] ** 2
        return reduced_form(squares[:count])


def reduced_form(squares: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """Frequencies [Hz] and loss factors of lambda = omega^2 (1 + i eta)."""
    return np.sqrt(squares.real) / (2.0 * np.pi), squares.imag / squares.real


@cache
def solid_cantilever(loss: float) -> tuple[FloatArray, FloatArray]:
    """Six lowest modes of the clamped solid."""
    return Sandwich(loss=loss).solid(clamped=True).modes(6, 3600.0)


@cache
def solid_supported(loss: float) -> tuple[FloatArray, FloatArray]:
    """Four lowest modes of the solid on two supports."""
    return Sandwich(loss=loss).solid(clamped=False).modes(4, 2200.0)


_THEORY = "Mead-Markus theory, Ritz's method"
_CLOSED = "Mead-Markus theory, closed form"
# The theory has faces without shear and rotary inertia, which count with the square of the mode;
# below 0.1 % in the first three modes and 0.5 % in the others, and 1 % in the loss factor.
for _loss, _tag, _quick in ((0.1, "light", True), (1.0, "heavy", False)):
    for _name, _solid, _values, _source in (
        ("", solid_cantilever, Sandwich(loss=_loss).cantilever(6), _THEORY),
        ("supported-", solid_supported, Sandwich(loss=_loss).supported(4), _CLOSED),
    ):
        for _mode, (_frequency, _factor) in enumerate(
            zip(*reduced_form(_values), strict=True), start=1
        ):

            @check(f"acoustics/sandwich-{_name}frequency-{_tag}-{_mode}",
                   quantity=f"frequency {_mode} of the sandwich, core loss {_loss:g} [Hz]",
                   reference=float(_frequency), source=_source, quick=_quick,
                   tolerance=(1e-3 if _mode <= 3 else 5e-3) * float(_frequency))  # fmt: skip
            def _frequencies(mode: int = _mode, loss: float = _loss, solid=_solid) -> float:  # type: ignore[no-untyped-def]
                return float(solid(loss)[0][mode - 1])

            @check(f"acoustics/sandwich-{_name}loss-{_tag}-{_mode}",
                   quantity=f"loss factor {_mode} of the sandwich, core loss {_loss:g}",
                   reference=float(_factor), source=_source, tolerance=1e-2 * float(_factor),
                   quick=_quick)  # fmt: skip
            def _losses(mode: int = _mode, loss: float = _loss, solid=_solid) -> float:  # type: ignore[no-untyped-def]
                return float(solid(loss)[1][mode - 1])
