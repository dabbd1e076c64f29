"""The command line: a file for each noun, a short function for each verb. `main` is where errors become lines."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from robolink.exceptions import NameValidationException, RobolinkError


def main(args: Sequence[str] | None = None) -> int:
    """Run a command; give the exit code: 1 after an error, 2 after wrong usage, 130 after Ctrl-C.

    A `RobolinkError` and wrong usage become one line on stderr; any other exception is a bug, and passes.
    """
    try:
        code = _run(sys.argv[1:] if args is None else list(args))
        if sys.stdout is not None:
            sys.stdout.flush()
    except RobolinkError as error:
        return complain(error)
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # for the flush at exit
        return 141
    except OSError as error:  # a full disk behind standard output, say
        return complain(error)
    return code


def complain(error: object, code: int = 1) -> int:
    """Print one line on stderr; give the exit code."""
    if isinstance(error, NameValidationException):  # its text has a line for the caret
        error = f"invalid {error.name_type} '{error.name[:200]}': {error.error_msg} (at index {error.invalid_index})"
    line = " ".join(str(error).split("\n"))
    print(f"robolink: {line}", file=sys.stderr)  # noqa: T201 - this is what the user is told
    return code


def _run(args: list[str]) -> int:
    import typer

    from robolink.cli.root import command

    usage_error: type[Exception] = next(each for each in typer.BadParameter.__mro__ if each.__name__ == "UsageError")
    try:
        code = command().main(args, prog_name="robolink", standalone_mode=False)
    except usage_error as error:  # typer exports it only under its subclass, and moved it when it took click in
        return _explain(error)
    return code if isinstance(code, int) else 0


def _explain(error: Exception) -> int:
    """Say what is wrong with the usage; a noun without a verb gets its whole help."""
    if type(error).__name__ == "NoArgsIsHelpError":
        print(error, file=sys.stderr)  # noqa: T201
        return 2
    context = getattr(error, "ctx", None)
    hint = f" (see '{context.command_path} --help')" if context is not None else ""
    text = str(getattr(error, "format_message", lambda: error)())
    return complain(text.rstrip(".") + hint, 2)
