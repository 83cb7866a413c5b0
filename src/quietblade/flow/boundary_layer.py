# SPDX-License-Identifier: LGPL-2.1-or-later
"""Integral boundary layer under a given edge speed: laminar, transition, turbulent.

One way: the layer does not change the flow that drives it. That serves attached layers and tells
where they separate; it says little about the flow after that.
"""

from dataclasses import dataclass

import numpy as np

from quietblade.flow import boundary_layer_closure as closure
from quietblade.typing import BoolArray, FloatArray, IntArray

STAGNATION_SHAPE = 2.216
"""Shape factor of the plane stagnation point (Hiemenz 1911)."""

LAMINAR_SEPARATION = 3.9
"""Shape factor at which a laminar layer counts as separated, a little ahead of the singularity."""

TURBULENT_SEPARATION = 2.4
"""Shape factor at which a turbulent layer counts as separated."""

INITIAL_SHAPE = 2.0
"""Shape factor of the turbulent layer at transition: it has not yet its equilibrium value."""

BUBBLE_SHAPE = 2.5
"""Mean shape factor while the pressure recovers at the end of a separation bubble."""

_SUBSTEPS = 2


@dataclass(frozen=True, eq=False)
class Layer:
    """Boundary layers on B sides, from the stagnation point on; lengths in chords.

    Attributes
    ----------
    arc, speed : array (B, S)
        Arc length from the stagnation point, edge speed / stream speed at the stations.
    momentum_thickness, shape, friction : array (B, S)
        Momentum thickness, shape factor H, friction coefficient on the local edge speed.
    transition : array (B,)
        Arc length of transition; nan if the side is laminar to its end.
    laminar_separation : array (B,)
        Arc length where the laminar layer separates ahead of transition; nan if it does not.
    bubble_reynolds : array (B,)
        Reynolds number of the displacement thickness and the edge speed there; nan without.
    separation : array (B,)
        Arc length where the turbulent layer separates, or the laminar one that never becomes
        turbulent; nan if attached.
    """

    arc: FloatArray
    speed: FloatArray
    momentum_thickness: FloatArray
    shape: FloatArray
    friction: FloatArray
    transition: FloatArray
    laminar_separation: FloatArray
    bubble_reynolds: FloatArray
    separation: FloatArray

    def drag(self) -> FloatArray:
        """Profile drag coefficient (B,) of each side by Squire and Young (theory: S1-77)."""
        theta, speed = self.momentum_thickness[:, -1], self.speed[:, -1]
        shape = np.minimum(self.shape[:, -1], closure.LARGEST_SHAPE)
        result: FloatArray = 2.0 * theta * speed ** (0.5 * (shape + 5.0))
        return result


def march_layer(
    arc: FloatArray,
    speed: FloatArray,
    gradient: FloatArray,
    reynolds: FloatArray | float,
    *,
    n_crit: float = 9.0,
    trip: FloatArray | float = np.inf,
) -> Layer:
    """March boundary layers along B sides.

    Laminar by the momentum and the kinetic-energy equation (theory: S1-73), transition where the
    strongest disturbance has grown by ``exp(n_crit)`` or at ``trip`` (S1-74), turbulent by the
    momentum equation and Head's entrainment (S1-75). Beyond laminar separation the edge speed is
    held until transition, as over a short bubble; then the pressure recovers at once (S1-76).

    Parameters
    ----------
    arc, speed, gradient : array (B, S)
        Arc length from the origin of the layer, rising; edge speed in units of the stream,
        positive except at the origin, and its derivative.
    reynolds : float or array (B,)
        Of the stream and the unit of length.
    n_crit : float
        9 is a quiet stream; Mack: n = -8.43 - 2.4 ln(turbulence intensity).
    trip : float or array (B,)
        Arc length of a forced transition.

    Returns
    -------
    Layer
    """
    arc, speed, gradient = (np.asarray(a, dtype=np.float64) for a in (arc, speed, gradient))
    sides = len(arc)
    viscosity = 1.0 / np.broadcast_to(np.asarray(reynolds, dtype=np.float64), sides)
    forced = np.broadcast_to(np.asarray(trip, dtype=np.float64), sides)

    laminar = _march_laminar(arc, speed, gradient, viscosity)
    turned = (laminar.exponent >= n_crit) | (arc >= forced[:, None])
    # A turbulent layer cannot begin with no thickness.
    turned[:, 0] = False
    first = np.where(turned.any(axis=1), np.argmax(turned, axis=1), arc.shape[1])
    transition = np.minimum(_crossing(arc, laminar.exponent, n_crit), forced)
    transition = np.where(first < arc.shape[1], transition, np.nan)

    behind = np.arange(arc.shape[1]) >= first[:, None]
    bubble = laminar.separated & ~behind
    theta, shape = _march_turbulent(arc, speed, gradient, viscosity, first, laminar)
    reynolds_theta = speed * theta / viscosity[:, None]
    stalled = behind & (shape >= TURBULENT_SEPARATION)
    unclosed = laminar.separated & np.isnan(transition)[:, None]
    friction = np.where(
        behind,
        closure.turbulent_friction(shape, reynolds_theta),
        2.0 * closure.laminar_shear(shape) / np.maximum(reynolds_theta, 1e-12),
    )
    at_bubble = _first_value(bubble, reynolds_theta * shape)
    return Layer(
        arc=arc,
        speed=speed,
        momentum_thickness=theta,
        shape=shape,
        friction=friction,
        transition=transition,
        laminar_separation=_first_value(bubble, arc),
        bubble_reynolds=at_bubble,
        separation=_first_value(stalled | unclosed, arc),
    )


