# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the paper says about its two blades, beside what was computed.

Each claim has a stated criterion. The paper gives figures without tolerances and words without
figures ("tiny", "clearly"), so the criteria are quietblade's own; they are all in this module.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from quietblade.results.model import ConfigurationResult, Result, state
from quietblade.results.peaks import Peak, find_peaks, partner_of
from quietblade.typing import FloatArray

_SHEAR_STRAIN = {"aluminium": 0.019, "composite": 0.09}
_VISIBLE_CAMBER = 0.003  # of the chord: a twentieth of the thickness of a 6 % section
_CLAMPED = 0.05  # span fraction beside the clamped root where angles are zero by definition
_SPAN_SHARE = 0.95  # share of the span that "along the span" means
_SIMILAR = 0.9  # MAC of "very similar" mode shapes


@dataclass(frozen=True)
class Claim:
    """One claim of the paper against the computed value.

    Attributes
    ----------
    id : str
        Stable name, such as ``paper/composite/film-shear-strain``.
    statement, paper, computed, criterion : str
        What it is about, what the paper says, what was computed, and when they agree.
    value : float or None
        Figure that the judgement rests on, in the unit of ``computed``.
    agrees : bool or None
        None if it was not computed.
    low, high : float
        Values between these agree; nan where the judgement is not that of one figure.
    """

    id: str
    statement: str
    paper: str
    computed: str
    criterion: str
    value: float | None
    agrees: bool | None
    low: float = np.nan
    high: float = np.nan

    @property
    def miss(self) -> float | None:
        """Distance of the value from the range that agrees; None where there is no such range."""
        if self.value is None or np.isnan(self.low):
            return None
        return max(self.low - self.value, self.value - self.high, 0.0)


@dataclass(frozen=True)
class _Said:
    """A statement of the paper, and the range of values that agrees with it."""

    text: str
    low: float
    high: float

    def criterion(self, unit: str) -> str:
        if np.isinf(self.high):
            return f"above {self.low:.4g} {unit}".rstrip()
        if np.isinf(self.low):
            return f"below {self.high:.4g} {unit}".rstrip()
        return f"between {self.low:.4g} and {self.high:.4g} {unit}".rstrip()


@dataclass(frozen=True)
class _PaperMode:
    name: str
    frequency: float
    shift: _Said
    level: _Said


_STIFFER = _Said("upward, below 1.3 %", 0.0, 1.3)
_QUIET = _Said("less than 3 dB higher", -3.0, 3.0)
_UP = _Said("+8 %", 6.0, 10.0)
_BELOW_2 = _Said("less than 2 dB higher", -2.0, 2.0)

_MODES: Mapping[str, tuple[_PaperMode, ...]] = MappingProxyType(
    {
        "aluminium": (
            _PaperMode("B5", 135.0, _STIFFER, _QUIET),
            _PaperMode("T2", 160.0, _Said("unchanged", -0.5, 0.5), _Said("+5 dB", 3.0, 7.0)),
            _PaperMode("B6", 190.0, _STIFFER, _QUIET),
        ),
        "composite": (
            _PaperMode("B6", 135.0, _UP, _BELOW_2),
            _PaperMode("T2", 160.0, _Said("-7 %", -9.0, -5.0), _BELOW_2),
            _PaperMode("B7", 190.0, _UP, _Said("+8 dB", 6.0, 10.0)),
        ),
    }
)

BLADES = tuple(_MODES)
"""The paper's blades: ``aluminium`` and ``composite``."""


def judge_claims(result: Result, blade: str | None = None) -> tuple[Claim, ...]:
    """Judge every claim of the paper about a blade.

    Parameters
    ----------
    result : Result
        The study.
    blade : {"aluminium", "composite"}, optional
        Which blade of the paper it stands for; by default what the result says of itself.

    Returns
    -------
    tuple of Claim
        Empty if the result stands for none of the paper's blades.
    """
    blade = result.blade if blade is None else blade
    if blade not in BLADES:
        return ()
    return (*_static_claims(result, blade), *_acoustic_claims(result, blade))


