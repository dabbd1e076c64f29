"""Entries of a ROS 2 launch file: each Node and ExecuteProcess action becomes what robolink's launcher starts."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePath
from typing import Any, NamedTuple

from robolink.arguments.remapping import parse_remap_rule
from robolink.exceptions import DocumentError, NameValidationException
from robolink.launch.entry import Entry, NodeToStart, OnExit, Respawn
from robolink.launch.lookup import command_of, source_of
from robolink.launch.ros.launch.actions import ExecuteLocal, Shutdown
from robolink.launch.ros.launch.bases import LaunchContext, LaunchError, Place, Substitution
from robolink.launch.ros.launch.utilities import boolean, performed
from robolink.launch.ros.launch_ros.components import ComposableNodeContainer, LoadComposableNodes
from robolink.launch.ros.launch_ros.descriptions import ComposableNode
from robolink.launch.ros.launch_ros.node import Node, note_name
from robolink.launch.ros.launch_ros.settings import NAMESPACE, REMAPS
from robolink.launch.ros.launch_ros.utilities import make_namespace_absolute, prefix_namespace
from robolink.launch.ros.programs import Program, component_of, parameters_of, program_of, texts_of
from robolink.supervisor.policy import NO_LIMIT
from robolink.system.processes import SHELL, own_command, split_words
from robolink.system.terminal import shown
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name
from robolink.workspace import NodeSource

TERMINALS = ("xterm", "gnome-terminal", "konsole", "lxterminal", "xfce4-terminal", "terminator", "x-terminal-emulator")
"""Programs that launch files put before nodes that read the keyboard."""
SHORTEST_DELAY = 0.1
"""Shortest time before a process is started again, in s: one that fails at once would be restarted for ever at one
moment of virtual time, and would take a core in real time."""
_PYTHON = re.compile(r"python[\d.]*(?:\.exe)?")


class Naming(NamedTuple):
    """Name of a node, '' for that of its program, and its namespace, '' or with a slash in front."""

    name: str
    namespace: str


class Requested(NamedTuple):
    """Node that a launch file requests: its program, and what is said of it."""

    program: Program
    what: str
    """Name of its executable, or of its plugin."""
    naming: Naming
    parameters: Iterable[Any]
    remappings: Iterable[Any]
    place: Place
    is_full: bool
    """True if the launch file gives it a name and a namespace."""

    @property
    def full_name(self) -> str:
        """Full name of the node; if it is not given a name, that of its program."""
        return f"{self.naming.namespace}/{self.naming.name or _default_name(self.program, self.what)}"


@dataclass
class EntryMaker:
    """Makes entries of actions; names that several have get a number.

    Args:
        home: Workspace in which packages are looked for, None for none.
        say: Called with a line for people about what is left out.
    """

    home: Path | None
    say: Callable[[str], object]
    files: frozenset[Path] = frozenset()
    """Launch files that have been read so far."""
    has_keyboard: bool = False
    """True once a node reads the keyboard: only one can."""
    _names: set[str] = field(default_factory=set)

    def make(self, action: ExecuteLocal, context: LaunchContext) -> Entry | None:
        """Return the entry of an action that starts a process; None, with a line, for one that cannot run here.

        Raises LaunchError, and NotFoundError with the nearest name.
        """
        if isinstance(action, Node):
            return self._node(action, context)
        return self._command(action, context)

    # Nodes

    def _node(self, action: Node, context: LaunchContext) -> Entry | None:
        package = None if action.node_package is None else performed(context, action.node_package)
        executable = performed(context, action.node_executable)
        arguments = list(texts_of(action.arguments, context))
        if package is None:
            executable, arguments = _script_of(executable, arguments)
        program = self._program(package, executable, action.place)
        if program.absent:
            self._leave_out(action, program.absent)
            return None
        name = "" if action.requested_name is None else performed(context, action.requested_name)
        naming = Naming(name, namespace_of(action.requested_namespace, context))
        is_full = action.is_node_name_fully_specified()
        requested = Requested(program, executable, naming, action.parameters, action.remappings, action.place, is_full)
        action.expanded_name = requested.full_name
        action.process_description.settle([executable, *arguments], context)
        action.describe_process()
        words = list(texts_of(action.ros_arguments, context))
        entry = self._entry_of(requested, [words, *arguments], self._shared(action, context), context)
        return entry if program.source is not None else _compiled(entry, program.path)

    def shared(self, requested: Requested, action: ExecuteLocal, process: str, context: LaunchContext) -> Entry:
        """Return the entry of a component that shares a process.

        Args:
            requested: The component.
            action: Action of its container, whose settings it has.
            process: Name of the process.
            context: The context with whose values it is performed.
        """
        if action.process_details is None:
            action.process_description.settle([process], context)
            action.describe_process()
        settings = self._shared(action, context)
        settings.pop("prefix", None)
        return self._entry_of(requested, [[]], {**settings, "process": process}, context)

    def _entry_of(
        self, requested: Requested, words: Sequence[Any], settings: Mapping[str, Any], context: LaunchContext
    ) -> Entry:
        """Return the entry of a node; the first of `words` are those behind `--ros-args`."""
        name, namespace = requested.naming
        if name:
            _check(validate_node_name, name)
        place, source = requested.place, requested.program.source

        def say(text: str) -> None:
            self.say(f"{placed(place)}{text}")

        own = parameters_of(
            requested.parameters, requested.full_name, bool(name), context, say, is_full=requested.is_full
        )
        of_ros, *others = words
        extra = [*own.words, *of_ros]
        node = NodeToStart(
            node=requested.what if source is None else source.spec,
            name=name,
            namespace=namespace,
            parameters=own.values if source is not None else own.without_children(),
            remappings=_remappings(requested.remappings, context),
            args=[*(["--ros-args", *extra, "--"] if extra else []), *others],
            **settings,
        )
        return self._entry(place, requested.full_name, node, source, own.wide, own.files)

    def _program(self, package: str | None, executable: str, place: Place) -> Program:
        if package is not None:
            return program_of(package, executable, self.home)
        path = Path(executable)
        if path.suffix == ".py" or path.is_file():
            folder = Path(place.file).parent if place.file else Path()
            return Program(source=source_of(executable, self.home, folder))
        if shutil.which(executable) is None:
            return Program(absent=f"no program '{shown(executable)}' is on the PATH")
        return Program(path=executable)

    # Commands

    def _command(self, action: ExecuteLocal, context: LaunchContext) -> Entry | None:
        described = action.process_description
        words = described.final_words
        if not words or not words[0].strip():
            raise LaunchError("cmd has no program")
        if action.shell:
            run, words = _in_shell(" ".join(words)), " ".join(words).split()
        else:
            words = [*split_words(words[0]), *words[1:]] if len(words) == 1 else words
            found = _command_line(words, context)
            if found is None:
                self._leave_out(action, f"no program '{shown(words[0])}' is on the PATH")
                return None
            run = found
        settings = self._shared(action, context)
        run = [*settings.pop("prefix", ()), *run]
        name = performed(context, described.name) if described.name is not None else _stem(words)
        return self._entry(action.place, f"/{name}", NodeToStart(run=run, **settings), None, frozenset(), [])

    # Both

    def _entry(
        self,
        place: Place,
        full_name: str,
        node: NodeToStart,
        source: NodeSource | None,
        wide: frozenset[str],
        files: Iterable[Path],
    ) -> Entry:
        name = self.free(full_name.strip("/") or "process")
        return Entry(name, node, source, self.home, _errors_at(place), wide, self.files | set(files))

    def free(self, name: str) -> str:
        """Return a name that no process has yet: this one, or with a number."""
        number, free = 1, name
        while free in self._names:
            number += 1
            free = f"{name}-{number}"
        self._names.add(free)
        return free

    def _shared(self, action: ExecuteLocal, context: LaunchContext) -> dict[str, Any]:
        """Return the settings of a process, of nodes and commands alike."""
        described = action.process_description
        settings: dict[str, Any] = {
            "env": {**context.changed_environment(), **described.final_variables},
            "cwd": described.final_cwd or "",
            "respawn": _respawn(action, context),
            "on_exit": _on_exit(action),
        }
        words = described.final_prefix
        if words and shutil.which(words[0]) is not None:
            settings["prefix"] = words
        elif words and PurePath(words[0]).name in TERMINALS and not self.has_keyboard:
            settings["interactive"] = self.has_keyboard = True
            self._note(action, f"'{shown(words[0])}' is not installed: the keyboard of this terminal is read instead")
        elif words:
            self._note(action, f"the prefix '{shown(words[0])}' is left out: no such program is on the PATH")
        return settings

    def _leave_out(self, action: ExecuteLocal, reason: str) -> None:
        self._note(action, f"left out: {reason}")

    def _note(self, action: ExecuteLocal, text: str) -> None:
        self.say(f"{placed(action.place)}{text}")


def namespace_of(given: Any, context: LaunchContext) -> str:
    """Return the namespace of a node within those around it, '' or with a slash in front; `given` is its own or None.

    Raises LaunchError for one that is invalid.
    """
    around = context.launch_configurations.get(NAMESPACE)
    whole = make_namespace_absolute(prefix_namespace(around, None if given is None else performed(context, given)))
    if whole in (None, "/"):
        return ""
    assert whole is not None
    _check(validate_namespace, whole)
    return whole


def placed(place: Place) -> str:
    """Return a place as the beginning of a line, `robot.launch.py:12: `; '' for an unknown one."""
    return f"{Path(place.file).name}:{place.line}: " if place.line else ""


def _errors_at(place: Place) -> Callable[[Sequence[str | int], str, bool], DocumentError]:
    return lambda steps, message, key: DocumentError(message, place.file, place.line)


def _check(validate: Callable[[str], object], name: str) -> None:
    try:
        validate(name)
    except NameValidationException as error:
        raise LaunchError(f"'{shown(name)}' {error.error_msg}") from None


def _default_name(program: Program, executable: str) -> str:
    stem = program.source.name if program.source is not None else PurePath(executable).stem
    return re.sub(r"\W", "_", stem)


def _stem(words: Sequence[str]) -> str:
    """Return a name for a command: that of its program, or of the script that Python runs."""
    name = PurePath(words[0]).stem or words[0]
    script = next((each for each in words[1:] if each.endswith(".py")), None)
    return PurePath(script).stem if script and _PYTHON.fullmatch(name) else name


def _compiled(entry: Entry, path: str) -> Entry:
    """Return the entry of a compiled node: a command that gets what the launcher gives a node."""
    from robolink.launch.planning import arguments

    words = list(arguments(entry))
    return replace(entry, node=NodeToStart(run=[path, *words], env=entry.node.env, cwd=entry.node.cwd))


def _command_line(words: list[str], context: LaunchContext) -> list[str] | None:
    """Return the command line of a command; `ros2` is robolink's own, wherever it is installed."""
    name = PurePath(words[0]).name
    if name in ("ros2", "robolink"):
        return [*own_command(), *words[1:]]
    at = _script_at(words)
    if at is not None:  # under plain Python it would find no rclpy
        return [*own_command(), "run", words[at], "--", *words[at + 1 :]]
    return command_of(words, context.environment.get("PATH"))


