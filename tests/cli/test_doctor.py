# SPDX-License-Identifier: LGPL-2.1-or-later
import json
from importlib import metadata

import pytest

from quietblade.cli import doctor
from quietblade.cli.common import ExitCode
from quietblade.cli.main import execute


def test_this_environment_can_compute(capsys: pytest.CaptureFixture[str]) -> None:
    assert execute(["doctor", "--json"]) == ExitCode.DONE
    found = json.loads(capsys.readouterr().out)
    solvers = {check["name"]: check for check in found["linear solvers"]}
    assert solvers["rslab"]["state"] == solvers["superlu"]["state"] == "good"
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
    assert checks["another-one"].state == "optional"
    assert checks["scipy"].state == "good"
