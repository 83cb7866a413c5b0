# SPDX-License-Identifier: LGPL-2.1-or-later
"""A(omega) on a small space of vectors, the fields split."""

from collections.abc import Iterable

import numpy as np
import scipy.linalg
from scipy.sparse import csr_matrix

from quietblade.typing import AnyArray, ComplexArray, FloatArray
from quietblade.vibroacoustics.operators import Operators

_LOST = 1e-9  # of a vector's length: what is left of it below is rounding
_SPREAD = 0.05  # relative distance of the omega between which factors are interpolated


class Projection:
    """Growing space of vectors, and the terms of A(omega) on it.

    Each vector enters as two columns, one with the structure's unknowns (displacement and film
    pressure) and one with the water's: the units of the fields then need no balance, and
    solutions in which they have another ratio are in the space too.  The structure's columns are
    orthonormal in its mass, the water's in the plain product.  With columns V the reduced
    matrices V^T A V, without conjugation, are complex symmetric as A is.

    Parameters
    ----------
    operators : Operators
        The system.
    """

    def __init__(self, operators: Operators) -> None:
        self._operators = operators
        blocks = operators.blocks
        self._fields = (np.concatenate([blocks.u, blocks.p]), blocks.psi)
        self._columns: tuple[list[ComplexArray], ...] = ([], [])
        self._order: list[tuple[int, int]] = []
        self._terms: dict[str, ComplexArray] = {
            name: np.zeros((0, 0), dtype=complex) for name in operators.factors(1.0)
        }

    def copy(self) -> "Projection":
        """Space with the same columns, which grows on its own."""
        other = Projection(self._operators)
        other._columns = tuple(list(field) for field in self._columns)
        other._order, other._terms = list(self._order), dict(self._terms)
        return other

    @property
    def size(self) -> int:
        """Number of columns."""
        return len(self._order)

    @property
    def structural(self) -> AnyArray:
        """Which columns belong to the structure, (size,) bool."""
        return np.array([field == 0 for field, _ in self._order], dtype=bool)

    def extend(self, vectors: Iterable[AnyArray]) -> None:
        """Add the structure's and the water's part of vectors (n,) of the whole system."""
        for vector in vectors:
            for field in (0, 1):
                column = self._orthonormal(field, vector[self._fields[field]].astype(complex))
                if column is not None:
                    self._append(field, column)

    def coordinates(self, vector: AnyArray) -> ComplexArray:
        """Coordinates (size,) of the projection of a vector (n,)."""
        parts = [vector[field].astype(complex) for field in self._fields]
        return np.array(
            [self._inner(field, self._columns[field][i], parts[field]) for field, i in self._order]
        )

    def lift(self, coordinates: ComplexArray) -> ComplexArray:
        """Vector (n,) of coordinates (size,)."""
        vector = np.zeros(self._operators.size, dtype=complex)
        for (field, i), factor in zip(self._order, coordinates, strict=True):
            vector[self._fields[field]] += factor * self._columns[field][i]
        return vector

    def at(self, omega: complex) -> ComplexArray:
        """V^T A(omega) V."""
        return self._sum(self._operators.factors(omega))

    def eigenpairs(self, omega: complex) -> tuple[ComplexArray, ComplexArray]:
        """Eigenvalues (m,) and coordinates (m, size) near omega.

        The factors of the terms are interpolated by polynomials of second degree around omega,
        exact for first-order BGT; the quadratic eigenproblem is linearised.
        """
        points = omega * np.array([1.0 - _SPREAD, 1.0, 1.0 + _SPREAD])
        below, here, above = (self.at(point) for point in points)
        # In mu = omega' / omega - 1, a number of order one.
        first, second = (above - below) / (2.0 * _SPREAD), (above + below - 2.0 * here)
        second /= 2.0 * _SPREAD**2
        scale = 1.0 / np.sqrt(np.abs(here).max(axis=1))
        zero, one, two = (scale[:, None] * part * scale for part in (here, first, second))
        nothing, unit = np.zeros_like(zero), np.eye(self.size)
        left = np.block([[nothing, unit], [-zero, -one]])
        right = np.block([[unit, nothing], [nothing, two]])
        values, vectors = scipy.linalg.eig(left, right)
        finite = np.isfinite(values)
        return omega * (1.0 + values[finite]), (scale[:, None] * vectors[: self.size, finite]).T

    def _sum(self, factors: "dict[str, complex]") -> ComplexArray:
        total = np.zeros((self.size, self.size), dtype=complex)
        for name, factor in factors.items():
            total += factor * self._terms[name]
        return total

    def _inner(self, field: int, a: ComplexArray, b: ComplexArray) -> complex:
        return complex(np.vdot(a, self._weighed(field, b)))

    def _weighed(self, field: int, vector: ComplexArray) -> ComplexArray:
        if field == 1:
            return vector
        full = np.zeros(self._operators.size, dtype=complex)
        full[self._fields[0]] = vector
        return np.asarray(times(self._operators.terms["M"], full)[self._fields[0]])

    def _orthonormal(self, field: int, vector: ComplexArray) -> ComplexArray | None:
        """Part of a vector that is new, with unit length; None if there is none."""
        length = self._length(field, vector)
        if length == 0.0:
            return None
        vector = vector / length
        for _ in range(2):  # once more for what rounding has left
            weighed = self._weighed(field, vector)
            for column in self._columns[field]:
                vector = vector - np.vdot(column, weighed) * column
        left = self._length(field, vector)
        return vector / left if left > _LOST else None

    def _length(self, field: int, vector: ComplexArray) -> float:
        return float(np.sqrt(max(self._inner(field, vector, vector).real, 0.0)))

    def _append(self, field: int, column: ComplexArray) -> None:
        self._columns[field].append(column)
        self._order.append((field, len(self._columns[field]) - 1))
        full = np.zeros(self._operators.size, dtype=complex)
        full[self._fields[field]] = column
        for name, old in self._terms.items():
            product = times(self._operators.terms[name], full)
            row = [self._columns[f][i] @ product[self._fields[f]] for f, i in self._order]
            grown = np.zeros((self.size, self.size), dtype=complex)
            grown[:-1, :-1] = old
            grown[-1, :] = grown[:, -1] = row
            self._terms[name] = grown


def times(matrix: csr_matrix, x: ComplexArray) -> ComplexArray:
    """Product of a real matrix and a complex vector, without a complex copy of the matrix."""
    parts = np.ascontiguousarray(x).view(np.float64).reshape(-1, 2)
    return np.asarray(np.ascontiguousarray(matrix @ parts).view(np.complex128)[:, 0])


def mass_assurance(a: ComplexArray, b: ComplexArray) -> FloatArray:
    """Modal assurance of each pair of rows of structural coordinates (orthonormal in mass)."""
    own, other = (np.linalg.norm(part, axis=1) for part in (a, b))
    scale = np.outer(own, other) ** 2
    overlap = np.abs(a.conj() @ b.T) ** 2
    return np.asarray(np.divide(overlap, scale, out=np.zeros_like(scale), where=scale > 0.0))
