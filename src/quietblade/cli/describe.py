# SPDX-License-Identifier: LGPL-2.1-or-later
"""A case in words for people, and as data for programs."""

from dataclasses import asdict
from math import degrees, pi
from typing import Any

import numpy as np

from quietblade.case import AnyCase, BodyCase, Case
from quietblade.case.body import CapWords, PointWords
from quietblade.case.excitation import (
    ExcitationWords,
    LinePushWords,
    PatchWords,
    PushWords,
    RootMotionWords,
)
from quietblade.case.laminate import LaminateWords
from quietblade.case.materials import (
    AnisotropicWords,
    IsotropicWords,
    OrthotropicWords,
    SolidWords,
)
from quietblade.case.spans import ConstantSpan, FormulaSpan, SpanValue
from quietblade.case.tables import AcousticsWords
from quietblade.case.units import in_unit
from quietblade.cli.describe_outlook import outlook_data
from quietblade.study.body_preflight import BodyPreflight
from quietblade.study.losses import Modulus
from quietblade.study.outlook import Outlook
from quietblade.study.preflight import Preflight, Surroundings
from quietblade.study.spectra import names

Rows = list[tuple[str, str]]


def case_tables(case: AnyCase, known: Surroundings) -> list[tuple[str, Rows]]:
    """Say in words and convenient units what a case says and what follows from it."""
    return [
        *_own_tables(case, known),
        ("Acoustics", _acoustics_rows(case, known)),
        ("Sound far away", _far_rows(case)),
        *([("Complex moduli", _modulus_rows(case, known))] if known.moduli else []),
        ("Numbers", _number_rows(case, known)),
    ]


def _own_tables(case: AnyCase, known: Surroundings) -> list[tuple[str, Rows]]:
    """Say what only a blade has, or another body."""
    if isinstance(case, Case) and isinstance(known, Preflight):
        return [("Blade", _blade_rows(case, known)), ("Flow", _flow_rows(case, known))]
    assert isinstance(case, BodyCase)
    assert isinstance(known, BodyPreflight)
    return [("Body", _body_rows(case, known))]


def _body_rows(case: BodyCase, known: BodyPreflight) -> Rows:
    body = case.body
    return [
        ("kind", f"{body.kind} about the origin, nothing inside, free in the water"),
        ("outer radius", _mm(body.radius)),
        ("wall", f"{_mm(body.thickness)} thick"),
        ("volume, mass", f"{1e3 * known.volume:.4g} litres, {known.mass:.4g} kg"),
        ("material", f"{body.material}: {_solid(case.material('body'))}"),
        ("water", _water(case)),
    ]


def _water(case: AnyCase) -> str:
    return f"{case.water.density:g} kg/m^3, sound speed {case.water.sound_speed:g} m/s"


def _blade_rows(case: Case, known: Preflight) -> Rows:
    blade = case.blade
    rows = [
        ("span", f"{_mm(blade.span)} from radius {_mm(blade.hub_radius)}"),
        ("sections", f"{blade.section}, trailing edge {100 * blade.trailing_edge:.3g} % of chord"),
        ("chord", _spanwise(blade.chord, "mm")),
        ("thickness", _spanwise(blade.thickness, "%", "of chord")),
        ("camber", _spanwise(blade.camber, "%", "of chord")),
        ("blade angle", _spanwise(blade.blade_angle, "deg", "from the rotor axis")),
        ("sweep", _spanwise(blade.sweep, "mm")),
        ("rake", _spanwise(blade.rake, "mm")),
        ("reference line", f"at {100 * blade.alignment:.3g} % of chord"),
        ("volume", f"{1e3 * known.blade.volume():.4g} litres"),
        ("material", f"{blade.material}: {_solid(case.material('blade'))}"),
    ]
    if case.film is None or known.film_cover is None:
        return [*rows, ("film", "none")]
    film = case.film
    return [
        *rows,
        (
            "film",
            f"{_mm(film.thickness)} thick, span {_percent(film.span)}, "
            f"chord {_percent(film.chord)}, least cover {_mm(known.film_cover)}",
        ),
        ("film material", f"{film.material}: {_solid(case.material('film'))}"),
    ]


