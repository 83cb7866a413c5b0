# SPDX-License-Identifier: LGPL-2.1-or-later
from pathlib import Path

import numpy as np
import pytest

from quietblade.results.alternatives import AlternativeTable
from quietblade.results.files import ResultError
from tests.results.made_tables import make_decomposition


def test_table_is_read_as_it_was_written(tmp_path: Path) -> None:
    table = make_decomposition()
    table.save(tmp_path / "deep" / "shift.nc")
    again = AlternativeTable.load(tmp_path / "deep" / "shift.nc")
    for name, array in table.arrays().items():
        np.testing.assert_array_equal(again.arrays()[name], array)
    assert again.name == table.name


def test_missing_and_foreign_files_are_told(tmp_path: Path) -> None:
    with pytest.raises(ResultError, match="no such table"):
        AlternativeTable.load(tmp_path / "none.nc")
    (tmp_path / "text.nc").write_text("no netCDF")
    with pytest.raises(ResultError, match=r"text\.nc"):
        AlternativeTable.load(tmp_path / "text.nc")


def test_rows_are_found_by_name() -> None:
    table = make_decomposition()
    assert table.row("shape") == 1
    with pytest.raises(ValueError, match="'shadow'; there are C0, shape"):
        table.row("shadow")
