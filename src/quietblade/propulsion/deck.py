# SPDX-License-Identifier: LGPL-2.1-or-later
"""A structure and its loads as an input deck (``.inp``) for CalculiX and Abaqus."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import ngsolve as ngs
import numpy as np

from quietblade.errors import QuietbladeError
from quietblade.materials.axes import Axes, as_coefficient
from quietblade.propulsion.cells import CORNERS, EdgeNodes
from quietblade.propulsion.deck_cells import (
    BaseNodes,
    Elements,
    collect_elements,
    face_elements,
)
from quietblade.propulsion.deck_materials import material_lines
from quietblade.propulsion.forms import StructuralForms
from quietblade.propulsion.loading import Loading
from quietblade.propulsion.structure import Structure, StructureState
from quietblade.typing import BoolArray, FloatArray, IntArray

_ENTRIES = 16  # a line of a deck holds no more
_NOTHING = 1e-14  # forces below this share of the largest are rounding

# Mean of a second-order field over a face from its corners and its mid-edge nodes.
_FACE_MEAN = {3: (0.0, 1.0 / 3.0), 4: (-1.0 / 12.0, 1.0 / 3.0)}


def write_deck(
    path: Path,
    structure: Structure,
    loads: StructureState | Loading,
    *,
    title: str = "quietblade",
    first_increment: float = 1.0,
    solver: str | None = None,
    tolerance: float | None = None,
) -> None:
    """Write the static problem of a structure at finite strain.

    Nodes keep their numbers in the structure's nodal basis, plus one.  Every region is an element
    set and a material of its name, every boundary of the mesh a node set; held nodes are the sets
    ``HELD-...``.  Results are asked for at the nodes: U, RF, S, E.

    Parameters
    ----------
    path : Path
        File to write.
    structure : Structure
        Mesh, materials and supports.
    loads : StructureState or Loading
        Loads to apply from the undeformed state.  Of a state also the displacements at held
        nodes, if they are not zero.
    title : str
        Heading, one line.
    first_increment : float
        First share of the load that the other program tries, 0 to 1.
    solver : str or None
        CalculiX's name of an equation solver, such as ``SPOOLES``; Abaqus refuses the parameter.
    tolerance : float or None
        Largest relative residual and correction (``*CONTROLS``); the programs' own, about 0.5 %
        and 1 %, if None.

    Raises
    ------
    QuietbladeError
        If the structure has an elastic support.
    MaterialError
        If a material has no counterpart.
    MeshError
        If pressure acts on a face that no element has.

    Notes
    -----
    The follower pressure becomes one value a face, the mean of the nodal pressure over it.
    Material axes that vary in space become one orientation an element, that of its middle.
    Pyramids become two tetrahedra each (see `deck_cells`).  A nearly incompressible film has no
    mixed element in CalculiX: its hexahedra are written with reduced integration, C3D20R, against
    locking; in Abaqus use the hybrid C3D20H.
    """
    if structure.support is not None:
        raise QuietbladeError(
            "deck: elastic supports cannot be exported; clamp the root, and add the springs to the "
            "deck by hand"
        )
    held = np.zeros((len(structure.basis.points), 3))
    if isinstance(loads, StructureState):
        held, loads = structure.values(loads), loads.loading
    forms = structure.forms
    elements, bases = collect_elements(forms.fem, structure.basis, [*forms.materials])
    lines = [
        "*HEADING",
        title,
        *_node_lines(structure.basis.points, elements, bases),
        *_element_lines(elements, forms),
        *_equation_lines(len(structure.basis.points), bases),
        *_boundary_set_lines(forms),
        *_material_lines(forms, elements),
        *_support_lines(forms),
        *_step_lines(first_increment, solver, tolerance),
        *_moved_support_lines(forms, held),
        *_pressure_lines(forms, elements, loads.pressure),
        *_force_lines(structure, loads.dead_load),
        *_spin_lines(forms, loads.spin_squared),
        *("*NODE FILE", "U, RF", "*EL FILE", "S, E", "*END STEP"),
    ]
    path.write_text("\n".join(lines) + "\n", encoding="ascii", errors="replace")


def _node_lines(points: FloatArray, elements: list[Elements], bases: BaseNodes) -> Iterator[str]:
    yield "*NODE, NSET=ALL"
    places = np.concatenate([points, bases.points])
    for node in np.unique(np.concatenate([block.nodes.ravel() for block in elements])).tolist():
        x, y, z = places[node]
        yield f"{node + 1}, {x:.12e}, {y:.12e}, {z:.12e}"


def _element_lines(elements: list[Elements], forms: StructuralForms) -> Iterator[str]:
    for block in elements:
        reduced = "R" if block.kind == "C3D20" and block.region in forms.mixed else ""
        yield f"*ELEMENT, TYPE={block.kind}{reduced}, ELSET={_name(block.region)}"
        for row in np.column_stack([block.numbers, block.nodes + 1]).tolist():
            yield from _wrapped(row)


def _equation_lines(first: int, bases: BaseNodes) -> Iterator[str]:
    """Tie the middle of a pyramid's base to its eight nodes."""
    for number, masters in enumerate((bases.masters + 1).tolist(), start=first + 1):
        for axis in (1, 2, 3):
            yield "*EQUATION"
            yield str(1 + len(masters))
            terms = [(number, -1.0), *zip(masters, bases.weights, strict=True)]
            for i in range(0, len(terms), 4):
                yield ", ".join(f"{node}, {axis}, {share:g}" for node, share in terms[i : i + 4])