def _flow_rows(case: Case, known: Preflight) -> Rows:
    flow = case.flow
    root, tip = (degrees(angle) for angle in known.incidence)
    return [
        ("water", _water(case)),
        ("speed", f"{flow.speed:.4g} m/s along the rotor axis"),
        ("rotation", f"{flow.rotation:.4g} rad/s ({in_unit(flow.rotation, 'rpm'):.4g} rpm)"),
        ("rotor", _rotor(case)),
        ("incidence", f"{root:.3g} deg at the root, {tip:.3g} deg at the tip (undeformed)"),
        ("inflow", f"{flow.inflow}, {flow.sections} sections of {flow.section_nodes} nodes"),
        (
            "equilibrium",
            f"to {case.static.tolerance:g} in at most {case.static.max_iterations} iterations",
        ),
    ]


def _rotor(case: Case) -> str:
    diameter = 2.0 * (case.blade.hub_radius + case.blade.span)
    count = f"{case.flow.blades} blade{'s' if case.flow.blades > 1 else ''}"
    if case.flow.rotation == 0.0:
        return f"{count}, fixed"
    advance = 2.0 * pi * case.flow.speed / (abs(case.flow.rotation) * diameter)
    return f"{count}, diameter {diameter:.4g} m, V/nD {advance:.3g} at the ship's speed"


def _acoustics_rows(case: AnyCase, known: Surroundings) -> Rows:
    acoustics = case.acoustics
    low, high = acoustics.band
    centre = ", ".join(f"{x:.4g}" for x in known.centre)
    return [
        ("band", f"{low:g} to {high:g} Hz, every {acoustics.step:g} Hz"),
        ("refinement", f"{acoustics.points_per_mode} frequencies around each wet mode"),
        ("configurations", " and ".join(acoustics.configurations)),
        ("sphere", f"radius {known.radius:.4g} m about ({centre}) m"),
        ("gap", f"{_mm(known.clearance)} at rest, {_mm(acoustics.gap)} asked for"),
        ("radiation", f"{acoustics.radiation}, kR = {known.kr[0]:.3g} to {known.kr[1]:.3g}"),
        ("tangent, loss", f"{acoustics.tangent}, {acoustics.loss}"),
        *([("stream", _stream(acoustics))] if isinstance(case, Case) else []),
        ("modes", "wet and dry" if acoustics.dry_modes else "wet"),
        *_campbell_rows(case),
        *_excitation_rows(case),
    ]


def _stream(acoustics: AcousticsWords) -> str:
    return "damps the blade" if acoustics.flow_damping else "does not damp the blade"


def _far_rows(case: AnyCase) -> Rows:
    far, limits = case.far_field, case.limits
    given = "".join(f", {f:.6g} Hz" for f in far.frequencies)
    place = "far away" if far.distance is None else f"at {far.distance:g} m"
    rows = [
        ("directivity", f"{place}, planes {', '.join(far.planes)}, at the peaks{given}"),
        ("bands", "decidecades" if case.bands.kind == "decidecade" else "third octaves, base two"),
    ]
    for point in far.points:
        rows.append(("pressure at", f"({', '.join(f'{x:.4g}' for x in point)}) m"))
    for limit in limits:
        values = f"from {limit.table}" if limit.table else f"{len(limit.levels)} levels"
        rows.append(
            ("limit", f"{limit.name}: {limit.quantity}, bands {limit.bands}, {values}"),
        )
    return rows


def _campbell_rows(case: AnyCase) -> Rows:
    words = case.campbell if isinstance(case, Case) else None
    if words is None or not isinstance(case, Case):
        return []
    count = len(words.speeds)
    orders = ", ".join(map(str, words.orders))
    return [
        (
            "Campbell diagram",
            f"{count} speeds from {words.speeds[0]:.4g} to {words.speeds[-1]:.4g} rad/s, advance "
            f"{words.advance}, orders {orders} of {case.flow.blades} blades",
        ),
        ("  costs", f"{count} more equilibria, mesh motions and solutions for wet modes"),
    ]


