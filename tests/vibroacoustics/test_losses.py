# SPDX-License-Identifier: LGPL-2.1-or-later
"""Complex moduli that depend on frequency, in sweeps, modes and powers."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from quietblade.linalg import make_solver
from quietblade.materials.viscoelastic import (
    ConstantLoss,
    FractionalZener,
    GeneralizedMaxwell,
    ModulusRatio,
)
from quietblade.vibroacoustics.complex_modes import complex_modes
from quietblade.vibroacoustics.loss import Lossy, Stiffened, Viscous, loss_term
from quietblade.vibroacoustics.loss_shares import loss_shares
from quietblade.vibroacoustics.modes import dry_modes, wet_modes
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.power import dissipated_by_region, level, power_budget
from quietblade.vibroacoustics.reduced import reduce_system
from quietblade.vibroacoustics.vacuum import dry_operators
from tests.vibroacoustics.small_systems import random_operators
from verification.acoustics_oscillators import maxwell_mode, oscillator_mode

ZENER = FractionalZener(3.0, 0.02, 0.7)
MAXWELL = GeneralizedMaxwell((0.3, 0.8), (0.004, 0.05))
BAND = (3.0, 9.0)


def chain(ratio: ModulusRatio, n: int = 120) -> Operators:
    """Masses on springs of one viscoelastic material: every mode is an oscillator of its own."""
    K = sp.csr_matrix(4e4 * sp.diags([-np.ones(n - 1), 2.0 * np.ones(n), -np.ones(n - 1)],
                                     [-1, 0, 1]))  # fmt: skip
    return dry_operators(
        stiffness=K, mass=sp.csr_matrix(2.0 * sp.eye(n)), free=np.ones(n, dtype=bool),
        displacements=n, loss={"springs": Lossy(K, ratio)},
    )  # fmt: skip


def with_moduli(operators: Operators, moduli: Mapping[str, ModulusRatio]) -> Operators:
    """Two lossy regions: the film, and a tenth of the film's matrix once more."""
    film = operators.terms[loss_term("film")]
    terms = {**operators.terms, loss_term("film"): 5.0 * film, loss_term("blade"): 0.1 * film}
    return replace(operators, terms=terms, moduli=moduli)


@pytest.mark.parametrize("ratio", [ZENER, MAXWELL, ConstantLoss(0.4), Viscous(),
                                   Stiffened(ZENER, 1.7)])  # fmt: skip
def test_frequency_dependent_modes_are_those_of_oscillators(ratio: ModulusRatio) -> None:
    scale = 1e-4 if isinstance(ratio, Viscous) else 1.0

    def scaled(omega: complex) -> complex:
        return 1.0 + scale * (ratio(omega) - 1.0)

    operators = chain(scaled)
    n = operators.size
    springs = 2.0 * np.sqrt(2e4) * np.sin(np.arange(1, n + 1) * np.pi / (2 * (n + 1)))
    highest = 1.02 * np.sqrt(complex(scaled(springs[9])).real) * springs[9] / (2.0 * np.pi)
    modes = dry_modes(operators, highest, moduli_at=highest)
    found = complex_modes(operators, modes, (0.0, highest))
    exact = np.array([oscillator_mode(w, scaled) for w in springs[: len(found.omega)]])
    assert len(exact) >= 9
    assert found.converged.all()
    np.testing.assert_allclose(found.omega, exact, rtol=1e-10)


def test_closed_forms_of_a_maxwell_oscillator_agree() -> None:
    for natural in (3.0, 40.0, 900.0):
        assert maxwell_mode(natural, MAXWELL) == pytest.approx(
            oscillator_mode(natural, MAXWELL), rel=1e-11
        )


def test_system_has_one_factor_for_each_region() -> None:
    operators = with_moduli(random_operators(), {"film": ZENER, "blade": ConstantLoss(0.2)})
    omega = 30.0 + 1.0j
    factors = operators.factors(omega)
    assert factors["D film"] == ZENER(omega) - 1.0
    assert factors["D blade"] == pytest.approx(0.2j)
    at = operators.at(7.0).toarray()
    plain = replace(operators, moduli={}).at(7.0).toarray()
    lossy = sum(
        (operators.moduli[r](7.0) - 1.0) * operators.terms[loss_term(r)].toarray()
        for r in ("film", "blade")
    )
    np.testing.assert_allclose(at - plain, lossy, atol=1e-9 * np.abs(at).max())
    stiffness = operators.stiffness(7.0) + 1j * operators.loss(7.0)
    complex_stiffness = operators.terms["K"] + lossy
    assert np.abs(stiffness - complex_stiffness).max() < 1e-12 * abs(operators.terms["K"]).max()


