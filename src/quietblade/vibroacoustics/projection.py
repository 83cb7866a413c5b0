# SPDX-License-Identifier: LGPL-2.1-or-later
"""A(omega) on a small space of real vectors, the fields split."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.sparse import csr_matrix

from quietblade.typing import AnyArray, BoolArray, ComplexArray, FloatArray, IntArray
from quietblade.vibroacoustics.operators import Operators

_LOST = 1e-9  # of a vector's length: what is left of it below is rounding
_SPREAD = 0.05  # relative distance of the omega between which factors are interpolated
_NEWTON_STEPS = 12
_SETTLED = 1e-14  # relative change of omega
_ROOM = 16  # columns for which room is made at a time
_HELD = 2  # number of the field of the root and its reaction


class Projection:
    """Growing space of vectors, and the terms of A(omega) on it.

    Each vector enters as up to four real columns, the real and imaginary parts of the structure's
    unknowns (displacement and film pressure) and of the water's: the units of the fields then need
    no balance, and solutions in which they have another ratio are in the space too.  The columns
    being real, the reduced matrices V^T A V are symmetric where A is, and every term that is
    positive semidefinite stays so: a passive system stays passive.  The structure's columns are
    orthonormal in its mass, the water's in the plain product.  The motion of a root and its
    reaction have a column each from the beginning, so that what holds the root is exact.

    Parameters
    ----------
    operators : Operators
        The system.
    """

    def __init__(self, operators: Operators) -> None:
        self._operators = operators
        blocks = operators.blocks
        moving = np.concatenate([blocks.u, blocks.p, blocks.strips])
        self._fields = (moving, blocks.water, blocks.held)
        self._mass = operators.terms["M"][self._fields[0]][:, self._fields[0]]
        self._columns = [np.zeros((0, len(field))) for field in self._fields]  # rows are columns
        self._count = [0] * len(self._fields)
        self._field = np.zeros(0, dtype=np.int64)  # of each column, in the order of entry
        self._whole = {
            name: _Term.of(operators.terms[name], self._fields) for name in operators.factors(1.0)
        }
        self._terms = {name: np.zeros((0, 0)) for name in self._whole}
        self._append([(_HELD, unit) for unit in np.eye(len(blocks.held))])

    def copy(self) -> "Projection":
        """Space with the same columns, which grows on its own."""
        other = Projection(self._operators)
        other._columns = [columns.copy() for columns in self._columns]
        other._count, other._field = list(self._count), self._field
        other._terms = dict(self._terms)
        return other

    @property
    def size(self) -> int:
        """Number of columns."""
        return len(self._field)

    @property
    def structural(self) -> BoolArray:
        """Which columns belong to the structure between its root and the water, (size,) bool."""
        return np.asarray(self._field == 0)

    @property
    def places(self) -> tuple[IntArray, IntArray, IntArray]:
        """Columns of the structure, of the water, and of the root and its reaction."""
        own, water, held = (np.flatnonzero(self._field == f) for f in range(len(self._fields)))
        return own, water, held

    @property
    def terms(self) -> dict[str, FloatArray]:
        """V^T A_j V of each term, (size, size)."""
        return dict(self._terms)

    def extend(self, vectors: Iterable[AnyArray]) -> None:
        """Add vectors (n,) of the whole system."""
        for vector in vectors:
            self._append(
                [
                    (field, column)
                    for field, unknowns in enumerate(self._fields[:_HELD])
                    for column in self._new_columns(field, vector[unknowns])
                ]
            )

    def restricted(self, vector: AnyArray) -> AnyArray:
        """V^T b of vectors (n,) or (n, k): (size,) or (size, k)."""
        return self._scattered(
            [self._basis(f) @ vector[unknowns] for f, unknowns in enumerate(self._fields)]
        )

    def coordinates(self, vector: AnyArray) -> ComplexArray:
        """Coordinates (size,) of the projection of a vector (n,)."""
        solid, water, held = (vector[unknowns].astype(complex) for unknowns in self._fields)
        parts = [self._basis(0) @ times(self._mass, solid), self._basis(1) @ water, held]
        return self._scattered(parts).astype(complex)

    def lift(self, coordinates: AnyArray) -> AnyArray:
        """Vectors (n,) or (k, n) of coordinates (size,) or (k, size)."""
        shape = (*coordinates.shape[:-1], self._operators.size)
        vector = np.zeros(shape, dtype=coordinates.dtype)
        for field, unknowns in enumerate(self._fields):
            vector[..., unknowns] = coordinates[..., self._field == field] @ self._basis(field)
        return vector

    def at(self, omega: complex) -> ComplexArray:
        """V^T A(omega) V."""
        return np.asarray(self.at_each(np.array([omega]))[0])

    def at_each(self, omega: AnyArray, size: int | None = None) -> ComplexArray:
        """V^T A(omega) V on the first columns, (f, size, size), at angular frequencies (f,)."""
        kept = slice(self.size if size is None else size)
        rows = [self._operators.factors(w) for w in np.asarray(omega, dtype=complex).tolist()]
        factors = np.array([list(row.values()) for row in rows], dtype=complex)
        terms = np.stack([self._terms[name][kept, kept] for name in rows[0]])
        flat = terms.reshape(len(terms), -1)
        # two real products: the terms have no imaginary part
        total = (factors.real @ flat) + 1j * (factors.imag @ flat)
        return np.asarray(total.reshape(len(rows), *terms.shape[1:]))

    def eigenpairs(
        self, omega: complex, size: int | None = None
    ) -> tuple[ComplexArray, ComplexArray]:
        """Eigenvalues (m,) and coordinates (m, size) near omega, on the first columns.

        The factors of the terms are interpolated by polynomials of second degree around omega,
        exact for first-order BGT; the quadratic eigenproblem is linearised.
        """
        points = omega * np.array([1.0 - _SPREAD, 1.0, 1.0 + _SPREAD])
        below, here, above = self.at_each(points, size)
        # In mu = omega' / omega - 1, a number of order one.
        first, second = (above - below) / (2.0 * _SPREAD), (above + below - 2.0 * here)
        second /= 2.0 * _SPREAD**2
        scale = 1.0 / np.sqrt(np.abs(here).max(axis=1))
        zero, one, two = (scale[:, None] * part * scale for part in (here, first, second))
        nothing, unit = np.zeros_like(zero), np.eye(len(zero))
        left = np.block([[nothing, unit], [-zero, -one]])
        right = np.block([[unit, nothing], [nothing, two]])
        values, vectors = scipy.linalg.eig(left, right)
        finite = np.isfinite(values)
        return omega * (1.0 + values[finite]), (scale[:, None] * vectors[: len(zero), finite]).T

    def refined(
        self, omega: complex, coordinates: ComplexArray, settled: float = _SETTLED
    ) -> tuple[complex, ComplexArray]:
        """Eigenpair of V^T A(omega) V itself, by Newton's method from one close by.

        That of `eigenpairs` is one of the interpolated factors.  If the iteration does not stay
        close, the start is returned.  It ends where omega changes by no more than ``settled`` of
        itself.  The columns are the first ones, as many as coordinates.
        """
        value, vector, kept = omega, coordinates, slice(len(coordinates))
        for _ in range(_NEWTON_STEPS):
            h = 1e-4 * abs(value)
            here, above, below = (self.at(w)[kept, kept] for w in (value, value + h, value - h))
            slope = (above - below) / (2.0 * h)
            scale = 1.0 / np.sqrt(np.abs(here).max(axis=1))
            y = vector / scale
            y /= np.linalg.norm(y)
            matrix = scale[:, None] * here * scale
            change = scale * (slope @ (scale * y)) * abs(value)
            bordered = np.block([[matrix, change[:, None]], [y.conj()[None], np.zeros((1, 1))]])
            step = np.linalg.solve(bordered, np.append(-(matrix @ y), 0.0))
            value += abs(value) * step[-1]
            vector = scale * (y + step[:-1])
            if abs(value / omega - 1.0) > _SPREAD:
                break
            if abs(step[-1]) <= settled:
                return complex(value), vector
        return omega, coordinates

    def _basis(self, field: int) -> FloatArray:
        """Columns of a field as rows, (count, unknowns of the field)."""
        return self._columns[field][: self._count[field]]

    def _scattered(self, parts: list[AnyArray]) -> AnyArray:
        """Rows of both fields in the order in which the columns entered."""
        whole = np.zeros((self.size, *parts[0].shape[1:]), dtype=np.result_type(*parts))
        for field, part in enumerate(parts):
            whole[self._field == field] = part
        return whole

    def _weighed(self, field: int, rows: FloatArray) -> FloatArray:
        """Rows times the mass of the structure, or as they are."""
        return np.ascontiguousarray((self._mass @ rows.T).T) if field == 0 else rows

    def _new_columns(self, field: int, vector: AnyArray) -> list[FloatArray]:
        """Orthonormal parts of a vector that its field does not hold yet, two at most."""
        complex_valued = np.iscomplexobj(vector)
        parts = np.stack([vector.real, vector.imag] if complex_valued else [vector])
        weighed = self._weighed(field, parts)
        length = np.sqrt(max(float(np.sum(parts * weighed)), 0.0))
        basis, found = self._basis(field), np.zeros((0, parts.shape[1]))
        if length == 0.0:
            return []
        for column, heavy in zip(parts / length, weighed / length, strict=True):
            for known in (basis, found):
                column = column - (known @ heavy) @ known  # noqa: PLW2901
            # once more for what rounding has left
            heavy = self._weighed(field, column[None])[0]  # noqa: PLW2901
            left = float(column @ heavy)
            for known in (basis, found):
                rest = known @ heavy
                column, left = column - rest @ known, left - float(rest @ rest)  # noqa: PLW2901
            if left > _LOST**2:
                found = np.concatenate([found, column[None] / np.sqrt(left)])
        return list(found)

    def _append(self, columns: list[tuple[int, FloatArray]]) -> None:
        """Take columns, each with the number of its field, and their products with all terms."""
        if not columns:
            return
        full = np.zeros((self._operators.size, len(columns)))
        for number, (field, column) in enumerate(columns):
            count = self._count[field]
            if count == len(self._columns[field]):
                room = np.empty((_ROOM, column.size))
                self._columns[field] = np.concatenate([self._columns[field], room])
            self._columns[field][count] = column
            self._count[field] += 1
            full[self._fields[field], number] = column
        old = self.size
        self._field = np.append(self._field, [field for field, _ in columns])
        bases = [self._basis(field) for field in range(len(self._fields))]
        for name, term in self._whole.items():
            rows = self._scattered(term.products(bases, full))
            grown = np.zeros((self.size, self.size))
            grown[:old, :old] = self._terms[name]
            grown[:, old:] = rows
            grown[old:, :old] = rows[:old].T
            self._terms[name] = grown


@dataclass(frozen=True, eq=False)
class _Term:
    """A term without its empty rows, which are most of them in many terms.

    Attributes
    ----------
    matrix : (r, n) csr_matrix
        The other rows; it shares the entries of the term.
    places : tuple of (slice or array, slice or array)
        For each field, which of its unknowns have a row here, and the numbers of these rows.
    """

    matrix: csr_matrix
    places: tuple[tuple[slice | IntArray, slice | IntArray], ...]

    @classmethod
    def of(cls, term: csr_matrix, fields: tuple[IntArray, ...]) -> "_Term":
        """Drop the empty rows of a term and find the others in the fields."""
        filled = np.diff(term.indptr) > 0
        starts = np.append(term.indptr[:-1][filled], term.indptr[-1])
        matrix = csr_matrix(
            (term.data, term.indices, starts), shape=(len(starts) - 1, term.shape[1]), copy=False
        )
        row = np.cumsum(filled) - 1
        places = []
        for unknowns in fields:
            own = filled[unknowns]
            places.append((_run(np.flatnonzero(own)), _run(row[unknowns[own]])))
        return cls(matrix, tuple(places))

    def products(self, bases: list[FloatArray], vectors: FloatArray) -> list[FloatArray]:
        """V^T A X of each field's columns and of vectors (n, m), (count of the field, m)."""
        moved = self.matrix @ vectors
        return [
            np.asarray(basis[:, own] @ moved[rows])
            for basis, (own, rows) in zip(bases, self.places, strict=True)
        ]


def _run(numbers: IntArray) -> slice | IntArray:
    """Numbers without gaps as a slice, which copies nothing."""
    if len(numbers) == 0:
        return slice(0, 0)
    if numbers[-1] - numbers[0] == len(numbers) - 1 and np.all(np.diff(numbers) == 1):
        return slice(int(numbers[0]), int(numbers[-1]) + 1)
    return numbers


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
