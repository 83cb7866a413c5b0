# SPDX-License-Identifier: LGPL-2.1-or-later
"""Regions whose stiffness is complex, as terms of A(omega) (theory: S2-51)."""

from collections.abc import Mapping
from dataclasses import dataclass

from scipy.sparse import csr_matrix

from quietblade.materials.viscoelastic import ConstantLoss, ModulusRatio

STREAM = "stream"
"""Name of the lossy part that a stream around the blade makes (`flow_damping`)."""


@dataclass(frozen=True, eq=False)
class Lossy:
    """Stiffness of a region that is complex: (g(omega) - 1) D comes on top of K.

    Attributes
    ----------
    matrix : csr_matrix
        D, the static stiffness that has the complex modulus; numbered as K.
    ratio : ModulusRatio
        g, the complex modulus over the static one.
    """

    matrix: csr_matrix
    ratio: ModulusRatio


Loss = csr_matrix | Mapping[str, csr_matrix | Lossy] | None
"""Lossy regions; a matrix is L with a constant loss factor included."""


@dataclass(frozen=True)
class Stiffened:
    """A model times a real factor, such as that of a static strain.

    Attributes
    ----------
    model : ModulusRatio
    factor : float
        Positive.
    """

    model: ModulusRatio
    factor: float

    def __call__(self, omega: complex) -> complex:
        """Return g(omega)."""
        return self.factor * self.model(omega)


@dataclass(frozen=True)
class Viscous:
    """g = 1 + i omega: D is then the matrix of a damping force, i omega D."""

    def __call__(self, omega: complex) -> complex:
        """Return g(omega)."""
        return 1.0 + 1j * omega


def loss_term(region: str) -> str:
    """Name of the term of A(omega) that holds a region's D."""
    return f"D {region}"


def lossy_parts(loss: Loss) -> dict[str, Lossy]:
    """Lossy regions by name; a matrix L is a D whose modulus is 1 + i."""
    named = {} if loss is None else loss if isinstance(loss, Mapping) else {"all": loss}
    return {
        name: part if isinstance(part, Lossy) else Lossy(part, ConstantLoss(1.0))
        for name, part in named.items()
    }