def _script_at(words: Sequence[str]) -> int | None:
    """Return which word is the Python file that a command runs, by its name or behind `python3` and its flags."""
    at = 0
    if _PYTHON.fullmatch(PurePath(words[0]).name):
        at = next((n for n, each in enumerate(words) if n and each not in ("-u", "-B", "-O")), 0)
    return at if words[at].endswith(".py") and Path(words[at]).is_file() else None


def _script_of(executable: str, arguments: list[str]) -> tuple[str, list[str]]:
    """Return a node's executable and arguments; where that is Python with a file, the file and what is behind it."""
    at = _script_at([executable, *arguments])
    return (arguments[at - 1], arguments[at:]) if at else (executable, arguments)


def _in_shell(line: str) -> list[str]:
    """Return the words by which a shell runs a line; a command `ros2` in it is robolink's own."""
    if sys.platform == "win32":
        own = subprocess.list2cmdline(own_command())
        return [*SHELL, re.sub(r"^\s*ros2(?=\s|$)", lambda _: own, line)]
    return ["/bin/sh", "-c", f'ros2() {{ {shlex.join(own_command())} "$@"; }}\n{line}']


def _remappings(given: Iterable[Any], context: LaunchContext) -> dict[str, str]:
    """Return the remappings of a node: those of SetRemap count more, and the first of a name."""
    pairs = list(context.launch_configurations.get(REMAPS, []))
    for each in given:
        if isinstance(each, Substitution):
            performed(context, each)  # one of a module that is not here says so
        if not isinstance(each, (tuple, list)) or len(each) != 2:
            raise LaunchError(f"a remapping is a pair of two names, got {shown(repr(each))}")
        pairs.append((performed(context, each[0]), performed(context, each[1])))
    found: dict[str, str] = {}
    for match, replacement in pairs:
        try:
            parse_remap_rule(f"{match}:={replacement}")
        except ValueError as error:
            raise LaunchError(f"remapping '{shown(match)}' to '{shown(replacement)}': {error}") from None
        found.setdefault(match, replacement)
    return found


