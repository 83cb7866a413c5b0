# SPDX-License-Identifier: LGPL-2.1-or-later
"""What can be known of a body in water before anything heavy runs."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from quietblade.case import BodyCase, Finding
from quietblade.case.materials import IsotropicWords
from quietblade.errors import Notice
from quietblade.study import translate
from quietblade.study.limits import far_field_findings, limit_notices, limits
from quietblade.study.losses import moduli, moduli_notices
from quietblade.study.preflight import (
    Surroundings,
    plate_wavelength,
    surroundings,
    too_fine,
    unused_notices,
    water_size_findings,
)
from quietblade.study.spectra import spectra
from quietblade.typing import FloatArray


@dataclass(frozen=True)
class BodyPreflight(Surroundings):
    """A case of a body that can be run, and what follows from it without a mesh.

    Attributes
    ----------
    volume, mass : float
        Of the wall [m3, kg].
    """

    volume: float
    mass: float


def body_preflight(case: BodyCase) -> BodyPreflight:
    """Check everything that can be checked before meshing.

    Raises
    ------
    InvalidCaseError
        A table, a limit, a point or a model of the loss is impossible, the sphere does not
        enclose the body with the stated gap, or the mesh size is absurd; each with file, line,
        key, value and remedy.
    """
    spectra(case)
    held = limits(case)
    complex_moduli = moduli(case)
    body = case.body
    centre, radius = translate.sphere(case)
    clearance = radius - float(np.linalg.norm(centre)) - body.radius
    area = 4.0 * np.pi * body.radius**2
    faces = int(min(area / (0.25 * np.sqrt(3.0) * case.mesh.size**2), 1e15)) + 1
    findings = [
        *_sphere_findings(case, clearance),
        *_mesh_findings(case, faces),
        *far_field_findings(case, sphere_points(body.radius, case.mesh.size)),
    ]
    if findings:
        raise case.invalid(*findings)
    words = case.material("body")
    assert isinstance(words, IsotropicWords)  # the case has no other law for a body
    volume = 4.0 / 3.0 * np.pi * (body.radius**3 - (body.radius - body.thickness) ** 3)
    bending = plate_wavelength(
        rigidity=words.E * body.thickness**3 / 12.0 / (1.0 - words.nu**2),
        mass=words.density * body.thickness,
        water=case.water.density,  # on one side
        frequency=case.acoustics.band[1],
    )
    known = surroundings(
        case,
        clearance=clearance,
        bending=bending,
        faces=faces,
        moduli=complex_moduli,
        notices=(
            *_thin_notices(case),
            *unused_notices(case),
            *limit_notices(case, held),
            *moduli_notices(case, complex_moduli),
        ),
    )
    return BodyPreflight(**vars(known), volume=volume, mass=volume * words.density)


def sphere_points(radius: float, apart: float) -> FloatArray:
    """Points on a sphere about the origin, no farther than ``apart`` from each other (n, 3) [m].

    On a spiral that turns by the golden angle from point to point.
    """
    count = int(np.clip(4.0 * np.pi * (2.0 * radius / apart) ** 2, 1000, 200_000))
    height = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(count)
    flat = np.sqrt(1.0 - height**2)
    return radius * np.stack([flat * np.cos(turn), flat * np.sin(turn), height], axis=1)


def _sphere_findings(case: BodyCase, clearance: float) -> Iterator[Finding]:
    gap = case.acoustics.gap
    if clearance >= gap:
        return
    least = case.acoustics.sphere_radius - clearance + gap
    fault = (
        f"the body reaches {-1e3 * clearance:.4g} mm out of the sphere"
        if clearance < 0.0
        else f"the body comes within {1e3 * clearance:.4g} mm of the sphere, and the gap is "
        f"{1e3 * gap:.4g} mm"
    )
    remedy = f"A radius above {least:.4g} m encloses the body"
    yield Finding(("acoustics", "sphere_radius"), fault, remedy)


def _mesh_findings(case: BodyCase, faces: int) -> Iterator[Finding]:
    radius = case.body.radius
    remedy = f'Try size = "{200 * radius:.3g} mm", a fifth of the radius'
    if case.mesh.size > 0.5 * radius:
        fault = f"is too coarse: less than two elements on a radius of {1e3 * radius:.4g} mm"
        yield Finding(("mesh", "size"), fault, remedy)
    elif too_fine(faces):
        fault = f"is too fine: about {faces:.2g} triangles on the body alone"
        yield Finding(("mesh", "size"), fault, remedy)
    yield from water_size_findings(case)


def _thin_notices(case: BodyCase) -> Iterator[Notice]:
    """Say where cells are flat: longer than the wall is thick by far."""
    ratio = case.mesh.size / case.body.thickness
    if ratio > _LONG_CELLS:
        yield Notice(
            "mesh.size",
            "the cells are long against the wall's thickness, which makes poor ones",
            ratio,
            _LONG_CELLS,
            "Reduce mesh.size",
        )


_LONG_CELLS = 3.0
