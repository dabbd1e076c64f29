"""The command line: a file for each noun, a short function for each verb. `main` is where errors become lines."""

from __future__ import annotations

import codecs
import contextlib
import io
import os
import sys
from collections.abc import Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from robolink.cli.hashing import begin_steadily
from robolink.cli.interrupts import not_lost
from robolink.exceptions import NameValidationException, RobolinkError, shown

if TYPE_CHECKING:
    from robolink.interfaces import Source

COMPLETION = "_ROBOLINK_COMPLETE"
"""The variable in which a shell says that it wants to know how to go on."""

LONGEST_LINE = 2000
"""Characters of an error that are shown: an argument that it names can be as long as a file."""


def main(args: Sequence[str] | None = None) -> int:
    """Run a command; give the exit code: 1 after an error, 2 after wrong usage, 130 after Ctrl-C.

    A `RobolinkError` and wrong usage become one line on stderr; any other exception is a bug, and passes. Without
    `args` the process is the command's own, and ends here where that saves the time to close a session.
    """
    given = sys.argv[1:] if args is None else list(args)
    if args is None:
        try:
            if not os.environ.get(COMPLETION):
                begin_steadily(given)
        except KeyboardInterrupt:
            return 130
        _open_closed_streams()
        _write_any_letter()
        with not_lost():
            return _main(given, ends_here=True)
    return _main(given, ends_here=False)


def _main(given: list[str], *, ends_here: bool) -> int:
    if os.environ.get(COMPLETION):
        code = _complete(given)
        if ends_here:
            _end(code)
        return code
    try:
        code = _outcome(given)
        if ends_here and _has_open_looks():
            _end(code)
        return code
    finally:
        if _has_open_looks():
            sys.modules["robolink.cli.session"].close_looks()


def complain(error: object, code: int = 1, place: str = "") -> int:
    """Print one line on stderr, with the place that is to blame if it is known; give the exit code."""
    if isinstance(error, NameValidationException):  # its text has a line for the caret
        error = f"invalid {error.name_type} '{error.name[:200]}': {error.error_msg} (at index {error.invalid_index})"
    text = " ".join(str(error).split("\n"))
    if len(text) > LONGEST_LINE:
        text = f"{text[: LONGEST_LINE // 2]} ... {text[-LONGEST_LINE // 4 :]}"
    line = shown(text, len(text))
    at = f" (at {place})" if place else ""
    print(f"robolink: {line}{at}", file=sys.stderr)  # noqa: T201 - this is what the user is told
    return code


def _open_closed_streams() -> None:
    """Let standard streams that whoever started us has closed lead nowhere: other files would get their numbers."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            with contextlib.suppress(OSError):
                opened = os.open(os.devnull, os.O_WRONLY if number else os.O_RDONLY)  # gets the lowest number: this one
                os.set_inheritable(opened, True)
                setattr(sys, name, os.fdopen(opened, "w" if number else "r", closefd=False))


def _write_any_letter() -> None:
    """Have standard output take letters that its encoding has not (ASCII, cp1252 behind a pipe on Windows), escaped."""
    codecs.register_error("robolink", _escaped)
    reconfigure = getattr(sys.stdout, "reconfigure", None)  # None stands for an output that is closed
    if reconfigure is not None:
        reconfigure(errors="robolink")


def _escaped(error: UnicodeError) -> tuple[str, int]:
    r"""Write characters as \uXXXX, two for those beyond 16 bits: what JSON reads back."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    units = error.object[error.start : error.end].encode("utf-16-be", "surrogatepass").hex()
    return "".join(f"\\u{units[at : at + 4]}" for at in range(0, len(units), 4)), error.end


def _outcome(args: list[str]) -> int:
    try:
        code = _run(args)
        if sys.stdout is not None:
            sys.stdout.flush()
    except RobolinkError as error:
        return complain(error)
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        _drop_output()
        return 141
    except OSError as error:  # a full disk behind standard output, say
        _drop_output()
        return complain(error)
    return code


def _drop_output() -> None:
    """Write what is left to write; drop what cannot be written, or Python would complain of it at the exit."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _complete(args: list[str]) -> int:
    """Answer the shell. An error or a warning would stand in the middle of what is being typed: there is none."""
    os.environ.pop("RUST_LOG", None)
    try:
        with contextlib.redirect_stderr(io.StringIO()):
            return _run(args)
    except SystemExit as answered:  # what typer ends with
        return answered.code if isinstance(answered.code, int) else 0
    except (Exception, KeyboardInterrupt):  # noqa: BLE001
        return 1


def _has_open_looks() -> bool:
    session = sys.modules.get("robolink.cli.session")
    return session is not None and session.any_looks()


def _end(code: int) -> None:
    """End the process without closing what is open: see `robolink.cli.session.looking`."""
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):  # closed, or None
            stream.flush()
    os._exit(code)


def _run(args: list[str]) -> int:
    from robolink.cli.shortcut import shortcut
    from robolink.interfaces import add_source

    add_source(_OF_WORKSPACE)
    short = None if os.environ.get(COMPLETION) else shortcut(args)
    return _parsed(args) if short is None else short()


def _parsed(args: list[str]) -> int:
    import typer

    from robolink.cli.root import command

    usage_error: type[Exception] = next(each for each in typer.BadParameter.__mro__ if each.__name__ == "UsageError")
    try:
        code = command().main(args, prog_name="robolink", standalone_mode=False)
    except usage_error as error:  # typer exports it only under its subclass, and moved it when it took click in
        return _explain(error)
    return code if isinstance(code, int) else 0


class _WorkspaceTypes:
    """The types of the workspace; what finds them is imported when one is asked for."""

    def names(self, kind: str) -> Mapping[str, Collection[str]]:
        """Give the types of a kind that there are."""
        return self._source().names(kind)

    def get(self, package: str, kind: str, short: str) -> type[Any] | None:
        """Give the class of a type."""
        return self._source().get(package, kind, short)

    def _source(self) -> Source:
        from robolink.workspace.interfaces import WORKSPACE_TYPES

        return WORKSPACE_TYPES


_OF_WORKSPACE = _WorkspaceTypes()


def _explain(error: Exception) -> int:
    """Say what is wrong with the usage; a noun without a verb gets its whole help."""
    if os.environ.get(COMPLETION):
        return 1
    if type(error).__name__ == "NoArgsIsHelpError":
        print(error, file=sys.stderr)  # noqa: T201
        return 2
    context = getattr(error, "ctx", None)
    hint = f" (see '{context.command_path} --help')" if context is not None else ""
    text = str(getattr(error, "format_message", lambda: error)())
    return complain(text.rstrip(".") + hint, 2)
