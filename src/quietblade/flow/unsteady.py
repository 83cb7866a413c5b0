# SPDX-License-Identifier: LGPL-2.1-or-later
"""Damping of a section that vibrates in a stream.

Thin section in incompressible potential flow: T. Theodorsen, General theory of aerodynamic
instability and the mechanism of flutter, NACA Report 496 (1935).  What has a share of the speed of
the stream is here; the added mass, which has none, belongs to the water's own equations.
"""

import numpy as np
from scipy.special import hankel2

from quietblade.typing import AnyArray, ComplexArray, FloatArray

WHERE = 0.75
"""Chord fraction whose normal velocity the stream damps."""

SLOWEST = 3.0
"""Reduced frequency from which on C(k) is one half within 4 %."""


def theodorsen_function(k: AnyArray) -> ComplexArray:
    """C(k) = H1 / (H1 + i H0), Hankel functions of the second kind, for exp(+i omega t).

    Parameters
    ----------
    k : (n,) array
        Reduced frequency omega b / W, b the half chord; positive.

    Returns
    -------
    (n,) complex array
        From 1 (slow) to 1/2 (fast).
    """
    first, zeroth = hankel2(1, k), hankel2(0, k)
    return np.asarray(first / (first + 1j * zeroth))


def section_force(
    heave: complex, pitch: complex, omega: float, chord: float, speed: float, density: float
) -> tuple[complex, complex]:
    """Lift [N/m] and nose-up moment about mid-chord [N] of the stream (theory: S2-70).

    Parameters
    ----------
    heave, pitch : complex
        Amplitudes: mid-chord along the normal to the upper side [m], nose up [rad].
    omega : float
        Angular frequency [rad/s].
    chord, speed, density : float
        [m], of the stream normal to the span [m/s], of the water [kg/m3].
    """
    b, w, a = 0.5 * chord, 1j * omega * heave, 1j * omega * pitch
    wake = complex(theodorsen_function(np.array([omega * b / speed]))[0])
    bound = 2.0 * np.pi * density * speed * b * wake * (speed * pitch - w + 0.5 * b * a)
    apparent = np.pi * density * b**2 * speed * a
    return bound + apparent, 0.5 * b * (bound - apparent)


def damping_per_length(chord: AnyArray, speed: AnyArray, density: float) -> FloatArray:
    """Damping of the normal velocity at three quarters of the chord [kg/(m s)] (theory: S2-71).

    The limit of high reduced frequency, C = 1/2: the symmetric part of the damping that
    `section_force` has then is ``pi rho W b`` times the square of that one velocity, and cannot be
    negative.

    Parameters
    ----------
    chord, speed : (n,) arrays
        [m], and of the stream normal to the span [m/s].
    density : float
        [kg/m3]
    """
    return np.asarray(0.5 * np.pi * density * np.asarray(speed) * np.asarray(chord))
