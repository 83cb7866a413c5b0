# SPDX-License-Identifier: LGPL-2.1-or-later
"""The folder of a run."""

from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from quietblade.results import dataset
from quietblade.results.files import ResultError, remove_leftovers, replacing, write_text
from quietblade.results.headline import summarise
from quietblade.results.model import Result
from quietblade.results.tables import as_text, summary_tables


@dataclass(frozen=True)
class RunFolder:
    """Where the parts of a run are.

    Attributes
    ----------
    root : Path
        The folder; ``result.nc`` is written last, so that a folder that has it is whole.
    """

    root: Path

    @property
    def result(self) -> Path:
        """``result.nc``."""
        return self.root / "result.nc"

    @property
    def summary(self) -> Path:
        """``summary.txt``."""
        return self.root / "summary.txt"

    @property
    def case(self) -> Path:
        """``case.toml``, a copy of the case file."""
        return self.root / "case.toml"

    @property
    def figures(self) -> Path:
        """Folder of the pictures."""
        return self.root / "figures"

    @property
    def stages(self) -> Path:
        """Folder of what the stages of a run have made, for the next run."""
        return self.root / "stages"

    @property
    def log(self) -> Path:
        """``run.log``: what was done when, in this run and those before it."""
        return self.root / "run.log"

    @property
    def static_fields(self) -> Path:
        """Solid in C0 with displacement, film shear strain and pressure."""
        return self.root / "fields" / "static.vtu"

    @property
    def mesh_fields(self) -> Path:
        """Solid of a body that is no blade, which has no steady load, and its excited parts."""
        return self.root / "fields" / "mesh.vtu"

    def mode_fields(self, configuration: str) -> Path:
        """Solid in one configuration with its wet mode shapes."""
        return self.root / "fields" / f"modes-{configuration}.vtu"

    def response_fields(self, configuration: str) -> Path:
        """Solid and water in one configuration with response and sound pressure at peaks."""
        return self.root / "fields" / f"response-{configuration}.vtu"

    def save(self, result: Result) -> None:
        """Write result, summary and case file."""
        write_text(self.case, result.run.case_text)
        summary = summarise(result)
        write_text(self.summary, as_text(summary.title, summary_tables(summary)))
        with replacing(self.result) as temporary:
            dataset.write(dataset.to_tree(result), temporary)

    def tidy(self) -> None:
        """Remove what killed runs have left half-written; no other run may be at work."""
        for place in (self.root, self.figures, self.static_fields.parent):
            remove_leftovers(place)

    def overtaken(self) -> bool:
        """Whether a later run has been at work in the folder and has not finished."""
        if not self.result.is_file():
            return False
        made = self.result.stat().st_mtime
        return any(file.stat().st_mtime > made for file in self.stages.glob("*.json"))

    def load(self) -> Result:
        """Read the result.

        Raises
        ------
        ResultError
            There is none, or it cannot be read.
        """
        if not self.result.is_file():
            raise ResultError(
                f"{self.root}: no result.nc here; give the folder of a finished run, or make one "
                "with `quietblade run CASE.toml`"
            )
        try:
            return dataset.from_tree(dataset.read(self.result))
        except ResultError as error:
            raise ResultError(f"{self.result}: {error}") from error


def load(folder: str | PathLike[str]) -> Result:
    """Read the result of a run from its folder.

    Raises
    ------
    ResultError
        There is none, or it cannot be read.
    """
    return RunFolder(Path(folder)).load()
