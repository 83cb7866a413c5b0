# SPDX-License-Identifier: LGPL-2.1-or-later
"""Named materials, each with the source of its constants."""

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from types import MappingProxyType

from quietblade.errors import MaterialError
from quietblade.materials.isotropic import IsotropicSVK
from quietblade.materials.mooney_rivlin import MooneyRivlin
from quietblade.materials.orthotropic import OrthotropicSVK

_PAPER = (
    "Application of a two-step fluid-structure approach for the analysis of large deformations "
    "and linear vibrations of propeller blades with embedded viscoelastic material, Table 2"
)


@dataclass(frozen=True)
class LibraryEntry:
    """A material of the library.

    Attributes
    ----------
    material : IsotropicSVK, OrthotropicSVK or MooneyRivlin
        The material; an orthotropic one still has to be given its axes (`oriented`).
    source : str
        Where the constants come from.
    note : str
        What a user should know before using them.
    """

    material: IsotropicSVK | OrthotropicSVK | MooneyRivlin
    source: str
    note: str = ""


LIBRARY: Mapping[str, LibraryEntry] = MappingProxyType(
    {
        entry.material.name: entry
        for entry in (
            LibraryEntry(
                IsotropicSVK("aluminium-paper", 2500.0, 65e9, 0.36),
                _PAPER,
                "Softer and lighter than usual aluminium alloys (70 GPa, 0.33, 2700 kg/m3).",
            ),
            LibraryEntry(
                OrthotropicSVK(
                    "woven-carbon-paper", 1500.0, e1=65e9, e2=65e9, e3=10e9,
                    g12=5e9, g23=3e9, g13=3e9, nu12=0.04, nu23=0.2, nu13=0.2,
                ),
                _PAPER,
                "Woven carbon-epoxy as one orthotropic solid; the paper lays its fibres at -45 and "
                "+45 degrees to the span: axes = ply_axes(pi / 4, ...).",
            ),
            LibraryEntry(
                MooneyRivlin("viscoelastic-paper", 1400.0, 0.238e6, 0.523e6, 2.2e9, 0.21),
                _PAPER,
                "Constant loss factor, an average over 100 to 200 Hz.",
            ),
        )
    }
)  # fmt: skip
"""Materials by name."""


def find_material(name: str) -> IsotropicSVK | OrthotropicSVK | MooneyRivlin:
    """Return the library's material of this name.

    Raises
    ------
    MaterialError
        If there is none; the message lists the names.
    """
    if name not in LIBRARY:
        near = get_close_matches(name, LIBRARY, n=1)
        hint = f" Did you mean {near[0]!r}?" if near else ""
        raise MaterialError(
            f"no material {name!r} in the library: it has {', '.join(LIBRARY)}.{hint}"
        )
    return LIBRARY[name].material