def _excitation_rows(case: AnyCase) -> Rows:
    random = case.acoustics.signal == "random"
    rows = [
        (f"excitation {name}", f"{_amplitude(words, random=random)} {_place(words)}")
        for name, words in zip(names(case), case.excitation, strict=True)
    ]
    if random:
        rows.append(("signal", f"random, correlation {case.acoustics.correlation}"))
    if case.transfer is not None:
        rows.append(("transfer functions", ", ".join(case.transfer.functions)))
    return rows


def _amplitude(words: ExcitationWords, *, random: bool) -> str:
    if words.table is not None:
        return f"{words.table} [{words.density_unit if random else words.unit}],"
    if random:
        return f"{words.density_value:g} {words.density_unit}"
    value = 1.0 if words.amplitude_value is None else words.amplitude_value
    phase = f" at {degrees(words.phase):.4g} deg" if words.phase else ""
    return f"{value:g} {words.unit}{phase}"


def _place(words: ExcitationWords) -> str:
    if isinstance(words, CapWords):
        return f"on a cap of {degrees(words.half_angle):.4g} deg about ({_listed(words.axis)})"
    if isinstance(words, PointWords):
        along = "towards the centre"
        if words.direction is not None:
            along = f"along ({_listed(words.direction)})"
        return f"at ({_listed(words.at)}) from the centre, {along}"
    if isinstance(words, PatchWords):
        return (
            f"on the {words.side} face, span {_percent(words.span)}, chord {_percent(words.chord)}"
        )
    if isinstance(words, RootMotionWords):
        how = "about" if words.motion == "rotation" else "along"
        return f"{words.motion} of the root {how} {words.axis}"
    assert isinstance(words, PushWords | LinePushWords)
    ends = (words.at,) if isinstance(words, PushWords) else (words.start, words.end)
    places = " to ".join(f"({100 * s:.3g} % span, {100 * xi:.3g} % chord)" for s, xi in ends)
    return f"on the {words.face} face at {places}, along ({_listed(words.direction)})"


def _listed(vector: tuple[float, ...]) -> str:
    return ", ".join(f"{x:g}" for x in vector)


def _number_rows(case: AnyCase, known: Surroundings) -> Rows:
    high, what = case.acoustics.band[1], case.parts[0]
    return [
        ("mesh", f"{_mm(case.mesh.size)} on the {what}: about {known.surface_elements} triangles"),
        (
            "in water",
            f"{known.elements_per_acoustic_wavelength:.3g} elements per wavelength of "
            f"{known.acoustic_wavelength:.3g} m at {high:g} Hz",
        ),
        (
            f"on the {what}",
            f"about {known.elements_per_bending_wavelength:.2g} elements per bending wavelength of "
            f"{known.bending_wavelength:.2g} m at {high:g} Hz",
        ),
        ("solver", f"{case.solver.name}, {case.solver.precision} precision"),
        ("content key", case.content_key()[:16]),
    ]


def case_data(case: AnyCase, known: Surroundings, ahead: Outlook) -> dict[str, Any]:
    """Return the same as plain data in SI units, angles in rad."""
    return {
        "valid": True,
        "file": case.file,
        "content_key": case.content_key(),
        "case": case.plain(),
        "derived": {
            **_own_data(known),
            "sphere_centre_m": known.centre.tolist(),
            "sphere_radius_m": known.radius,
            "clearance_m": known.clearance,
            "kr": known.kr.tolist(),
            "acoustic_wavelength_m": known.acoustic_wavelength,
            "bending_wavelength_m": known.bending_wavelength,
            "elements_per_acoustic_wavelength": known.elements_per_acoustic_wavelength,
            "elements_per_bending_wavelength": known.elements_per_bending_wavelength,
            "surface_elements": known.surface_elements,
            "moduli": [_modulus_data(case, modulus) for modulus in known.moduli],
        },
        **outlook_data(ahead),
        "notices": [asdict(notice) for notice in (*known.notices, *ahead.notices)],
    }


