# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flexible hydrofoils of a water-tunnel experiment: stiffness, frequencies, and bending in water.

    python -m verification.hydrofoils

prints the tables of the documentation's page on hydrofoils.
"""

import numpy as np

from quietblade.materials import OrthotropicSVK
from verification.hydrofoil_models import (
    FOILS,
    SPAN,
    STREAMS,
    TYPE_I,
    TYPE_II,
    Bent,
    Hydrofoil,
    bent,
    frequencies,
    reference_force,
    stiffness,
    taper_slope,
    taper_stiffness,
)
from verification.registry import check

_MEASURED = "Zarruk, Brandner, Pearce, Phillips (2014), J. Fluids Struct. 51, 326-343"

# The foils are computed with a rigid clamp.  Type I has a flange of its own; type II is held in a
# housing, whose compliance (8 to 12 %) beam theory shows as well.
_CLAMP = {TYPE_I: 0.06, TYPE_II: 0.13}

for _foil in FOILS.values():

    @check(f"structure/zarruk-{_foil.name}-stiffness",
           quantity=f"{_foil.name}: force at the quarter chord of the tip over deflection [N/mm]",
           reference=1e-3 * _foil.stiffness, source=_MEASURED,
           tolerance=1e-3 * _CLAMP[_foil.edge] * _foil.stiffness, quick=False)  # fmt: skip
    def _stiffness(name: str = _foil.name) -> float:
        return 1e-3 * stiffness(name)

    # With the clamp's share taken out by the measured stiffness.  Of the carbon foil only the
    # density and one modulus are published.
    @check(f"structure/zarruk-{_foil.name}-dry",
           quantity=f"{_foil.name}: first frequency in air at the measured tip stiffness [Hz]",
           reference=_foil.dry, source=_MEASURED, quick=False,
           tolerance=(0.15 if isinstance(_foil.material, OrthotropicSVK) else 0.10) * _foil.dry,
           )  # fmt: skip
    def _dry(foil: Hydrofoil = _foil) -> float:
        return float(frequencies(foil.name)[0] * np.sqrt(foil.stiffness / stiffness(foil.name)))

    # The ratio to the frequency in air leaves the clamp out: only the added mass is judged.
    @check(f"acoustics/zarruk-{_foil.name}-wet",
           quantity=f"{_foil.name}: first frequency in water, from the measured one in air [Hz]",
           reference=_foil.wet, source=_MEASURED, tolerance=0.10 * _foil.wet,
           quick=False)  # fmt: skip
    def _wet(foil: Hydrofoil = _foil) -> float:
        dry, wet = frequencies(foil.name)
        return foil.dry * wet / dry


@check("structure/zarruk-I-SS-beam",
       quantity="I-SS: tip stiffness over that of the clamped tapered beam", reference=1.0,
       source="Euler-Bernoulli beam, 1.5 E I_root / s^3", quick=False,
       # the clamp hinders the root's curvature across the chord: stiffer than a beam
       tolerance=0.02)  # fmt: skip
def _beam() -> float:
    foil = FOILS["I-SS"]
    return stiffness("I-SS") / taper_stiffness(foil.young, foil.inertia)


@check(
    "flow/zarruk-I-SS-slope",
    quantity="I-SS in the lifting line's stream: d E I / (F s^3)",
    reference=taper_slope(lambda s: np.sqrt(1.0 - s**2)),
    quick=False,
    source="Euler-Bernoulli beam, rigid clamp, elliptic load",
    tolerance=0.005,
)  # the load of a trapezoid is not quite an ellipse
def _slope() -> float:
    return bent("I-SS", "lifting line").slope


def tables() -> str:
    """Tables of the documentation's page, in Markdown."""
    return "\n\n".join([_dry_and_wet_table(), _bending_table()])


def _dry_and_wet_table() -> str:
    rows = [
        ["Foil", "", "K [N/mm]", "f in air [Hz]", "f in water [Hz]", "water over air"],
        ["---"] * 6,
    ]
    for foil in FOILS.values():
        dry, wet = frequencies(foil.name)
        tip = stiffness(foil.name)
        measured = (1e-3 * foil.stiffness, foil.dry, foil.wet, foil.wet / foil.dry)
        for label, figures in {
            "measured": measured,
            "computed": (1e-3 * tip, dry, wet, wet / dry),
        }.items():
            name = foil.name if label == "measured" else ""
            k, air, water, ratio = figures
            rows.append([name, label, f"{k:.1f}", f"{air:.1f}", f"{water:.1f}", f"{ratio:.3f}"])
    return _markdown(rows)


def _bending_table() -> str:
    rows = [
        ["Foil", "", "C_N", "tip deflection [mm]", "tip twist [deg]", "d E I / (F s^3)"],
        ["---"] * 6,
    ]
    for foil in FOILS.values():
        # published are deflection and slope; they imply the force
        force = foil.deflection * foil.young * foil.inertia / (foil.slope * SPAN**3)
        found = {"measured": Bent(foil.deflection, foil.twist, force / reference_force(),
                                  foil.slope)}  # fmt: skip
        found |= {kind: bent(foil.name, kind) for kind in STREAMS}
        for label, state in found.items():
            rows.append([
                foil.name if label == "measured" else "", label,
                _figure(state.normal_coefficient, 3), _figure(1e3 * state.deflection, 2),
                _figure(np.degrees(state.twist), 2), _figure(state.slope, 3),
            ])  # fmt: skip
    return _markdown(rows)


def _figure(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if np.isfinite(value) else ""


def _markdown(rows: list[list[str]]) -> str:
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


if __name__ == "__main__":
    print(tables())