def _claim(
    key: str,
    statement: str,
    said: _Said,
    value: float,
    computed: str,
    unit: str = "",
) -> Claim:
    criterion = said.criterion(unit)
    bounds = said.low, said.high
    if not np.isfinite(value):
        text = "not computed"
        return Claim(f"paper/{key}", statement, said.text, text, criterion, None, None, *bounds)
    agrees = bool(said.low < value < said.high)
    return Claim(
        f"paper/{key}", statement, said.text, computed, criterion, float(value), agrees, *bounds
    )


# --- step 1 -----------------------------------------------------------------------------------


def _static_claims(result: Result, blade: str) -> Iterator[Claim]:
    static = result.steady
    paper, strain = 100 * _SHEAR_STRAIN[blade], 100 * static.max_film_shear_strain
    yield _claim(
        f"{blade}/film-shear-strain",
        "largest shear strain (engineering gamma)",
        _Said(f"{paper:g} %", 0.75 * paper, 1.25 * paper),
        strain,
        f"{strain:.3g} % (tensor component {strain / 2:.3g} %)",
        "%",
    )
    ratio = strain / (100 * static.max_blade_shear_strain)
    yield _claim(
        f"{blade}/film-strained-most",
        "largest shear strain is in the film",
        _Said("always", 1.0, np.inf),
        ratio,
        f"{ratio:.3g} times that outside the film",
    )
    yield _camber(result, blade)
    yield _aluminium_angle(result) if blade == "aluminium" else _composite_angle(result)
    gain = 100 * (_mean_lift(result, "coupled") / _mean_lift(result, "rigid") - 1)
    smaller, larger = _Said("a bit smaller", -15.0, 0.0), _Said("larger", 0.0, np.inf)
    yield _claim(
        f"{blade}/lift-coefficient",
        "lift coefficient against the rigid blade (mean over the planform)",
        smaller if blade == "aluminium" else larger,
        gain,
        f"{gain:+.3g} %",
        "%",
    )
    yield from _rigid_blade(result, blade)


def _camber(result: Result, blade: str) -> Claim:
    sections, middle = result.steady.sections, result.steady.mid_section.span_fraction
    index = np.argmin(np.abs(sections.span_fraction - middle))
    camber = 100 * float(sections.camber[state("coupled"), index])
    visible = 100 * _VISIBLE_CAMBER
    tiny = _Said("tiny, positive", 0.0, visible)
    significant = _Said("significant, positive", visible, np.inf)
    return _claim(
        f"{blade}/camber",
        "camber of the mid section",
        tiny if blade == "aluminium" else significant,
        camber,
        f"{camber:+.3g} % of the chord",
        "%",
    )


def _twist(result: Result) -> tuple[FloatArray, FloatArray]:
    """Span fraction, and change of the blade angle from the rigid blade [deg]."""
    sections = result.steady.sections
    change = sections.blade_angle[state("coupled")] - sections.blade_angle[state("rigid")]
    return sections.span_fraction, np.degrees(change)


def _aluminium_angle(result: Result) -> Claim:
    s, twist = _twist(result)
    inner, tip = float(twist[s <= 0.3].max()), float(twist[-1])
    return Claim(
        "paper/aluminium/blade-angle",
        "blade angle along the span",
        "slightly positive at the root, then clearly negative to the tip",
        f"{inner:+.2g} deg at most near the root, {tip:+.2g} deg at the tip",
        "positive somewhere below s = 0.3, negative above s = 0.7, and by more",
        tip,
        inner > 0.0 and bool(np.all(twist[s >= 0.7] < 0.0)) and -tip > inner,
    )


def _composite_angle(result: Result) -> Claim:
    s, twist = _twist(result)
    share = float(np.mean(twist[s > _CLAMPED] > 0.0))
    return Claim(
        "paper/composite/blade-angle",
        "blade angle along the span",
        "positive",
        f"positive along {100 * share:.3g} % of the span, {twist[-1]:+.2g} deg at the tip",
        f"positive along at least {100 * _SPAN_SHARE:g} % of the span",
        share,
        share >= _SPAN_SHARE,
    )


