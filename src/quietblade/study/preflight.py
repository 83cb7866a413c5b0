# SPDX-License-Identifier: LGPL-2.1-or-later
"""What can be known of a study before anything heavy runs: refusals, estimates, notices."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from quietblade.case import AnyCase, Case, Finding
from quietblade.case.materials import MooneyRivlinWords, NeoHookeanWords
from quietblade.errors import Notice
from quietblade.geometry import Blade
from quietblade.study import solids, translate
from quietblade.study.limits import far_field_findings, limit_notices, limits
from quietblade.study.loads import steady_loads
from quietblade.study.losses import Modulus, moduli, moduli_notices
from quietblade.study.spectra import spectra
from quietblade.typing import FloatArray

_MOST_FACES = 400_000
_LEAST_KR = 3.0
_LEAST_PER_WAVELENGTH = 6.0
_SOFTEST_SOLID = 1e6  # [Pa]
_SOFTEST_FILM = 1e3  # [Pa]


@dataclass(frozen=True)
class Surroundings:
    """A body in its sphere of water, as far as it is known without a mesh.

    Attributes
    ----------
    centre : (3,) float array
        Centre of the water sphere [m].
    radius, clearance : float
        Radius of the sphere, and least distance of the body at rest from it [m].
    kr : (2,) float array
        Wave number times radius at the ends of the band.
    acoustic_wavelength, bending_wavelength : float
        In the water, and of the body in the water (estimate), at the top of the band [m].
    elements_per_acoustic_wavelength, elements_per_bending_wavelength : float
        Wavelength over the largest edge length of the elements.
    surface_elements : int
        Estimated number of triangles on the body.
    moduli : tuple of Modulus
        Complex moduli of the parts whose loss is more than a number.
    notices : tuple of Notice
    """

    centre: FloatArray
    radius: float
    clearance: float
    kr: FloatArray
    acoustic_wavelength: float
    bending_wavelength: float
    elements_per_acoustic_wavelength: float
    elements_per_bending_wavelength: float
    surface_elements: int
    moduli: tuple[Modulus, ...]
    notices: tuple[Notice, ...]


@dataclass(frozen=True)
class Preflight(Surroundings):
    """A case of a blade that can be run, and what follows from it without a mesh.

    Attributes
    ----------
    blade : Blade
        The blade; it is a possible shape and its film fits.
    incidence : (2,) float array
        Angle of attack of the undeformed blade at root and tip [rad].
    film_cover : float or None
        Least material between the film and a face [m].
    """

    blade: Blade
    incidence: FloatArray
    film_cover: float | None


def preflight(case: Case) -> Preflight:
    """Check everything that can be checked before meshing.

    Raises
    ------
    InvalidCaseError
        The blade, its film, a load, its table, a limit, a point or a model of the loss is
        impossible, the sphere does not enclose the blade with the stated gap, or the mesh size is
        absurd; each with file, line, key, value and remedy.
    """
    blade = translate.build_blade(case)
    steady_loads(case, blade)
    spectra(case)
    held = limits(case)
    complex_moduli = moduli(case)
    centre, radius = translate.sphere(case)
    clearance, outermost = _clearance(blade, centre, radius)
    faces = _surface_elements(blade, case.mesh.size)
    findings = [
        *_sphere_findings(case, clearance, outermost),
        *_mesh_findings(case, blade, faces),
        *far_field_findings(case, _surface(blade)),
        *_campbell_findings(case),
    ]
    if findings:
        raise case.invalid(*findings)
    ends = np.array([0.0, 1.0])
    swirl = case.flow.rotation * blade.radius(ends)
    known = surroundings(
        case,
        clearance=clearance,
        bending=bending_wavelength(case, blade, case.acoustics.band[1]),
        faces=faces,
        moduli=complex_moduli,
        notices=(
            *_material_notices(case),
            *limit_notices(case, held),
            *moduli_notices(case, complex_moduli),
        ),
    )
    return Preflight(
        **vars(known),
        blade=blade,
        incidence=np.arctan2(swirl, case.flow.speed) + blade.blade_angle(ends),
        film_cover=_film_cover(blade),
    )


def surroundings(
    case: AnyCase,
    *,
    clearance: float,
    bending: float,
    faces: int,
    moduli: tuple[Modulus, ...],
    notices: tuple[Notice, ...],
) -> Surroundings:
    """Put together what the water makes of a body; notices of waves come before the given ones.

    Parameters
    ----------
    case : AnyCase
    clearance : float
        Least distance of the body at rest from the sphere [m].
    bending : float
        Bending wavelength at the top of the band [m].
    faces : int
        Triangles on the body.
    moduli : tuple of Modulus
    notices : tuple of Notice
    """
    centre, radius = translate.sphere(case)
    kr = 2.0 * np.pi * np.array(case.acoustics.band) / case.water.sound_speed * radius
    acoustic = case.water.sound_speed / case.acoustics.band[1]
    per_acoustic = acoustic / translate.water_size(case)
    per_bending = bending / case.mesh.size
    return Surroundings(
        centre=centre,
        radius=radius,
        clearance=clearance,
        kr=kr,
        acoustic_wavelength=acoustic,
        bending_wavelength=bending,
        elements_per_acoustic_wavelength=per_acoustic,
        elements_per_bending_wavelength=per_bending,
        surface_elements=faces,
        moduli=moduli,
        notices=(
            *_radiation_notices(case, float(kr[0])),
            *_mesh_notices(case, per_bending, per_acoustic),
            *notices,
        ),
    )


def bending_wavelength(case: Case, blade: Blade, frequency: float) -> float:
    """Estimate the wavelength of bending waves along the blade in water [m].

    A plate of the blade's mean thickness at mid-span, without film, with water on both sides:
    ``D k^4 = omega^2 (rho_s h + 2 rho / k)`` well below coincidence (Fahy and Gardonio, Sound and
    Structural Vibration, 2nd ed., section 4.2).

    Parameters
    ----------
    case : Case
    blade : Blade
    frequency : float
        [Hz]
    """
    middle = np.array([0.5])
    xi = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 201))
    half = blade.family.half_thickness(xi, blade.thickness(middle), blade.trailing_edge)
    height = float(2.0 * np.trapezoid(half, xi) * blade.chord(middle)[0])
    return plate_wavelength(
        rigidity=solids.bending_modulus(case) * height**3 / 12.0,
        mass=solids.blade_density(case) * height,
        water=2.0 * case.water.density,
        frequency=frequency,
    )


def plate_wavelength(*, rigidity: float, mass: float, water: float, frequency: float) -> float:
    """Wavelength of bending waves of a plate in water [m], well below coincidence.

    Parameters
    ----------
    rigidity, mass : float
        Of the plate by its width, and by its area [N m, kg/m2].
    water : float
        Densities of the water on its sides, added up [kg/m3].
    frequency : float
        [Hz]
    """
    omega = 2.0 * np.pi * frequency

    def excess(log_k: float) -> float:
        k = np.exp(log_k)
        added = water / k
        return float(np.log(rigidity) + 4.0 * log_k - np.log(omega**2 * (mass + added)))

    return float(2.0 * np.pi / np.exp(brentq(excess, -50.0, 50.0)))


def _clearance(blade: Blade, centre: FloatArray, radius: float) -> tuple[float, float]:
    """Least distance from the sphere, negative outside, and the span fraction where it is."""
    s = np.linspace(0.0, 1.0, 101)
    reach = np.linalg.norm(blade.section(s, 161) - centre, axis=-1).max(axis=1)
    worst = int(np.argmax(reach))
    return radius - float(reach[worst]), float(s[worst])


def _sphere_findings(case: Case, clearance: float, where: float) -> Iterator[Finding]:
    gap, radius = case.acoustics.gap, case.acoustics.sphere_radius
    if clearance < gap:
        least = radius - clearance + gap
        if clearance < 0.0:
            fault = f"the blade reaches {-1e3 * clearance:.4g} mm out of the sphere"
        else:
            fault = (
                f"the blade comes within {1e3 * clearance:.4g} mm of the sphere, and the gap is "
                f"{1e3 * gap:.4g} mm,"
            )
        yield Finding(
            ("acoustics", "sphere_radius"),
            f"{fault} at span fraction {where:.3g}",
            f"A radius above {least:.4g} m encloses the blade at rest; leave room for its "
            "deformation",
        )


def _surface(blade: Blade) -> FloatArray:
    return blade.section(np.linspace(0.0, 1.0, 201), 161).reshape(-1, 3)


def _surface_elements(blade: Blade, size: float) -> int:
    triangle = 0.25 * np.sqrt(3.0) * size**2
    count = 2.0 * blade.planform_area() / triangle if triangle > 0.0 else np.inf
    return int(min(count, 1e15)) + 1


def _mesh_findings(case: Case, blade: Blade, faces: int) -> Iterator[Finding]:
    longest = float(blade.chord(np.linspace(0.0, 1.0, 101)).max())
    size = case.mesh.size
    if size > 0.5 * longest:
        yield Finding(
            ("mesh", "size"),
            f"is too coarse: less than two elements on a chord of {1e3 * longest:.4g} mm",
            f'Try size = "{100 * longest:.3g} mm", a tenth of the longest chord',
        )
    elif too_fine(faces):
        yield Finding(
            ("mesh", "size"),
            f"is too fine: about {faces:.2g} triangles on the blade alone",
            f'Try size = "{100 * longest:.3g} mm", a tenth of the longest chord',
        )
    yield from water_size_findings(case)


def too_fine(faces: int) -> bool:
    """Whether so many triangles on a body are a mistake."""
    return faces > _MOST_FACES


def water_size_findings(case: AnyCase) -> Iterator[Finding]:
    """Hold the size of the cells at the sphere against the others."""
    size, water_size = case.mesh.size, case.mesh.water_size
    if water_size is not None and not size <= water_size <= case.acoustics.sphere_radius:
        yield Finding(
            ("mesh", "water_size"),
            "must lie between the size on the surface and the sphere's radius",
            "Leave it out: a good size is then chosen",
        )


def _campbell_findings(case: Case) -> Iterator[Finding]:
    words = case.campbell
    if words is None or words.advance == "fixed":
        return
    if case.flow.rotation == 0.0:
        yield Finding(
            ("campbell", "advance"),
            "the speed of advance cannot go with the shaft, which stands still in [flow]",
            'Give flow.rotation, or write advance = "fixed"',
        )
    elif words.speeds[0] == 0.0:
        yield Finding(
            ("campbell", "speeds"),
            'a shaft at rest has no water to advance in with advance = "scaled"',
            'Begin above zero, or write advance = "fixed"',
        )


def _film_cover(blade: Blade) -> float | None:
    if blade.film is None:
        return None
    s, xi = np.meshgrid(np.linspace(*blade.film.span, 61), np.linspace(*blade.film.chord, 121))
    return float(np.min(blade.film_cover(s, xi)))


def _radiation_notices(case: AnyCase, kr: float) -> Iterator[Notice]:
    """Say where an approximate condition is not exact enough."""
    if kr < _LEAST_KR and case.acoustics.radiation != "dtn":
        yield Notice(
            "acoustics.radiation",
            f"kR is small at {case.acoustics.band[0]:g} Hz for {case.acoustics.radiation}: sound "
            "levels are off by decibels, peak frequencies hardly",
            kr,
            _LEAST_KR,
            'Use radiation = "dtn", or a larger sphere_radius',
        )


def _mesh_notices(case: AnyCase, per_bending: float, per_acoustic: float) -> Iterator[Notice]:
    """Say where cells are too few for a wavelength."""
    for key, count, wave in (
        ("mesh.size", per_bending, "bending wavelength"),
        ("mesh.water_size", per_acoustic, "acoustic wavelength"),
    ):
        if count < _LEAST_PER_WAVELENGTH:
            yield Notice(
                key,
                f"few elements per {wave} at {case.acoustics.band[1]:g} Hz",
                count,
                _LEAST_PER_WAVELENGTH,
                f"Reduce {key}",
            )


def unused_notices(case: AnyCase) -> Iterator[Notice]:
    """Say which materials are not used."""
    for name in case.materials:
        if name not in solids.used_materials(case):
            yield Notice(f"materials.{name}", "this material is not used", remedy="Remove it")


def _material_notices(case: Case) -> Iterator[Notice]:
    yield from unused_notices(case)
    yield from solids.laminate_notices(case)
    parts = [("blade", solids.bending_modulus(case), _SOFTEST_SOLID)]
    if case.film is not None:
        film = case.material("film")
        if isinstance(film, MooneyRivlinWords | NeoHookeanWords):
            parts.append(("film", film.shear_modulus, _SOFTEST_FILM))
    for part, modulus, least in parts:
        if modulus < least:
            yield Notice(
                f"{part}.material",
                "the material is very soft",
                modulus,
                least,
                "mPa is millipascal, MPa megapascal",
            )
