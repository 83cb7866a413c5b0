# SPDX-License-Identifier: LGPL-2.1-or-later
"""Direct sweep: one factorisation of A(omega) a frequency (theory: S2-7)."""

from collections import deque
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from time import perf_counter

import numpy as np

from quietblade.errors import SolverError
from quietblade.linalg import SolverChain, SolverReport, default_threads, make_solver
from quietblade.typing import AnyArray, ComplexArray, FloatArray, Progress, silent
from quietblade.vibroacoustics.operators import Operators

Observe = Callable[[float, ComplexArray], Mapping[str, AnyArray | complex]]
"""Called with a frequency [Hz] and its solution (n,) or (k, n); returns what is kept, by name."""


@dataclass(frozen=True, eq=False)
class Point:
    """Solution at one frequency.

    Attributes
    ----------
    frequency : float
        [Hz]
    solution : (n,) or (k, n) complex array, or None
        Displacement, film pressure and potential on the free unknowns; None if it failed.
    residual : float
        Worst ``||A x - b|| / ||b||``, nan if it failed.
    solver : str
        Solver and precision, empty if it failed.
    failure : str
        Why there is no solution, else empty.
    """

    frequency: float
    solution: ComplexArray | None
    residual: float
    solver: str
    failure: str = ""


@dataclass(frozen=True, eq=False)
class Response:
    """Harmonic response over frequency.

    Attributes
    ----------
    frequency : (f,) array
        [Hz], in the order asked for.
    solution : (f, n) or (f, k, n) complex array, or None
        Solutions, nan where a frequency failed; None if they were observed instead.
    observed : mapping of name to (f, ...) array
        What the observer kept, nan where a frequency failed.
    residual : (f,) array
        Worst ``||A x - b|| / ||b||`` at each frequency.
    failures : mapping of float to str
        Frequency and reason of each failed point.
    report : SolverReport
        What the solvers did.
    """

    frequency: FloatArray
    solution: ComplexArray | None
    observed: Mapping[str, AnyArray]
    residual: FloatArray
    failures: Mapping[float, str]
    report: SolverReport

    @property
    def omega(self) -> FloatArray:
        """Angular frequencies [rad/s]."""
        return 2.0 * np.pi * self.frequency


def sweep(
    operators: Operators,
    frequencies: FloatArray,
    load: AnyArray,
    *,
    solver: SolverChain | None = None,
    workers: int = 1,
    progress: Progress = silent,
) -> Iterator[Point]:
    """Solve A(omega) x = b at one frequency after the other.

    Parameters
    ----------
    operators : Operators
        The system.
    frequencies : (f,) array
        [Hz], in any order.
    load : (n,) or (k, n) array
        Right-hand sides on the free unknowns, the same at every frequency.
    solver : SolverChain, optional
        Symmetric; `make_solver` with the threads shared among the workers if left out.
    workers : int
        Frequencies in work at once, each with a factor of its own in memory.
    progress : Progress
        Called after each frequency with the time left.

    Yields
    ------
    Point
        In the order of the frequencies.  A frequency that cannot be solved is a point with a
        reason; it does not end the sweep.
    """
    if solver is None:
        solver = make_solver(threads=max(default_threads() // workers, 1))
    chain = solver
    start, total = perf_counter(), len(frequencies)
    waiting: deque[Future[Point]] = deque()
    left = iter(np.asarray(frequencies, dtype=float))
    with ThreadPoolExecutor(workers) as pool:
        for done in range(total):
            while len(waiting) < workers and (following := next(left, None)) is not None:
                waiting.append(pool.submit(solve_point, operators, float(following), load, chain))
            point = waiting.popleft().result()
            remaining = (perf_counter() - start) / (done + 1) * (total - done - 1)
            message = f"{point.frequency:.6g} Hz, {_duration(remaining)} left"
            progress("sweep", (done + 1) / total, message)
            yield point


def solve_point(
    operators: Operators, frequency: float, load: AnyArray, solver: SolverChain
) -> Point:
    """Factor and solve at one frequency [Hz]; a failure is a part of the point."""
    columns = load.T if load.ndim == 2 else load
    try:
        factor = solver.factor(operators.at(2.0 * np.pi * frequency))
        solution = np.ascontiguousarray(factor.solve(columns.astype(complex)).T)
    except SolverError as error:
        return Point(frequency, None, np.nan, "", str(error))
    return Point(frequency, solution, factor.residual, factor.solver)


def solve_response(
    operators: Operators,
    frequencies: FloatArray,
    load: AnyArray,
    *,
    observe: Observe | None = None,
    solver: SolverChain | None = None,
    workers: int = 1,
    progress: Progress = silent,
) -> Response:
    """Run a direct sweep and put its points side by side.

    Parameters
    ----------
    observe : callable, optional
        Reduces each solution to what is kept; the solutions themselves are then not stored.  It
        returns arrays of the same shapes at every frequency.
    operators, frequencies, load, solver, workers, progress
        As in `sweep`.

    Raises
    ------
    SolverError
        If no frequency could be solved.
    """
    if solver is None:
        solver = make_solver(threads=max(default_threads() // workers, 1))
    record = _Record(len(frequencies))
    points = sweep(operators, frequencies, load, solver=solver, workers=workers, progress=progress)
    for index, point in enumerate(points):
        record.residual[index] = point.residual
        if point.solution is None:
            record.failures[point.frequency] = point.failure
        elif observe is None:
            record.keep(index, {"": point.solution})
        else:
            record.keep(index, observe(point.frequency, point.solution))
    if len(record.failures) == len(frequencies) > 0:
        raise SolverError(
            f"sweep: none of {len(frequencies)} frequencies could be solved; the first: "
            f"{next(iter(record.failures.values()))}"
        )
    solution = record.kept.pop("", None)
    return Response(
        np.asarray(frequencies, dtype=float), solution, record.kept, record.residual,
        record.failures, solver.report(),
    )  # fmt: skip


@dataclass
class _Record:
    """Growing arrays of a response."""

    size: int
    kept: dict[str, AnyArray] = field(default_factory=dict)
    failures: dict[float, str] = field(default_factory=dict)
    residual: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        self.residual = np.full(self.size, np.nan)

    def keep(self, index: int, values: Mapping[str, AnyArray | complex]) -> None:
        for name, value in values.items():
            entry = np.asarray(value)
            if name not in self.kept:
                kind = np.result_type(entry.dtype, np.float64)
                self.kept[name] = np.full((self.size, *entry.shape), np.nan, dtype=kind)
            self.kept[name][index] = entry


def _duration(seconds: float) -> str:
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02d} min" if hours else f"{minutes} min {seconds:02d} s"