def _respawn(action: ExecuteLocal, context: LaunchContext) -> Respawn:
    if not boolean(context, action.respawn):
        return Respawn(when="never")
    text = "0" if action.respawn_delay is None else "".join(texts_of([action.respawn_delay], context))
    try:
        delay = float(text)
    except ValueError:
        raise LaunchError(f"respawn_delay is a number of seconds, got '{shown(text)}'") from None
    if not 0.0 <= delay < 1e9:
        raise LaunchError(f"respawn_delay is a number of seconds from 0 on, got {text:.60}")
    most = action.respawn_max_retries
    if most == 0:
        return Respawn(when="never")
    delay = max(delay, SHORTEST_DELAY)
    return Respawn("always", delay, delay, NO_LIMIT if most < 0 else most, float(NO_LIMIT))


def _on_exit(action: ExecuteLocal) -> OnExit:
    return "shutdown" if ends_launch(action.on_exit) else "ignore"


def ends_launch(on_exit: Any) -> bool:
    """True if what follows the end of a process is the end of the launch, and nothing else."""
    some = [on_exit] if isinstance(on_exit, Shutdown) else on_exit
    if not isinstance(some, (list, tuple)) or not some:
        return False
    return all(isinstance(each, Shutdown) and each.condition is None for each in some)


