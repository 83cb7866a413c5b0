# SPDX-License-Identifier: LGPL-2.1-or-later
import json
import tomllib
from email.message import Message
from importlib import metadata
from pathlib import Path

import pytest

from quietblade.cli import doctor
from quietblade.cli.common import ExitCode
from quietblade.cli.main import execute

ROOT = Path(__file__).parents[2]


def test_this_environment_can_compute(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["doctor", "--json"]) == ExitCode.DONE
    found = json.loads(capsys.readouterr().out)
    solvers = {check["name"]: check for check in found["linear solvers"]}
    assert solvers["rslab"]["state"] == solvers["superlu"]["state"] == "good"
    assert found["speed"][0]["name"] == "paper-aluminium"
    assert {check["name"] for check in found["packages"]} >= {"ngsolve", "gmsh", "numpy"}


def test_an_old_and_a_missing_package_are_named_with_their_remedy(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    wanted = ["numpy>=99.0", "no-such-package>=1", 'another-one>=2; extra == "more"', "scipy>=1.0"]
    monkeypatch.setattr(metadata, "requires", lambda _: wanted)
    checks = {check.name: check for check in doctor._packages()}
    assert checks["numpy"].state == "bad"
    assert checks["numpy"].remedy == "pip install 'numpy>=99.0'"
    assert checks["no-such-package"].state == "bad"
    assert checks["scipy"].state == "good"
    assert "another-one" not in checks


def test_extras_say_what_they_are_for_and_are_never_bad(monkeypatch: pytest.MonkeyPatch) -> None:
    provided = Message()
    for extra, need in (("uff", "no-such-package>=1"), ("pdf", "numpy>=99.0"), ("mkl", "scipy")):
        provided["Provides-Extra"] = extra
        wanted = [*(metadata.requires("quietblade") or []), f'{need}; extra == "{extra}"']
        monkeypatch.setattr(metadata, "requires", lambda _, found=wanted: found)
    monkeypatch.setattr(metadata, "metadata", lambda _: provided)
    checks = {(check.name, check.found.split()[0]): check for check in doctor._extras()}
    missing = checks["uff", "no-such-package"]
    assert missing.found == "no-such-package not installed: universal files, export --uff"
    assert (missing.state, missing.remedy) == ("optional", "pip install 'no-such-package>=1'")
    assert checks["pdf", "numpy"].state == "optional"
    assert checks["mkl", "scipy"].state == "good"


def test_every_extra_has_its_use() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert set(project["optional-dependencies"]) == set(doctor.EXTRAS)


def test_programs_that_are_not_there_are_optional(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    checks = {check.name: check for check in doctor._programs()}
    assert {check.state for check in checks.values()} == {"optional"}
    assert "apt install calculix-ccx" in checks["ccx"].remedy


def test_the_packages_of_every_name_can_be_imported() -> None:
    # gmsh's wheel has files outside its folder, as a module called ".."
    assert doctor._module("gmsh") == "gmsh"
    assert doctor._module("pillow") == "PIL"


def test_many_versions_stand_in_one_line() -> None:
    good = [doctor.Check(name, "1.0", "good") for name in "abcdef"]
    bad = doctor.Check("g", "not installed", "bad", "pip install g")
    line, other = doctor._short([*good[:3], bad, *good[3:]])
    assert (line.name, line.found) == ("6 packages", "a 1.0, b 1.0, c 1.0, d 1.0, e 1.0, f 1.0")
    assert other == bad
    assert doctor._short(good[:2]) == good[:2]
