# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a sparse direct solver must offer: analyse once, factor often, solve."""

from typing import Protocol

from scipy.sparse import csr_array, csr_matrix

from quietblade.errors import SolverError
from quietblade.typing import AnyArray

SparseMatrix = csr_matrix | csr_array
Inertia = tuple[int, int, int]
"""Numbers of positive, negative and zero eigenvalues."""


class Factorization(Protocol):
    """A factored matrix whose solutions are checked."""

    @property
    def n(self) -> int:
        """Number of unknowns."""
        ...

    @property
    def solver(self) -> str:
        """Program and precision of the factor in use."""
        ...

    @property
    def residual(self) -> float:
        """Worst ``||A x - b|| / ||b||`` of the last solve; nan before the first."""
        ...

    @property
    def inertia(self) -> Inertia | None:
        """Positive, negative and zero eigenvalues; None unless real symmetric and in double."""
        ...

    @property
    def seconds(self) -> float:
        """Time spent on numerical factorisations."""
        ...

    @property
    def memory_bytes(self) -> int:
        """Size of the factor."""
        ...

    def solve(self, b: AnyArray) -> AnyArray:
        """Solve for one vector ``(n,)`` or for the columns of ``(n, k)``."""
        ...


class Analysis(Protocol):
    """Ordering and symbolic factorisation of one sparsity pattern."""

    def factor(self, A: SparseMatrix) -> Factorization:
        """Factor new values on the analysed pattern."""
        ...


class SparseSolver(Protocol):
    """A sparse direct solver."""

    @property
    def name(self) -> str:
        """Name of the program or chain."""
        ...

    def analyse(self, A: SparseMatrix) -> Analysis:
        """Analyse the pattern of ``A`` (both triangles stored, also when symmetric)."""
        ...

    def factor(self, A: SparseMatrix) -> Factorization:
        """Factor ``A``; the last analysis is used again if its pattern is the same."""
        ...


class BackendFailed(SolverError):  # noqa: N818  # an event inside the chain, not its end
    """A solver program gave up on this matrix; the chain tries the next one."""


class BackendFactor(Protocol):
    """A factor as a solver program delivers it, unchecked."""

    @property
    def inertia(self) -> Inertia | None:
        """Positive, negative and zero eigenvalues; None unless real symmetric and in double."""
        ...

    @property
    def memory_bytes(self) -> int:
        """Size of the factor."""
        ...

    def apply(self, b: AnyArray) -> AnyArray:
        """Forward and backward substitution for the columns of ``b (n, k)``, in double."""
        ...


class BackendAnalysis(Protocol):
    """A symbolic analysis as a solver program keeps it."""

    def factor(self, A: SparseMatrix, *, single: bool) -> BackendFactor:
        """Factor ``A``, in single precision if asked; raises `BackendFailed`."""
        ...


class Backend(Protocol):
    """A solver program behind the chain."""

    @property
    def name(self) -> str:
        """Name of the program or chain."""
        ...

    def analyse(self, A: SparseMatrix) -> BackendAnalysis:
        """Analyse the pattern of ``A``; raises `BackendFailed`."""
        ...
