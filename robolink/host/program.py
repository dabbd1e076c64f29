"""Program of a host: the counterpart of a process, from its start to its end."""

from __future__ import annotations

import importlib.util
import signal
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import CodeType, ModuleType
from typing import TYPE_CHECKING, Any, Literal, Protocol
from weakref import WeakSet

from robolink.arguments.command_line import parse_arguments
from robolink.context import Context
from robolink.exceptions import (
    ExternalShutdownException,
    InterruptedByUser,
    NotInitializedException,
    RobolinkError,
)
from robolink.executors import SingleThreadedExecutor
from robolink.host.driver import HostDriver
from robolink.host.pace import Pace
from robolink.host.participants import HostLike, Killed, ProgramLike
from robolink.host.patches.entropy import stream
from robolink.host.platform import HostedPlatform, abandon
from robolink.impl.rcutils_logger import RcutilsLogger
from robolink.logging import get_logger, set_logger_level
from robolink.running.defaults import Defaults
from robolink.system.processes import Variables
from robolink.text.suggestions import LackingNameError
from robolink.text.tracebacks import formatted
from robolink.workspace import VARIABLE, NodeLoadError, NodeSource, load_node, workspace_of
from robolink.workspace.load import check_needs_nothing, make_node, runs_itself

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.running.timebase import TimeBase

State = Literal["waiting", "running", "ended", "crashed"]

INTERRUPTED = 130
KILLED = -9
"""Return code of a process that SIGKILL has ended, as `Popen` has it."""

_ENDS = (KeyboardInterrupt, ExternalShutdownException)


class ProgramHost(HostLike, Protocol):
    """Host as seen by a program."""

    seed: int
    preferred_parameters: dict[str, Any]
    """Values by parameter, for nodes that declare it and have no other."""
    pace: Pace

    def shared(self, env: dict[str, str | None]) -> dict[str, str | None]:
        """Return an environment that is equal to this one: the same for all programs that have the same."""

    def note_exit(self, program: Program) -> None:
        """Call `on_exit` for a program that has ended."""


class Part:
    """A node or script of a program: its name for people, its code, and its command line."""

    def __init__(self, name: str, found: NodeSource | Callable[[], Any], argv: Sequence[str]) -> None:
        self.name, self.argv = name, list(argv)
        self._found = found

    def load(self, program: Program) -> Callable[[], Any]:
        """Return its Node class, or a function that runs the script."""
        return load(self._found, program) if isinstance(self._found, NodeSource) else self._found

    @property
    def is_found(self) -> bool:
        """True if it was found by a name or a file, not given as a class."""
        return isinstance(self._found, NodeSource)

    @property
    def home(self) -> Path | None:
        """Workspace in which it looks up names; None for the current one."""
        path = self._found.path if isinstance(self._found, NodeSource) else None
        return None if path is None else workspace_of(path.parent)


