"""Runner of one node: loads it, runs it, and turns its end into an exit code."""

from __future__ import annotations

import ast
import contextlib
import gc
import os
import re
import signal
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType, TracebackType
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.cli.shared.output import complain, say, tell
from robolink.exceptions import (
    ExternalShutdownException,
    InterruptedByUser,
    NotFoundError,
    RobolinkError,
    nearest,
)
from robolink.signals import SignalHandlerOptions, get_current_signal_handlers_options
from robolink.supervisor.processes.lifeline import watch_lifeline
from robolink.system.files import LONGEST_SOURCE, read_plain
from robolink.text.suggestions import LackingNameError
from robolink.text.tracebacks import formatted
from robolink.workspace import (
    VARIABLE,
    NodeLoadError,
    NodeSource,
    RosProgramError,
    built_in_workspace,
    canonical,
    executable_of,
    find_launch,
    find_node,
    find_package,
    find_world,
    instead_of,
    lacking_executable,
    list_executables,
    list_nodes,
    list_packages,
    load_node,
    named_executables,
    program,
    program_names,
    programs_of,
    unmarked_package,
    user_workspace,
    workspace_of,
)
from robolink.workspace.load import check_needs_nothing, make_node, runs_itself

if TYPE_CHECKING:
    from robolink.node import Node

INTERRUPTED, TERMINATED = 130, 143
_ASSIGNED = ("xacro",)
"""Programs whose own arguments are `NAME:=VALUE`."""
_PACKAGE = str(Path(__file__).resolve().parents[2])
_COUNTERPARTS = str(Path(_PACKAGE, "counterparts"))


class NodeCommand(NamedTuple):
    """Words of `robolink run`: the node, the words after it, and how many of these may name an executable."""

    node: str
    words: list[str]
    before: int = 0
    """Number of the words that came before `--`."""


def run(command: NodeCommand, ros_args: list[str], workspace: str | None) -> int:
    """Run a node until it ends, and return the exit code.

    That is 0 for a Node class that Ctrl-C or SIGTERM ended, since nothing went wrong. A script decides itself;
    when it lets the interrupt pass, it is 130 or 143, as shells count. An exception in the user's code is shown
    with its traceback, from the user's code on, and gives 1.
    """
    source, args = found(command, workspace)
    settle(source, workspace)
    take_names()
    pass_over_imports()
    terminated = prepare()  # so late: a Ctrl-C that a launcher held back may break into no import of ours
    sys.argv = [str(source.path or source.name), *args, *ros_args]
    return outcome(lambda: _start(source, args), terminated)


def prepare() -> list[int]:
    """Make this process end with its launcher, and on SIGTERM; return a list that gets an entry at a SIGTERM."""
    if sys.platform == "win32":
        signal.signal(signal.SIGBREAK, signal.default_int_handler)  # what a launcher sends there
    watch_lifeline()
    return _note_termination()


def outcome(act: Callable[[], Any], terminated: list[int]) -> int:
    """Run the user's code, print its error if there is one, and return the exit code as `run` does."""
    try:
        return _exit_code(act)
    except (KeyboardInterrupt, ExternalShutdownException):
        return TERMINATED if terminated else INTERRUPTED
    except LackingNameError as error:
        _show(error)
        return 1
    except RobolinkError as error:
        return complain(error, place=_place(error))
    except Exception as error:  # noqa: BLE001 - it is the user's, and they want to see where
        if isinstance(error, ImportError):
            from robolink.image.opencv import lacking

            if lack := lacking(error):
                return complain(lack)
        _show(error)
        return 1


def found(command: NodeCommand, workspace: str | None) -> tuple[NodeSource, list[str]]:
    """Return the node to run and the program's own arguments.

    Two words that name a package and an executable of it are that, also those of ROS 2's own packages that robolink
    has; else the first is a node's name or file, and the second is the program's. Raises NotFoundError.
    """
    name, words = command.node, command.words
    folder = find_package(name, workspace=workspace) if canonical(name).isidentifier() else None
    if command.before > 0:
        source = executable_of(name, words[0], folder)
        if source is not None:
            if folder is not None and (folder / "setup.py").is_file() and source.module and not source.attribute:
                _tell_of_unnamed(source)
            return source, words[1:]
    try:
        return find_node(name, workspace=workspace), words
    except NotFoundError:
        alone = program(name, name)  # rviz2 and rqt are programs, and packages
        if alone is not None and folder is None:
            return alone, words
        requested = words[0] if command.before > 0 else ""
        error = _lacking(name, requested, folder, workspace)
        if error is None:
            raise
        raise error from None


