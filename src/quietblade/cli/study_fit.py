# SPDX-License-Identifier: LGPL-2.1-or-later
"""``quietblade study --calibrate`` and ``--sensitivities``."""

from dataclasses import asdict
from pathlib import Path

from quietblade.case.study_calibration import Calibration
from quietblade.cli.common import ExitCode, console, error_console, show_json
from quietblade.cli.progress import ProgressDisplay
from quietblade.cli.tables import show_tables
from quietblade.study.calibration import calibrate
from quietblade.study.fitting import write_fitted, write_sensitivities
from quietblade.study.sensitivity import sensitivities


def fit(
    file: Path, folder: Path, reading: str, *, search: bool, quiet: bool, as_json: bool
) -> ExitCode:
    """Run a calibration file: its search, or its sensitivities."""
    words = Calibration.load(file)
    settled = True
    with ProgressDisplay(error_console if as_json else console, quiet=quiet) as progress:
        if search:
            fitted = calibrate(words, folder, reading, progress=progress)
            tables, settled = write_fitted(words, fitted, folder), fitted.settled
        else:
            found = sensitivities(words, folder, progress=progress)
            tables = write_sensitivities(words, found, folder)
    if as_json:
        show_json({"settled": settled, "tables": [asdict(table) for table in tables]})
    elif not quiet:
        show_tables(words.title or file.stem, tables)
        console.print(f"files: {folder}", markup=False)
    return ExitCode.DONE if settled else ExitCode.NOT_CONVERGED
