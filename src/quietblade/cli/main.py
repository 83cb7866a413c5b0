# SPDX-License-Identifier: LGPL-2.1-or-later
"""The ``quietblade`` command. A command's module is imported when it is asked for."""

import sys
from collections.abc import Sequence
from difflib import get_close_matches
from importlib import import_module
from importlib.util import find_spec
from typing import Annotated, Any, cast

import typer
from typer.core import TyperGroup
from typer.main import get_command

from quietblade import __version__
from quietblade.cli.common import (
    EXIT_CODES,
    ExitCode,
    StoppedError,
    failure,
    show_error,
    show_json,
    show_stop,
)
from quietblade.errors import CaseError, QuietbladeError

COMMANDS = (
    "new", "check", "run", "show", "plot", "report", "compare", "cite", "study", "section",
    "export", "materials", "doctor",
)  # fmt: skip
"""Each is the function of the same name in the module of the same name."""

# its base is the usage error of the click that typer carries, wherever that is
_UsageError = cast(type[typer.BadParameter], typer.BadParameter.__mro__[1])


class CommandGroup(TyperGroup):
    """Commands that are imported one by one, so that help and mistakes cost nothing."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Name the commands in the order of a study."""
        return [name for name in COMMANDS if find_spec(f"quietblade.cli.{name}")]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Import a command."""
        known = self.list_commands(ctx)
        if cmd_name not in known:
            near = get_close_matches(cmd_name, known, n=1)
            hint = f' Did you mean "{near[0]}"?' if near else ""
            ctx.fail(f'there is no command "{cmd_name}".{hint} Known: {", ".join(known)}')
        if cmd_name not in self.commands:
            function = getattr(import_module(f"quietblade.cli.{cmd_name}"), cmd_name)
            single = typer.Typer(add_completion=False)
            single.command(cmd_name)(function)
            self.commands[cmd_name] = get_command(single)
        return self.commands[cmd_name]


app = typer.Typer(
    name="quietblade",
    epilog=EXIT_CODES,
    cls=CommandGroup,
    add_completion=True,
    pretty_exceptions_enable=False,
)


def _show_version(wanted: bool) -> None:
    if wanted:
        sys.stdout.write(f"quietblade {__version__}\n")
        raise typer.Exit


@app.callback()
def _quietblade(
    version: Annotated[
        bool,
        typer.Option(
            "--version", help="Show the version and exit.", callback=_show_version, is_eager=True
        ),
    ] = False,
) -> None:
    """Flexible propeller blades in water: deformation, wet modes and radiated sound."""


def execute(arguments: Sequence[str]) -> int:
    """Run one command and return its exit code.

    With ``--json`` standard output is one JSON value, whether the command ends well or not.
    """
    as_json = "--json" in arguments
    try:
        ended = get_command(app).main(
            list(arguments) or ["--help"], prog_name="quietblade", standalone_mode=False
        )
    except StoppedError as stop:
        return show_stop(str(stop), as_json=as_json)
    except (QuietbladeError, OSError, MemoryError) as error:
        return show_error(_told(error), as_json=as_json)
    except _UsageError as error:
        error.show()
        if as_json:
            show_json(failure(CaseError(error.format_message()), ExitCode.CASE_WRONG))
        return ExitCode.CASE_WRONG
    except (typer.Abort, KeyboardInterrupt):
        ended = ExitCode.STOPPED
    if ended == ExitCode.STOPPED:  # typer makes it of Ctrl-C
        return show_stop("stopped", as_json=as_json)
    return int(ended) if isinstance(ended, int) else ExitCode.DONE


def _told(error: Exception) -> QuietbladeError:
    """Say in one line what the system has refused."""
    match error:
        case QuietbladeError():
            return error
        case OSError():
            place = f"{error.filename}: " if error.filename else ""
            return QuietbladeError(f"{place}{error.strerror or error}")
    remedy = "use larger cells (mesh.size) or a smaller sphere (acoustics.sphere_radius)"
    return QuietbladeError(f"not enough memory; {remedy}")


def run() -> None:
    """Entry point of the console script."""
    sys.exit(execute(sys.argv[1:]))


if __name__ == "__main__":
    run()
