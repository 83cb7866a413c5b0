# SPDX-License-Identifier: LGPL-2.1-or-later
"""Materials as a case file says them, with the conditions that make a solid possible."""

from collections.abc import Iterator, Mapping
from math import sqrt
from typing import Annotated, Any, Literal, TypeAlias

import numpy as np
from pydantic import Field, model_validator

from quietblade.case import units
from quietblade.case.fields import (
    Angle,
    Density,
    Modulus,
    ModulusOrZero,
    Number,
    Quantity,
    Text,
    Words,
    entries,
    wrong,
)
from quietblade.case.laminate import LaminateWords
from quietblade.case.loss import FILM_LOSS, STRUCTURAL_LOSS, FilmLossValue, LossValue
from quietblade.case.problems import suggestion
from quietblade.case.source import Finding

Ratio = Number
Strength = Modulus

StiffnessRow = Annotated[tuple[Annotated[float, Quantity(units.MODULUS)], ...], entries(6)]
"""Six entries of a stiffness, of either sign."""

_SOURCE = "Where the constants come from, for people"

_REVERSED = "nu_ij is strain j from stress i; some tables print nu_ji = nu_ij E_j / E_i"


class IsotropicWords(Words):
    """Isotropic Saint-Venant-Kirchhoff solid."""

    law: Literal["isotropic"] = Field(title="Law", description="Isotropic Saint-Venant-Kirchhoff")
    density: Density = Field(title="Density", description="Mass per undeformed volume")
    E: Modulus = Field(title="Young's modulus", description="Young's modulus E")
    nu: Ratio = Field(title="Poisson's ratio", description="Poisson's ratio nu, between -1 and 1/2")
    loss_factor: LossValue = Field(0.0, title="Loss factor", description=STRUCTURAL_LOSS)
    yield_strength: Strength | None = Field(
        None, title="Yield strength", description="Yield or 0.2 % proof stress of a metal"
    )
    source: Text = Field("", title="Source", description=_SOURCE)

    @model_validator(mode="after")
    def _check_definite(self) -> "IsotropicWords":
        if not -1.0 < self.nu < 0.5:
            raise wrong(
                "the stiffness is not positive definite: -1 < nu < 1/2 fails",
                "A nearly incompressible solid needs the law neo-hookean or mooney-rivlin",
                at=("nu",),
            )
        return self


