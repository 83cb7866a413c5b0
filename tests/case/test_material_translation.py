# SPDX-License-Identifier: LGPL-2.1-or-later
"""From the words of a material to the solid on a mesh."""

from dataclasses import replace
from math import radians
from typing import Any

import numpy as np
import pytest

from quietblade.case import Case, InvalidCaseError
from quietblade.case.library import LAW_OF, NAMES
from quietblade.case.presets import preset_text
from quietblade.materials import (
    LIBRARY,
    AnisotropicSVK,
    IsotropicSVK,
    MooneyRivlin,
    NeoHookean,
    OrthotropicSVK,
    ply_axes,
    section_directions,
    surface_frame,
)
from quietblade.mesh.nodal import NodalBasis
from quietblade.study import solids, translate
from tests.materials.blades import blade_basis


def preset(name: str, **changes: Any) -> Case:
    case = Case.parse(preset_text(name), f"{name}.toml")
    return case.varied({key.replace("__", "."): value for key, value in changes.items()})


def materials_of(case: Case) -> dict[str, Any]:
    blade = translate.build_blade(case)
    return dict(solids.build_materials(case, blade, blade_basis(blade, (4, 3, 4), film=True)))


def with_laminate(model: str, *, repeat: int = 1, angle: str = "90 deg") -> Case:
    """A blade of two plies of the library's carbon."""
    plies = [
        {"material": "carbon-epoxy-t300", "angle": "0 deg", "fraction": 0.5},
        {"material": "carbon-epoxy-t300", "angle": angle, "fraction": 0.5},
    ]
    table = {"law": "laminate", "model": model, "plies": plies, "repeat": repeat}
    return preset("paper-aluminium", materials__stack=table, blade__material="stack")


def test_materials_of_the_paper() -> None:
    materials = materials_of(preset("paper-aluminium"))
    assert materials["blade"] == IsotropicSVK("aluminium", 2500.0, 65e9, 0.36)
    assert materials["film"] == MooneyRivlin("polymer", 1400.0, 0.238e6, 0.523e6, 2.2e9, 0.21)


@pytest.mark.parametrize("name", NAMES)
def test_library_of_the_case_is_the_library_of_materials(name: str) -> None:
    part = "film" if LAW_OF[name] == "mooney-rivlin" else "blade"
    if LAW_OF[name] == "neo-hookean":
        part = "film"
    made = materials_of(preset("paper-aluminium", **{f"{part}__material": name}))[part]
    wanted = LIBRARY[name].material
    if isinstance(made, OrthotropicSVK):
        made = replace(made, axes=np.eye(3))
        assert all(getattr(made, k) == getattr(wanted, k) for k in made.__dict__ if k != "axes")
    else:
        assert made == wanted


def test_axes_of_the_papers_blade_are_constant() -> None:
    made = materials_of(preset("paper-composite"))["blade"]
    wanted = ply_axes(radians(45.0), *section_directions(0.0))
    assert np.asarray(made.axes) == pytest.approx(wanted, abs=1e-9)


def test_fibres_and_film_follow_the_surface_of_a_twisted_blade() -> None:
    case = preset("twisted", blade__material="woven-carbon-paper")
    blade = translate.build_blade(case)
    basis = blade_basis(blade, (8, 3, 16), film=True)
    made = solids.build_materials(case, blade, basis)["blade"]
    assert isinstance(made, OrthotropicSVK)
    film = solids.surface_axes(blade, basis)
    for s, xi in ((0.1, 0.3), (0.52, 0.2), (0.93, 0.7)):
        height = float(blade.family.camber_line(xi, blade.camber(np.array(s)))[0])
        at = basis.fem(*blade.place(s, [xi, height]))
        frame = surface_frame(blade, s, xi)
        assert np.reshape(film(at), (3, 3)) == pytest.approx(frame, abs=5e-3)
        fibres = np.reshape(made.axes(at), (3, 3))
        assert fibres == pytest.approx(ply_axes(radians(45.0), *frame.T), abs=5e-3)


