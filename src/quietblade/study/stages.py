# SPDX-License-Identifier: LGPL-2.1-or-later
"""The stages of a run, and on which keys of the case each of them depends.

A stage is computed again if a key that it reads has changed, if a stage before it is computed
again, or if the code is another one.  What a stage does not declare here it must not read: a
forgotten key would keep a stage that is out of date.  ``tests/study/test_stages.py`` changes every
key of the case and watches what each stage reads.
"""

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from quietblade.case import AnyCase, Case
from quietblade.study import translate

PACKAGES = ("ngsolve", "gmsh", "rslab", "numpy", "scipy", "xarray", "h5netcdf")
"""Packages that the numbers depend on."""

_SHOWN = 3
"""Changed keys that a reason names."""


@dataclass(frozen=True)
class Stage:
    """What the result of a stage depends on.

    Attributes
    ----------
    reads : tuple of str
        Keys of `Case.physics`, tables with all their keys, or patterns of them.
    ignores : tuple of str
        Those among them that do not matter.
    after : tuple of str
        Stages whose results it takes.
    """

    reads: tuple[str, ...]
    ignores: tuple[str, ...] = ()
    after: tuple[str, ...] = ()

    def depends_on(self, key: str) -> bool:
        """Whether the stage reads a key itself."""
        return _named(key, self.reads) and not _named(key, self.ignores)


_VIBRATION = (
    "materials", "files.*.loss_factor.*", "root", "water.density",
    "water.sound_speed", "flow.rotation",
    "acoustics.band", "acoustics.step", "acoustics.sweep", "acoustics.accuracy",
    "acoustics.radiation", "acoustics.radiation_accuracy", "acoustics.tangent", "acoustics.loss",
    "acoustics.flow_damping", "acoustics.signal", "acoustics.correlation", "excitation",
    "files.excitation", "transfer", "solver",
)  # fmt: skip

_SWEEP = (
    "acoustics.band", "acoustics.step", "acoustics.points_per_mode",
    "acoustics.configurations", "acoustics.signal", "acoustics.correlation",
    "excitation", "files.excitation", "transfer", "far_field", "solver",
)  # fmt: skip

_TABLES = ("acoustics.dry_modes", "solver")

ALWAYS = (
    "bands",
    "limits",
    "files.limits",
    "film.minimum_cover",
    "flow.depth",
    "flow.atmospheric_pressure",
    "water.vapour_pressure",
)
"""Keys that no stage reads: what depends on them is checked or made anew in every run."""


def stages(
    configurations: Sequence[str], *, stream: bool = True, campbell: bool = True
) -> dict[str, Stage]:
    """Return the stages of a run in their order, by name.

    Parameters
    ----------
    configurations : sequence of str
        ``C0``, ``C1`` or both, as in ``acoustics.configurations``.
    stream : bool
        Whether the stream damps the blade, ``acoustics.flow_damping``.
    campbell : bool
        Whether there is a Campbell diagram.
    """
    table = {
        "mesh": Stage(
            (
                "blade", "film", "files.blade.section", "mesh", "acoustics.sphere_radius",
                "acoustics.sphere_centre",
                # the patches of pressures, each of which is marked on the surface
                "excitation[[]*].side", "excitation[[]*].span", "excitation[[]*].chord",
            ),
            ignores=("film.minimum_cover",),
        ),
        "flow and structure": Stage(
            (
                "materials", "root", "loads", "files.loads", "water.density",
                "water.kinematic_viscosity", "flow", "static",
            ),
            ignores=("materials.*.loss_factor", "flow.depth", "flow.atmospheric_pressure"),
            after=("mesh",),
        ),
    }  # fmt: skip
    if "C1" in configurations:
        table["mesh motion"] = Stage(("acoustics.gap",), after=("mesh", "flow and structure"))
    # the blade at rest does not know of the flow, unless it is damped by it
    rest = ("flow and structure",) if stream else ("mesh",)
    before = {"C0": rest, "C1": ("flow and structure", "mesh motion")}
    modes = tuple(f"modes {name}" for name in configurations)
    for name, stage in zip(configurations, modes, strict=True):
        table[stage] = Stage(_VIBRATION, after=before[name])
    for name in configurations:
        # the frequencies of both sweeps are refined around the modes of both configurations
        table[f"sweep {name}"] = Stage(_SWEEP, after=modes)
    sweeps = tuple(f"sweep {name}" for name in configurations)
    table["mode tables"] = Stage(_TABLES, after=(*modes, *sweeps))
    if campbell:
        table["Campbell diagram"] = Stage(
            (
                "campbell", "materials", "files.*.loss_factor.*", "root", "loads", "files.loads",
                "water", "flow", "static",
                "acoustics", "excitation", "files.excitation", "transfer", "solver",
            ),
            ignores=("water.vapour_pressure", "flow.depth", "flow.atmospheric_pressure"),
            after=("mesh",),
        )  # fmt: skip
    return table


