# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the stages of a run have made, kept in its folder for the next run.

Two files a stage: ``modes-C1.json`` says from what the result was made, in which time, and which
file holds it; ``modes-C1-<key>.pickle`` is that file.  The first is written after the second is
whole, and the older ones go after that: a run that is killed at any moment leaves the stage either
as it was or as it is now.

Arrays and plain records are pickled.  What they refer to but what is made faster than it is read
(finite elements, the structure's forms) is left out and made again.  Reading makes nothing but
classes of quietblade, NumPy and SciPy: a folder from somebody else cannot run code.
"""

import hashlib
import json
import pickle
import shutil
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, fields, is_dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeAlias

from quietblade.results.files import replacing, write_text
from quietblade.study.stages import Origin

Makers: TypeAlias = Mapping[type, Callable[[], Any]]
"""How to make again, by class, what is not stored with a result."""

_PROTOCOL = 5
_FORMAT = 1
_ARRAYS = {
    ("numpy", "dtype"),
    ("numpy", "ndarray"),
    ("numpy._core.multiarray", "_reconstruct"),
    ("numpy._core.multiarray", "scalar"),
    ("numpy._core.numeric", "_frombuffer"),
    ("builtins", "complex"),
    ("builtins", "frozenset"),
    ("builtins", "range"),
    ("builtins", "set"),
    ("builtins", "slice"),
    ("quietblade.study.keeping", "_frozen"),
    ("quietblade.study.keeping", "_record"),
}

_ROOMS = ("quietblade.", "scipy.sparse.")


class DamagedError(Exception):
    """The file of a result is not what was written, or cannot be read."""


@dataclass(frozen=True)
class Lap:
    """What one stage cost.

    Attributes
    ----------
    seconds : float
        Wall-clock time, of the run that computed it [s].
    memory : float
        Largest memory of the process until its end [B]; nan where the system does not tell.
    kept : bool
        Whether it comes from an earlier run.
    """

    seconds: float
    memory: float
    kept: bool = False


@dataclass(frozen=True)
class Kept:
    """What is known of a kept result: from what it was made, and what that cost."""

    origin: Origin
    lap: Lap


class StageStore:
    """The folder of the kept results, one a stage.

    Parameters
    ----------
    folder : Path
        Made when the first result is kept.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def known(self, stage: str) -> Kept | None:
        """Say from what the kept result of a stage was made; None if there is none."""
        with suppress(OSError, ValueError, TypeError, KeyError):
            card = json.loads(self._card(stage).read_text(encoding="utf-8"))
            if card["format"] == _FORMAT:
                lap = Lap(float(card["seconds"]), float(card["memory"]), kept=True)
                return Kept(Origin(**card["origin"]), lap)
        return None

    def read(self, stage: str, makers: Makers) -> Any:
        """Read the kept result of a stage.

        Raises
        ------
        DamagedError
            The file is missing, or is not what was written.
        """
        try:
            card = json.loads(self._card(stage).read_text(encoding="utf-8"))
            with self._content(stage, card["key"]).open("rb") as file:
                if hashlib.file_digest(file, "sha256").hexdigest() != card["sha256"]:
                    raise DamagedError("its content is not what was written")
                file.seek(0)
                return _Reader(file, makers).load()
        except OSError as error:
            raise DamagedError(error.strerror or str(error)) from error
        except (pickle.UnpicklingError, EOFError, AttributeError, LookupError, TypeError) as error:
            raise DamagedError(f"cannot be read: {error}") from error

    def keep(self, stage: str, origin: Origin, lap: Lap, result: Any, makers: Makers) -> None:
        """Keep the result of a stage in the place of an older one."""
        content = self._content(stage, origin.key)
        with replacing(content) as temporary:
            with temporary.open("wb") as file:
                _Writer(file, makers).dump(result)
            with temporary.open("rb") as file:
                digest = hashlib.file_digest(file, "sha256").hexdigest()
        card = {
            "format": _FORMAT,
            "key": origin.key,
            "sha256": digest,
            "seconds": lap.seconds,
            "memory": lap.memory,
            "origin": asdict(origin),
        }
        write_text(self._card(stage), json.dumps(card, indent=1) + "\n")
        self._remove(f"{_file_name(stage)}-*.pickle", but=content)

    def borrow(self, other: Path) -> None:
        """Take over what another run's folder of stages has and this one lacks.

        What does not fit the case is found out when it is asked for, as after any change.
        """
        for card in other.glob("*.json"):
            content = next(other.glob(f"{card.stem}-*.pickle"), None)
            if content is None or (self._folder / card.name).exists():
                continue
            self._folder.mkdir(parents=True, exist_ok=True)
            _take(content, self._folder / content.name)
            _take(card, self._folder / card.name)

    def tidy(self, stages: Iterable[str]) -> None:
        """Remove what killed runs have left half-written, and results of stages there are not."""
        self._remove(".*")
        wanted = {_file_name(stage) for stage in stages}
        for card in self._folder.glob("*.json"):
            if card.stem not in wanted:
                card.unlink(missing_ok=True)
                self._remove(f"{card.stem}-*.pickle")

    def _card(self, stage: str) -> Path:
        return self._folder / f"{_file_name(stage)}.json"

    def _content(self, stage: str, key: str) -> Path:
        return self._folder / f"{_file_name(stage)}-{key[:16]}.pickle"

    def _remove(self, pattern: str, but: Path | None = None) -> None:
        for file in self._folder.glob(pattern):
            if file != but:
                file.unlink(missing_ok=True)


def _take(file: Path, place: Path) -> None:
    """Have a file in two places, without a second copy where the file system can do that."""
    with suppress(FileExistsError):
        try:
            place.hardlink_to(file)
        except (OSError, NotImplementedError) as error:
            if isinstance(error, FileExistsError):
                raise
            shutil.copy2(file, place)


def _file_name(stage: str) -> str:
    return stage.replace(" ", "-")


def _record(cls: type, values: Mapping[str, Any]) -> Any:
    """Make a record of its attributes as they were, without its checks and its cache."""
    record: Any = object.__new__(cls)
    for name, value in values.items():
        object.__setattr__(record, name, value)
    return record


def _frozen(values: dict[Any, Any]) -> Mapping[Any, Any]:
    return MappingProxyType(values)


class _Writer(pickle.Pickler):
    """Leaves out what is made again, and what records have cached."""

    def __init__(self, file: Any, makers: Makers) -> None:
        super().__init__(file, _PROTOCOL)
        self._makers = makers

    def persistent_id(self, obj: Any) -> str | None:
        return type(obj).__name__ if type(obj) in self._makers else None

    def reducer_override(self, obj: Any) -> Any:
        if is_dataclass(obj) and not isinstance(obj, type):
            values = {field.name: getattr(obj, field.name) for field in fields(obj)}
            return _record, (type(obj), values)
        if isinstance(obj, MappingProxyType):
            return _frozen, (dict(obj),)
        return NotImplemented


class _Reader(pickle.Unpickler):
    """Makes arrays, sparse matrices and objects of quietblade, and nothing else."""

    def __init__(self, file: Any, makers: Makers) -> None:
        super().__init__(file)
        self._makers = {cls.__name__: make for cls, make in makers.items()}
        self._made: dict[str, Any] = {}

    def persistent_load(self, pid: str) -> Any:
        if pid not in self._made:
            self._made[pid] = self._makers[pid]()
        return self._made[pid]

    def find_class(self, module: str, name: str) -> Any:
        if (module, name) in _ARRAYS:
            return super().find_class(module, name)
        if module.startswith(_ROOMS) and "." not in name:
            found = super().find_class(module, name)
            if isinstance(found, type) and found.__module__ == module:
                return found
        raise pickle.UnpicklingError(f"{module}.{name} has no place in a result")
