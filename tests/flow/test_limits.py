# SPDX-License-Identifier: LGPL-2.1-or-later
"""Notices on stall, cavitation and resolution; cavitation inception and bucket."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from quietblade.flow import (
    BladeFlow,
    Environment,
    PanelSections,
    StripInflow,
    cavitation_bucket,
    cavitation_number,
    inception_depth,
    inception_ship_speed,
    inception_speed,
    inception_submergence,
    notices,
    stall_incidence,
    strip_loads,
)
from tests.flow.shapes import OMEGA, V, fin, naca

STALL_TABLE = Path(__file__).resolve().parents[1] / "data" / "xfoil" / "stall-reynolds.csv"
DEEP = Environment(depth=100.0)


def blade(thickness: float = 0.06, n: int = 161, rotation: float = OMEGA) -> BladeFlow:
    return strip_loads(fin(naca(thickness, n=n)), StripInflow(V, rotation))


def test_gentle_flow_needs_no_notice() -> None:
    gentle = blade(0.09, rotation=0.3)
    assert notices(gentle.sections, gentle.loads, DEEP) == []


def test_stall_limits_are_those_of_the_table() -> None:
    with STALL_TABLE.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 9
    for row in rows:
        limit = stall_incidence(float(row["thickness"]), float(row["reynolds"]))
        assert np.degrees(limit) == pytest.approx(float(row["alpha_deg"]), abs=1e-9)


def test_stall_limit_lies_between_its_neighbours_and_holds_beyond_the_table() -> None:
    between = stall_incidence(0.075, np.sqrt(3.8e5 * 1.2e6))
    corners = [stall_incidence(t, re) for t in (0.06, 0.09) for re in (3.8e5, 1.2e6)]
    assert between == pytest.approx(np.mean(corners))
    assert stall_incidence(0.03, 0.0) == stall_incidence(0.06, 3.8e5)
    assert stall_incidence(0.3, 1e9) == stall_incidence(0.12, 3e6)


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


def test_cavitation_number_is_least_at_the_top_of_the_turn() -> None:
    paper = blade()
    turn = np.linspace(0.0, 2.0 * np.pi, 9)
    sigma = cavitation_number(paper.sections, paper.loads, Environment(), turn)
    assert sigma.shape == (9, 21)
    top = cavitation_number(paper.sections, paper.loads, Environment())
    np.testing.assert_allclose(sigma.min(axis=0), top)
    np.testing.assert_allclose(sigma[2], sigma[6])  # level with the axis
    head = 9.80665 * 1000.0 * 2.0 * paper.sections.reference[:, 2]
    np.testing.assert_allclose((sigma[4] - top) * paper.loads.dynamic_pressure, head)


def test_at_the_inception_depth_suction_equals_the_cavitation_number() -> None:
    paper = blade()
    depth = inception_depth(paper.sections, paper.loads, Environment())
    for k in (5, 20):
        water = Environment(depth=float(depth[k]))
        sigma = cavitation_number(paper.sections, paper.loads, water)
        assert sigma[k] == pytest.approx(-paper.loads.cp[k].min())


def test_inception_speed_and_submergence_are_inverses() -> None:
    water, suction = Environment(), np.array([3.5, 7.1, 12.8])
    depth = np.array([[0.0], [5.0], [10.0]])
    speed = inception_speed(suction, depth, water)
    np.testing.assert_allclose(
        inception_submergence(suction, speed, water), np.broadcast_to(depth, (3, 3)), atol=1e-9
    )
    assert np.isinf(inception_speed(-0.1, 1.0, water))
    assert inception_speed(1.0, -20.0, water) == 0.0


def test_inception_ship_speed_scales_the_whole_flow() -> None:
    paper, water = blade(), Environment(depth=8.0)
    faster = inception_ship_speed(paper.sections, paper.loads, water, V)
    k = int(np.argmin(faster))
    scale = float(faster[k]) / V
    other = strip_loads(fin(naca()), StripInflow(scale * V, scale * OMEGA))
    sigma = cavitation_number(other.sections, other.loads, water)
    assert sigma[k] == pytest.approx(-other.loads.cp[k].min())
    assert np.all(np.delete(sigma + other.loads.cp.min(axis=1), k) > 0.0)


def test_bucket_edges_have_the_suction_of_the_cavitation_number() -> None:
    contours = np.stack([naca(0.06), naca(0.12), naca(0.09, camber=0.02)])
    sigma = np.array([0.8, 1.5, 4.0])
    lowest, highest = cavitation_bucket(contours, sigma)
    assert lowest.shape == highest.shape == (3, 3)
    panels = PanelSections(contours)
    for edge in (lowest, highest):
        np.testing.assert_allclose(
            -panels.solve(edge).cp.min(axis=-1), np.broadcast_to(sigma[:, None], (3, 3))
        )
    inside = panels.solve(0.3 * lowest + 0.7 * highest)
    assert np.all(-inside.cp.min(axis=-1) < sigma[:, None])
    np.testing.assert_allclose(lowest[:, :2], -highest[:, :2], atol=1e-9)  # symmetric sections
    assert np.all(np.diff(highest - lowest, axis=0) > 0.0)


def test_bucket_is_empty_where_thickness_alone_cavitates() -> None:
    lowest, highest = cavitation_bucket(naca(0.12)[None], 0.2)
    assert np.isnan(lowest[0])
    assert np.isnan(highest[0])
