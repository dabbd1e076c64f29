"""Multi-process runner of a system under test: each program is a process, in real time over Zenoh."""

from __future__ import annotations

import inspect
import queue
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from robolink.context import Context
from robolink.executors import SingleThreadedExecutor
from robolink.faults.injector import Fault
from robolink.interfaces.rcl_interfaces.msg import Log
from robolink.interfaces.rcl_interfaces.srv import ListParameters
from robolink.logging import LoggingSeverity, Record
from robolink.node import BaseNode, Node
from robolink.qos import qos_profile_rosout_default
from robolink.serialization import serialize_message
from robolink.system import clocks, waits
from robolink.testing.expectations import NodeFailure, OnlyInMemoryError
from robolink.testing.faults import Faults
from robolink.testing.launching import entry_of
from robolink.testing.stage import Failure, Named, NodeRequest, full
from robolink.testing.supervisor_thread import Launch
from robolink.text.names import the_one
from robolink.transport.port_sharing import free_domain
from robolink.transport.zenoh import ZenohTransport
from robolink.wire import DataKey, EndpointKind, EndpointToken, NodeToken, format_key, graph_pattern

if TYPE_CHECKING:
    from robolink.launch.entry import System as LaunchSystem
    from robolink.message import Message
    from robolink.supervisor.events import Exited
    from robolink.task import Future
    from robolink.testing.recorder import Recorder, Topic
    from robolink.transport import Transport

NETWORK = "localhost"
"""Network of the processes: this machine's loopback alone."""
UP_WITHIN = 30.0
"""Timeout of a started node's announcement, in seconds."""
ANSWERS_WITHIN = 5.0
"""Timeout of an announced node's first answer, in seconds: until then it is still made."""
DOWN_WITHIN = 20.0
"""Timeout of a process that is to end, in seconds: it is killed before."""
UNKNOWN_WITHIN = 5.0
"""Timeout in which the others learn that a process has ended, in seconds."""
SLICE = 0.02
"""Period in seconds at which a wait checks its condition."""


class RemoteNode:
    """Stand-in for a node in another process, by its name: it is observed by topics, services and log lines.

    `beside` are the full names of all nodes that its program had when it was announced.
    """

    def __init__(self, program: str, full_name: str, beside: Sequence[str]) -> None:
        self.program, self.beside, self._full_name = program, beside, full_name

    def get_fully_qualified_name(self) -> str:
        """Return the node's namespace and name."""
        return self._full_name

    def get_name(self) -> str:
        """Return the node's name."""
        return self._full_name.rpartition("/")[2]

    def get_namespace(self) -> str:
        """Return the node's namespace, with its leading slash."""
        return self._full_name.rpartition("/")[0] or "/"