def _rigid_blade(result: Result, blade: str) -> Iterator[Claim]:
    sections, rigid = result.steady.sections, state("rigid")
    lift, alpha = sections.lift_coefficient[rigid], sections.incidence[rigid]
    slope = float(lift @ alpha / (alpha @ alpha)) / (2.0 * np.pi)
    yield _claim(
        f"{blade}/rigid-lift-slope",
        "rigid blade: lift coefficient over 2 pi times the incidence",
        _Said("1", 0.9, 1.1),  # the section's thickness alone adds 4 %
        slope,
        f"{slope:.3f}",
    )
    radius = sections.radius[rigid]
    line = np.polynomial.Polynomial.fit(radius, lift, 1)(radius)
    departure = 100 * float(np.max(np.abs(lift - line)) / np.max(np.abs(lift)))
    yield _claim(
        f"{blade}/rigid-lift-linear",
        "rigid blade: departure of the lift coefficient from a line in the radius",
        _Said("almost linear", -np.inf, 2.0),
        departure,
        f"{departure:.2g} % of its maximum",
        "%",
    )


def _mean_lift(result: Result, name: str) -> float:
    sections = result.steady.sections
    chord, s = sections.chord[state("rigid")], sections.span_fraction
    lift = sections.lift_coefficient[state(name)]
    return float(np.trapezoid(lift * chord, s) / np.trapezoid(chord, s))


# --- step 2 -----------------------------------------------------------------------------------


def _acoustic_claims(result: Result, blade: str) -> Iterator[Claim]:
    rest, loaded = (result.configurations.get(name) for name in ("C0", "C1"))
    peaks = find_peaks(rest) if rest else {}
    loaded_peaks = find_peaks(loaded) if loaded else {}
    for order, mode in enumerate(_MODES[blade], start=1):
        here = peaks.get(mode.name)
        partner, mac = _partner(rest, mode.name)
        there = loaded_peaks.get(partner)
        yield _peak(f"{blade}/peak-{order}", mode, here, computed=rest is not None)
        shift = 100 * (_frequency(loaded, partner) / _frequency(rest, mode.name) - 1)
        yield _claim(
            f"{blade}/shift-{order}",
            f"{mode.name}: natural frequency in the water, C1 against C0",
            mode.shift,
            shift,
            f"{shift:+.2f} %",
            "%",
        )
        rise = there.level - here.level if here and there else np.nan
        yield _claim(
            f"{blade}/level-{order}",
            f"{mode.name}: level of the peak, C1 against C0",
            mode.level,
            rise,
            f"{rise:+.1f} dB",
            "dB",
        )
        yield _claim(
            f"{blade}/shape-{order}",
            f"{mode.name}: similarity of the mode shape, C1 to C0",
            _Said("very similar", _SIMILAR, np.inf),
            mac,
            f"MAC {mac:.3f} with {partner}",
        )


def _peak(key: str, mode: _PaperMode, peak: Peak | None, *, computed: bool) -> Claim:
    said = _Said(f"about {mode.frequency:g} Hz", 0.87 * mode.frequency, 1.13 * mode.frequency)
    statement = f"{mode.name}: peak at rest"
    if computed and peak is None:  # the sweep was made and the peak is not there
        text, criterion = "no such peak", said.criterion("Hz")
        return Claim(
            f"paper/{key}", statement, said.text, text, criterion, None, False, said.low, said.high
        )
    frequency = peak.frequency if peak else np.nan
    return _claim(key, statement, said, frequency, f"{frequency:.1f} Hz", "Hz")


def _frequency(configuration: ConfigurationResult | None, mode: str) -> float:
    """Natural frequency of a mode [Hz]; a peak may lie beyond the band, the mode is still known."""
    if configuration is None or mode not in configuration.modes.name:
        return np.nan
    return float(configuration.modes.frequency[configuration.modes.name.index(mode)])


def _partner(rest: ConfigurationResult | None, mode: str) -> tuple[str, float]:
    found = partner_of(rest, mode) if rest else None
    return found or ("", np.nan)
