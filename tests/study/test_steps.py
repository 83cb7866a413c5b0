# SPDX-License-Identifier: LGPL-2.1-or-later
"""The page of the notebook runs, and its steps give what a run gives."""

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import quietblade
from quietblade.errors import CaseError

PAGE = Path(__file__).resolve().parents[2] / "docs" / "notebook.md"


@pytest.fixture(scope="module")
def notebook(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Names after all cells of the page."""
    names: dict[str, Any] = {"__name__": "notebook"}
    cells = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.S | re.M)
    assert len(cells[0].splitlines()) <= 25
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("notebook"))
        for number, cell in enumerate(cells, 1):
            exec(compile(cell, f"notebook.md, cell {number}", "exec"), names)
    return names


def test_steps_give_what_a_run_gives(notebook: dict[str, Any]) -> None:
    steps, at_once = notebook["arrays"], notebook["again"].to_xarray()
    assert {node.path for node in steps.subtree} == {node.path for node in at_once.subtree}
    for node in steps.subtree:
        if node.path.startswith("/run"):
            continue
        for name, variable in node.to_dataset(inherit=False).variables.items():
            other = at_once[node.path].to_dataset(inherit=False)[name].values
            if variable.dtype.kind in "fc" and name not in {"residual", "error_estimate"}:
                size = np.max(np.abs(np.nan_to_num(other)), initial=0.0)
                np.testing.assert_allclose(variable.values, other, rtol=1e-6, atol=1e-9 * size)
            elif variable.dtype.kind not in "fc":
                assert np.array_equal(variable.values, other), f"{node.path}/{name}"


def test_every_variable_says_unit_and_meaning(notebook: dict[str, Any]) -> None:
    for node in notebook["arrays"].subtree:
        for name, variable in node.to_dataset(inherit=False).data_vars.items():
            assert variable.attrs["long_name"], f"{node.path}/{name}"
            number = variable.dtype.kind in "iufc" and node.path != "/run/notices"
            assert variable.attrs.get("units") or not number, f"{node.path}/{name}"


SAYS = {
    "case": ("NACA", "60 mm", "80 to 150 Hz"),
    "blade": ("chord [mm]", "75"),
    "mesh": ("hexahedron20", "radius"),
    "static": ("von Mises", "MPa", "tip displacement"),
    "modes": ("frequency [Hz]", "C1"),
    "response": ("dB re 1 pW", "Hz"),
    "result": ("C1: wet modes", "dB re 1 pW", "mm"),
}


@pytest.mark.parametrize("name", SAYS)
def test_objects_show_short_tables_with_units(notebook: dict[str, Any], name: str) -> None:
    shown = notebook[name]
    text, html = repr(shown), shown._repr_html_()
    for words in SAYS[name]:
        assert words.lower() in text.lower()
        assert words.lower() in html.lower()
    assert str(shown) == text
    assert len(text.splitlines()) <= 20
    assert html.count("<tr>") == html.count("</tr>") >= 2


def test_parts_show_themselves_too(notebook: dict[str, Any]) -> None:
    state, modes = notebook["static"].state, notebook["modes"].modes
    assert f"{1e3 * state.tip_displacement[1]:.2f}" in repr(state)
    assert f"{modes.frequency[0]:.4f}" in modes._repr_html_()
    assert "<svg" in notebook["blade"]._repr_html_()
    spectrum = repr(notebook["result"].configurations["C1"].spectrum)
    assert re.search(r"power_level +path \(3\) x frequency \(\d+\) +dB re 1 pW", spectrum)


def test_what_does_not_belong_together_is_refused(notebook: dict[str, Any]) -> None:
    case, mesh, static = (notebook[name] for name in ("case", "mesh", "static"))
    with pytest.raises(CaseError, match="give the response of each configuration"):
        quietblade.collect(case, mesh, static, [notebook["at_rest"]], [notebook["response"]])
    with pytest.raises(CaseError, match='configuration "C2"'):
        quietblade.solve_modes(case, notebook["blade"], mesh, static, "C2")


def test_import_is_light() -> None:
    code = "import sys, quietblade; print(sorted(set(sys.modules) & {'numpy', 'ngsolve', 'gmsh'}))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    assert set(quietblade.__all__) <= set(dir(quietblade))
    with pytest.raises(AttributeError, match="no attribute 'make_propeller'"):
        _ = quietblade.make_propeller
