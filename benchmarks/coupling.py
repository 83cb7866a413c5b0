# SPDX-License-Identifier: LGPL-2.1-or-later
"""The coupled static solution against one nonlinear solution under its final pressure."""

import resource
from collections.abc import Iterator, Mapping
from time import perf_counter

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.mesh import build_mesh
from quietblade.study import translate
from quietblade.study.preflight import preflight
from quietblade.study.statics import solve_statics
from quietblade.typing import silent


def rows() -> Iterator[Mapping[str, object]]:
    """Yield the row of the composite blade."""
    case = Case.parse(preset_text("paper-composite")).varied({"mesh.size": "25 mm"})
    blade = preflight(case).blade
    mesh = build_mesh(blade, translate.mesh_spec(case))
    _ = mesh.basis
    start = perf_counter()
    statics = solve_statics(case, blade, mesh, silent)
    coupled = perf_counter() - start
    statics.structure.forget()
    start = perf_counter()
    statics.structure.solve(statics.state.surface.values)
    uncoupled = perf_counter() - start
    yield {
        "id": "flow/coupled-vs-uncoupled",
        "size": f"{3 * len(mesh.basis.nodes_of('blade|film'))} displacement unknowns",
        "ours_s": coupled,
        "other": "one nonlinear solution under the final pressure",
        "other_s": uncoupled,
        "ratio": coupled / uncoupled,
        "peak_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
        "notes": f"composite blade, {len(statics.state.history)} passes of the plain fixed point; "
        "with the set-up of the load transfer and the strains",
    }
