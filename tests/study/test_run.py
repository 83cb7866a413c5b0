# SPDX-License-Identifier: LGPL-2.1-or-later
"""One coarse study from case to files; laws that hold on any mesh."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import BaseModel

from quietblade.case import Case
from quietblade.case.fields import Words
from quietblade.case.presets import preset_text
from quietblade.results.headline import summarise
from quietblade.results.model import Result, path
from quietblade.results.store import RunFolder
from quietblade.results.vtk import field_labels, read_fields
from quietblade.study.gather import paper_blade
from quietblade.study.run import finished, run_case
from quietblade.study.stages import Stage, stages
from verification.runs import difference

COARSE = {
    "film.span": [0.1, 0.9],
    "film.chord": [0.25, 0.65],
    "film.thickness": "1 mm",
    "mesh.size": "45 mm",
    "acoustics.sphere_radius": "1.3 m",
    "acoustics.band": ["80 Hz", "180 Hz"],
    "acoustics.step": "50 Hz",
    "acoustics.points_per_mode": 3,
    "flow.sections": 41,
    "flow.section_nodes": 121,
    "far_field": {"frequencies": ["131 Hz"], "points": [["0 m", "400 m", "0.7 m"]]},
    "limits": [
        {"name": "low", "frequencies": ["50 Hz", "500 Hz"], "levels": ["0 dB", "0 dB"]},
        {
            "name": "high", "quantity": "source-level", "bands": "third-octave",
            "frequencies": ["50 Hz", "500 Hz"], "levels": ["300 dB", "300 dB"],
        },
    ],
}  # fmt: skip


@pytest.fixture(scope="module")
def case() -> Case:
    return Case.parse(preset_text("paper-composite")).varied(COARSE)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> RunFolder:
    return RunFolder(tmp_path_factory.mktemp("run") / "blade")


class Watch:
    """Records which keys of the case each stage reads; a progress callback."""

    def __init__(self, case: Case) -> None:
        self.seen: dict[str, set[str]] = {}
        self.said: dict[str, str] = {}
        self._stage = ""
        self._places: dict[int, str] = {}
        self._locate(case, "")
        for part in ("blade", "film"):
            self._locate(case.material(part), f"materials.{part}")

    def _locate(self, words: Words, place: str) -> None:
        self._places[id(words)] = place
        for name in type(words).model_fields:
            inner = getattr(words, name)
            if isinstance(inner, Words):
                self._locate(inner, f"{place}.{name}".lstrip("."))

    def __call__(self, stage: str, fraction: float | None, message: str) -> None:
        self._stage = "" if fraction == 1.0 else stage
        self.said[stage] = message

    def read(self, words: Words, name: str) -> Any:
        value = BaseModel.__getattribute__(words, name)
        place = self._places.get(id(words))
        known = self._stage and place is not None and name in type(words).model_fields
        if known and not isinstance(value, Words):
            self.seen.setdefault(self._stage, set()).add(f"{place}.{name}".lstrip("."))
        return value


@pytest.fixture(scope="module")
def watch(case: Case) -> Watch:
    return Watch(case)


@pytest.fixture(scope="module")
def result(case: Case, folder: RunFolder, watch: Watch) -> Result:
    def read(words: Words, name: str) -> Any:  # a method of Words must be a function
        return watch.read(words, name)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Words, "__getattribute__", read)
        return run_case(case, folder, watch)


def test_injected_power_is_radiated_or_dissipated(result: Result) -> None:
    for configuration in result.configurations.values():
        assert np.all(configuration.spectrum.balance_residual < 1e-6)
        assert np.all(configuration.spectrum.dissipated > 0.0)


def test_power_of_sphere_and_wetted_surface_agree(result: Result) -> None:
    for configuration in result.configurations.values():
        sphere, wetted, outgoing = configuration.spectrum.power
        assert np.allclose(sphere, wetted, rtol=1e-4)  # both need the small part of a large field
        assert np.all(outgoing > 0.0)


def test_exact_condition_lets_the_outgoing_waves_pass(result: Result) -> None:
    for configuration in result.configurations.values():
        assert configuration.radiation_condition == "DtN"
        spectrum = configuration.spectrum
        excess = spectrum.power[path("sphere")] / spectrum.power[path("multipoles")]
        np.testing.assert_allclose(excess, 1.0, rtol=0.02)  # of a coarse mesh


def test_sweep_is_certified_and_its_peaks_are_told(result: Result) -> None:
    for configuration in result.configurations.values():
        sweep, peaks = configuration.sweep, configuration.peaks
        assert sweep.method == "reduced"
        assert sweep.largest_estimate <= sweep.accuracy
        assert sweep.factorizations <= 2
        assert len(peaks.frequency) > 0
        # no frequency of the grid is louder than the peaks
        top = np.nanmax(configuration.spectrum.power_level[path("sphere")])
        assert peaks.power_level.max() >= top - 1e-6


def test_source_level_is_that_of_the_power_through_the_sphere(result: Result) -> None:
    for configuration in result.configurations.values():
        far, spectrum = configuration.far_field, configuration.spectrum
        assert far.origin == "sphere"
        difference = far.source_level - spectrum.power_level[path("sphere")]
        np.testing.assert_allclose(difference, 50.7688, atol=1e-3)  # 10 lg(rho c / 4 pi)
        np.testing.assert_allclose(far.share.sum(axis=0), 1.0)
        assert np.all(far.efficiency < 1e-2)  # the water flows around so small a blade
        assert np.all(far.condition_error < 0.05)
        bands = configuration.bands
        np.testing.assert_allclose(bands.source_level - bands.level, 50.7688, atol=1e-3)


def test_directivity_at_the_peaks_and_where_asked(result: Result) -> None:
    for configuration in result.configurations.values():
        pattern, peaks = configuration.directivity, configuration.peaks
        count = len(peaks.frequency)
        np.testing.assert_allclose(pattern.frequency[:count], peaks.frequency)
        assert pattern.reason[count:] == ("given",)
        spectrum = configuration.spectrum
        (place,) = np.flatnonzero(spectrum.frequency == 131.0)
        level = spectrum.power_level[path("sphere"), place] + 50.7688
        assert pattern.source_level[count] == pytest.approx(level, abs=1e-3)
        # a point 400 m away along y against the pattern in that direction
        told = configuration.far_field.pressure_level[0, place] + 20.0 * np.log10(400.0)
        ahead = pattern.level[count, len(pattern.polar) // 2, len(pattern.azimuth) // 4]
        assert told == pytest.approx(ahead, abs=0.2)


def test_limits_are_held_against_peaks_and_bands(result: Result) -> None:
    for configuration in result.configurations.values():
        low, high = configuration.limits.worst_excess
        assert low == pytest.approx(configuration.peaks.power_level.max(), abs=1e-6)
        assert high < 0.0
    told = summarise(result).limits
    assert [limit.exceeded for limit in told if limit.name == "low"] == [True, True]
    assert [limit.exceeded for limit in told if limit.name == "high"] == [False, False]


def test_peaks_of_the_sweep_stand_on_the_modes(result: Result) -> None:
    for configuration in result.configurations.values():
        spectrum, modes = configuration.spectrum, configuration.modes
        level = spectrum.power_level[path("sphere")]
        inside = (modes.frequency > 85.0) & (modes.frequency < 175.0)
        assert inside.any()
        best = modes.participation[inside] > 0.1
        for f in modes.frequency[inside][best]:
            near = np.abs(spectrum.frequency - f) < 0.02 * f
            assert level[near].max() > np.median(level)


def test_static_load_moves_the_modes_and_keeps_their_shapes(result: Result) -> None:
    rest, loaded = (result.configurations[name].modes for name in ("C0", "C1"))
    bending = [k for k, name in enumerate(rest.name) if name in ("B1", "B2", "B3")]
    assert np.all(rest.partner_mac[bending] > 0.98)  # in the mass of blade and moved water
    for k in bending:
        back = loaded.name.index(rest.partner[k])
        assert loaded.partner[back] == rest.name[k]
        assert loaded.partner_mac[back] == pytest.approx(rest.partner_mac[k], rel=1e-9)
    shift = [
        loaded.frequency[loaded.name.index(rest.partner[k])] / rest.frequency[k] for k in bending
    ]
    assert np.all(np.abs(np.array(shift) - 1.0) > 1e-3)


def test_losses_of_a_mode_add_up_and_none_is_missing(result: Result) -> None:
    for configuration in result.configurations.values():
        modes, losses = configuration.modes, configuration.loss_shares
        assert losses.name == ("film", "radiation")
        np.testing.assert_allclose(np.nansum(losses.share, axis=1), modes.loss_factor, rtol=1e-12)
        inside = (modes.frequency > 80.0) & (modes.frequency < 180.0)
        assert np.all(losses.share[inside] > 0.0)
        count = configuration.mode_count
        assert count.counted == len(modes.frequency)
        assert count.highest == pytest.approx(1.2 * 180.0)
        assert len(count.character) == count.counted
        assert np.all(count.family_share.sum(axis=1) < 1.0 + 1e-9)


def test_response_at_a_peak_is_its_mode(result: Result) -> None:
    for configuration in result.configurations.values():
        at, modes = configuration.participation, configuration.modes
        assert np.all(at.share.sum(axis=1) < 1.0 + 1e-6)
        highest = np.argmax(configuration.peaks.power_level)
        row = np.argmin(np.abs(at.frequency - configuration.peaks.frequency[highest]))
        best = np.argmax(at.share[row])
        assert at.share[row, best] > 0.9
        assert modes.frequency[best] == pytest.approx(at.frequency[row], rel=5e-3)


def test_lift_grows_with_the_camber_of_the_composite_blade(result: Result) -> None:
    rigid, chained, coupled = result.static.lift
    assert result.static.converged
    assert chained > rigid
    assert coupled > rigid
    assert result.static.max_film_shear_strain > 5.0 * 0.002


def test_headline_has_what_scripts_read(result: Result) -> None:
    figures = summarise(result).model_dump(mode="json")
    assert len(figures["static"]["tip_displacement_m"]) == 3
    assert figures["static"]["iterations"] == len(result.static.history.lift)
    assert {"name", "frequency_hz", "loss_factor"} <= set(figures["modes"]["C0"][0])
    frequencies = figures["sound_power"]["frequency_hz"]
    assert len(frequencies) == len(figures["sound_power"]["C1_db"])
    assert figures["balance"]["max_relative_residual"] < 1e-6
    assert figures["mesh"]["nodes"] == result.mesh.nodes
    assert figures["unknowns"] == result.mesh.unknowns.count.sum()


def test_files_can_be_read_again(result: Result, folder: RunFolder) -> None:
    static = read_fields(folder.static_fields)
    assert np.nanmax(static.point_data["displacement"][:, 1]) > 0.05
    for name, configuration in result.configurations.items():
        labels = field_labels(read_fields(folder.mode_fields(name)), "mode_shape")
        assert labels == configuration.modes.name


def test_finished_run_is_found_and_another_case_is_not(
    result: Result, case: Case, folder: RunFolder
) -> None:
    found = finished(case, folder)
    assert found is not None
    assert np.array_equal(found.static.lift, result.static.lift)
    assert finished(case.varied({"flow.speed": "4 m/s"}), folder) is None
    assert finished(case, RunFolder(Path("no-such-run"))) is None


def test_stages_read_only_what_they_declare(result: Result, watch: Watch) -> None:
    # what they stand for is declared: materials by their constants, the cells of the water, the
    # places of pressures
    names = {"blade.material", "film.material", "materials"}
    stand_ins = {"mesh": {"acoustics.band", "water.sound_speed", "excitation"}}
    for name, stage in stages(tuple(result.configurations), stream=False, campbell=False).items():
        reads = watch.seen.get(name, set()) - names - stand_ins.get(name, set())
        undeclared = sorted(key for key in reads if not depends(name, key))
        assert not undeclared, f"{name} reads {undeclared}: add it to quietblade/study/stages.py"
        assert reads or stage.after, name


def depends(name: str, key: str) -> bool:
    """Whether a stage, or one that it comes after, declares a key, or that it does not matter."""
    stage = stages(("C0", "C1"))[name]
    ignored = Stage(stage.ignores).depends_on(key)
    return ignored or stage.depends_on(key) or any(depends(other, key) for other in stage.after)


def test_changed_case_goes_on_from_what_is_kept(
    result: Result, case: Case, folder: RunFolder
) -> None:
    said: dict[str, str] = {}
    damaged = next(folder.stages.glob("modes-C1-*.pickle"))
    content = damaged.read_bytes()
    damaged.write_bytes(content[: len(content) // 2])
    again = run_case(case, folder, lambda stage, _, message: said.setdefault(stage, message))
    assert "kept: mesh, flow and structure" in said.pop("stages")
    assert {stage for stage, message in said.items() if message.startswith("kept")} == {
        "mesh", "flow and structure", "mesh motion", "modes C0", "sweep C0", "sweep C1",
        "mode tables",
    }  # fmt: skip
    assert "damaged" in said["modes C1"]
    assert any("damaged" in notice.message for notice in again.run.notices.notices())
    assert again.run.cost.kept.tolist() == [*4 * [True], False, *3 * [True], False]
    assert difference(result, again) < 1e-10
    assert len(list(folder.stages.glob("*.pickle"))) == 8
    assert "modes C1" in folder.log.read_text(encoding="utf-8")


def test_papers_blades_are_recognised(case: Case) -> None:
    assert paper_blade(case) == "composite"  # film, mesh and sphere are not stated in the paper
    assert paper_blade(Case.parse(preset_text("paper-aluminium"))) == "aluminium"
    assert paper_blade(case.varied({"flow.speed": "4 m/s"})) == ""
