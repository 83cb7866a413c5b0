# SPDX-License-Identifier: LGPL-2.1-or-later
"""Excitations and transfer functions of a case file: words, units, tables and messages."""

from pathlib import Path

import numpy as np
import pytest

from quietblade.case import Case, InvalidCaseError
from quietblade.case.excitation import PatchWords, PushWords, RootMotionWords
from quietblade.case.presets import preset_text
from quietblade.study.spectra import names, read_spectrum, spectra

TEXT = preset_text("paper-aluminium")
START = TEXT.index("[excitation]")
END = TEXT.index("\n[", START) + 1
PATCH = "span = [0.9, 0.95]\nchord = [0.3, 0.7]\n"
PUSH = '[[excitation]]\nkind = "point-force"\ndirection = [0, -1, 0]\nat = [0.5, 0.5]\n'
SHAKE = '[[excitation]]\nkind = "root-motion"\nmotion = "velocity"\naxis = "y"\n'
RANDOM = {"acoustics.signal": "random"}
SPRINGS = {"root": {"support": "elastic", "rotation": ["1 MN*m/rad"] * 3}}


def with_words(words: str) -> str:
    return TEXT[:START] + words + "\n" + TEXT[END:]


def test_one_table_is_a_list_of_one() -> None:
    one = Case.parse(with_words("[excitation]\n" + PATCH))
    listed = Case.parse(with_words("[[excitation]]\n" + PATCH))
    assert one.excitation == listed.excitation
    assert one.content_key() == listed.content_key()
    (patch,) = one.excitation
    assert isinstance(patch, PatchWords)
    assert patch.side == "upper"
    again = Case.from_plain(one.plain())
    assert again == one
    assert again.content_key() == one.content_key()


def test_units_of_each_kind() -> None:
    words = "[[excitation]]\n" + PATCH + PUSH + 'force = "3 N"\n' + SHAKE + 'amplitude = "2 mm/s"'
    case = Case.parse(with_words(words))
    _, push, shake = case.excitation
    assert isinstance(push, PushWords)
    assert (push.force, push.unit) == (3.0, "N")
    assert isinstance(shake, RootMotionWords)
    assert (shake.amplitude, shake.unit, shake.density_unit) == (2e-3, "m/s", "m^2/s^2/Hz")
    assert names(case) == ("pressure", "point-force", "root-motion")
    assert Case.from_plain(case.plain()) == case


def test_names_tell_loads_of_one_kind_apart() -> None:
    named = PUSH + 'force = "3 N"\nname = "shaker"\n' + PUSH + 'force = "1 N"\n' + PUSH
    case = Case.parse(with_words(named + 'force = "2 N"\n'))
    assert names(case) == ("shaker", "point-force", "point-force 2")


def test_densities_of_random_loads() -> None:
    case = Case.parse(with_words("[excitation]\n" + PATCH)).varied(
        {**RANDOM, "excitation.density": "4 kPa^2/Hz", "acoustics.correlation": "full"}
    )
    assert case.excitation[0].density_value == pytest.approx(4e6)


