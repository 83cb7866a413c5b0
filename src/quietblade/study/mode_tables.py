# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tables of the modes of all configurations: partners, losses, participation, dry modes."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from quietblade.case import AnyCase
from quietblade.mesh import Mesh
from quietblade.results import mode_records as records
from quietblade.results import model
from quietblade.study.losses import region_of
from quietblade.study.sound import Sound
from quietblade.study.vibration import Vibration, nodal_shapes, symmetric_solver
from quietblade.typing import ComplexArray, FloatArray, Progress
from quietblade.vibroacoustics.flow_damping import stream_loss
from quietblade.vibroacoustics.loss import STREAM
from quietblade.vibroacoustics.loss_shares import RADIATION, loss_shares
from quietblade.vibroacoustics.matching import Match, match, participation, wet_mass
from quietblade.vibroacoustics.modes import dry_modes

_BEYOND = 1.05
"""Dry modes are sought up to this multiple of what the wet shapes would have without water."""


@dataclass(frozen=True, eq=False)
class ModeTables:
    """All tables of the modes of one configuration."""

    modes: model.ModeTable
    count: records.ModeCount
    losses: records.LossShares
    participation: records.Participation
    dry: records.DryModes


def mode_tables(
    case: AnyCase,
    mesh: Mesh,
    vibrations: Mapping[str, Vibration],
    sounds: Mapping[str, Sound],
    progress: Progress,
) -> dict[str, ModeTables]:
    """Make the tables of each configuration; partners are looked for in the mass of C0."""
    tables, matches = {}, {}
    for number, (name, vibration) in enumerate(vibrations.items()):
        progress("modes", number / len(vibrations), f"mass of {name} with the water's")
        product = wet_mass(vibration.operators, solver=symmetric_solver(case))
        if name == "C0" and "C1" in vibrations:
            rest, loaded = vibration.modes.vectors, carried(mesh, vibrations["C1"], vibration)
            matches = {"C0": match(rest, loaded, product), "C1": match(loaded, rest, product)}
        frequency, response = _response(vibration, sounds[name])
        shares = participation(response, vibration.modes.vectors, product)
        losses = _losses(vibration)
        partners = {"C0": "C1", "C1": "C0"}[name]
        tables[name] = ModeTables(
            modes=_mode_table(vibration, losses, matches.get(name), vibrations.get(partners)),
            count=_count(vibration),
            losses=losses,
            participation=records.Participation(frequency, shares),
            dry=_dry_modes(case, mesh, vibration) if case.acoustics.dry_modes else _no_dry_modes(),
        )
    return tables


def carried(mesh: Mesh, modes_of: Vibration, onto: Vibration) -> FloatArray:
    """Modes as displacements of another configuration, whose sections carry them along.

    Returns
    -------
    (m, n) array
        On the unknowns of ``onto``.
    """
    moved = np.zeros((len(modes_of.shapes), len(mesh.nodes), 3))
    moved[:, onto.frames.nodes] = onto.frames.placed(modes_of.shapes)
    u = onto.operators.blocks.u
    vectors = np.zeros((len(moved), onto.operators.size))
    for vector, values in zip(vectors, moved, strict=True):
        vector[u] = mesh.basis.to_dofs(values)[onto.operators.free[u]]
    return vectors


def _mode_table(
    vibration: Vibration,
    losses: records.LossShares,
    found: Match | None,
    other: Vibration | None,
) -> model.ModeTable:
    """Real modes; those in the band with the loss of the damped mode that belongs to them."""
    modes, count = vibration.modes, len(vibration.modes.frequency)
    work = vibration.excited.modal_work(vibration.operators, modes.vectors, modes.frequency)
    partner, likeness = ("",) * count, np.full(count, np.nan)
    if found is not None and other is not None:
        names = other.naming.name
        partner = tuple(names[k] if k >= 0 else "" for k in found.partner)
        likeness = found.assurance
    return model.ModeTable(
        name=vibration.naming.name,
        frequency=modes.frequency,
        loss_factor=np.where(modes.rigid, np.nan, np.nansum(losses.share, axis=1)),
        film_loss=modes.loss_factor,
        radiation_loss=losses.share[:, losses.name.index(RADIATION)],
        purity=vibration.naming.purity,
        partner=partner,
        partner_mac=likeness,
        participation=(work / work.max(initial=np.finfo(float).tiny)) ** 2,
    )


def _count(vibration: Vibration) -> records.ModeCount:
    modes, naming = vibration.modes, vibration.naming
    return records.ModeCount(
        counted=modes.count,
        highest=modes.highest,
        character=tuple(naming.character),
        family_share=naming.shares,
        residual=modes.residual,
    )


def _losses(vibration: Vibration) -> records.LossShares:
    """Shares of the damped modes where they are known, of the real ones elsewhere."""
    operators, modes, damped = vibration.operators, vibration.modes, vibration.damped
    real = {region: modes.losses[region] for region in operators.moduli}
    if len(operators.blocks.strips):
        real[STREAM] = stream_loss(operators, modes)
    known = {**real, RADIATION: np.full(len(modes.frequency), np.nan)}
    good = damped.converged
    share = np.array(list(known.values())).T
    for column, values in enumerate(loss_shares(operators, damped).values()):
        share[damped.start[good], column] = values[good]
    regions = tuple(dict.fromkeys(map(region_of, known)))  # a film may have several static shears
    parts = [[region_of(name) == region for name in known] for region in regions]
    whole = np.array([share[:, own].sum(axis=1) for own in parts]).T
    return records.LossShares(regions, whole)


def _response(vibration: Vibration, sound: Sound) -> tuple[FloatArray, ComplexArray]:
    """Frequencies [Hz] at which the response matters, and the response there (k, n)."""
    if vibration.sweep is None or sound.peaks is None:
        return sound.snapshots, sound.solutions
    frequency = sound.peaks.frequency if len(sound.waves) == 1 else sound.snapshots
    if (
        len(frequency) == 0
    ):  # independent loads have no common response, and heavily damped modes make no peaks
        return frequency, np.zeros((0, vibration.operators.size), dtype=complex)
    reduced = vibration.sweep.model
    together = vibration.excited.combined(reduced, 2.0 * np.pi * frequency)
    return frequency, together.responses[0] @ reduced.columns()


def _dry_modes(case: AnyCase, mesh: Mesh, vibration: Vibration) -> records.DryModes:
    operators, wet, frames = vibration.operators, vibration.modes, vibration.frames
    mass = operators.terms["M"]
    own = np.einsum("ij,ij->i", wet.vectors, (mass @ wet.vectors.T).T)
    # the wet mass of the shapes is one: without the water they would be this much faster
    highest = _BEYOND * float(np.max(np.abs(wet.frequency) / np.sqrt(own)))
    found = dry_modes(
        operators,
        highest,
        moduli_at=0.5 * sum(case.acoustics.band),
        solver=symmetric_solver(case, precision="double"),
    )
    shapes = frames.shapes(nodal_shapes(mesh, operators, found.vectors))
    naming = frames.names(shapes, vibration.masses, found.rigid)
    pairs = match(found.vectors, wet.vectors, mass)
    names = vibration.naming.name
    return records.DryModes(
        name=naming.name,
        frequency=found.frequency,
        loss_factor=found.loss_factor,
        purity=naming.purity,
        partner=tuple(names[k] if k >= 0 else "" for k in pairs.partner),
        partner_mac=pairs.assurance,
    )


def _no_dry_modes() -> records.DryModes:
    nothing = np.zeros(0)
    return records.DryModes((), nothing, nothing, nothing, (), nothing)
