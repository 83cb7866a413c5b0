# SPDX-License-Identifier: LGPL-2.1-or-later
"""Water mesh moved to the deformed blade by a pseudo-material (theory: S2-30).

A fictitious elastic solid fills the water.  Its stiffness falls with a power of the cell size, so
that small cells beside the blade move and turn almost rigidly and large cells far away deform.
Only the corners of the cells are moved by it: edges in the water stay straight, which inverts fewer
cells than curving them and costs an eighth of the unknowns.  Cells that it leaves poor are relaxed
one by one.
"""

from dataclasses import dataclass

import ngsolve as ngs
import numpy as np

from quietblade.errors import MeshError, Notice
from quietblade.linalg import make_solver
from quietblade.mesh.assembly import csr_of
from quietblade.mesh.model import INTERFACE, Mesh
from quietblade.mesh.quality import POOR_JACOBIAN, tetrahedron_jacobians
from quietblade.mesh.relax import relax_cells
from quietblade.typing import FloatArray

_ATTEMPTS = ((2.5, 4), (3.0, 8), (2.1, 16))
"""Power of the cell size and number of steps, tried in turn until no cell is poor."""


@dataclass(frozen=True)
class MeshMotion:
    """Displacement of every node from C0 to C1.

    Attributes
    ----------
    displacement : (n, 3) float array
        At the nodes of the mesh [m]: the blade's own in the blade, the pseudo-material's in the
        water, zero on the sphere.
    least_jacobian : float
        Least ratio of a water cell's Jacobian determinant on C1 to its mean in the cell.
    volume_ratio : (2,) tuple of float
        Least and largest volume of a water cell on C1 over that on C0.
    gap : float
        Least distance of the deformed blade to the sphere [m].
    steps : int
        Steps in which the mesh was moved.
    notices : tuple of Notice
    """

    displacement: FloatArray
    least_jacobian: float
    volume_ratio: tuple[float, float]
    gap: float
    steps: int
    notices: tuple[Notice, ...] = ()


def solve_mesh_motion(mesh: Mesh, blade_displacement: FloatArray, minimum_gap: float) -> MeshMotion:
    """Move the water mesh with the blade's surface.

    Parameters
    ----------
    mesh : Mesh
    blade_displacement : (n, 3) float array
        Displacement at the nodes of the mesh [m]; only the blade's nodes are read.
    minimum_gap : float
        Least allowed distance from the deformed blade to the outer sphere [m].

    Returns
    -------
    MeshMotion

    Raises
    ------
    MeshError
        The blade comes too close to the sphere, or a water cell stays inverted.
    """
    gap = sphere_gap(mesh, blade_displacement)
    if gap < minimum_gap:
        raise MeshError(
            f"the deformed blade comes within {gap:.3f} m of the outer sphere where at least "
            f"{minimum_gap:.3f} m are wanted; use a larger sphere radius or move its centre"
        )
    connectivity = np.concatenate([block.connectivity for block in mesh.cells["water"]])
    before = tetrahedron_jacobians(mesh.nodes, connectivity).mean(axis=1)
    held = np.ones(len(mesh.nodes), dtype=bool)
    held[connectivity] = False
    held[np.concatenate([faces.ravel() for faces in mesh.faces.values()])] = True
    best: MeshMotion | None = None
    worst = mesh.nodes[0]
    for power, steps in _ATTEMPTS:
        there = mesh.nodes + _move(mesh, blade_displacement, power, steps)
        there = relax_cells(there, connectivity, before, held, POOR_JACOBIAN)
        after = tetrahedron_jacobians(there, connectivity)
        if after.min() <= 0.0:
            worst = there[connectivity[after.min(axis=1).argmin()]].mean(axis=0)
            continue
        least = float((after.min(axis=1) / after.mean(axis=1)).min())
        if best is None or least > best.least_jacobian:
            ratio = after.mean(axis=1) / before
            bounds = (float(ratio.min()), float(ratio.max()))
            best = MeshMotion(there - mesh.nodes, least, bounds, gap, steps, _notices(least))
        if least >= POOR_JACOBIAN:
            break
    if best is None:
        x, y, z = worst
        raise MeshError(
            f"a water cell is inverted on C1 at x = {x:.3f} m, y = {y:.3f} m, z = {z:.3f} m "
            f"although the mesh was moved in {_ATTEMPTS[-1][1]} steps; use a smaller mesh size or "
            "a larger sphere"
        )
    return best


def sphere_gap(mesh: Mesh, displacement: FloatArray) -> float:
    """Least distance of the displaced blade's nodes to the outer sphere [m]."""
    blade = np.unique(np.concatenate([mesh.interface.ravel(), mesh.faces["root"].ravel()]))
    arm = (mesh.nodes + displacement)[blade] - mesh.centre
    return float(mesh.radius - np.linalg.norm(arm, axis=1).max())


def _notices(least: float) -> tuple[Notice, ...]:
    if least >= POOR_JACOBIAN:
        return ()
    remedy = "Peak levels on C1 may be inaccurate; try a smaller mesh size"
    return (Notice("water mesh on C1", "strongly curved cell", least, POOR_JACOBIAN, remedy),)


def _move(mesh: Mesh, blade_displacement: FloatArray, power: float, steps: int) -> FloatArray:
    """Nodal displacement in ``steps`` increments, the pseudo-material following the mesh."""
    basis, fem = mesh.basis, mesh.fem
    used = np.zeros(len(mesh.nodes), dtype=bool)
    used[basis.nodes_of("blade|film" if "film" in mesh.cells else "blade")] = True
    wanted = basis.to_dofs(np.where(used[:, None], blade_displacement, 0.0))
    space = ngs.VectorH1(fem, order=1, dirichlet=f"{INTERFACE}|root|outer")
    # the basis is hierarchical: its first functions are those of the corners
    corners = np.concatenate([c * basis.ndof + np.arange(fem.nv) for c in range(3)])
    water = np.array(space.GetDofs(fem.Materials("water")))
    free = np.flatnonzero(water & np.array(space.FreeDofs()))
    increment = wanted[corners] / steps
    increment[free] = 0.0
    total = np.zeros_like(increment)
    for _ in range(steps):
        matrix = csr_of(_pseudo_material(space, total, power))
        stiffness, coupled = matrix[free][:, free], matrix[free] @ increment
        step = increment.copy()
        step[free] = make_solver().analyse(stiffness).factor(stiffness).solve(-coupled)
        total += step
    regions = fem.Materials("|".join(region for region in mesh.cells if region != "water"))
    solid = np.array(ngs.VectorH1(fem, order=2).GetDofs(regions))
    moved = np.where(solid, wanted, 0.0)  # edges in the water: straight
    moved[corners] = total
    return np.asarray(basis.to_values(moved))


def _pseudo_material(space: ngs.VectorH1, moved: FloatArray, power: float) -> ngs.BilinearForm:
    deformation = ngs.GridFunction(space)
    deformation.vec.FV().NumPy()[:] = moved
    u, v = space.TnT()
    size = ngs.specialcf.mesh_size
    strain = ngs.Sym(ngs.Grad(u))
    density = 2 * ngs.InnerProduct(strain, ngs.Sym(ngs.Grad(v))) + ngs.div(u) * ngs.div(v)
    form = ngs.BilinearForm(space, symmetric=False, check_unused=False)
    form += density / size**power * ngs.dx("water", deformation=deformation)
    with ngs.TaskManager():
        form.Assemble()
    return form
