# SPDX-License-Identifier: LGPL-2.1-or-later
"""Complex moduli over frequency."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from quietblade.errors import MaterialError
from quietblade.materials.viscoelastic import (
    ArrheniusShift,
    ConstantLoss,
    FractionalZener,
    GeneralizedMaxwell,
    ModulusRatio,
    Shifted,
    WlfShift,
    fit_maxwell,
    loss_factor,
    modulus_ratio,
)

ISD112_LIKE = FractionalZener(stiffening=46.6, tau=1.4e-5, alpha=0.79)
FREQUENCY = np.logspace(-2, 7, 40)


@given(
    stiffening=st.floats(1.01, 1e4), tau=st.floats(1e-8, 1e2), alpha=st.floats(0.05, 1.0),
    omega=st.floats(1e-3, 1e8),
)  # fmt: skip
def test_fractional_zener_is_passive_and_bounded(
    stiffening: float, tau: float, alpha: float, omega: float
) -> None:
    g = FractionalZener(stiffening, tau, alpha)(omega)
    assert g.imag >= -1e-12 * abs(g)
    assert 1.0 - 1e-12 <= g.real <= stiffening * (1.0 + 1e-12)


def test_first_order_fractional_zener_is_one_maxwell_branch() -> None:
    zener = FractionalZener(3.0, 1e-3, 1.0)
    maxwell = GeneralizedMaxwell((2.0,), (1e-3,))
    np.testing.assert_allclose(modulus_ratio(zener, FREQUENCY), modulus_ratio(maxwell, FREQUENCY))


def test_loss_peak_of_the_fractional_zener() -> None:
    # T. Pritz, J. Sound Vib. 195 (1996) 103-115: the largest loss factor is at
    # omega tau = r^(-1 / (2 alpha)), with the value below
    r, tau, alpha = 46.6, 1.4e-5, 0.79
    peak = r ** (-1.0 / (2.0 * alpha)) / tau / (2.0 * np.pi)
    near = peak * np.array([0.98, 1.0, 1.02])
    eta = loss_factor(ISD112_LIKE, near)
    assert eta[1] > max(eta[0], eta[2])
    half = 0.5 * alpha * np.pi
    expected = (r - 1.0) * np.sin(half) / (2.0 * np.sqrt(r) + (r + 1.0) * np.cos(half))
    assert eta[1] == pytest.approx(expected, rel=1e-12)


def test_moduli_are_analytic() -> None:
    # Cauchy-Riemann by central differences
    for model in (ISD112_LIKE, GeneralizedMaxwell((1.0, 3.0), (1e-3, 1e-5)), ConstantLoss(0.2)):
        omega, h = 2.0e3 * (1.0 + 0.02j), 1e-3
        along = (model(omega + h) - model(omega - h)) / (2.0 * h)
        across = (model(omega + 1j * h) - model(omega - 1j * h)) / (2j * h)
        assert along == pytest.approx(across, abs=1e-12)


def test_temperature_shifts() -> None:
    wlf = WlfShift(17.44, 51.6, 293.15)
    assert wlf.factor(293.15) == 1.0
    assert wlf.factor(303.15) < 1.0 < wlf.factor(283.15)
    arrhenius = ArrheniusShift(1e5, 293.15)
    assert arrhenius.factor(293.15) == 1.0
    assert np.log(arrhenius.factor(303.15)) == pytest.approx(-1.353, abs=2e-3)
    warm = Shifted(ISD112_LIKE, wlf.factor(303.15))
    assert warm(1e3) == ISD112_LIKE(1e3 * wlf.factor(303.15))
    with pytest.raises(MaterialError, match=r"241\.55 K"):
        wlf.factor(200.0)


@pytest.mark.parametrize("model", [ISD112_LIKE, GeneralizedMaxwell((1.0, 3.0), (1e-3, 1e-5))])
def test_fit_finds_the_model_that_made_the_points(model: ModulusRatio) -> None:
    frequency = np.logspace(0, 5, 31)
    fit = fit_maxwell(frequency, 2e6 * modulus_ratio(model, frequency), branches_per_decade=3.0)
    assert fit.error < 0.02
    np.testing.assert_allclose(fit.static_modulus * modulus_ratio(fit.model, frequency), fit.fitted)


@given(st.lists(st.floats(0.0, 2.0), min_size=5, max_size=5))
def test_fit_is_passive_whatever_the_points(losses: list[float]) -> None:
    points = 1e6 * (1.0 + 1j * np.array(losses))
    fit = fit_maxwell([1.0, 10.0, 100.0, 1e3, 1e4], points, static_modulus=5e5)
    assert np.all(modulus_ratio(fit.model, FREQUENCY).imag >= 0.0)


def test_impossible_materials_are_refused() -> None:
    with pytest.raises(MaterialError, match="must not be negative"):
        ConstantLoss(-0.1)
    with pytest.raises(MaterialError, match="must exceed 1"):
        FractionalZener(0.5, 1.0, 0.5)
    with pytest.raises(MaterialError, match="alpha"):
        FractionalZener(2.0, 1.0, 1.5)
    with pytest.raises(MaterialError, match="feeds energy"):
        GeneralizedMaxwell((-1.0,), (1.0,))
    with pytest.raises(MaterialError, match="loss moduli"):
        fit_maxwell([1.0, 2.0], [1.0 - 0.1j, 1.0])
    with pytest.raises(MaterialError, match="no stiffness at rest"):
        fit_maxwell([1.0, 10.0, 100.0], [1e6 + 1e6j, 1e6, 1e6])
    with pytest.raises(MaterialError, match="two or more"):
        fit_maxwell([1.0], [1.0])
