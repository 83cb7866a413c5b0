# SPDX-License-Identifier: LGPL-2.1-or-later
"""The one door through which units enter: text such as ``"250 mm"`` becomes an SI number."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from quietblade.case.problems import shown, suggestion

if TYPE_CHECKING:
    import pint

_NUMBER = r"[+-]?(?:\d[\d_]*\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*(.*?)\s*", re.DOTALL)
WRITTEN_QUANTITY = rf"^\s*{_NUMBER}\s*(?:[A-Za-zµμΩ%°(]|1\s*/).*$"
"""Pattern of a number and a unit, for tools that know no units."""
_NAME = r"[A-Za-z_µμΩ]+|[%°]"
_FACTOR = rf"(?:1|(?:{_NAME})(?:(?:\^|\*\*)[+-]?[1-9]|⁻?[¹²³])?)"
# products, one level of parentheses, exponents of one digit: nothing that pint could choke on
_PRODUCT = rf"{_FACTOR}(?:\s*[*/·]\s*{_FACTOR}|\s+{_FACTOR})*"
_UNIT = re.compile(rf"{_PRODUCT}(?:\s*/\s*\(\s*{_PRODUCT}\s*\))?")


@dataclass(frozen=True)
class Kind:
    """A kind of quantity, the SI unit it is kept in, and how a user may write it.

    Attributes
    ----------
    name : str
        With its article, as it stands in a message: ``a length``.
    unit : str
        SI unit.
    example : str
        A good value, as it stands in a case file between quotes.
    usual : tuple of str
        Units to suggest for a misspelt one.
    smallest, largest : float
        Magnitudes in SI units beyond which a value is a slip (zero is none).
    """

    name: str
    unit: str
    example: str
    usual: tuple[str, ...]
    smallest: float
    largest: float


LENGTH = Kind("a length", "m", "250 mm", ("m", "cm", "mm", "µm"), 1e-7, 1e4)
ANGLE = Kind("an angle", "rad", "8 deg", ("deg", "rad"), 0.0, 1e2)
SPEED = Kind("a speed", "m/s", "5 m/s", ("m/s", "km/h", "knot"), 1e-6, 1e5)
ANGULAR_SPEED = Kind("an angular speed", "rad/s", "60 rpm", ("rad/s", "rpm", "rev/s"), 1e-9, 1e5)
FREQUENCY = Kind("a frequency", "Hz", "100 Hz", ("Hz", "kHz"), 1e-4, 1e8)
PRESSURE = Kind("a pressure", "Pa", "101.3 kPa", ("Pa", "kPa", "MPa", "GPa", "bar"), 1e-9, 1e12)
MODULUS = Kind("a modulus", "Pa", "65 GPa", ("Pa", "kPa", "MPa", "GPa"), 1e-3, 1e14)
DENSITY = Kind("a density", "kg/m^3", "2500 kg/m^3", ("kg/m^3", "g/cm^3"), 1e-3, 1e6)
VISCOSITY = Kind("a kinematic viscosity", "m^2/s", "1.1e-6 m^2/s", ("m^2/s",), 1e-12, 1e3)
FORCE = Kind("a force", "N", "120 N", ("N", "kN", "MN"), 1e-9, 1e12)
LINE_FORCE = Kind("a force per length", "N/m", "250 N/m", ("N/m", "kN/m", "N/mm"), 1e-9, 1e15)
MOMENT_PER_ANGLE = Kind(
    "a moment per angle", "N*m/rad", "40 kN*m/rad", ("N*m/rad", "kN*m/rad"), 1e-9, 1e18
)
ACCELERATION = Kind("an acceleration", "m/s^2", "9.81 m/s^2", ("m/s^2",), 1e-9, 1e6)
TIME = Kind("a time", "s", "0.2 ms", ("s", "ms", "µs"), 1e-18, 1e18)
TEMPERATURE = Kind("a temperature", "K", "15 degC", ("degC", "K"), 1.0, 3e3)
TEMPERATURE_STEP = Kind("a difference of temperatures", "K", "101.6 K", ("K",), 1e-6, 1e5)
MOLAR_ENERGY = Kind("an energy per amount", "J/mol", "80 kJ/mol", ("kJ/mol", "J/mol"), 1e-3, 1e9)
DAMPING = Kind("a force per speed", "N*s/m", "5 kN*s/m", ("N*s/m", "kN*s/m"), 1e-9, 1e15)
ANGULAR_DAMPING = Kind(
    "a moment per angular speed", "N*m*s/rad", "50 N*m*s/rad", ("N*m*s/rad",), 1e-9, 1e18
)
MASS = Kind("a mass", "kg", "12 kg", ("kg", "g"), 1e-9, 1e9)
INERTIA = Kind("a moment of inertia", "kg*m^2", "0.4 kg*m^2", ("kg*m^2",), 1e-12, 1e12)
PRESSURE_DENSITY = Kind(
    "a spectral density of pressure", "Pa^2/Hz", "4 Pa^2/Hz", ("Pa^2/Hz", "kPa^2/Hz"), 1e-18, 1e24
)
FORCE_DENSITY = Kind(
    "a spectral density of force", "N^2/Hz", "0.1 N^2/Hz", ("N^2/Hz",), 1e-18, 1e24
)
LINE_FORCE_DENSITY = Kind(
    "a spectral density of force per length", "N^2/m^2/Hz", "0.1 N^2/m^2/Hz", ("N^2/m^2/Hz",),
    1e-18, 1e30,
)  # fmt: skip
LENGTH_DENSITY = Kind(
    "a spectral density of displacement", "m^2/Hz", "1e-12 m^2/Hz", ("m^2/Hz", "mm^2/Hz"), 1e-30, 1
)
SPEED_DENSITY = Kind(
    "a spectral density of velocity", "m^2/s^2/Hz", "1e-8 m^2/s^2/Hz", ("m^2/s^2/Hz",), 1e-27, 1e6
)
ACCELERATION_DENSITY = Kind(
    "a spectral density of acceleration", "m^2/s^4/Hz", "1e-4 m^2/s^4/Hz", ("m^2/s^4/Hz",),
    1e-24, 1e12,
)  # fmt: skip
ANGLE_DENSITY = Kind(
    "a spectral density of rotation", "rad^2/Hz", "1e-10 rad^2/Hz", ("rad^2/Hz",), 1e-30, 1e2
)
LEVEL = Kind("a difference of levels", "dB", "0.01 dB", ("dB",), 1e-9, 1e3)
SOUND_LEVEL = Kind("a level", "dB", "120 dB", ("dB",), 0.0, 1e3)
FRACTION = Kind("a fraction", "", "6 %", ("%",), 0.0, 1e3)

_ICE_POINT = {"degC": 273.15, "°C": 273.15, "celsius": 273.15}
"""Scales of temperature with a zero of their own, and where it is [K]."""

_HUGE = 1e300  # an integer beyond has no float

# what pint's parser raises on nonsense
_UNREADABLE = (AttributeError, ArithmeticError, AssertionError, LookupError, TypeError, ValueError)

_KINDS = (
    LENGTH, ANGLE, SPEED, ANGULAR_SPEED, FREQUENCY, PRESSURE, DENSITY, VISCOSITY, FRACTION, FORCE,
    LINE_FORCE, MOMENT_PER_ANGLE, ACCELERATION, LEVEL, TIME, TEMPERATURE, MOLAR_ENERGY, DAMPING,
    ANGULAR_DAMPING, MASS, INERTIA, PRESSURE_DENSITY, FORCE_DENSITY, LINE_FORCE_DENSITY,
    LENGTH_DENSITY, SPEED_DENSITY, ACCELERATION_DENSITY, ANGLE_DENSITY,
)  # fmt: skip


class UnitError(Exception):
    """A value that cannot be read as the wanted quantity; says so, and what to write."""

    def __init__(self, message: str, remedy: str) -> None:
        super().__init__(message)
        self.message, self.remedy = message, remedy


def read_quantity(value: Any, kind: Kind, *, bare: bool = False) -> float:
    """Read a value of a case file as a number in the SI unit of its kind.

    Parameters
    ----------
    value : object
        What stands in the file. Fractions are bare numbers or percentages; everything else is
        text, a number followed by a unit.
    kind : Kind
        What is wanted.
    bare : bool
        Take bare numbers as SI values (for cases that were written in SI by a program).

    Raises
    ------
    UnitError
        Says what is wrong and gives an example.
    """
    example = f'for example "{kind.example}"'
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        what = "a truth value" if isinstance(value, bool) else _container(value)
        raise UnitError(f"{what} where {kind.name} is needed", f"Write {example}")
    if not isinstance(value, str):
        if bare or not kind.unit:
            return _finite(float(value) if abs(value) < _HUGE else math.inf, kind)
        raise UnitError(
            f"a bare number where {kind.name} with its unit is needed",
            f"Write the number and its unit in quotes, {example}",
        )
    match = _QUANTITY.fullmatch(value)
    if match is None or match.group(2).startswith(","):
        if re.match(r"\s*[+-]?\d+,\d", value):
            raise UnitError("has a decimal comma", f"Write a decimal point, {example}")
        raise UnitError(
            f"cannot be read as a number and a unit, and {kind.name} is needed", f"Write {example}"
        )
    number, unit = float(match.group(1)), match.group(2)
    if not unit:
        remedy = "Write it without quotes" if not kind.unit else f"Write {example}"
        raise UnitError(f"has no unit, and {kind.name} is needed", remedy)
    if kind is TEMPERATURE and unit in _ICE_POINT:
        return _finite(float(f"{number + _ICE_POINT[unit]:.15g}"), kind)
    factor, powers = _root_unit(unit, kind)
    wanted_factor, wanted = _root(kind.unit)
    if powers != wanted:
        raise UnitError(f"{_named(powers, unit)} where {kind.name} is needed", f"Write {example}")
    # 12 + 3 digits: 25 cm and 250 mm become the same number
    return _finite(float(f"{number * factor / wanted_factor:.15g}"), kind)


def in_unit(value: float, unit: str) -> float:
    """Express an SI value in another unit, for tables that people read."""
    return value / _root(unit)[0] * _root(_si(unit))[0]


def convert_factor(unit: str, kind: Kind) -> float:
    """SI value of one of a unit, for formulas whose result carries a unit."""
    return read_quantity(f"1 {unit}", kind)


def _si(unit: str) -> str:
    powers = _root(unit)[1]
    return next(kind.unit for kind in _KINDS if _root(kind.unit)[1] == powers)


def _finite(value: float, kind: Kind) -> float:
    if not math.isfinite(value):
        raise UnitError(
            "is not a finite number", f'Write {kind.name}, for example "{kind.example}"'
        )
    return value


def _container(value: Any) -> str:
    if isinstance(value, list | tuple):
        return "a list"
    return "a table" if isinstance(value, Mapping) else f"{shown(value)}"


def _root_unit(unit: str, kind: Kind) -> tuple[float, Mapping[str, float]]:
    example = f'Write {kind.name}, for example "{kind.example}"'
    if _UNIT.fullmatch(unit) is None:
        raise UnitError(f'"{unit}" is not a unit', example)
    try:
        return _root(unit)
    except _UNREADABLE as error:  # which pint's own errors derive from
        near = suggestion(unit, kind.usual)
        raise UnitError(f'"{unit}" is not a known unit', near or example) from error


@cache
def _registry() -> "pint.UnitRegistry[float]":
    import pint  # noqa: PLC0415  # a second of start-up time

    registry: pint.UnitRegistry[float] = pint.UnitRegistry()
    registry.define("@alias turn = rev")
    return registry


@cache
def _root(unit: str) -> tuple[float, Mapping[str, float]]:
    """Factor and powers in root units; radian is one, so that Hz and rad/s differ."""
    if not unit:
        return 1.0, {}
    if unit == LEVEL.unit:  # a level has no scale factor that a registry of units could know
        return 1.0, {"level": 1.0}
    registry = _registry()
    quantity = registry.parse_expression(unit)
    if registry.Quantity(0.0, quantity.units).to_root_units().magnitude != 0.0:
        raise ValueError("levels and temperatures have an offset")
    root: Any = quantity.to_root_units()
    return float(root.magnitude), {name: float(p) for name, p in root.unit_items()}


def _named(powers: Mapping[str, float], unit: str) -> str:
    for kind in _KINDS:
        if _root(kind.unit)[1] == powers:
            return kind.name if kind.unit else "a number without dimension"
    return f'a quantity in "{unit}"'
