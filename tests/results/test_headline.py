# SPDX-License-Identifier: LGPL-2.1-or-later
"""Headline figures, their schema, their tables, and the differences of two runs."""

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from quietblade.results.comparison import compare_summaries, comparison_table, exchanged_names
from quietblade.results.documentation import json_schema, schema_page
from quietblade.results.headline import summarise
from quietblade.results.model import state, without_state
from quietblade.results.study_figures import headline_figures
from quietblade.results.summary import Summary
from quietblade.results.tables import as_text, summary_tables
from tests.results.synthetic import make_result, with_static

PAGE = Path(__file__).parents[2] / "docs" / "result-schema.md"


def as_json(summary: Summary) -> Any:
    return json.loads(json.dumps(summary.model_dump(mode="json"), allow_nan=False))


def problems(
    data: Any, node: Mapping[str, Any], schema: Mapping[str, Any], at: str = ""
) -> list[str]:
    """Places where data do not fit a JSON schema (the keywords that ours uses)."""
    if "$ref" in node:
        return problems(data, schema["$defs"][node["$ref"].rsplit("/", 1)[1]], schema, at)
    if "anyOf" in node:
        found = [problems(data, option, schema, at) for option in node["anyOf"]]
        return [] if any(not f for f in found) else [f"{at}: fits no option"]
    kinds = {"object": dict, "array": list, "string": str, "boolean": bool, "null": type(None)}
    kind, number = node["type"], isinstance(data, (int, float)) and not isinstance(data, bool)
    if kind in {"number", "integer"}:
        return [] if number and (kind == "number" or isinstance(data, int)) else [f"{at}: {kind}"]
    if not isinstance(data, kinds[kind]):
        return [f"{at}: not {kind}"]
    found = []
    if kind == "object":
        known, rest = node.get("properties", {}), node.get("additionalProperties", True)
        found += [f"{at}.{key}: missing" for key in node.get("required", ()) if key not in data]
        for key, value in data.items():
            inner = known.get(key, rest)
            if isinstance(inner, bool):
                found += [] if inner else [f"{at}.{key}: unknown"]
            else:
                found += problems(value, inner, schema, f"{at}.{key}")
    if kind == "array":
        items = node.get("prefixItems") or [node["items"]] * len(data)
        if len(items) != len(data):
            return [f"{at}: length"]
        for k, (value, inner) in enumerate(zip(data, items, strict=True)):
            found += problems(value, inner, schema, f"{at}[{k}]")
    return found


@pytest.mark.parametrize("blade", ["aluminium", "composite"])
def test_the_output_fits_the_schema(blade: str) -> None:
    schema = json_schema()
    data = as_json(summarise(make_result(blade)))
    assert problems(data, schema, schema) == []
    assert Summary.model_validate(data) == summarise(make_result(blade))


@pytest.mark.parametrize(
    ("part", "key", "value"),
    [("static", "lift_n", "much"), ("static", "converged", None), ("mesh", "nodes", 1.5),
     ("modes", "C0", [{"name": "B1"}]), ("sound_power", "surprise", 1.0)],
)  # fmt: skip
def test_the_schema_refuses(part: str, key: str, value: Any) -> None:
    schema = json_schema()
    data = as_json(summarise(make_result()))
    data[part][key] = value
    assert problems(data, schema, schema)
    with pytest.raises(ValidationError):
        Summary.model_validate(data)


def test_the_promised_fields_hold_the_result() -> None:
    result = make_result("composite")
    data = as_json(summarise(result))
    static, c0 = result.static, result.configurations["C0"]
    assert data["static"]["tip_displacement_m"] == static.tip_displacement.tolist()
    assert data["static"]["max_film_shear_strain"] == static.max_film_shear_strain
    assert data["static"]["lift_n"] == static.lift[2]
    assert data["static"]["iterations"] == 8
    first = data["modes"]["C0"][0]
    assert (first["name"], first["frequency_hz"]) == ("B5", 96.1)
    assert first["loss_factor"] == c0.modes.loss_factor[0]
    assert data["sound_power"]["frequency_hz"] == c0.spectrum.frequency.tolist()
    assert data["sound_power"]["C0_db"] == c0.spectrum.power_level[0].tolist()
    assert len(data["sound_power"]["C1_db"]) == len(data["sound_power"]["frequency_hz"])
    worst = max(c.spectrum.balance_residual.max() for c in result.configurations.values())
    assert data["balance"]["max_relative_residual"] == worst
    assert data["timings_s"] == {"mesh": 4.0, "equilibrium": 20.5, "sweep": 60.0, "total": 84.5}
    assert data["mesh"]["nodes"] == 17036
    assert data["unknowns"] == 28410 + 388 + 12034


