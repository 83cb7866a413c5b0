# SPDX-License-Identifier: LGPL-2.1-or-later
"""A command as a user types it, in this process."""

from contextlib import redirect_stderr, redirect_stdout
from io import StringIO

from quietblade.cli.main import execute


def command(*arguments: str) -> tuple[int, str, str]:
    """Exit code, standard output and standard error; an exception is a traceback to the user."""
    out, err = StringIO(), StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        code = execute(arguments)
    return code, out.getvalue(), err.getvalue()
