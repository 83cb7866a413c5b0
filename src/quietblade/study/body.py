# SPDX-License-Identifier: LGPL-2.1-or-later
"""Step 2 of a body that is no blade: at rest, free in the water, so that there is no step 1."""

import ngsolve as ngs
import numpy as np

from quietblade.case import BodyCase, Finding
from quietblade.case.body import CapWords, PointWords
from quietblade.case.materials import IsotropicWords
from quietblade.errors import MaterialError
from quietblade.mesh import Mesh
from quietblade.mesh.model import INTERFACE, patch_name
from quietblade.mesh.shell import BODY, Cap, ShellSpec
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.propulsion.linear import newton_solver
from quietblade.propulsion.structure import Structure
from quietblade.study import translate
from quietblade.study.excitations import Drive, Excited, constant_amplitude, patch_area
from quietblade.study.frames import SphereFrames
from quietblade.study.solids import isotropic
from quietblade.study.spectra import names, spectra
from quietblade.study.vibration import LinearProblem, SolidMatrices, Vibration, assemble, find_modes
from quietblade.typing import FloatArray, Progress
from quietblade.vibroacoustics.excitation import pressure_force
from quietblade.vibroacoustics.fluid import normal_motion_matrix
from quietblade.vibroacoustics.loads import Excitation, Spectrum
from quietblade.vibroacoustics.multipoles import SurfaceSources
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.point_loads import point_force


def shell_spec(case: BodyCase) -> ShellSpec:
    """Say what the mesh shall be."""
    centre, radius = translate.sphere(case)
    caps = (words for words in case.excitation if isinstance(words, CapWords))
    return ShellSpec(
        outer=case.body.radius,
        thickness=case.body.thickness,
        size=case.mesh.size,
        water_size=translate.water_size(case),
        centre=(float(centre[0]), float(centre[1]), float(centre[2])),
        radius=radius,
        caps=tuple(Cap(words.axis, words.half_angle) for words in caps),
    )


def build_body(case: BodyCase, mesh: Mesh) -> Structure:
    """Make the structure, which nothing holds.

    Raises
    ------
    InvalidCaseError
        The material is not admissible.
    """
    words = case.material(BODY)
    assert isinstance(words, IsotropicWords)  # the case has no other law for a body
    try:
        material = isotropic(case.body.material, words)
    except MaterialError as error:
        raise case.invalid(Finding((BODY, "material"), str(error))) from error
    return Structure(
        mesh.fem, {BODY: material}, clamped=None, basis=mesh.basis, solver=newton_solver()
    )


def solve_body(case: BodyCase, mesh: Mesh, progress: Progress) -> Vibration:
    """Set up the linear problem of the body in water, and find its modes."""
    structure = build_body(case, mesh)
    solid = SolidMatrices.of(case, structure, structure.rest())
    with ngs.TaskManager():
        operators = assemble(case, mesh, solid, clamped=None)
        problem = LinearProblem(
            name="C0",
            operators=operators,
            excited=_excite(case, mesh, operators),
            sources=SurfaceSources.of(mesh.fem, mesh.basis, operators, surface=INTERFACE),
            normal_motion=normal_motion_matrix(mesh.fem, INTERFACE, None),
            positions=mesh.nodes,
            frames=SphereFrames.of(mesh),
        )
    return find_modes(case, mesh, problem, progress)


def _excite(case: BodyCase, mesh: Mesh, operators: Operators) -> Excited:
    tables = {number: Spectrum(*table) for number, table in spectra(case).items()}
    random, caps = case.acoustics.signal == "random", 0
    drives = []
    for number, (words, name) in enumerate(zip(case.excitation, names(case), strict=True)):
        if isinstance(words, CapWords):
            surface = patch_name(caps)
            caps += 1
            force = pressure_force(mesh.fem, 1.0, surface=surface)
            size = patch_area(mesh, mesh.nodes, surface)
        else:
            force, size = _push(case, words, mesh), 1.0
        amplitude = tables.get(number, constant_amplitude(words))
        load = Excitation(name, operators.right_hand_side(force), amplitude)
        unit = words.density_unit if random else words.unit
        drives.append(Drive(words.kind, unit, load, size))
    correlation = case.acoustics.correlation if random else None
    none = np.zeros((0, operators.size))
    return Excited(tuple(drives), correlation, None, none, case.acoustics.band)


def _push(case: BodyCase, words: PointWords, mesh: Mesh) -> FloatArray:
    """Force on the unknowns of a unit force."""
    outward = np.array(words.at) / np.linalg.norm(words.at)
    direction = -outward if words.direction is None else np.array(words.direction)
    surface = SurfaceQuadrature(mesh.nodes, mesh.interface)
    unit = direction / np.linalg.norm(direction)
    return point_force(mesh.basis, surface, case.body.radius * outward, unit)
