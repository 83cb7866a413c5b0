# SPDX-License-Identifier: LGPL-2.1-or-later
r"""Fixed points :math:`x = G(x)` of arrays: iterations, their rate and their true error.

Nothing here knows of blades: G maps an array to an array of the same shape. The pairs
:math:`(x_j, G(x_j))` of an iteration tell three things: where to try next (Aitken, Anderson), which
eigenvalues the linearised G has (theory: S1-92), and how far the fixed point still is
(theory: S1-93).
"""

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, Protocol

import numpy as np
from scipy.linalg import lstsq

from quietblade.typing import AnyArray, FloatArray

# A difference of which less than this share is new tells nothing but rounding.
_NOTHING_NEW = 1e-4

# Accelerated steps are not longer than this many times the change of one pass.
_LONGEST_STEP = 50.0

# A change that has grown to this many times the smallest one means a wrong acceleration.
_WORSE = 4.0

# The part of a change that no pair describes is taken to shrink at least a little.
_SLOWEST = 0.95

Map = Callable[[FloatArray], FloatArray]


class SecantModel:
    r"""Linear model J of a map in the span of a few steps (theory: S1-92).

    With the steps :math:`\Delta X` and the changes :math:`\Delta G` of the map along them,
    :math:`J = \Delta G\, \Delta X^+`.

    Parameters
    ----------
    steps, images : sequence of arrays (n,)
        Columns of :math:`\Delta X` and :math:`\Delta G`, the most trustworthy first: steps that the
        ones before them nearly contain are left out.

    Attributes
    ----------
    kept : tuple of int
        Numbers of the steps in use.
    """

    def __init__(
        self, steps: Sequence[FloatArray], images: Sequence[FloatArray], noise: float = 0.0
    ) -> None:
        basis: list[FloatArray] = []
        kept: list[int] = []
        for number, step in enumerate(steps):
            rest = step
            for _ in range(2):  # twice is enough for orthogonality
                for q in basis:
                    rest = rest - (q @ rest) * q
            size, new = float(np.linalg.norm(step)), float(np.linalg.norm(rest))
            if new > max(_NOTHING_NEW * size, noise):
                basis.append(rest / new)
                kept.append(number)
        self.kept = tuple(kept)
        self._all_images = images
        self._basis = np.array(basis).T
        if kept:
            triangle = self._basis.T @ np.array([steps[k] for k in kept]).T
            self._inverse = np.linalg.inv(np.triu(triangle))
            self._images = np.array([images[k] for k in kept]).T
            self._small = self._basis.T @ self._images @ self._inverse

    @cached_property
    def eigenvalues(self) -> AnyArray:
        """Eigenvalues of the model, (steps in use,) complex, the largest first."""
        if not self.kept:
            return np.zeros(0, dtype=complex)
        values = np.linalg.eigvals(self._small).astype(complex)
        return np.asarray(values[np.argsort(-np.abs(values))])

    @property
    def dominant(self) -> complex:
        """Eigenvalue of largest modulus; nan without steps."""
        return complex(self.eigenvalues[0]) if self.kept else complex(np.nan)

    def completion(self, change: FloatArray, images: Sequence[FloatArray]) -> FloatArray:
        r"""Return what follows a change r, :math:`J (I - J)^{-1} r`.

        Parameters
        ----------
        change : ndarray, shape (n,)
        images : sequence of arrays
            Images of all steps, in these or in other unknowns; the result is in theirs.

        Returns
        -------
        ndarray
        """
        system = np.eye(len(self.kept)) - self._small
        weights = self._inverse @ lstsq(system, self._basis.T @ change)[0]
        used = np.array([images[k] for k in self.kept])
        return np.asarray(weights @ used)

    def image(self, step: FloatArray) -> FloatArray:
        """Apply the model: J times the part of a step that lies in its span."""
        if not self.kept:
            return np.zeros_like(step)
        return np.asarray(self._images @ (self._inverse @ (self._basis.T @ step)))

    def beyond(self, change: FloatArray, rate: float) -> float:
        r"""Norm of what follows a change r: :math:`\lVert J (I - J)^{-1} r\rVert`.

        The part of r outside the steps is taken to shrink by ``rate`` from pass to pass.
        """
        if not self.kept:
            return np.inf
        inside = float(np.linalg.norm(self.completion(change, self._all_images)))
        outside = change - self._basis @ (self._basis.T @ change)
        slow = min(rate, _SLOWEST)
        return inside + slow / (1.0 - slow) * float(np.linalg.norm(outside))