@dataclass(frozen=True, eq=False)
class _Laminar:
    """Laminar layers, followed to the end of the side (B, S); speed with the held part."""

    theta: FloatArray
    shape: FloatArray
    exponent: FloatArray
    separated: BoolArray
    speed: FloatArray


def _march_laminar(
    arc: FloatArray, speed: FloatArray, gradient: FloatArray, viscosity: FloatArray
) -> _Laminar:
    step = np.diff(arc, axis=1)
    shape = np.full(len(arc), STAGNATION_SHAPE)
    origin = closure.laminar_shear(shape) / ((shape + 2.0) * np.maximum(gradient[:, 0], 1e-12))
    square = viscosity * origin  # of the momentum thickness
    # A layer that begins at an edge, not at a stagnation point, begins with no thickness.
    square = np.where(speed[:, 0] > 0.0, 0.0, square)
    shape = np.where(speed[:, 0] > 0.0, _PLATE_SHAPE, shape)
    energy = np.full(len(arc), closure.LEAST_ENERGY)
    separated = np.zeros(len(arc), dtype=bool)
    exponent, held = np.zeros(len(arc)), speed[:, 0]
    history = [(np.sqrt(square), shape, exponent, separated, held)]
    for k in range(arc.shape[1] - 1):
        h, before = step[:, k], held
        held = np.where(separated, held, speed[:, k + 1])
        slope = np.where(separated, 0.0, gradient[:, k + 1])
        square = _momentum(square, shape, before, held, viscosity, h)
        attached = _implicit_shape(shape, held, slope, square, viscosity, h)
        # Under a constant pressure the energy of a separated layer only grows.
        surplus = closure.laminar_dissipation(shape) - closure.laminar_shear(shape)
        rate = viscosity / (held * square) * surplus
        energy = np.where(separated, energy * (1.0 + h * rate), energy)
        energy = np.minimum(energy, _LARGEST_ENERGY)
        free = closure.separated_shape(energy)
        leaves = ~separated & (attached >= LAMINAR_SEPARATION)
        shape = np.where(separated | leaves, free, attached)
        separated = separated | leaves
        theta = np.sqrt(square)
        growth = closure.disturbance_growth(shape, held * theta / viscosity)
        exponent = exponent + growth / theta * h
        history.append((theta, shape, exponent, separated, held))
    columns = [np.stack(column, axis=1) for column in zip(*history, strict=True)]
    return _Laminar(*columns)


_LEAST_HEAD = closure.LEAST_ENTRAINMENT + 0.01

_LARGEST_ENERGY = 1.6
"""Energy shape factor (H = 12) beyond which the relations mean nothing."""

_PLATE_SHAPE = 2.569
"""Shape factor at which the closure's flat plate is in equilibrium (Blasius: 2.591)."""


def _momentum(
    square: FloatArray,
    shape: FloatArray,
    before: FloatArray,
    after: FloatArray,
    viscosity: FloatArray,
    step: FloatArray,
) -> FloatArray:
    """Square of the momentum thickness after a step, exact for constant H and linear speed."""
    power = 2.0 * shape + 4.0
    ratio = before / after
    decay = ratio**power
    away = 1.0 - ratio
    small = np.abs(away) < 1e-8
    mean = np.where(small, 1.0, (1.0 - decay) / (power * np.where(small, 1.0, away)))
    grown = square * decay + 2.0 * viscosity * closure.laminar_shear(shape) * step / after * mean
    return np.asarray(np.maximum(grown, 0.25 * square), dtype=np.float64)


def _implicit_shape(
    shape: FloatArray,
    speed: FloatArray,
    gradient: FloatArray,
    square: FloatArray,
    viscosity: FloatArray,
    step: FloatArray,
) -> FloatArray:
    """Shape factor after an implicit step of the energy equation, which is stiff at the nose."""

    def rate(h: FloatArray) -> FloatArray:
        energy = closure.laminar_energy(h)
        slope = (closure.laminar_energy(h + 1e-4) - energy) / 1e-4
        surplus = closure.laminar_dissipation(h) - closure.laminar_shear(h)
        source = viscosity * surplus / square + (h - 1.0) * gradient
        result: FloatArray = energy / slope * source / speed
        return result

    h = np.minimum(shape, LAMINAR_SEPARATION)
    now = rate(h)
    stiffness = np.minimum((rate(h + 1e-3) - now) / 1e-3, 0.0)
    # Layers thinner than that of a stagnation point do not occur; the start must not overshoot.
    return np.asarray(np.maximum(h + step * now / (1.0 - step * stiffness), 2.0), dtype=np.float64)


