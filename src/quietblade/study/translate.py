# SPDX-License-Identifier: LGPL-2.1-or-later
"""From the words of a case to the objects of physics; the only place that knows both.

Finite elements and mesher are imported where they are needed: a look at a case stays light.
"""
# ruff: noqa: PLC0415

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from quietblade import geometry
from quietblade.case import Case, Finding
from quietblade.case.materials import IsotropicWords, MooneyRivlinWords, OrthotropicWords
from quietblade.case.spans import (
    ConstantSpan,
    FormulaSpan,
    SpanValue,
    TableSpan,
    spanwise_quantity,
)
from quietblade.case.tables import BladeWords
from quietblade.errors import GeometryError, MaterialError
from quietblade.geometry import Blade, Film, SpanFunction
from quietblade.typing import FloatArray

if TYPE_CHECKING:
    import ngsolve as ngs

    from quietblade.flow.inflow import StripInflow
    from quietblade.materials.protocols import Material
    from quietblade.mesh import MeshSpec
    from quietblade.propulsion.loading import Spin
    from quietblade.vibroacoustics.fluid import Water
    from quietblade.vibroacoustics.radiation import RadiationCondition

SPANWISE = ("chord", "thickness", "camber", "blade_angle", "sweep", "rake")
"""Keys of [blade] that are functions of the span."""

_STATIONS = np.linspace(0.0, 1.0, 401)


def build_blade(case: Case) -> Blade:
    """Make the blade and check that it is a possible shape into which the film fits.

    Raises
    ------
    InvalidCaseError
        With the lines of everything that is wrong with the shape, or of a film that does not fit.
    """
    functions: dict[str, SpanFunction] = {}
    findings = []
    for key in SPANWISE:
        words: SpanValue = getattr(case.blade, key)
        try:
            functions[key] = span_function(words)
        except GeometryError as error:
            findings.append(_finding(("blade", key, "formula"), error))
            continue
        findings.extend(_bounds_findings(key, functions[key]))
    if findings:
        raise case.invalid(*findings)
    solid = Blade(
        case.blade.hub_radius,
        case.blade.span,
        chord=functions["chord"],
        blade_angle=functions["blade_angle"],
        sweep=functions["sweep"],
        rake=functions["rake"],
        thickness=functions["thickness"],
        camber=functions["camber"],
        family=geometry.section_family(case.blade.section),
        trailing_edge=case.blade.trailing_edge,
        alignment=case.blade.alignment,
    )
    try:
        solid.check()
    except GeometryError as error:
        raise case.invalid(_finding(("blade",), error)) from error
    if case.film is None:
        return solid
    blade = replace(solid, film=Film(case.film.span, case.film.chord, case.film.thickness))
    try:
        blade.check(case.film.minimum_cover)
    except GeometryError as error:
        raise case.invalid(_finding(("film", "thickness"), error)) from error
    return blade


def _bounds_findings(key: str, function: SpanFunction) -> Iterator[Finding]:
    """Hold a formula or an interpolation against the bounds that single values have."""
    quantity = spanwise_quantity(BladeWords.model_fields[key].metadata)
    values = function(_STATIONS)
    for worst in (int(np.argmin(values)), int(np.argmax(values))):
        fault = quantity.fault(float(values[worst]))
        if fault is not None:
            value = f"{values[worst]:.4g} {quantity.kind.unit}".rstrip()
            message, remedy = fault
            message = f"is {value} at span fraction {_STATIONS[worst]:.3g}, which {message}"
            yield Finding(("blade", key), message, remedy)
            return


def span_function(words: SpanValue) -> SpanFunction:
    """Make a function of the span.

    Raises
    ------
    GeometryError
        A formula is not finite everywhere on the span.
    """
    match words:
        case ConstantSpan(value):
            return geometry.constant(value)
        case TableSpan(s, values, interpolation):
            return geometry.table(s, values, interpolation)
        case FormulaSpan(formula, _, scale):
            return geometry.formula(formula, scale)


def build_materials(case: Case) -> "Mapping[str, Material]":
    """Make the materials of the regions ``blade`` and ``film`` of the mesh.

    An orthotropic material's axes follow the twist of the blade.

    Raises
    ------
    InvalidCaseError
        A material is not admissible.
    """
    parts = {"blade": case.blade, "film": case.film}
    materials = {}
    for part, words in parts.items():
        if words is not None:
            try:
                materials[part] = _material(case, part, words.material)
            except MaterialError as error:
                raise case.invalid(_finding((part, "material"), error)) from error
    return materials


