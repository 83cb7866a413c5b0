# SPDX-License-Identifier: LGPL-2.1-or-later
"""One pattern for all terms."""

import numpy as np
import pytest
from scipy.sparse import csr_matrix, random_array

from quietblade.vibroacoustics.pattern import CommonPattern


@pytest.fixture
def terms() -> dict[str, csr_matrix]:
    rng = np.random.default_rng(1)
    return {
        name: csr_matrix(random_array((40, 40), density=density, rng=rng))
        for name, density in (("A", 0.2), ("B", 0.02), ("empty", 0.0))
    }


def test_combination_is_the_sum(terms: dict[str, csr_matrix]) -> None:
    pattern = CommonPattern.of(terms)
    combined = pattern.combine({"A": 2.0 - 1.0j, "B": 3.0j, "empty": 1.0})
    expected = (2.0 - 1.0j) * terms["A"] + 3.0j * terms["B"]
    assert abs(combined - expected).max() < 1e-15
    assert combined.dtype == np.complex128
    assert pattern.combine({"A": 1.0, "B": -2.0}).dtype == np.float64


def test_pattern_does_not_depend_on_the_factors(terms: dict[str, csr_matrix]) -> None:
    pattern = CommonPattern.of(terms)
    first, second = pattern.combine({"A": 1.0}), pattern.combine({"B": 1.0j})
    np.testing.assert_array_equal(first.indices, second.indices)
    np.testing.assert_array_equal(first.indptr, second.indptr)
    assert first.has_sorted_indices


def test_repeated_entries_and_the_callers_matrix() -> None:
    repeated = csr_matrix((np.array([1.0, 2.0, 4.0]), np.array([1, 1, 0]), np.array([0, 2, 3])))
    pattern = CommonPattern.of({"A": repeated})
    np.testing.assert_array_equal(
        pattern.combine({"A": 1.0}).toarray(), np.array([[0.0, 3.0], [4.0, 0.0]])
    )
    assert repeated.nnz == 3


def test_terms_of_different_shape_are_refused() -> None:
    with pytest.raises(ValueError, match="one shape"):
        CommonPattern.of({"A": csr_matrix((2, 2)), "B": csr_matrix((3, 3))})
    with pytest.raises(ValueError, match="square"):
        CommonPattern.of({"A": csr_matrix((2, 3))})
