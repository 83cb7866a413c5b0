# SPDX-License-Identifier: LGPL-2.1-or-later
"""Small systems with the blocks of a blade in water, for dense comparison."""

import numpy as np
import scipy.sparse as sp

from quietblade.materials.viscoelastic import ConstantLoss
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.loss import loss_term
from quietblade.vibroacoustics.operators import Blocks, Operators

SOUND_SPEED, RADIUS = 300.0, 2.0


def random_operators(
    seed: int = 0, n_u: int = 120, n_p: int = 8, n_psi: int = 50, *, loss: float = 0.05
) -> Operators:
    """Stiffness with a film's saddle point, mass, water: random but of the right signs.

    Natural frequencies lie between about 3 and 1000 Hz.
    """
    rng = np.random.default_rng(seed)
    size = n_u + n_p + n_psi
    u, p, psi = np.split(np.arange(size), [n_u, n_u + n_p])

    def positive(n: int, low: float, high: float, power: float = 1.0) -> FloatArray:
        q, _ = np.linalg.qr(rng.standard_normal((n, n)))
        values = low + (high - low) * np.linspace(0.0, 1.0, n) ** power
        return np.asarray(q @ np.diag(values) @ q.T)

    def placed(rows: FloatArray, columns: FloatArray, block: FloatArray) -> sp.csr_matrix:
        full = np.zeros((size, size))
        full[np.ix_(rows, columns)] = block
        return sp.csr_matrix(full)

    shear = positive(n_u, 40.0, 4e7, power=3.0)
    bulk = 10.0 * rng.standard_normal((n_u, n_p))
    stiffness = placed(u, u, shear) - placed(p, p, 1e-3 * np.eye(n_p))
    stiffness = stiffness + placed(u, p, bulk) + placed(p, u, bulk.T)
    coupling = 0.1 * rng.standard_normal((n_u, n_psi))
    exterior = np.zeros((n_psi, n_psi))
    exterior[-5:, -5:] = positive(5, 0.5, 1.0)
    terms = {
        "K": stiffness,
        loss_term("film"): placed(u, u, loss * (0.5 * shear + 20.0 * np.diag(rng.random(n_u)))),
        "M": placed(u, u, positive(n_u, 1.0, 2.0)),
        "C": placed(u, psi, coupling) + placed(psi, u, coupling.T),
        "H": placed(psi, psi, positive(n_psi, 0.5, 5.0)),
        "G": placed(psi, psi, positive(n_psi, 1.0, 2.0) / SOUND_SPEED**2),
        "Q": placed(psi, psi, exterior * RADIUS / SOUND_SPEED),
    }
    terms = {name: _symmetrical(term) for name, term in terms.items()}
    return Operators(
        terms,
        Blocks(u, p, psi),
        np.arange(size),
        n_u + n_p,
        SOUND_SPEED,
        1.0,
        RADIUS,
        moduli={"film": ConstantLoss(1.0)},
        exterior=_symmetrical(placed(psi, psi, exterior)),
    )


def _symmetrical(term: sp.csr_matrix) -> sp.csr_matrix:
    return sp.csr_matrix(0.5 * (term + term.T))


def condensed(operators: Operators, *, water: bool) -> tuple[FloatArray, FloatArray]:
    """Dense stiffness without film pressure, and mass with the water's."""
    blocks, terms = operators.blocks, operators.terms
    K = terms["K"].toarray()
    u, p, psi = blocks.u, blocks.p, blocks.psi
    stiffness = K[np.ix_(u, u)] - K[np.ix_(u, p)] @ np.linalg.solve(
        K[np.ix_(p, p)], K[np.ix_(p, u)]
    )
    mass = terms["M"].toarray()[np.ix_(u, u)]
    if water:
        assert operators.exterior is not None
        H = (terms["H"] + operators.exterior).toarray()[np.ix_(psi, psi)]
        C = terms["C"].toarray()[np.ix_(u, psi)]
        mass = mass + C @ np.linalg.solve(H, C.T)
    return stiffness, mass
