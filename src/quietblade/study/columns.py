# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files of numbers that a case names: columns with titles, separated by commas."""

from pathlib import Path

import numpy as np

from quietblade.typing import AnyArray


def read_columns(file: Path, *known: tuple[str, ...]) -> AnyArray:
    """Read a file whose titles are one of the known sets.

    Returns
    -------
    (n,) structured array
        A field a column; nan where an entry is missing or is not a number.

    Raises
    ------
    ValueError
        The titles are other ones, or rows differ in length.
    OSError
        It cannot be read.
    """
    table = np.genfromtxt(file, delimiter=",", names=True, encoding="utf-8", ndmin=1)
    titles = table.dtype.names or ()
    if titles not in known:
        raise ValueError(f"the columns are {', '.join(titles) or 'unnamed'}")
    return table