def test_what_was_not_computed_is_null() -> None:
    result = with_static(make_result(), max_film_shear_strain=np.nan)
    c0 = result.configurations["C0"]
    power = c0.spectrum.power.copy()
    power[:, 3] = np.nan
    holed = replace(c0, spectrum=replace(c0.spectrum, power=power))
    data = as_json(summarise(replace(result, configurations={"C0": holed})))
    assert data["static"]["max_film_shear_strain"] is None
    assert data["sound_power"]["C0_db"][3] is None
    assert data["sound_power"]["C1_db"] == []
    assert data["modes"]["C1"] == []
    empty = as_json(summarise(replace(result, configurations={})))
    assert empty["balance"]["max_relative_residual"] is None
    schema = json_schema()
    assert problems(empty, schema, schema) == []


def test_the_documentation_is_that_of_the_code() -> None:
    assert PAGE.read_text(encoding="utf-8") == schema_page(), (
        "docs/result-schema.md is out of date; quietblade.results.documentation says how to "
        "renew it"
    )


def test_the_text_says_what_people_ask() -> None:
    summary = summarise(make_result("composite"))
    text = as_text(summary.title, summary_tables(summary))
    for part in ("1.4, 360.0, -77.8 mm", "BGT-1, R = 1.3 m, kR = 0.54 to 1.09", "dB re 1 pW",
                 "+7.94 %", "19 of 19 claims agree", "incidence beyond stall"):  # fmt: skip
        assert part in text, part
    assert all(len(set(map(len, t.rows))) == 1 for t in summary_tables(summary))


def test_a_result_that_did_not_converge_says_so() -> None:
    summary = summarise(with_static(make_result(), converged=False))
    assert "NOT CONVERGED" in as_text("", summary_tables(summary))


def test_repeated_changes_of_solver_are_counted() -> None:
    summary = summarise(make_result())
    events = tuple(f"sweep: a -> b: residual {k}e-5" for k in range(4))
    changed = summary.model_copy(
        update={"run": summary.run.model_copy(update={"fallbacks": events})}
    )
    text = as_text("", summary_tables(changed))
    assert text.count("sweep: a -> b") == 1
    assert "first of 4 times" in text


def test_exchanged_names_of_modes_are_noticed() -> None:
    a = summarise(make_result("aluminium"))
    assert exchanged_names(a, a) == ()
    other = {"B5": "E2", "E2": "B5"}
    modes = tuple(m.model_copy(update={"name": other.get(m.name, m.name)}) for m in a.modes.C0)
    b = a.model_copy(update={"modes": a.modes.model_copy(update={"C0": modes})})
    (notice,) = exchanged_names(a, b)
    assert notice.where == "modes C0"
    assert "B5 and E2" in notice.message
    assert "crosswise" in notice.remedy


def test_differences() -> None:
    a, b = (summarise(make_result(blade)) for blade in ("aluminium", "composite"))
    found = {d.name: d for d in compare_summaries(a, b)}
    tip = found["tip displacement y"]
    assert (tip.first, tip.second) == (0.13, 0.36)
    assert tip.change == pytest.approx(0.23)
    assert tip.relative == pytest.approx(0.23 / 0.13)
    assert found["C0 T2 frequency"].change == pytest.approx(4.2)
    assert found["C0 B7 frequency"].first is None
    assert found["C0 B7 frequency"].change is None
    level = found["C1 T2 peak level"]
    assert level.unit == "dB re 1 pW"
    assert level.relative is None
    assert all(d.change == 0.0 for d in compare_summaries(a, a) if d.change is not None)
    table = comparison_table(tuple(found.values()), ("first", "second"))
    row = next(row for row in table.rows if row[0] == "C0 T2 frequency")
    assert row == ("C0 T2 frequency", "162.7", "166.9", "+4.2", "+2.58", "Hz")


