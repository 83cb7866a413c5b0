# SPDX-License-Identifier: LGPL-2.1-or-later
"""Regular waves, and the outgoing waves found from the surface."""

from dataclasses import replace

import ngsolve as ngs
import numpy as np
import pytest
from netgen import occ
from scipy.special import sph_harm_y, spherical_jn

from quietblade.typing import ComplexArray, FloatArray
from quietblade.vibroacoustics.harmonics import radial_factors, solid_harmonics
from quietblade.vibroacoustics.multipoles import SurfaceSources
from quietblade.vibroacoustics.operators import build_operators, product_space
from quietblade.vibroacoustics.radiation import sphere_mass
from verification.acoustics_closed_forms import bgt1, h1, h2, moving_sphere, reflection
from verification.acoustics_models import SOFT, WATER, SphereModel, ball, linear_elastic

RNG = np.random.default_rng(2)
POINTS = RNG.normal(size=(9, 3))


@pytest.mark.parametrize("degree", range(6))
def test_solid_harmonics_are_the_real_spherical_ones(degree: int) -> None:
    radius = np.linalg.norm(POINTS, axis=1)
    theta, phi = np.arccos(POINTS[:, 2] / radius), np.arctan2(POINTS[:, 1], POINTS[:, 0])
    values, _ = solid_harmonics(POINTS, degree)
    for m in range(-degree, degree + 1):
        harmonic = (-1) ** m * sph_harm_y(degree, abs(m), theta, phi)
        real = harmonic.real if m >= 0 else harmonic.imag
        expected = radius**degree * real * (np.sqrt(2.0) if m else 1.0)
        np.testing.assert_allclose(values[degree + m], expected, atol=1e-12)


def test_radial_factors_near_the_centre_and_away() -> None:
    radius = np.array([0.0, 1e-3, 0.0099, 0.0101, 0.5, 2.0])
    for degree in range(5):
        value, _ = radial_factors(radius, np.array([1.0]), degree)
        np.testing.assert_allclose(
            value[0] * radius**degree, spherical_jn(degree, radius), rtol=1e-12, atol=1e-300
        )


@pytest.mark.parametrize("degree", range(4))
def test_gradient_of_a_regular_wave(degree: int) -> None:
    k, step = np.array([1.3]), 1e-5

    def wave(points: FloatArray) -> FloatArray:
        factor, _ = radial_factors(np.linalg.norm(points, axis=1), k, degree)
        return np.asarray(factor * solid_harmonics(points, degree)[0])

    values, gradients = solid_harmonics(POINTS, degree)
    factor, slope = radial_factors(np.linalg.norm(POINTS, axis=1), k, degree)
    for axis in range(3):
        shift = step * np.eye(3)[axis]
        numerical = (wave(POINTS + shift) - wave(POINTS - shift)) / (2.0 * step)
        exact = factor * gradients[:, axis] + slope * values * POINTS[:, axis]
        np.testing.assert_allclose(exact, numerical, atol=1e-9)


def test_interpolation_matrix_is_that_of_the_nodal_basis() -> None:
    basis = ball().basis
    values = RNG.normal(size=len(basis.points))
    np.testing.assert_allclose(basis.interpolation @ values, basis.to_dofs(values), atol=1e-12)


def test_regular_wave_from_outside_gives_nothing() -> None:
    # psi = regular plane wave, u . n = d psi/dn / (i omega): all amplitudes vanish.
    model = ball()
    omega, k = 1500.0, 1.0
    points = model.basis.points
    psi = np.exp(1j * k * points @ np.array([0.6, 0.0, 0.8]))
    u = (1j * k * psi[:, None] * np.array([0.6, 0.0, 0.8])) / (1j * omega)
    response = _response(model, u, psi)
    parts = replace(model.sources, flux=0.0 * model.sources.flux)
    nothing = model.sources.multipoles(np.array([omega]), response[None], max_degree=3)
    without_motion = parts.multipoles(np.array([omega]), response[None], max_degree=3)
    assert np.abs(nothing.amplitudes).max() < 3e-3 * np.abs(without_motion.amplitudes).max()


