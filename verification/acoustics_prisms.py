# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shells in water of second-order prisms: the triangles of one sphere, put on many.

Bending of a thick wall asks for two things at once, fine triangles and several layers, and of
water only a thin one: prisms have both for a third of the unknowns of tetrahedra.
"""

import ngsolve as ngs
import numpy as np
from netgen import occ
from netgen.meshing import Element3D, FaceDescriptor, MeshingStep, PointId
from netgen.meshing import Mesh as NetgenMesh

from quietblade.typing import BoolArray, FloatArray, IntArray

# Netgen's order of the nodes in the middle of a triangle's edges: (1, 2), (0, 2), (0, 1); and of a
# prism's: edges of the lower triangle in reverse, upright edges, those of the upper triangle.
_BACKWARDS = [5, 4, 3]


def prism_shell(
    radii: tuple[float, ...], wetted: float, size: float, cap: float | None = None
) -> ngs.Mesh:
    """Hollow sphere "blade" inside the wetted radius and "water" outside, of curved prisms.

    Parameters
    ----------
    radii : tuple of float
        Ascending radii of the surfaces between the layers of prisms [m]: the first one is
        "inside", the last one "outer".
    wetted : float
        The radius, one of them, where the water begins: boundary "wet".
    size : float
        Edge length on the wetted sphere [m].
    cap : float or None
        Half-angle of a polar cap [rad] of the wetted surface, which becomes "excited".
    """
    unit, triangles, excited = _sphere(size / wetted, cap)
    between = 0.5 * (np.array(radii[1:]) + radii[:-1])
    levels = np.sort(np.concatenate([radii, between]))
    mesh, count = NetgenMesh(dim=3), len(unit)
    mesh.AddPoints(np.ascontiguousarray(np.concatenate([level * unit for level in levels])))
    for layer in range(len(radii) - 1):
        region = 1 if radii[layer + 1] <= wetted else 2
        low, middle, high = (triangles + (2 * layer + step) * count for step in range(3))
        prisms = np.concatenate(
            [low[:, :3], high[:, :3], low[:, _BACKWARDS], middle[:, :3], high[:, _BACKWARDS]],
            axis=1,
        )
        for prism in prisms + 1:
            mesh.Add(Element3D(region, [PointId(node) for node in prism.tolist()]))
    for region, name in ((1, "blade"), (2, "water")):
        mesh.SetMaterial(region, name)
    wet, every = radii.index(wetted), np.ones(len(triangles), dtype=bool)
    faces = [("inside", 0, every), ("wet", wet, ~excited), ("excited", wet, excited),
             ("outer", len(radii) - 1, every)]  # fmt: skip
    for index, (name, surface, chosen) in enumerate(faces, start=1):
        mesh.Add(FaceDescriptor(surfnr=index, domin=1, domout=0, bc=index))
        mesh.SetBCName(index - 1, name)
        nodes = triangles[chosen] + 2 * surface * count
        mesh.AddElements(dim=2, index=index, data=nodes.astype(np.int32), base=0)
    return ngs.Mesh(mesh)


def _sphere(size: float, cap: float | None) -> tuple[FloatArray, IntArray, BoolArray]:
    """Six-node triangles of the unit sphere in Netgen's order, and which lie on the cap.

    Returns
    -------
    points : (n, 3) array
    triangles : (m, 6) int array
        Seen from outside, they turn to the left.
    excited : (m,) bool array
    """
    ball = occ.Sphere(occ.Pnt(0.0, 0.0, 0.0), 1.0)
    ball.faces.name, parts = "wet", [ball]
    if cap is not None:
        box = occ.Box(occ.Pnt(-1.0, -1.0, float(np.cos(cap))), occ.Pnt(1.0, 1.0, 2.0))
        top = max((box * ball).faces, key=lambda face: face.center.z)
        top.name = "excited"
        parts.append(top)
    shape = occ.OCCGeometry(occ.Glue(parts))
    mesh = shape.GenerateMesh(maxh=size, perfstepsend=MeshingStep.MESHSURFACE)
    mesh.SecondOrder()
    points, elements = np.array(mesh.Coordinates()), mesh.Elements2D()
    triangles = np.array([[node.nr - 1 for node in element.points] for element in elements])
    names = {i: mesh.FaceDescriptor(i).bcname for i in {element.index for element in elements}}
    excited = np.array([names[element.index] == "excited" for element in elements])
    a, b, c = points[triangles[:, :3]].swapaxes(0, 1)
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0.0
    triangles[inward] = triangles[inward][:, [0, 2, 1, 3, 5, 4]]
    return points / np.linalg.norm(points, axis=1)[:, None], triangles, excited
