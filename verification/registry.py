# SPDX-License-Identifier: LGPL-2.1-or-later
"""The register of checks: one entry a reference value, one function a computation."""

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter


@dataclass(frozen=True)
class Check:
    """One computed figure against one reference.

    Attributes
    ----------
    id : str
        Stable name that begins with the part: ``structure/``, ``flow/``, ``acoustics/`` or
        ``paper/``.
    quantity, source : str
        What is compared (with its unit), and where the reference comes from.
    reference, tolerance : float
        The check passes if ``|value - reference| <= tolerance`` (absolute, in the same unit).
    compute : callable
        Returns the value.
    quick : bool
        Quick checks also run in the ordinary tests.
    known : str
        Why the value is known to lie elsewhere: then the row says ``passed: false`` with this
        explanation, and the run does not fail for it. Empty for an ordinary check.
    """

    id: str
    quantity: str
    reference: float
    source: str
    tolerance: float
    compute: Callable[[], float]
    quick: bool = True
    known: str = ""

    def run(self) -> "Row":
        """Compute the value and judge it."""
        start = perf_counter()
        value = float(self.compute())
        passed = bool(abs(value - self.reference) <= self.tolerance)
        return Row(
            self.id,
            self.quantity,
            self.reference,
            self.source,
            value,
            self.tolerance,
            passed,
            perf_counter() - start,
            "" if passed else self.known,
        )


@dataclass(frozen=True)
class Row:
    """A line of ``build/verification.json``."""

    id: str
    quantity: str
    reference: float
    source: str
    value: float
    tolerance: float
    passed: bool
    seconds: float
    explanation: str = ""


CHECKS: dict[str, Check] = {}


def check(
    id: str,  # noqa: A002  # the name that the records use
    *,
    quantity: str,
    reference: float,
    source: str,
    tolerance: float,
    quick: bool = True,
    known: str = "",
) -> Callable[[Callable[[], float]], Callable[[], float]]:
    """Enter a function that returns a figure into the register."""

    def enter(compute: Callable[[], float]) -> Callable[[], float]:
        if id in CHECKS:
            raise ValueError(f"check {id!r} is registered twice")
        CHECKS[id] = Check(id, quantity, reference, source, tolerance, compute, quick, known)
        return compute

    return enter
