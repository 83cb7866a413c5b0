# SPDX-License-Identifier: LGPL-2.1-or-later
"""Complex modulus over frequency: how stiff and how lossy a material is in small vibrations.

With exp(+i omega t) a modulus is G(omega) = G0 g(omega), G0 the static one that the strain energy
has, g = 1 at rest, Im g >= 0 for omega > 0 (a material that does not lose negative energy), and
loss factor eta = Im g / Re g (theory: S2-50).  Models are functions of complex omega near the
positive real axis, so that damped modes and Krylov vectors can use them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.optimize import nnls

from quietblade.errors import MaterialError
from quietblade.typing import AnyArray, ComplexArray, FloatArray

_FARTHEST = 30.0  # decades of frequency by which a temperature can shift a material
GAS_CONSTANT = 8.31446261815324  # J/(mol K), exact by the definition of the SI


class ModulusRatio(Protocol):
    """Complex modulus over the static one."""

    def __call__(self, omega: complex) -> complex:
        """Return g(omega) at an angular frequency [rad/s]."""
        ...


def loss_factor(ratio: ModulusRatio, frequency: FloatArray) -> FloatArray:
    """Loss factor Im g / Re g at frequencies [Hz]."""
    values = modulus_ratio(ratio, frequency)
    return np.asarray(values.imag / values.real)


def modulus_ratio(ratio: ModulusRatio, frequency: FloatArray) -> ComplexArray:
    """Values g at frequencies (f,) [Hz]."""
    return np.array([ratio(complex(2.0 * np.pi * f)) for f in np.atleast_1d(frequency)])


@dataclass(frozen=True)
class ConstantLoss:
    """g = 1 + i eta at every frequency, as in the paper.

    Attributes
    ----------
    eta : float
        Loss factor.
    """

    eta: float

    def __post_init__(self) -> None:
        _require(0.0 <= self.eta < np.inf, f"loss factor {self.eta:g} must not be negative")

    def __call__(self, omega: complex) -> complex:
        """Return g(omega)."""
        return 1.0 + 1j * self.eta


@dataclass(frozen=True)
class FractionalZener:
    """Four-parameter fractional derivative model.

    g = (1 + r (i omega tau)^alpha) / (1 + (i omega tau)^alpha), r = E_inf / E_0
    (R. L. Bagley, P. J. Torvik, J. Rheology 30 (1986) 133-155; T. Pritz, J. Sound Vib. 195 (1996)
    103-115).

    Attributes
    ----------
    stiffening : float
        r, the ratio of the moduli far above and far below 1 / tau; above 1.
    tau : float
        Relaxation time [s].
    alpha : float
        Order of the derivative, above 0 up to 1 (the standard linear solid).
    """

    stiffening: float
    tau: float
    alpha: float

    def __post_init__(self) -> None:
        _require(self.stiffening > 1.0, f"E_inf / E_0 = {self.stiffening:g} must exceed 1")
        _require(self.tau > 0.0, f"relaxation time {self.tau:g} s must be positive")
        _require(0.0 < self.alpha <= 1.0, f"order alpha = {self.alpha:g} must lie in ]0, 1]")

    def __call__(self, omega: complex) -> complex:
        """Return g(omega)."""
        z = complex(1j * omega * self.tau) ** self.alpha
        return (1.0 + self.stiffening * z) / (1.0 + z)


@dataclass(frozen=True)
class GeneralizedMaxwell:
    """Springs and dashpots side by side: g = 1 + sum_k g_k i omega tau_k / (1 + i omega tau_k).

    Attributes
    ----------
    strengths : tuple of float
        g_k, moduli of the branches over the static modulus; not negative.
    times : tuple of float
        tau_k, relaxation times [s]; positive.
    """

    strengths: tuple[float, ...]
    times: tuple[float, ...]

    def __post_init__(self) -> None:
        _require(
            len(self.strengths) == len(self.times) > 0,
            f"{len(self.strengths)} strengths and {len(self.times)} relaxation times",
        )
        _require(min(self.strengths) >= 0.0, "a branch with a negative modulus feeds energy")
        _require(min(self.times) > 0.0, "relaxation times must be positive")

    def __call__(self, omega: complex) -> complex:
        """Return g(omega)."""
        z = 1j * omega * np.asarray(self.times)
        return complex(1.0 + np.sum(np.asarray(self.strengths) * z / (1.0 + z)))


class Shift(Protocol):
    """Temperature shift of a thermorheologically simple material."""

    def factor(self, temperature: float) -> float:
        """Return a_T at a temperature [K]; the material answers at omega as at omega a_T."""
        ...


@dataclass(frozen=True)
class WlfShift:
    """Williams, Landel and Ferry: log10 a_T = -C1 (T - T0) / (C2 + T - T0).

    M. L. Williams, R. F. Landel, J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701-3707.

    Attributes
    ----------
    c1 : float
    c2 : float
        [K]
    reference : float
        T0 [K].
    """

    c1: float
    c2: float
    reference: float

    def factor(self, temperature: float) -> float:
        """Return a_T; raises `MaterialError` at or below T0 - C2, where it has no meaning."""
        above = temperature - self.reference
        _require(
            self.c2 + above > 0.0,
            f"the WLF shift ends at {self.reference - self.c2:g} K; {temperature:g} K is beyond",
        )
        return _shift(-self.c1 * above / (self.c2 + above), temperature)


@dataclass(frozen=True)
class ArrheniusShift:
    """ln a_T = (Q / R) (1 / T - 1 / T0).

    Attributes
    ----------
    energy : float
        Activation energy Q [J/mol].
    reference : float
        T0 [K].
    """

    energy: float
    reference: float

    def factor(self, temperature: float) -> float:
        """Return a_T."""
        for kelvin in (temperature, self.reference):
            _require(kelvin > 0.0, f"temperature {kelvin:g} K must be positive")
        turned = 1.0 / temperature - 1.0 / self.reference
        return _shift(self.energy / GAS_CONSTANT * turned / np.log(10.0), temperature)


@dataclass(frozen=True)
class Shifted:
    """A model at another temperature than that for which its constants were measured.

    Attributes
    ----------
    model : ModulusRatio
        At the reference temperature.
    factor : float
        a_T.
    """

    model: ModulusRatio
    factor: float

    def __post_init__(self) -> None:
        _require(0.0 < self.factor < np.inf, f"shift factor {self.factor:g} must be positive")

    def __call__(self, omega: complex) -> complex:
        """Return g(omega)."""
        return self.model(omega * self.factor)


@dataclass(frozen=True, eq=False)
class ModulusFit:
    """A generalised Maxwell model of measured points.

    Attributes
    ----------
    model : GeneralizedMaxwell
        The fit.
    static_modulus : float
        Its modulus at rest [Pa].
    frequency : (f,) array
        Where it was measured [Hz].
    measured, fitted : (f,) complex arrays
        Complex moduli [Pa].
    """

    model: GeneralizedMaxwell
    static_modulus: float
    frequency: FloatArray
    measured: ComplexArray
    fitted: ComplexArray

    @property
    def error(self) -> float:
        """Largest |fitted - measured| / |measured|."""
        return float(np.max(np.abs(self.fitted / self.measured - 1.0)))


def fit_maxwell(
    frequency: Sequence[float] | FloatArray,
    modulus: Sequence[complex] | ComplexArray,
    *,
    static_modulus: float | None = None,
    branches_per_decade: float = 2.0,
) -> ModulusFit:
    """Fit a generalised Maxwell model to measured complex moduli.

    Relaxation times are spread evenly (in the logarithm) over the measured band and half a decade
    beyond; their strengths follow from least squares of the relative error with the condition that
    none is negative.  Whatever the scatter of the points, the model is causal and passive.

    Parameters
    ----------
    frequency : (f,)
        [Hz], positive, at least two.
    modulus : (f,)
        Storage + i loss modulus [Pa].
    static_modulus : float, optional
        Modulus at rest [Pa], where it is known from elsewhere; else it is fitted too.
    branches_per_decade : float
        Density of relaxation times.

    Raises
    ------
    MaterialError
        The points cannot be those of a passive material, or are too few.
    """
    f, values = np.asarray(frequency, dtype=float), np.asarray(modulus, dtype=complex)
    _require(f.ndim == 1 and f.shape == values.shape and f.size >= 2, "two or more points needed")
    _require(bool(np.all(np.isfinite(f)) and np.all(f > 0.0)), "frequencies must be positive")
    _require(
        bool(np.all(np.isfinite(values)) and np.all(values.real > 0.0)),
        "storage moduli must be positive",
    )
    _require(bool(np.all(values.imag >= 0.0)), "loss moduli must not be negative")
    low, high = np.log10(f.min()) - 0.5, np.log10(f.max()) + 0.5
    count = max(2, round((high - low) * branches_per_decade) + 1)
    times = 1.0 / (2.0 * np.pi * np.logspace(low, high, count))
    z = 2j * np.pi * f[:, None] * times
    branches, spring = z / (1.0 + z), np.ones((f.size, 1))
    if static_modulus is None:
        strengths = _positive_fit(np.concatenate([spring, branches], axis=1), values, values)
        static, strengths = float(strengths[0]), strengths[1:]
        _require(static > 0.0, "the points leave no stiffness at rest; give the static modulus")
    else:
        static = static_modulus
        _require(static > 0.0, f"static modulus {static:g} Pa must be positive")
        strengths = _positive_fit(branches, values - static, values)
    kept = strengths > 0.0
    if not kept.any():
        kept[-1] = True  # no loss at all: a branch of no strength
    model = GeneralizedMaxwell(
        tuple((strengths[kept] / static).tolist()), tuple(times[kept].tolist())
    )
    return ModulusFit(model, static, f, values, static * modulus_ratio(model, f))


def _positive_fit(columns: AnyArray, wanted: AnyArray, size: ComplexArray) -> FloatArray:
    """Coefficients that are not negative, by least squares of the error relative to the size."""
    rows, target = columns / np.abs(size)[:, None], wanted / np.abs(size)
    strengths, _ = nnls(
        np.concatenate([rows.real, rows.imag]), np.concatenate([target.real, target.imag])
    )
    return np.asarray(strengths, dtype=np.float64)


def _shift(exponent: float, temperature: float) -> float:
    """10 to an exponent, refused where a temperature is beyond what a law of shift can mean."""
    _require(
        abs(exponent) < _FARTHEST,
        f"at {temperature:g} K the law of shift gives a factor of 1e{exponent:+.0f}: the "
        "temperature is outside its range",
    )
    return float(10.0**exponent)


def _require(holds: bool, message: str) -> None:
    if not holds:
        raise MaterialError(f"viscoelastic model: {message}")
