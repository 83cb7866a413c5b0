# SPDX-License-Identifier: LGPL-2.1-or-later
"""Records: frozen groups of registered quantities that check themselves when they are made."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from quietblade.card import Card, Shown
from quietblade.results.quantities import LABELS, QUANTITIES, Kind, Quantity
from quietblade.typing import AnyArray

if TYPE_CHECKING:
    import xarray as xr

_DTYPES: dict[Kind, type[np.generic]] = {
    "real": np.float64,
    "complex": np.complex128,
    "integer": np.int64,
    "flag": np.bool_,
    "text": np.str_,
}

_FEW = 3
_LONG = 60
"""Values, and characters of a text, that are shown rather than counted."""


@dataclass(frozen=True, eq=False, repr=False)
class Record(Shown):
    """Base of the records: one attribute a registered quantity, one record a group.

    Arrays are copied and made read-only. Attributes that are properties are derived: they are
    stored with the others and not read back.

    Raises
    ------
    ValueError
        A value does not have its registered dimensions, or two of them disagree on a length.
    """

    group: ClassVar[str]

    def __post_init__(self) -> None:
        lengths: dict[str, int] = {name: len(labels) for name, labels in LABELS.items()}
        for field in fields(self):
            quantity = QUANTITIES.get(f"{self.group}/{field.name}".lstrip("/"))
            if quantity is None:
                continue
            array = as_array(quantity, getattr(self, field.name))
            _check_lengths(quantity, array, lengths)
            object.__setattr__(self, field.name, _as_value(quantity, array))

    @classmethod
    def quantities(cls) -> Iterator[Quantity]:
        """Return the registered quantities of the record, in the order of the register."""
        return (q for q in QUANTITIES.values() if q.group == cls.group)

    @classmethod
    def stored(cls) -> tuple[str, ...]:
        """Names of the quantities that are attributes, not derived."""
        names = {field.name for field in fields(cls)}
        return tuple(q.name for q in cls.quantities() if q.name in names)

    def card(self) -> Card:
        """Show what the record holds, with units; long arrays by their dimensions."""
        rows = [
            (q.name, _shown(q, array), q.label, q.description)
            for q, array in zip(self.quantities(), self.arrays().values(), strict=True)
        ]
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, Record):
                rows.append((field.name, "record", "", _first_line(value)))
            elif isinstance(value, Mapping):
                rows += [(f"{field.name}[{key!r}]", "record", "", _first_line(inner))
                         for key, inner in value.items()]  # fmt: skip
        columns = ("name", "value", "unit", "meaning")
        return Card(f"{type(self).__name__}: {_first_line(self)}", tuple(rows), columns)

    def to_xarray(self) -> "xr.DataTree":
        """Return labelled arrays with the unit and meaning of every variable."""
        from quietblade.results.dataset import record_tree  # noqa: PLC0415  # which imports records

        return record_tree(self)

    def arrays(self) -> Mapping[str, AnyArray]:
        """Every registered quantity, derived ones too, as an array with its dimensions."""
        return {q.name: as_array(q, getattr(self, q.name)) for q in self.quantities()}


def as_array(quantity: Quantity, value: Any) -> AnyArray:
    """Convert a value to the type that is registered for it (always a copy).

    Raises
    ------
    ValueError
        The value is of another type, or has another number of dimensions.
    """
    given = np.asarray(value)
    dtype = _DTYPES[quantity.kind]
    text = quantity.kind == "text"
    fits = given.dtype.kind == "U" if text else np.can_cast(given.dtype, dtype, "same_kind")
    if given.size and not fits:  # an empty list has no type of its own
        raise ValueError(
            f"{quantity.group}/{quantity.name}: values of type {given.dtype}, "
            f"registered as {quantity.kind}"
        )
    if given.ndim != len(quantity.dims):
        raise ValueError(
            f"{quantity.group}/{quantity.name}: shape {given.shape}, registered with dimensions "
            f"({', '.join(quantity.dims)})"
        )
    return np.array(given, dtype=given.dtype if text and given.size else dtype)


def _shown(quantity: Quantity, array: AnyArray) -> str:
    if quantity.dims and (array.size > _FEW or quantity.kind == "text"):
        sizes = zip(quantity.dims, array.shape, strict=True)
        return " x ".join(f"{dim} ({size})" for dim, size in sizes)
    texts = [f"{v:.5g}" if array.dtype.kind in "fc" else str(v) for v in array.ravel()]
    line = ", ".join(texts) or "none"
    return line if len(line) <= _LONG and "\n" not in line else f"{len(line)} characters"


def _first_line(record: object) -> str:
    return (type(record).__doc__ or "").partition("\n")[0].rstrip(".")


def _check_lengths(quantity: Quantity, array: AnyArray, lengths: dict[str, int]) -> None:
    for dim, length in zip(quantity.dims, array.shape, strict=True):
        if lengths.setdefault(dim, length) != length:
            raise ValueError(
                f"{quantity.group}/{quantity.name}: {length} values along {dim!r}, "
                f"expected {lengths[dim]}"
            )


def _as_value(quantity: Quantity, array: AnyArray) -> Any:
    if not quantity.dims:
        return array.item()
    if quantity.kind == "text":
        return tuple(str(text) for text in array)
    array.flags.writeable = False
    return array