def test_film_of_a_metal_blade_may_be_neo_hookean() -> None:
    case = preset("paper-aluminium", film__material="neoprene-60")
    assert isinstance(materials_of(case)["film"], NeoHookean)


def test_homogenised_laminate_arrives() -> None:
    made = materials_of(with_laminate("homogenised"))["blade"]
    assert isinstance(made, AnisotropicSVK)
    assert made.name == "stack"
    assert made.density == 1550.0
    C = np.asarray(made.stiffness)
    assert C.shape == (6, 6)
    assert C[0, 0] == pytest.approx(C[1, 1])


def test_plies_arrive_in_their_places() -> None:
    case = with_laminate("plies")
    blade = translate.build_blade(case)
    basis: NodalBasis = blade_basis(blade, (4, 3, 4), film=True)
    made = solids.build_materials(case, blade, basis)["blade"]
    assert isinstance(made, AnisotropicSVK)
    at = [basis.fem(*blade.place(0.02, [0.5, height])) for height in (0.0, 0.022)]
    middle, outside = (np.reshape(made.stiffness(place), (6, 6)) for place in at)
    assert outside[0, 0] > 2.0 * outside[1, 1]  # fibres along the span outside
    assert middle[1, 1] > 2.0 * middle[0, 0]


def test_repeats_are_plies_of_their_own() -> None:
    case = with_laminate("plies", repeat=3)
    words = case.material("blade")
    laminate = solids.build_laminate(case, "stack", words)  # type: ignore[arg-type]
    assert [ply.angle for ply in laminate.plies] == pytest.approx([0.0, np.pi / 2] * 3)
    assert laminate.total == pytest.approx(1.0)


def test_estimates_know_laminates() -> None:
    homogenised, plies = with_laminate("homogenised"), with_laminate("plies")
    assert solids.blade_density(plies) == 1550.0
    assert solids.blade_density(preset("paper-aluminium")) == 2500.0
    # [0/90] by laminate theory, with 7/8 of the inertia along the fibres
    assert solids.bending_modulus(plies) == pytest.approx((7 * 138e9 + 11e9) / 8, rel=0.01)
    assert solids.bending_modulus(homogenised) == pytest.approx(0.5 * (138e9 + 11e9), rel=0.01)
    (notice,) = solids.laminate_notices(homogenised)
    assert notice.value == pytest.approx(0.39, abs=0.01)
    assert 'model = "plies"' in notice.remedy
    assert not list(solids.laminate_notices(plies))
    assert not list(solids.laminate_notices(with_laminate("homogenised", angle="0 deg")))
    assert solids.used_materials(plies) >= {"stack", "carbon-epoxy-t300"}


def test_bending_modulus_of_a_turned_weave_is_that_of_jones() -> None:
    # 1 / Ex = c^4/E1 + s^4/E2 + (1/G12 - 2 nu12/E1) s^2 c^2
    case = preset("paper-composite")
    wanted = 1.0 / (0.5 / 65e9 + 0.25 * (1 / 5e9 - 0.08 / 65e9))
    assert solids.bending_modulus(case) == pytest.approx(wanted, rel=1e-9)


def test_a_stack_that_cannot_be_is_told_with_its_line() -> None:
    case = preset(
        "paper-aluminium",
        materials__lossy={
            "law": "isotropic", "density": "1 g/cm^3", "E": "1 GPa", "nu": 0.3, "loss_factor": 0.1,
        },
        materials__stack={
            "law": "laminate",
            "model": "homogenised",
            "plies": [
                {"material": "lossy", "angle": "0 deg", "fraction": 0.5},
                {"material": "carbon-epoxy-t300", "angle": "0 deg", "fraction": 0.5},
            ],
        },
        blade__material="stack",
    )  # fmt: skip
    with pytest.raises(InvalidCaseError, match=r"blade\.material.*one loss factor") as caught:
        materials_of(case)
    assert caught.value.problems[0].file == "paper-aluminium.toml"