class Program:
    """Runs in a host in place of a process.

    `state` is ``waiting`` before it begins, ``running``, ``ended``, or ``crashed`` by an exception or `Host.crash`.
    `error` is the exception that ended it, `returncode` what its process would have given; both None until then.
    """

    def __init__(self, host: ProgramHost, name: str, parts: Sequence[Part], env: Variables, time: TimeBase) -> None:
        home = parts[0].home
        self.host, self.name, self.parts, self.time = host, name, parts, time
        self.chance = stream(host.seed, name)
        self.env = host.shared({**({} if home is None else {VARIABLE: str(home)}), **env})
        self.main_module: ModuleType | None = None
        """A script's ``__main__`` module."""
        self.argv = list(parts[0].argv)
        self.state: State = "waiting"
        self.error: BaseException | None = None
        self.returncode: int | None = None
        self.lives = 0
        """Number of its starts."""
        self._made: list[Node] = []
        self.contexts: list[Context] = []
        self.defaults = Defaults()
        self.driver: HostDriver | None = None
        """Runs the callbacks of its Node classes; None in a script, and before they are made."""
        self.has_waited = False
        """True once its code has waited for something since it began."""
        self.loops: WeakSet[Any] = WeakSet()
        """Its event loops of asyncio."""
        self.handlers: dict[int, Any] = {}
        """Handlers that it has given to `signal.signal`, by number."""
        self.is_script = self._is_ending = False
        self.has_begun = False
        """True once its nodes are made, or its script is over."""

    @property
    def context(self) -> Context:
        """Its first context. Raises IndexError as long as it has none."""
        return self.contexts[0]

    @property
    def nodes(self) -> list[Node]:
        """Its nodes, as they were made: also those of a script."""
        tracked = (node for context in self.contexts for node in context._nodes.values())
        return list({id(node): node for node in (*self._made, *tracked)}.values())

    @property
    def preferred_parameters(self) -> Mapping[str, Any]:
        """Return the values that the host prefers for its nodes' parameters; none for a class given as it is."""
        return self.host.preferred_parameters if self.parts[0].is_found else {}

    @property
    def is_over(self) -> bool:
        """True once it has ended, in whatever way."""
        return self.state in ("ended", "crashed")

    def prepare(self) -> None:
        """Reset to the state before the first start."""
        self.state, self.error, self.returncode = "waiting", None, None
        self._made, self.contexts, self.driver = [], [], None
        self.is_script = self._is_ending = False
        self.handlers, self.loops = {}, WeakSet()
        self.has_waited = self.has_begun = False
        self.argv = list(self.parts[0].argv)
        self.main_module = None
        self.defaults = Defaults(self, HostedPlatform(self))
        self.defaults.time = self.time

    def begin(self) -> None:
        """Make its nodes, or run its script; called as its code is."""
        if self.state != "waiting":
            return
        self.state = "running"
        self.lives += 1
        life = self.lives
        try:
            found = [part.load(self) for part in self.parts]
            if any(map(runs_itself, found)):
                self._run_async_node(found)
            elif isinstance(found[0], type):
                self._make_nodes(found)
            else:
                self._run_script(found[0])
        except BaseException as error:  # noqa: BLE001 - it ends the program, and is kept there
            self.end(error)
        if self.lives == life:
            self.has_begun = True

    def _run_async_node(self, classes: Sequence[Callable[[], Any]]) -> None:
        """Run an AsyncNode on a loop of its own, in this thread."""
        from robolink.experimental.program import run_node  # late: few programs have such nodes

        if len(classes) > 1:
            raise NodeLoadError(f"{self.name}: an AsyncNode needs a process of its own: leave `process` out")
        context = self._initialized_context()
        context.arguments = parse_arguments(self.argv)
        run_node(lambda: make_node(classes[0]), self._note_made)
        self.end()

    def _note_made(self, node: Any) -> None:
        self._made.append(node)
        self._set_levels(node)
        self.has_begun = True

    def _initialized_context(self) -> Context:
        context = self.defaults.context = Context()
        context.init([])
        return context

    def _set_levels(self, node: Node) -> None:
        """Set the levels of loggers that the command line names; one without a name is the node's."""
        for logger, level in node.context.arguments.log_levels:
            set_logger_level(logger or node.get_logger().name, level)

    def _make_nodes(self, classes: Sequence[Callable[[], Any]]) -> None:
        context = self._initialized_context()
        executor = self.defaults.executor = SingleThreadedExecutor(context=context)
        driver = executor._driver
        assert isinstance(driver, HostDriver)
        self.driver = driver
        for part, node_class in zip(self.parts, classes, strict=True):
            self.argv = sys.argv = list(part.argv)
            context.arguments = parse_arguments(part.argv)
            node = make_node(node_class)
            self._made.append(node)
            self._set_levels(node)
            executor.add_node(node)
        context.given_parameters.warn_of_typos(self._made)
        self.driver.release()

    def _run_script(self, script: Callable[[], Any]) -> None:
        check_needs_nothing(script)
        self.is_script = True
        sys.exit(script())

    # The end

    def end(self, error: BaseException | None = None) -> None:
        """End as a process does that this exception has left; None when it has come to its end."""
        if self.state != "running" or self._is_ending or isinstance(error, Killed):
            return
        self._is_ending = True
        self.returncode = self._outcome(error)
        is_crash = self.error is not None
        if self.driver is not None:
            self.driver.withdraw()
        self._clear_away()
        self.host.pace.end_daemons(self)
        self.state = "crashed" if is_crash or self.error is not None else "ended"
        self.host.note_exit(self)

    def _outcome(self, error: BaseException | None) -> int:
        """Return the exit code that Python, or `robolink run`, would give; log an error that is not logged yet."""
        is_script = self.is_script
        if error is None:
            return 0
        if isinstance(error, SystemExit):
            if error.code is None or isinstance(error.code, int):
                return error.code or 0
            get_logger(self.name).error(str(error.code))
            return 1
        if isinstance(error, _ENDS) or (isinstance(error, NotInitializedException) and self._was_interrupted()):
            return INTERRUPTED if is_script else 0
        error = self.error = _lacking_opencv(error) or error
        self._logger().error(self._message_for(error))
        return 1

    def _logger(self) -> RcutilsLogger:
        """Return the logger of the only node, by which /rosout and so a bag tells of its end; else robolink's."""
        nodes = [each for context in self.contexts for each in context.nodes]
        logger: RcutilsLogger = nodes[0].get_logger() if len(nodes) == 1 else get_logger("robolink")
        return logger

    def _was_interrupted(self) -> bool:
        """Return True if it was interrupted, maybe while a node was made."""
        return any(each.interrupted for each in self.contexts)

    def _message_for(self, error: BaseException) -> str:
        """Return the message for an error: a line for one of robolink's, a traceback for one of the program's."""
        if isinstance(error, RobolinkError) and not isinstance(error, LackingNameError):
            return f"{self.name}: {error}"
        what = "raised" if self.has_begun or self.is_script else "raised while it was made"
        return f"{self.name} {what}:\n{formatted(error, _of_the_user(error))}"

    def _clear_away(self) -> None:
        """Destroy what it has, as `robolink run` does at its end."""
        for node in self._made:
            self._try(node.destroy_node)
        for context in list(self.contexts):
            self._try(context.try_shutdown)
        self._abandon_loops()

    def _abandon_loops(self) -> None:
        for loop in self.loops:
            loop.abandon()

    def _try(self, act: Callable[[], Any]) -> None:
        try:
            act()
        except Killed:
            raise
        except BaseException as error:  # noqa: BLE001 - a node's own destroy_node is anybody's code
            self.returncode = self._outcome(error) or self.returncode

    def kill(self) -> None:
        """End at once, as by SIGKILL: nothing of it is destroyed in order, nothing published."""
        if self.is_over:
            return
        self.state, self.returncode = "crashed", KILLED
        if self.driver is not None:
            self.driver.withdraw()
        for context in self.contexts:
            abandon(context)
        self._abandon_loops()
        self.host.pace.unwind(self)
        self.host.note_exit(self)

    def give_up(self, error: BaseException) -> None:
        """Count as crashed, since code of it does not go on."""
        self.error = error
        self.kill()

    def interrupt(self) -> None:
        """Interrupt it as Ctrl-C does: by its own handler, if it has set one, which replaces that of its contexts."""
        if self.state == "waiting":
            self.state, self.returncode = "ended", INTERRUPTED
            self.host.note_exit(self)
        if self.state != "running":
            return
        handler = self.handlers.get(signal.SIGINT, signal.default_int_handler)
        error: BaseException | None = InterruptedByUser()
        if handler is not signal.default_int_handler:
            error = _raised_by(handler)
        if handler is signal.default_int_handler or error is not None:
            for context in self.contexts:
                context.interrupt()
        self.host.pace.break_in(self, error)


