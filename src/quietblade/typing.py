# SPDX-License-Identifier: LGPL-2.1-or-later
"""Array and callback types that every room speaks."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
AnyArray = NDArray[Any]

Progress = Callable[[str, float | None, str], None]
"""Called with the stage, the fraction done (None if unknown) and a short message."""


def silent(stage: str, fraction: float | None, message: str) -> None:
    """Progress callback that says nothing."""
