# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several excitations at once: amplitudes over frequency, and random ones (theory: S2-76)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Literal

import numpy as np
from scipy.integrate import quad

from quietblade.typing import AnyArray, ComplexArray, FloatArray

Correlation = Literal["none", "full"]


@dataclass(frozen=True, eq=False)
class Spectrum:
    """Values over frequency, straight in between.

    Attributes
    ----------
    frequency : (k,) array
        Ascending [Hz].
    value : (k,) array
        Complex amplitudes, or real densities.
    """

    frequency: FloatArray
    value: AnyArray

    def __post_init__(self) -> None:
        f = np.asarray(self.frequency, dtype=float)
        if f.ndim != 1 or f.shape != np.shape(self.value) or len(f) < 2 or np.any(np.diff(f) <= 0):
            raise ValueError(
                "a spectrum needs two or more ascending frequencies and a value for each"
            )

    def __call__(self, frequency: FloatArray) -> AnyArray:
        """Values at frequencies (f,) [Hz]; raises `ValueError` outside the table."""
        f, known = np.atleast_1d(frequency), np.asarray(self.frequency)
        if np.any(f < known[0]) or np.any(f > known[-1]):
            raise ValueError(
                f"the spectrum of an excitation covers {known[0]:g} to {known[-1]:g} Hz, but "
                f"{f.min():g} to {f.max():g} Hz are wanted; extend it"
            )
        return np.asarray(np.interp(f, known, np.asarray(self.value)))


@dataclass(frozen=True, eq=False)
class Excitation:
    """One harmonic or random load.

    Attributes
    ----------
    name : str
    vector : (n,) array
        Load of a unit amplitude on the unknowns.
    amplitude : complex or Spectrum
        Factor of the vector; for a random load its one-sided power spectral density
        [unit^2 / Hz], not negative.
    """

    name: str
    vector: AnyArray
    amplitude: complex | Spectrum = field(default=1.0)

    def at(self, frequency: FloatArray) -> ComplexArray:
        """Amplitude or density at frequencies (f,) [Hz]."""
        if isinstance(self.amplitude, Spectrum):
            return np.asarray(self.amplitude(frequency), dtype=complex)
        return np.full(len(np.atleast_1d(frequency)), complex(self.amplitude))


def load_vectors(excitations: Sequence[Excitation]) -> AnyArray:
    """Vectors of all excitations, (k, n), to be solved for side by side."""
    return np.stack([excitation.vector for excitation in excitations])


def harmonic_amplitudes(excitations: Sequence[Excitation], frequency: FloatArray) -> ComplexArray:
    """Amplitudes of all excitations, (f, k)."""
    return np.stack([excitation.at(frequency) for excitation in excitations], axis=1)


def superposed(amplitude: AnyArray, response: ComplexArray) -> ComplexArray:
    """Responses (f, ...) to amplitudes (f, k), from those to a unit of each one, (f, k, ...)."""
    return np.asarray(np.einsum("fk,fk...->f...", amplitude, response))


def spectral_matrix(
    excitations: Sequence[Excitation], frequency: FloatArray, correlation: Correlation
) -> ComplexArray:
    """Cross-spectral densities of random excitations, (f, k, k) [unit^2 / Hz].

    Parameters
    ----------
    excitations : sequence of Excitation
        Their amplitudes are densities.
    frequency : (f,) array
        [Hz]
    correlation : {"none", "full"}
        Independent of each other, or all in phase with each other.

    Raises
    ------
    ValueError
        If a density is negative.
    """
    density = harmonic_amplitudes(excitations, frequency)
    if np.any(density.real < 0.0) or np.any(density.imag != 0.0):
        raise ValueError("a power spectral density must be real and not negative")
    if correlation == "none":
        return np.asarray(density[:, :, None] * np.eye(density.shape[1]))
    root = np.sqrt(density)
    return np.asarray(root[:, :, None] * root[:, None, :])