def _tell_of_unnamed(source: NodeSource) -> None:
    """Warn of a program that is found by its file alone: on a robot, `ros2 run` knows only what setup.py names."""
    entry = f"'{source.name} = {source.module}:main'"
    complain(f"setup.py does not name '{source.name}', so ROS 2 will not find it: add {entry} to its console_scripts")


def _lacking(name: str, requested: str, folder: Path | None, workspace: str | None) -> RobolinkError | None:
    """Return the error for a name that is not a node's; None if there is nothing to add to that.

    `requested` is the word after it, '' if there is none; `folder` is that of the user's own package of this name.
    """
    if not canonical(name).isidentifier():
        return _other_kind(name, workspace)
    if folder is None and not requested and not programs_of(name) and (advice := instead_of(name)):
        return RosProgramError(name, "", advice)
    known = [*(each.name for each in (named_executables(folder) if folder is not None else ())), *programs_of(name)]
    if requested:
        error = lacking_executable(name, requested, folder) or (None if folder else _neither(name, workspace))
        return error or _other_kind(name, workspace)
    if not known:
        return _other_kind(name, workspace)
    return NodeLoadError(f"{name} is a package: say which of its executables, {' or '.join(known)}")


def _other_kind(name: str, workspace: str | None) -> RobolinkError | None:
    other = _meant_command(name, workspace)
    return NodeLoadError(f"'{name}' is {other}") if other else None


def _meant_command(name: str, workspace: str | None) -> str:
    """Return the other thing that a name stands for, with the command for it; an empty text if it is unknown."""
    with contextlib.suppress(NotFoundError):
        if not _is_world(find_launch(name, workspace=workspace)):
            return f"a launch file, and no node: robolink launch {name}"
    with contextlib.suppress(NotFoundError):
        find_world(name, workspace=workspace)
        return f"a world, and no node: robolink run world -p world:={name}"
    return ""


def _is_world(path: Path) -> bool:
    """True for a file of a world, by its folder or its first keys: it need not be right for this."""
    with contextlib.suppress(OSError, ValueError):
        text = read_plain(path, LONGEST_SOURCE).decode("utf-8", errors="replace")
        keys = re.findall(r"^(\w+):", text, re.MULTILINE)
        return path.parent.name == "worlds" or ("robots" in keys and "nodes" not in keys)
    return False


def _neither(name: str, workspace: str | None) -> NotFoundError:
    """Return the error for the first of two words that is neither a node nor a package."""
    home = user_workspace(workspace)
    nodes = (each.name for each in list_nodes(workspace=workspace))
    known = [*nodes, *list_packages(workspace=workspace), *program_names()]
    error = NotFoundError("node or package", name, known, "" if home is None else str(home))
    unmarked = unmarked_package(name, Path() if home is None else home)
    if unmarked is not None:
        advice = f"the folder {unmarked} has no package.xml, by which a package is known: add one, or run a file of it"
        error.args = (f"{error}: {advice}",)
    elif home is None and not nearest(name, known):
        advice = "this folder is in no workspace; go to the one with its src/, or name it with --workspace"
        error.args = (f"{error}: {advice}",)
    return error


def show_nodes(workspace: str | None) -> None:
    """Print a line for each node: its name, after its package's if it has one, and the first line of its docstring."""
    from robolink.cli.shared.layout import aligned

    rows = [(each.name, each) for each in list_nodes(workspace=workspace)]
    shown = {each.path for _, each in rows}
    for package, nodes in list_executables(workspace=workspace).items():
        rows += [(f"{package} {each.name}", each) for each in nodes if each.path not in shown]
    for line in aligned([(name, _purpose(each)) for name, each in rows]):
        say(line)


def spin(node_class: Callable[[], Node]) -> None:
    """Run a Node class until its context ends."""
    import robolink

    # Exit code 0 after Ctrl-C, as of rclpy's usual main(); a script decides itself.
    with robolink.init(), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        if runs_itself(node_class):
            from robolink.experimental.program import run_node  # late: with asyncio

            return run_node(lambda: make_node(node_class))
        node = make_node(node_class)
        try:
            robolink.spin(node)
        finally:
            node.destroy_node()


def take_names() -> None:
    """Make the names rclpy and those of its companions stand for robolink, for the program that is run."""
    from robolink import compat  # late: its import takes names already

    if compat.activate(compat.ALWAYS):
        compat.prepare_opencv()


def pass_over_imports() -> None:
    """Import what every node uses, and exclude it from garbage collection.

    Without that the interpreter's end looks through all modules, several times: a third of a node's processor time.
    What the user's code makes is made after this, and is collected as ever.
    """
    from robolink import node, spinning  # noqa: F401

    gc.freeze()
    gc.enable()


