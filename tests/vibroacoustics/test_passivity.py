# SPDX-License-Identifier: LGPL-2.1-or-later
"""No force draws power from the paper's blade, in its own shape or bent, whatever the condition."""

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from verification.acoustics_blade import WetBlade, resting_blade
from verification.acoustics_passivity import ForcedSystem

COARSE = {
    "mesh.size": "40 mm",
    "mesh.water_size": "400 mm",
    "acoustics.sphere_radius": "0.9 m",
}
NUMBER = st.integers(-1000, 1000).map(lambda n: 1e-2 * n)


@cache
def bodies() -> dict[str, WetBlade]:
    """The composite blade, and the same with water around a bent one."""
    rest = resting_blade(COARSE)
    bent = np.zeros_like(rest.mesh.nodes)
    bent[:, 1] = 0.25 * (rest.mesh.nodes[:, 2] - 0.2) ** 2
    return {
        "C0": rest,
        "bent": WetBlade(rest.case, rest.mesh, rest.tangent, bent),
    }


@cache
def forced(state: str, exact: bool, frequency: float) -> ForcedSystem:
    """Keep the responses to four forces."""
    body = bodies()[state]
    condition = body.exact_condition() if exact else None
    return ForcedSystem(body.system(condition), frequency, count=4, seed=3)


@pytest.mark.parametrize(("state", "exact"), [("C0", False), ("bent", True)])
@settings(max_examples=40, deadline=None)
@given(amplitude=st.lists(st.tuples(NUMBER, NUMBER), min_size=4, max_size=4))
def test_no_power_is_negative(
    state: str, exact: bool, amplitude: list[tuple[float, float]]
) -> None:
    system = forced(state, exact, 137.0)
    injected, radiated, dissipated = system.powers(np.array([complex(*a) for a in amplitude]))
    assert injected >= 0.0
    assert radiated >= 0.0
    assert dissipated >= 0.0
    assert injected == pytest.approx(radiated + dissipated, rel=1e-8)


def test_every_combination_is_covered_by_the_least_eigenvalue() -> None:
    assert forced("bent", True, 137.0).forms().min() > -1e-12