def test_amplitude_of_one_harmonic_and_its_far_field() -> None:
    model, omega = ball(), 1500.0
    found = model.sources.multipoles(np.array([omega]), model.forced_by_motion(1, omega)[None])
    wave = moving_sphere(1, 1.0, 0.5, 1.0, 1.0)
    # P_1 = sqrt(4 pi/3) Y_10; index of (1, 0) is 2.
    expected = np.sqrt(4.0 * np.pi / 3.0) * (wave.outgoing - wave.incoming)
    assert found.amplitudes[0, 2] == pytest.approx(expected, rel=4e-3)
    others = np.delete(found.amplitudes[0], 2)
    assert np.abs(others).max() < 2e-3 * abs(expected)
    # Far field: p r exp(ikr) = rho c i^l a Y, here with h_1(kr) exp(ikr) kr = i^2.
    axis = found.far_field(np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]))
    assert axis[0, 0] == pytest.approx(
        -1j * omega * 1000.0 * (wave.outgoing - wave.incoming) * (-1.0) / 1.0, rel=4e-3
    )
    assert abs(axis[0, 1]) < 2e-3 * abs(axis[0, 0])


def test_far_field_carries_the_power() -> None:
    model, omega = ball(), 1500.0
    response = model.forced_by_motion(0, omega) + 3.0 * model.forced_by_motion(1, omega)
    found = model.sources.multipoles(np.array([omega]), response[None])
    cosine, weights = np.polynomial.legendre.leggauss(12)
    angle = 2.0 * np.pi * np.arange(24) / 24
    mu, phi = np.meshgrid(cosine, angle, indexing="ij")
    sine = np.sqrt(1.0 - mu**2)
    directions = np.stack([sine * np.cos(phi), sine * np.sin(phi), mu], axis=-1).reshape(-1, 3)
    intensity = np.abs(found.far_field(directions)[0]) ** 2 / (2.0 * 1000.0 * 1500.0)
    power = np.sum(np.repeat(weights, 24) * intensity) * 2.0 * np.pi / 24
    assert power == pytest.approx(found.power[0], rel=1e-12)


def test_power_does_not_depend_on_the_centre() -> None:
    model, omega = ball(), np.array([1500.0, 2500.0])
    response = np.stack([model.forced_by_motion(1, w) for w in omega])
    central = model.sources.multipoles(omega, response)
    moved = SurfaceSources.of(
        model.fem, model.basis, model.operators, center=np.array([0.1, 0.0, 0.2])
    ).multipoles(omega, response, tolerance=1e-6)
    np.testing.assert_allclose(moved.power, central.power, rtol=1e-4)
    assert moved.degree > central.degree


def test_cut_off_is_reported() -> None:
    model, omega = ball(), np.array([1500.0])
    response = model.forced_by_motion(2, 1500.0)[None]
    cut = model.sources.multipoles(omega, response, max_degree=2)
    assert cut.degree == 2
    assert cut.tail[0] == pytest.approx(1.0, abs=1e-4)
    (notice,) = cut.notices()
    assert "degrees 1 and 2" in notice.message
    whole = model.sources.multipoles(omega, response)
    assert whole.degree == 4
    assert whole.notices() == []
    np.testing.assert_allclose(whole.power_by_degree.sum(axis=1), whole.power)


@pytest.fixture(scope="module")
def capped() -> SphereModel:
    """The ball with a clamped cap below z = -0.3 m: a rigid part of the closed surface."""
    center = occ.Pnt(0.0, 0.0, 0.0)
    solid, knife = occ.Sphere(center, 0.5), occ.Box(occ.Pnt(-1, -1, -1), occ.Pnt(1, 1, -0.3))
    water = (occ.Sphere(center, 1.0) - solid).mat("water")
    top, bottom = (solid - knife).mat("blade"), (solid * knife).mat("blade")
    shape = occ.Glue([top, bottom, water])
    for face in shape.faces:
        low, high = face.bounding_box
        flat = high.z - low.z < 1e-3
        below = high.z < -0.29
        face.name = "outer" if high.x > 0.9 else "cut" if flat else "root" if below else "wet"
        face.maxh = 0.35 if face.name == "outer" else 0.12
    fem = ngs.Mesh(occ.OCCGeometry(shape).GenerateMesh(maxh=0.4, grading=0.5, optsteps3d=1))
    return SphereModel(fem.Curve(2), 0.5, 1.0, {"blade": SOFT})


