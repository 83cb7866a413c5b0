# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of a result that people ask for when they doubt: mesh, convergence, solvers, packages."""

import numpy as np

from quietblade.results.model import Result
from quietblade.results.table import Table, number
from quietblade.typing import FloatArray


def evidence_tables(result: Result) -> tuple[Table, ...]:
    """Mesh, convergence of each loop, solvers and packages; those that have rows."""
    tables = (
        _cells(result),
        _unknowns(result),
        *(() if result.static is None else (_passes(result), _newton(result))),
        _sweeps(result),
        _solvers(result),
        _packages(result),
    )
    return tuple(table for table in tables if table.rows)


def _cells(result: Result) -> Table:
    cells, quality = result.mesh.cells, result.mesh.quality
    rows = []
    for i, region in enumerate(quality.region):
        census = [
            f"{count} {kind}"
            for name, kind, count in zip(cells.region, cells.kind, cells.count, strict=True)
            if name == region
        ]
        figures = (quality.worst[i], quality.mean[i], quality.least_jacobian[i])
        rows.append((region, ", ".join(census), *(_figure(x, ".3f") for x in figures)))
    note = f"{result.mesh.nodes} nodes; quality: inverse condition number, 1 for a regular cell"
    heads = ("Region", "cells", "worst quality", "mean quality", "least Jacobian over mean")
    return Table("Cells and their quality", heads, tuple(rows), note)


def _unknowns(result: Result) -> Table:
    table = result.mesh.unknowns
    rows = [(part, str(count)) for part, count in zip(table.part, table.count, strict=True)]
    if rows:
        rows.append(("all", str(int(table.count.sum()))))
    return Table("Free unknowns of step 2", (), tuple(rows))


def _passes(result: Result) -> Table:
    static, history = result.steady, result.steady.history
    rows = tuple(
        (
            str(i + 1),
            _figure(history.relative_change[i], ".1e"),
            _figure(history.error[i], ".1e"),
            _figure(1e3 * history.tip_displacement[i, 1], ".3f"),
            _figure(history.lift[i], ".2f"),
            str(int(history.factorizations[i])),
        )
        for i in range(static.iterations)
    )
    heads = ("Pass", "change", "estimated error", "tip u_y [mm]", "lift [N]", "factorisations")
    note = (
        f"flow and structure, method {static.coupling_method}; change and error relative to the "
        f"displacement, asked for {static.tolerance:.0e}; "
        f"{'converged' if static.converged else 'NOT CONVERGED'}"
    )
    return Table("Passes between flow and structure", heads, rows, note)


def _newton(result: Result) -> Table:
    """One row a pass: Newton steps, and the residual where they ended."""
    newton = result.steady.newton
    rows = []
    for number_of_pass in np.unique(newton.coupling_iteration):
        steps = np.flatnonzero(newton.coupling_iteration == number_of_pass)
        last = steps[-1]
        rows.append(
            (
                str(int(number_of_pass)),
                str(len(steps)),
                str(int(newton.new_tangent[steps].sum())),
                _figure(newton.residual[last], ".1e"),
                _figure(newton.increment[last], ".1e"),
                _figure(newton.force[last], ".1e"),
            )
        )
    heads = ("Pass", "Newton steps", "new tangents", "residual", "correction", "force [N]")
    note = "in the structure; the last three before the last step of the pass"
    return Table("Newton's method in the structure", heads, tuple(rows), note)


def _sweeps(result: Result) -> Table:
    rows = []
    for name, member in result.configurations.items():
        wrong = _largest(np.abs(member.far_field.condition_error))
        rows.append(
            (
                name,
                member.sweep.method,
                f"{len(member.spectrum.frequency)}",
                str(member.sweep.factorizations),
                _figure(member.sweep.largest_estimate, ".1e"),
                _figure(_largest(member.spectrum.balance_residual), ".1e"),
                f"{member.radiation_condition}, {_figure(wrong, '.1g')}",
            )
        )
    heads = ("", "sweep", "frequencies", "factorisations", "estimated error [dB]",
             "energy balance", "condition on the sphere, error [dB]")  # fmt: skip
    return Table("Sweeps over frequency", heads, tuple(rows))


def _solvers(result: Result) -> Table:
    table = result.run.solvers
    rows = tuple(
        (
            table.use[i],
            table.solver[i],
            str(int(table.factorizations[i])),
            _figure(table.worst_residual[i], ".1e"),
            _figure(1e-9 * table.peak_memory[i], ".2f"),
        )
        for i in range(len(table.use))
    )
    heads = ("Used for", "solver", "factorisations", "worst residual", "memory [GB]")
    return Table("Linear solvers", heads, rows)


def _packages(result: Result) -> Table:
    packages = result.run.packages
    return Table("Packages", (), tuple(zip(packages.name, packages.version, strict=True)))


def _figure(value: float, form: str) -> str:
    return number(float(value) if np.isfinite(value) else None, form)


def _largest(values: FloatArray) -> float:
    known = values[np.isfinite(values)]
    return float(known.max()) if known.size else float("nan")
