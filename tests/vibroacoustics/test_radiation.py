# SPDX-License-Identifier: LGPL-2.1-or-later
"""Conditions on the outer sphere."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import eval_legendre

from quietblade.errors import MeshError
from quietblade.vibroacoustics.dtn import Dtn
from quietblade.vibroacoustics.fluid import Water
from quietblade.vibroacoustics.operators import build_operators
from quietblade.vibroacoustics.power import radiated_power, surface_power
from quietblade.vibroacoustics.radiation import (
    Bgt1,
    Bgt2,
    check_sphere,
    sphere_mass,
    static_exterior,
)
from verification.acoustics_closed_forms import bgt1, bgt2, moving_sphere, power_ratio, reflection
from verification.acoustics_models import SOFT, WATER, ball, linear_elastic


@pytest.mark.parametrize("degree", [0, 1, 2, 3])
def test_static_exterior_on_spherical_harmonics(degree: int) -> None:
    model = ball()
    # On the outer sphere of radius 1 the cosine is z; elsewhere the values do not matter.
    psi = model.basis.to_dofs(eval_legendre(degree, model.basis.points[:, 2]))
    water = Water(1.0, 1500.0)
    quotient = psi @ static_exterior(model.fem, water, 1.0) @ psi
    quotient /= psi @ sphere_mass(model.fem) @ psi
    # Exact for degrees 0 and 1: (l + 1)/R; the surface triangles are 0.35 long.
    assert quotient == pytest.approx(
        1.0 + degree * (degree + 1) / 2.0, rel=1e-3 * (degree + 1) ** 2
    )
    if degree < 2:
        assert quotient == pytest.approx(degree + 1.0, rel=4e-3)


def test_outer_boundary_must_be_the_sphere() -> None:
    fem = ball().fem
    np.testing.assert_allclose(check_sphere(fem, 1.0), 0.0, atol=1e-3)
    with pytest.raises(MeshError, match="give the radius"):
        check_sphere(fem, 1.05)


@pytest.mark.parametrize("omega", [500.0, 2000.0 - 30.0j])
def test_factor_of_first_order_bgt(omega: complex) -> None:
    assert Bgt1().factors(omega, 1500.0, 1.3) == {"Q": -(1j * omega + 1500.0 / 1.3)}


@pytest.mark.parametrize("condition", [Bgt1(), Bgt2(), Dtn(3)])
def test_coefficients_and_factors_are_one_condition(condition: Bgt1 | Bgt2 | Dtn) -> None:
    # On a harmonic: Q is rho (or rho/c), T is rho l (l + 1)/R^2, Y_l is rho on its own degree.
    kr, radius, sound_speed = 0.7, 1.3, 1500.0
    factors = condition.factors(kr * sound_speed / radius, sound_speed, radius)
    scale = 1.0 / sound_speed if condition.name == "BGT-1" else 1.0
    found = [
        -radius
        * (
            scale * factors["Q"]
            + factors.get("T", 0.0) * degree * (degree + 1) / radius**2
            + factors.get(f"Y{degree}", 0.0)
        )
        for degree in range(6)
    ]
    np.testing.assert_allclose(condition.coefficients(5, kr), found, rtol=1e-13)


def test_another_condition_finds_its_place() -> None:
    # Second order is exact for degree 1, where first order is 2.6 times too loud.
    model = ball()
    stiffness, mass = linear_elastic(model.fem, SOFT, "blade")
    operators = build_operators(
        model.fem,
        stiffness=stiffness,
        mass=mass,
        water=WATER,
        radius=1.0,
        clamped=None,
        condition=Bgt2(),
    )
    other = replace(model)
    other.__dict__["operators"] = operators
    omega = 1500.0
    response = other.forced_by_motion(1, omega)
    exact = moving_sphere(1, 1.0, 0.5, 1.0, 1.0, None).power(WATER.density, omega)
    power = radiated_power(operators, np.array(omega), response)
    assert power == pytest.approx(exact, rel=6e-3)
    assert surface_power(operators, np.array(omega), response) == pytest.approx(power, rel=1e-9)


def test_closed_forms_against_the_table_of_reflections() -> None:
    # |B/A| and power ratios, to the digits of the table in the theory guide.
    assert abs(reflection(1, 1.0, 1.0, bgt1)) == pytest.approx(0.447, abs=5e-4)
    assert abs(reflection(2, 2.0, 1.0, bgt1)) == pytest.approx(0.469, abs=5e-4)
    assert abs(reflection(1, 1.0, 1.0, bgt2)) == pytest.approx(0.0, abs=1e-14)
    assert abs(reflection(0, 0.3, 1.0, bgt1)) == pytest.approx(0.0, abs=1e-14)
    table = {0.25: (36.3, 6450.0), 0.5: (9.34, 413.0), 1.0: (2.61, 28.4), 2.0: (1.017, 2.62)}
    for kr, ratios in table.items():
        for degree, ratio in enumerate(ratios, start=1):
            assert power_ratio(degree, kr, bgt1) == pytest.approx(ratio, rel=2e-3)
    # Second order feeds power back to a quadrupole below kR = sqrt(2).
    assert power_ratio(2, 1.0, bgt2) < 0.0 < power_ratio(2, 1.5, bgt2)
