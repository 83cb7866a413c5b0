# SPDX-License-Identifier: LGPL-2.1-or-later
"""The register is complete, and records refuse what it does not allow."""

from collections.abc import Iterator, Mapping
from dataclasses import fields, replace
from types import UnionType
from typing import get_args, get_origin, get_type_hints

import numpy as np
import pytest

from quietblade.errors import Notice
from quietblade.results import model as m
from quietblade.results.alternatives import AlternativeTable
from quietblade.results.quantities import DIMENSIONS, LABELS, QUANTITIES
from quietblade.results.record import Record
from tests.results.synthetic import make_result


def all_records(cls: type[Record] = m.Result) -> Iterator[type[Record]]:
    yield cls
    for hint in get_type_hints(cls).values():
        member = get_args(hint)[1] if get_origin(hint) is Mapping else record_type(hint)
        if isinstance(member, type) and issubclass(member, Record):
            yield from all_records(member)


def record_type(hint: object) -> object:
    """What a member is that may be None."""
    return get_args(hint)[0] if get_origin(hint) is UnionType else hint


RECORDS = [*all_records(), AlternativeTable]


def test_all_records_are_found() -> None:
    defined = {c for c in vars(m).values() if isinstance(c, type) and issubclass(c, Record)}
    assert defined - {Record} == set(RECORDS) - {AlternativeTable}


@pytest.mark.parametrize("record", RECORDS, ids=lambda r: r.__name__)
def test_every_attribute_is_registered_and_every_entry_exists(record: type[Record]) -> None:
    hints = get_type_hints(record)
    plain = {
        field.name
        for field in fields(record)
        if get_origin(hints[field.name]) is not Mapping
        and not issubclass(
            get_origin(record_type(hints[field.name])) or record_type(hints[field.name]), Record
        )
    }
    registered = {q.name for q in record.quantities()}
    assert plain <= registered
    assert all(isinstance(getattr(record, name), property) for name in registered - plain)


def test_every_group_has_a_record_or_is_the_fields() -> None:
    assert {q.group for q in QUANTITIES.values()} == {r.group for r in RECORDS} | {"fields"}


def test_entries_are_described_and_their_dimensions_known() -> None:
    for key, q in QUANTITIES.items():
        assert q.description, key
        assert set(q.dims) <= set(DIMENSIONS), key
        numeric = q.kind in {"real", "complex", "integer"}
        # the value and limit of a warning have the unit of whatever it is about
        assert bool(q.unit) == numeric or q.group == "run/notices", key
    assert set(LABELS) <= set(DIMENSIONS)


def test_levels_name_their_reference() -> None:
    assert QUANTITIES["C*/spectrum/power_level"].label == "dB re 1 pW"
    levels = [q for q in QUANTITIES.values() if q.unit == "dB" and q.name.endswith("level")]
    assert levels
    assert all(q.reference for q in levels)
    # what is left are differences of levels
    others = {q.name for q in QUANTITIES.values() if q.unit == "dB"} - {q.name for q in levels}
    assert others == {
        "accuracy", "largest_estimate", "estimate", "error_estimate", "condition_error",
        "index", "worst_excess", "excess",
        "found", "allowed",  # on the reference of the limit's quantity
    }  # fmt: skip


def test_values_are_copied_and_read_only() -> None:
    seconds = np.array([1.0, 2.0])
    timings = m.Timings(stage=("a", "b"), seconds=seconds)
    seconds[0] = 7.0
    assert timings.seconds[0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        timings.seconds[0] = 2.0


def test_wrong_number_of_dimensions() -> None:
    with pytest.raises(ValueError, match=r"run/timings/seconds: shape \(1, 2\).*\(stage\)"):
        m.Timings(stage=("a", "b"), seconds=np.ones((1, 2)))


def test_lengths_must_agree() -> None:
    with pytest.raises(ValueError, match="3 values along 'stage', expected 2"):
        m.Timings(stage=("a", "b"), seconds=np.ones(3))


def test_lengths_of_named_dimensions() -> None:
    with pytest.raises(ValueError, match="2 values along 'axis', expected 3"):
        replace(make_result().static, tip_displacement=np.zeros(2))


@pytest.mark.parametrize(
    ("stage", "seconds"), [((1, 2), np.ones(2)), (("a", "b"), np.ones(2) * 1j), (("a",), ("b",))]
)
def test_wrong_types(stage: object, seconds: object) -> None:
    with pytest.raises(ValueError, match="registered as"):
        m.Timings(stage=stage, seconds=seconds)  # type: ignore[arg-type]


def test_spectra_share_their_frequencies() -> None:
    result = make_result()
    c1 = result.configurations["C1"]
    other = replace(c1, spectrum=replace(c1.spectrum, frequency=c1.spectrum.frequency + 0.1))
    with pytest.raises(ValueError, match="share their frequencies"):
        replace(result, configurations={**result.configurations, "C1": other})


def test_frequencies_ascend() -> None:
    spectrum = make_result().configurations["C0"].spectrum
    with pytest.raises(ValueError, match="ascend"):
        replace(spectrum, frequency=spectrum.frequency[::-1])


def test_there_is_no_third_configuration() -> None:
    result = make_result()
    with pytest.raises(ValueError, match="C7"):
        replace(result, configurations={"C7": result.configurations["C0"]})


def test_derived_quantities() -> None:
    spectrum = make_result().configurations["C0"].spectrum
    ones = np.ones_like(spectrum.frequency)
    known = replace(
        spectrum,
        power=np.array([1e-9 * ones, 1e-12 * ones, -1.0 * ones]),
        injected=4e-9 * ones,
        dissipated=2e-9 * ones,
    )
    np.testing.assert_allclose(known.power_level[0], 30.0, rtol=1e-12)
    np.testing.assert_allclose(known.power_level[1], 0.0, atol=1e-12)
    assert np.all(np.isnan(known.power_level[2]))
    np.testing.assert_allclose(known.balance_residual, 0.25, rtol=1e-12)
    c0 = make_result().configurations["C0"]
    np.testing.assert_allclose(c0.kr[0], 2 * np.pi * 100.0 / 1500.0 * 1.3, rtol=1e-14)


def test_notices_survive_the_table() -> None:
    notices = (Notice("here", "this", 1.0, 2.0, "do that"), Notice("there", "no figures"))
    assert m.NoticeTable.of(notices).notices() == notices
    assert m.NoticeTable.of(()).notices() == ()
