# SPDX-License-Identifier: LGPL-2.1-or-later
"""Loss that depends on frequency, and the stream's, against closed forms."""

from functools import cache

import numpy as np
from scipy.sparse import csr_matrix, diags, eye

from quietblade.linalg import make_solver
from quietblade.materials.viscoelastic import (
    FractionalZener,
    GeneralizedMaxwell,
    ModulusRatio,
    fit_maxwell,
    modulus_ratio,
)
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.complex_modes import complex_modes
from quietblade.vibroacoustics.excitation import pressure_force
from quietblade.vibroacoustics.flow_damping import stream_loss
from quietblade.vibroacoustics.loss import Lossy
from quietblade.vibroacoustics.modes import WetModes, dry_modes
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.power import power_budget
from quietblade.vibroacoustics.projection import Projection
from quietblade.vibroacoustics.reduced import ReducedModel, reduce_system
from quietblade.vibroacoustics.vacuum import dry_operators
from verification.acoustics_oscillators import maxwell_mode, oscillator_mode
from verification.acoustics_plate import WetPlate, solve_all
from verification.acoustics_strip import StripInStream
from verification.registry import check

ZENER = FractionalZener(stiffening=12.0, tau=2e-4, alpha=0.7)
MAXWELL = GeneralizedMaxwell((0.6, 2.5, 1.2), (4e-3, 4e-4, 4e-5))


def lossy_chain(ratio: ModulusRatio, count: int = 80, lowest: float = 100.0) -> Operators:
    """Equal masses on equal springs between walls; the lowest mode at rest has ``lowest`` Hz.

    All springs have one complex modulus, so that every mode is an oscillator of one degree of
    freedom: omega_j^2 g(Omega) = Omega^2 with omega_j = omega_0 sin(j x)/sin(x),
    x = pi/(2 count + 2).
    """
    side = -np.ones(count - 1)
    springs = csr_matrix(diags([side, 2.0 * np.ones(count), side], [-1, 0, 1]))
    least = 2.0 * np.sin(0.5 * np.pi / (count + 1))
    stiffness = (2.0 * np.pi * lowest / least) ** 2 * springs
    return dry_operators(
        stiffness=stiffness, mass=csr_matrix(eye(count)), free=np.ones(count, dtype=bool),
        displacements=count, loss={"springs": Lossy(stiffness, ratio)},
    )  # fmt: skip


def chain_mode(ratio: ModulusRatio, lowest: float = 100.0) -> complex:
    """Omega [rad/s] of the lowest mode as the iteration on the full system finds it."""
    operators = lossy_chain(ratio, lowest=lowest)
    near = complex(oscillator_mode(2.0 * np.pi * lowest, ratio)).real / (2.0 * np.pi)
    real = dry_modes(operators, 1.5 * near, moduli_at=near)
    found = complex_modes(operators, real, (0.0, 1.5 * near))
    return complex(found.omega[0])


for _name, _model, _exact in (
    ("zener", ZENER, oscillator_mode(200.0 * np.pi, ZENER)),
    ("maxwell", MAXWELL, maxwell_mode(200.0 * np.pi, MAXWELL)),
):
    _what = "one degree of freedom, omega_0^2 g(Omega) = Omega^2"

    @check(f"acoustics/complex-mode-{_name}-frequency",
           quantity=f"frequency of a mode with a {_name} modulus [Hz]", source=_what,
           reference=_exact.real / (2.0 * np.pi), tolerance=1e-6 * _exact.real)  # fmt: skip
    def _mode_frequency(model: ModulusRatio = _model) -> float:
        return chain_mode(model).real / (2.0 * np.pi)

    @check(f"acoustics/complex-mode-{_name}-loss", quantity=f"its loss factor ({_name})",
           reference=2.0 * _exact.imag / _exact.real, source=_what, tolerance=1e-6)  # fmt: skip
    def _mode_loss(model: ModulusRatio = _model) -> float:
        omega = chain_mode(model)
        return 2.0 * omega.imag / omega.real


def wide_band_error(ratio: ModulusRatio, band: tuple[float, float], count: int = 24) -> float:
    """Largest relative error of a reduced model's modes in a band from the oscillators' [rad/s]."""
    operators = lossy_chain(ratio, count)
    space = Projection(operators)
    space.extend(np.eye(count))
    model = ReducedModel(operators, space, np.ones(count), space.size)
    frequency, loss = model.light_modes(band)
    x = np.pi / (2 * count + 2)
    natural = 200.0 * np.pi * np.sin(np.arange(1, count + 1) * x) / np.sin(x)
    exact = np.array([oscillator_mode(float(w), ratio) for w in natural]) / (2.0 * np.pi)
    exact = exact[(exact.real >= band[0]) & (exact.real < band[1])]
    if len(exact) != len(frequency):
        raise ValueError(f"{len(frequency)} modes where there are {len(exact)}")
    return float(np.abs(frequency * (1.0 + 0.5j * loss) / exact - 1.0).max())


