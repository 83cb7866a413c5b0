# SPDX-License-Identifier: LGPL-2.1-or-later
"""The assumptions of the method, with what they come to in a case: before anything is computed.

The flow is that of the undeformed blade; under load the same limits are looked at again by a run.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from quietblade.case import AnyCase, Case
from quietblade.errors import Notice
from quietblade.flow import limits
from quietblade.flow.cavitation import cavitation_number, is_judged, suction
from quietblade.flow.inflow import BladeFlow, strip_loads
from quietblade.geometry import Blade
from quietblade.study import translate
from quietblade.typing import FloatArray

FAST_SPIN = 0.05
"""Ratio 2 omega_p / omega_1 beyond which the neglected Coriolis force is noticed."""

SUBSONIC = 0.3
"""Mach number of the tip up to which water past it may be taken as incompressible."""

_MISTAKEN = np.radians(45.0)  # incidence that no blade is meant to have
_EASE = "Lower the incidence: the lift beyond stall is overestimated"
_TURN = (
    "The blade angle counts from the rotor axis: it is the pitch angle of a drawing, which counts "
    "from the plane of rotation, less 90 deg. Look at the sense of flow.rotation too"
)

_STATIONS = 21  # sections of the undeformed blade
_NODES = 161


@dataclass(frozen=True)
class Assumption:
    """One assumption of the method in a case.

    Attributes
    ----------
    name : str
        What is assumed.
    said : str
        What it comes to here, in words.
    value, limit : float or None
        The figure it is judged by, in SI units, and its limit; None if it is only told.
    holds : bool
    remedy : str
        What to do if it does not hold.
    doubt : str
        How a notice says that it does not hold.
    """

    name: str
    said: str
    value: float | None = None
    limit: float | None = None
    holds: bool = True
    remedy: str = ""
    doubt: str = ""

    def notice(self) -> Notice | None:
        """Return the notice of an assumption that does not hold."""
        if self.holds:
            return None
        message = self.doubt or f"it is doubtful that {self.name}"
        return Notice("assumptions", message, self.value, self.limit, self.remedy)


def undeformed_flow(case: Case, blade: Blade) -> BladeFlow:
    """Solve the flow around the undeformed blade, on a few sections.

    Raises
    ------
    GeometryError
        The sections cannot be solved.
    """
    points = blade.section(np.linspace(0.0, 1.0, _STATIONS), _NODES)
    return strip_loads(points, translate.inflow(case))


def assumptions(case: Case, flow: BladeFlow, clearance: float) -> tuple[Assumption, ...]:
    """Say what each assumption comes to.

    Parameters
    ----------
    case : Case
    flow : BladeFlow
        Of the undeformed blade.
    clearance : float
        Least distance of the blade at rest from the sphere [m].
    """
    speed = float(np.linalg.norm(flow.loads.velocity - flow.loads.induced, axis=1)[-1])
    mach = speed / case.water.sound_speed
    return (
        Assumption(
            "the flow is incompressible",
            f"tip speed {speed:.4g} m/s, Mach {mach:.2g} against {SUBSONIC:g}",
            mach,
            SUBSONIC,
            mach <= SUBSONIC,
            "Slower, or a method for compressible flow",
        ),
        _slow_rotation(case),
        _attached(case, flow),
        _dry(case, flow),
        *_inflow(case, flow),
        _clear(case, clearance, "blade", ", which the deformed blade must keep too"),
        _linear("the loaded blade"),
    )


def body_assumptions(case: AnyCase, clearance: float) -> tuple[Assumption, ...]:
    """Say what the assumptions come to of a body at rest.

    Parameters
    ----------
    case : AnyCase
    clearance : float
        Least distance of the body from the sphere [m].
    """
    return (
        Assumption("the water is unbounded and at rest", "no surface, no bottom, no stream"),
        _clear(case, clearance, "body"),
        _linear("the body at rest, without pressure or weight"),
    )


def _clear(case: AnyCase, clearance: float, what: str, more: str = "") -> Assumption:
    return Assumption(
        f"the sphere is clear of the {what}",
        f"{1e3 * clearance:.4g} mm at rest against {1e3 * case.acoustics.gap:.4g} mm{more}",
        clearance,
        case.acoustics.gap,
    )


def _linear(about: str) -> Assumption:
    return Assumption(
        "vibration and sound are small",
        f"linear about {about}: powers grow with the square of the excitation",
    )


def _slow_rotation(case: Case) -> Assumption:
    low, rotation = case.acoustics.band[0], abs(case.flow.rotation)
    name = "the vibration is much faster than the rotation"
    if rotation == 0.0:
        return Assumption(name, "the blade does not turn")
    ratio = 2.0 * np.pi * low / rotation
    limit = 2.0 / FAST_SPIN
    return Assumption(
        name,
        f"the band begins at {ratio:.4g} times the rotation rate, at least {limit:g}",
        ratio,
        limit,
        ratio >= limit,
        "Raise the band's lower end: slower vibrations feel the Coriolis force, which is left out",
        f"it is doubtful that {name}: lower end of the band over the rotation rate",
    )


def _attached(case: Case, flow: BladeFlow) -> Assumption:
    limit = limits.stall_limit(flow.sections, flow.loads, translate.environment(case))
    value = np.abs(flow.loads.alpha)
    k = _worst(np.where(is_judged(flow.loads), value - limit, -np.inf))
    place = _place(flow, k)
    return Assumption(
        "the flow is attached",
        f"incidence {np.degrees(value[k]):.3g} deg {place}, stall near "
        f"{np.degrees(limit[k]):.3g} deg: margin {np.degrees(limit[k] - value[k]):.3g} deg",
        float(value[k]),
        float(limit[k]),
        bool(value[k] <= limit[k]),
        _TURN if value[k] > _MISTAKEN else _EASE,
        f"it is doubtful that the flow is attached: incidence {place} [rad]",
    )


def _dry(case: Case, flow: BladeFlow) -> Assumption:
    sigma = cavitation_number(flow.sections, flow.loads, translate.environment(case))
    peak = suction(flow.loads)
    k = _worst(np.where(np.isfinite(sigma) & is_judged(flow.loads), peak - sigma, -np.inf))
    said = f"suction -Cp {peak[k]:.3g} {_place(flow, k)}, cavitation number {sigma[k]:.3g}: margin "
    return Assumption(
        "the water does not cavitate",
        f"{said}{sigma[k] - peak[k]:.3g}",
        float(peak[k]),
        float(sigma[k]),
        bool(peak[k] <= sigma[k]),
        "Deeper (flow.depth) or slower; a peak narrower than the boundary layer exaggerates",
        f"it is doubtful that the water does not cavitate: suction -Cp {_place(flow, k)}",
    )


def _inflow(case: Case, flow: BladeFlow) -> Iterator[Assumption]:
    model = translate.inflow(case)
    name = f'the inflow model "{model.name}" fits the blade'
    doubts = model.notices(flow.sections, flow.loads)
    if not doubts:
        yield Assumption(name, f"for {model.validity}")
    for doubt in doubts:
        compared = f": {doubt.value:.3g} against {doubt.limit:.3g}" if doubt.value else ""
        said = f"{doubt.message}{compared}"
        yield Assumption(name, said, doubt.value, doubt.limit, False, doubt.remedy, doubt.message)


def _place(flow: BladeFlow, k: int) -> str:
    return f"at {100.0 * flow.sections.arc_length[k] / flow.sections.arc_length[-1]:.0f} % span"


def _worst(excess: FloatArray) -> int:
    return int(np.argmax(excess))