class OrthotropicWords(Words):
    """Orthotropic Saint-Venant-Kirchhoff solid.

    Of each pair of Poisson's ratios (nu12 or nu21, nu23 or nu32, nu13 or nu31) one is given.
    """

    law: Literal["orthotropic"] = Field(
        title="Law", description="Orthotropic Saint-Venant-Kirchhoff"
    )
    density: Density = Field(title="Density", description="Mass per undeformed volume")
    E1: Modulus = Field(title="E1", description="Young's modulus along axis 1, the fibres")
    E2: Modulus = Field(title="E2", description="Young's modulus along axis 2, across in the ply")
    E3: Modulus = Field(title="E3", description="Young's modulus along axis 3, the thickness")
    G12: Modulus = Field(title="G12", description="Shear modulus in the ply")
    G23: Modulus = Field(title="G23", description="Shear modulus between axes 2 and 3")
    G13: Modulus = Field(title="G13", description="Shear modulus between axes 1 and 3")
    nu12: Ratio | None = Field(None, title="nu12", description="Strain 2 from stress 1")
    nu21: Ratio | None = Field(None, title="nu21", description="Strain 1 from stress 2")
    nu23: Ratio | None = Field(None, title="nu23", description="Strain 3 from stress 2")
    nu32: Ratio | None = Field(None, title="nu32", description="Strain 2 from stress 3")
    nu13: Ratio | None = Field(None, title="nu13", description="Strain 3 from stress 1")
    nu31: Ratio | None = Field(None, title="nu31", description="Strain 1 from stress 3")
    ply_angle: Angle = Field(
        0.0,
        title="Ply angle",
        description="Angle from the span to axis 1, turning about the thickness axis towards the "
        "trailing edge; in a laminate the ply's own angle counts instead",
    )
    Xt: Strength | None = Field(None, title="Xt", description="Tensile strength along axis 1")
    Xc: Strength | None = Field(None, title="Xc", description="Compressive strength along axis 1")
    Yt: Strength | None = Field(None, title="Yt", description="Tensile strength along axis 2")
    Yc: Strength | None = Field(None, title="Yc", description="Compressive strength along axis 2")
    S12: Strength | None = Field(None, title="S12", description="Shear strength in the ply")
    loss_factor: LossValue = Field(0.0, title="Loss factor", description=STRUCTURAL_LOSS)
    source: Text = Field("", title="Source", description=_SOURCE)

    @property
    def strengths(self) -> tuple[float, float, float, float, float] | None:
        """Xt, Xc, Yt, Yc, S12 [Pa] if they are given."""
        if (
            self.Xt is None or self.Xc is None or self.Yt is None or self.Yc is None
            or self.S12 is None
        ):  # fmt: skip
            return None
        return self.Xt, self.Xc, self.Yt, self.Yc, self.S12

    def ratio(self, i: int, j: int) -> float:
        """Poisson's ratio nu_ij for i < j, from whichever of nu_ij and nu_ji is given."""
        direct: float | None = getattr(self, f"nu{i}{j}")
        if direct is not None:
            return direct
        inverse: float = getattr(self, f"nu{j}{i}")
        moduli: tuple[float, ...] = (self.E1, self.E2, self.E3)
        return inverse * moduli[i - 1] / moduli[j - 1]

    @model_validator(mode="after")
    def _check_strengths(self) -> "OrthotropicWords":
        given = [key for key in ("Xt", "Xc", "Yt", "Yc", "S12") if getattr(self, key) is not None]
        if given and len(given) < 5:
            raise wrong(
                f"only {', '.join(given)} of the five strengths are given",
                "Give Xt, Xc, Yt, Yc and S12, or none",
                at=(given[0],),
            )
        return self

    @model_validator(mode="after")
    def _check_definite(self) -> "OrthotropicWords":
        for i, j in ((1, 2), (2, 3), (1, 3)):
            self._one_spelling(f"nu{i}{j}", f"nu{j}{i}")
        moduli = {1: self.E1, 2: self.E2, 3: self.E3}
        determinant = 1.0
        for i, j in ((1, 2), (2, 3), (1, 3)):
            scaled = self.ratio(i, j) * sqrt(moduli[j] / moduli[i])
            determinant -= scaled * scaled
            if not abs(scaled) < 1.0:
                direct = getattr(self, f"nu{i}{j}") is not None
                a, b = (i, j) if direct else (j, i)
                raise wrong(
                    "the stiffness is not positive definite: "
                    f"|nu{a}{b}| < sqrt(E{a} / E{b}) = {sqrt(moduli[a] / moduli[b]):.4g} fails",
                    _REVERSED,
                    at=(f"nu{a}{b}",),
                )
        # of the compliance of the normal stresses, scaled to a unit diagonal
        nu12, nu23, nu13 = self.ratio(1, 2), self.ratio(2, 3), self.ratio(1, 3)
        determinant -= 2.0 * nu12 * nu23 * nu13 * self.E3 / self.E1
        if not determinant > 0.0:
            raise wrong(
                "the stiffness is not positive definite: 1 - nu12 nu21 - nu23 nu32 - nu13 nu31 "
                f"- 2 nu12 nu23 nu31 > 0 fails, it is {determinant:.4g} for "
                f"nu12 = {nu12:.4g}, nu23 = {nu23:.4g}, nu13 = {nu13:.4g}",
                f"The three Poisson's ratios together are too large. {_REVERSED}",
            )
        return self

    def _one_spelling(self, direct: str, inverse: str) -> None:
        given = [key for key in (direct, inverse) if getattr(self, key) is not None]
        if len(given) == 2:
            raise wrong(
                f"both {direct} and {inverse} are given",
                f"Give one of them. {_REVERSED}",
                at=(inverse,),
            )
        if not given:
            raise wrong(f"{direct} is missing", f"Add {direct} (or {inverse}). {_REVERSED}")


class AnisotropicWords(Words):
    """General anisotropic Saint-Venant-Kirchhoff solid.

    Rows and columns of the stiffness: 11, 22, 33, 23, 13, 12, for engineering shear strains.
    """

    law: Literal["anisotropic"] = Field(
        title="Law", description="Anisotropic Saint-Venant-Kirchhoff"
    )
    density: Density = Field(title="Density", description="Mass per undeformed volume")
    stiffness: Annotated[tuple[StiffnessRow, ...], entries(6)] = Field(
        title="Stiffness", description="Six rows of six moduli, symmetric"
    )
    ply_angle: Angle = Field(
        0.0,
        title="Ply angle",
        description="Angle from the span to axis 1, turning about the thickness axis towards the "
        "trailing edge",
    )
    loss_factor: LossValue = Field(0.0, title="Loss factor", description=STRUCTURAL_LOSS)
    source: Text = Field("", title="Source", description=_SOURCE)

    @model_validator(mode="after")
    def _check_definite(self) -> "AnisotropicWords":
        C = np.array(self.stiffness)
        if np.abs(C - C.T).max() > 1e-9 * np.abs(C).max():
            i, j = np.unravel_index(int(np.argmax(np.abs(C - C.T))), C.shape)
            raise wrong(
                f"is not symmetric: row {i + 1}, column {j + 1} and its mirror image differ",
                "Rows and columns are 11, 22, 33, 23, 13, 12",
                at=("stiffness",),
            )
        diagonal = np.diag(C)
        scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
        least = float(np.linalg.eigvalsh(scale[:, None] * C * scale)[0])
        if not (least > 0.0 and np.all(diagonal > 0.0)):
            raise wrong(
                "is not positive definite: the least eigenvalue, scaled to a unit diagonal, is "
                f"{least:.4g}",
                "Some strain would release energy; check signs, and the order 11, 22, 33, 23, 13, "
                "12",
                at=("stiffness",),
            )
        return self


