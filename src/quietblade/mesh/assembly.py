# SPDX-License-Identifier: LGPL-2.1-or-later
"""Assembled NGSolve matrices as SciPy matrices."""

import ngsolve as ngs
import numpy as np
from scipy.sparse import csr_matrix


def csr_of(form: ngs.BilinearForm) -> csr_matrix:
    """Copy the matrix of an assembled form to compressed rows, in the form's full numbering."""
    values, columns, starts = form.mat.CSR()
    shape = (form.mat.height, form.mat.width)
    return csr_matrix((np.array(values), np.array(columns), np.array(starts)), shape=shape)