@check("acoustics/zener-modes-wide-band", reference=0.0, tolerance=1e-9,
       quantity="largest relative error of a reduced model's damped modes from 100 to 1000 Hz, "
       "fractional Zener modulus",
       source="one degree of freedom each, omega_j^2 g(Omega) = Omega^2")  # fmt: skip
def zener_wide_band() -> float:
    """Loss factors of 0.06 to 0.09: the modulus changes by a fifth over the band."""
    return wide_band_error(FractionalZener(1.4, 1e-3, 0.6), (100.0, 1000.0))


@check("acoustics/zener-loss-maximum", quantity="largest loss factor of a fractional Zener model",
       reference=float((12.0 - 1.0) * np.sin(0.35 * np.pi)
                       / (2.0 * np.sqrt(12.0) + 13.0 * np.cos(0.35 * np.pi))),
       source="Pritz 1996, eta_max = (r - 1) sin(a pi/2)/(2 sqrt r + (r + 1) cos(a pi/2))",
       tolerance=1e-6)  # fmt: skip
def zener_maximum() -> float:
    """On a fine grid around omega tau = r^(-1/(2 alpha))."""
    centre = 12.0 ** (-1.0 / 1.4) / 2e-4 / (2.0 * np.pi)
    values = modulus_ratio(ZENER, centre * np.logspace(-0.5, 0.5, 2001))
    return float(np.max(values.imag / values.real))


@check("acoustics/maxwell-fit-of-zener", reference=0.0, tolerance=0.03,
       quantity="largest relative error of a fitted Maxwell model of a fractional Zener material",
       source="the fractional Zener model, 1 Hz to 10 kHz, 2 branches per decade")  # fmt: skip
def maxwell_fit() -> float:
    """Fit on 60 points."""
    frequency = np.logspace(0.0, 4.0, 60)
    return fit_maxwell(frequency, 1e6 * modulus_ratio(ZENER, frequency)).error


@cache
def zener_sweep() -> tuple[FloatArray, FloatArray, FloatArray]:
    """Level differences [dB], estimates [dB] and balance of a reduced sweep with that modulus."""
    plate = WetPlate(ratio=FractionalZener(1.4, 1e-3, 0.6))
    operators = plate.operators
    load = operators.right_hand_side(pressure_force(plate.fem, 1.0))
    solver = make_solver(precision="double", tolerance=1e-12)
    sweep = reduce_system(
        operators, load, np.linspace(40.0, 260.0, 45), tolerance=1e-3, solver=solver
    )
    held_out = np.array([47.3, 91.0, 127.7, 183.2, 251.9])
    omega = 2.0 * np.pi * held_out
    exact = power_budget(operators, omega, solve_all(operators, held_out, load[None])[:, 0], load)
    error = 10.0 * np.log10(sweep.model.radiated(omega) / exact.radiated)
    return error, sweep.estimate(held_out), exact.residual


@check("acoustics/zener-reduced-sweep", reference=0.0, tolerance=1e-3,
       quantity="largest error of a reduced sweep with a fractional Zener modulus [dB]",
       source="direct solutions at frequencies that the sweep did not see")  # fmt: skip
def zener_reduced() -> float:
    """Five held-out frequencies."""
    return float(np.abs(zener_sweep()[0]).max())


@check("acoustics/zener-power-balance", reference=0.0, tolerance=1e-8,
       quantity="power balance with a fractional Zener modulus",
       source="conservation of energy")  # fmt: skip
def zener_balance() -> float:
    """Of the direct solutions."""
    return float(zener_sweep()[2].max())


STRIP = StripInStream()


@cache
def strip_modes() -> WetModes:
    """Real modes of the strip."""
    return dry_modes(STRIP.operators, 60.0)


# The plate's sections do not stay perfectly plane, and a strip averages over its width.
@check("acoustics/stream-damping-bending", reference=1.0, tolerance=3e-3,
       quantity="loss factor by the stream over W/(b omega), first bending",
       source="closed form, the mass being that of the water around a section")  # fmt: skip
def stream_bending() -> float:
    """By the functionals of the strips."""
    modes = strip_modes()
    return float((stream_loss(STRIP.operators, modes) / STRIP.loss(modes.frequency))[0])


@check("acoustics/stream-damping-complex", reference=1.0, tolerance=3e-3,
       quantity="loss factor of the damped mode over W/(b omega), W = 4 mm/s",
       source="closed form, the mass being that of the water around a section")  # fmt: skip
def stream_complex() -> float:
    """By the auxiliary unknowns in the complex modes."""
    slow = StripInStream(speed=4e-3)
    modes = dry_modes(slow.operators, 10.0)
    # rounding in a stiffness that is 1e10 times that of the mode limits the residual
    damped = complex_modes(slow.operators, modes, (1.0, 10.0), tolerance=1e-5)
    return float((damped.loss_factor / slow.loss(damped.frequency))[0])
