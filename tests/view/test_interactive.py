# SPDX-License-Identifier: LGPL-2.1-or-later
"""The moving blade of the report: its numbers, and what a browser makes of it."""

import gzip
import json
import re
import shutil
import subprocess
from base64 import b64decode
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from quietblade.results.store import RunFolder
from quietblade.results.vtk import field_values, read_fields
from quietblade.view.interactive import POLICY, interactive_view, packed
from quietblade.view.surfaces import MovingSurface, mode_surface, steady_surface
from tests.results.synthetic import make_result


@pytest.fixture(scope="module")
def surfaces(runs: tuple[RunFolder, ...]) -> tuple[MovingSurface, ...]:
    """Surfaces of a run: steady load, modes at rest, modes under load."""
    result = make_result("composite")
    return (steady_surface(runs[1]), *(mode_surface(runs[1], result, c) for c in ("C0", "C1")))


def test_surfaces_are_closed(surfaces: tuple[MovingSurface, ...]) -> None:
    for surface in surfaces:
        for faces in (surface.blade, surface.film):
            assert len(faces) > 100
            sides = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
            _, count = np.unique(sides, axis=0, return_counts=True)
            assert np.all(count == 2)
        used = np.unique(np.concatenate([surface.blade, surface.film]))
        np.testing.assert_array_equal(used, np.arange(len(surface.points)))


def test_motions_are_those_of_the_fields(
    surfaces: tuple[MovingSurface, ...], runs: tuple[RunFolder, ...]
) -> None:
    steady, _, loaded = surfaces
    largest = np.linalg.norm(
        field_values(read_fields(runs[1].static_fields), "displacement"), axis=1
    ).max()
    assert steady.motions[0].amplitude.max() == pytest.approx(largest, rel=1e-3)
    result = make_result("composite")
    assert [m.name for m in loaded.motions] == list(result.configurations["C1"].modes.name)
    assert all(m.amplitude.max() == pytest.approx(1.0) for m in loaded.motions)


def test_packed_numbers_unpack_to_the_surface(surfaces: tuple[MovingSurface, ...]) -> None:
    scene, numbers = packed(surfaces)

    def array(place: tuple[int, int], kind: str) -> np.ndarray:
        assert place[0] % 4 == 0
        return np.frombuffer(numbers, kind, place[1], place[0]).astype(float)

    for told, surface in zip(scene["surfaces"], surfaces, strict=True):
        np.testing.assert_allclose(
            array(told["points"], "<f4").reshape(-1, 3), 1e3 * surface.points, atol=1e-3
        )
        np.testing.assert_array_equal(array(told["film"], "<i4").reshape(-1, 3), surface.film)
        for motion, own in zip(told["motions"], surface.motions, strict=True):
            unit = 1e-3 * motion["largest"] / 32767
            real = unit * array(motion["real"], "<i2").reshape(-1, 3)
            np.testing.assert_allclose(real, own.shape.real, atol=unit)
            if motion["imag"]:
                imag = unit * array(motion["imag"], "<i2").reshape(-1, 3)
                np.testing.assert_allclose(imag, own.shape.imag, atol=unit)
            else:
                assert np.abs(own.shape.imag).max() <= unit


def test_the_view_carries_its_library(runs: tuple[RunFolder, ...]) -> None:
    view = interactive_view(runs[1], make_result("composite"))
    text = re.search(r'id="view3d-library">([^<]*)<', view)
    assert text is not None
    assert b"plotly.js" in gzip.decompress(b64decode(text[1]))[:200]
    scene = re.search(r'id="view3d-scene">([^<]*)<', view)
    assert scene is not None
    assert len(json.loads(scene[1])["surfaces"]) == 3
    assert "src=" not in view
    assert len(view) < 8e6


def in_browser(page: Path, show: str, picture: Path) -> np.ndarray:
    """Picture that a browser without a graphics card makes of a page."""
    program = shutil.which("chromium") or shutil.which("google-chrome")
    if program is None:
        pytest.skip("neither chromium nor google-chrome is installed")
    subprocess.run(
        [
            program, "--headless", "--no-sandbox", "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--hide-scrollbars",
            f"--user-data-dir={picture.parent / 'profile'}", "--window-size=900,700",
            "--virtual-time-budget=20000", f"--screenshot={picture}", f"{page.as_uri()}#{show}",
        ],
        check=True, capture_output=True, timeout=120,
    )  # fmt: skip
    with Image.open(picture) as image:
        return np.asarray(image.convert("RGB")).astype(int)


def test_a_browser_draws_the_blade(runs: tuple[RunFolder, ...], tmp_path: Path) -> None:
    view = interactive_view(runs[1], make_result("composite"))
    page = tmp_path / "view.html"
    page.write_text(
        f'<!DOCTYPE html><meta charset="utf-8"><meta http-equiv="Content-Security-Policy" '
        f'content="{POLICY}"><style>#view3d-plot {{ height: 500px }}</style>{view}'
        '<p id="view3d-still">nothing was drawn</p>',
        encoding="utf-8",
    )
    steady = in_browser(page, "steady", tmp_path / "steady.png")
    mode = in_browser(page, "C1-B6", tmp_path / "mode.png")
    for picture in (steady, mode):
        red, green, blue = (picture[150:600, 100:700, k] for k in range(3))
        purple, teal = (blue > green + 25) & (red > green + 5), (green > red + 40) & (blue > red)
        assert purple.sum() > 500  # the root, which hardly moves
        assert teal.sum() > 200
    assert np.any(np.abs(steady - mode)[150:600, 100:700] > 60)