@pytest.mark.parametrize(
    ("words", "changes", "key", "told"),
    [
        ("[[excitation]]\n" + PATCH + "[[excitation]]\n" + PATCH, {}, "excitation[1].span",
         ("touches that of excitation[0]", "gap")),
        ("[excitation]\nspan = [0.9, 1.2]\nchord = [0.3, 0.7]", {}, "excitation.span[1]",
         ("at most 1",)),
        ("[[excitation]]\nspan = [0.9, 1.2]\nchord = [0.3, 0.7]", {}, "excitation[0].span[1]",
         ("at most 1",)),
        ("[excitation]\nspan = [0.9, 0.95]", {}, "excitation.chord", ("is missing",)),
        ('[excitation]\nkind = "force"\n', {}, "excitation.kind",
         ("not a kind of excitation", '"line-force"')),
        ("", {}, "excitation", ("table is missing", "span, chord")),
        (PUSH, {}, "excitation[0]", ("no amplitude", 'force = "120 N"')),
        (PUSH + 'force = "3 Pa"', {}, "excitation[0].force", ("a pressure where a force",)),
        (PUSH + 'force = "3 N"\ntable = "a.csv"', {}, "excitation[0].table",
         ("beside force", "Keep one")),
        (PUSH.replace("[0, -1, 0]", "[0, 0, 0]") + 'force = "3 N"', {}, "excitation[0].direction",
         ("points nowhere",)),
        (PUSH + 'force = "3 N"\nname = "a"\n' + PUSH + 'force = "3 N"\nname = "a"', {},
         "excitation[1].name", ("names two",)),
        (SHAKE + 'amplitude = "1 mm"', {}, "excitation[0].amplitude",
         ("a length where a speed is needed",)),
        (SHAKE.replace("velocity", "velocty") + 'amplitude = "1 mm/s"', {},
         "excitation[0].motion", ('Did you mean "velocity"',)),
        (SHAKE + 'amplitude = "1 mm/s"', SPRINGS, "excitation[0].kind",
         ("stands on springs", "[transfer.shaft]")),
        ("[excitation]\n" + PATCH, RANDOM, "excitation", ("no density", 'signal = "harmonic"')),
        ("[excitation]\n" + PATCH + 'pressure = "1 Pa"', RANDOM, "excitation.pressure",
         ("the signal is random",)),
        ("[excitation]\n" + PATCH + 'density = "1 Pa^2/Hz"', {}, "excitation.density",
         ("the signal is harmonic",)),
        ("[excitation]\n" + PATCH + 'density = "1 Pa^2/Hz"\nphase = "9 deg"', RANDOM,
         "excitation.phase", ("means nothing",)),
        ("[excitation]\n" + PATCH, {"acoustics.correlation": "full"}, "acoustics.correlation",
         ("harmonic loads",)),
        ("[excitation]\n" + PATCH, {"transfer": {"functions": ["mobilty"]}},
         "transfer.functions[0]", ('Did you mean "mobility"',)),
        ("[excitation]\n" + PATCH, {"transfer": {"functions": ["shaft"]}}, "transfer.functions",
         ("not described", "translation_damping")),
        ("[excitation]\n" + PATCH,
         {"transfer": {"functions": ["shaft"], "shaft": {"mass": ["1 kg", "1 kg", "1 kg"]}}},
         "transfer.shaft", ("takes no power", "translation_damping")),
        ("[excitation]\n" + PATCH,
         {"transfer": {"functions": ["mobility"],
                       "shaft": {"rotation_damping": ["1 N*m*s/rad"] * 3}}},
         "transfer.shaft", ("not asked for",)),
        ("[excitation]\n" + PATCH, {**SPRINGS, "transfer": {"functions": ["blocked-force"]}},
         "transfer.functions", ("root stands on springs",)),
        (SHAKE + 'amplitude = "1 mm/s"',
         {"transfer": {"functions": ["shaft"],
                       "shaft": {"rotation_damping": ["1 N*m*s/rad"] * 3}}},
         "transfer.shaft", ("forces on the blade",)),
    ],
)  # fmt: skip
def test_what_cannot_be_is_told(
    words: str, changes: dict[str, object], key: str, told: tuple[str, ...]
) -> None:
    with pytest.raises(InvalidCaseError) as caught:
        text = with_words(words)
        if changes is RANDOM:
            text = text.replace("[acoustics]\n", '[acoustics]\nsignal = "random"\n')
        Case.parse(text).varied({} if changes is RANDOM else changes)
    (problem,) = caught.value.problems
    assert problem.key == key
    for part in told:
        assert part in str(problem)


def test_table_over_frequency(tmp_path: Path) -> None:
    file = tmp_path / "case.toml"
    file.write_text(with_words("[excitation]\n" + PATCH + 'table = "p.csv"\n'))
    table = tmp_path / "p.csv"
    table.write_text("frequency, amplitude, phase\n50, 1, 0\n150, 3, 0\n300, 2, 90\n")
    case = Case.load(file)
    ((frequency, value),) = spectra(case).values()
    np.testing.assert_allclose(frequency, [50.0, 150.0, 300.0])
    np.testing.assert_allclose(value, [1.0, 3.0, 2.0j], atol=1e-15)
    before = case.content_key()
    table.write_text("frequency, amplitude\n50, 1\n300, 2\n")
    assert case.content_key() != before
    for text, told in (
        ("frequency, amplitude\n120, 1\n300, 2\n", "the band for 100 to 220 Hz. Extend"),
        ("frequency, amplitude\n50, 1\n50, 2\n300, 3\n", "ascending"),
        ("frequency, pressure\n50, 1\n300, 2\n", "the columns are frequency, pressure"),
        ("frequency, amplitude\n50, 1\n300, x\n", "not a finite number"),
        ("frequency, density\n50, 1\n300, 2\n", "the columns are frequency, density"),
    ):
        table.write_text(text)
        with pytest.raises(InvalidCaseError, match=told) as caught:
            spectra(case)
        assert caught.value.problems[0].key == "excitation.table"
    table.unlink()
    with pytest.raises(InvalidCaseError, match=r"p\.csv"):
        spectra(case)


def test_table_of_densities(tmp_path: Path) -> None:
    table = tmp_path / "p.csv"
    table.write_text("frequency, density\n50, 1\n300, -2\n")
    with pytest.raises(ValueError, match="negative"):
        read_spectrum(table, random=True)
    table.write_text("frequency, density\n50, 1\n300, 2\n")
    np.testing.assert_allclose(read_spectrum(table, random=True)[1], [1.0, 2.0])