class Processes:
    """Runner of each program of a system as a process, on a domain of their own."""

    virtual = False

    def __init__(self) -> None:
        self.failures: list[Failure] = []
        self.logs: list[Record] = []
        self.faults = Faults(_NoFaults())
        self._launches: list[Launch] = []
        self._exits: queue.SimpleQueue[Exited] = queue.SimpleQueue()
        self._expected: set[int | None] = set()
        """Ids of the processes that the test itself has ended."""
        self._answering: set[str] = set()
        """Full names of new nodes that have answered at their parameter services."""
        self._shown: dict[str, str] = {}
        """Names of nodes, by their programs'."""
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

    now_ns = staticmethod(clocks.now)

    def session(self) -> Transport:
        """Open a session on the domain."""
        return ZenohTransport(self.domain, NETWORK)

    # Programs

    def start(self, request: NodeRequest) -> RemoteNode:
        """Start a node and wait until it is made; return its stand-in. Raises NodeFailure if it ends before."""
        __tracebackhide__ = True
        called = self._free_name(request)
        before = set(self.node.context.graph.nodes())
        self._begin(Launch(entry_of(_spec(request.what), request), self.domain, NETWORK, self._exits.put, called))
        return self._node(called, before)

    def _free_name(self, request: NodeRequest) -> str:
        """Return a free name for a program: that of its node, if it is given one."""
        own = request.name or (request.what.__name__ if isinstance(request.what, type) else Path(request.what).stem)
        name, taken = f"{request.namespace.strip('/')}/{own}".lstrip("/"), self._all_names()
        names = (name if number == 1 else f"{name}_{number}" for number in range(1, len(taken) + 2))
        return next(each for each in names if each not in taken)

    def launch(self, system: LaunchSystem, faults: str | PathLike[str] | None = None) -> None:
        """Start the nodes of a launch file, and wait until every node is made that waits for nothing."""
        __tracebackhide__ = True
        if faults is not None:
            self.faults.read(faults)
        before = set(self.node.context.graph.nodes())
        launch = Launch(system.entries, self.domain, NETWORK, self._exits.put, direct=system.direct)
        self._begin(launch)
        self._announced(before, ", ".join(launch.names), launch.awaited_nodes)

    def _begin(self, launch: Launch) -> None:
        self._launches.append(launch)
        launch.begin()
        if launch.waits:
            self.node.context.transport.watch(graph_pattern(self.domain), launch.hear)

    def _node(self, program: str, before: set[NodeToken]) -> RemoteNode:
        __tracebackhide__ = True
        found = [each.full_node_name for each in self._announced(before, program)]
        name = next((each for each in found if each == f"/{program}"), found[0])
        self._shown[program] = name.strip("/")
        return RemoteNode(program, name, found)

    def _announced(self, before: set[NodeToken], who: str, how_many: Callable[[], int] = lambda: 1) -> list[NodeToken]:
        """Wait until so many nodes that were not there before are made. Raises NodeFailure if a program ends first."""
        __tracebackhide__ = True
        graph, failed = self.node.context.graph, len(self.failures)
        found: list[NodeToken] = []

        def are_there() -> bool:
            found[:] = [each for each in graph.nodes() if each not in before]
            return len(found) >= how_many() or len(self.failures) > failed

        if not self.run_until(are_there, UP_WITHIN):
            raise NodeFailure(f"{who}: not every node was announced within {UP_WITHIN:g} s")
        self._answered(found, lambda: len(self.failures) > failed)
        if len(self.failures) > failed:
            failure = self.failures.pop()
            raise NodeFailure(f"{failure.program} failed at its start: {failure.why}")
        return found

    def _answered(self, nodes: Sequence[NodeToken], has_ended: Callable[[], bool]) -> None:
        """Wait until nodes answer at their parameter services: those are announced while a node is still made.

        A script may have nodes that never spin: one that does not answer in a while is taken for made.
        """
        names = {each.full_node_name for each in nodes}
        clients = {each: self.node.create_client(ListParameters, f"{each}/list_parameters") for each in names}
        open_calls = dict.fromkeys(names)
        answers: dict[str, Future[ListParameters.Response]] = {}

        def all_answer() -> bool:
            for each in [one for one in open_calls if clients[one].service_is_ready()]:
                del open_calls[each]
                answers[each] = clients[each].call_async(ListParameters.Request())
            return has_ended() or (not open_calls and all(each.done() for each in answers.values()))

        try:
            self.run_until(all_answer, ANSWERS_WITHIN)
        finally:
            self._answering |= {name for name, answer in answers.items() if answer.done()}
            for each in clients.values():
                self.node.destroy_client(each)

    def settle(self, recorder: Recorder) -> None:
        """Wait until each new node that answers at all has answered the recorder, too: it knows what is recorded then.

        Else what it publishes because of the test's first message may be gone before it knows that anybody hears it.
        """
        own, graph = self.node.get_fully_qualified_name(), self.node.context.graph
        publishers = [each for each in graph.endpoints(EndpointKind.PUBLISHER) if each.full_node_name != own]
        keys = {_key(each) for each in publishers}
        self.run_until(lambda: keys <= recorder.topics.keys(), ANSWERS_WITHIN)
        request = bytes(serialize_message(ListParameters.Request()))
        answers = [
            recorder.ask(_key(each), request)
            for name in self._answering
            for each in graph.endpoints(EndpointKind.SERVICE, name=f"{name}/list_parameters")
        ]
        self._answering.clear()
        self.run_until(lambda: all(each.is_set() for each in answers), ANSWERS_WITHIN)

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
        """End a program, and wait until it has ended and its node is announced no more."""
        launch = self._launch_of(program)
        pid, before = launch.pid(program), self._count_of(program)
        self._expected.add(pid)
        act(launch)
        if pid is not None:
            self.run_until(lambda: launch.pid(program) is None, DOWN_WITHIN)
            self.run_until(lambda: not before or self._count_of(program) < before, UNKNOWN_WITHIN)

    def _count_of(self, program: str) -> int:
        """Count the nodes that are called as that of a program."""
        name = "/" + self._shown.get(program, program)
        return sum(each.full_node_name == name for each in self.node.context.graph.nodes())

    @property
    def programs(self) -> list[str]:
        """Names of all programs, ended ones too: that of the node where it is one program's alone."""
        shown = {name: self._shown.get(name, name) for name in self._all_names()}
        times = Counter(shown.values())
        return [name if times[node] > 1 else node for name, node in shown.items()]

    def _all_names(self) -> list[str]:
        return [name for launch in self._launches for name in launch.names]

    def program_of(self, node: str | Named) -> str:
        """Return the program of a node, or of the only one of this name in any namespace. Raises NotFoundError."""
        if isinstance(node, RemoteNode):
            return node.program
        found = the_one("node", full(node), self.programs, "this system")
        return next((program for program, shown in self._shown.items() if shown == found), found)

    def _launch_of(self, program: str) -> Launch:
        return next(each for each in reversed(self._launches) if program in each.names)

    # Time

    def run_until(self, condition: Callable[[], bool], within: float) -> bool:
        """Let real time pass until the condition holds or `within` seconds are over; True if it holds."""
        deadline = clocks.monotonic() + within
        while True:
            self._take_exits()
            if condition():
                return True
            left = deadline - clocks.monotonic()
            if left <= 0:
                return False
            self._executor.spin_once(timeout_sec=min(left, SLICE))

    def _take_exits(self) -> None:
        while not self._exits.empty():
            each = self._exits.get()
            if each.returncode and each.pid not in self._expected:
                why = each.how + (f": {each.cause}" if each.cause else "")
                self.failures.append(Failure(self._shown.get(each.name, each.name), int(each.at * 1e9), why))

    # State of the programs

    def nodes(self) -> list[Node]:
        """Return the test's own node: all others live elsewhere."""
        return [self.node]

    def nodes_beside(self, started: RemoteNode) -> Sequence[str]:
        """Return the names of the nodes of a node's program that exist now."""
        there = {each.full_node_name for each in self.node.context.graph.nodes()}
        return [each for each in started.beside if each in there]

    def class_of(self, topic: Topic) -> type[Message] | None:
        """Return None: the class must be installed, or asked of the node."""
        return None

    def fault_reports(self) -> list[str]:
        """Return nothing: there are no faults."""
        return []

    def faults_in_vain(self) -> list[str]:
        """Return nothing: there are no faults."""
        return []

    def real_time_use(self) -> list[str]:
        """Return nothing: all of it is real time."""
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
            waits.join(each.thread, DOWN_WITHIN)
        self._stack.close()


def _key(end: EndpointToken) -> str:
    return format_key(DataKey(end.domain, end.name, end.type_name, end.type_hash))


def _spec(what: type[BaseNode] | str | Path) -> str:
    """Return the name by which `robolink run` finds it. Raises OnlyInMemoryError for a class that no file gives."""
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


class _NoFaults:
    """Refusal of all faults: between real processes nothing can lose a message on purpose."""

    def now(self) -> float:
        """Return a time that nothing uses."""
        return 0.0

    def add(self, fault: Fault) -> None:
        """Refuse a fault."""
        raise _only_in_memory(type(fault).__name__)

    def read(self, path: str | PathLike[str]) -> None:
        """Refuse a file of faults."""
        raise _only_in_memory(str(path))

    def clear(self) -> None:
        """Do nothing: there are no faults."""


def _only_in_memory(what: str) -> OnlyInMemoryError:
    return OnlyInMemoryError(f"{what}: faults strike in memory alone; run this with --robolink-transport memory")
