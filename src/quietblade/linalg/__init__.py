# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sparse direct solvers behind one protocol, with every residual checked."""

from quietblade.linalg.chain import (
    Precision,
    SolverChain,
    SolverName,
    default_threads,
    make_solver,
)
from quietblade.linalg.protocol import Analysis, Factorization, SparseMatrix, SparseSolver
from quietblade.linalg.report import Fallback, SolverReport
from quietblade.linalg.symmetrized import SymmetrizedSolver, make_nearly_symmetric_solver

__all__ = [
    "Analysis",
    "Factorization",
    "Fallback",
    "Precision",
    "SolverChain",
    "SolverName",
    "SolverReport",
    "SparseMatrix",
    "SparseSolver",
    "SymmetrizedSolver",
    "default_threads",
    "make_nearly_symmetric_solver",
    "make_solver",
]
