# SPDX-License-Identifier: LGPL-2.1-or-later
"""Boundaries of a mesh by name; a name that the mesh does not have is an error."""

import re

import ngsolve as ngs

from quietblade.errors import MeshError

_NAMES = re.compile(r"[\w -]+(\|[\w -]+)*")


def boundary(fem: ngs.Mesh, pattern: str) -> ngs.Region:
    """Boundary region by name pattern, a regular expression.

    Raises
    ------
    MeshError
        If no boundary matches.
    """
    region = fem.Boundaries(pattern)
    if not any(region.Mask()):
        names = sorted(set(fem.GetBoundaries()))
        raise MeshError(f"no boundary of the mesh matches {pattern!r}: it has {names}")
    return region


def held_boundary(fem: ngs.Mesh, pattern: str) -> ngs.Region:
    """Boundary region that a support holds: each name of ``"one|other"`` must be there.

    Raises
    ------
    MeshError
        If a name matches no boundary, so that its support would hold nothing.
    """
    for name in pattern.split("|") if _NAMES.fullmatch(pattern) else ():
        boundary(fem, name)
    return boundary(fem, pattern)
