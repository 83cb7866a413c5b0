# SPDX-License-Identifier: LGPL-2.1-or-later
"""Excitations and transfer functions against closed forms and reciprocity."""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from scipy.sparse import csr_matrix

from quietblade.propulsion.structure import Structure
from quietblade.propulsion.tangent import compute_tangent
from quietblade.typing import ComplexArray, FloatArray
from quietblade.vibroacoustics.loads import (
    Excitation,
    band_integral,
    response_density,
    spectral_matrix,
)
from quietblade.vibroacoustics.loss import Lossy, Viscous
from quietblade.vibroacoustics.point_loads import point_force
from quietblade.vibroacoustics.power import power_budget
from quietblade.vibroacoustics.root import RootedSystem, add_root, elastic_shaft
from quietblade.vibroacoustics.transfer_functions import mobility, root_path
from quietblade.vibroacoustics.vacuum import dry_operators
from verification.acoustics_oscillators import (
    bar_carried,
    bar_stiffness,
    cantilever_mobility,
    random_mean_square,
)
from verification.acoustics_plate import WetPlate, solve_all
from verification.registry import check
from verification.structure_models import Beam


@dataclass(frozen=True, eq=False)
class DryBeam:
    """A dry cantilever with a constant loss factor, whose root can move.

    Attributes
    ----------
    beam : Beam
    loss : float
    """

    beam: Beam
    loss: float

    @cached_property
    def structure(self) -> Structure:
        """Mesh and material."""
        return self.beam.structure()

    @cached_property
    def system(self) -> RootedSystem:
        """Operators with the root."""
        structure = self.structure
        tangent = compute_tangent(structure, structure.rest())
        matrices = {"stiffness": tangent.stiffness(), "mass": tangent.mass}
        loss = {"blade": self.loss * tangent.region_material["blade"]}
        operators = dry_operators(
            **matrices, free=tangent.free, displacements=structure.forms.n_displacement, loss=loss
        )
        return add_root(operators, structure.forms.fem, structure.basis, **matrices, loss=loss)

    def tip(self, axis: int) -> FloatArray:
        """Load of a unit force along an axis, spread over the tip face."""
        return np.asarray(
            self.system.right_hand_side(self.beam.tip_load(self.structure, np.eye(3)[axis]))
        )


BAR = DryBeam(Beam(length=2.0, height=0.1, cells=20, youngs_modulus=1e9), 0.05)
# 80 times as long as high, so that shear and rotary inertia do not count
SLENDER = DryBeam(Beam(length=8.0, height=0.1, cells=30, youngs_modulus=1e9), 0.05)


def tip_mobility(model: DryBeam, frequency: FloatArray) -> ComplexArray:
    """Drive-point mobility of the tip, sideways."""
    omega, load = 2.0 * np.pi * frequency, model.tip(1)
    x = solve_all(model.system.operators, frequency, load[None])[:, 0]
    return mobility(omega, x, load)


def exact_mobility(model: DryBeam, frequency: FloatArray) -> ComplexArray:
    """Give that of an Euler-Bernoulli beam."""
    beam = model.beam
    bending = beam.bending_stiffness * (1.0 + 1j * model.loss)
    return cantilever_mobility(
        2.0 * np.pi * frequency, beam.length, bending, beam.density * beam.height**2
    )


_AT = np.array([0.15, 0.26, 1.0])
for _i, _exact in enumerate(exact_mobility(SLENDER, _AT)):
    # 0.2 %: shear and rotary inertia, and a root that does not warp
    @check(f"acoustics/beam-mobility-{_i + 1}", source="Euler-Bernoulli beam, closed form",
           quantity=f"tip mobility of a dry cantilever at {_AT[_i]:g} Hz, modulus [m/(N s)]",
           reference=float(abs(_exact)), tolerance=float(2e-3 * abs(_exact)))  # fmt: skip
    def _beam_mobility(at: float = float(_AT[_i])) -> float:
        return float(abs(tip_mobility(SLENDER, np.array([at]))[0]))


