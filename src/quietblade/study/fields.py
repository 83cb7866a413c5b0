# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fields of a run as VTU files."""

import re
from collections.abc import Iterator

import numpy as np

from quietblade.mesh import CellBlock, Mesh
from quietblade.mesh.model import EXCITED
from quietblade.propulsion.stress import RegionStress
from quietblade.results.store import RunFolder
from quietblade.results.vtk import PointField, write_fields
from quietblade.study.sound import Sound
from quietblade.study.statics import Statics
from quietblade.study.vibration import Vibration, nodal_shapes
from quietblade.typing import ComplexArray, FloatArray


def write_static_fields(mesh: Mesh, statics: Statics, folder: RunFolder) -> None:
    """Displacement, pressure, stress and strain of the blade, drawn on C0."""
    displacement = np.where(_solid(mesh)[:, None], statics.state.displacement, np.nan)
    fields = [
        PointField("displacement", displacement),
        PointField("pressure", _wetted(mesh, statics.state.surface.values)),
    ]
    for region in statics.stress.regions.values():
        fields += _stress_fields(region, len(mesh.nodes))
    write_fields(folder.static_fields, mesh.nodes, _with_excited(mesh), fields)


def write_mesh_fields(mesh: Mesh, folder: RunFolder) -> None:
    """Cells of a solid that bears no steady load."""
    write_fields(folder.mesh_fields, mesh.nodes, _with_excited(mesh), [])


def _with_excited(mesh: Mesh) -> dict[str, tuple[CellBlock, ...]]:
    """Cells of the solid, and the triangles of its excited parts."""
    cells = {name: blocks for name, blocks in mesh.cells.items() if name != "water"}
    excited = [faces for name, faces in mesh.faces.items() if re.fullmatch(EXCITED, name)]
    if excited:
        cells["excited"] = (CellBlock("triangle6", np.concatenate(excited)),)
    return cells


def _stress_fields(region: RegionStress, count: int) -> list[PointField]:
    """Stress and strain of a region; on the interface each region has values of its own."""
    at_nodes = region.at_nodes
    fields = [
        PointField("von_mises_stress", region.spread(at_nodes.von_mises, count), region.region),
        PointField(
            "largest_strain",
            region.spread(at_nodes.principal_logarithmic[:, 0], count),
            region.region,
        ),
    ]
    for name, values in region.failure_at_nodes.items():
        label = f"{region.region} {name.replace('_', ' ')}"
        fields.append(PointField("failure_index", region.spread(values, count), label))
    strain = at_nodes.material_strain
    if region.region == "film" and strain is not None:
        shear = 2.0 * np.hypot(strain[:, 0, 2], strain[:, 1, 2])
        fields.append(PointField("film_shear_strain", region.spread(shear, count)))
    return fields


def write_vibration_fields(
    mesh: Mesh, vibration: Vibration, sound: Sound, folder: RunFolder
) -> None:
    """Mode shapes, and response and sound pressure at the peaks, drawn on the configuration."""
    solid = {name: blocks for name, blocks in mesh.cells.items() if name != "water"}
    modes = list(_mode_shapes(mesh, vibration))
    write_fields(folder.mode_fields(vibration.name), vibration.positions, solid, modes)
    response = list(_responses(mesh, vibration, sound))
    write_fields(folder.response_fields(vibration.name), vibration.positions, mesh.cells, response)


def _mode_shapes(mesh: Mesh, vibration: Vibration) -> Iterator[PointField]:
    """Damped modes where they are known, real ones elsewhere."""
    vectors = vibration.modes.vectors.astype(complex)
    good = vibration.damped.converged
    vectors[vibration.damped.start[good]] = vibration.damped.vectors[good]
    shapes = nodal_shapes(mesh, vibration.operators, vectors)
    for name, shape in zip(vibration.naming.name, shapes, strict=True):
        yield PointField("mode_shape", _on_solid(mesh, _scaled(shape)), name)


def _scaled(shape: ComplexArray) -> ComplexArray:
    """Largest displacement 1, and real there."""
    largest = np.unravel_index(np.argmax(np.abs(shape)), shape.shape)
    return np.asarray(shape / shape[largest])


def _responses(mesh: Mesh, vibration: Vibration, sound: Sound) -> Iterator[PointField]:
    """Response at the frequency of the sweep nearest to each damped mode."""
    for frequency, solution in zip(sound.snapshots, sound.solutions, strict=True):
        label = f"{frequency:.2f} Hz"
        omega = 2.0 * np.pi * float(frequency)
        root = vibration.excited.root
        (shape,) = nodal_shapes(mesh, vibration.operators, solution[None], root)
        yield PointField("response", _on_solid(mesh, shape), label)
        yield PointField("sound_pressure", _sound_pressure(mesh, vibration, omega, solution), label)


def _sound_pressure(
    mesh: Mesh, vibration: Vibration, omega: float, solution: ComplexArray
) -> ComplexArray:
    operators, basis = vibration.operators, mesh.basis
    potential = np.zeros(basis.ndof, dtype=complex)
    psi = operators.blocks.psi
    potential[operators.free[psi] - operators.first_potential] = solution[psi]
    pressure = -1j * omega * operators.density * basis.to_values(potential)
    pressure[~_nodes_in(mesh, "water")] = np.nan
    return np.asarray(pressure)


def _nodes_in(mesh: Mesh, *regions: str) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    inside = np.zeros(len(mesh.nodes), dtype=bool)
    for region in regions:
        for block in mesh.cells.get(region, ()):
            inside[block.connectivity] = True
    return inside


def _solid(mesh: Mesh) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    return _nodes_in(mesh, "blade", "film", "body")


def _on_solid(mesh: Mesh, shape: ComplexArray) -> ComplexArray:
    return np.asarray(np.where(_solid(mesh)[:, None], shape, np.nan))


def _wetted(mesh: Mesh, pressure: FloatArray) -> FloatArray:
    wetted = np.zeros(len(mesh.nodes), dtype=bool)
    wetted[mesh.interface] = True
    return np.where(wetted, pressure, np.nan)
