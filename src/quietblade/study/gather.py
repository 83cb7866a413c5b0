# SPDX-License-Identifier: LGPL-2.1-or-later
"""From what the stages have found to the result, with every notice on the way."""

from collections.abc import Mapping
from itertools import chain
from types import MappingProxyType

from quietblade.case import AnyCase, Case
from quietblade.case.presets import BLADES, preset_text
from quietblade.errors import Notice
from quietblade.mesh import Mesh
from quietblade.results import mode_records as records
from quietblade.results.model import Result, StaticResult
from quietblade.study import losses, outcome
from quietblade.study.keeping import Lap
from quietblade.study.mode_tables import ModeTables
from quietblade.study.preflight import Surroundings
from quietblade.study.sound import Sound
from quietblade.study.statics import Statics
from quietblade.study.vibration import Vibration
from quietblade.study.viscous import singing

_UNTIMED: Mapping[str, Lap] = MappingProxyType({})


def gather(
    case: AnyCase,
    facts: Surroundings,
    mesh: Mesh,
    statics: Statics | None,
    vibrations: Mapping[str, Vibration],
    sounds: Mapping[str, Sound],
    tables: Mapping[str, ModeTables],
    *,
    key: str,
    laps: Mapping[str, Lap] = _UNTIMED,
    moved: tuple[Notice, ...] = (),
    diagram: records.CampbellDiagram | None = None,
    others: tuple[Notice, ...] = (),
) -> Result:
    """Make the result of a case.

    Parameters
    ----------
    case, facts, mesh, statics, vibrations, sounds, tables
        What the stages have made, by configuration; without statics for a body that is no blade.
    key : str
        Hash of the case and of the code.
    laps : mapping
        What the stages have cost; none if they were not timed.
    moved, others : tuple of Notice
        Of the motion of the mesh, and of everything else.
    diagram : CampbellDiagram, optional
    """
    notices = (
        *facts.notices,
        *mesh.notices,
        *_steady_notices(case, statics, vibrations),
        *moved,
        *chain.from_iterable((*vibrations[n].notices, *sounds[n].notices) for n in vibrations),
        *others,
    )
    reports = {
        **({} if statics is None else {"flow and structure": statics.solver}),
        **{f"modes {name}": vibration.solver for name, vibration in vibrations.items()},
        **{f"sweep {name}": sound.report for name, sound in sounds.items()},
    }
    return Result(
        title=case.title,
        blade=paper_blade(case) if isinstance(case, Case) else "",
        static=_static(case, statics),
        configurations={
            name: outcome.configuration_result(case, vibration, sounds[name], tables[name])
            for name, vibration in vibrations.items()
        },
        moduli=losses.modulus_table(facts.moduli, case.acoustics.band),
        mesh=outcome.mesh_result(mesh, next(iter(vibrations.values()))),
        run=outcome.run_record(
            case.text,
            key,
            laps,
            [sound.report for sound in sounds.values()],
            reports,
            notices,
        ),
        campbell=records.CampbellDiagram.none() if diagram is None else diagram,
    )


def _static(case: AnyCase, statics: Statics | None) -> StaticResult | None:
    if statics is None:
        return None
    assert isinstance(case, Case)  # nothing else bears a steady load
    return outcome.static_result(case, statics)


def _steady_notices(
    case: AnyCase, statics: Statics | None, vibrations: Mapping[str, Vibration]
) -> tuple[Notice, ...]:
    if statics is None:
        return ()
    assert isinstance(case, Case)
    return (*statics.notices(case), *_singing(statics, vibrations))


def paper_blade(case: Case) -> str:
    """Which of the paper's blades a case stands for: shape, material and flow are those.

    What the paper leaves open (film, excitation, mesh, sphere) may be anything.
    """
    for name in BLADES:
        family, _, blade = name.partition("-")
        if family == "paper" and _stated(case) == _stated(Case.parse(preset_text(name))):
            return blade
    return ""


def _stated(case: Case) -> tuple[object, ...]:
    """Tell apart what the paper says of its blades."""
    plain = case.plain()
    shape = {k: plain["blade"][k] for k in ("hub_radius", "span", "chord", "thickness", "camber")}
    flow = plain["flow"]["speed"], plain["flow"]["rotation"]
    return shape, flow, case.material("blade")


def _singing(statics: Statics, vibrations: Mapping[str, Vibration]) -> tuple[Notice, ...]:
    """Shedding of the trailing edge against the wet modes under load, or at rest without them."""
    if not vibrations:
        return ()
    vibration = vibrations.get("C1", next(iter(vibrations.values())))
    names = vibration.naming.name
    return tuple(singing(statics.viscous[-1], vibration.modes.frequency, names))
