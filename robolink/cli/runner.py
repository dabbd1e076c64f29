"""What `robolink run` does: load a node, run it, and end quietly."""

from __future__ import annotations

import ast
import contextlib
import os
import signal
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from types import FrameType, TracebackType
from typing import TYPE_CHECKING, Any

from robolink.exceptions import ExternalShutdownException, InterruptedByUser, RobolinkError
from robolink.signals import SignalHandlerOptions, get_current_signal_handlers_options
from robolink.supervisor import watch_lifeline
from robolink.workspace import (
    VARIABLE,
    NodeLoadError,
    NodeSource,
    built_in_workspace,
    find_node,
    list_nodes,
    load_node,
    user_workspace,
    workspace_of,
)

if TYPE_CHECKING:
    from robolink.node import Node

INTERRUPTED, TERMINATED = 130, 143
_PACKAGE = str(Path(__file__).resolve().parent.parent)


def run(node: str, args: list[str], ros_args: list[str], workspace: str | None) -> int:
    """Run a node until it ends; give the exit code.

    That is 0 for a Node class that Ctrl-C or SIGTERM ended, since nothing went wrong. A script decides itself;
    when it lets the interrupt pass, it is 130 or 143, as shells count. An exception in the user's code is shown
    with its traceback, from the user's code on, and gives 1.
    """
    if sys.platform == "win32":
        signal.signal(signal.SIGBREAK, signal.default_int_handler)  # what a launcher sends there
    watch_lifeline()
    terminated = _note_termination()
    source = find_node(node, workspace=workspace)
    _settle(source, workspace)
    sys.argv = [str(source.path or source.name), *args, *ros_args]
    try:
        return _exit_code(lambda: _start(source))
    except (KeyboardInterrupt, ExternalShutdownException):
        return TERMINATED if terminated else INTERRUPTED
    except RobolinkError:
        raise
    except Exception as error:  # noqa: BLE001 - it is the user's, and they want to see where
        _show(error)
        return 1


def show_nodes(workspace: str | None) -> None:
    """Print each node's name and what its file says of it."""
    nodes = list_nodes(workspace=workspace)
    width = max((len(each.name) for each in nodes), default=0)
    for each in nodes:
        print(f"{each.name:<{width}}  {_purpose(each)}".rstrip())  # noqa: T201


def spin(node_class: Callable[[], Node]) -> None:
    """Run a Node class until its context ends."""
    import robolink

    with robolink.init(), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = node_class()
        if not hasattr(node, "_owner"):
            name = type(node).__name__
            raise NodeLoadError(f"{name}.__init__ must call super().__init__('{name.lower()}') before all else")
        try:
            robolink.spin(node)
        finally:
            node.destroy_node()


def _note_termination() -> list[int]:
    """Give a list that a SIGTERM is noted in; otherwise it does what it does without us."""
    noted: list[int] = []

    def note(number: int, frame: FrameType | None) -> None:
        noted.append(number)
        if SignalHandlerOptions.SIGTERM in get_current_signal_handlers_options():
            raise InterruptedByUser
        signal.signal(number, signal.SIG_DFL)
        signal.raise_signal(number)

    signal.signal(signal.SIGTERM, note)
    return noted


def _start(source: NodeSource) -> Any:
    found = load_node(source)
    return spin(found) if isinstance(found, type) else found()


def _exit_code(act: Callable[[], Any]) -> int:
    """Give the exit code that Python would give to `sys.exit(act())`."""
    try:
        result = act()
    except SystemExit as error:
        result = error.code
    if result is None or isinstance(result, int):
        return result or 0
    print(result, file=sys.stderr)  # noqa: T201
    return 1


def _settle(source: NodeSource, workspace: str | None) -> None:
    """Let what the node looks up by name be found in the same workspace as the node."""
    home = user_workspace(workspace)
    if home is None and source.path is not None:
        home = workspace_of(source.path.parent)
    if home is not None:
        os.environ[VARIABLE] = str(home)


def _purpose(source: NodeSource) -> str:
    """Give the first line of a file's docstring."""
    if source.path is None:
        return str(source.entry_point.value) if source.entry_point else ""
    try:
        text = ast.get_docstring(ast.parse(source.path.read_bytes()))
    except (OSError, SyntaxError, ValueError):
        return "(cannot be read)"
    return (text or "").partition("\n")[0]


def _show(error: Exception) -> None:
    """Print a traceback that begins in the user's code, unless the executor has logged it."""
    if getattr(error, "__robolink_logged__", False):
        return
    trace = error.__traceback__
    while trace is not None and _is_ours(trace):
        trace = trace.tb_next
    traceback.print_exception(type(error), error, trace or error.__traceback__)


def _is_ours(trace: TracebackType) -> bool:
    file = trace.tb_frame.f_code.co_filename
    is_node = file.startswith(str(built_in_workspace() / "nodes"))
    return not is_node and (file.startswith(("<frozen", _PACKAGE)) or Path(file).name == "runpy.py")
