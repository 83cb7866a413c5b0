# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes and meshes that several rooms' tests use."""

import numpy as np
import pytest

from quietblade.geometry import Blade, Film, NacaFourDigit, constant, formula, table
from quietblade.mesh import Mesh, MeshSpec, Patch, build_mesh


def make_paper_blade(film: Film | None = None) -> Blade:
    """The paper's trapezoid: NACA 0006, chord 250 mm to 75 mm over 1 m, root at 0.2 m."""
    return Blade(
        hub_radius=0.2,
        span=1.0,
        chord=table(np.array([0.0, 1.0]), np.array([0.25, 0.075])),
        blade_angle=constant(0.0),
        sweep=constant(0.0),
        rake=constant(0.0),
        thickness=constant(0.06),
        camber=constant(0.0),
        family=NacaFourDigit(),
        trailing_edge=0.006,
        alignment=0.5,
        film=film,
    )


def make_twisted_blade() -> Blade:
    """A twisted, swept, raked and cambered blade with a film."""
    return Blade(
        hub_radius=0.2,
        span=1.0,
        chord=formula("0.25 - 0.12*s - 0.05*s**2", 1.0),
        blade_angle=formula("0.3 - 0.6*s", 1.0),
        sweep=formula("0.1*s**2", 1.0),
        rake=formula("0.05*s", 1.0),
        thickness=constant(0.06),
        camber=constant(0.02),
        family=NacaFourDigit(),
        trailing_edge=0.006,
        alignment=0.5,
        film=Film((0.1, 0.9), (0.25, 0.65), 1.0e-3),
    )


PAPER_FILM = Film((0.05, 0.95), (0.15, 0.80), 1.5e-3)
PATCH = Patch(1, (0.90, 0.96), (0.30, 0.70))


SMALL_FILM = Film((0.1, 0.9), (0.25, 0.65), 1.0e-3)
"""A film with enough cover for coarse meshes."""


@pytest.fixture(scope="session")
def small_film_blade() -> Blade:
    return make_paper_blade(SMALL_FILM)


@pytest.fixture(scope="session")
def coarse_mesh(small_film_blade: Blade) -> Mesh:
    """The paper's blade, very coarse, in a sphere of 1.3 m."""
    return build_mesh(small_film_blade, MeshSpec(0.05, (0.0, 0.0, 0.7), 1.3, (PATCH,), 0.6))
