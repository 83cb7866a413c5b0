# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is stored comes back, and nothing else is stored."""

from collections.abc import Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from quietblade.results import dataset
from quietblade.results import model as m
from quietblade.results.files import ResultError
from quietblade.results.quantities import LABELS, QUANTITIES
from quietblade.results.record import Record
from tests.results.synthetic import make_result


def assert_same(a: Any, b: Any) -> None:
    """Equal to the last bit, NaN included."""
    assert type(a) is type(b)
    if isinstance(a, Record):
        for field in fields(a):
            assert_same(getattr(a, field.name), getattr(b, field.name))
    elif isinstance(a, Mapping):
        assert list(a) == list(b)
        for name in a:
            assert_same(a[name], b[name])
    elif isinstance(a, np.ndarray):
        assert a.dtype == b.dtype
        np.testing.assert_array_equal(a, b)
    elif isinstance(a, float):
        np.testing.assert_array_equal(a, b)
    else:
        assert a == b


@pytest.mark.parametrize("blade", ["aluminium", "composite"])
def test_round_trip_through_the_file_is_exact(blade: str, tmp_path: Path) -> None:
    result = make_result(blade)
    dataset.write(dataset.to_tree(result), tmp_path / "result.nc")
    assert_same(dataset.from_tree(dataset.read(tmp_path / "result.nc")), result)


def test_reading_finds_what_xarray_finds(tmp_path: Path) -> None:
    file = tmp_path / "result.nc"
    dataset.write(dataset.to_tree(make_result()), file)
    ours = dataset.read(file)
    with xr.open_datatree(file, engine="h5netcdf") as tree:
        theirs = tree.load()
    assert ours.attrs == theirs.attrs
    assert [node.path for node in ours.subtree] == [node.path for node in theirs.subtree]
    for mine, other in zip(ours.subtree, theirs.subtree, strict=True):
        assert list(mine.variables) == list(other.variables)
        assert mine.to_dataset().equals(other.to_dataset())


def test_empty_tables_and_missing_figures_survive(tmp_path: Path) -> None:
    result = make_result()
    c0 = result.configurations["C0"]
    spectrum = replace(c0.spectrum, power_by_degree=np.empty((0, len(c0.spectrum.frequency))))
    bare = replace(
        result,
        static=replace(result.static, max_film_shear_strain=np.nan),
        configurations={"C0": replace(c0, spectrum=spectrum)},
        run=replace(result.run, notices=m.NoticeTable.of(())),
    )
    dataset.write(dataset.to_tree(bare), tmp_path / "result.nc")
    assert_same(dataset.from_tree(dataset.read(tmp_path / "result.nc")), bare)


def test_variables_carry_units_and_meaning(tmp_path: Path) -> None:
    dataset.write(dataset.to_tree(make_result()), tmp_path / "result.nc")
    with xr.open_datatree(tmp_path / "result.nc", engine="h5netcdf") as tree:
        level = tree["C1/spectrum/power_level"]
        assert level.attrs["units"] == "dB"
        assert level.attrs["reference"] == "1 pW"
        assert level.sel(path="sphere").dims == ("frequency",)
        assert tree["static/sections/blade_angle"].attrs["units"] == "rad"
        for node in tree.subtree:
            for variable in node.data_vars.values():
                assert variable.attrs["long_name"]


def test_complex_values_are_two_real_ones() -> None:
    result = make_result()
    mobility = dataset.to_tree(result)["C0/spectrum/mobility"]
    assert mobility.dims == ("frequency", "complex")
    assert mobility.dtype == np.float64
    expected = result.configurations["C0"].spectrum.mobility
    np.testing.assert_array_equal(mobility.sel(complex="im"), expected.imag)


def test_every_quantity_is_stored() -> None:
    tree = dataset.to_tree(make_result())
    stored = {
        f"{node.path.strip('/').replace('C0', 'C*')}/{name}".lstrip("/")
        for node in tree.subtree
        if not node.path.startswith("/C1")
        for name in node.to_dataset(inherit=False).variables
        if name not in LABELS
    }
    elsewhere = {"fields", "alternatives"}
    assert stored == {k for k, q in QUANTITIES.items() if q.group not in elsewhere}


@pytest.mark.parametrize(
    ("path", "variable"),
    [
        ("static/guess", xr.Variable((), 1.0)),
        ("extra/lift", xr.Variable((), 1.0)),
        ("static/thrust", xr.Variable(("axis",), np.ones(3))),  # registered by state
    ],
)
def test_unregistered_variables_are_errors(
    path: str, variable: xr.Variable, tmp_path: Path
) -> None:
    tree = dataset.to_tree(make_result())
    tree[path] = xr.DataArray(variable)
    with pytest.raises(ResultError, match=f"{path}.*not registered"):
        dataset.write(tree, tmp_path / "result.nc")
    with pytest.raises(ResultError, match=f"{path}.*not registered"):
        dataset.from_tree(tree)
    assert not (tmp_path / "result.nc").exists()


def test_a_missing_variable_is_named() -> None:
    tree = dataset.to_tree(make_result())
    tree["static"].dataset = tree["static"].to_dataset().drop_vars("lift")
    with pytest.raises(ResultError, match="lacks /static/lift"):
        dataset.from_tree(tree)


def test_another_format_is_refused() -> None:
    tree = dataset.to_tree(make_result())
    tree.attrs["format_version"] = 99
    with pytest.raises(ResultError, match="of version 99"):
        dataset.from_tree(tree)
    with pytest.raises(ResultError, match="something else"):
        dataset.from_tree(xr.DataTree())


def test_a_damaged_file_is_refused(tmp_path: Path) -> None:
    dataset.write(dataset.to_tree(make_result()), tmp_path / "result.nc")
    whole = (tmp_path / "result.nc").read_bytes()
    (tmp_path / "half.nc").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(ResultError, match=r"half\.nc: not a readable"):
        dataset.read(tmp_path / "half.nc")
