# SPDX-License-Identifier: LGPL-2.1-or-later
"""Wall-clock time by stage."""

from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter

from quietblade.typing import Progress


class Clock:
    """Times stages and tells the progress callback when one begins and ends."""

    def __init__(self, progress: Progress) -> None:
        self.seconds: dict[str, float] = {}
        self._progress = progress

    @contextmanager
    def stage(self, name: str) -> Iterator[Progress]:
        """Time what is done inside; yields the progress callback under the stage's name."""
        start = perf_counter()
        self._progress(name, 0.0, "")

        def report(_: str, fraction: float | None, message: str) -> None:
            self._progress(name, fraction, message)

        yield report
        self.seconds[name] = perf_counter() - start
        self._progress(name, 1.0, f"{self.seconds[name]:.1f} s")
