# SPDX-License-Identifier: LGPL-2.1-or-later
"""Unknowns that are added to a system behind all others."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy.sparse import csr_matrix

from quietblade.materials.viscoelastic import ModulusRatio
from quietblade.vibroacoustics.loss import loss_term
from quietblade.vibroacoustics.operators import Blocks, Operators


def bordered(
    operators: Operators,
    blocks: Blocks,
    additions: Mapping[str, csr_matrix],
    losses: Mapping[str, tuple[csr_matrix, ModulusRatio]] | None = None,
) -> Operators:
    """System with more unknowns.

    Parameters
    ----------
    operators : Operators
    blocks : Blocks
        Those of the larger system.
    additions : mapping of name to (n', n') csr_matrix
        What is added to the terms of these names, which exist; it sets the new size.
    losses : mapping of name to (matrix, ratio)
        New lossy parts.
    """
    losses = {} if losses is None else losses
    matrices = [*additions.values(), *(matrix for matrix, _ in losses.values())]
    size = matrices[0].shape[0]
    terms = {name: _padded(term, size) for name, term in operators.terms.items()}
    for name, addition in additions.items():
        terms[name] = csr_matrix(terms[name] + addition)
    terms |= {loss_term(region): matrix for region, (matrix, _) in losses.items()}
    exterior = operators.exterior
    return replace(
        operators,
        terms=terms,
        blocks=blocks,
        moduli={**operators.moduli, **{region: ratio for region, (_, ratio) in losses.items()}},
        exterior=None if exterior is None else _padded(exterior, size),
    )


def _padded(term: csr_matrix, size: int) -> csr_matrix:
    indptr = np.pad(term.indptr, (0, size - term.shape[0]), mode="edge")
    return csr_matrix((term.data, term.indices, indptr), shape=(size, size))