def body_stages() -> dict[str, Stage]:
    """Return the stages of a run of a body that is no blade, which is at rest (C0)."""
    return {
        "mesh": Stage(
            (
                "body", "mesh", "acoustics.sphere_radius", "acoustics.sphere_centre",
                "excitation[[]*].axis", "excitation[[]*].half_angle",
            )
        ),
        "modes C0": Stage(_VIBRATION, after=("mesh",)),
        "sweep C0": Stage(_SWEEP, after=("modes C0",)),
        "mode tables": Stage(_TABLES, after=("modes C0", "sweep C0")),
    }  # fmt: skip


@dataclass(frozen=True)
class Origin:
    """Everything that the result of a stage depends on, with the values.

    Attributes
    ----------
    inputs : mapping of str to value
        Keys of the case that the stage reads.
    after : mapping of str to str
        Keys (`key`) of the stages before it.
    code : mapping of str to str
        Fingerprint of quietblade's source, and versions of the packages that the numbers depend
        on.
    """

    inputs: Mapping[str, Any]
    after: Mapping[str, str]
    code: Mapping[str, str]

    @property
    def key(self) -> str:
        """Hash of all that."""
        text = json.dumps([self.inputs, self.after, self.code], sort_keys=True)
        return hashlib.sha256(text.encode()).hexdigest()

    def changes_from(self, old: "Origin") -> str:
        """Say in words what is not as in an older origin; empty if nothing is."""
        keys = _different(old.inputs, self.inputs)
        if keys:
            more = " and more" if len(keys) > _SHOWN else ""
            return f"{', '.join(keys[:_SHOWN])}{more} changed"
        code = _different(old.code, self.code)
        if code:
            return f"another version of {', '.join(code)}"
        before = _different(old.after, self.after)
        return f"follows from {', '.join(before)}" if before else ""


def origins(case: AnyCase) -> dict[str, Origin]:
    """Return the origin of each stage of a case, by name and in their order."""
    known = dict(inputs(case))
    found: dict[str, Origin] = {}
    for name, stage in _wanted(case).items():
        found[name] = Origin(
            {key: value for key, value in known.items() if stage.depends_on(key)},
            {other: found[other].key for other in stage.after},
            code_version(),
        )
    return found


def _wanted(case: AnyCase) -> dict[str, Stage]:
    if not isinstance(case, Case):
        return body_stages()
    return stages(
        case.acoustics.configurations,
        stream=case.acoustics.flow_damping,
        campbell=case.campbell is not None,
    )


def inputs(case: AnyCase) -> Iterator[tuple[str, Any]]:
    """Return the dotted keys of `Case.physics` with their values, all of them.

    What the case leaves to quietblade enters with the value that it gets, so that a change of the
    band, for instance, touches the mesh only if the mesh needs other cells.
    """
    plain = case.physics()
    plain["mesh"]["water_size"] = translate.water_size(case)
    plain["acoustics"]["sphere_centre"] = translate.sphere(case)[0].tolist()
    return _leaves(plain, "")


@cache
def code_version() -> Mapping[str, str]:
    """Fingerprint of quietblade's source, and the versions of what it computes with."""
    root = Path(translate.__file__).parents[1]
    digest = hashlib.sha256()
    for file in sorted(root.rglob("*")):
        # pictures, texts and commands do not change a number
        inside = file.relative_to(root)
        if file.suffix in {".py", ".toml"} and inside.parts[0] not in {"cli", "view"}:
            digest.update(inside.as_posix().encode() + b"\0" + file.read_bytes() + b"\0")
    return {"quietblade": digest.hexdigest(), **{name: version(name) for name in PACKAGES}}


def _leaves(value: Any, path: str) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _leaves(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list) and any(isinstance(inner, dict) for inner in value):
        for number, inner in enumerate(value):
            yield from _leaves(inner, f"{path}[{number}]")
    else:
        yield path, value


def _named(key: str, names: Sequence[str]) -> bool:
    return any(fnmatchcase(key, name) or key.startswith((f"{name}.", f"{name}[")) for name in names)


def _different(old: Mapping[str, Any], new: Mapping[str, Any]) -> list[str]:
    absent = object()
    return [key for key in {**old, **new} if old.get(key, absent) != new.get(key, absent)]
