# SPDX-License-Identifier: LGPL-2.1-or-later
import ngsolve as ngs
import numpy as np
import pytest

from quietblade.materials import IsotropicSVK, MooneyRivlin, find_material
from quietblade.mesh import Mesh
from verification.structure_composites import Bar
from verification.structure_convergence import (
    CondensedMooneyRivlin,
    bending_ratio,
    manufactured_errors,
    orders,
    patch_errors,
    unit_cube,
)
from verification.structure_models import box_mesh, piola_stress

SOLID = IsotropicSVK("solid", 1.0, 1e3, 0.3)
RUBBER = MooneyRivlin("rubber", 1.0, 120.0, 80.0, 1e6)
THICK = Bar(width=0.05, thickness=0.05, cells=(1, 1, 20))


@pytest.mark.parametrize("law", [SOLID, RUBBER], ids=["elastic", "mixed"])
@pytest.mark.parametrize("kind", ["hexahedra", "tetrahedra"])
def test_errors_fall_with_the_third_and_second_power_of_the_cells(
    law: IsotropicSVK | MooneyRivlin, kind: str
) -> None:
    displacement, stress = orders(manufactured_errors(law, kind, (1, 2)))
    assert displacement == pytest.approx(3.0, abs=0.2)
    assert stress == pytest.approx(2.0, abs=0.2)


def test_unknown_cells_are_refused() -> None:
    with pytest.raises(ValueError, match="neither 'hexahedra' nor 'tetrahedra'"):
        unit_cube("prisms", 1)


def test_the_mixed_mesh_passes_the_patch_test(coarse_mesh: Mesh) -> None:
    assert {kind for part in coarse_mesh.census().values() for kind in part} == {
        "tetra10", "pyramid13", "hexahedron20",
    }  # fmt: skip
    film = find_material("viscoelastic-paper")
    assert isinstance(film, MooneyRivlin)
    gradient = np.eye(3) + 0.003 * np.array([[1, 0.5, -0.4], [0.8, -1, 0.5], [-0.3, 0.7, 0.3]])
    errors = patch_errors(coarse_mesh, film, gradient)
    # what quadrature leaves on curved cells, whatever the size of the gradient; where the iteration
    # begins must not invert the flat pyramids over a thin cover
    assert errors.displacement < 5e-5
    assert errors.pressure < 1e-4  # the pressure itself is small here


def test_the_condensed_law_has_the_stress_of_the_mixed_one() -> None:
    gradient = np.array([[1.1, 0.2, 0.0], [-0.1, 0.9, 0.1], [0.05, 0.0, 1.02]])
    mesh = box_mesh(*3 * (np.array([0.0, 1.0]),))
    F = ngs.CF(tuple(gradient.ravel()), dims=(3, 3))
    twin = CondensedMooneyRivlin(RUBBER)
    p = RUBBER.bulk_modulus * (np.linalg.det(gradient) - 1)
    variable = F.MakeVariable()
    mixed = RUBBER.energy(variable, ngs.CF(p)).Diff(variable)
    at = mesh(0.5, 0.5, 0.5)
    assert np.array(piola_stress(twin, F)(at)) == pytest.approx(np.array(mixed(at)), rel=1e-9)
    strain = 0.5 * (F.trans * F - ngs.Id(3))
    assert twin.energy_of_strain(strain)(at) == pytest.approx(twin.energy(F)(at), rel=1e-12)


@pytest.mark.parametrize("ratio", [0.4, 0.499, 0.4999999])
def test_a_mixed_bar_does_not_lock(ratio: float) -> None:
    assert bending_ratio(ratio, THICK) == pytest.approx(1.0, abs=5e-4)
