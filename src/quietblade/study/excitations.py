# SPDX-License-Identifier: LGPL-2.1-or-later
"""Excitations of a case: from words to load vectors and their amplitudes over frequency."""

from dataclasses import dataclass

import ngsolve as ngs
import numpy as np

from quietblade.case import Case
from quietblade.case.excitation import (
    ExcitationWords,
    LinePushWords,
    PatchWords,
    PushWords,
    RootMotionWords,
)
from quietblade.geometry import Blade
from quietblade.mesh import Mesh
from quietblade.mesh.model import patch_name
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.study.loads import line_on_face, on_face
from quietblade.study.spectra import names, spectra
from quietblade.typing import AnyArray, ComplexArray, FloatArray
from quietblade.vibroacoustics.combined import Combined
from quietblade.vibroacoustics.excitation import pressure_force
from quietblade.vibroacoustics.loads import (
    Correlation,
    Excitation,
    Spectrum,
    harmonic_amplitudes,
    independent_parts,
    load_vectors,
)
from quietblade.vibroacoustics.operators import Operators
from quietblade.vibroacoustics.point_loads import line_force, point_force
from quietblade.vibroacoustics.reduced import ReducedModel
from quietblade.vibroacoustics.root import RootedSystem

_ORDER = {"displacement": 0, "velocity": 1, "acceleration": 2, "rotation": 0}
_AXES = "xyz"


@dataclass(frozen=True, eq=False)
class Drive:
    """One load of a case.

    Attributes
    ----------
    kind, unit : str
        Word of the case, and SI unit of the amplitude.
    load : Excitation
        Name, right-hand side of a unit (of displacement, for a moved root), amplitude or density.
    size : float
        Force of a unit [N]: area of a patch, length of a line; nan for a moved root.
    motion : int
        Rigid motion of the root that is forced, -1 for a force.
    order : int
        Time derivatives of the displacement that the amplitude is of, for a moved root.
    """

    kind: str
    unit: str
    load: Excitation
    size: float
    motion: int = -1
    order: int = 0


@dataclass(frozen=True, eq=False)
class Powers:
    """Radiated powers of all loads together, and of each: a value, so that it can be stored."""

    excited: "Excited"

    def __call__(self, model: ReducedModel, omega: FloatArray) -> FloatArray:
        """Powers (f, k + 1) at angular frequencies [rad/s], (f, 1) of a single load."""
        each = model.radiated(omega)
        if len(self.excited.drives) == 1:
            return each
        return np.column_stack([each, self.excited.combined(model, omega).radiated])


@dataclass(frozen=True, eq=False)
class Excited:
    """All loads of a case on one configuration.

    Attributes
    ----------
    drives : tuple of Drive
    correlation : {"none", "full"} or None
        Of random loads; None for harmonic ones.
    root : RootedSystem or None
        The blade with a root that can be moved and read, if the case needs it.
    probes : (0 or 6, n) array
        Unit motions of the root, if the dynamic stiffness of the root is wanted.
    band : (float, float)
        Frequencies for which the amplitudes are given [Hz].
    """

    drives: tuple[Drive, ...]
    correlation: Correlation | None
    root: RootedSystem | None
    probes: AnyArray
    band: tuple[float, float]

    @property
    def vectors(self) -> AnyArray:
        """Right-hand sides of the loads (k, n)."""
        return load_vectors(self._loads)

    @property
    def _loads(self) -> list[Excitation]:
        return [drive.load for drive in self.drives]

    @property
    def every(self) -> AnyArray:
        """Right-hand sides of the loads and the probes (k or k + 6, n)."""
        return np.concatenate([self.vectors, self.probes])

    def amplitude(self, frequency: FloatArray) -> ComplexArray:
        """Amplitudes or densities as the case gives them, (f, k); those of the band's ends beyond.

        So a mode outside the band has an amplitude too.
        """
        return harmonic_amplitudes(self._loads, np.clip(frequency, *self.band))

    def parts(self, frequency: FloatArray) -> ComplexArray:
        """Factors of the right-hand sides for each independent part, (j, f, k)."""
        inside = np.clip(frequency, *self.band)
        amplitude = independent_parts(self._loads, inside, self.correlation)
        return amplitude * self.per_amplitude(frequency)

    def per_amplitude(self, frequency: FloatArray) -> ComplexArray:
        """Factors from amplitudes to right-hand sides (f, k): 1, or 1/(i omega) of a velocity."""
        omega = 2j * np.pi * np.asarray(frequency)
        return np.stack([omega ** -float(drive.order) for drive in self.drives], axis=1)

    def combined(self, model: ReducedModel, omega: FloatArray) -> Combined:
        """Put together what a reduced model of `every` says at angular frequencies [rad/s]."""
        count = len(self.drives)
        return Combined(
            model.reduced_operators,
            omega,
            model.coordinates(omega)[:, :count],
            model.reduced_load[:count],
            self.parts(omega / (2.0 * np.pi)),
        )

    @property
    def powers(self) -> "Powers":
        """What a reduced model must have right."""
        return Powers(self)

    def modal_work(
        self,
        operators: Operators,
        vectors: AnyArray,
        frequency: FloatArray,
    ) -> FloatArray:
        """Size of the work of all loads on real modes (m, n) at their frequencies [Hz], (m,).

        A moved root works on a mode by the force with which that mode pulls at the root.
        """
        work = vectors @ self.vectors.T + 0j
        for column, drive in enumerate(self.drives):
            if drive.motion >= 0:
                work[:, column] = _pulls(operators, vectors, frequency, drive.motion)
        factors = self.parts(frequency)
        return np.asarray(np.linalg.norm(np.einsum("jmk,mk->jm", factors, work), axis=0))


