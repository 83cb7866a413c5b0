# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tables of a case file: blade, film, water, flow, static, acoustics and so on."""

from itertools import pairwise
from typing import Annotated, Literal, get_args

from pydantic import AfterValidator, BeforeValidator, Field, WithJsonSchema, model_validator

from quietblade.case.excitation import Correlation, Signal
from quietblade.case.fields import (
    Band,
    Count,
    Density,
    Extent,
    Flag,
    Fraction,
    Frequency,
    Length,
    LengthOrZero,
    LevelDifference,
    Number,
    Point,
    PressureOrZero,
    Speed,
    Text,
    Viscosity,
    Words,
    between,
    entries_from,
    one_of,
    wrong,
)
from quietblade.case.problems import suggestion
from quietblade.case.spans import (
    ConstantSpan,
    SpanAngle,
    SpanCamber,
    SpanLength,
    SpanOffset,
    SpanThickness,
)

Section = Literal[
    "naca-4",
    "naca-5-210", "naca-5-220", "naca-5-230", "naca-5-240", "naca-5-250",
    "naca-5-221", "naca-5-231", "naca-5-241", "naca-5-251",
    "naca-16-a10", "naca-16-a08",
    "naca-66-a08", "naca-66-a10",
]  # fmt: skip
Method = Literal["newton", "fixed-point", "aitken", "anderson"]
Configuration = Literal["C0", "C1"]
Radiation = Literal["dtn", "bgt1", "bgt2"]
Sweep = Literal["reduced", "direct"]
Tangent = Literal["full", "paper"]
Loss = Literal["isochoric", "paper"]
SolverName = Literal["auto", "rslab", "mkl-pardiso", "superlu"]
Precision = Literal["mixed", "double"]

FILE = "file:"
"""What the name of a file of coordinates begins with."""

_MOST_FREQUENCIES = 100_000


def _inside(extent: tuple[float, float], ends: str) -> tuple[float, float]:
    if not (extent[0] > 0.0 and extent[1] < 1.0):
        raise wrong(
            "the film is embedded and must end inside the blade",
            f"Leave material at {ends}: fractions above 0 and below 1",
        )
    return extent


def _section(word: object) -> object:
    if isinstance(word, str) and word.startswith(FILE):
        if not word.removeprefix(FILE).strip():
            raise wrong("names no file", f'Write section = "{FILE}foil.dat"')
        return word
    if word not in get_args(Section):
        near = suggestion(word, get_args(Section)) if isinstance(word, str) else ""
        known = ", ".join(f'"{name}"' for name in get_args(Section))
        remedy = f'{near} Known: {known}, or "{FILE}" and the name of a file of coordinates'
        raise wrong("is not a section family", remedy.strip())
    return word


_SECTIONS = {
    "anyOf": [
        {"enum": list(get_args(Section))},
        {"type": "string", "pattern": rf"^{FILE}\s*\S"},
    ]
}


def _ramp(fractions: tuple[float, ...]) -> tuple[float, ...]:
    steps = (0.0, *fractions)
    if any(a >= b for a, b in pairwise(steps)) or fractions[-1] != 1.0:
        raise wrong("does not increase from above 0 to 1", "Write for example [0.25, 0.5, 1.0]")
    return fractions


def _distinct(names: tuple[Configuration, ...]) -> tuple[Configuration, ...]:
    if len(set(names)) < len(names):
        raise wrong("names a configuration twice", 'Write ["C0", "C1"]')
    return tuple(sorted(names))


