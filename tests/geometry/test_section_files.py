# SPDX-License-Identifier: LGPL-2.1-or-later
"""Coordinate files: layouts, what is read from them, and what is refused, with the line."""

from pathlib import Path

import numpy as np
import pytest

from quietblade.errors import GeometryError
from quietblade.flow import PanelSections
from quietblade.geometry import NacaFourDigit, read_section, section_from_file
from quietblade.geometry.table_sections import table_family
from quietblade.typing import FloatArray

CAMBERED = NacaFourDigit().contour(0.12, 0.04, 0.002, 121)


def lines(points: FloatArray) -> list[str]:
    return [f"{x:.7f}  {y:.7f}" for x, y in points]


def written(folder: Path, *text: str) -> Path:
    file = folder / "section.dat"
    file.write_text("\n".join(text) + "\n", encoding="utf-8")
    return file


def selig(folder: Path, points: FloatArray = CAMBERED) -> Path:
    return written(folder, "NACA 4412", "# a comment", "", *lines(points))


def lednicer(folder: Path, counts: str = " 61.  61.") -> Path:
    upper, lower = CAMBERED[60::-1], CAMBERED[60:]
    return written(folder, "NACA 4412", counts, "", *lines(upper), "", *lines(lower))


def test_both_layouts_hold_the_same_points(tmp_path: Path) -> None:
    first = read_section(selig(tmp_path))
    second = read_section(lednicer(tmp_path))
    assert (first.layout, second.layout) == ("Selig", "Lednicer")
    assert first.title == second.title == "NACA 4412"
    np.testing.assert_allclose(first.points, CAMBERED, atol=1e-7)
    np.testing.assert_allclose(np.delete(second.points, 61, axis=0), CAMBERED, atol=1e-7)


def test_lednicer_without_counts(tmp_path: Path) -> None:
    file = written(tmp_path, *lines(CAMBERED[60::-1]), *lines(CAMBERED[60:]))
    assert read_section(file).layout == "Lednicer"
    assert section_from_file(file).thickness == pytest.approx(0.12, abs=2e-4)


@pytest.mark.parametrize("camber", [0.0, 0.02, 0.04])
def test_a_table_of_a_naca_section_is_that_section(camber: float) -> None:
    naca = NacaFourDigit().contour(0.12, camber, 0.002, 161)
    table = table_family(naca, "table")
    assert table.trailing_edge == pytest.approx(0.002, rel=0.03)
    assert table.thickness == pytest.approx(0.12, abs=2e-4)
    ours = PanelSections(table.own_contour(161)[None]).solve(np.radians(4.0) + table.rotation)
    exact = PanelSections(naca[None]).solve(np.radians(4.0))
    # What is left is the base: at right angles to the chord, or to the mean line.
    assert ours.lift.item() == pytest.approx(exact.lift.item(), rel=3e-3)
    assert ours.cp.min() == pytest.approx(exact.cp.min(), rel=5e-3)


def test_units_place_position_and_order_do_not_matter(tmp_path: Path) -> None:
    plain = section_from_file(selig(tmp_path))
    angle = np.radians(7.0)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    moved = section_from_file(selig(tmp_path, (100.0 * CAMBERED @ turn.T + [3.0, -2.0])[::-1]))
    np.testing.assert_allclose(moved.own_contour(81), plain.own_contour(81), atol=1e-6)
    assert plain.rotation - moved.rotation == pytest.approx(angle, abs=1e-6)


def test_thickness_and_camber_scale_the_table() -> None:
    table = table_family(CAMBERED, "table")
    x = np.linspace(0.0, 1.0, 1001)
    double = table.half_thickness(x, 2.0 * table.thickness, 2.0 * table.trailing_edge)
    single = table.half_thickness(x, table.thickness, table.trailing_edge)
    np.testing.assert_allclose(double, 2.0 * single, atol=1e-15)
    assert 2.0 * single.max() == pytest.approx(table.thickness, rel=1e-5)
    assert table.camber_line(x, 0.01)[0].max() == pytest.approx(0.01, rel=1e-5)
    h = 1e-6
    inner = x[50:-50]
    rise = table.camber_line(inner + h, 0.03)[0] - table.camber_line(inner - h, 0.03)[0]
    np.testing.assert_allclose(table.camber_line(inner, 0.03)[1], rise / (2.0 * h), atol=1e-6)
    wide = table.contour(0.12, 0.02, 0.01, 81)
    assert np.linalg.norm(wide[0] - wide[-1]) == pytest.approx(0.01)


def test_a_symmetric_table_has_no_camber_to_scale() -> None:
    table = table_family(NacaFourDigit().contour(0.12, 0.0, 0.002, 81), "straight")
    table.contour(0.1, 0.0, 0.002, 41)
    with pytest.raises(GeometryError, match="'straight' is symmetric"):
        table.contour(0.1, 0.01, 0.002, 41)


def test_double_points_and_commas_are_read(tmp_path: Path) -> None:
    text = [line.replace("  ", ", ") for line in lines(CAMBERED)]
    doubled = [*text[:61], text[60], *text[61:]]
    assert len(section_from_file(written(tmp_path, *doubled)).own_contour(81)) == 81


WRONG = {
    "line 5: expected two numbers": ["title", *lines(CAMBERED)[:3], "0.5 abc"],
    "line 3: expected two numbers": ["title", "1.0 0.0", "0.5 0.1 0.2"],
    "line 2: announces 17 + 18 points": ["title", "17. 18.", *lines(CAMBERED)],
    "several elements": [*lines(CAMBERED), "999.0 999.0", *lines(CAMBERED)],
    "limit at least 11": ["1 0", "0.5 0.05", "0 0", "0.5 -0.05", "1 0"],
    "holds 0 points": ["only", "a title"],
    "begins and ends at": lines(CAMBERED[:90]),
    "turns back": [*lines(CAMBERED[:20]), *lines(CAMBERED[15:16]), *lines(CAMBERED[20:])],
    "nan": ["1.0 0.0", "nan 0.0"],
}


@pytest.mark.parametrize("message", WRONG)
def test_wrong_files_are_refused(message: str, tmp_path: Path) -> None:
    with pytest.raises(GeometryError, match=r"section") as caught:
        section_from_file(written(tmp_path, *WRONG[message]))
    assert message in str(caught.value)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(GeometryError, match=r"nothing\.dat"):
        read_section(tmp_path / "nothing.dat")


def test_sides_that_cross() -> None:
    crossed = CAMBERED.copy()
    crossed[20:50, 1] -= 0.2
    with pytest.raises(GeometryError, match=r"cross or touch|turns back"):
        table_family(crossed, "crossed")
