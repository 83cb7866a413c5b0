# SPDX-License-Identifier: LGPL-2.1-or-later
"""From the words of a case to the complex moduli of its regions (theory: S2-50 to S2-54).

Finite elements are imported where they are needed: a look at a case stays light.
"""
# ruff: noqa: PLC0415

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from quietblade.case import AnyCase, Finding
from quietblade.case.laminate import LaminateWords
from quietblade.case.loss import (
    ConstantWords,
    LossWords,
    MaxwellWords,
    ModulusTableWords,
    ShiftWords,
    WlfWords,
    ZenerWords,
)
from quietblade.case.materials import IsotropicWords, MooneyRivlinWords, NeoHookeanWords
from quietblade.case.problems import Path
from quietblade.errors import MaterialError, Notice
from quietblade.results.model import ModulusTable
from quietblade.study.modulus_files import EXAMPLE, MeasuredModulus, read_moduli
from quietblade.typing import ComplexArray, FloatArray

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix

    from quietblade.materials.viscoelastic import ModulusFit, ModulusRatio, Shift
    from quietblade.propulsion.structure import Structure, StructureState
    from quietblade.propulsion.tangent import Tangent
    from quietblade.vibroacoustics.loss import Lossy

POOR_FIT = 0.1
"""Largest relative distance of a fit from a measured point beyond which a notice is given."""

CONTRADICTION = 0.1
"""Relative difference of a fit's modulus at rest from the case's beyond which a notice is given."""

_SAMPLES = 201
_MOST_SHIFT = 1e30

_AT_SHEAR = " at shear "


@dataclass(frozen=True, eq=False)
class Modulus:
    """Complex modulus of a region, or of its share under one static shear.

    Attributes
    ----------
    region : str
        ``blade`` or ``film``.
    model : str
        Its name in the case.
    ratio : ModulusRatio
        g, the complex modulus over the one that the strain energy has.
    static : float
        The latter: a film's shear modulus, an isotropic solid's Young's modulus [Pa]; nan for
        another solid.
    shear : float
        Static shear; nan if the modulus does not depend on it.
    temperature : float
        [K]; nan if the case gives none.
    shift : float
        a_T of that temperature.
    fit : ModulusFit or None
        Of measured moduli, at the reference temperature.
    """

    region: str
    model: str
    ratio: "ModulusRatio"
    static: float = float("nan")
    shear: float = float("nan")
    temperature: float = float("nan")
    shift: float = 1.0
    fit: "ModulusFit | None" = None

    @property
    def name(self) -> str:
        """Region, with the shear if there is one."""
        return self.region if np.isnan(self.shear) else f"{self.region}{_AT_SHEAR}{self.shear:g}"

    def at(self, frequency: FloatArray) -> ComplexArray:
        """Values g at frequencies (f,) [Hz]."""
        from quietblade.materials.viscoelastic import modulus_ratio

        return modulus_ratio(self.ratio, frequency)

    @property
    def measured(self) -> tuple[FloatArray, ComplexArray]:
        """Frequencies at which the material answers as measured [Hz], and moduli over `static`."""
        if self.fit is None:
            return np.zeros(0), np.zeros(0, dtype=complex)
        base = self.fit.static_modulus if np.isnan(self.static) else self.static
        return self.fit.frequency / self.shift, self.fit.measured / base


def region_of(name: str) -> str:
    """Region of a lossy part."""
    return name.partition(_AT_SHEAR)[0]


def moduli(case: AnyCase) -> tuple[Modulus, ...]:
    """Complex moduli of the parts whose loss is more than a number.

    Raises
    ------
    InvalidCaseError
        A model is not admissible, its file cannot be read, or plies have different models.
    """
    _check_plies(case)
    found: list[Modulus] = []
    for part in case.parts:
        path, words = case.loss(part)
        if isinstance(words, LossWords):
            found.extend(_under_shear(case, part, path, words))
    return tuple(found)


def moduli_notices(case: AnyCase, found: tuple[Modulus, ...]) -> Iterator[Notice]:
    """Say what the user should know of fitted moduli."""
    low, high = case.acoustics.band
    for modulus in found:
        if modulus.fit is None:
            continue
        where, frequency = f"{modulus.name}: loss_factor", modulus.measured[0]
        if modulus.fit.error > POOR_FIT:
            yield Notice(
                where,
                "the fit is far from a measured point (relative)",
                modulus.fit.error,
                POOR_FIT,
                "Look at the picture of the moduli; moduli that no passive material has cannot be "
                "fitted",
            )
        sheared = modulus.shear > 0.0
        apart = abs(modulus.fit.static_modulus / modulus.static - 1.0)
        if apart > CONTRADICTION and not sheared:
            yield Notice(
                where,
                f"the fit tends to {modulus.fit.static_modulus:.4g} Pa at rest, the case's modulus "
                f"under the steady load is {modulus.static:.4g} Pa; relative difference",
                float(apart),
                CONTRADICTION,
                "The vibration has the measured moduli; check that the steady load has its own",
            )
        for end, beyond in ((low, low < frequency.min()), (high, high > frequency.max())):
            if beyond:
                yield Notice(
                    where,
                    f"no modulus was measured at {end:g} Hz, an end of the band; the nearest [Hz], "
                    "moved to the case's temperature",
                    float(frequency.min() if end == low else frequency.max()),
                    end,
                    "Beyond the measured frequencies the model is an extrapolation",
                )