class Accelerator(Protocol):
    """Rule for the next array of an iteration; it remembers the pairs it has seen."""

    def propose(self, x: FloatArray, image: FloatArray) -> FloatArray:
        """Return the next x after the pair (x, G(x))."""


@dataclass
class Plain:
    """The plain iteration, or with a factor below 1 a relaxed one.

    Attributes
    ----------
    relaxation : float
        Share of the change that is taken.
    """

    relaxation: float = 1.0

    def propose(self, x: FloatArray, image: FloatArray) -> FloatArray:
        """Return the next x after the pair (x, G(x))."""
        return x + self.relaxation * (image - x)


@dataclass
class Aitken:
    r"""Aitken's factor from the last two changes r (Kuttler and Wall 2008; theory: S1-94).

    :math:`\omega \leftarrow -\omega\, r_{k-1}\cdot(r_k - r_{k-1}) / |r_k - r_{k-1}|^2`.

    Attributes
    ----------
    largest : float
        Bound of the factor's size.
    """

    largest: float = 20.0
    _factor: float = field(default=1.0, init=False)
    _last: FloatArray | None = field(default=None, init=False)

    def propose(self, x: FloatArray, image: FloatArray) -> FloatArray:
        """Return the next x after the pair (x, G(x))."""
        change = image - x
        if self._last is not None:
            difference = change - self._last
            size = float(difference @ difference)
            if size > 0.0:
                self._factor *= -float(self._last @ difference) / size
                self._factor = float(np.clip(self._factor, -self.largest, self.largest))
        self._last = change
        return x + self._factor * change


@dataclass
class Anderson:
    r"""Anderson's mixing of the last pairs, also known as IQN-ILS (theory: S1-95).

    Of all combinations of the last pairs whose weights sum to 1 take the one with the smallest
    change, and go to its image. The safeguards: pairs that bring nothing new are left out, the
    step is at most 50 times the change, and if the change grows to 4 times its smallest value,
    the iteration returns to the pair that had it and begins anew with half its change.

    Attributes
    ----------
    depth : int
        Largest number of differences.
    """

    depth: int = 5
    _pairs: list[tuple[FloatArray, FloatArray]] = field(default_factory=list, init=False)
    _best: tuple[float, FloatArray, FloatArray] | None = field(default=None, init=False)

    def propose(self, x: FloatArray, image: FloatArray) -> FloatArray:
        """Return the next x after the pair (x, G(x))."""
        change = image - x
        size = float(np.linalg.norm(change))
        if self._best is not None and len(self._pairs) > 2 and size > _WORSE * self._best[0]:
            _, x, image = self._best
            self._pairs = [(x, image)]
            return x + 0.5 * (image - x)
        if self._best is None or size < self._best[0]:
            self._best = (size, x, image)
        self._pairs = [*self._pairs[-self.depth :], (x, image)]
        step = change - self._mixed(change)
        length = float(np.linalg.norm(step))
        return x + step * min(1.0, _LONGEST_STEP * size / length if length > 0.0 else 1.0)

    def _mixed(self, change: FloatArray) -> FloatArray:
        changes = [b - a for a, b in self._pairs]
        drops = [new - old for old, new in itertools.pairwise(changes)][::-1]
        moves = [
            new[1] - old[1] for old, new in zip(self._pairs[:-1], self._pairs[1:], strict=True)
        ]
        model = SecantModel(drops, moves[::-1])
        return model.image(change)


@dataclass(frozen=True)
class Pass:
    """One pass of a fixed-point iteration.

    Attributes
    ----------
    iteration : int
        From 1.
    change : float
        ``|G(x) - x| / |x|``; infinite where x is zero.
    ratio : float
        Size of the change over that of the pass before; nan in the first.
    eigenvalue : complex
        Dominant eigenvalue of G's linearisation, as the pairs so far show it; nan in the first.
    error : float
        Estimate of the distance from G(x) to the fixed point, relative to G(x); infinite in the
        first pass.
    """

    iteration: int
    change: float
    ratio: float
    eigenvalue: complex
    error: float