def test_clamped_root_belongs_to_the_closed_surface(capped: SphereModel) -> None:
    # The same amplitudes from the field on the outer sphere, degree by degree.
    omega, k = 1500.0, 1.0
    response = capped.forced_by_motion(1, omega)
    found = capped.sources.multipoles(np.array([omega]), response[None])
    psi, mass = _full_potential(capped, response), sphere_mass(capped.fem)
    expected = []
    for degree in range(3):
        harmonics, _ = solid_harmonics(capped.basis.points, degree)
        projected = capped.basis.to_dofs(harmonics.T).reshape(2 * degree + 1, -1) @ (mass @ psi)
        ratio = reflection(degree, k, 1.0, bgt1)
        field = h2(degree, k) + ratio * h1(degree, k)
        expected.append(projected / field * (1.0 - ratio))
    scale = np.abs(np.concatenate(expected)).max()
    np.testing.assert_allclose(found.amplitudes[0, :9], np.concatenate(expected), atol=0.01 * scale)
    opened = SurfaceSources.of(capped.fem, capped.basis, capped.operators, surface="wet")
    wrong = opened.multipoles(np.array([omega]), response[None], max_degree=2).amplitudes[0]
    assert np.abs(wrong - np.concatenate(expected)).max() > 0.05 * scale


def test_moved_sphere_radiates_as_the_one_at_rest() -> None:
    # C1: the ball has moved 0.15 m along z inside the sphere, the mesh with it.
    rest, omega = ball(), np.array([1500.0])
    distance = np.linalg.norm(rest.basis.points, axis=1)
    share = np.clip((1.0 - distance) / 0.5, 0.0, 1.0)
    share[rest.basis.nodes_of("outer", codimension=1)] = 0.0
    motion = ngs.GridFunction(ngs.VectorH1(rest.fem, order=2))
    shift = share[:, None] * np.array([0.0, 0.0, 0.15])
    motion.vec.FV().NumPy()[:] = rest.basis.to_dofs(shift)
    stiffness, mass = linear_elastic(rest.fem, SOFT, "blade")
    moved = replace(rest)
    moved.__dict__["operators"] = build_operators(
        rest.fem,
        stiffness=stiffness,
        mass=mass,
        water=WATER,
        radius=1.0,
        clamped=None,
        motion=motion,
    )
    sources = SurfaceSources.of(moved.fem, moved.basis, moved.operators, motion=motion)
    np.testing.assert_allclose(sources.center, [0.0, 0.0, 0.15], atol=1e-3)
    response = moved.forced_by_motion(0, omega[0])
    power = sources.multipoles(omega, response[None]).power[0]
    exact = moving_sphere(0, 1.0, 0.5, 1.0, 1.0, None).power(1000.0, omega[0])
    # The dipole that the eccentric sphere reflects moves the pressure by a per cent.
    assert power == pytest.approx(exact, rel=0.01)
    assert abs(moved.operators.terms["C"] - rest.operators.terms["C"]).max() < 1e-12
    assert abs(moved.operators.terms["H"] - rest.operators.terms["H"]).max() > 1.0


def _full_potential(model: SphereModel, response: ComplexArray) -> ComplexArray:
    space = product_space(model.fem)
    full = np.zeros(space.ndof, dtype=np.complex128)
    full[model.operators.free] = response
    return full[space.Range(2).start :]


def _response(model: SphereModel, u: ComplexArray, psi: ComplexArray) -> ComplexArray:
    space, operators = product_space(model.fem), model.operators
    full = np.zeros(space.ndof, dtype=np.complex128)
    full[: space.Range(1).start] = model.basis.to_dofs(u)
    full[space.Range(2).start :] = model.basis.to_dofs(psi)
    return full[operators.free]


@pytest.mark.parametrize("degree", [0, 1, 4, 9])
def test_radial_factor_is_the_spherical_bessel_function(degree: int) -> None:
    radius, k = np.linspace(0.05, 1.0, 40), np.array([0.3, 1.9, 2.1, 6.0])
    factor, slope = radial_factors(radius, k, degree)
    z = k[:, None] * radius
    np.testing.assert_allclose(
        factor * radius**degree, spherical_jn(degree, z), rtol=1e-10, atol=1e-14
    )
    np.testing.assert_allclose(
        -slope * radius ** (degree + 1) / k[:, None],
        spherical_jn(degree + 1, z),
        rtol=1e-10,
        atol=1e-14,
    )
