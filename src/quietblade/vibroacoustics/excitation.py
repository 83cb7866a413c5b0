# SPDX-License-Identifier: LGPL-2.1-or-later
"""Harmonic loads on the blade's surface."""

import ngsolve as ngs
import numpy as np

from quietblade.mesh.boundaries import boundary
from quietblade.typing import FloatArray
from quietblade.vibroacoustics.fluid import fluid_normal


def pressure_force(
    fem: ngs.Mesh,
    pressure: float | ngs.CoefficientFunction,
    *,
    surface: str = "excited",
    motion: ngs.GridFunction | None = None,
) -> FloatArray:
    """Force of a harmonic pressure on a part of the wetted surface (theory: S2-5).

    The surface is made of the same material points in every configuration; normal and area are
    those of the configuration.  A positive pressure pushes into the blade, along the normal n out
    of the fluid, and adds to the water's own pressure.

    Parameters
    ----------
    pressure : float or ngsolve.CoefficientFunction
        Real peak amplitude [Pa]; on the whole patch, or as a function of place (of C0).
    surface : str
        Name pattern of the boundaries.
    motion : ngsolve.GridFunction or None
        Displacement from C0 to C1 [m]; None is C0.

    Returns
    -------
    (V.ndof,) array
        int pressure (du . n), on the unknowns of ``VectorH1(fem, order=2)`` [N].

    Raises
    ------
    MeshError
        If no boundary matches, or it does not touch the water.
    """
    region = boundary(fem, surface)
    space = ngs.VectorH1(fem, order=2)
    test = space.TestFunction()
    normal = fluid_normal(fem, region)
    form = ngs.LinearForm(space)
    form += (
        pressure
        * ngs.InnerProduct(test.Trace(), normal)
        * ngs.ds(definedon=region, deformation=motion)
    )
    force: FloatArray = np.array(form.Assemble().vec)
    return force
