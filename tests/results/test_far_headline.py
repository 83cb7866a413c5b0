# SPDX-License-Identifier: LGPL-2.1-or-later
"""Peaks, bands and limits among the headline figures."""

from dataclasses import replace

import numpy as np
import pytest

from quietblade.results.headline import summarise
from quietblade.results.model import path
from quietblade.results.table import Table
from quietblade.results.tables import summary_tables
from tests.results.synthetic import make_result

RESULT = make_result("composite")


def table(title: str) -> Table:
    return next(t for t in summary_tables(summarise(RESULT)) if t.title == title)


def test_peaks_have_the_names_of_their_modes_and_what_belongs_to_them() -> None:
    rest, members = summarise(RESULT).far_field.C0, RESULT.configurations["C0"]
    assert [peak.mode for peak in rest.peaks] == ["E2", "B6", "T2", "B7"]
    np.testing.assert_array_equal([p.frequency_hz for p in rest.peaks], members.peaks.frequency)
    np.testing.assert_array_equal([p.level_db for p in rest.peaks], members.peaks.power_level)
    np.testing.assert_array_equal([p.width_hz for p in rest.peaks], members.peaks.width)
    assert rest.peaks[0].dipole == 0.9
    (given,) = rest.given
    assert (given.mode, given.frequency_hz, given.width_hz) == ("", 140.0, None)
    spectrum = members.spectrum
    nearest = int(np.argmin(np.abs(spectrum.frequency - 140.0)))
    assert given.level_db == spectrum.power_level[path("sphere"), nearest]


def test_limits_say_whether_they_are_exceeded() -> None:
    told = summarise(RESULT).limits
    assert [(x.name, x.configuration, x.exceeded) for x in told] == [
        ("hull", "C0", True), ("range", "C0", True),
        ("hull", "C1", True), ("range", "C1", True),
    ]  # fmt: skip
    rest = RESULT.configurations["C0"]
    limits = replace(rest.limits, worst_excess=np.array([-1.0, np.nan]))
    kept = replace(RESULT, configurations={"C0": replace(rest, limits=limits)})
    below, untouched = summarise(kept).limits
    assert (below.exceeded, untouched.exceeded) == (False, None)
    assert untouched.worst_excess_db is None
    words = [
        row[0] for t in summary_tables(summarise(kept)) if t.title == "Limits" for row in t.rows
    ]
    assert words == ["kept", "not touched"]


def test_tables_name_references_condition_and_its_error() -> None:
    peaks = table("Peaks of the radiated power")
    for part in ("dB re 1 pW", "dB re 1 uPa m", "BGT-1", "kR = 0.54 to 1.09", "up to 5.2 dB"):
        assert part in peaks.note, part
    assert peaks.rows[4][:3] == ("given", "C0", "140.000")
    assert table("Bands").rows[-1] == ("all frequencies", "71.0", "71.0", "116.5", "116.5")
    assert len(table("Multipoles and directivity at the peaks").rows) == len(peaks.rows)


def test_pressure_level_is_that_of_the_root_mean_square() -> None:
    far = RESULT.configurations["C0"].far_field
    loud = replace(far, pressure=np.full(far.pressure.shape, np.sqrt(2.0) + 0.0j))
    assert loud.pressure_level[0, 0] == pytest.approx(120.0)


def test_a_run_without_vibration_has_no_far_field() -> None:
    empty = summarise(replace(RESULT, configurations={}))
    assert (empty.far_field.C0.peaks, empty.limits) == ((), ())
    titles = {t.title for t in summary_tables(empty)}
    assert not titles & {"Peaks of the radiated power", "Limits", "Bands"}