class NeoHookeanWords(Words):
    """Nearly incompressible neo-Hookean solid."""

    law: Literal["neo-hookean"] = Field(
        title="Law", description="Nearly incompressible neo-Hookean"
    )
    density: Density = Field(title="Density", description="Mass per undeformed volume")
    shear_modulus: Modulus = Field(title="Shear modulus", description="Shear modulus G")
    bulk_modulus: Modulus = Field(title="Bulk modulus", description="Bulk modulus K")
    loss_factor: FilmLossValue = Field(title="Loss factor", description=FILM_LOSS)
    source: Text = Field("", title="Source", description=_SOURCE)

    @model_validator(mode="after")
    def _check_stable(self) -> "NeoHookeanWords":
        _check_bulk(self.bulk_modulus, self.shear_modulus, "shear_modulus")
        return self


class MooneyRivlinWords(Words):
    """Nearly incompressible Mooney-Rivlin solid."""

    law: Literal["mooney-rivlin"] = Field(
        title="Law", description="Nearly incompressible Mooney-Rivlin"
    )
    density: Density = Field(title="Density", description="Mass per undeformed volume")
    c10: ModulusOrZero = Field(title="C10", description="Coefficient of the first invariant")
    c01: ModulusOrZero = Field(title="C01", description="Coefficient of the second invariant")
    bulk_modulus: Modulus = Field(title="Bulk modulus", description="Bulk modulus K")
    loss_factor: FilmLossValue = Field(title="Loss factor", description=FILM_LOSS)
    source: Text = Field("", title="Source", description=_SOURCE)

    @property
    def shear_modulus(self) -> float:
        """Shear modulus of small strains, 2 (c10 + c01) [Pa]."""
        return 2.0 * (self.c10 + self.c01)

    @model_validator(mode="after")
    def _check_stable(self) -> "MooneyRivlinWords":
        if self.shear_modulus <= 0.0:
            raise wrong("the shear modulus 2 (c10 + c01) is zero", "Give c10 or c01 a value")
        _check_bulk(self.bulk_modulus, self.shear_modulus, "2 (c10 + c01)")
        return self


def _check_bulk(bulk_modulus: float, shear_modulus: float, shear_name: str) -> None:
    if bulk_modulus <= 2.0 / 3.0 * shear_modulus:
        raise wrong(
            "Poisson's ratio would be negative: bulk_modulus > 2/3 of the shear modulus "
            f"{shear_name} = {shear_modulus:.4g} Pa fails",
            "Check the units of the moduli",
            at=("bulk_modulus",),
        )


SolidWords: TypeAlias = (
    IsotropicWords
    | OrthotropicWords
    | AnisotropicWords
    | LaminateWords
    | MooneyRivlinWords
    | NeoHookeanWords
)
MaterialWords = Annotated[SolidWords, Field(discriminator="law")]

LAWS: Mapping[str, type[SolidWords]] = {
    "isotropic": IsotropicWords,
    "orthotropic": OrthotropicWords,
    "mooney-rivlin": MooneyRivlinWords,
    "neo-hookean": NeoHookeanWords,
    "anisotropic": AnisotropicWords,
    "laminate": LaminateWords,
}
"""Model of each law."""

BLADE_LAWS = ("isotropic", "orthotropic", "anisotropic", "laminate")
"""Laws that the blade may have."""

BODY_LAWS = ("isotropic",)
"""Laws that a body other than a blade may have."""

FILM_LAWS = ("mooney-rivlin", "neo-hookean")
"""Laws that the film may have."""

PLY_LAWS = ("isotropic", "orthotropic")
"""Laws that the plies of a laminate may have."""


def plies_in(data: Mapping[str, Any]) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """Place and material of each ply of a case's laminates that names one, in its plain data."""
    own = data.get("materials")
    for name, words in own.items() if isinstance(own, Mapping) else ():
        plies = words.get("plies") if isinstance(words, Mapping) else None
        for number, ply in enumerate(plies if isinstance(plies, list | tuple) else ()):
            material = ply.get("material") if isinstance(ply, Mapping) else None
            if isinstance(material, str):
                yield ("materials", name, "plies", number, "material"), material


def ply_findings(data: Mapping[str, Any], laws: Mapping[str, str]) -> Iterator[Finding]:
    """Check that the materials of plies exist and can be plies.

    Parameters
    ----------
    data : mapping
        Plain data of a case.
    laws : mapping
        Law of each material that the case may name.
    """
    for path, name in plies_in(data):
        if name not in laws:
            near = suggestion(name, laws)
            yield Finding(path, "there is no material of this name", near or "Define it")
        elif laws[name] in LAWS and laws[name] not in PLY_LAWS:
            yield Finding(
                path,
                f"has the law {laws[name]}, which a ply cannot have",
                f"A ply needs the law {' or '.join(PLY_LAWS)}",
            )