def prepare_types() -> None:
    """Make what each node makes of the types that all nodes have: their hashes, and the encoders of what they send."""
    from robolink.interfaces.rcl_interfaces import msg, srv
    from robolink.interfaces.type_description_interfaces.srv import GetTypeDescription
    from robolink.message import type_hash
    from robolink.message.cdr import encoder

    for each in (msg.Log, msg.ParameterEvent):
        encoder(each)
        type_hash(each)
    of_parameters = (srv.DescribeParameters, srv.GetParameters, srv.GetParameterTypes, srv.ListParameters)
    for service in (*of_parameters, srv.SetParameters, srv.SetParametersAtomically, GetTypeDescription):
        type_hash(service)


def _note_termination() -> list[int]:
    """Return a list that gets an entry at a SIGTERM, which otherwise acts as before."""
    noted: list[int] = []

    def note(number: int, frame: FrameType | None) -> None:
        noted.append(number)
        if SignalHandlerOptions.SIGTERM in get_current_signal_handlers_options():
            raise InterruptedByUser
        signal.signal(number, signal.SIG_DFL)
        signal.raise_signal(number)

    signal.signal(signal.SIGTERM, note)
    return noted


def _start(source: NodeSource, args: list[str]) -> Any:
    found = load_node(source)
    if source.name not in _ASSIGNED:
        _tell_of_unread(args, nobody_reads=isinstance(found, type))
    if isinstance(found, type):
        return spin(found)
    check_needs_nothing(found)
    return found()


def _tell_of_unread(args: list[str], *, nobody_reads: bool) -> None:
    """Warn of words without effect: parameters without `-p`, and any for a Node class, which is not a program."""
    for each in args:
        if ":=" in each:
            complain(f"'{each}' does nothing without an option: -p {each} sets a parameter, -r renames")
        elif nobody_reads:
            complain(f"nobody reads '{each}': what a node shall know is a parameter, as in -p NAME:=VALUE")


def _exit_code(act: Callable[[], Any]) -> int:
    """Return the exit code that Python would give to `sys.exit(act())`."""
    try:
        result = act()
    except SystemExit as error:
        result = error.code
    if result is None or isinstance(result, int):
        return result or 0
    tell(str(result))
    return 1


def settle(source: NodeSource, workspace: str | None) -> None:
    """Set the environment's workspace to the node's own, in which it then looks up names."""
    home = user_workspace(workspace)
    if home is None:
        home = workspace_of(source.path.parent)
    if home is not None:
        os.environ[VARIABLE] = str(home)


LONGEST_LISTED = 200_000
"""Upper bound of a file whose docstring is listed, in bytes: to parse it takes 600 times as much memory."""


def _purpose(source: NodeSource) -> str:
    """Return the first line of a file's docstring."""
    try:
        text = ast.get_docstring(ast.parse(read_plain(source.path, LONGEST_LISTED)))
    except (OSError, SyntaxError, ValueError, RecursionError, MemoryError):
        return "(cannot be read)"
    return (text or "").partition("\n")[0]


def _show(error: Exception) -> None:
    """Print a traceback that begins in the user's code."""
    trace = error.__traceback__
    while trace is not None and is_ours(trace):
        trace = trace.tb_next
    if isinstance(error, LackingNameError):
        _end_in_users_code(trace)
    tell(formatted(error, trace), colours=True)


def _end_in_users_code(trace: TracebackType | None) -> None:
    """Cut the end of a traceback, which is robolink's own search for a name: the error says what it found."""
    last = trace
    while trace is not None:
        last, trace = last if is_ours(trace) else trace, trace.tb_next
    if last is not None:
        last.tb_next = None


def _place(error: Exception) -> str:
    """Return the line of the user's code that called what failed, as ``file:line``; '' if there is none."""
    place, trace = "", error.__traceback__
    while trace is not None and trace.tb_next is not None:
        file = trace.tb_frame.f_code.co_filename
        # Parsers written in C have frames with the path of their source on the machine where Python was built.
        is_source = file.endswith((".py", ".pyw")) or Path(file).is_file()
        if is_source and not _is_built_in(file) and not is_ours(trace) and is_ours(trace.tb_next):
            place = f"{file}:{trace.tb_lineno}"
        trace = trace.tb_next
    return place


def _is_built_in(file: str) -> bool:
    """True if a file is one of a node that comes with robolink."""
    return file.startswith((str(built_in_workspace() / "nodes"), _COUNTERPARTS))


def is_ours(trace: TracebackType) -> bool:
    """True if a frame is robolink's own or Python's import machinery, and not of a built-in node."""
    file = trace.tb_frame.f_code.co_filename
    is_node = _is_built_in(file)
    is_python = Path(file).name == "runpy.py" or Path(file).parent.name == "importlib"
    return not is_node and (file.startswith(("<frozen", _PACKAGE)) or is_python)
