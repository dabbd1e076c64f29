"""One program of a host: what would be a process, from its start to its end."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Literal

from robolink.arguments import parse_arguments
from robolink.defaults import Defaults
from robolink.exceptions import (
    ExternalShutdownException,
    InterruptedByUser,
    NotInitializedException,
    RobolinkError,
)
from robolink.executors import SingleThreadedExecutor
from robolink.lacking import LackingNameError
from robolink.logging import get_logger, set_logger_level
from robolink.oneprocess.chance import stream
from robolink.oneprocess.executor import HostedExecutor
from robolink.oneprocess.loading import load
from robolink.oneprocess.parts import Killed
from robolink.tracebacks import formatted
from robolink.workspace import VARIABLE, NodeSource, workspace_of
from robolink.workspace.making import check_needs_nothing, made

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.oneprocess.host import Host
    from robolink.oneprocess.hosted import HostedContext
    from robolink.timebase import TimeBase

State = Literal["waiting", "running", "ended", "crashed"]

INTERRUPTED = 130
KILLED = -9
"""The return code of a process that SIGKILL has ended, as `Popen` has it."""

_ENDS = (KeyboardInterrupt, ExternalShutdownException)


class Part:
    """A node or script of a program: its name for people, what runs it, and its command line."""

    def __init__(self, name: str, found: NodeSource | Callable[[], Any], argv: Sequence[str]) -> None:
        self.name, self.argv = name, list(argv)
        self._found = found

    def load(self, program: Program) -> Callable[[], Any]:
        """Give its Node class, or what runs the script."""
        return load(self._found, program) if isinstance(self._found, NodeSource) else self._found

    @property
    def is_found(self) -> bool:
        """Whether it was found by a name or a file."""
        return isinstance(self._found, NodeSource)

    @property
    def home(self) -> Path | None:
        """The workspace in which what it looks up by name is found."""
        path = self._found.path if isinstance(self._found, NodeSource) else None
        return None if path is None else workspace_of(path.parent)


class Program:
    """What a host runs in place of a process.

    `state` is ``waiting`` before it begins, ``running``, ``ended``, or ``crashed`` by an exception or `Host.crash`.
    `error` is the exception that ended it, `returncode` what its process would have given; both None until then.
    """

    def __init__(self, host: Host, name: str, parts: Sequence[Part], env: Mapping[str, str], time: TimeBase) -> None:
        home = parts[0].home
        self.host, self.name, self.parts, self.time = host, name, parts, time
        self.chance = stream(host.seed, name)
        self.env = host.shared({**({} if home is None else {VARIABLE: str(home)}), **env})
        self.main_module: ModuleType | None = None
        """What is ``__main__`` for a script."""
        self.argv = list(parts[0].argv)
        self.state: State = "waiting"
        self.error: BaseException | None = None
        self.returncode: int | None = None
        self.lives = 0
        """How often it has begun."""
        self._made: list[Node] = []
        self.contexts: list[HostedContext] = []
        self.defaults = Defaults()
        self.executor: HostedExecutor | None = None
        self.has_waited = False
        """Whether its code has waited for something since it began."""
        self.on_read: Callable[[], object] = lambda: None
        """Called, in real time, when it has read its command line and environment."""
        self.interrupted = threading.Event()
        """Set once it was asked to end; for what sleeps in real time."""
        self.handlers: dict[int, Any] = {}
        """What it has given to `signal.signal`."""
        self.is_script = self._is_ending = False
        self.has_begun = False
        """Whether its nodes are made, or its script is over."""

    @property
    def context(self) -> HostedContext:
        """Its first context. Raises IndexError as long as it has none."""
        return self.contexts[0]

    @property
    def nodes(self) -> list[Node]:
        """Its nodes, as they were made: also those of a script."""
        tracked = (node for context in self.contexts for node in context._nodes.values())
        return list({id(node): node for node in (*self._made, *tracked)}.values())

    @property
    def wishes(self) -> Mapping[str, Any]:
        """Give the host's wishes for parameters of its nodes; none for a class that somebody starts as it is."""
        return self.host.wishes if self.parts[0].is_found else {}

    @property
    def is_over(self) -> bool:
        """Whether it has ended, in whatever way."""
        return self.state in ("ended", "crashed")

    def prepare(self) -> None:
        """Be as before the first start."""
        self.state, self.error, self.returncode = "waiting", None, None
        self._made, self.contexts, self.executor = [], [], None
        self.is_script = self._is_ending = False
        self.handlers = {}
        self.interrupted = threading.Event()
        self.has_waited = self.has_begun = False
        self.argv = list(self.parts[0].argv)
        self.main_module = None
        self.defaults = Defaults(self.host.pace.context_type, self)
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
            if isinstance(found[0], type):
                self._make_nodes(found)
            else:
                self._run_script(found[0])
        except BaseException as error:  # noqa: BLE001 - it ends the program, and is kept there
            self.end(error)
        if self.lives == life:
            self.has_begun = True

    def _make_nodes(self, classes: Sequence[Callable[[], Any]]) -> None:
        context = self.defaults.context = self.host.pace.context_type()
        context.init([])
        executor = self._make_executor(context)
        for part, node_class in zip(self.parts, classes, strict=True):
            self.argv = sys.argv = list(part.argv)
            context.arguments = parse_arguments(part.argv)
            node = made(node_class)
            self._made.append(node)
            for logger, level in context.arguments.log_levels:
                set_logger_level(logger or node.get_logger().name, level)
            executor.add_node(node)
        if isinstance(executor, HostedExecutor):
            context.given_parameters.warn_of_typos(self._made)
            executor.release()
            return
        self.on_read()
        self.has_begun = True
        executor.spin()
        self.end()

    def _make_executor(self, context: HostedContext) -> SingleThreadedExecutor:
        """Make the executor of its nodes: in virtual time one that the host runs among others'."""
        executor = self.defaults.executor = SingleThreadedExecutor(context=context)
        if isinstance(executor, HostedExecutor):
            self.executor = executor
        return executor

    def _run_script(self, script: Callable[[], Any]) -> None:
        check_needs_nothing(script)
        self.is_script = True
        sys.exit(script())

    # The end

    def end(self, error: BaseException | None = None) -> None:
        """End as a process does when this has come out of its code; None when it has come to its end."""
        if self.state != "running" or self._is_ending or isinstance(error, Killed):
            return
        self._is_ending = True
        self.returncode = self._outcome(error)
        is_crash = self.error is not None
        if self.executor is not None:
            self.executor.withdraw()
        self._clear_away()
        self.host.pace.end_daemons(self)
        self.state = "crashed" if is_crash or self.error is not None else "ended"
        self.host.note_exit(self)

    def _outcome(self, error: BaseException | None) -> int:
        """Give the exit code that Python, or `robolink run`, would give; tell of an error that nobody has told of."""
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
        self.error = error
        if not getattr(error, "__robolink_logged__", False):
            get_logger("robolink").error(self._told(error))
        return 1

    def _was_interrupted(self) -> bool:
        """Whether it was asked to end, in whose midst it may have been making a node."""
        return any(each.interrupted for each in self.contexts)

    def _told(self, error: BaseException) -> str:
        """Say what went wrong: what is robolink's in a line, what is the program's with its traceback."""
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

    def _try(self, act: Callable[[], Any]) -> None:
        try:
            act()
        except Killed:
            raise
        except BaseException as error:  # noqa: BLE001 - a node's own destroy_node is anybody's code
            self.returncode = self._outcome(error) or self.returncode

    def kill(self) -> None:
        """Be gone at once: nothing of it is destroyed in order, nobody is told."""
        if self.is_over:
            return
        self.state, self.returncode = "crashed", KILLED
        if self.executor is not None:
            self.executor.withdraw()
        for context in self.contexts:
            context.abandon()
        self.host.pace.unwind(self)
        self.host.note_exit(self)

    def give_up(self, error: BaseException) -> None:
        """Be taken for crashed, since code of it does not go on."""
        self.error = error
        self.kill()

    def interrupt(self) -> None:
        """Ask it to end, as Ctrl-C does: by its own handler, if it has set one, which replaces that of its contexts."""
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
    """Call a handler of a signal; give what it raises, which the main thread is to meet where it waits."""
    try:
        if callable(handler):
            handler(int(signal.SIGINT), None)
    except BaseException as error:  # noqa: BLE001 - it is raised elsewhere
        return error
    return None


def _of_the_user(error: BaseException) -> Any:
    """Leave out robolink's own frames at the top of a traceback."""
    first = error.__traceback__
    while first is not None and first.tb_frame.f_globals.get("__name__", "").startswith(("robolink.", "runpy")):
        first = first.tb_next
    return first or error.__traceback__
