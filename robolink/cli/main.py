"""Entry point of the command line: runs a command, and turns its errors into one line and an exit code."""

from __future__ import annotations

import codecs
import contextlib
import gc
import importlib
import io
import os
import sys
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink.cli.launching.hashing import begin_steadily, is_simulation
from robolink.cli.shared.output import complain
from robolink.cli.shared.process import OTHER_NAMES, not_lost
from robolink.documents.foreign import in_a_line
from robolink.exceptions import ExternalShutdownException, NotInitializedException, RobolinkError
from robolink.system import exit_code

if TYPE_CHECKING:
    from robolink.interfaces import Source

COMPLETION = "_ROBOLINK_COMPLETE"
"""Environment variable by which a shell asks for completions."""


def main(args: Sequence[str] | None = None) -> int:
    """Run a command and return the exit code: 1 after an error, 2 after wrong usage, 130 after Ctrl-C.

    A `RobolinkError` and wrong usage become one line on stderr; any other exception is a bug, and is not caught.

    Args:
        args: The words after `robolink`; None takes those of the process, which then may end here, without returning,
            if that saves the time to close a session.
    """
    given = sys.argv[1:] if args is None else list(args)
    if args is None:
        name = Path(sys.argv[0]).name.removesuffix(".exe")
        if name in OTHER_NAMES:
            code: int = importlib.import_module(OTHER_NAMES[name]).main(given)
            return code
        try:
            if not os.environ.get(COMPLETION):
                begin_steadily(given)
                if is_simulation(given):
                    gc.disable()  # there is nothing to collect while modules are imported; the command enables it
        except KeyboardInterrupt:
            return 130
        _open_closed_streams()
        _write_any_letter()
        with not_lost():
            code = _main(given, ends_here=True)
        exit_code.note(code)
        return code
    return _main(given, ends_here=False)


def _main(given: list[str], *, ends_here: bool) -> int:
    if os.environ.get(COMPLETION):
        code = _complete(given)
        if ends_here:
            _end(code)
        return code
    try:
        with in_a_line():
            code = _outcome(given)
        if ends_here and _has_open_looks():
            _end(code)
        return code
    finally:
        if _has_open_looks():
            sys.modules["robolink.cli.shared.session"].close_looks()


def _open_closed_streams() -> None:
    """Open the null device for standard streams that were closed at the start: other files would get their numbers."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            with contextlib.suppress(OSError):
                opened = os.open(os.devnull, os.O_WRONLY if number else os.O_RDONLY)  # gets the lowest number: this one
                os.set_inheritable(opened, True)
                setattr(sys, name, os.fdopen(opened, "w" if number else "r", closefd=False))


def _write_any_letter() -> None:
    """Make standard output escape letters that its encoding lacks (ASCII, cp1252 behind a pipe on Windows)."""
    codecs.register_error("robolink", _escaped)
    reconfigure = getattr(sys.stdout, "reconfigure", None)  # None stands for an output that is closed
    if reconfigure is not None:
        reconfigure(errors="robolink")


def _escaped(error: UnicodeError) -> tuple[str, int]:
    r"""Return characters as \uXXXX, two of them beyond 16 bits (surrogates), which JSON reads back."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    units = error.object[error.start : error.end].encode("utf-16-be", "surrogatepass").hex()
    return "".join(f"\\u{units[at : at + 4]}" for at in range(0, len(units), 4)), error.end


def _outcome(args: list[str]) -> int:
    try:
        code = _run(args)
        if sys.stdout is not None:
            sys.stdout.flush()
    except (KeyboardInterrupt, ExternalShutdownException):  # the second is what SIGTERM ends a spin with
        return 130
    except RobolinkError as error:
        if isinstance(error, NotInitializedException) and error.by_signal:  # it came before the spin that it would end
            return 130
        return complain(error)
    except BrokenPipeError:
        _drop_output()
        return 141
    except OSError as error:  # a full disk behind standard output, say
        _drop_output()
        return complain(error)
    return code


