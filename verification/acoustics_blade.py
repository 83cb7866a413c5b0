# SPDX-License-Identifier: LGPL-2.1-or-later
"""A blade of a case, at rest or under its steady load, for systems with any condition and loss."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import ngsolve as ngs
import numpy as np

from quietblade.case import Case
from quietblade.case.presets import preset_text
from quietblade.geometry import Blade
from quietblade.mesh import Mesh, build_mesh, resize_sphere
from quietblade.mesh.motion import solve_mesh_motion
from quietblade.propulsion.structure import Structure
from quietblade.propulsion.tangent import Tangent, compute_tangent
from quietblade.study import solids, translate
from quietblade.study.preflight import preflight
from quietblade.study.statics import solve_statics
from quietblade.typing import FloatArray, silent
from quietblade.vibroacoustics.dtn import fitted_dtn
from quietblade.vibroacoustics.excitation import pressure_force
from quietblade.vibroacoustics.loss import Loss
from quietblade.vibroacoustics.multipoles import SurfaceSources
from quietblade.vibroacoustics.operators import Operators, build_operators
from quietblade.vibroacoustics.radiation import Bgt1, RadiationCondition


@dataclass(frozen=True, eq=False)
class WetBlade:
    """A blade on C0 or C1: what the sweeps of all its systems have in common.

    Attributes
    ----------
    case : Case
    mesh : Mesh
    tangent : Tangent
        Of the solid.
    displacement : (nodes, 3) array or None
        Of the blade's nodes from C0 to C1 [m]; None at rest.
    moved : (nodes, 3) array or None
        Of all nodes; None finds that of the water's by `solve_mesh_motion`.
    """

    case: Case
    mesh: Mesh
    tangent: Tangent
    displacement: FloatArray | None
    moved: FloatArray | None = None

    @cached_property
    def carried(self) -> FloatArray | None:
        """Displacement of all nodes from C0 to C1 (nodes, 3) [m], the water's too, if any moves."""
        if self.displacement is None:
            return None
        if self.moved is not None:
            return self.moved
        return solve_mesh_motion(self.mesh, self.displacement, self.case.acoustics.gap).displacement

    @cached_property
    def motion(self) -> ngs.GridFunction | None:
        """The same as a field of the whole mesh."""
        if self.carried is None:
            return None
        field = ngs.GridFunction(ngs.VectorH1(self.mesh.fem, order=2))
        field.vec.FV().NumPy()[:] = self.mesh.basis.to_dofs(self.carried)
        return field

    def in_sphere(self, radius: float, fixed: float) -> "WetBlade":
        """Return the same blade, cell by cell, in another sphere [m] (`resize_sphere`).

        What stays within ``fixed`` [m] of the centre is the same on C0 and on C1.
        """
        mesh = resize_sphere(self.mesh, radius, fixed)
        if self.carried is None:
            return replace(self, mesh=mesh)
        deformed = replace(self.mesh, nodes=self.mesh.nodes + self.carried)
        moved = resize_sphere(deformed, radius, fixed).nodes - mesh.nodes
        return replace(self, mesh=mesh, moved=moved)

    def system(self, condition: RadiationCondition | None = None, loss: Loss = None) -> Operators:
        """A(omega) with a condition on the sphere, first-order BGT if left out, and a loss.

        Without a loss, that of the case.
        """
        with ngs.TaskManager():
            return build_operators(
                self.mesh.fem,
                stiffness=self.tangent.stiffness(self.case.acoustics.tangent),
                loss=self.tangent.losses(self.case.acoustics.loss) if loss is None else loss,
                mass=self.tangent.mass,
                water=translate.water(self.case),
                radius=self.mesh.radius,
                motion=self.motion,
                condition=Bgt1() if condition is None else condition,
            )

    def exact_condition(self) -> RadiationCondition:
        """Dirichlet-to-Neumann map up to the degree that the blade and the band need."""
        return fitted_dtn(
            self.mesh.fem,
            translate.REACH * self.case.acoustics.band[1],
            sound_speed=self.case.water.sound_speed,
            radius=self.mesh.radius,
            accuracy=self.case.acoustics.radiation_accuracy,
            motion=self.motion,
        )

    def load(self, operators: Operators) -> FloatArray:
        """Right-hand side of the excitation (n,) [N]."""
        force = pressure_force(self.mesh.fem, self.case.excitation.pressure, motion=self.motion)
        return np.asarray(operators.right_hand_side(force))

    def sources(self, operators: Operators) -> SurfaceSources:
        """For the outgoing waves."""
        return SurfaceSources.of(self.mesh.fem, self.mesh.basis, operators, motion=self.motion)


def resting_blade(changes: Mapping[str, object], preset: str = "paper-composite") -> WetBlade:
    """Make the blade of a preset on C0, with some of the preset's keys changed.

    Parameters
    ----------
    changes : mapping
        Values by key, as ``{"mesh.size": "40 mm"}``.
    preset : str
    """
    case, shape, mesh = _meshed(changes, preset)
    materials = solids.build_materials(case, shape, mesh.basis)
    structure = Structure(mesh.fem, materials, basis=mesh.basis)
    return WetBlade(case, mesh, compute_tangent(structure, structure.rest()), None)


def loaded_blade(changes: Mapping[str, object], preset: str = "paper-composite") -> WetBlade:
    """Make the blade of a preset on C1: the same, in equilibrium with the flow."""
    case, shape, mesh = _meshed(changes, preset)
    statics = solve_statics(case, shape, mesh, silent)
    tangent = compute_tangent(statics.structure, statics.state.structure)
    return WetBlade(case, mesh, tangent, statics.state.displacement)


def _meshed(changes: Mapping[str, object], preset: str) -> tuple[Case, Blade, Mesh]:
    case = Case.parse(preset_text(preset)).varied(dict(changes))
    shape = preflight(case).blade
    return case, shape, build_mesh(shape, translate.mesh_spec(case))