def modulus_table(found: tuple[Modulus, ...], band: tuple[float, float]) -> ModulusTable:
    """Put moduli in figures, over the band and wherever they were measured."""
    points = [modulus.measured for modulus in found]
    reach = np.concatenate([[0.1 * band[0], 10.0 * band[1]], *(f for f, _ in points)])
    at = np.geomspace(reach.min(), reach.max(), _SAMPLES)
    ends = np.array(band)
    return ModulusTable(
        name=tuple(modulus.name for modulus in found),
        model=tuple(modulus.model for modulus in found),
        static=np.array([modulus.static for modulus in found]),
        temperature=np.array([modulus.temperature for modulus in found]),
        shift=np.array([modulus.shift for modulus in found]),
        fit_error=np.array([np.nan if m.fit is None else m.fit.error for m in found]),
        band=ends,
        band_ratio=np.array([modulus.at(ends) for modulus in found]).reshape(-1, 2),
        frequency=at,
        ratio=np.array([modulus.at(at) for modulus in found]).reshape(-1, _SAMPLES),
        measured_modulus=np.array([i for i, (f, _) in enumerate(points) for _ in f], dtype=int),
        measured_frequency=np.concatenate([np.zeros(0), *(f for f, _ in points)]),
        measured_ratio=np.concatenate([np.zeros(0, dtype=complex), *(g for _, g in points)]),
    )


def loss_parts(
    case: AnyCase,
    found: tuple[Modulus, ...],
    structure: "Structure",
    state: "StructureState",
    tangent: "Tangent",
) -> "Mapping[str, csr_matrix | Lossy]":
    """Lossy parts of the system about an equilibrium, by name.

    Parameters
    ----------
    case : AnyCase
    found : tuple of Modulus
        As from `moduli`.
    structure, state, tangent
        Of the equilibrium.
    """
    from quietblade.propulsion.film_loss import prestrain_parts
    from quietblade.vibroacoustics.loss import Lossy

    parts: dict[str, csr_matrix | Lossy] = dict(tangent.losses(case.acoustics.loss))
    for region in dict.fromkeys(modulus.region for modulus in found):
        own = [modulus for modulus in found if modulus.region == region]
        parts.pop(region, None)  # a model takes the place of a number
        if len(own) == 1:
            film = region in tangent.film_regions
            whole = tangent.film_isochoric_material if film else tangent.region_material[region]
            parts[region] = Lossy(whole, own[0].ratio)
            continue
        matrices = prestrain_parts(structure, state, [modulus.shear for modulus in own])
        for modulus, matrix in zip(own, matrices, strict=True):
            if abs(matrix).max() > 0.0:  # nowhere is this shear near
                parts[modulus.name] = Lossy(matrix, modulus.ratio)
    return parts


def _check_plies(case: AnyCase) -> None:
    for part in case.parts:
        words = case.material(part)
        if not isinstance(words, LaminateWords) or words.loss_factor is not None:
            continue
        losses = [case.named_material(ply.material).loss_factor for ply in words.plies]
        modelled = any(isinstance(loss, LossWords) for loss in losses)
        if modelled and any(loss != losses[0] for loss in losses):
            finding = Finding(
                (part, "material"),
                "the plies have different models of the loss",
                "Give the laminate a loss_factor of its own",
            )
            raise case.invalid(finding)


def _under_shear(case: AnyCase, part: str, path: Path, words: LossWords) -> list[Modulus]:
    """Moduli of a part: one, or one for each static shear that is given."""
    whole = _moduli(case, part, path, words, f"{part}.loss_factor")
    if not words.prestrain:
        return whole
    if len(whole) > 1:
        raise case.invalid(
            Finding(
                (*path, "prestrain"),
                "is given twice: the file has a column of static shears",
                "Leave out the column, or prestrain",
            )
        )
    from quietblade.materials.viscoelastic import ConstantLoss
    from quietblade.vibroacoustics.loss import Stiffened

    found = [replace(whole[0], shear=0.0)]
    for number, entry in enumerate(words.prestrain):
        place = (*path, "prestrain", number, "loss_factor")
        own = entry.loss_factor
        if own is None:
            (base,) = whole
        elif isinstance(own, LossWords):
            key = f"{part}.loss_factor.prestrain[{number}].loss_factor"
            base, *others = _moduli(case, part, place, own, key)
            if others:
                raise case.invalid(
                    Finding(
                        (*place, "file"),
                        "has a column of static shears, and this modulus is for one of them",
                        "Leave out the column",
                    )
                )
        else:
            base = Modulus(part, "constant", ConstantLoss(own), whole[0].static)
        found.append(replace(base, shear=entry.shear, ratio=Stiffened(base.ratio, entry.factor)))
    return found


