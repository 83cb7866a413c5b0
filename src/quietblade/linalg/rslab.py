# SPDX-License-Identifier: LGPL-2.1-or-later
"""rslab: LDL^T of real and complex symmetric matrices, LU of others, in single or double."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import rslab
from scipy.sparse import csc_matrix

from quietblade.linalg.memory import require_memory
from quietblade.linalg.pattern import Pattern, canonical
from quietblade.linalg.protocol import BackendFailed, Inertia, SparseMatrix
from quietblade.typing import AnyArray


@dataclass(frozen=True)
class Rslab:
    """The rslab program with a number of threads."""

    symmetric: bool
    threads: int
    name: str = "rslab"

    def analyse(self, A: SparseMatrix) -> "RslabAnalysis":
        """Order and analyse; nested dissection is among the orderings that it compares."""
        A = canonical(A)
        pattern = Pattern.of(A, "upper" if self.symmetric else "csc")
        matrix = csc_matrix(
            (pattern.values(A), pattern.indices, pattern.indptr), shape=A.shape, copy=False
        )
        try:
            symbolic = rslab.analyze(
                matrix, path="ldlt" if self.symmetric else "lu", threads=self.threads
            )
        except (RuntimeError, ValueError, MemoryError) as error:
            raise BackendFailed(f"analysis: {error}") from error
        return RslabAnalysis(symbolic, pattern, self.threads, self.symmetric)


@dataclass(frozen=True, eq=False)
class RslabAnalysis:
    """Symbolic analysis; any number of factors may live on it at once."""

    symbolic: Any
    pattern: Pattern
    threads: int
    symmetric: bool

    def factor(self, A: SparseMatrix, *, single: bool) -> "RslabFactor":
        """Factor in the matrix's precision or, if ``single``, in half of it.

        Raises
        ------
        SolverError
            If the factor does not fit into the memory: no other program needs less.
        BackendFailed
            If it cannot be made.
        """
        values = self.pattern.values(canonical(A))
        kind = np.complex128 if np.iscomplexobj(values) else np.float64
        low = "complex64" if kind is np.complex128 else "float32"
        plan = self.symbolic.memory_plan(low if single else np.dtype(kind).name)
        require_memory(plan["peak_bytes"] - plan["analysis_bytes"], self.symbolic.n)
        try:
            factor = self.symbolic.factor(
                values.astype(kind, copy=False),
                threads=self.threads,
                factor_dtype=low if single else None,
            )
        except (RuntimeError, ValueError, MemoryError) as error:
            raise BackendFailed(f"factorisation: {error}") from error
        counts: Inertia | None = None
        if self.symmetric and kind is np.float64 and not single:
            positive, negative, zero = factor.inertia
            counts = (int(positive), int(negative), int(zero))
        width = np.dtype(low if single else kind).itemsize
        return RslabFactor(factor, np.dtype(kind), counts, int(factor.factor_nnz) * width)


@dataclass(frozen=True, eq=False)
class RslabFactor:
    """A factor of rslab."""

    factor: Any
    dtype: np.dtype[Any]
    inertia: Inertia | None
    memory_bytes: int

    def apply(self, b: AnyArray) -> AnyArray:
        """Substitute for the columns of ``b``."""
        try:
            if b.shape[1] == 1:
                column = np.ascontiguousarray(b[:, 0], dtype=self.dtype)
                return np.asarray(self.factor.solve(column))[:, None]
            return np.asarray(self.factor.solve_many(np.ascontiguousarray(b, dtype=self.dtype)))
        except RuntimeError as error:
            raise BackendFailed(f"substitution: {error}") from error
