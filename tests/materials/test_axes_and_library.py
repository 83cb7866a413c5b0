# SPDX-License-Identifier: LGPL-2.1-or-later
import ngsolve as ngs
import numpy as np
import pytest

from quietblade.errors import MaterialError
from quietblade.materials import (
    LIBRARY,
    IsotropicSVK,
    MooneyRivlin,
    OrthotropicSVK,
    PlyStrength,
    find_material,
    ply_axes,
    section_directions,
)
from verification.structure_models import box_mesh


def test_section_directions_follow_the_convention() -> None:
    span, chordwise, thickness = section_directions(0.3)
    assert chordwise == pytest.approx([np.cos(0.3), -np.sin(0.3), 0.0])
    assert thickness == pytest.approx([np.sin(0.3), np.cos(0.3), 0.0])
    assert np.cross(chordwise, thickness) == pytest.approx(span)
    assert span == pytest.approx([0.0, 0.0, 1.0])


def test_ply_angle_turns_from_the_span_to_the_chord_about_the_thickness() -> None:
    span, chordwise, thickness = section_directions(0.3)
    axes = ply_axes(np.radians(30.0), span, chordwise, thickness)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert axes[:, 0] @ span == pytest.approx(np.cos(np.radians(30.0)))
    assert axes[:, 0] @ chordwise == pytest.approx(0.5)
    assert axes[:, 2] == pytest.approx(thickness)
    right_angle = ply_axes(np.pi / 2, span, chordwise, thickness)
    assert right_angle[:, 0] == pytest.approx(chordwise)


def test_axes_of_a_twisted_blade_are_those_of_each_section() -> None:
    plane = np.array([0.0, 1.0])
    mesh = box_mesh(plane, plane, plane)
    twist = 0.4 - 0.6 * ngs.z
    turning = ply_axes(0.7, *section_directions(twist))
    for z in (0.1, 0.8):
        fixed = ply_axes(0.7, *section_directions(0.4 - 0.6 * z))
        assert np.array(turning(mesh(0.5, 0.5, z))).reshape(3, 3) == pytest.approx(fixed)


def test_axes_that_are_no_rotation_are_refused() -> None:
    span, chordwise, thickness = section_directions()
    with pytest.raises(MaterialError, match=r"not a rotation.*det A = -1"):
        ply_axes(0.0, span, chordwise, -thickness)
    carbon = find_material("woven-carbon-paper")
    assert isinstance(carbon, OrthotropicSVK)
    with pytest.raises(MaterialError, match=r"\|A\^T A - 1\| = 3"):
        carbon.oriented(2 * np.eye(3))
    with pytest.raises(MaterialError, match=r"shape \(3,\)"):
        carbon.oriented(np.ones(3))
    with pytest.raises(MaterialError, match=r"dimensions \(3,\)"):
        carbon.oriented(ngs.CF((1, 0, 0)))


def test_library_knows_the_papers_materials_and_their_source() -> None:
    paper = {"aluminium-paper", "woven-carbon-paper", "viscoelastic-paper"}
    assert paper < set(LIBRARY)
    assert all("Table 2" in LIBRARY[name].source for name in paper)
    film = find_material("viscoelastic-paper")
    assert isinstance(film, MooneyRivlin)
    assert film.shear_modulus == pytest.approx(1.522e6)
    with pytest.raises(MaterialError, match="Did you mean 'aluminium-paper'"):
        find_material("aluminum-paper")


@pytest.mark.parametrize("name", LIBRARY)
def test_every_material_of_the_library_says_where_it_is_from(name: str) -> None:
    entry = LIBRARY[name]
    assert entry.name == entry.material.name == name
    assert len(entry.source) > 20
    assert entry.note


def test_unidirectional_plies_of_the_library_are_transversely_isotropic() -> None:
    for name in ("carbon-epoxy-t300", "carbon-epoxy-as4", "glass-epoxy-ud"):
        ply = find_material(name)
        assert isinstance(ply, OrthotropicSVK)
        assert ply.g23 == pytest.approx(ply.e2 / (2 * (1 + ply.nu23)), rel=1e-3)
        assert (ply.e2, ply.g12, ply.nu12) == (ply.e3, ply.g13, ply.nu13)
        assert ply.strength is not None
        # compression along fibres is weaker than tension, across them stronger
        assert ply.strength.xc < ply.strength.xt
        assert ply.strength.yc > ply.strength.yt


def test_strengths_are_positive() -> None:
    with pytest.raises(MaterialError, match="yc > 0"):
        PlyStrength(1.0, 1.0, 1.0, -1.0, 1.0)
    with pytest.raises(MaterialError, match="yield_strength > 0"):
        IsotropicSVK("metal", 1.0, 1.0, 0.3, yield_strength=0.0)
