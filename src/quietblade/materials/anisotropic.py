# SPDX-License-Identifier: LGPL-2.1-or-later
"""General anisotropic Saint-Venant-Kirchhoff solid: 21 constants, or a stack of plies."""

from dataclasses import dataclass, field, replace

import ngsolve as ngs
import numpy as np

from quietblade.errors import MaterialError
from quietblade.materials.axes import Axes, as_coefficient, check_axes
from quietblade.materials.kinematics import green_lagrange
from quietblade.materials.protocols import (
    Density,
    require_definite,
    require_loss_factor,
    require_positive,
)
from quietblade.materials.voigt import strain_components
from quietblade.typing import FloatArray


@dataclass(frozen=True, eq=False)
class AnisotropicSVK:
    """Solid with ``W = 1/2 e . C e``, e the Green-Lagrange strain in the material axes.

    Attributes
    ----------
    name : str
        Name for messages and records.
    density : float or CoefficientFunction
        Mass per undeformed volume [kg/m3].
    stiffness : (6, 6) float array or CoefficientFunction
        C [Pa] for the components 11, 22, 33, 23, 13, 12 with engineering shear strains; a
        function of place for a stack of plies.
    axes : (3, 3) float array or CoefficientFunction
        Its columns are the unit material axes 1, 2, 3 in the blade frame (undeformed
        configuration); a CoefficientFunction may turn from place to place.
    loss_factor : float
        Loss factor eta of the complex stiffness ``C (1 + i eta)``, zero or positive.
    extra_order : int
        Degrees by which the order of the quadrature should exceed that of a solid with one
        stiffness in each cell.

    Raises
    ------
    MaterialError
        If the stiffness is not symmetric and positive definite (numbers only; of a function of
        place each ply is checked where it is made), or the axes are not a rotation.

    Notes
    -----
    Theory: S1-41.
    """

    name: str
    density: Density
    stiffness: FloatArray | ngs.CoefficientFunction
    axes: Axes = field(default_factory=lambda: np.eye(3))
    loss_factor: float = 0.0
    extra_order: int = 0

    def __post_init__(self) -> None:
        if not isinstance(self.density, ngs.CoefficientFunction):
            require_positive(self.name, density=self.density)
        require_loss_factor(self.name, self.loss_factor)
        if isinstance(self.stiffness, ngs.CoefficientFunction):
            if tuple(self.stiffness.dims) != (6, 6):
                raise MaterialError(
                    f"material {self.name!r}: the stiffness has dimensions "
                    f"{tuple(self.stiffness.dims)}, not (6, 6)"
                )
        else:
            require_definite(self.name, self.stiffness)
        check_axes(self.name, self.axes)

    def oriented(self, axes: Axes) -> "AnisotropicSVK":
        """Return the same material with other axes."""
        return replace(self, axes=axes)

    def energy(self, F: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """Strain energy per undeformed volume [J/m3] of the deformation gradient."""
        return self.energy_of_strain(green_lagrange(F))

    def energy_of_strain(self, E: ngs.CoefficientFunction) -> ngs.CoefficientFunction:
        """Strain energy ``1/2 e . C e`` [J/m3] of the Green-Lagrange strain in the blade frame."""
        axes = as_coefficient(self.axes)
        e = strain_components(axes.trans * E * axes)
        C = self.stiffness
        if not isinstance(C, ngs.CoefficientFunction):
            C = ngs.CF(tuple(np.asarray(C, dtype=float).ravel()), dims=(6, 6))
        return 0.5 * ngs.InnerProduct(C * e, e)