@cache
def moved_bar() -> tuple[ComplexArray, ComplexArray]:
    """Motion of the tip and force at the root of a bar whose root moves by one along it."""
    system, frequency = BAR.system, np.array([50.0, 124.0, 260.0])
    x = solve_all(system.operators, frequency, system.base_motion(np.eye(6)[2])[None])[:, 0]
    return x @ BAR.tip(2), system.reaction(x)[:, 2]


_OMEGA = 2.0 * np.pi * np.array([50.0, 124.0, 260.0])
_YOUNG = BAR.beam.youngs_modulus * (1.0 + 1j * BAR.loss)
_CARRIED = bar_carried(_OMEGA, BAR.beam.length, BAR.beam.length, _YOUNG, BAR.beam.density)
_PULLED = bar_stiffness(_OMEGA, BAR.beam.length, BAR.beam.height**2, _YOUNG, BAR.beam.density)
for _i in range(3):
    # the mesh's error in the wave number grows with frequency
    @check(f"acoustics/base-motion-tip-{_i + 1}", source="bar, closed form 1/cos(k L)",
           quantity="tip motion over root motion of a dry bar, modulus",
           reference=float(abs(_CARRIED[_i])),
           tolerance=float(2e-4 * abs(_CARRIED[_i])))  # fmt: skip
    def _tip(i: int = _i) -> float:
        return float(abs(moved_bar()[0][i]))

    @check(f"acoustics/base-motion-force-{_i + 1}", source="bar, closed form -E A k tan(k L)",
           quantity="force over motion of the root of a dry bar, modulus [N/m]",
           reference=float(abs(_PULLED[_i])), tolerance=float(2e-4 * abs(_PULLED[_i])))  # fmt: skip
    def _pull(i: int = _i) -> float:
        return float(abs(moved_bar()[1][i]))


PLATE = WetPlate()
FREQUENCY = np.array([30.0, 110.0, 220.0])
PLACES = np.array([[0.06, 0.015, 0.2], [-0.05, -0.015, 0.1]])
FORCES = np.array([[0.4, -1.0, 0.3], [1.0, 1.0, 1.0]])


@cache
def plate_path() -> tuple[FloatArray, ComplexArray]:
    """Solve for two point forces and six motions of the root; loads and responses."""
    system = PLATE.rooted
    loads = np.stack([
        system.right_hand_side(point_force(PLATE.basis, PLATE.surface, place, force))
        for place, force in zip(PLACES, FORCES, strict=True)
    ])  # fmt: skip
    every = np.concatenate([loads, system.base_motion(np.eye(6))])
    return loads, solve_all(system.operators, FREQUENCY, every)


@check("acoustics/reciprocity-points", reference=0.0, tolerance=1e-8,
       quantity="largest relative difference of the mobilities A to B and B to A, in water",
       source="reciprocity (A is symmetric)")  # fmt: skip
def reciprocity() -> float:
    """Two places and directions on the wet plate."""
    loads, x = plate_path()
    omega = 2.0 * np.pi * FREQUENCY
    there, back = mobility(omega, x[:, 0], loads[1]), mobility(omega, x[:, 1], loads[0])
    return float(np.abs(there / back - 1.0).max())


@check("acoustics/reciprocity-root", reference=0.0, tolerance=1e-7,
       quantity="largest relative difference of a blocked force and the motion that the root gives",
       source="reciprocity: at the root by a force at A, at A by a motion of the root")  # fmt: skip
def root_reciprocity() -> float:
    """Norm over the six components."""
    loads, x = plate_path()
    blocked, carried = -PLATE.rooted.reaction(x[:, 0]), x[:, 2:] @ loads[0]
    difference, size = (np.linalg.norm(part, axis=1) for part in (blocked - carried, carried))
    return float(np.max(difference / size))


@check("acoustics/base-motion-balance", reference=0.0, tolerance=1e-8,
       quantity="power balance of a plate in water moved by its root",
       source="power through the root = radiated + dissipated")  # fmt: skip