def test_reduced_sweep_with_a_fractional_zener_film() -> None:
    operators = with_moduli(random_operators(1), {"film": ZENER, "blade": ConstantLoss(0.1)})
    load = np.zeros((2, operators.size))
    load[:, operators.blocks.u] = np.random.default_rng(2).standard_normal(
        (2, len(operators.blocks.u))
    )
    solver = make_solver(precision="double", tolerance=1e-12)
    sweep = reduce_system(operators, load, np.linspace(*BAND, 40), tolerance=1e-3, solver=solver)
    assert sweep.certificate.factorizations == 1
    omega = 2.0 * np.pi * np.linspace(*BAND, 23)
    exact = np.array([np.linalg.solve(operators.at(w).toarray(), load.T).T for w in omega])
    beside = np.broadcast_to(omega[:, None], (len(omega), 2))
    budget = power_budget(operators, beside, exact, load)
    assert budget.residual.max() < 1e-8
    error = level(sweep.model.radiated(omega)) - level(budget.radiated)
    assert np.abs(error).max() < 1e-3
    assert np.all(np.abs(error).max(axis=1) <= sweep.estimate(omega / (2.0 * np.pi)) + 1e-9)
    assert sweep.model.budget(omega).residual.max() < 1e-8
    # a combination of both loads, and powers by region
    both = sweep.model.combined(np.array([1.0, -2.0]))
    mixed = exact[:, 0] - 2.0 * exact[:, 1]
    np.testing.assert_allclose(
        both.budget(omega).radiated,
        power_budget(operators, omega, mixed, load[0] - 2.0 * load[1]).radiated,
        rtol=1e-3,
    )
    parts = dissipated_by_region(operators, omega, mixed)
    whole = 0.5 * omega * np.array([
        np.vdot(x, operators.loss(w) @ x).real for w, x in zip(omega, mixed, strict=True)
    ])  # fmt: skip
    np.testing.assert_allclose(parts["film"] + parts["blade"], whole, rtol=1e-10)
    assert min(parts["film"].min(), parts["blade"].min()) > 0.0


def test_moduli_at_a_frequency_make_better_real_modes() -> None:
    operators = with_moduli(random_operators(3), {"film": FractionalZener(4.0, 0.05, 0.6)})
    static = wet_modes(operators, 15.0)
    there = wet_modes(operators, 15.0, moduli_at=9.0)
    assert there.frequency[0] > 1.05 * static.frequency[0]
    damped = complex_modes(operators, there, (1.0, 9.0))
    assert damped.converged.all()
    reach = np.abs(damped.frequency / there.frequency[damped.start] - 1.0)
    assert reach.max() < 0.2
    np.testing.assert_allclose(there.loss_factor, there.losses["film"], rtol=1e-12)


def test_loss_of_a_mode_has_its_parts() -> None:
    operators = with_moduli(random_operators(2), {"film": ZENER, "blade": ConstantLoss(0.1)})
    modes = wet_modes(operators, 12.0, moduli_at=6.0)
    damped = complex_modes(operators, modes, (1.0, 10.0))
    shares = loss_shares(operators, damped)
    assert set(shares) == {"film", "blade", "radiation"}
    np.testing.assert_allclose(sum(shares.values()), damped.loss_factor, rtol=1e-12)
    assert all(part.min() > 0.0 for part in shares.values())
    # without sound the material's part is that of the real mode
    light = with_moduli(
        random_operators(2), {"film": ConstantLoss(1e-4), "blade": ConstantLoss(1e-5)}
    )
    silent = {name: 1e-9 * light.terms[name] for name in ("G", "Q")}
    light = replace(light, terms={**light.terms, **silent}, exterior=0.0 * light.terms["Q"])
    modes = wet_modes(light, 12.0)
    damped = complex_modes(light, modes, (1.0, 10.0))
    assert len(damped.start) >= 2
    for region, share in loss_shares(light, damped).items():
        if region != "radiation":
            expected = modes.losses[region][damped.start]
            np.testing.assert_allclose(share, expected, rtol=1e-5)