@dataclass(frozen=True, eq=False)
class FixedPoint:
    """Result of `solve_fixed_point`.

    Attributes
    ----------
    x : ndarray
        The image of the last pass.
    converged : bool
    history : tuple of Pass
    """

    x: FloatArray
    converged: bool
    history: tuple[Pass, ...]

    @property
    def eigenvalue(self) -> complex:
        """Dominant eigenvalue at the end."""
        return self.history[-1].eigenvalue


Method = Literal["fixed-point", "aitken", "anderson"]
Stop = Literal["change", "error"]


def make_accelerator(method: Method, depth: int = 5) -> Accelerator:
    """Return the rule of a method's name; ``depth`` is Anderson's.

    Raises
    ------
    ValueError
        No such method.
    """
    if method == "fixed-point":
        return Plain()
    if method == "aitken":
        return Aitken()
    if method == "anderson":
        return Anderson(depth)
    raise ValueError(f"method {method!r}: use 'fixed-point', 'aitken' or 'anderson'")


def iterate(
    image: Map, start: FloatArray, rule: Accelerator, *, depth: int = 5
) -> Iterator[tuple[Pass, FloatArray]]:
    """Yield pass after pass of an iteration, without end unless it runs out of numbers.

    Parameters
    ----------
    image : callable
        The map G.
    start : ndarray
        First x.
    rule : Accelerator
    depth : int
        Differences from which rate and error are estimated.

    Yields
    ------
    Pass, ndarray
        The pass, and G(x).
    """
    x = np.array(start, dtype=np.float64)
    pairs: list[tuple[FloatArray, FloatArray]] = []
    before, iteration = np.nan, 0
    while True:
        iteration += 1
        there = np.asarray(image(x), dtype=np.float64)
        if not np.isfinite(there).all():
            yield Pass(iteration, np.inf, np.inf, complex(np.nan), np.inf), there
            return
        pairs = [*pairs[-depth:], (x.ravel(), there.ravel())]
        change = (there - x).ravel()
        size = float(np.linalg.norm(change))
        model = model_of(pairs)
        ratio = size / before if before else np.nan
        error = model.beyond(change, ratio) if size > 0.0 else 0.0
        yield (
            Pass(
                iteration,
                relative(size, x),
                ratio,
                model.dominant,
                relative(error, there),
            ),
            there,
        )
        before = size
        x = rule.propose(x.ravel(), there.ravel()).reshape(x.shape)


def model_of(pairs: Sequence[tuple[FloatArray, FloatArray]]) -> SecantModel:
    """Linear model of a map from pairs (x, G(x)), the newest last."""
    steps = [new[0] - old[0] for old, new in itertools.pairwise(pairs)]
    images = [new[1] - old[1] for old, new in itertools.pairwise(pairs)]
    return SecantModel(steps[::-1], images[::-1])


def relative(size: float, x: FloatArray) -> float:
    """Size relative to the norm of x; infinite if x is zero and the size is not."""
    whole = float(np.linalg.norm(x))
    if whole > 0.0:
        return size / whole
    return 0.0 if size == 0.0 else np.inf


def solve_fixed_point(
    image: Map,
    start: FloatArray,
    *,
    method: Method = "anderson",
    tolerance: float = 1e-5,
    stop: Stop = "error",
    max_iterations: int = 200,
    depth: int = 5,
) -> FixedPoint:
    """Iterate until the change, or the estimated true error, falls below the tolerance.

    Parameters
    ----------
    image : callable
        The map G, from an array to one of the same shape.
    start : ndarray
        First x.
    method : {"fixed-point", "aitken", "anderson"}
    tolerance : float
        Relative to the norm of x.
    stop : {"error", "change"}
        What the tolerance is for. The plain iteration stops too early by the change where the
        rate is near 1.
    max_iterations : int
    depth : int
        Pairs that Anderson and the estimates remember.

    Returns
    -------
    FixedPoint

    Raises
    ------
    ValueError
        Unknown method.
    """
    history: list[Pass] = []
    for line, there in iterate(image, start, make_accelerator(method, depth), depth=depth):
        history.append(line)
        x = there
        done = (line.change if stop == "change" else line.error) < tolerance
        if done or line.iteration == max_iterations or not np.isfinite(there).all():
            break
    return FixedPoint(x, done, tuple(history))