def base_balance() -> float:
    """Take a motion with all six components and phases."""
    system, motion = PLATE.rooted, np.array([0.3, -1.0, 0.2j, 0.5, 1.0j, -0.4])
    x = np.einsum("i,fin->fn", motion, plate_path()[1][:, 2:])
    load = system.base_motion(motion)
    return float(power_budget(system.operators, 2.0 * np.pi * FREQUENCY, x, load).residual.max())


SHAFT_STIFFNESS = np.array([4e5, 5e5, 9e5, 3e4, 2e4, 1e4])
SHAFT_DAMPING = np.array([40.0, 50.0, 90.0, 3.0, 2.0, 1.0])
SHAFT_MASS = np.array([0.5, 0.5, 0.5, 0.01, 0.01, 0.01])


@cache
def shaft_powers() -> tuple[FloatArray, FloatArray, FloatArray]:
    """Power into the shaft from blocked forces and from the coupled system, and its balance."""
    system, omega = PLATE.rooted, 2.0 * np.pi * FREQUENCY
    loads, every = plate_path()
    path = root_path(
        system, omega, loads[:1], lambda _: np.concatenate([every[:, :1], every[:, 2:]], axis=1)
    )
    impedance = np.array([
        SHAFT_DAMPING + 1j * (w * SHAFT_MASS - SHAFT_STIFFNESS / w) for w in omega
    ])  # fmt: skip
    shafted = elastic_shaft(system, SHAFT_STIFFNESS, SHAFT_DAMPING, SHAFT_MASS)
    load = shafted.right_hand_side(point_force(PLATE.basis, PLATE.surface, PLACES[0], FORCES[0]))
    x = solve_all(shafted.operators, FREQUENCY, load[None])[:, 0]
    budget = power_budget(shafted.operators, omega, x, load)
    velocity = 1j * omega[:, None] * shafted.motion(x)
    direct = 0.5 * np.sum(SHAFT_DAMPING * np.abs(velocity) ** 2, axis=1)
    return path.power(impedance)[:, 0], direct, budget.residual


@check("acoustics/shaft-power", reference=0.0, tolerance=1e-7,
       quantity="largest relative difference of the power into an elastic shaft on two ways",
       source="blocked force and dynamic stiffness against the coupled system")  # fmt: skip
def shaft_power() -> float:
    """Three frequencies."""
    behind, direct, _ = shaft_powers()
    return float(np.abs(behind / direct - 1.0).max())


@check("acoustics/shaft-balance", reference=0.0, tolerance=1e-8,
       quantity="power balance of a plate in water on an elastic shaft",
       source="injected = radiated + dissipated + into the shaft")  # fmt: skip
def shaft_balance() -> float:
    """Of the coupled system."""
    return float(shaft_powers()[2].max())


def random_oscillator(mass: float, damping: float, stiffness: float, density: float) -> float:
    """Mean square displacement under white noise, integrated over the band 0..1000 f_0."""
    one = csr_matrix(np.ones((1, 1)))
    operators = dry_operators(
        stiffness=stiffness * one, mass=mass * one, free=np.ones(1, dtype=bool), displacements=1,
        loss={"dashpot": Lossy(damping * one, Viscous())},
    )  # fmt: skip
    natural = float(np.sqrt(stiffness / mass) / (2.0 * np.pi))

    def spectrum(frequency: FloatArray) -> FloatArray:
        transfer = np.array([[1.0 / operators.at(2.0 * np.pi * f)[0, 0]] for f in frequency])
        force = spectral_matrix([Excitation("white", np.ones(1), density)], frequency, "none")
        return response_density(transfer, force)

    loss = np.array([damping / np.sqrt(stiffness * mass)])
    return band_integral(spectrum, (0.0, 1000.0 * natural), np.array([natural]), loss)


@check("acoustics/random-oscillator",
       quantity="mean square of an oscillator under white noise [m2]",
       reference=random_mean_square(7.0, 0.3, 5e3), source="closed form S/(4 c k)",
       tolerance=1e-6 * random_mean_square(7.0, 0.3, 5e3))  # fmt: skip
def random_response() -> float:
    """Loss factor 0.003: the spectrum is a needle."""
    return random_oscillator(2.0, 0.3, 5e3, 7.0)