def _material(case: Case, part: str, name: str) -> "Material":
    from quietblade import materials

    words = case.material(part)
    match words:
        case IsotropicWords():
            return materials.IsotropicSVK(name, words.density, words.E, words.nu)
        case OrthotropicWords():
            return materials.OrthotropicSVK(
                name,
                words.density,
                e1=words.E1, e2=words.E2, e3=words.E3,
                g12=words.G12, g23=words.G23, g13=words.G13,
                nu12=words.ratio(1, 2), nu23=words.ratio(2, 3), nu13=words.ratio(1, 3),
                axes=materials.ply_axes(
                    words.ply_angle, *materials.section_directions(blade_angle_field(case))
                ),
            )  # fmt: skip
        case MooneyRivlinWords():
            return materials.MooneyRivlin(
                name,
                words.density,
                words.c10,
                words.c01,
                words.bulk_modulus,
                words.loss_factor,
            )


def blade_angle_field(case: Case) -> "float | ngs.CoefficientFunction":
    """Blade angle [rad] as a function of place in C0; a number where it is constant."""
    if isinstance(case.blade.blade_angle, ConstantSpan):
        return case.blade.blade_angle.value
    import ngsolve as ngs

    # piecewise linear: a spline of order 2 whose i-th value stands on knot i + 1; one knot more
    # at each end, because nodes of the root and the tip are only nearly there
    values = span_function(case.blade.blade_angle)(_STATIONS)
    radius = case.blade.hub_radius + case.blade.span * _STATIONS
    step = radius[1] - radius[0]
    knots = [radius[0] - 2.0 * step, radius[0] - step, *radius, radius[-1] + step]
    ends = [values[0], *values, values[-1], values[-1]]
    return ngs.BSpline(2, [float(z) for z in knots], [float(v) for v in ends])(ngs.z)


def sphere(case: Case) -> tuple[FloatArray, float]:
    """Centre (3,) and radius of the water sphere [m]."""
    centre = case.acoustics.sphere_centre
    if centre is None:
        centre = (0.0, 0.0, case.blade.hub_radius + 0.5 * case.blade.span)
    return np.array(centre), case.acoustics.sphere_radius


def water_size(case: Case) -> float:
    """Edge length of the elements at the sphere [m], as given or as the case needs it."""
    if case.mesh.water_size is not None:
        return case.mesh.water_size
    shortest = case.water.sound_speed / case.acoustics.band[1]
    return max(case.mesh.size, min(0.25 * case.acoustics.sphere_radius, shortest / 6.0))


def mesh_spec(case: Case) -> "MeshSpec":
    """Say what the mesh shall be."""
    from quietblade.mesh import MeshSpec, Patch

    centre, radius = sphere(case)
    side = 1 if case.excitation.side == "upper" else -1
    return MeshSpec(
        size=case.mesh.size,
        centre=(float(centre[0]), float(centre[1]), float(centre[2])),
        radius=radius,
        patch=Patch(side, case.excitation.span, case.excitation.chord),
        water_size=water_size(case),
    )


def inflow(case: Case) -> "StripInflow":
    """Water that meets the sections."""
    from quietblade.flow.inflow import StripInflow

    return StripInflow(
        case.flow.speed,
        case.flow.rotation,
        case.water.density,
        case.water.kinematic_viscosity,
    )


def spin(case: Case) -> "Spin":
    """Rotation that the structure feels."""
    from quietblade.propulsion.loading import Spin

    return Spin(case.flow.rotation)


def water(case: Case) -> "Water":
    """Water that carries the sound."""
    from quietblade.vibroacoustics.fluid import Water

    return Water(case.water.density, case.water.sound_speed)


def radiation(case: Case) -> "RadiationCondition":
    """Radiation condition on the outer sphere."""
    from quietblade.vibroacoustics.radiation import Bgt1

    return {"bgt1": Bgt1}[case.acoustics.radiation]()


def base_frequencies(case: Case) -> FloatArray:
    """Frequencies of the sweep before refinement [Hz], from end to end of the band."""
    low, high = case.acoustics.band
    intervals = max(1, round((high - low) / case.acoustics.step))
    return np.linspace(low, high, intervals + 1)


def _finding(path: tuple[str, ...], error: GeometryError | MaterialError) -> Finding:
    """Take the subject and the remedy off a message of the form ``subject: fault; remedy``."""
    text = str(error).removeprefix("blade: ").removeprefix("film: ")
    if path == ("blade",) and (key := text.split(" ", 1)[0]) in SPANWISE:
        path = ("blade", key)
    message, _, remedy = text.rpartition("; ")
    return Finding(path, message or remedy, remedy[:1].upper() + remedy[1:] if message else "")