def test_a_state_that_could_not_be_computed_is_null() -> None:
    result = make_result("composite")
    lost = replace(result, static=without_state(result.static, "chained"))
    data = as_json(summarise(lost))
    assert data["static"]["lift_chained_n"] is None
    assert data["performance"]["chained"]["thrust_n"] is None
    assert data["static"]["lift_n"] == as_json(summarise(result))["static"]["lift_n"]
    assert np.isnan(lost.static.mid_section.placed[state("chained")]).all()
    assert np.isfinite(lost.static.mid_section.placed[state("coupled")]).all()
    assert np.isfinite(lost.static.history.error[1:]).all()
    assert "and - N" in as_text("", summary_tables(summarise(lost)))


def test_modes_tell_their_kind_loss_and_dry_partner() -> None:
    text = as_text("", summary_tables(summarise(make_result("composite"))))
    for part in ("by film", "by radiation", "dry [Hz]", "none missing", "edgewise", "3 x 5"):
        assert part in text, part
    (mode, *_) = summarise(make_result("composite")).modes.C1
    assert mode.loss_factor == pytest.approx(sum(mode.loss_by_part.values()))
    assert mode.dry_frequency_hz == pytest.approx(2.5 * mode.frequency_hz)


def test_where_the_power_goes_is_told_for_the_band_and_each_peak() -> None:
    result = make_result()
    summary = summarise(result)
    shares = summary.power_paths.C0
    assert list(shares.mean) == ["blade", "film", "water"]
    assert sum(shares.mean.values()) == pytest.approx(1.0)
    assert len(shares.peaks) == len(result.configurations["C0"].peaks.frequency)
    assert sum(shares.peaks[0].share.values()) == pytest.approx(1.0)
    text = as_text("run", summary_tables(summary))
    assert "Where the power goes" in text
    assert "C1, mean over the band" in text
    (film, blade) = summary.moduli
    assert (film.name, film.model, blade.fit_error) == ("film", "table", None)
    assert film.temperature_k == 283.15
    assert "10.0 degC" in text


def test_a_configuration_that_was_not_computed_has_no_columns() -> None:
    result = make_result("composite")
    rest = replace(result, configurations={"C0": result.configurations["C0"]})
    heads = [table.columns for table in summary_tables(summarise(rest))]
    assert ("Load", "kind", "amplitude", "C0 [dB]") in heads
    assert not any("C1" in head for table in heads for head in table)


def test_without_models_there_is_no_table_of_moduli() -> None:
    result = make_result()
    table = result.moduli
    empty = {
        name: getattr(table, name)[:0]
        for name in table.stored()
        if name not in ("band", "frequency")
    }
    bare = replace(result, moduli=replace(table, **empty))
    assert "Complex moduli" not in as_text("run", summary_tables(summarise(bare)))


def test_levels_of_random_loads_are_densities_everywhere() -> None:
    result = make_result()
    random = {
        name: replace(c, excitations=replace(c.excitations, signal="random"))
        for name, c in result.configurations.items()
    }
    result = replace(result, configurations=random)
    summary = summarise(result)
    assert summary.sound_power.level_reference == "1 pW/Hz"
    assert summary.far_field.source_level_reference == "1 uPa m/sqrt(Hz)"
    levels = [f.unit for f in headline_figures(result) if f.unit.startswith("dB re")]
    assert set(levels) == {"dB re 1 pW/Hz"}
    assert "1 pW/Hz if random" in str(type(summary.sound_power).model_fields["C0_db"].description)


def test_a_foil_that_does_not_turn_has_no_figures_of_a_rotor() -> None:
    result = make_result()
    unknown = np.full(3, np.nan)
    names = ("advance_ratio", "thrust_coefficient", "torque_coefficient", "efficiency")
    figures = replace(
        result.static.performance,
        **dict.fromkeys((*names, "inviscid_efficiency"), unknown),
        torque=np.array([1.0, np.nan, np.nan]),  # known in one state
    )
    summary = summarise(with_static(result, performance=figures))
    (table,) = (t for t in summary_tables(summary) if t.title == "Performance")
    assert [row[0] for row in table.rows] == ["Thrust T [N]", "Torque Q [N m]"]
    assert table.rows[1][1:4] == ("1.00", "-", "-")