def _march_turbulent(
    arc: FloatArray,
    speed: FloatArray,
    gradient: FloatArray,
    viscosity: FloatArray,
    first: IntArray,
    laminar: _Laminar,
) -> tuple[FloatArray, FloatArray]:
    """Momentum thickness and shape factor (B, S), turbulent from the stations ``first`` on."""
    theta, shape = laminar.theta.copy(), laminar.shape.copy()
    thick = np.zeros(len(arc))
    begin = closure.entrainment_shape(np.array(INITIAL_SHAPE))
    head = np.full(len(arc), float(begin))
    for k in range(int(first.min()), arc.shape[1]):
        starts, runs = np.equal(first, k), np.less(first, k)
        if k > 0 and runs.any():
            thick, head = _turbulent_step(thick, head, k, arc, speed, gradient, viscosity, runs)
        if starts.any():
            # The pressure that a bubble has held recovers; momentum is kept.
            held = np.where(laminar.separated[:, k], laminar.speed[:, k], speed[:, k])
            recovery = (held / np.maximum(speed[:, k], 1e-12)) ** (BUBBLE_SHAPE + 2.0)
            thick = np.where(starts, laminar.theta[:, k] * recovery, thick)
            head = np.where(starts, begin, head)
        on = starts | runs
        theta[:, k] = np.where(on, thick, theta[:, k])
        shape[:, k] = np.where(on, closure.turbulent_shape(head), shape[:, k])
    return theta, shape


def _turbulent_step(
    theta: FloatArray,
    head: FloatArray,
    k: int,
    arc: FloatArray,
    speed: FloatArray,
    gradient: FloatArray,
    viscosity: FloatArray,
    runs: BoolArray,
) -> tuple[FloatArray, FloatArray]:
    """One step from station k - 1 to k, by Heun's method."""
    h = (arc[:, k] - arc[:, k - 1]) / _SUBSTEPS
    safe = np.where(runs, theta, 1.0)
    for part in range(_SUBSTEPS):
        near, far = part / _SUBSTEPS, (part + 1) / _SUBSTEPS
        u, du = _between(speed, k, near), _between(gradient, k, near)
        a, b = _turbulent_rates(safe, head, u, du, viscosity)
        u, du = _between(speed, k, far), _between(gradient, k, far)
        guess, middle = np.maximum(safe + h * a, 1e-9), np.maximum(head + h * b, _LEAST_HEAD)
        c, d = _turbulent_rates(guess, middle, u, du, viscosity)
        safe = np.maximum(safe + 0.5 * h * (a + c), 1e-9)
        head = np.maximum(head + 0.5 * h * (b + d), _LEAST_HEAD)
    return np.where(runs, safe, theta), head


def _between(field: FloatArray, k: int, weight: float) -> FloatArray:
    """Value between the stations k - 1 and k."""
    return np.asarray((1.0 - weight) * field[:, k - 1] + weight * field[:, k], dtype=np.float64)


def _turbulent_rates(
    theta: FloatArray,
    head: FloatArray,
    speed: FloatArray,
    gradient: FloatArray,
    viscosity: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    speed = np.maximum(speed, 1e-6)
    shape = closure.turbulent_shape(head)
    friction = closure.turbulent_friction(shape, speed * theta / viscosity)
    rise = 0.5 * friction - (shape + 2.0) * theta / speed * gradient
    change = (closure.entrainment_rate(head) - head * (rise + theta / speed * gradient)) / theta
    return rise, change


def _crossing(arc: FloatArray, values: FloatArray, limit: float) -> FloatArray:
    """Arc length where rising values first reach the limit, linear between stations; or inf."""
    above = values >= limit
    k = np.maximum(np.argmax(above, axis=1), 1)
    row = np.arange(len(arc))
    low, high = values[row, k - 1], values[row, k]
    fraction = (limit - low) / np.where(high > low, high - low, 1.0)
    place = arc[row, k - 1] + fraction * (arc[row, k] - arc[row, k - 1])
    return np.where(above.any(axis=1), place, np.inf)


def _first_value(where: BoolArray, values: FloatArray) -> FloatArray:
    """Value at the first station of each side at which the condition holds; nan without."""
    taken = np.take_along_axis(values, np.argmax(where, axis=1)[:, None], axis=1)[:, 0]
    return np.where(where.any(axis=1), taken, np.nan)