def _raised_by(handler: Any) -> BaseException | None:
    """Call a handler of a signal. Return the exception that it raises, for the main thread where it waits."""
    try:
        if callable(handler):
            handler(int(signal.SIGINT), None)
    except BaseException as error:  # noqa: BLE001 - it is raised elsewhere
        return error
    return None


def _lacking_opencv(error: BaseException) -> RobolinkError | None:
    """Return the error that tells what to install, if `error` is a failed import of OpenCV."""
    if not isinstance(error, ImportError):
        return None
    from robolink.image.opencv import lacking  # with numpy, which is slow to import

    return lacking(error)


def _of_the_user(error: BaseException) -> Any:
    """Return the traceback without robolink's own frames at its top."""
    first = error.__traceback__
    while first is not None and first.tb_frame.f_globals.get("__name__", "").startswith(("robolink.", "runpy")):
        first = first.tb_next
    return first or error.__traceback__


def load(source: NodeSource, program: ProgramLike) -> Callable[[], Any]:
    """Return the Node class of a source, or a function that runs its script. Raises what `load_node` raises.

    A node's own file is loaded anew for every start, as in a process of its own: two programs from one file, and one
    that was started again, share none of its variables. What it imports is shared: its neighbours, modules of packages.
    """
    if not source.module:  # loaded again: two programs of one file must not share variables
        _forget(str(source.path.resolve()))
    return load_node(source, script=lambda found, reach: _script(found, reach, program))


def _forget(path: str) -> None:
    """Remove the module of a file, by whichever name it was imported (one of a package has its dotted name)."""
    for name, each in list(sys.modules.items()):
        if getattr(each, "__dict__", {}).get("__file__") == path:
            del sys.modules[name]


def _script(source: NodeSource, reach: Callable[[], None], program: ProgramLike) -> Callable[[], None]:
    """Return a function that runs a script as ``__main__``, of which each program has its own."""

    def run() -> None:
        reach()
        module = program.main_module = ModuleType("__main__")
        code = _code_of_module(source.module, module) if source.module else _code_of_file(source.path, module)
        program.host.scheduler.view.show(program)
        exec(code, vars(module))  # noqa: S102 - that is what running a script is

    return run


def _code_of_file(path: Path | None, module: ModuleType) -> CodeType:
    assert path is not None
    vars(module).update(__file__=str(path), __builtins__=__builtins__)
    return compile(path.read_bytes(), str(path), "exec", dont_inherit=True)


def _code_of_module(name: str, module: ModuleType) -> CodeType:
    spec = importlib.util.find_spec(name)
    if spec is not None and spec.submodule_search_locations is not None:
        return _code_of_module(f"{name}.__main__", module)
    code = getattr(spec.loader, "get_code", lambda name: None)(name) if spec is not None else None
    if spec is None or code is None:
        raise NodeLoadError(f"{name} is not a module that can be run")
    vars(module).update(
        __file__=spec.origin, __spec__=spec, __package__=spec.parent, __loader__=spec.loader, __builtins__=__builtins__
    )
    found: CodeType = code
    return found
