# SPDX-License-Identifier: LGPL-2.1-or-later
"""Notices on stall, cavitation and resolution."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from quietblade.flow import (
    BladeFlow,
    Environment,
    StripInflow,
    cavitation_number,
    notices,
    strip_loads,
)
from quietblade.flow.limits import STALL_INCIDENCE, STALL_THICKNESS
from tests.flow.shapes import OMEGA, V, fin, naca

STALL_TABLE = Path(__file__).resolve().parents[1] / "data" / "xfoil" / "stall.csv"
DEEP = Environment(depth=100.0)


def blade(thickness: float = 0.06, n: int = 161, rotation: float = OMEGA) -> BladeFlow:
    return strip_loads(fin(naca(thickness, n=n)), StripInflow(V, rotation))


def test_gentle_flow_needs_no_notice() -> None:
    gentle = blade(0.09, rotation=0.3)
    assert notices(gentle.sections, gentle.loads, DEEP) == []


def test_stall_limits_are_those_of_the_table() -> None:
    with STALL_TABLE.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    np.testing.assert_allclose(STALL_THICKNESS, [float(row["thickness"]) for row in rows])
    np.testing.assert_allclose(np.degrees(STALL_INCIDENCE), [float(r["alpha_deg"]) for r in rows])


def test_paper_blade_is_beyond_the_stall_of_its_thin_sections_at_the_tip() -> None:
    paper = blade()
    (notice,) = notices(paper.sections, paper.loads, DEEP)
    assert "stall" in notice.message
    assert "section 20, 1 m along the span" in notice.where
    assert notice.value == pytest.approx(np.radians(7.92), abs=1e-3)
    assert notice.limit == pytest.approx(np.radians(5.75), abs=1e-3)
    assert notice.remedy
    thick = blade(0.12)
    assert notices(thick.sections, thick.loads, DEEP) == []


def test_stall_limit_can_be_stated_and_holds_for_negative_incidence() -> None:
    stated = replace(DEEP, stall_incidence=0.1)
    backwards = blade(0.12, rotation=-OMEGA)
    (notice,) = notices(backwards.sections, backwards.loads, stated)
    assert notice.limit == 0.1


def test_cavitation_number_is_that_of_the_shallowest_position() -> None:
    paper, water = blade(), Environment(depth=3.0)
    sigma = cavitation_number(paper.sections, paper.loads, water)
    speed = np.hypot(V, OMEGA * 1.2)
    exact = (101325.0 + 1000.0 * 9.80665 * (3.0 - 1.2) - 2339.0) / (500.0 * speed**2)
    assert sigma[-1] == pytest.approx(exact)


def test_cavitation_begins_where_suction_exceeds_the_cavitation_number() -> None:
    paper = blade(0.12)
    suction = -paper.loads.cp.min(axis=1)
    radius = paper.sections.reference[:, 2]
    needed = (suction * paper.loads.dynamic_pressure - 101325.0 + 2339.0) / 9806.65 + radius
    inception = float(needed.max())
    wet = Environment(depth=inception + 0.01)
    dry = Environment(depth=inception - 0.01)
    assert notices(paper.sections, paper.loads, wet) == []
    (notice,) = notices(paper.sections, paper.loads, dry)
    assert "cavitation" in notice.message
    assert "1 of 21 sections" in notice.message
    assert notice.value is not None
    assert notice.limit is not None
    assert notice.value > notice.limit
    assert f"section {int(np.argmax(needed))}," in notice.where


def test_water_at_rest_does_not_cavitate() -> None:
    still = strip_loads(fin(naca()), StripInflow(0.0, 0.0))
    assert np.all(np.isinf(cavitation_number(still.sections, still.loads, Environment())))
    assert notices(still.sections, still.loads) == []


def test_coarse_noses_are_noticed() -> None:
    coarse = blade(0.06, n=61)
    messages = [n.message for n in notices(coarse.sections, coarse.loads, DEEP)]
    assert any("numerical drag" in message for message in messages)
