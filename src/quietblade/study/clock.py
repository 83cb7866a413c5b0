# SPDX-License-Identifier: LGPL-2.1-or-later
"""Stages one after the other: timed, told of, kept, and not computed again without need."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from time import perf_counter
from typing import TypeVar, cast

from quietblade.errors import Notice
from quietblade.results.files import ResultError
from quietblade.study.keeping import DamagedError, Lap, Makers, StageStore
from quietblade.study.stages import Origin
from quietblade.typing import Progress

Made = TypeVar("Made")

_NOTHING: Makers = {}


class Clock:
    """Times stages and tells the progress callback when one begins and ends.

    Attributes
    ----------
    laps : dict of str to Lap
        The stages so far.
    notices : list of Notice
        Kept results that could not be used.
    """

    def __init__(self, progress: Progress) -> None:
        self.laps: dict[str, Lap] = {}
        self.notices: list[Notice] = []
        self._progress = progress

    def tell(self, said: str) -> None:
        """Tell the progress callback something about all stages."""
        self._progress("stages", 1.0, said)

    @contextmanager
    def stage(self, name: str, why: str = "") -> Iterator[Progress]:
        """Time what is done inside; yields the progress callback under the stage's name.

        Parameters
        ----------
        name : str
        why : str
            Why the stage is computed again, if it is.
        """
        start = perf_counter()
        self._progress(name, 0.0, why)

        def report(_: str, fraction: float | None, message: str) -> None:
            # the end is told below, once
            inside = None if fraction is None else min(fraction, 0.99)
            self._progress(name, inside, message)

        yield report
        self.laps[name] = Lap(perf_counter() - start, peak_memory())
        self._progress(name, 1.0, f"{self.laps[name].seconds:.1f} s")


class Stages(Clock):
    """A clock whose stages are kept.

    Parameters
    ----------
    progress : callable
    origins : mapping of str to Origin
        What each stage is made from, see `quietblade.study.stages`.
    store : StageStore or None
        Where results are kept; None keeps nothing.
    force : bool
        Compute everything, whatever is kept.
    """

    def __init__(
        self,
        progress: Progress,
        origins: Mapping[str, Origin],
        store: StageStore | None,
        *,
        force: bool = False,
    ) -> None:
        super().__init__(progress)
        self._origins, self._store, self._force = origins, store, force
        self._why: dict[str, str] = {}
        if store is not None:
            store.tidy(origins)

    def make(
        self, name: str, compute: Callable[[Progress], Made], makers: Makers = _NOTHING
    ) -> Made:
        """Take the result of a stage from an earlier run, or compute it and keep it.

        Parameters
        ----------
        name : str
            A stage of `quietblade.study.stages`.
        compute : callable
            Called with a progress callback.
        makers : mapping
            How to make again, by class, what is not to be stored with the result.
        """
        origin, store = self._origins[name], self._store
        kept = None if store is None else store.known(name)
        why = "" if kept is None else origin.changes_from(kept.origin)
        if store is not None and kept is not None:
            if self._force:
                why = "everything is computed again"
            elif not why:
                try:
                    result = cast(Made, store.read(name, makers))
                except DamagedError as damage:
                    why = f"what was kept is damaged: {damage}"
                    remedy = "It was computed again"
                    self.notices.append(Notice(f"stage {name}", why, remedy=remedy))
                else:
                    self.laps[name] = kept.lap
                    said = f"kept ({kept.lap.seconds:.1f} s when it was computed)"
                    self._progress(name, 1.0, said)
                    return result
        self._why[name] = why
        with self.stage(name, why) as report:
            result = compute(report)
        if store is not None:
            try:
                store.keep(name, origin, self.laps[name], result, makers)
            except OSError as error:  # as of a full disk: the next run computes the stage again
                fault = f"could not be kept: {error.strerror or error}"
                remedy = "Make room on the disk, or run with --no-keep"
                self.notices.append(Notice(f"stage {name}", fault, remedy=remedy))
        return result

    def account(self) -> str:
        """Say what was kept and what was computed again, and why; empty for a first run."""
        kept = [name for name, lap in self.laps.items() if lap.kept]
        again = [f"{name} ({why})" for name, why in self._why.items() if why]
        new = [name for name, why in self._why.items() if not why]
        if not kept and not again:
            return ""
        told = (("kept", kept), ("computed again", again), ("computed", new))
        return "; ".join(f"{what}: {', '.join(names)}" for what, names in told if names)

    def shelve(
        self, name: str, compute: Callable[[Progress], Made], makers: Makers = _NOTHING
    ) -> Callable[[], Made]:
        """Make the result of a stage, and let go of it until it is asked for.

        Takes what `make` takes; what is returned reads the result from the disk. A result that
        is not kept there stays in memory.
        """
        made = self.make(name, compute, makers)
        store, kept = self._store, None if self._store is None else self._store.known(name)
        if store is None or kept is None or kept.origin != self._origins[name]:
            return lambda: made

        def read() -> Made:
            try:
                return cast(Made, store.read(name, makers))
            except DamagedError as damage:
                raise ResultError(
                    f"stage {name}: what the run had kept of it is damaged: {damage}; "
                    "run again, which computes it anew"
                ) from damage

        return read


def within(progress: Progress, low: float, high: float) -> Progress:
    """Put the fractions that a part of a stage reports into the stage's own, from low to high."""

    def report(stage: str, fraction: float | None, message: str) -> None:
        share = None if fraction is None else low + (high - low) * fraction
        progress(stage, share, message)

    return report


def peak_memory() -> float:
    """Largest memory of this process so far [B]; nan where the system does not tell."""
    try:
        import resource  # noqa: PLC0415  # not on Windows
        import sys  # noqa: PLC0415
    except ImportError:
        return float("nan")
    unit = 1 if sys.platform == "darwin" else 1024
    return float(unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
