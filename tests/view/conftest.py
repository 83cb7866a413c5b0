# SPDX-License-Identifier: LGPL-2.1-or-later
"""Folders of made-up runs on a real mesh."""

from pathlib import Path

import pytest

from quietblade.mesh import Mesh
from quietblade.results.store import RunFolder
from tests.results.synthetic import make_result, write_synthetic_fields


def _run(root: Path, blade: str, mesh: Mesh) -> RunFolder:
    folder, result = RunFolder(root / blade), make_result(blade)
    write_synthetic_fields(folder, mesh, result)
    folder.save(result)
    return folder


@pytest.fixture(scope="session")
def runs(tmp_path_factory: pytest.TempPathFactory, coarse_mesh: Mesh) -> tuple[RunFolder, ...]:
    """An aluminium and a composite run."""
    root = tmp_path_factory.mktemp("runs")
    return tuple(_run(root, blade, coarse_mesh) for blade in ("aluminium", "composite"))
