"""The stage on which the programs of a system are processes, which talk over Zenoh in real time."""

from __future__ import annotations

import inspect
import queue
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from robolink.context import Context
from robolink.exceptions import NotFoundError
from robolink.executors import SingleThreadedExecutor
from robolink.faults.injector import Fault
from robolink.interfaces.rcl_interfaces.msg import Log
from robolink.logging import LoggingSeverity, Record
from robolink.node import Node
from robolink.qos import qos_profile_rosout_default
from robolink.testing.domains import free_domain
from robolink.testing.expectations import NodeFailure, OnlyInMemoryError
from robolink.testing.faults import Faults
from robolink.testing.launching import entry_of
from robolink.testing.remote import Launch, RemoteNode
from robolink.testing.stage import Failure, Startable, Wanted
from robolink.transport.zenoh import ZenohTransport
from robolink.wire import NodeToken

if TYPE_CHECKING:
    from robolink.launch import Entry
    from robolink.message import Message
    from robolink.supervisor.events import Exited
    from robolink.testing.recorder import Topic
    from robolink.transport import Transport

NETWORK = "localhost"
UP_WITHIN = 30.0
"""Seconds in which a node that is started must be announced."""
DOWN_WITHIN = 20.0
"""Seconds in which a process that is to end has ended: it is killed before."""
SLICE = 0.02
"""Seconds after which a wait looks whether what it waits for has come."""


