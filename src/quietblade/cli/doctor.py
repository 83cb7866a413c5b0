# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade doctor``: what is installed, which solver serves, how fast, what is missing.

Packages are imported where they are tried: help must stay fast, and one that is broken is told.
"""
# ruff: noqa: PLC0415

import os
import platform
import shutil
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from importlib import import_module, metadata
from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer

from quietblade import __version__
from quietblade.cli.common import ExitCode, console, show_json

CELLS = 16
"""Cells along an edge of the cube whose Helmholtz equation is the trial of each solver: SuperLU
takes seconds for it already."""

SCARCE_MEMORY = 4.0
"""Memory [GB] below which the presets do not fit."""


@dataclass(frozen=True)
class Check:
    """One thing that was looked at.

    Attributes
    ----------
    name : str
    found : str
        Version, figure or fault.
    state : str
        ``good``, ``optional`` (missing, and not needed) or ``bad``.
    remedy : str
        What to do unless it is good.
    """

    name: str
    found: str
    state: str
    remedy: str = ""


def doctor(
    as_json: Annotated[bool, typer.Option("--json", help="Write JSON instead of tables.")] = False,
) -> ExitCode:
    """Say what is installed, which solver is used and how fast it is, and what is missing.

    The exit code is 3 if something is missing without which no case can be computed.
    """
    groups = {
        "machine": [*_machine()],
        "packages": [*_packages()],
        "linear solvers": [*_solvers()],
        "pictures": [_picture()],
    }
    sick = any(check.state == "bad" for checks in groups.values() for check in checks)
    if as_json:
        show_json({name: [asdict(check) for check in checks] for name, checks in groups.items()})
    else:
        for name, checks in groups.items():
            _show(name, checks)
        console.print("something is missing" if sick else "ready to compute")
    return ExitCode.FAILED if sick else ExitCode.DONE


def _machine() -> Iterator[Check]:
    yield Check("quietblade", f"{__version__}, Python {platform.python_version()}", "good")
    from quietblade.linalg import default_threads

    yield Check("threads", f"{default_threads()} of {os.cpu_count()} processors", "good")
    try:
        total = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9
    except (AttributeError, ValueError, OSError):  # not on every system
        yield Check("memory", "unknown", "optional", "this system does not tell it")
    else:
        scarce = total < SCARCE_MEMORY
        remedy = f"the presets need {SCARCE_MEMORY:g} GB; use coarser meshes" if scarce else ""
        yield Check("memory", f"{total:.1f} GB", "optional" if scarce else "good", remedy)
    yield Check("disk here", f"{shutil.disk_usage(Path()).free / 1e9:.1f} GB free", "good")


def _module(distribution: str) -> str:
    """Name under which a distribution is imported, as PIL is that of pillow."""
    from packaging.utils import canonicalize_name

    normal = canonicalize_name(distribution)
    for module, owners in metadata.packages_distributions().items():
        if normal in map(canonicalize_name, owners) and not module.startswith("_"):
            return module
    return distribution


def _packages() -> Iterator[Check]:
    """Check what the installed quietblade says that it needs."""
    from packaging.requirements import Requirement

    for requirement in map(Requirement, metadata.requires("quietblade") or []):
        # what an extra brings is optional
        optional = requirement.marker is not None and not requirement.marker.evaluate({"extra": ""})
        name, wanted = requirement.name, f"{requirement.name}{requirement.specifier}"
        try:
            found = metadata.version(name)
            if not optional:
                import_module(_module(name))
        except metadata.PackageNotFoundError:
            state = "optional" if optional else "bad"
            yield Check(name, "not installed", state, f"pip install '{wanted}'")
        except (ImportError, OSError) as error:  # such as a shared library that the wheel expects
            yield Check(name, f"does not load: {error}", "bad", "python3 tools/check_system.py")
        else:
            if requirement.specifier.contains(found, prereleases=True):
                yield Check(name, found, "good")
            else:
                yield Check(name, found, "bad", f"pip install '{wanted}'")


def _solvers() -> Iterator[Check]:
    """Factor and solve one system, complex symmetric like those of a sweep, by each program."""
    import numpy as np

    from quietblade.errors import SolverError
    from quietblade.linalg import make_solver
    from quietblade.linalg.chain import SolverName
    from quietblade.linalg.trial import trial_system

    system = trial_system(CELLS)
    load = np.ones(CELLS**3)
    names: tuple[SolverName, ...] = ("rslab", "mkl-pardiso", "superlu")
    for name in names:
        try:
            solver = make_solver(name, precision="double")
            start = perf_counter()
            solution = solver.analyse(system).factor(system).solve(load)
            seconds = perf_counter() - start
        except SolverError as error:
            state = "optional" if name == "mkl-pardiso" else "bad"
            yield Check(name, "not available", state, str(error).rpartition("; ")[2])
            continue
        residual = np.linalg.norm(system @ solution - load) / np.linalg.norm(load)
        memory = solver.report().largest_factor / 1e6
        yield Check(
            name,
            f"{CELLS**3} unknowns in {seconds:.2f} s, factor {memory:.0f} MB, "
            f"residual {residual:.0e}",
            "good",
        )
    yield Check("auto", " then ".join(map(str, make_solver("auto").levels)), "good")


def _picture() -> Check:
    """Draw a sphere off screen."""
    try:
        import pyvista as pv

        from quietblade.view.render import FROM_ABOVE, Stage

        stage = Stage((64, 64))
        stage.add(pv.Sphere())
        image = stage.picture(FROM_ABOVE)
    except (ImportError, RuntimeError, OSError) as error:
        return Check("off screen", str(error), "bad", "python3 tools/check_system.py")
    if image.std() == 0.0:
        return Check("off screen", "an empty picture", "bad", "python3 tools/check_system.py")
    return Check("off screen", "VTK draws", "good")


def _show(title: str, checks: list[Check]) -> None:
    from rich.table import Table
    from rich.text import Text

    style = {"good": "green", "optional": "yellow", "bad": "bold red"}
    word = {"good": "ok", "optional": "optional", "bad": "MISSING"}
    table = Table(
        title=title, title_justify="left", title_style="bold", show_header=False, box=None
    )
    for check in checks:
        said = check.found + (f" ({check.remedy})" if check.remedy else "")
        table.add_row(Text(check.name), Text(word[check.state], style[check.state]), Text(said))
    console.print(table)
