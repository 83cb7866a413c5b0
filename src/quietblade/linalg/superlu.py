# SPDX-License-Identifier: LGPL-2.1-or-later
"""SuperLU of scipy: always there, and slow; the last resort."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.sparse.linalg import SuperLU, splu

from quietblade.linalg.pattern import canonical
from quietblade.linalg.protocol import BackendFailed, Inertia, SparseMatrix
from quietblade.typing import AnyArray


@dataclass(frozen=True)
class SuperLu:
    """The SuperLU program; it keeps no analysis and knows double precision only."""

    symmetric: bool
    name: str = "superlu"

    def analyse(self, A: SparseMatrix) -> "SuperLu":
        """Do nothing: SuperLU orders anew in each factorisation."""
        return self

    def factor(self, A: SparseMatrix, *, single: bool) -> "SuperLuFactor":
        """Factor in double precision."""
        ordering: Literal["MMD_AT_PLUS_A", "COLAMD"]
        ordering = "MMD_AT_PLUS_A" if self.symmetric else "COLAMD"
        try:
            factor = splu(canonical(A).tocsc(), permc_spec=ordering)
        except (RuntimeError, MemoryError, ValueError) as error:
            raise BackendFailed(f"factorisation: {error}") from error
        return SuperLuFactor(factor, factor.nnz * (np.dtype(A.dtype).itemsize + 4))


@dataclass(frozen=True, eq=False)
class SuperLuFactor:
    """A factor of SuperLU."""

    factor: SuperLU
    memory_bytes: int
    inertia: Inertia | None = None

    def apply(self, b: AnyArray) -> AnyArray:
        """Substitute for the columns of ``b``."""
        return np.asarray(self.factor.solve(np.asarray(b)))
