# SPDX-License-Identifier: LGPL-2.1-or-later
"""The whole study of a body that is no blade: mesh, wet modes, sound."""

from functools import partial

import ngsolve as ngs

from quietblade.case import BodyCase
from quietblade.mesh import Mesh
from quietblade.mesh.nodal import NodalBasis
from quietblade.mesh.shell import build_shell
from quietblade.results.model import Result
from quietblade.results.store import RunFolder
from quietblade.study.body import shell_spec, solve_body
from quietblade.study.body_preflight import BodyPreflight
from quietblade.study.clock import Stages
from quietblade.study.fields import write_mesh_fields, write_vibration_fields
from quietblade.study.gather import gather
from quietblade.study.keeping import Makers
from quietblade.study.mode_tables import mode_tables
from quietblade.study.sound import solve_sound
from quietblade.study.vibration import frequencies


def run_body(
    case: BodyCase, facts: BodyPreflight, key: str, folder: RunFolder, stages: Stages
) -> Result:
    """Run all stages of `quietblade.study.stages.body_stages`, and what is made from them.

    Parameters
    ----------
    case, facts
        As from `body_preflight`.
    key : str
        Hash of the case and of the code.
    folder : RunFolder
    stages : Stages
    """
    mesh = stages.make("mesh", lambda _: build_shell(shell_spec(case)))
    parts: Makers = {
        Mesh: lambda: mesh,
        ngs.Mesh: lambda: mesh.fem,
        NodalBasis: lambda: mesh.basis,
    }
    vibration = stages.make("modes C0", partial(solve_body, case, mesh), parts)
    vibrations, grid = {"C0": vibration}, frequencies(case, [vibration])
    sounds = {"C0": stages.make("sweep C0", partial(solve_sound, case, vibration, grid), parts)}
    tables = stages.make(
        "mode tables", lambda report: mode_tables(case, mesh, vibrations, sounds, report), parts
    )
    if account := stages.account():
        stages.tell(account)
    with stages.stage("files"):
        write_mesh_fields(mesh, folder)
        write_vibration_fields(mesh, vibration, sounds["C0"], folder)
    result = gather(
        case,
        facts,
        mesh,
        None,
        vibrations,
        sounds,
        tables,
        key=key,
        laps=stages.laps,
        others=tuple(stages.notices),
    )
    folder.save(result)
    return result
