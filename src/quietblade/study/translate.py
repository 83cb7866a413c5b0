# SPDX-License-Identifier: LGPL-2.1-or-later
"""From the words of a case to the objects of physics; the only place that knows both.

Finite elements and mesher are imported where they are needed: a look at a case stays light.
"""
# ruff: noqa: PLC0415

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from quietblade import geometry
from quietblade.case import AnyCase, Case, Finding
from quietblade.case.excitation import PatchWords
from quietblade.case.spans import (
    ConstantSpan,
    FormulaSpan,
    SpanValue,
    TableSpan,
    spanwise_quantity,
)
from quietblade.case.tables import BladeWords
from quietblade.errors import GeometryError
from quietblade.geometry import Blade, Film, SectionFamily, SpanFunction
from quietblade.typing import FloatArray

if TYPE_CHECKING:
    import ngsolve as ngs

    from quietblade.flow.environment import Environment
    from quietblade.flow.inflow import StripInflow
    from quietblade.flow.lifting_line import LiftingLineInflow
    from quietblade.flow.momentum import MomentumInflow
    from quietblade.flow.wake import RadialWake
    from quietblade.mesh import Mesh, MeshSpec
    from quietblade.propulsion.loading import Spin
    from quietblade.vibroacoustics.fluid import Water
    from quietblade.vibroacoustics.radiation import RadiationCondition

REACH = 1.2
"""The radiation condition is made for this multiple of the band's upper end."""

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
        family=_family(case),
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


def _family(case: Case) -> SectionFamily:
    file = case.files.get("blade.section")
    if file is None:
        return geometry.section_family(case.blade.section)
    try:
        return geometry.section_from_file(file)
    except GeometryError as error:
        raise case.invalid(_finding(("blade", "section"), error)) from error


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


def sphere(case: AnyCase) -> tuple[FloatArray, float]:
    """Centre (3,) and radius of the water sphere [m]."""
    centre = case.acoustics.sphere_centre
    return np.array(case.middle if centre is None else centre), case.acoustics.sphere_radius


def water_size(case: AnyCase) -> float:
    """Edge length of the elements at the sphere [m], as given or as the case needs it."""
    if case.mesh.water_size is not None:
        return case.mesh.water_size
    shortest = case.water.sound_speed / case.acoustics.band[1]
    return max(case.mesh.size, min(0.25 * case.acoustics.sphere_radius, shortest / 6.0))


def mesh_spec(case: Case) -> "MeshSpec":
    """Say what the mesh shall be."""
    from quietblade.mesh import MeshSpec, Patch

    centre, radius = sphere(case)
    return MeshSpec(
        size=case.mesh.size,
        centre=(float(centre[0]), float(centre[1]), float(centre[2])),
        radius=radius,
        patches=tuple(
            Patch(1 if words.side == "upper" else -1, words.span, words.chord)
            for words in case.excitation
            if isinstance(words, PatchWords)
        ),
        water_size=water_size(case),
    )


def inflow(case: Case) -> "StripInflow | LiftingLineInflow | MomentumInflow":
    """Water that meets the sections."""
    from quietblade.flow import LiftingLineInflow, MomentumInflow, StripInflow

    flow = case.flow
    stream = (
        flow.speed, flow.rotation, case.water.density, case.water.kinematic_viscosity,
        wake(case), flow.blades,
    )  # fmt: skip
    match flow.inflow:
        case "none":
            return StripInflow(*stream)
        case "lifting-line":
            return LiftingLineInflow(*stream, root=flow.root, control=flow.control)
        case "momentum":
            return MomentumInflow(*stream)


def wake(case: Case) -> "RadialWake | None":
    """Mean inflow along the radius, if the case has one."""
    from quietblade.flow import radial_wake

    words = case.flow.wake
    return None if words is None else radial_wake(words.radius, words.axial, words.tangential)


def environment(case: Case) -> "Environment":
    """Say what decides stall and cavitation besides the loads."""
    from quietblade.flow import Environment

    return Environment(
        depth=case.flow.depth,
        atmospheric_pressure=case.flow.atmospheric_pressure,
        vapour_pressure=case.water.vapour_pressure,
    )


def spin(case: Case) -> "Spin":
    """Rotation that the structure feels."""
    from quietblade.propulsion.loading import Spin

    return Spin(case.flow.rotation)


def water(case: AnyCase) -> "Water":
    """Water that carries the sound."""
    from quietblade.vibroacoustics.fluid import Water

    return Water(case.water.density, case.water.sound_speed)


def radiation(
    case: AnyCase, mesh: "Mesh", motion: "ngs.GridFunction | None"
) -> "RadiationCondition":
    """Radiation condition on the outer sphere, exact up to the degree that the body needs.

    Raises
    ------
    InvalidCaseError
        The body is too close to the sphere.
    """
    from quietblade.vibroacoustics.dtn import fitted_dtn
    from quietblade.vibroacoustics.radiation import Bgt1, Bgt2

    match case.acoustics.radiation:
        case "bgt1":
            return Bgt1()
        case "bgt2":
            return Bgt2()
        case "dtn":
            try:
                return fitted_dtn(
                    mesh.fem,
                    REACH * case.acoustics.band[1],
                    sound_speed=case.water.sound_speed,
                    radius=mesh.radius,
                    accuracy=case.acoustics.radiation_accuracy,
                    motion=motion,
                )
            except ValueError as error:
                finding = Finding(("acoustics", "sphere_radius"), str(error), "Enlarge the sphere")
                raise case.invalid(finding) from error


def base_frequencies(case: AnyCase) -> FloatArray:
    """Frequencies of the sweep before refinement [Hz], from end to end of the band."""
    low, high = case.acoustics.band
    intervals = max(1, round((high - low) / case.acoustics.step))
    return np.linspace(low, high, intervals + 1)


def _finding(path: tuple[str, ...], error: GeometryError) -> Finding:
    """Take the subject and the remedy off a message of the form ``subject: fault; remedy``."""
    text = str(error).removeprefix("blade: ").removeprefix("film: ")
    if path == ("blade",) and (key := text.split(" ", 1)[0]) in SPANWISE:
        path = ("blade", key)
    message, _, remedy = text.rpartition("; ")
    return Finding(path, message or remedy, remedy[:1].upper() + remedy[1:] if message else "")
