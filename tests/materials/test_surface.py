# SPDX-License-Identifier: LGPL-2.1-or-later
from dataclasses import replace

import ngsolve as ngs
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quietblade.errors import GeometryError
from quietblade.geometry import Blade, constant, formula
from quietblade.materials import (
    ply_axes,
    section_directions,
    surface_axes,
    surface_depth,
    surface_frame,
)
from quietblade.mesh.nodal import NodalBasis
from tests.materials.blades import FLAT, TWISTED, blade_basis

fractions = st.floats(0.0, 1.0)


@pytest.fixture(scope="module")
def twisted() -> NodalBasis:
    return blade_basis(TWISTED, (8, 2, 12))


@settings(max_examples=60, deadline=None)
@given(fractions, fractions, st.floats(-1.2, 1.2), st.floats(-0.3, 0.3), st.floats(0.0, 0.09))
def test_frames_are_rotations_tangent_to_the_camber_surface(s, xi, twist, sweep, camber) -> None:
    blade = replace(
        FLAT,
        blade_angle=formula(f"{twist}*s"),
        sweep=formula(f"{sweep}*s*s"),
        camber=constant(camber),
    )
    frame = surface_frame(blade, s, xi)
    assert frame.T @ frame == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(frame) == pytest.approx(1.0)

    def on_surface(a: float, b: float) -> np.ndarray:
        return blade.place(a, [b, float(blade.family.camber_line(b, blade.camber(np.array(a)))[0])])

    h = 1e-5
    a, b = float(np.clip(s, h, 1 - h)), float(np.clip(xi, h, 1 - h))
    for tangent in (
        on_surface(a + h, b) - on_surface(a - h, b),
        on_surface(a, b + h) - on_surface(a, b - h),
    ):
        assert tangent @ surface_frame(blade, a, b)[:, 2] == pytest.approx(0.0, abs=1e-8)
    # sense: outwards along the span, towards the trailing edge, out of the upper side
    _, t, n = blade.frame(s)
    assert frame[2, 0] > 0.0
    assert frame[:, 1] @ t > 0.0
    assert frame[:, 2] @ n > 0.0


def test_axes_of_an_untwisted_blade_are_the_sections_directions_and_numbers() -> None:
    axes = surface_axes(FLAT, blade_basis(FLAT), "blade", angle=np.radians(45.0))
    assert isinstance(axes, np.ndarray)
    wanted = ply_axes(np.radians(45.0), *section_directions(0.0))
    assert axes == pytest.approx(wanted, abs=1e-9)


def test_axes_on_the_mesh_are_rotations_and_follow_the_surface(twisted) -> None:
    axes = surface_axes(TWISTED, twisted, "blade")
    fem = twisted.fem
    places = fem.MapToAllElements(
        {ngs.HEX: ngs.IntegrationRule(ngs.HEX, 4)}, fem.Materials("blade")
    )
    found = axes(places).reshape(-1, 3, 3)
    assert np.abs(np.einsum("nji,njk->nik", found, found) - np.eye(3)).max() < 1e-12
    assert np.linalg.det(found) == pytest.approx(np.ones(len(found)))
    points = ngs.CF((ngs.x, ngs.y, ngs.z))(places)
    s, xi, _ = TWISTED.locate(points)
    # cells of 80 mm along the span, and a kink of the camber line's curvature
    assert np.abs(found - surface_frame(TWISTED, s, xi)).max() < 3e-3


def test_ply_angle_turns_about_the_normal(twisted) -> None:
    at = twisted.fem(*TWISTED.place(0.37, [0.52, 0.03]))
    straight, turned = (
        np.reshape(surface_axes(TWISTED, twisted, "blade", angle)(at), (3, 3))
        for angle in (0.0, 0.5)
    )
    assert turned[:, 2] == pytest.approx(straight[:, 2])
    assert turned[:, 0] == pytest.approx(
        np.cos(0.5) * straight[:, 0] + np.sin(0.5) * straight[:, 1]
    )


def test_sweep_turns_the_zero_of_the_ply_angle_with_the_reference_line() -> None:
    swept = replace(FLAT, sweep=formula("0.3*s"))
    frame = surface_frame(swept, 0.5, 0.5)
    assert frame[:, 0] == pytest.approx(np.array([0.3, 0.0, 1.0]) / np.hypot(1.0, 0.3))
    assert frame[:, 2] == pytest.approx([0.0, 1.0, 0.0], abs=1e-9)


def test_a_blade_wound_up_is_refused() -> None:
    wound = replace(FLAT, blade_angle=formula("6*s"))
    with pytest.raises(GeometryError, match="more than 150 degrees"):
        surface_axes(wound, blade_basis(wound), "blade")


@pytest.mark.parametrize("blade", [FLAT, TWISTED], ids=["flat", "twisted"])
def test_depth_is_zero_on_the_faces_and_sums_to_the_thickness(blade: Blade) -> None:
    basis = blade_basis(blade)
    depth = surface_depth(blade, basis, "blade")
    for side, field in ((-1, depth.below), (+1, depth.above)):
        face = "lower" if side < 0 else "upper"
        nodes = basis.nodes_of(face, 1)
        values = basis.to_values(np.array(field.vec))[nodes]
        corners = nodes[nodes < basis.fem.nv]
        assert values[: len(corners)] == pytest.approx(np.zeros(len(corners)), abs=1e-9)
    s, xi, share = 0.4, 0.3, 0.7
    lower, upper = (float(blade.face_height(side, s, xi)) for side in (-1, +1))
    chord = float(blade.chord(np.array(s)))
    at = basis.fem(*blade.place(s, [xi, lower + share * (upper - lower)]))
    thickness = chord * (upper - lower)
    assert depth.below(at) == pytest.approx(share * thickness, rel=0.02)
    assert depth.above(at) == pytest.approx((1 - share) * thickness, rel=0.03)