class BladeWords(Words):
    """Shape of the blade as functions of the span, and what it is made of."""

    hub_radius: LengthOrZero = Field(
        title="Hub radius", description="Radius of the root section from the rotor axis"
    )
    span: Length = Field(title="Span", description="Distance from the root to the tip section")
    section: Annotated[Text, BeforeValidator(_section), WithJsonSchema(_SECTIONS)] = Field(
        "naca-4",
        title="Section",
        description="Family of sections, or `file:` and the name of a file of coordinates (Selig "
        "or Lednicer), beside the case file",
    )
    chord: SpanLength = Field(title="Chord", description="Chord of the sections along the span")
    thickness: SpanThickness = Field(
        title="Thickness", description="Largest thickness as a fraction of the chord"
    )
    camber: SpanCamber = Field(
        ConstantSpan(0.0), title="Camber", description="Largest camber as a fraction of the chord"
    )
    blade_angle: SpanAngle = Field(
        ConstantSpan(0.0),
        title="Blade angle",
        description="Angle of the chord from the rotor axis; positive raises the incidence",
    )
    sweep: SpanOffset = Field(
        ConstantSpan(0.0),
        title="Sweep",
        description="Shift of the sections along their chord, towards the trailing edge",
    )
    rake: SpanOffset = Field(
        ConstantSpan(0.0),
        title="Rake",
        description="Shift of the sections along the rotor axis, downstream",
    )
    alignment: Fraction = Field(
        0.5, title="Alignment", description="Chord fraction that lies on the reference line"
    )
    trailing_edge: Annotated[Number, between(1e-4, 0.1)] = Field(
        0.006,
        title="Trailing edge",
        description="Thickness of the blunt trailing edge as a fraction of the chord",
    )
    material: Text = Field(title="Material", description="Name of the blade's material")


class FilmWords(Words):
    """Viscoelastic film embedded around the camber surface."""

    span: Annotated[Extent, AfterValidator(lambda r: _inside(r, "root and tip"))] = Field(
        title="Span", description="Range of span fractions"
    )
    chord: Annotated[Extent, AfterValidator(lambda r: _inside(r, "both edges"))] = Field(
        title="Chord", description="Range of chord fractions"
    )
    thickness: Length = Field(title="Thickness", description="Thickness of the film")
    material: Text = Field(title="Material", description="Name of the film's material")
    minimum_cover: LengthOrZero = Field(
        0.1e-3,
        title="Minimum cover",
        description="Least thickness of blade material between the film and either face",
    )


class WaterWords(Words):
    """The water around the blade."""

    density: Density = Field(1000.0, title="Density", description="Mass per volume")
    sound_speed: Speed = Field(1500.0, title="Sound speed", description="Speed of sound")
    kinematic_viscosity: Viscosity = Field(
        1.1e-6,
        title="Kinematic viscosity",
        description="For Reynolds numbers (sea water, 17 deg C)",
    )
    vapour_pressure: PressureOrZero = Field(
        2.34e3, title="Vapour pressure", description="For the cavitation check (20 deg C)"
    )


class StaticWords(Words):
    """Iteration between flow and structure."""

    method: Annotated[Method, one_of(Method, "a method of coupling")] = Field(
        "newton",
        title="Method",
        description="Load updated inside Newton's iteration (newton), the plain fixed point of the "
        "paper (fixed-point), or that accelerated (aitken, anderson)",
    )
    tolerance: Annotated[Number, between(0.0, 0.1, open_low=True)] = Field(
        1e-5,
        title="Tolerance",
        description="Estimated relative error of the displacement at the end; of the fixed point, "
        "as in the paper, its change in the last pass",
    )
    max_iterations: Annotated[Count, between(1, 10_000)] = Field(
        40, title="Largest number of iterations", description="Then the run ends unconverged"
    )
    ramp: Annotated[tuple[Number, ...], AfterValidator(_ramp), entries_from(1)] = Field(
        (1.0,),
        title="Ramp",
        description="Fractions of the dynamic pressure on the way, increasing to 1",
    )
    newton_tolerance: Annotated[Number, between(0.0, 1e-2, open_low=True)] = Field(
        1e-8,
        title="Newton tolerance",
        description="Relative residual at which the structure's equilibrium is accepted",
    )