def _drop_output() -> None:
    """Flush standard output; drop what cannot be written, of which Python would complain at the exit."""
    try:
        if sys.stdout is not None:
            sys.stdout.flush()
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _complete(args: list[str]) -> int:
    """Answer the shell, without any error or warning: it would stand in the middle of what is being typed."""
    os.environ.pop("RUST_LOG", None)
    try:
        with contextlib.redirect_stderr(io.StringIO()), _answering_bash():
            return _run(args)
    except SystemExit as answered:  # what typer ends with
        return answered.code if isinstance(answered.code, int) else 0
    except (Exception, KeyboardInterrupt):  # noqa: BLE001
        return 1


@contextlib.contextmanager
def _answering_bash() -> Iterator[None]:
    """Context in which bash's parts of `NAME:=VALUE` are one word, and the answer is the part that bash replaces."""
    from robolink.cli.shared.complete import joined_for_bash

    words, at, prefix = os.environ.get("COMP_WORDS", ""), os.environ.get("COMP_CWORD", ""), ""
    if os.environ.get(COMPLETION) == "complete_bash" and at.isdecimal():
        words, number, prefix = joined_for_bash(words, int(at))
    if not prefix:
        yield
        return
    os.environ.update(COMP_WORDS=words, COMP_CWORD=str(number))
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said):
            yield
    finally:
        sys.stdout.write("".join(each.removeprefix(prefix) for each in said.getvalue().splitlines(keepends=True)))


def _has_open_looks() -> bool:
    session = sys.modules.get("robolink.cli.shared.session")
    return session is not None and session.any_looks()


def _end(code: int) -> None:
    """End the process without closing its sessions: see `robolink.cli.shared.session.looking`.

    Those on DDS do say goodbye: else others show the command's node for 20 s.
    """
    if (lifetime := sys.modules.get("robolink.transport.lifetime")) is not None:
        lifetime.say_goodbye()
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):  # closed, or None
            stream.flush()
    os._exit(code)


def _run(args: list[str]) -> int:
    from robolink.cli.running_nodes.shortcut import shortcut
    from robolink.interfaces import add_source

    add_source(_OF_WORKSPACE)
    if os.environ.get(COMPLETION):
        return _parsed(args)
    if args == ["topic", "list"]:  # the most usual command: typer is a quarter of its time
        from robolink.cli.topic.listing import list_topics

        list_topics()
        return 0
    short = shortcut(args)
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
    """Source of the workspace's types, imported when the first one is looked up."""

    def names(self, kind: str) -> Mapping[str, Collection[str]]:
        """Return the names of the types of a kind, "msg", "srv" or "action", by package."""
        return self._source().names(kind)

    def get(self, package: str, kind: str, short: str) -> type[Any] | None:
        """Return the class of a type; None if the workspace has no such type."""
        return self._source().get(package, kind, short)

    def _source(self) -> Source:
        from robolink.workspace.interfaces import WORKSPACE_TYPES

        return WORKSPACE_TYPES


_OF_WORKSPACE = _WorkspaceTypes()


def _explain(error: Exception) -> int:
    """Print the error of the usage, or the whole help of a noun without a verb; return the exit code."""
    if os.environ.get(COMPLETION):
        return 1
    if type(error).__name__ == "NoArgsIsHelpError":
        print(error, file=sys.stderr)  # noqa: T201
        return 2
    context = getattr(error, "ctx", None)
    hint = f" (see '{context.command_path} --help')" if context is not None else ""
    text = str(getattr(error, "format_message", lambda: error)())
    if context is not None and getattr(error, "option_name", "") == "--network":
        hint = (
            f" (for all commands it comes first: robolink --network NET {context.command_path.partition(' ')[2]} ...)"
        )
    return complain(text.rstrip(".") + hint, 2)