def _boundary_set_lines(forms: StructuralForms) -> Iterator[str]:
    solid = forms.solid_nodes
    for boundary in sorted(set(forms.fem.GetBoundaries())):
        nodes = np.intersect1d(forms.basis.nodes_of(boundary, 1), solid)
        if len(nodes):
            yield from _set_lines(boundary, nodes)


def _set_lines(name: str, nodes: IntArray) -> Iterator[str]:
    yield f"*NSET, NSET={_name(name)}"
    numbers = (nodes + 1).tolist()
    for i in range(0, len(numbers), _ENTRIES):
        yield ", ".join(map(str, numbers[i : i + _ENTRIES]))


def _material_lines(forms: StructuralForms, elements: list[Elements]) -> Iterator[str]:
    for region, material in forms.materials.items():
        name = _name(region)
        yield from material_lines(name, material)
        axes: Axes | None = getattr(material, "axes", None)
        oriented = ""
        if axes is not None:
            oriented = f", ORIENTATION={name}-AXES"
            yield from _orientation_lines(forms.fem, region, axes, elements)
        yield f"*SOLID SECTION, ELSET={name}, MATERIAL={name}{oriented}"


def _orientation_lines(
    fem: ngs.Mesh, region: str, axes: Axes, elements: list[Elements]
) -> Iterator[str]:
    """Two points a and b: axis 1 towards a, axis 2 in the plane of a and b."""
    name = _name(region)
    if not isinstance(axes, ngs.CoefficientFunction):
        yield f"*ORIENTATION, NAME={name}-AXES, SYSTEM=RECTANGULAR"
        yield _axes_entries(np.asarray(axes))
        return
    middle = {
        kind: ngs.IntegrationRule([tuple(np.mean(corners, axis=0))], [1.0])
        for kind, corners in CORNERS.items()
    }
    places = fem.MapToAllElements(middle, fem.Materials(region))
    values = as_coefficient(axes)(places).reshape(-1, 3, 3)
    # CalculiX skips the table, and the parameters that only Abaqus needs, with a warning
    yield f"*DISTRIBUTION TABLE, NAME={name}-TABLE"
    yield "COORD3D, COORD3D"
    yield f"*DISTRIBUTION, NAME={name}-PLACES, LOCATION=ELEMENT, TABLE={name}-TABLE"
    yield f", {_axes_entries(values[0])}"
    for block in elements:
        if block.region == region:
            for element, rank in zip(block.numbers.tolist(), block.rank.tolist(), strict=True):
                yield f"{element}, {_axes_entries(values[rank])}"
    yield f"*ORIENTATION, NAME={name}-AXES, SYSTEM=RECTANGULAR"
    yield f"{name}-PLACES"


def _axes_entries(axes: FloatArray) -> str:
    return ", ".join(f"{entry:.10f}" for entry in axes[:, :2].T.ravel())


def _support_lines(forms: StructuralForms) -> Iterator[str]:
    held = _held(forms)
    for code in range(1, 8):
        axes = [axis for axis in range(3) if code >> axis & 1]
        nodes = np.flatnonzero(held @ (1, 2, 4) == code)
        if len(nodes):
            name = "HELD-" + "".join("XYZ"[axis] for axis in axes)
            yield from _set_lines(name, nodes)
            yield "*BOUNDARY"
            yield from (f"{name}, {axis + 1}, {axis + 1}" for axis in axes)


