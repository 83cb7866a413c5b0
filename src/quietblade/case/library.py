# SPDX-License-Identifier: LGPL-2.1-or-later
"""Materials that a case file may name without defining them."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from pydantic import TypeAdapter

from quietblade.case.materials import MaterialWords, SolidWords

SOURCE = (
    "Application of a two-step fluid-structure approach for the analysis of large deformations "
    "and linear vibrations of propeller blades with embedded viscoelastic material, Table 2"
)
"""Where the constants come from."""

_CONSTANTS: Mapping[str, Mapping[str, Any]] = {
    "aluminium-paper": {
        "law": "isotropic",
        "density": "2500 kg/m^3",
        "E": "65 GPa",
        "nu": 0.36,
    },
    "woven-carbon-paper": {
        "law": "orthotropic",
        "density": "1500 kg/m^3",
        "E1": "65 GPa",
        "E2": "65 GPa",
        "E3": "10 GPa",
        "G12": "5 GPa",
        "G23": "3 GPa",
        "G13": "3 GPa",
        "nu12": 0.04,
        "nu23": 0.2,
        "nu13": 0.2,
        "ply_angle": "45 deg",
    },
    "viscoelastic-paper": {
        "law": "mooney-rivlin",
        "density": "1400 kg/m^3",
        "c10": "0.238 MPa",
        "c01": "0.523 MPa",
        "bulk_modulus": "2.2 GPa",
        "loss_factor": 0.21,
    },
}

NAMES = tuple(_CONSTANTS)
"""Names of the library's materials."""

LAW_OF: Mapping[str, str] = MappingProxyType(
    {name: constants["law"] for name, constants in _CONSTANTS.items()}
)
"""Law of each material of the library."""


def library_material(name: str) -> SolidWords:
    """Return a material of the library by its name."""
    adapter: TypeAdapter[SolidWords] = TypeAdapter(MaterialWords)
    return adapter.validate_python(_CONSTANTS[name])
