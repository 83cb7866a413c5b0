# SPDX-License-Identifier: LGPL-2.1-or-later
"""The exported deck, read back: geometry, laws, supports and loads are those of the structure."""

from pathlib import Path

import ngsolve as ngs
import numpy as np
import pytest
from netgen.meshing import FaceDescriptor
from netgen.meshing import Mesh as NetgenMesh

from quietblade.errors import MaterialError, MeshError, QuietbladeError
from quietblade.materials import IsotropicSVK, Material, find_material, ply_axes
from quietblade.materials.anisotropic import AnisotropicSVK
from quietblade.materials.neo_hookean import NeoHookean
from quietblade.propulsion.deck import write_deck
from quietblade.propulsion.deck_cells import FACES, collect_elements, face_elements
from quietblade.propulsion.deck_materials import law_lines, material_lines
from quietblade.propulsion.loading import Loading
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.supports import ElasticBed
from tests.propulsion.solid_models import bent_plate, plate
from verification.calculix import CalculixError, read_frd
from verification.structure_blade import TaperedBlade, mesh_blade
from verification.structure_models import box_mesh, traction_load, uniform_pressure
from verification.structure_stress import GLASS

PLASTIC = IsotropicSVK("plastic", 1200.0, 2.5e9, 0.35)


def blocks(path: Path) -> list[tuple[str, list[list[str]]]]:
    """Keyword lines of a deck, each with the fields of its data lines."""
    found: list[tuple[str, list[list[str]]]] = []
    for line in path.read_text(encoding="ascii").splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            found.append((line, []))
        else:
            found[-1][1].append([part.strip() for part in line.split(",")])
    return found


def data(path: Path, keyword: str) -> list[list[str]]:
    return [row for name, rows in blocks(path) if name.startswith(keyword) for row in rows]


def points_of(path: Path) -> dict[int, np.ndarray]:
    return {int(row[0]): np.array(row[1:], dtype=float) for row in data(path, "*NODE,")}


@pytest.fixture(scope="module")
def deck(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("deck") / "plate.inp"
    write_deck(path, plate(), bent_plate(), title="a plate", solver="SPOOLES", tolerance=1e-6)
    return path


def test_lines_fit_and_the_sections_are_in_order(deck) -> None:
    lines = deck.read_text(encoding="ascii").splitlines()
    assert max(map(len, lines)) <= 132
    assert all(line.count(",") < 17 for line in lines)
    names = [name.split(",")[0] for name, _ in blocks(deck)]
    assert names[0] == "*HEADING"
    assert lines[1] == "a plate"
    assert names[-1] == "*END STEP"
    assert names.index("*BOUNDARY") < names.index("*STEP") < names.index("*DLOAD")
    assert "*STATIC, SOLVER=SPOOLES" in lines
    assert lines[lines.index("*CONTROLS, PARAMETERS=FIELD") + 1] == "1e-06, 1e-06"


def test_elements_have_positive_volumes_and_their_nodes_between_the_corners() -> None:
    tetrahedra = mesh_blade(TaperedBlade(), 0.15).structure(PLASTIC)
    for structure in (plate(), tetrahedra):
        regions = [*structure.forms.materials]
        elements, bases = collect_elements(structure.forms.fem, structure.basis, regions)
        assert len(bases.points) == 0
        for block in elements:
            x = structure.basis.points[block.nodes]
            ends = {"C3D10": (1, 2, 3), "C3D20": (1, 3, 4)}[block.kind]
            assert np.all(np.linalg.det(x[:, ends] - x[:, :1]) > 0.0)
            middle = 0.5 * (x[:, 0] + x[:, 1])
            assert x[:, {"C3D10": 4, "C3D20": 8}[block.kind]] == pytest.approx(middle, abs=1e-9)


def test_faces_are_numbered_with_their_corners_in_a_plane() -> None:
    cube = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], dtype=float)
    cube = np.concatenate([cube, cube + np.array([0.0, 0.0, 1.0])])
    for corners in FACES["C3D20"]:
        assert np.min(np.ptp(cube[list(corners)], axis=0)) == 0.0
    assert len({tuple(sorted(face)) for face in FACES["C3D15"]}) == 5


def test_pressure_of_the_deck_makes_the_structures_force(deck) -> None:
    points = points_of(deck)
    elements = {
        int(row[0]): [int(n) for n in row[1:9]]
        for name, rows in blocks(deck)
        if name.startswith("*ELEMENT")
        for row in rows[::2]
    }
    force = np.zeros(3)
    for row in data(deck, "*DLOAD"):
        if row[1].startswith("P"):
            face = FACES["C3D20"][int(row[1][1:]) - 1]
            x = np.array([points[elements[int(row[0])][corner]] for corner in face])
            # Abaqus numbers some faces inward: what counts is the side of the cell
            normal = 0.5 * np.cross(x[2] - x[0], x[3] - x[1])
            outside = x.mean(axis=0) - np.mean([points[n] for n in elements[int(row[0])]], axis=0)
            force -= float(row[2]) * normal * np.sign(normal @ outside)
    structure, state = plate(), bent_plate()
    undeformed = structure.rest()
    still = type(state)(
        undeformed.displacement,
        undeformed.film_pressure,
        Loading(state.loading.pressure, state.loading.dead_load, 0.0),
    )
    external = structure.external_force(still)[: structure.forms.n_displacement].reshape(3, -1)
    ones = structure.basis.to_dofs(np.ones(len(structure.basis.points)))
    assert force == pytest.approx(external @ ones, rel=1e-3, abs=0.05)


