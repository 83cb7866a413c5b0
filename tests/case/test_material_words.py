# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a case may say about materials, and what it is told about the rest."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import TypeAdapter, ValidationError

from quietblade.case.laminate import LaminateWords
from quietblade.case.library import LAW_OF, NAMES, NOTE_OF, SOURCE_OF, library_material
from quietblade.case.materials import (
    LAWS,
    AnisotropicWords,
    MaterialWords,
    NeoHookeanWords,
    OrthotropicWords,
    SolidWords,
    ply_findings,
)
from quietblade.materials import LIBRARY

ADAPTER: TypeAdapter[SolidWords] = TypeAdapter(MaterialWords)
RUBBER = {
    "law": "neo-hookean", "density": "1100 kg/m^3", "shear_modulus": "1.5 MPa",
    "bulk_modulus": "2 GPa", "loss_factor": 0.3,
}  # fmt: skip
STACK = {
    "law": "laminate",
    "model": "plies",
    "plies": [
        {"material": "carbon-epoxy-t300", "angle": "0 deg", "fraction": 0.25},
        {"material": "glass-epoxy-woven", "angle": "45 deg", "fraction": "75 %"},
    ],
}
WEAVE = {
    "law": "orthotropic", "density": "1500 kg/m^3", "E1": "65 GPa", "E2": "65 GPa", "E3": "10 GPa",
    "G12": "5 GPa", "G23": "3 GPa", "G13": "3 GPa", "nu12": 0.04, "nu23": 0.2, "nu13": 0.2,
}  # fmt: skip


def words(table: dict[str, Any], **changes: Any) -> SolidWords:
    return ADAPTER.validate_python(table | changes)


def fault(table: dict[str, Any], **changes: Any) -> tuple[str, str, tuple[Any, ...]]:
    """Message, remedy and place of the only problem."""
    with pytest.raises(ValidationError) as caught:
        words(table, **changes)
    (problem,) = caught.value.errors()
    context = problem["ctx"]
    return context["message"], context["remedy"], (*problem["loc"][1:], *context["at"])


def test_neo_hookean() -> None:
    rubber = words(RUBBER)
    assert isinstance(rubber, NeoHookeanWords)
    assert (rubber.shear_modulus, rubber.bulk_modulus, rubber.loss_factor) == (1.5e6, 2e9, 0.3)
    message, remedy, at = fault(RUBBER, bulk_modulus="1 MPa")
    assert "Poisson's ratio would be negative" in message
    assert "units" in remedy
    assert at == ("bulk_modulus",)


def test_laminate() -> None:
    stack = words(STACK)
    assert isinstance(stack, LaminateWords)
    assert (stack.model, stack.drape, stack.repeat) == ("plies", "symmetric", 1)
    assert stack.plies[1].angle == pytest.approx(np.pi / 4)
    assert stack.plies[1].fraction == 0.75
    assert stack.loss_factor is None
    again = ADAPTER.validate_python(stack.model_dump(mode="json"), context={"si": True})
    assert again == stack


PLY = STACK["plies"][0]


@pytest.mark.parametrize(
    ("changes", "message", "at"),
    [
        ({"model": "smeared"}, "is not a model of a laminate", ("model",)),
        ({"drape": "symetric"}, "is not a way to drape a laminate", ("drape",)),
        ({"plies": []}, "a list of 1 or more entries is needed", ("plies",)),
        ({"plies": [PLY]}, "the fractions sum to 0.25 and must sum to 1", ("plies",)),
        (
            {"plies": [PLY, {"material": "x", "angle": "0 deg", "thickness": "1 mm"}]},
            "some plies have a thickness and some a fraction",
            ("plies",),
        ),
        (
            {"plies": [{"material": "x", "angle": "0 deg"}]},
            "a ply needs either a thickness or a fraction",
            ("plies", 0),
        ),
        (
            {"plies": [PLY | {"thickness": "1 mm"}]},
            "a ply needs either a thickness or a fraction",
            ("plies", 0),
        ),
        ({"plies": [PLY | {"angle": 45}]}, "a bare number", ("plies", 0, "angle")),
        ({"repeat": 0}, "must be from 1 to 1000", ("repeat",)),
        ({"loss_factor": -0.1}, "must be from 0 to 10", ("loss_factor",)),
    ],
)
def test_laminates_that_cannot_be(changes, message, at) -> None:
    found, remedy, place = fault(STACK, **changes)
    assert message in found
    assert remedy
    assert place == at


