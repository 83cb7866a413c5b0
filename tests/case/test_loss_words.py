# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a case may say about the loss of its materials, and what it is told about the rest."""

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from quietblade.case import Case, InvalidCaseError
from quietblade.case.loss import ArrheniusWords, ModulusTableWords, WlfWords, ZenerWords
from quietblade.case.presets import preset_text
from quietblade.study.losses import moduli

ZENER = {
    "model": "fractional-zener", "stiffening": 12.0, "relaxation_time": "0.2 ms", "exponent": 0.7,
}  # fmt: skip
WLF = {"law": "wlf", "c1": 8.86, "c2": "101.6 K", "reference": "20 degC"}
TABLE = {"model": "table", "file": "rubber.csv"}


def case(loss: Any, part: str = "polymer", **changes: Any) -> Case:
    varied = {key.replace("__", "."): value for key, value in changes.items()}
    return Case.parse(preset_text("paper-composite"), "blade.toml").varied(
        {f"materials.{part}.loss_factor": loss} | varied
    )


def problems(loss: Any, part: str = "polymer", **changes: Any) -> str:
    with pytest.raises(InvalidCaseError) as caught:
        case(loss, part, **changes)
    return str(caught.value)


def test_a_constant_is_a_number_however_it_is_said() -> None:
    assert case({"model": "constant", "value": 0.25}) == case(0.25)
    assert case({"model": "constant", "value": 0.25}).content_key() == case(0.25).content_key()


def test_models_have_units_and_round_trip() -> None:
    words = case(ZENER | {"temperature": "10 degC", "shift": WLF}).loss("film")[1]
    assert isinstance(words, ZenerWords)
    assert (words.stiffening, words.relaxation_time, words.exponent) == (12.0, 2e-4, 0.7)
    assert words.temperature == pytest.approx(283.15)
    assert words.shift == WlfWords(law="wlf", c1=8.86, c2="101.6 K", reference="293.15 K")
    whole = {
        "model": "maxwell",
        "strengths": [1.0, 2],
        "relaxation_times": ["1 s", "1 ms"],
        "temperature": "288.15 K",
        "shift": {"law": "arrhenius", "energy": "80 kJ/mol", "reference": "20 °C"},
        "prestrain": [
            {"shear": 0.05, "factor": 1.2},
            {"shear": 0.1, "loss_factor": 0.3},
            {"shear": 0.2, "loss_factor": TABLE},
        ],
    }
    said = case(whole)
    words = said.loss("film")[1]
    assert words.shift == ArrheniusWords(law="arrhenius", energy="80000 J/mol", reference="20 degC")
    assert words.prestrain[1].loss_factor == 0.3
    assert isinstance(words.prestrain[2].loss_factor, ModulusTableWords)
    again = Case.from_plain(json.loads(json.dumps(said.plain())))
    assert again == said
    assert again.content_key() == said.content_key()


def test_files_of_moduli_count_by_what_they_say(tmp_path: Path) -> None:
    (tmp_path / "blade.toml").write_text(preset_text("paper-composite"))
    said = Case.load(tmp_path / "blade.toml").varied(
        {
            "materials.polymer.loss_factor": TABLE
            | {"prestrain": [{"shear": 1, "loss_factor": TABLE}]},
            "materials.woven-carbon.loss_factor": TABLE,
        }
    )
    assert set(said.files) == {
        "film.loss_factor.file", "film.loss_factor.prestrain[0].loss_factor.file",
        "blade.loss_factor.file",
    }  # fmt: skip
    assert said.files["film.loss_factor.file"] == tmp_path / "rubber.csv"
    before = said.content_key()
    (tmp_path / "rubber.csv").write_text("frequency [Hz]")
    assert said.content_key() != before