def _own_data(known: Surroundings) -> dict[str, Any]:
    if isinstance(known, Preflight):
        return {
            "volume_m3": known.blade.volume(),
            "planform_area_m2": known.blade.planform_area(),
            "film_cover_m": known.film_cover,
            "incidence_rad": known.incidence.tolist(),
        }
    assert isinstance(known, BodyPreflight)
    return {"volume_m3": known.volume, "mass_kg": known.mass}


def _modulus_data(case: AnyCase, modulus: Modulus) -> dict[str, Any]:
    band = np.array(case.acoustics.band)
    g = modulus.at(band)
    return {
        "name": modulus.name,
        "model": modulus.model,
        "static_modulus_pa": _known(modulus.static),
        "temperature_k": _known(modulus.temperature),
        "shift": modulus.shift,
        "frequency_hz": band.tolist(),
        "storage_ratio": g.real.tolist(),
        "loss_factor": (g.imag / g.real).tolist(),
        "fit_error": None if modulus.fit is None else modulus.fit.error,
    }


def _known(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _spanwise(words: SpanValue, unit: str, of: str = "") -> str:
    if isinstance(words, ConstantSpan):
        text = f"{in_unit(words.value, unit):.4g} {unit}"
    elif isinstance(words, FormulaSpan):
        text = f"{words.formula} {words.unit}".rstrip()
    else:
        values = ", ".join(f"{in_unit(value, unit):.4g}" for value in words.values)
        places = ", ".join(f"{s:.4g}" for s in words.s)
        text = f"{values} {unit} at s = {places} ({words.interpolation})"
    return f"{text} {of}".rstrip()


def _solid(words: SolidWords) -> str:
    if isinstance(words, LaminateWords):
        angles = ", ".join(f"{degrees(ply.angle):.4g}" for ply in words.plies)
        return f"laminate [{angles}] deg x {words.repeat}, {words.drape}, model {words.model}"
    density = f"{words.density:g} kg/m^3"
    if isinstance(words, IsotropicWords):
        return f"isotropic, E = {_gpa(words.E)}, nu = {words.nu:g}, {density}"
    if isinstance(words, OrthotropicWords):
        moduli = f"{_gpa(words.E1)}, {_gpa(words.E2)}, {_gpa(words.E3)}"
        angle = degrees(words.ply_angle)
        return f"orthotropic, E = {moduli}, axis 1 at {angle:.4g} deg to the span, {density}"
    if isinstance(words, AnisotropicWords):
        angle = degrees(words.ply_angle)
        return f"anisotropic, axis 1 at {angle:.4g} deg to the span, {density}"
    shear = f"G = {words.shear_modulus / 1e6:.4g} MPa"
    loss = words.loss_factor
    damping = f"loss factor {loss:g}" if isinstance(loss, float) else "loss by a model (below)"
    return f"{words.law}, {shear}, {damping}, {density}"


def _modulus_rows(case: AnyCase, known: Surroundings) -> Rows:
    low, high = case.acoustics.band
    rows = []
    for modulus in known.moduli:
        g = modulus.at(np.array([low, high]))
        storage, factor = g.real, g.imag / g.real
        text = modulus.model
        if np.isfinite(modulus.temperature):
            text += f" at {modulus.temperature - 273.15:.4g} degC (a_T = {modulus.shift:.3g})"
        text += (
            f": storage modulus {storage[0]:.3g} to {storage[1]:.3g} times the static one, loss "
            f"factor {factor[0]:.3g} to {factor[1]:.3g}, from {low:g} to {high:g} Hz"
        )
        if modulus.fit is not None:
            text += f"; fit within {100 * modulus.fit.error:.2g} % of the points"
        rows.append((modulus.name, text))
    return rows


def _mm(value: float) -> str:
    return f"{1e3 * value:.4g} mm"


def _gpa(value: float) -> str:
    return f"{value / 1e9:.4g} GPa"


def _percent(extent: tuple[float, float]) -> str:
    return f"{100 * extent[0]:.3g} to {100 * extent[1]:.3g} %"
