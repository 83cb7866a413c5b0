# SPDX-License-Identifier: LGPL-2.1-or-later
"""Closed forms of spheres in water, and what the coupled system must share with them.

The comparisons of computed figures with closed forms are reference checks, in `verification`.
"""

import ngsolve as ngs
import numpy as np
import pytest

from quietblade.vibroacoustics.power import power_budget
from verification.acoustics_closed_forms import ElasticSphere, bgt1, moving_sphere
from verification.acoustics_models import WATER, harmonic_pressure, shell
from verification.acoustics_shell import closed_form


def test_closed_form_impedances() -> None:
    # p/(rho c v) at ka = 1: tables of modal impedances of a sphere.
    expected = {0: 0.5 + 0.5j, 1: 0.2 + 0.6j, 2: 1.123596e-2 + 3.820225e-1j}
    for degree, value in expected.items():
        wave = moving_sphere(degree, 1.0, 1.0, 2.0, 1.0, None)
        assert -1j * wave.potential(1.0) == pytest.approx(value, rel=1e-6)


@pytest.mark.parametrize("inner", [0.0, 0.35])
@pytest.mark.parametrize("degree", [0, 1, 2])
def test_closed_form_conserves_energy(inner: float, degree: int) -> None:
    # Injected = 1/2 Re(F* i omega u) with the force -p P_l on the surface; no loss, no absorption
    # but by the water.
    omega = 2.0 * np.pi * 700.0
    sphere = ElasticSphere(0.5, inner, 5e9, 0.3, 1500.0, 1000.0, 1500.0, 1.0, bgt1)
    radial, wave = sphere.solve(degree, omega)
    area = 4.0 * np.pi * 0.25 / (2 * degree + 1)
    injected = 0.5 * (-1j * omega * radial).real * area
    assert injected == pytest.approx(wave.power(1000.0, omega), rel=1e-8)


def test_closed_form_of_a_thin_walled_limit() -> None:
    # Breathing of a thin shell without water: membrane stiffness 2 E h/((1 - nu) a^2).
    thickness = 1e-3
    sphere = ElasticSphere(0.5, 0.5 - thickness, 70e9, 0.3, 2700.0, 1e-6, 1500.0)
    radial, _ = sphere.solve(0, 2.0 * np.pi * 5.0)
    stiffness = 2.0 * 70e9 * thickness / (0.7 * 0.25)
    assert radial.real == pytest.approx(-1.0 / stiffness, rel=5e-3)


def test_pressure_inside_reaches_the_water_through_the_solid() -> None:
    # Load on the dry inner face, so that nothing but the coupling makes sound.
    model, omega, degree = shell(), 2.0 * np.pi * 300.0, 1
    displacement = ngs.VectorH1(model.fem, order=2)
    test = displacement.TestFunction()
    outward = ngs.CF((ngs.x, ngs.y, ngs.z)) / 0.35
    form = ngs.LinearForm(
        harmonic_pressure(degree) * ngs.InnerProduct(test.Trace(), outward) * ngs.ds("inside")
    )
    load = model.operators.right_hand_side(np.array(form.Assemble().vec))
    response = model.forced_by_load(load, omega)
    radial, wave = closed_form(bgt1).solve(degree, omega, 0.0, 1.0)
    found = model.surface_mean(model.radial_displacement(response), degree)
    assert found == pytest.approx(radial, rel=5e-3)
    potential = model.surface_mean(model.potential(response), degree)
    assert potential == pytest.approx(wave.potential(0.5), rel=5e-3)
    budget = power_budget(model.operators, np.array(omega), response, load)
    assert budget.radiated == pytest.approx(wave.power(WATER.density, omega), rel=1e-2)
    assert budget.residual < 1e-8