class Processes:
    """Runs each program of a system as a process, on a domain of their own; `start` gives what stands for its node."""

    virtual = False

    def __init__(self) -> None:
        self.failures: list[Failure] = []
        self.logs: list[Record] = []
        self.faults = Faults(_NoInjector())
        self._launches: list[Launch] = []
        self._exits: queue.SimpleQueue[Exited] = queue.SimpleQueue()
        self._expected: set[int | None] = set()
        """The numbers of the processes that the test has had ended."""
        self._shown: dict[str, str] = {}
        """The names of nodes, by their programs'."""
        with ExitStack() as stack:
            self.domain = stack.enter_context(free_domain())
            context = Context(transport=self.session())
            context.init([], domain_id=self.domain)
            stack.enter_context(context)
            self._executor = stack.enter_context(SingleThreadedExecutor(context=context))
            self.node = Node("test", context=context, enable_rosout=False)
            self.node.create_subscription(Log, "/rosout", self._on_log, qos_profile_rosout_default)
            self._executor.add_node(self.node)
            self._stack = stack.pop_all()
        self.begin_ns = self.now_ns()

    now_ns = staticmethod(time.time_ns)

    def session(self) -> Transport:
        """Open a session on the domain."""
        return ZenohTransport(self.domain, NETWORK)

    # Programs

    def start(self, wanted: Wanted) -> RemoteNode:
        """Start a node, and wait until it is announced. Raises NodeFailure when it ends before."""
        __tracebackhide__ = True
        called = self._free_name(wanted)
        before = set(self.node.context.graph.nodes())
        self._begin(Launch(entry_of(_spec(wanted.what), wanted), self.domain, NETWORK, self._exits.put, called))
        return self._node(called, before)

    def _free_name(self, wanted: Wanted) -> str:
        """Find a name for a program: that of its node, if it is given one."""
        own = wanted.name or (wanted.what.__name__ if isinstance(wanted.what, type) else Path(wanted.what).stem)
        name, taken = f"{wanted.namespace.strip('/')}/{own}".lstrip("/"), self.programs
        names = (name if number == 1 else f"{name}_{number}" for number in range(1, len(taken) + 2))
        return next(each for each in names if each not in taken)

    def launch(self, entries: Sequence[Entry]) -> None:
        """Start what a launch file says, and wait until every node is announced that waits for nothing."""
        __tracebackhide__ = True
        before = set(self.node.context.graph.nodes())
        launch = Launch(entries, self.domain, NETWORK, self._exits.put)
        self._begin(launch)
        self._announced(before, ", ".join(launch.names), launch.awaited_nodes)

    def _begin(self, launch: Launch) -> None:
        self._launches.append(launch)
        launch.begin()

    def _node(self, program: str, before: set[NodeToken]) -> RemoteNode:
        __tracebackhide__ = True
        found = [each.full_node_name for each in self._announced(before, program)]
        name = next((each for each in found if each == f"/{program}"), found[0])
        self._shown[program] = name.strip("/")
        return RemoteNode(program, name)

    def _announced(self, before: set[NodeToken], who: str, how_many: Callable[[], int] = lambda: 1) -> list[NodeToken]:
        """Wait for so many nodes that were not there before. Raises NodeFailure when a program ends first."""
        __tracebackhide__ = True
        graph, failed = self.node.context.graph, len(self.failures)
        found: list[NodeToken] = []

        def are_there() -> bool:
            found[:] = [each for each in graph.nodes() if each not in before]
            return len(found) >= how_many() or len(self.failures) > failed

        if not self.run_until(are_there, UP_WITHIN):
            raise NodeFailure(f"{who}: not every node was announced within {UP_WITHIN:g} s")
        if len(self.failures) > failed:
            failure = self.failures.pop()
            raise NodeFailure(f"{failure.program} failed at its start: {failure.why}")
        return found

    def stop(self, program: str) -> None:
        """End a program in order."""
        self._end(program, lambda launch: launch.stop(program))

    def crash(self, program: str) -> None:
        """Kill a program."""
        self._end(program, lambda launch: launch.kill(program))

    def restart(self, program: str) -> RemoteNode:
        """Start a program anew."""
        launch, before = self._launch_of(program), set(self.node.context.graph.nodes())
        self._expected.add(launch.pid(program))
        launch.restart(program)
        return self._node(program, before)

    def _end(self, program: str, act: Callable[[Launch], object]) -> None:
        launch = self._launch_of(program)
        self._expected.add(launch.pid(program))
        act(launch)
        self.run_until(lambda: launch.pid(program) is None, DOWN_WITHIN)

    @property
    def programs(self) -> list[str]:
        """The names of all programs, ended ones too."""
        return list(dict.fromkeys(self._shown.get(name, name) for launch in self._launches for name in launch.names))

    def program_of(self, node: str) -> str:
        """Give the program of this name, or the only one of this name in any namespace. Raises NotFoundError."""
        wanted, known = node.strip("/"), self.programs
        found = [each for each in known if each == wanted] or [each for each in known if each.endswith(f"/{wanted}")]
        if len(found) != 1:
            raise NotFoundError("node", node, known, "this system")
        return next((program for program, shown in self._shown.items() if shown == found[0]), found[0])

    def _launch_of(self, program: str) -> Launch:
        return next(each for each in reversed(self._launches) if program in each.names)

    # Time

    def run_until(self, condition: Callable[[], bool], within: float) -> bool:
        """Let real time pass until the condition holds, so many seconds at most; whether it holds."""
        deadline = time.monotonic() + within
        while True:
            self._take_exits()
            for launch in self._launches:
                launch.release_what_may_start(self.node.context.graph)
            if condition():
                return True
            left = deadline - time.monotonic()
            if left <= 0:
                return False
            self._executor.spin_once(timeout_sec=min(left, SLICE))

    def _take_exits(self) -> None:
        while not self._exits.empty():
            each = self._exits.get()
            if each.returncode and each.pid not in self._expected:
                why = each.how + (f": {each.cause}" if each.cause else "")
                self.failures.append(Failure(self._shown.get(each.name, each.name), int(each.at * 1e9), why))

    # What is known of the programs

    def nodes(self) -> list[Node]:
        """Give the test's own node: all others live elsewhere."""
        return [self.node]

    def class_of(self, topic: Topic) -> type[Message] | None:
        """Give nothing: the class must be installed, or asked of the node."""
        return None

    def fault_reports(self) -> list[str]:
        """Give nothing: there are no faults."""
        return []

    def real_time_use(self) -> list[str]:
        """Give nothing: all of it is real time."""
        return []

    def _on_log(self, log: Log) -> None:
        stamp = log.stamp.sec * 10**9 + log.stamp.nanosec
        self.logs.append(Record(stamp, _severity(log.level), log.name, log.msg, log.file, log.function, log.line))

    def close(self) -> None:
        """End all programs in order, and by force what does not end; then leave the network."""
        launches, self._launches = self._launches, []
        for each in launches:
            each.supervisor.stop()
        for each in launches:
            each.thread.join(DOWN_WITHIN)
        self._stack.close()


def _spec(what: Startable) -> str:
    """Give how `robolink run` finds it. Raises OnlyInMemoryError for a class that no file gives."""
    if not isinstance(what, type):
        return str(what)
    if "<locals>" in what.__qualname__:
        reason = f"{what.__qualname__} is a class within a function"
        raise OnlyInMemoryError(f"{reason}: another process cannot import it, so put it outside")
    return f"{inspect.getsourcefile(what)}:{what.__qualname__}"


def _severity(level: int) -> LoggingSeverity:
    try:
        return LoggingSeverity(level)
    except ValueError:
        return LoggingSeverity.UNSET


class _NoInjector:
    """Refuses faults: between real processes there is nothing that could lose a message on purpose."""

    def now(self) -> float:
        """Give nothing that counts."""
        return 0.0

    def add(self, fault: Fault) -> None:
        """Refuse it."""
        raise _only_in_memory(type(fault).__name__)

    def read(self, path: str | PathLike[str]) -> None:
        """Refuse it."""
        raise _only_in_memory(str(path))

    def clear(self) -> None:
        """There are none."""


def _only_in_memory(what: str) -> OnlyInMemoryError:
    return OnlyInMemoryError(f"{what}: faults strike in memory alone; run this with --robolink-transport memory")
