# SPDX-License-Identifier: LGPL-2.1-or-later
"""The coupled static solution against one nonlinear solution under its final pressure.

The paper's blades with elements of 40 mm, every method in the same run. What does not depend on
the method (mesh, compiled forms, search of the load transfer) is made once before.
"""

import resource
from collections.abc import Iterator, Mapping
from time import perf_counter, process_time

import numpy as np

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.mesh import build_mesh
from quietblade.mesh.surface import SurfaceQuadrature
from quietblade.propulsion.coupling import Method, StaticState, solve_static
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.transfer import LoadTransfer
from quietblade.study import solids, translate
from quietblade.study.preflight import preflight

BLADES = ("paper-composite", "paper-aluminium")
SIZE = "40 mm"
METHODS: tuple[tuple[Method, bool], ...] = (
    ("newton", False),
    ("newton", True),
    ("anderson", True),
    ("aitken", True),
    ("fixed-point", True),
)
NEWTON_TOLERANCE = 1e-8


def parts(preset: str, size: str = SIZE) -> tuple[Case, Structure, LoadTransfer]:
    """Build structure and transfer of a preset with elements of a size."""
    case = Case.parse(preset_text(preset)).varied({"mesh.size": size})
    blade = preflight(case).blade
    mesh = build_mesh(blade, translate.mesh_spec(case))
    structure = Structure(
        mesh.fem,
        solids.build_materials(case, blade, mesh.basis),
        spin=translate.spin(case),
        basis=mesh.basis,
    )
    s = np.linspace(0.0, 1.0, case.flow.sections)
    surface = SurfaceQuadrature(mesh.nodes, mesh.interface)
    transfer = LoadTransfer(surface, blade, s, blade.section(s, case.flow.section_nodes))
    return case, structure, transfer


def timed_coupled(
    case: Case, structure: Structure, transfer: LoadTransfer, method: Method, chained: bool
) -> tuple[StaticState, float]:
    """Couple from rest; return the state and the processor time [s]."""
    structure.forget()
    start = process_time()
    state = solve_static(
        structure,
        transfer,
        translate.inflow(case),
        method=method,
        chained=chained,
        newton_tolerance=NEWTON_TOLERANCE,
    )
    return state, process_time() - start


def timed_uncoupled(structure: Structure, state: StaticState) -> tuple[int, float]:
    """Solve from rest under a state's pressure; return factorisations and processor time [s]."""
    structure.forget()
    start = process_time()
    solution = structure.solve(state.surface.values, tolerance=NEWTON_TOLERANCE)
    seconds = process_time() - start
    return sum(line.new_tangent for line in solution.newton), seconds


def rows() -> Iterator[Mapping[str, object]]:
    """Yield a row for each blade and method."""
    for preset in BLADES:
        case, structure, transfer = parts(preset)
        warm = transfer.projected_pressure(np.ones(transfer.sections.shape[:2]))
        structure.solve(1e-3 * warm)  # compiles the forms and analyses the pattern
        for method, chained in METHODS:
            start = perf_counter()
            state, coupled = timed_coupled(case, structure, transfer, method, chained)
            wall = perf_counter() - start
            tangents, uncoupled = timed_uncoupled(structure, state)
            yield {
                "id": f"flow/coupled-{method}{'' if chained else '-alone'}-{preset[6:]}",
                "size": f"{structure.forms.ndof} unknowns, elements of {SIZE}",
                "ours_s": coupled,
                "other": "one nonlinear solution under the final pressure",
                "other_s": uncoupled,
                "ratio": coupled / uncoupled,
                "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
                "notes": f"{len(state.history)} passes, {state.factorizations} factorisations "
                f"(against {tangents}), {state.flows:.1f} flows, estimated error "
                f"{state.error:.1e}, processor time ({wall:.1f} s of wall time)"
                + ("" if chained else "; without the chained computation"),
            }
