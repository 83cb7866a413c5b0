# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the user says: case files with units, read into one frozen object."""

from os import PathLike
from pathlib import Path

from quietblade.case.body import BodyCase
from quietblade.case.common import AnyCase
from quietblade.case.model import Case
from quietblade.case.problems import InvalidCaseError, Problem
from quietblade.case.source import Finding, Source, parse_source, read_source

__all__ = [
    "AnyCase",
    "BodyCase",
    "Case",
    "Finding",
    "InvalidCaseError",
    "Problem",
    "load_case",
    "parse_case",
]


def load_case(path: str | PathLike[str]) -> Case | BodyCase:
    """Read a case file, of a blade or of another body.

    Raises
    ------
    InvalidCaseError
        Lists every problem with file, line, key, value and remedy.
    """
    return _made(read_source(Path(path)))


def parse_case(text: str, name: str = "case.toml") -> Case | BodyCase:
    """Read the text of a case file; ``name`` stands for it in messages.

    Raises
    ------
    InvalidCaseError
        Lists every problem with file, line, key, value and remedy.
    """
    return _made(parse_source(text, name))


def _made(source: Source) -> Case | BodyCase:
    if "body" in source.data and "blade" not in source.data:
        return BodyCase.from_source(source)
    return Case.from_source(source)