def independent_parts(
    excitations: Sequence[Excitation], frequency: FloatArray, correlation: Correlation | None
) -> ComplexArray:
    """Harmonic amplitudes whose powers add up to those of all excitations, (j, f, k).

    Harmonic loads are one part.  Random ones have the densities of harmonic loads with the peak
    amplitudes sqrt(2 G) [unit / sqrt(Hz)]: each a part of its own if they are independent, all one
    part if they are in phase (theory: S2-77).

    Parameters
    ----------
    excitations : sequence of Excitation
        Their amplitudes are densities, if a correlation is given.
    frequency : (f,) array
        [Hz]
    correlation : {"none", "full"} or None
        None for harmonic loads.

    Raises
    ------
    ValueError
        If a density is negative or complex.
    """
    amplitude = harmonic_amplitudes(excitations, frequency)
    if correlation is None:
        return amplitude[None]
    if np.any(amplitude.real < 0.0) or np.any(amplitude.imag != 0.0):
        raise ValueError("a power spectral density must be real and not negative")
    peak = np.sqrt(2.0 * amplitude)
    if correlation == "full":
        return peak[None]
    return np.asarray(peak[None] * np.eye(len(excitations))[:, None, :])


def response_density(transfer: ComplexArray, density: ComplexArray) -> FloatArray:
    """Power spectral density of a response, sum_jk H_j G_jk H_k^* (theory: S2-77).

    Parameters
    ----------
    transfer : (f, k) or (f, k, ...) array
        Response per unit amplitude of each excitation.
    density : (f, k, k) array
        `spectral_matrix`.

    Returns
    -------
    (f, ...) array
        [response unit^2 / Hz], of the mean square.
    """
    return np.asarray(np.einsum("fj...,fjk,fk...->f...", transfer, density, transfer.conj()).real)


def power_density(power: Callable[[AnyArray], FloatArray], density: ComplexArray) -> FloatArray:
    """Spectral density of a power [W/Hz] under random excitations (theory: S2-77).

    A random load is a sum of independent harmonic ones, the columns of a square root of the matrix
    of densities, each with the mean square of one and hence the peak of sqrt(2).

    Parameters
    ----------
    power : callable
        Powers (f,) of harmonic excitations with peak amplitudes (f, k).
    density : (f, k, k) array
        `spectral_matrix`.
    """
    values, vectors = np.linalg.eigh(density)
    roots = vectors * np.sqrt(2.0 * np.maximum(values, 0.0))[:, None, :]
    return np.asarray(sum(power(roots[:, :, j]) for j in range(roots.shape[2])))


def band_integral(
    density: Callable[[FloatArray], FloatArray],
    band: tuple[float, float],
    resonances: FloatArray,
    losses: FloatArray,
    *,
    accuracy: float = 1e-8,
) -> float:
    """Integral of a spectral density over a band, its needles included.

    Parameters
    ----------
    density : callable
        Values (f,) at frequencies (f,) [Hz], as a reduced model gives them.
    band : (float, float)
        [Hz]
    resonances, losses : (m,) arrays
        Frequencies [Hz] and loss factors of the damped modes: the integral is split around them.
    accuracy : float
        Relative, of each part.
    """
    spread = np.array([-100.0, -10.0, -3.0, -1.0, 0.0, 1.0, 3.0, 10.0, 100.0])
    widths = np.maximum(np.abs(losses), 1e-9) * resonances
    cuts = (np.asarray(resonances)[:, None] + spread * np.reshape(widths, (-1, 1))).ravel()
    inside = cuts[(cuts > band[0]) & (cuts < band[1])]
    edges = np.unique([band[0], *inside, band[1]])
    total = 0.0
    for low, high in pairwise(edges):
        part, _ = quad(
            lambda f: float(density(np.array([f]))[0]), low, high, epsabs=0.0, epsrel=accuracy,
            limit=200,
        )  # fmt: skip
        total += part
    return float(total)