def _moved_support_lines(forms: StructuralForms, values: FloatArray) -> Iterator[str]:
    moved = [(n, a) for n, a in np.argwhere(_held(forms)).tolist() if values[n, a] != 0.0]
    if moved:
        yield "*BOUNDARY"
        yield from (f"{n + 1}, {a + 1}, {a + 1}, {values[n, a]:.12e}" for n, a in moved)


def _held(forms: StructuralForms) -> BoolArray:
    """Which displacements of the solid's nodes are held, (nodes, 3)."""
    basis = forms.basis
    free = forms.free[: forms.n_displacement].reshape(3, -1)
    held = np.zeros((len(basis.points), 3), dtype=bool)
    vertices = np.setdiff1d(forms.solid_nodes, basis.edge_nodes)
    held[vertices] = ~free[:, vertices].T
    edges = np.flatnonzero(np.isin(basis.edge_nodes, forms.solid_nodes))
    held[basis.edge_nodes[edges]] = ~free[:, forms.fem.nv + edges].T
    return held


def _step_lines(first: float, solver: str | None, tolerance: float | None) -> Iterator[str]:
    yield "*STEP, NLGEOM, INC=1000"
    yield "*STATIC" if solver is None else f"*STATIC, SOLVER={solver}"
    yield f"{first:g}, 1.0, 1e-6"
    if tolerance is not None:
        yield "*CONTROLS, PARAMETERS=FIELD"
        yield f"{tolerance:g}, {tolerance:g}"


def _pressure_lines(
    forms: StructuralForms, elements: list[Elements], pressure: FloatArray
) -> Iterator[str]:
    edge_nodes = EdgeNodes(forms.basis)
    yield "** follower pressure, mean of each face [Pa]"
    for corners in _loaded_faces(forms):
        ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1)
        at_corner, at_middle = _FACE_MEAN[corners.shape[1]]
        mean = at_corner * pressure[corners].sum(axis=1)
        mean += at_middle * pressure[edge_nodes.middles(ends)].sum(axis=1)
        loaded = mean != 0.0
        if np.any(loaded):
            yield "*DLOAD"
            found = face_elements(elements, corners[loaded])
            for (element, face), value in zip(found, mean[loaded].tolist(), strict=True):
                yield f"{element}, P{face}, {value:.10e}"


def _loaded_faces(forms: StructuralForms) -> Iterator[IntArray]:
    """Corner nodes of the wetted triangles (n, 3), then of the quadrilaterals (n, 4)."""
    faces: dict[int, list[list[int]]] = {3: [], 4: []}
    for element in forms.fem.Boundaries(forms.wetted).Elements():
        faces[len(element.vertices)].append([vertex.nr for vertex in element.vertices])
    yield from (np.array(corners) for corners in faces.values() if corners)


def _force_lines(structure: Structure, dead_load: FloatArray) -> Iterator[str]:
    """Turn forces at the hierarchical unknowns into nodal ones that do the same work."""
    interpolation = structure.basis.interpolation
    forces = (interpolation.T @ dead_load.reshape(3, -1).T)[structure.forms.solid_nodes]
    used = np.argwhere(np.abs(forces) > _NOTHING * np.abs(forces).max(initial=0.0)).tolist()
    if used:
        yield "*CLOAD"
        nodes = structure.forms.solid_nodes
        yield from (f"{nodes[i] + 1}, {a + 1}, {forces[i, a]:.12e}" for i, a in used)


def _spin_lines(forms: StructuralForms, spin_squared: float) -> Iterator[str]:
    if spin_squared:
        yield "*DLOAD"
        for region in forms.materials:
            yield f"{_name(region)}, CENTRIF, {spin_squared:.12e}, 0., 0., 0., 1., 0., 0."


def _wrapped(row: Sequence[int]) -> Iterable[str]:
    """One element; a line that goes on ends with a comma."""
    parts = [row[i : i + _ENTRIES - 1] for i in range(0, len(row), _ENTRIES - 1)]
    texts = [", ".join(map(str, part)) for part in parts]
    return [text + "," for text in texts[:-1]] + [texts[-1]]


def _name(text: str) -> str:
    return text.upper().replace(" ", "-")
