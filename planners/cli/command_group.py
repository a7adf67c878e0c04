"""Exceptions become one message and an exit code, for all commands in one place."""

from __future__ import annotations

from typing import Any

from typer.core import TyperGroup

from ellipsoid_planning.errors import EllipsoidPlanningError
from planners.cli.compiling import telling_of_compilation
from planners.cli.faults import DEBUG, check_address_space, show_traceback, show_tracebacks
from planners.cli.interrupt import INTERRUPTED
from planners.cli.streams import discard_output
from planners.cli.terminal import say

SOLVED = 0
NO_PATH = 1
BAD_INPUT = 2
NO_READER = 141
"""Whoever read the output has left; the shell's code for SIGPIPE."""

_HELP = frozenset({"-h", "--help"})
_LIGHT = frozenset({"scenarios", "schema"})
"""Commands that compile nothing."""


class CommandGroup(TyperGroup):
    """The commands, with our exceptions turned into messages: no user sees a traceback.

    Mistakes in options are typer's own to report; it, too, exits with 2.
    """

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse, with ``--debug`` allowed anywhere before ``--``."""
        end = args.index("--") if "--" in args else len(args)
        if DEBUG in args[:end]:
            show_tracebacks()
            args = [arg for arg in args[:end] if arg != DEBUG] + args[end:]
        return list(super().parse_args(ctx, args))

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Find the chosen command, and check that it has the memory that it will need."""
        name, command, rest = super().resolve_command(ctx, args)
        if name not in _LIGHT and _HELP.isdisjoint(rest):
            check_address_space()
        return name, command, rest

    def invoke(self, ctx: Any) -> Any:
        """Run the chosen command."""
        try:
            with telling_of_compilation():
                return super().invoke(ctx)
        except EllipsoidPlanningError as error:
            show_traceback(error)
            say(f"Error: {error}")
            code = BAD_INPUT
        except KeyboardInterrupt:
            say("Interrupted.")
            code = INTERRUPTED
        except BrokenPipeError:
            discard_output()
            code = NO_READER
        except OSError as error:
            if error.strerror is None:  # libraries use the class for anything
                raise
            show_traceback(error)
            what = "cannot write the output" if error.filename is None else str(error.filename)
            say(f"Error: {what}: {error.strerror}")
            discard_output()
            code = BAD_INPUT
        raise SystemExit(code)