class AcousticsWords(Words):
    """Band, water sphere and linearisation of the vibro-acoustic step."""

    band: Band = Field(title="Band", description="Lowest and highest frequency")
    sweep: Annotated[Sweep, one_of(Sweep, "a sweep")] = Field(
        "reduced",
        title="Sweep",
        description="By a reduced model whose error is known, or a direct solve at each frequency",
    )
    accuracy: LevelDifference = Field(
        0.01,
        title="Accuracy",
        description="Largest estimated error of the sound power level by the reduced model",
    )
    step: Frequency = Field(2.5, title="Step", description="Spacing of the base frequencies")
    points_per_mode: Annotated[Count, between(0, 1001)] = Field(
        9, title="Points per mode", description="Frequencies added around each wet mode"
    )
    configurations: Annotated[
        tuple[Annotated[Configuration, one_of(Configuration, "a configuration")], ...],
        AfterValidator(_distinct),
        entries_from(1),
    ] = Field(("C0", "C1"), title="Configurations", description="At rest (C0), under load (C1)")
    radiation: Annotated[Radiation, one_of(Radiation, "a radiation condition")] = Field(
        "dtn",
        title="Radiation",
        description="Condition on the outer sphere: exact (dtn), or of Bayliss, Gunzburger and "
        "Turkel of first (bgt1, the paper) or second order (bgt2)",
    )
    radiation_accuracy: Annotated[Number, between(1e-6, 0.1)] = Field(
        1e-3,
        title="Radiation accuracy",
        description="Share of the field that the exact condition (dtn) may get wrong; its degree "
        "follows from it",
    )
    sphere_radius: Length = Field(title="Sphere radius", description="Radius of the water sphere")
    sphere_centre: Point | None = Field(
        None,
        title="Sphere centre",
        description="Centre of the water sphere x, y, z; the middle of the span if not given",
    )
    gap: Length = Field(
        0.05,
        title="Gap",
        description="Least distance of the blade, at rest and deformed, from the sphere",
    )
    tangent: Annotated[Tangent, one_of(Tangent, "a tangent")] = Field(
        "full",
        title="Tangent",
        description="With load stiffness and spin softening (full), or without (paper)",
    )
    loss: Annotated[Loss, one_of(Loss, "a loss model")] = Field(
        "isochoric",
        title="Loss",
        description="Loss on the film's isochoric stiffness, or on its whole tangent (paper)",
    )
    flow_damping: Flag = Field(
        False,
        title="Flow damping",
        description="Whether the stream along the blade damps it, by strip theory; left out in the "
        "paper",
    )
    dry_modes: Flag = Field(
        False,
        title="Dry modes",
        description="Whether to find the modes without water too, beside the wet ones",
    )

    signal: Annotated[Signal, one_of(Signal, "a kind of signal")] = Field(
        "harmonic",
        title="Signal",
        description="Excitations are peak amplitudes (harmonic) or spectral densities (random); "
        "powers are then per hertz",
    )
    correlation: Annotated[Correlation, one_of(Correlation, "a correlation")] = Field(
        "none",
        title="Correlation",
        description="Random loads are independent (none), or all in phase (full)",
    )

    @model_validator(mode="after")
    def _check_signal(self) -> "AcousticsWords":
        if self.signal == "harmonic" and self.correlation != "none":
            raise wrong(
                "is given for harmonic loads, which have phases",
                'Leave it out, or write signal = "random"',
                at=("correlation",),
            )
        return self

    @model_validator(mode="after")
    def _check_step(self) -> "AcousticsWords":
        low, high = self.band
        if self.step > high - low:
            raise wrong(
                f"is wider than the band of {high - low:g} Hz",
                "Choose a smaller step",
                at=("step",),
            )
        count = (high - low) / self.step
        if count > _MOST_FREQUENCIES:
            raise wrong(
                f"makes {count:.3g} frequencies",
                "Choose a larger step or a smaller band",
                at=("step",),
            )
        return self


class MeshWords(Words):
    """Size of the elements."""

    size: Length = Field(title="Size", description="Edge length of the elements on the blade")
    water_size: Length | None = Field(
        None,
        title="Water size",
        description="Edge length at the sphere; if not given a quarter of its radius, or a sixth "
        "of the shortest wavelength if that is smaller",
    )


class SolverWords(Words):
    """Sparse direct solver of the linear systems."""

    name: Annotated[SolverName, one_of(SolverName, "a solver")] = Field(
        "auto", title="Name", description="Solver, or auto for the best that is installed"
    )
    precision: Annotated[Precision, one_of(Precision, "a precision")] = Field(
        "mixed",
        title="Precision",
        description="Factors in single precision with refinement (mixed), or in double",
    )
    tolerance: Annotated[Number, between(0.0, 1e-3, open_low=True)] = Field(
        1e-10, title="Tolerance", description="Relative residual that each solve aims at"
    )