def test_spin_and_supports_are_those_of_the_structure(deck) -> None:
    spin = [row for row in data(deck, "*DLOAD") if row[1] == "CENTRIF"]
    assert {row[0] for row in spin} == {"BLADE", "FILM"}
    assert float(spin[0][2]) == pytest.approx(400.0)
    held = [int(n) for row in data(deck, "*NSET, NSET=HELD-XYZ") for n in row]
    assert np.array_equal(np.array(held) - 1, plate().basis.nodes_of("root", 1))
    assert data(deck, "*BOUNDARY") == [["HELD-XYZ", axis, axis] for axis in "123"]


def test_dead_load_becomes_nodal_forces_with_the_same_resultant(tmp_path) -> None:
    structure = mesh_blade(TaperedBlade(), 0.15).structure(PLASTIC)
    load = traction_load(structure, np.array([1.0, 2.0, 3.0]), "lower")
    path = tmp_path / "dead.inp"
    write_deck(path, structure, Loading(np.zeros(len(structure.basis.points)), load, 0.0))
    rows = np.array(data(path, "*CLOAD"), dtype=float)
    total = [rows[rows[:, 1] == axis, 2].sum() for axis in (1, 2, 3)]
    ones = structure.basis.to_dofs(np.ones(len(structure.basis.points)))
    assert total == pytest.approx(load.reshape(3, -1) @ ones)
    assert data(path, "*DLOAD") == []


def test_guided_and_moved_supports(tmp_path) -> None:
    planes = np.array([0.0, 1.0])
    structure = Structure(
        box_mesh(planes, planes, planes), {"blade": PLASTIC}, clamped=None, wetted="tip",
        guided={"x": "left", "z": "root"},
    )  # fmt: skip
    rest = structure.rest()
    shift = structure.basis.to_dofs(np.tile([0.0, 0.0, 0.25], (len(structure.basis.points), 1)))
    state = type(rest)(shift, rest.film_pressure, rest.loading)
    path = tmp_path / "guided.inp"
    write_deck(path, structure, state)
    sets = {name.split("=")[1] for name, _ in blocks(path) if name.startswith("*NSET, NSET=HELD")}
    assert sets == {"HELD-X", "HELD-Z", "HELD-XZ"}
    moved = [row for row in data(path, "*BOUNDARY") if len(row) == 4]
    assert {row[1] for row in moved} == {"3"}
    assert {float(row[3]) for row in moved} == {0.25}


def test_axes_that_turn_get_one_orientation_an_element(tmp_path) -> None:
    turning = ply_axes(0.3, ngs.CF((0, 0, 1)), ngs.CF((1, 0, 0)), ngs.CF((0, 1, 0)))
    structure = mesh_blade(TaperedBlade(), 0.15).structure(GLASS.oriented(turning))
    path = tmp_path / "axes.inp"
    write_deck(path, structure, structure.rest())
    rows = [row for row in data(path, "*DISTRIBUTION, ") if row[0]]
    assert len(rows) == sum(1 for _ in structure.forms.fem.Elements())
    first = np.array(rows[0][1:], dtype=float)
    c, s = np.cos(0.3), np.sin(0.3)
    assert first == pytest.approx([s, 0.0, c, c, 0.0, -s], abs=1e-9)


def pyramid_on_a_cube() -> ngs.Mesh:
    netgen = NetgenMesh(dim=3)
    cube = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    netgen.AddPoints(np.array([*cube, (0.4, 0.6, 1.7)], dtype=float))
    hexahedron, pyramid = np.array([range(8)]), np.array([[4, 5, 6, 7, 8]])
    for index, (name, cells) in enumerate((("blade", hexahedron), ("cap", pyramid)), start=1):
        netgen.AddElements(dim=3, index=index, data=cells.astype(np.int32), base=0)
        netgen.SetMaterial(index, name)
    faces = {"root": np.array([[0, 3, 2, 1]]), "side": np.array([[4, 5, 8]])}
    for index, (name, nodes) in enumerate(faces.items(), start=1):
        netgen.Add(FaceDescriptor(surfnr=index, domin=1, domout=0, bc=index))
        netgen.SetBCName(index - 1, name)
        netgen.AddElements(dim=2, index=index, data=nodes.astype(np.int32), base=0)
    return ngs.Mesh(netgen)


