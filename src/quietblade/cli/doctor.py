# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade doctor``: what is installed, which solver serves, how fast, what is missing.

Packages are imported where they are tried: help must stay fast, and one that is broken is told.
"""
# ruff: noqa: PLC0415

import os
import platform
import shutil
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from importlib import import_module, metadata
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated

import typer

from quietblade import __version__
from quietblade.cli.common import ExitCode, console, show_json

if TYPE_CHECKING:
    from packaging.requirements import Requirement

CELLS = 16
"""Cells along an edge of the cube whose Helmholtz equation is the trial of each solver: SuperLU
takes seconds for it already."""

_MANY = 5
"""Checks of one kind that are told in one line."""

SCARCE_MEMORY = 4.0
"""Memory [GB] below which the presets do not fit."""

_THREADS = "OMP_NUM_THREADS"

EXTRAS = {
    "mkl": "a second solver, where the first does not reach its residual",
    "mp4": "films, plot --animate --format mp4",
    "pdf": "pages of a report, report --pdf",
    "uff": "universal files, export --uff",
}
"""What each extra of the package is for."""

PROGRAMS = {
    "ccx": ("CalculiX, which solves the decks of export", "apt install calculix-ccx"),
    "xfoil": ("XFOIL, which some checks compare with", "apt install xfoil"),
}
"""Programs that quietblade never calls, but its users and its verification may."""


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
        "extras": [*_extras()],
        "other programs": [*_programs()],
        "linear solvers": [*_solvers()],
        "pictures": [_picture()],
        "speed": [_speed()],
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

    set_by = f", set by OMP_NUM_THREADS={asked}" if (asked := os.environ.get(_THREADS)) else ""
    yield Check("threads", f"{default_threads()} of {os.cpu_count()} processors{set_by}", "good")
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
        # wheels own private modules too, and files elsewhere, whose "module" is ".."
        public = module.isidentifier() and not module.startswith("_")
        if public and normal in map(canonicalize_name, owners):
            return module
    return distribution


def _packages() -> Iterator[Check]:
    """Check what the installed quietblade says that it needs."""
    for requirement in _requirements(""):
        yield _package(requirement, "bad")


def _extras() -> Iterator[Check]:
    """Check what each of its extras brings."""
    needed = set(map(str, _requirements("")))
    for extra in sorted(metadata.metadata("quietblade").get_all("Provides-Extra") or []):
        for requirement in _requirements(extra):
            if str(requirement) not in needed:
                check = _package(requirement, "optional")
                brings = "" if check.name == extra else f"{check.name} "
                told = f"{brings}{check.found}: {EXTRAS.get(extra, extra)}"
                yield replace(check, name=extra, found=told)


def _requirements(extra: str) -> "Iterator[Requirement]":
    """Yield what is to be installed with an extra; with none what is always needed."""
    from packaging.requirements import Requirement

    for requirement in map(Requirement, metadata.requires("quietblade") or []):
        if requirement.marker is None or requirement.marker.evaluate({"extra": extra}):
            yield requirement


def _package(requirement: "Requirement", missing: str) -> Check:
    """Look at one package; the state that it has when it is missing is given."""
    name = requirement.name
    remedy = f"pip install '{name}{requirement.specifier}'"
    try:
        found = metadata.version(name)
        import_module(_module(name))
    except metadata.PackageNotFoundError:
        return Check(name, "not installed", missing, remedy)
    except (ImportError, OSError) as error:  # such as a shared library that the wheel expects
        return Check(name, f"does not load: {error}", missing, "python3 tools/check_system.py")
    fits = requirement.specifier.contains(found, prereleases=True)
    return Check(name, found, "good") if fits else Check(name, found, missing, remedy)


def _programs() -> Iterator[Check]:
    """Look for programs beside quietblade."""
    for name, (use, remedy) in PROGRAMS.items():
        found = shutil.which(name)
        if found:
            yield Check(name, f"{found}: {use}", "good")
        else:
            yield Check(name, f"not found: {use}", "optional", f"on Debian and Ubuntu {remedy}")


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


def _speed() -> Check:
    """Say how long a preset would take here, from a small factorisation."""
    from quietblade.case import Case
    from quietblade.case.presets import PRESETS, preset_text
    from quietblade.cli.describe_outlook import spell
    from quietblade.study.costs import TIME_FACTOR
    from quietblade.study.outlook import look_ahead
    from quietblade.study.preflight import preflight

    name = next(iter(PRESETS))
    case = Case.parse(preset_text(name), name)
    cost = look_ahead(case, preflight(case)).cost
    return Check(
        name,
        f"a run of this preset takes about {spell(cost.total)} and {cost.memory / 1e9:.2g} GB, "
        f"within a factor {TIME_FACTOR:g}",
        "good",
    )


def _show(title: str, checks: list[Check]) -> None:
    from rich.table import Table
    from rich.text import Text

    style = {"good": "green", "optional": "yellow", "bad": "bold red"}
    word = {"good": "ok", "optional": "optional", "bad": "MISSING"}
    table = Table(
        title=title, title_justify="left", title_style="bold", show_header=False, box=None
    )
    for check in _short(checks):
        said = check.found + (f" ({check.remedy})" if check.remedy else "")
        table.add_row(Text(check.name), Text(word[check.state], style[check.state]), Text(said))
    console.print(table)


def _short(checks: list[Check]) -> list[Check]:
    """Put what is good and has nothing to tell but a version into one line."""
    plain = [check for check in checks if check.state == "good" and check.found[:1].isdigit()]
    if len(plain) < _MANY:
        return checks
    told = ", ".join(f"{check.name} {check.found}" for check in plain)
    return [Check(f"{len(plain)} packages", told, "good"), *(c for c in checks if c not in plain)]
