"""Exceptions become one message and an exit code, for all commands in one place."""

from __future__ import annotations

import os
import sys
from typing import Any

from typer.core import TyperGroup

from ellipsoid_planning.errors import EllipsoidPlanningError
from planners.cli.compiling import telling_of_compilation
from planners.cli.interrupt import INTERRUPTED
from planners.cli.terminal import say

SOLVED = 0
NO_PATH = 1
BAD_INPUT = 2


class CommandGroup(TyperGroup):
    """The commands, with our exceptions turned into messages: no user sees a traceback.

    Mistakes in options are typer's own to report; it, too, exits with 2.
    """

    def invoke(self, ctx: Any) -> Any:
        """Run the chosen command."""
        try:
            with telling_of_compilation():
                return super().invoke(ctx)
        except EllipsoidPlanningError as error:
            say(f"Error: {error}")
            code = BAD_INPUT
        except KeyboardInterrupt:
            say("Interrupted.")
            code = INTERRUPTED
        except BrokenPipeError:
            # Whoever read our output has had enough.
            _discard_output()
            code = NO_PATH
        except OSError as error:
            say(f"Error: cannot write the output: {error.strerror or error}")
            _discard_output()
            code = BAD_INPUT
        raise SystemExit(code)


def _discard_output() -> None:
    # Writing the rest at exit would fail again.
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
