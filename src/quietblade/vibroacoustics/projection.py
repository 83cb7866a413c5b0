# SPDX-License-Identifier: LGPL-2.1-or-later
"""A(omega) on a small space of real vectors, the fields split."""

from collections.abc import Iterable

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
        self._whole = {name: operators.terms[name] for name in operators.factors(1.0)}
        self._terms = {name: np.zeros((0, 0)) for name in self._whole}
        for unit in np.eye(len(blocks.held)):
            self._append(_HELD, unit)

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
            for field, unknowns in enumerate(self._fields[:_HELD]):
                part = vector[unknowns]
                length = self._length(field, part)
                if length == 0.0:
                    continue
                for column in (part.real, part.imag) if np.iscomplexobj(part) else (part,):
                    new = self._orthonormal(field, column / length)
                    if new is not None:
                        self._append(field, new)

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
        total = np.zeros((self.size, self.size), dtype=complex)
        for name, factor in self._operators.factors(omega).items():
            total += factor * self._terms[name]
        return total

    def eigenpairs(
        self, omega: complex, size: int | None = None
    ) -> tuple[ComplexArray, ComplexArray]:
        """Eigenvalues (m,) and coordinates (m, size) near omega, on the first columns.

        The factors of the terms are interpolated by polynomials of second degree around omega,
        exact for first-order BGT; the quadratic eigenproblem is linearised.
        """
        points = omega * np.array([1.0 - _SPREAD, 1.0, 1.0 + _SPREAD])
        kept = slice(self.size if size is None else size)
        below, here, above = (self.at(point)[kept, kept] for point in points)
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

    def refined(self, omega: complex, coordinates: ComplexArray) -> tuple[complex, ComplexArray]:
        """Eigenpair of V^T A(omega) V itself, by Newton's method from one close by.

        That of `eigenpairs` is one of the interpolated factors.  If the iteration does not stay
        close, the start is returned.
        """
        value, vector = omega, coordinates
        for _ in range(_NEWTON_STEPS):
            here, h = self.at(value), 1e-4 * abs(value)
            slope = (self.at(value + h) - self.at(value - h)) / (2.0 * h)
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
            if abs(step[-1]) <= _SETTLED:
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

    def _weighed(self, field: int, vector: FloatArray) -> FloatArray:
        return np.asarray(self._mass @ vector) if field == 0 else vector

    def _orthonormal(self, field: int, vector: FloatArray) -> FloatArray | None:
        """Part of a vector that is new, with unit length; None if there is none."""
        basis = self._basis(field)
        for _ in range(2):  # once more for what rounding has left
            vector = vector - (basis @ self._weighed(field, vector)) @ basis
        left = self._length(field, vector)
        return vector / left if left > _LOST else None

    def _length(self, field: int, vector: AnyArray) -> float:
        parts = (vector.real, vector.imag) if np.iscomplexobj(vector) else (vector,)
        return float(np.sqrt(max(sum(p @ self._weighed(field, p) for p in parts), 0.0)))

    def _append(self, field: int, column: FloatArray) -> None:
        count = self._count[field]
        if count == len(self._columns[field]):
            room = np.empty((_ROOM, column.size))
            self._columns[field] = np.concatenate([self._columns[field], room])
        self._columns[field][count] = column
        self._count[field] += 1
        self._field = np.append(self._field, field)
        full = np.zeros(self._operators.size)
        full[self._fields[field]] = column
        for name, old in self._terms.items():
            row = self.restricted(np.asarray(self._whole[name] @ full))
            grown = np.zeros((self.size, self.size))
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