@pytest.mark.parametrize(
    ("loss", "fragments"),
    [
        ("soft", ["polymer.loss_factor", "a number is needed"]),
        (-0.1, ["must be from 0 to 10"]),
        ({}, ["names no known model of the loss", '"fractional-zener"']),
        ({"model": "maxwel"}, ["loss_factor.model", 'Did you mean "maxwell"?']),
        ({"model": "constant"}, ["loss_factor.value", "is missing", "Loss factor eta"]),
        ({"model": "constant", "value": 0.1, "temperature": "3 degC"}, ["unknown key"]),
        (ZENER | {"stiffening": 1.0}, ["loss_factor.stiffening", "must be above 1"]),
        (ZENER | {"exponent": 1.1}, ["loss_factor.exponent", "must be above 0 to 1"]),
        (ZENER | {"relaxation_time": 3.0}, ["relaxation_time", "a time with its unit"]),
        (ZENER | {"relaxation_time": "3 Hz"}, ["relaxation_time", "a frequency where a time"]),
        (ZENER | {"stifening": 2.0}, ["stifening", 'Did you mean "stiffening"?']),
        (ZENER | {"temperature": "10 degC"}, ["loss_factor.temperature", "no shift"]),
        (ZENER | {"shift": WLF}, ["loss_factor.shift", "no temperature"]),
        (
            ZENER | {"temperature": "10 mm", "shift": WLF},
            ["temperature", "a length where a temperature is needed", "degC"],
        ),
        (
            ZENER | {"temperature": "-300 degC", "shift": WLF},
            ["temperature", "must be greater than zero"],
        ),
        (
            ZENER | {"temperature": "3 degC", "shift": WLF | {"law": "vlf"}},
            ["shift.law", 'Did you mean "wlf"?'],
        ),
        (
            ZENER | {"temperature": "3 degC", "shift": {"law": "arrhenius", "reference": "3 K"}},
            ["shift.energy", "is missing", "80 kJ/mol"],
        ),
        (ZENER | {"temperature": "3 degC", "shift": 3}, ["loss_factor.shift", "a table is needed"]),
        (
            {"model": "maxwell", "strengths": [1.0], "relaxation_times": ["1 s", "2 s"]},
            ["relaxation_times", "1 strengths and 2 relaxation times"],
        ),
        (
            {"model": "maxwell", "strengths": [], "relaxation_times": []},
            ["strengths", "1 or more entries"],
        ),
        ({"model": "table", "file": " "}, ["loss_factor.file", "names no file"]),
        (
            ZENER | {"prestrain": [{"shear": 0.1}, {"shear": 0.1}]},
            ["loss_factor.prestrain", "do not ascend"],
        ),
        (ZENER | {"prestrain": [{"shear": 0.0}]}, ["prestrain[0].shear", "must be above 0"]),
        (ZENER | {"prestrain": [{"sheer": 0.1}]}, ["prestrain[0].sheer", '"shear"?']),
        (
            ZENER | {"prestrain": [{"shear": 0.1, "loss_factor": ZENER | {"expnent": 1}}]},
            ["prestrain[0].loss_factor.expnent", '"exponent"?'],
        ),
        (
            ZENER
            | {"prestrain": [{"shear": 1, "loss_factor": ZENER | {"prestrain": [{"shear": 1}]}}]},
            ["prestrain[0].loss_factor.prestrain", "only the loss of a film"],
        ),
    ],
)
def test_what_is_refused(loss: Any, fragments: list[str]) -> None:
    message = problems(loss)
    for fragment in ("blade.toml:", "materials.polymer.loss_factor", *fragments):
        assert fragment in message


def test_every_problem_of_a_model_is_told() -> None:
    message = problems({"model": "fractional-zener", "stiffening": 0.5, "exponent": 3})
    assert len(message.splitlines()) == 3


def test_static_shear_is_for_films() -> None:
    message = problems(ZENER | {"prestrain": [{"shear": 0.1}]}, "woven-carbon")
    assert "materials.woven-carbon.loss_factor.prestrain" in message
    assert "only the loss of a film" in message


def test_one_loss_factor_on_the_whole_tangent_has_no_model() -> None:
    message = problems(ZENER, acoustics__loss="paper")
    assert "acoustics.loss" in message
    assert 'Use loss = "isochoric"' in message
    assert case(ZENER, "woven-carbon", acoustics__loss="paper").acoustics.loss == "paper"


WHOLE = ZENER | {
    "temperature": "10 degC",
    "shift": WLF,
    "prestrain": [{"shear": 0.1, "factor": 2.0, "loss_factor": TABLE}],
}
PLACES = [
    ("model",), ("stiffening",), ("relaxation_time",), ("exponent",), ("temperature",), ("shift",),
    ("shift", "law"), ("shift", "c2"), ("prestrain",), ("prestrain", 0), ("prestrain", 0, "shear"),
    ("prestrain", 0, "loss_factor"), ("prestrain", 0, "loss_factor", "file"), ("odd",),
]  # fmt: skip
VALUES = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5),
    st.sampled_from(["table", "maxwell", "1 s", "1e999 degC", "5 K", "\x00", "9" * 400]),
    st.just([]), st.just({}), st.just([{}]), st.just({"model": "table"}), st.just([ZENER]),
)  # fmt: skip


@settings(max_examples=60, deadline=None)
@given(place=st.sampled_from(PLACES), value=VALUES)
@example(place=("prestrain", 0, "loss_factor", "file"), value="9" * 400)
@example(place=("prestrain", 0, "loss_factor", "file"), value="\x00")
def test_whatever_stands_in_a_model_it_is_a_case_or_messages(place, value) -> None:
    loss: Any = json.loads(json.dumps(WHOLE))
    table = loss
    for part in place[:-1]:
        table = table[part]
    table[place[-1]] = value
    try:
        said = case(loss)
        said.content_key()
        moduli(said)
    except InvalidCaseError as error:
        for problem in error.problems:
            assert problem.message
            assert problem.key.startswith("materials.polymer.loss_factor")
