# SPDX-License-Identifier: LGPL-2.1-or-later
"""A small system on which solvers are tried and machines measured."""

from time import process_time

import numpy as np
from scipy.sparse import csr_matrix, kron

from quietblade.linalg.chain import make_solver
from quietblade.linalg.protocol import SparseMatrix

SPEED_CELLS = 20
"""Cells along an edge of the cube by which a machine is measured: a tenth of a second."""


def trial_system(cells: int) -> SparseMatrix:
    """Helmholtz's equation in a cube, complex symmetric like the systems of a sweep.

    Parameters
    ----------
    cells : int
        Along an edge.

    Returns
    -------
    sparse matrix of ``cells**3`` unknowns
    """
    second = 2.0 * np.eye(cells) - np.eye(cells, k=1) - np.eye(cells, k=-1)
    line, one = csr_matrix(second), csr_matrix(np.eye(cells))
    cube = kron(kron(line, one), one) + kron(kron(one, line), one) + kron(kron(one, one), line)
    system = csr_matrix(cube.astype(complex))
    system.setdiag(system.diagonal() - 0.05 + 0.01j)
    return system


def trial_seconds(repeats: int = 3) -> float:
    """Processor time of one factorisation of the trial on one thread [s], the least of some.

    Processor time, because it is what stays the same when other work is done beside.

    Parameters
    ----------
    repeats : int
    """
    system = trial_system(SPEED_CELLS)
    analysis = make_solver(precision="double", threads=1).analyse(system)
    seconds = []
    for _ in range(repeats):
        start = process_time()
        analysis.factor(system)
        seconds.append(process_time() - start)
    return min(seconds)
