# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the user says: case files with units, read into one frozen object."""

from quietblade.case.model import Case
from quietblade.case.problems import InvalidCaseError, Problem
from quietblade.case.source import Finding

__all__ = ["Case", "Finding", "InvalidCaseError", "Problem"]