def _moduli(case: AnyCase, part: str, path: Path, words: LossWords, key: str) -> list[Modulus]:
    """Moduli of one model, without its prestrain."""
    from quietblade.materials.viscoelastic import (
        ConstantLoss,
        FractionalZener,
        GeneralizedMaxwell,
        Shifted,
    )

    static = _static_modulus(case, part)
    match words:
        case ConstantWords():
            return [Modulus(part, words.model, ConstantLoss(words.value), static)]
        case ZenerWords():
            zener = FractionalZener(words.stiffening, words.relaxation_time, words.exponent)
            bare = [Modulus(part, words.model, zener, static)]
        case MaxwellWords():
            maxwell = GeneralizedMaxwell(words.strengths, words.relaxation_times)
            bare = [Modulus(part, words.model, maxwell, static)]
        case ModulusTableWords():
            bare = _fitted(case, part, path, words, key, static)
        case _:
            raise TypeError(f"no model {words!r}")
    if words.temperature is None or words.shift is None:
        return bare
    factor = _shift_factor(case, path, words.shift, words.temperature)
    return [
        replace(m, ratio=Shifted(m.ratio, factor), temperature=words.temperature, shift=factor)
        for m in bare
    ]


def _shift_factor(case: AnyCase, path: Path, words: ShiftWords, temperature: float) -> float:
    """Factor a_T of a temperature [K]."""
    from quietblade.materials.viscoelastic import ArrheniusShift, WlfShift

    shift: Shift
    if isinstance(words, WlfWords):
        shift = WlfShift(words.c1, words.c2, words.reference)
    else:
        shift = ArrheniusShift(words.energy, words.reference)
    try:
        with np.errstate(over="ignore"):
            factor = shift.factor(temperature)
    except (MaterialError, OverflowError) as error:
        fault = str(error) if isinstance(error, MaterialError) else "shifts beyond all frequencies"
    else:
        if 1.0 / _MOST_SHIFT < factor < _MOST_SHIFT:
            return factor
        fault = f"shifts the frequency by the factor {factor:.3g}"
    finding = Finding((*path, "temperature"), fault, "Check temperature and shift")
    raise case.invalid(finding)


def _fitted(
    case: AnyCase, part: str, path: Path, words: ModulusTableWords, key: str, static: float
) -> list[Modulus]:
    """Fits of a file, one for each static shear in it.

    Where the solid has one modulus, the fit is taken over that, so that vibrations have the
    measured moduli; of another solid it is taken over its own modulus at rest.
    """
    from quietblade.vibroacoustics.loss import Stiffened

    try:
        groups = read_moduli(case.files[f"{key}.file"])
        fits = [(group, _fit(group, static)) for group in groups]
    except (OSError, ValueError, MaterialError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        remedy = f"Write a header such as {EXAMPLE}, and numbers below it"
        finding = Finding((*path, "file"), reason[:1].lower() + reason[1:].rstrip("."), remedy)
        raise case.invalid(finding) from error
    if len(groups) > 1 and part != "film":
        finding = Finding(
            (*path, "file"),
            "depends on static shear, which only the loss of a film does",
            "Leave out the column static shear",
        )
        raise case.invalid(finding)
    base = fits[0][1].static_modulus if np.isnan(static) else static
    return [
        Modulus(
            part,
            words.model,
            Stiffened(fit.model, fit.static_modulus / base),
            static,
            _shear_of(group, groups),
            fit=fit,
        )
        for group, fit in fits
    ]


def _fit(group: MeasuredModulus, static: float) -> "ModulusFit":
    """Fit points; if they leave nothing at rest, with the case's modulus there."""
    from quietblade.materials.viscoelastic import fit_maxwell

    try:
        return fit_maxwell(group.frequency, group.modulus)
    except MaterialError:
        if np.isnan(static):
            raise
        return fit_maxwell(group.frequency, group.modulus, static_modulus=static)


def _shear_of(group: MeasuredModulus, groups: tuple[MeasuredModulus, ...]) -> float:
    return group.shear if len(groups) > 1 else float("nan")


def _static_modulus(case: AnyCase, part: str) -> float:
    words = case.material(part)
    if isinstance(words, MooneyRivlinWords | NeoHookeanWords):
        return words.shear_modulus
    return words.E if isinstance(words, IsotropicWords) else float("nan")
