# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws the pictures of the stress page: convergence, stress and strain on the deformed blade.

python -m tools.draw_structure [--out DIRECTORY] [--only NAME]

Everything is computed anew (about two minutes on one thread); files in docs/_static.
"""

import argparse
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyvista as pv
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.materials import IsotropicSVK, ply_axes, section_directions
from quietblade.mesh import CellBlock, Mesh, build_mesh
from quietblade.propulsion.samples import take_samples
from quietblade.propulsion.strain import compute_film_shear
from quietblade.propulsion.stress import compute_stress
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.tensors import cauchy_stress
from quietblade.results.vtk import CELL_TYPES
from quietblade.study import translate
from quietblade.study.preflight import preflight
from quietblade.typing import AnyArray, FloatArray
from quietblade.view.render import (
    FROM_UPSTREAM,
    Stage,
    View,
    cropped,
    moved,
    sharp_edges,
)
from quietblade.view.style import BLUE, GREY, SEQUENTIAL, VERMILION, WIDTH, new_figure, styled
from verification.structure_blade import TaperedBlade, mesh_blade
from verification.structure_solid_theory import ThickTube
from verification.structure_statics import solve_tube

OUT = Path(__file__).resolve().parent.parent / "docs" / "_static"
_DPI = 150
_SIZE = (1500, 800)
_OUTLINE = "#30363C"


# -- convergence ----------------------------------------------------------------------------------


def tube_errors(tube: ThickTube, size: float) -> tuple[float, float]:
    """Relative errors in the mean square, of displacement and of hoop less radial stress."""
    solved = solve_tube(tube, height=0.5 * size, size=size)
    samples = take_samples(solved.structure, solved.state, "film")
    radius = np.hypot(samples.points[:, 0], samples.points[:, 1])
    swelling = (tube.inner + tube.displacement(tube.inner)) ** 2 - tube.inner**2
    moved_to = np.sqrt(radius**2 + swelling)
    square = (moved_to / radius) ** 2
    exact = 2.0 * (tube.c10 + tube.c01) * (square - 1.0 / square)
    stress = cauchy_stress(samples.gradient, samples.second_piola)
    radial = samples.points * [1.0, 1.0, 0.0] / radius[:, None]
    hoop = np.stack([-radial[:, 1], radial[:, 0], 0.0 * radius], axis=1)
    found = np.einsum("ni,nij,nj->n", hoop, stress, hoop)
    found -= np.einsum("ni,nij,nj->n", radial, stress, radial)
    place = solved.structure.forms.fem(*samples.points.T)
    u = solved.structure.forms.displacement(solved.state.displacement)(place)
    error = np.linalg.norm(u - radial * (moved_to - radius)[:, None], axis=1)
    return (
        _mean_square(error, samples.volumes) / _mean_square(moved_to - radius, samples.volumes),
        _mean_square(found - exact, samples.volumes) / _mean_square(exact, samples.volumes),
    )


def _mean_square(values: FloatArray, volumes: FloatArray) -> float:
    return float(np.sqrt(np.average(values**2, weights=volumes)))


@styled
def draw_convergence() -> Figure:
    """Errors of the thick tube against the size of the cells."""
    tube = ThickTube(inner=7.0, outer=18.625, c10=80.0, c01=20.0, pressure=150.0)
    sizes = np.array([5.0, 3.5, 2.5, 1.75, 1.25])
    errors = np.array([tube_errors(tube, size) for size in sizes])
    x = sizes / tube.inner
    figure = new_figure(2.9, 0.75 * WIDTH)
    axes = figure.subplots()
    series = (("displacement", BLUE, "o-", 3), ("stress", VERMILION, "s--", 2))
    for (name, color, marker, order), error in zip(series, errors.T, strict=True):
        axes.loglog(x, error, marker, color=color, markersize=4, label=name)
        slope = error[-1] * (x / x[-1]) ** order * 0.6
        axes.loglog(x, slope, ":", color=GREY, linewidth=1.0)
        axes.text(x[1], slope[1] * 0.75, f"order {order}", color=GREY, va="top", ha="left")
    axes.set_xlabel("edge of the tetrahedra / inner radius")
    axes.set_ylabel("relative error (mean square)")
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 3.0, 5.0, 7.0)))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.legend(loc="upper left")
    axes.set_title("Thick rubber tube, its bore doubled by pressure")
    return figure


# -- pictures of solids ---------------------------------------------------------------------------


def grid_of(nodes: FloatArray, blocks: tuple[CellBlock, ...]) -> pv.UnstructuredGrid:
    """VTK grid of second-order cells."""
    return pv.UnstructuredGrid({CELL_TYPES[b.kind]: b.connectivity for b in blocks}, nodes)


def _with_bar(image: AnyArray, title: str, label: str, limits: tuple[float, float]) -> Figure:
    """Picture above a horizontal colour bar."""
    height = WIDTH * image.shape[0] / image.shape[1]
    figure = new_figure(height + 0.95)
    axes = figure.subplots()
    axes.imshow(image, interpolation="antialiased")
    axes.set_axis_off()
    axes.set_title(title)
    colors = ScalarMappable(Normalize(*limits), SEQUENTIAL)
    bar = figure.colorbar(
        colors, ax=axes, orientation="horizontal", fraction=0.06, aspect=45, pad=0.02
    )
    bar.set_label(label)
    return figure


@styled
def draw_von_mises() -> Figure:
    """Von Mises stress of the blade of the comparison with CalculiX, bent by a quarter."""
    mesh = mesh_blade(TaperedBlade(), 0.025)
    structure = mesh.structure(IsotropicSVK("plastic", 1200.0, 2.5e9, 0.35))
    state = structure.solve(mesh.pressure(15e3))
    region = compute_stress(structure, state).regions["blade"]
    grid = grid_of(mesh.nodes, (CellBlock("tetra10", mesh.cells),))
    grid["stress"] = region.spread(region.at_nodes.von_mises, len(mesh.nodes)) / 1e6
    bent = moved(grid, structure.values(state))
    limits = (0.0, float(np.ceil(grid["stress"].max() / 5) * 5))
    stage = Stage(_SIZE)
    stage.add(sharp_edges(grid), color=GREY, line_width=2)
    stage.add(
        bent.extract_surface(nonlinear_subdivision=2, algorithm="dataset_surface"),
        scalars="stress", cmap=SEQUENTIAL, clim=limits,
    )  # fmt: skip
    stage.add_lines(sharp_edges(bent), FROM_UPSTREAM, color=_OUTLINE, line_width=2)
    (image,) = cropped([stage.picture(FROM_UPSTREAM)])
    return _with_bar(
        image,
        "Plastic blade of 1 m under a following pressure of 15 kPa (grey: at rest)",
        "von Mises stress [MPa]",
        limits,
    )


@styled
def draw_film_shear() -> Figure:
    """Shear strain of the film of the composite blade under a pressure on one side."""
    case = Case.parse(preset_text("paper-composite")).varied({"mesh.size": "25 mm"})
    mesh = build_mesh(preflight(case).blade, translate.mesh_spec(case))
    structure = Structure(mesh.fem, translate.build_materials(case), basis=mesh.basis)
    state = structure.solve(_one_sided(mesh, 2000.0))
    axes = ply_axes(0.0, *section_directions(translate.blade_angle_field(case)))
    report = compute_stress(structure, state, axes={"film": axes})
    film = report.regions["film"]
    strain = film.at_nodes.material_strain
    assert strain is not None
    shear = 200.0 * np.hypot(strain[:, 0, 2], strain[:, 1, 2])
    film_grid = grid_of(mesh.nodes, mesh.cells["film"])
    film_grid["shear"] = np.nan_to_num(film.spread(shear, len(mesh.nodes)))
    skin = grid_of(mesh.nodes, (CellBlock("triangle6", mesh.interface),))
    displacement = structure.values(state)
    found = compute_film_shear(structure, state, axes)
    limits = (0.0, float(np.ceil(2.0 * shear.max()) / 2.0))
    view = View((-1.0, 0.9, 0.5), (0.0, 1.0, 0.0))
    stage = Stage(_SIZE)
    stage.add(sharp_edges(skin), color=GREY, line_width=1.5)
    bent = moved(skin, displacement)
    far_side = bent.extract_surface(nonlinear_subdivision=2, algorithm="dataset_surface")
    far_side = far_side.compute_normals(auto_orient_normals=True, split_vertices=False)
    stage.add(far_side, color="#E4E9EE", culling="front")
    stage.add_lines(sharp_edges(bent), view, color=_OUTLINE, line_width=2)
    stage.add(
        moved(film_grid, displacement).extract_surface(
            nonlinear_subdivision=2, algorithm="dataset_surface"
        ),
        scalars="shear", cmap=SEQUENTIAL, clim=limits,
    )  # fmt: skip
    (image,) = cropped([stage.picture(view)])
    return _with_bar(
        image,
        "Film in the composite blade under 2 kPa on each side: "
        f"largest {100 * found.maximum:.1f} %, 99 % of it below {100 * found.percentile():.1f} %",
        "shear strain of the film [%]",
        limits,
    )


def _one_sided(mesh: Mesh, size: float) -> FloatArray:
    """Nodal pressure: positive on the lower half, negative on the upper."""
    wetted = np.unique(mesh.interface)
    pressure = np.zeros(len(mesh.nodes))
    pressure[wetted] = np.where(mesh.nodes[wetted, 1] < 0.0, size, -size)
    return pressure


DRAWINGS: dict[str, Callable[[], Figure]] = {
    "stress-convergence.svg": draw_convergence,
    "stress-von-mises.png": draw_von_mises,
    "stress-film-shear.png": draw_film_shear,
}


def main() -> None:
    """Draw what the command line selects."""
    parser = argparse.ArgumentParser(prog="python -m tools.draw_structure", description=__doc__)
    parser.add_argument("--out", type=Path, default=OUT)
    parser.add_argument("--only", default="", help="names that contain this")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    for name, draw in DRAWINGS.items():
        if options.only in name:
            path = options.out / name
            metadata = {"Date": None} if path.suffix == ".svg" else None
            draw().savefig(path, dpi=_DPI, metadata=metadata)
            print(f"{path.name}: {path.stat().st_size / 1024:.0f} kB")


if __name__ == "__main__":
    main()
