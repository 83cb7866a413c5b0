# SPDX-License-Identifier: LGPL-2.1-or-later
"""Text with a unit to an SI number."""

from math import pi
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from quietblade.case.units import (
    ANGLE,
    ANGULAR_SPEED,
    DENSITY,
    FRACTION,
    FREQUENCY,
    LENGTH,
    MODULUS,
    PRESSURE,
    SPEED,
    VISCOSITY,
    Kind,
    UnitError,
    in_unit,
    read_quantity,
)


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("250 mm", LENGTH, 0.25),
        ("25cm", LENGTH, 0.25),
        ("1.5e-3 m", LENGTH, 1.5e-3),
        ("10 µm", LENGTH, 1e-5),
        ("-3 mm", LENGTH, -0.003),
        ("65 GPa", MODULUS, 65e9),
        ("2 N/mm²", MODULUS, 2e6),
        ("1 bar", PRESSURE, 1e5),
        ("0.58 rad/s", ANGULAR_SPEED, 0.58),
        ("10 rpm", ANGULAR_SPEED, pi / 3),
        ("10 rev/min", ANGULAR_SPEED, pi / 3),
        ("8 deg", ANGLE, 8 * pi / 180),
        ("8°", ANGLE, 8 * pi / 180),
        ("5 m/s", SPEED, 5.0),
        ("18 km/h", SPEED, 5.0),
        ("1 knot", SPEED, 1852 / 3600),
        ("2500 kg/m^3", DENSITY, 2500.0),
        ("2500 kg m^-3", DENSITY, 2500.0),
        ("2.5 g/cm**3", DENSITY, 2500.0),
        ("1 kHz", FREQUENCY, 1000.0),
        ("3 1/s", FREQUENCY, 3.0),
        ("1.1 mm^2/s", VISCOSITY, 1.1e-6),
        ("6 %", FRACTION, 0.06),
        (0.06, FRACTION, 0.06),
        (1, FRACTION, 1.0),
    ],
)
def test_reads(text: Any, kind: Kind, value: float) -> None:
    assert read_quantity(text, kind) == pytest.approx(value, rel=1e-14)


def test_the_same_length_in_two_units_is_the_same_number() -> None:
    assert read_quantity("250 mm", LENGTH) == read_quantity("25 cm", LENGTH) == 0.25
    assert read_quantity("35 cm", LENGTH) == read_quantity("350 mm", LENGTH) == 0.35


@pytest.mark.parametrize(
    ("text", "kind", "fragments"),
    [
        (250, LENGTH, ("bare number", "a length", '"250 mm"')),
        (8, ANGLE, ("bare number", "an angle", '"8 deg"')),
        ("8", ANGLE, ("no unit", '"8 deg"')),
        ("0.06", FRACTION, ("no unit", "without quotes")),
        ("5 kg", LENGTH, ("a mass where", "a length is needed")),
        ("5 mol", LENGTH, ('"mol"', "a length is needed")),
        ("5 m", ANGLE, ("a length where an angle",)),
        ("10 Hz", ANGULAR_SPEED, ("a frequency where an angular speed", "60 rpm")),
        ("10 rpm", FREQUENCY, ("an angular speed where a frequency", "Hz")),
        ("65 gpa", MODULUS, ("not a known unit", 'Did you mean "GPa"')),
        ("65 furlongs/gallon^2", MODULUS, ("a modulus is needed",)),
        ("2 mmm", LENGTH, ("not a known unit", 'Did you mean "mm"')),
        ("1,5 m", LENGTH, ("decimal comma", "decimal point")),
        ("five m", LENGTH, ("cannot be read",)),
        ("", LENGTH, ("cannot be read",)),
        ("20 degC", FRACTION, ("not a known unit",)),
        ("3 dB", FRACTION, ("a difference of levels where",)),
        ("1e999 m", LENGTH, ("not a finite",)),
        (float("nan"), FRACTION, ("not a finite",)),
        (10**400, FRACTION, ("not a finite",)),
        (True, FRACTION, ("a truth value",)),
        ([1], LENGTH, ("a list where",)),
        ({"a": 1}, LENGTH, ("a table where",)),
        ("2 m**9**9**9", LENGTH, ("not a unit",)),
        ("1 __import__('os')", LENGTH, ("not a unit",)),
    ],
)
def test_refuses(text: Any, kind: Kind, fragments: tuple[str, ...]) -> None:
    with pytest.raises(UnitError) as caught:
        read_quantity(text, kind)
    message = f"{caught.value.message}. {caught.value.remedy}"
    for fragment in fragments:
        assert fragment in message


def test_bare_numbers_are_si_where_a_program_wrote_them() -> None:
    assert read_quantity(0.25, LENGTH, bare=True) == 0.25


@pytest.mark.parametrize(
    ("value", "unit", "expected"), [(0.25, "mm", 250), (pi, "deg", 180), (pi / 3, "rpm", 10)]
)
def test_in_unit(value: float, unit: str, expected: float) -> None:
    assert in_unit(value, unit) == pytest.approx(expected)


_UNIT_TEXT = st.text(st.sampled_from("mMkgsPaHzrd%°µ/*^() 12-·²_eE"), max_size=12)


@settings(max_examples=300, deadline=None)
@given(st.floats(allow_nan=False), st.one_of(_UNIT_TEXT, st.text(max_size=8)))
def test_any_unit_is_read_or_refused(number: float, unit: str) -> None:
    try:
        value = read_quantity(f"{number!r} {unit}", LENGTH)
    except UnitError as error:
        assert error.message
        assert error.remedy
    else:
        assert abs(value) < float("inf")