def test_pyramids_become_tetrahedra_tied_to_the_square_below(tmp_path) -> None:
    structure = Structure(pyramid_on_a_cube(), {"blade": PLASTIC, "cap": PLASTIC}, wetted="side")
    pressure = uniform_pressure(structure.basis, "side", 10.0)
    path = tmp_path / "pyramid.inp"
    loading = Loading(pressure, np.zeros(structure.forms.n_displacement), 0.0)
    write_deck(path, structure, loading)
    points = points_of(path)
    caps = [
        [points[int(n)] for n in row[1:]]
        for name, rows in blocks(path)
        if name == "*ELEMENT, TYPE=C3D10, ELSET=CAP"
        for row in rows
    ]
    volumes = [np.linalg.det(np.array(x[1:4]) - x[0]) / 6 for x in caps]
    assert min(volumes) > 0.0
    assert sum(volumes) == pytest.approx(0.7 / 3)
    for x in caps:
        for place, (a, b) in enumerate(((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)), start=4):
            assert x[place] == pytest.approx(0.5 * (x[a] + x[b]))
    equations = [rows for name, rows in blocks(path) if name.startswith("*EQUATION")]
    assert len(equations) == 3
    terms = np.array([float(part) for row in equations[0][1:] for part in row]).reshape(-1, 3)
    assert terms[0, 2] == -1.0
    masters = np.array([points[int(node)] for node in terms[1:, 0]])
    assert terms[1:, 2].sum() == pytest.approx(1.0)
    assert terms[1:, 2] @ masters == pytest.approx(points[int(terms[0, 0])])
    (load,) = data(path, "*DLOAD")
    assert float(load[2]) == pytest.approx(10.0)


def test_laws_with_their_constants() -> None:
    rubber = find_material("viscoelastic-paper")
    header, constants = law_lines(rubber)
    assert header == "*HYPERELASTIC, MOONEY-RIVLIN"
    assert [float(c) for c in constants.split(",")] == pytest.approx([0.238e6, 0.523e6, 2 / 2.2e9])
    header, constants = law_lines(NeoHookean("gum", 1000.0, 1e6, 1e9))
    assert header == "*HYPERELASTIC, NEO HOOKE"
    assert [float(c) for c in constants.split(",")] == pytest.approx([5e5, 2e-9])
    header, first, second = law_lines(GLASS)
    assert header.endswith("TYPE=ENGINEERING CONSTANTS")
    assert [float(c) for c in (*first.split(","), second)] == pytest.approx(
        [54e9, 18e9, 18e9, 0.25, 0.25, 0.4, 9e9, 9e9, 6e9]
    )
    C = GLASS.stiffness
    entries = ",".join(list(law_lines(AnisotropicSVK("a", 2000.0, C)))[1:]).split(",")
    assert len(entries) == 21
    assert float(entries[1]) == pytest.approx(C[0, 1])
    assert [float(entries[k]) for k in (9, 14, 20)] == pytest.approx([9e9, 9e9, 6e9])


class Clay:
    name, density = "clay", 1.0


def test_what_cannot_be_exported_says_so() -> None:
    with pytest.raises(MaterialError, match="Clay has no counterpart"):
        next(iter(law_lines(Clay())))
    layered = AnisotropicSVK("layers", 2000.0, ngs.CF(tuple(np.eye(6).ravel()), dims=(6, 6)))
    with pytest.raises(MaterialError, match="'layers' changes from place to place"):
        list(law_lines(layered))
    heavy: Material = AnisotropicSVK("heavy", ngs.x + 1.0, GLASS.stiffness)
    with pytest.raises(MaterialError, match="density of material 'heavy' changes"):
        list(material_lines("X", heavy))


def test_an_elastic_support_is_refused(tmp_path) -> None:
    mesh = mesh_blade(TaperedBlade(), 0.15)
    structure = Structure(
        mesh.fem(), {"blade": PLASTIC}, clamped=None, wetted="lower", support=ElasticBed(1e12)
    )
    with pytest.raises(QuietbladeError, match="elastic supports cannot be exported"):
        write_deck(tmp_path / "bed.inp", structure, structure.rest())


def test_a_loaded_base_of_a_pyramid_is_refused() -> None:
    structure = Structure(
        pyramid_on_a_cube(), {"cap": PLASTIC, "blade": PLASTIC}, wetted="root", clamped="side"
    )
    elements, _ = collect_elements(structure.forms.fem, structure.basis, ["cap"])
    with pytest.raises(MeshError, match="face of no element"):
        list(face_elements(elements, np.array([[4, 5, 6, 7]])))


def test_a_result_file_without_results_is_refused(tmp_path) -> None:
    path = tmp_path / "empty.frd"
    path.write_text("    1C\n 9999\n")
    with pytest.raises(CalculixError, match="no results"):
        read_frd(path)