def needs_root(case: Case) -> bool:
    """Whether the root has to be moved, or the force on it read."""
    moved = any(isinstance(words, RootMotionWords) for words in case.excitation)
    return moved or (case.transfer is not None and case.transfer.of_root)


def root_centre(mesh: Mesh) -> FloatArray:
    """Centroid of the root face (3,) [m]; rotations and moments refer to it."""
    surface = SurfaceQuadrature(mesh.nodes, mesh.faces["root"])
    area = np.linalg.norm(surface.area_vectors(mesh.nodes), axis=-1).ravel()
    return np.asarray(area @ surface.positions(mesh.nodes).reshape(-1, 3) / area.sum())


def excite(
    case: Case,
    blade: Blade,
    mesh: Mesh,
    positions: FloatArray,
    operators: Operators,
    root: RootedSystem | None,
    motion: ngs.GridFunction | None,
) -> Excited:
    """Make the loads of a case on one configuration.

    Parameters
    ----------
    positions : (nodes, 3) array
        Nodes of the mesh in the configuration [m].
    operators : Operators
        Of the configuration; those of the root, if there is one.
    root : RootedSystem or None
    motion : ngsolve.GridFunction or None
        Displacement from C0 to C1 [m].
    """
    tables = {number: Spectrum(*table) for number, table in spectra(case).items()}
    random, patches = case.acoustics.signal == "random", 0
    drives = []
    for number, (words, name) in enumerate(zip(case.excitation, names(case), strict=True)):
        amplitude = tables.get(number, constant_amplitude(words))
        unit = words.density_unit if random else words.unit
        if isinstance(words, RootMotionWords):
            assert root is not None  # needs_root
            place = _AXES.index(words.axis) + 3 * (words.motion == "rotation")
            vector = root.base_motion(np.eye(6)[place])
            load = Excitation(name, vector, amplitude)
            drives.append(Drive(words.kind, unit, load, np.nan, place, _ORDER[words.motion]))
            continue
        if isinstance(words, PatchWords):
            surface = patch_name(patches)
            patches += 1
            force = pressure_force(mesh.fem, 1.0, surface=surface, motion=motion)
            size = patch_area(mesh, positions, surface)
        else:
            force, size = _push(words, blade, mesh)
        vector = (operators if root is None else root).right_hand_side(force)
        drives.append(Drive(words.kind, unit, Excitation(name, vector, amplitude), size))
    wants_shaft = case.transfer is not None and "shaft" in case.transfer.functions
    probes = np.zeros((0, operators.size))
    if wants_shaft:
        assert root is not None  # needs_root
        probes = root.base_motion(np.eye(6))
    correlation = case.acoustics.correlation if random else None
    return Excited(tuple(drives), correlation, root, probes, case.acoustics.band)


def constant_amplitude(words: ExcitationWords) -> complex:
    """Amplitude or density of a load that has no table."""
    if words.density_value is not None:
        return words.density_value
    value = words.amplitude_value
    constant = 1.0 if value is None else value  # a pressure of 1 Pa; others must say
    return constant * np.exp(1j * words.phase) if words.phase else constant


def _push(words: PushWords | LinePushWords, blade: Blade, mesh: Mesh) -> tuple[FloatArray, float]:
    """Force on the unknowns of a unit amplitude, and its size [N]."""
    surface = SurfaceQuadrature(mesh.nodes, mesh.interface)
    direction = np.array(words.direction) / np.linalg.norm(words.direction)
    if isinstance(words, PushWords):
        places = on_face(blade, words.face, np.array([words.at]))
        return point_force(mesh.basis, surface, places, direction), 1.0
    places = line_on_face(blade, words.face, words.start, words.end)
    length = float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
    return line_force(mesh.basis, surface, places, direction), length


def patch_area(mesh: Mesh, positions: FloatArray, name: str) -> float:
    """Area of a boundary whose nodes are at these positions [m2]."""
    surface = SurfaceQuadrature(mesh.nodes, mesh.faces[name])
    return float(np.linalg.norm(surface.area_vectors(positions), axis=-1).sum())


def _pulls(
    operators: Operators, vectors: AnyArray, frequency: FloatArray, motion: int
) -> ComplexArray:
    """Force of each mode on the root that is held, along one of its rigid motions, (m,)."""
    row = operators.blocks.root[motion]
    wave = np.zeros(operators.size, dtype=bool)
    wave[operators.blocks.water] = True
    pulls = np.zeros(len(vectors), dtype=complex)
    for mode, (vector, f) in enumerate(zip(vectors, frequency, strict=True)):
        omega = 2.0 * np.pi * f
        x = np.where(wave, 1j * omega * vector, vector)  # modes have phi for psi = i omega phi
        for name, factor in operators.factors(omega).items():
            pulls[mode] += factor * (operators.terms[name][[row]] @ x)[0]
    # the row belongs to (q + lambda) / sqrt 2
    return np.asarray(np.sqrt(2.0) * pulls)