def container_of(action: ComposableNodeContainer, context: LaunchContext) -> str:
    """Return the name of the process of a container: its full name without the first slash."""
    namespace = namespace_of(action.requested_namespace, context)
    name = performed(context, action.requested_name or "container")
    action.expanded_name = f"{namespace}/{name}"
    return action.expanded_name.strip("/")


def target_of(action: LoadComposableNodes, context: LaunchContext) -> str:
    """Return the name of the process of the container into which components are loaded."""
    target = action.target_container
    if isinstance(target, ComposableNodeContainer):
        return container_of(target, context)
    name = performed(context, target)
    return (name if name.startswith("/") else f"{namespace_of(None, context)}/{name}").strip("/")


def components(
    maker: EntryMaker, described: Iterable[ComposableNode], action: ExecuteLocal, process: str, context: LaunchContext
) -> Iterator[Entry]:
    """Yield the entries of the components that are Python classes; tell of the others in one line for each package.

    Args:
        maker: Maker of the entries.
        described: The components.
        action: Action of their container, whose settings they share.
        process: Name of the process that they share.
        context: The context with whose values they are performed.
    """
    absent: dict[str, list[str]] = {}
    for each in described:
        if (condition := each.condition()) is not None and not condition.evaluate(context):
            continue
        package, plugin = performed(context, each.package), performed(context, each.node_plugin)
        program = component_of(package, plugin, maker.home)
        if program.absent:
            absent.setdefault(program.absent, []).append(plugin)
            continue
        naming = Naming(_text(each.node_name, context), namespace_of(each.node_namespace, context))
        requested = Requested(
            program, plugin, naming, each.parameters or (), each.remappings or (), each.place, all(naming)
        )
        note_name(context, requested.full_name)
        yield maker.shared(requested, action, process, context)
    for reason, plugins in absent.items():
        maker.say(f"{placed(action.place)}left out: {_listed(plugins)} of container /{process}: {reason}")


def _text(value: Any, context: LaunchContext) -> str:
    return "" if value is None else performed(context, value)


def _listed(plugins: Sequence[str]) -> str:
    return ", ".join(shown(re.sub(r"\s", "", each)) for each in plugins)
