# SPDX-License-Identifier: LGPL-2.1-or-later
"""Alternative models of one blade beside each other: modes and peaks of each, mode by mode."""

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from quietblade.results import dataset
from quietblade.results.files import ResultError, replacing
from quietblade.results.record import Record
from quietblade.typing import FloatArray


@dataclass(frozen=True, eq=False, repr=False)
class AlternativeTable(Record):
    """Wet modes and peaks of the sound power of several models; the first one is the reference.

    Columns are the modes of the reference; each row has those that are most like them. What a
    model does not have is NaN.
    """

    group: ClassVar[str] = "alternatives"
    title: str
    name: tuple[str, ...]
    description: tuple[str, ...]
    mode: tuple[str, ...]
    frequency: FloatArray
    loss_factor: FloatArray
    assurance: FloatArray
    peak_frequency: FloatArray
    peak_level: FloatArray
    mean_level: FloatArray
    element_size: float
    content_key: str

    def row(self, name: str) -> int:
        """Row of an alternative.

        Raises
        ------
        ValueError
            There is none of this name.
        """
        if name not in self.name:
            raise ValueError(f"no alternative {name!r}; there are {', '.join(self.name)}")
        return self.name.index(name)

    def save(self, path: Path) -> None:
        """Write the table as netCDF."""
        with replacing(path) as temporary:
            dataset.write(dataset.record_tree(self), temporary)

    @classmethod
    def load(cls, path: Path) -> "AlternativeTable":
        """Read a table.

        Raises
        ------
        ResultError
            There is none, or it cannot be read.
        """
        if not path.is_file():
            raise ResultError(f"{path}: there is no such table of alternatives")
        try:
            return dataset.read_record(cls, dataset.read(path))
        except ResultError as error:
            raise ResultError(f"{path}: {error}") from error