def test_plies_name_materials_that_can_be_plies() -> None:
    data = {
        "materials": {
            "stack": STACK | {"plies": [PLY | {"material": "carbon-epoxy-t30"}, PLY]},
            "odd": STACK | {"plies": [PLY | {"material": "neoprene-60"}]},
            "broken": {"plies": 3},
        }
    }
    missing, unfit = ply_findings(data, LAW_OF)
    assert missing.path == ("materials", "stack", "plies", 0, "material")
    assert missing.remedy == 'Did you mean "carbon-epoxy-t300"?'
    assert "neo-hookean, which a ply cannot have" in unfit.message
    assert "isotropic or orthotropic" in unfit.remedy


def gigapascals(C: np.ndarray) -> list[list[str]]:
    return [[f"{entry!r} GPa" for entry in row] for row in C.tolist()]


def test_anisotropic() -> None:
    C = np.diag([9.0, 8.0, 7.0, 3.0, 2.0, 1.0])
    C[0, 5] = C[5, 0] = -1.5
    table = {"law": "anisotropic", "density": "1 g/cm^3", "stiffness": gigapascals(C)}
    solid = words(table)
    assert isinstance(solid, AnisotropicWords)
    assert np.array(solid.stiffness) == pytest.approx(1e9 * C)
    plain = solid.model_dump(mode="json")
    assert ADAPTER.validate_python(plain, context={"si": True}) == solid
    C[0, 5] = 1.5
    assert "row 1, column 6" in fault(table, stiffness=gigapascals(C))[0]
    C[0, 5] = C[5, 0] = -4.0
    message, _, at = fault(table, stiffness=gigapascals(C))
    assert "is not positive definite: the least eigenvalue" in message
    assert at == ("stiffness",)
    assert "has 5 entries and needs 6" in fault(table, stiffness=gigapascals(C[:5]))[0]


@settings(max_examples=100, deadline=None)
@given(st.lists(st.integers(-1000, 1000), min_size=21, max_size=21))
def test_stiffness_is_refused_exactly_if_it_is_indefinite(entries: list[int]) -> None:
    C = np.zeros((6, 6))
    C[np.triu_indices(6)] = np.array(entries) / 1000
    C += np.triu(C, 1).T + 1.5 * np.eye(6)
    least = float(np.linalg.eigvalsh(C)[0])
    if abs(least) < 1e-6:
        return  # on the border, where rounding decides
    table = {"law": "anisotropic", "density": 1000.0, "stiffness": (1e9 * C).tolist()}
    if least > 0.0:
        ADAPTER.validate_python(table, context={"si": True})
    else:
        with pytest.raises(ValidationError, match="not positive definite"):
            ADAPTER.validate_python(table, context={"si": True})


def test_strengths_come_together() -> None:
    strengths = {"Xt": "1.5 GPa", "Xc": "900 MPa", "Yt": "27 MPa", "Yc": "200 MPa", "S12": "80 MPa"}
    full = words(WEAVE, **strengths)
    assert isinstance(full, OrthotropicWords)
    assert full.strengths == (1.5e9, 9e8, 27e6, 2e8, 8e7)
    none = words(WEAVE)
    assert isinstance(none, OrthotropicWords)
    assert none.strengths is None
    message, remedy, at = fault(WEAVE, Xt="1.5 GPa")
    assert message == "only Xt of the five strengths are given"
    assert "or none" in remedy
    assert at == ("Xt",)


def test_structural_loss_is_zero_unless_given() -> None:
    assert words(WEAVE).loss_factor == 0.0
    assert words(WEAVE, loss_factor=0.01).loss_factor == 0.01


def test_loss_of_a_film_may_name_its_model() -> None:
    assert words(RUBBER, loss_factor={"model": "constant", "value": 0.25}) == words(
        RUBBER, loss_factor=0.25
    )
    message, remedy, at = fault(RUBBER, loss_factor={"model": "constnt", "value": 0.25})
    assert message == "names no known model of the loss"
    assert 'Did you mean "constant"?' in remedy
    assert at == ("loss_factor", "model")


@pytest.mark.parametrize("name", NAMES)
def test_library_of_the_case_is_that_of_the_materials(name: str) -> None:
    entry, said = LIBRARY[name], library_material(name)
    assert (SOURCE_OF[name], NOTE_OF[name]) == (entry.source, entry.note)
    assert LAW_OF[name] == said.law in LAWS
    assert said.density == entry.material.density
    assert said.loss_factor == entry.material.loss_factor
    assert tuple(LIBRARY) == NAMES


def test_source_is_free_text() -> None:
    assert words(WEAVE, source="measured here").source == "measured here"
