"""In-process runner of a system under test: all programs in memory, in virtual time, with fault injection."""

from __future__ import annotations

import inspect
import re
import traceback
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink import logging
from robolink.faults.description import Why
from robolink.host import Host, Program
from robolink.host.call_sites import is_users
from robolink.host.supervision import Supervision
from robolink.launch import processes
from robolink.message import type_hash
from robolink.node import BaseNode, Node
from robolink.simulate.settings import numpy_seeded
from robolink.supervisor.policy import Step, is_orderly
from robolink.testing.faults import Faults, ProgramFaults
from robolink.testing.launching import entry_of
from robolink.testing.stage import Failure, Named, NodeRequest, full
from robolink.text.names import meant, the_one
from robolink.transport.memory import MemoryTransport

if TYPE_CHECKING:
    from robolink.launch import Launched
    from robolink.launch.entry import System as LaunchSystem
    from robolink.logging import Record
    from robolink.message import Message
    from robolink.running.timebase import TimeBase
    from robolink.testing.recorder import Recorder, Topic
    from robolink.transport import Transport


class Tester(Node):
    """The test's own node."""

    def __init__(self) -> None:
        super().__init__("test")


class OneProcess:
    """Runner of all programs of a system in this process; `seed` decides all that is drawn."""

    virtual = True

    def __init__(self, seed: int) -> None:
        self.failures: list[Failure] = []
        self.logs: list[Record] = []
        self.supervisions: list[Supervision] = []
        self.expected: set[str] = set()
        with ExitStack() as stack:
            self.host = stack.enter_context(Host(seed=seed, connect=self._connect, clock=self._clock))
            self.program_faults = ProgramFaults(self, seed)
            self.faults = Faults(self.program_faults)
            self.host.on_exit.append(self._on_exit)
            logging.add_handler(self.logs.append)
            stack.callback(logging.remove_handler, self.logs.append)
            stack.enter_context(numpy_seeded(seed))
            self.host.preferred_parameters = {"seed": seed}
            self.begin_ns = self.now_ns()
            self.node: Node = self.host.start_node(Tester)
            self._own = next(iter(self.host.programs))
            self.domain = self.node.context.get_domain_id()
            self._stack = stack.pop_all()

    # The host is made first: it asks for both only once a program starts.

    def _connect(self, program: str) -> Transport:
        return self.program_faults.injector.connect(program)

    def _clock(self, program: str, time: TimeBase) -> TimeBase:
        return self.program_faults.injector.clock(program, time)

    def now_ns(self) -> int:
        """Return the virtual time in ns."""
        return self.host.time.now()

    def session(self) -> Transport:
        """Open a session that no fault touches."""
        return MemoryTransport(bus=self.host.bus)

    # Programs

    def start(self, request: NodeRequest) -> Any:
        """Start a node; return it, or the program of a script."""
        failed = len(self.failures)
        try:
            if isinstance(request.what, type):
                return self._started_class(request.what, request)
            (launched,) = processes(entry_of(str(request.what), request))
            self._register(launched)
            program = self.host.start(launched.name, launched.members, env=launched.env)
            if program.error is not None:
                raise program.error
        except BaseException:
            del self.failures[failed:]  # whoever starts it sees it
            raise
        return self._node_of(program)

    def _started_class(self, node_class: type[BaseNode], request: NodeRequest) -> Any:
        called = self._free_name(request.namespace, request.name or _name_in(node_class) or node_class.__name__)
        self.program_faults.injector.register(called, [called])
        node = self.host.start_node(
            node_class,
            name=request.name,
            namespace=request.namespace,
            parameters=request.parameters,
            remappings=request.remappings,
            args=request.args,
            called=called,
        )
        self.program_faults.warn_of_right_clock(called, node.get_fully_qualified_name().strip("/"))
        return node

    def _free_name(self, namespace: str, name: str) -> str:
        """Return a name for a program that no other has."""
        first = f"{namespace.strip('/')}/{name}".lstrip("/")
        names = (first if number == 1 else f"{first}_{number}" for number in range(1, len(self.host.programs) + 2))
        return next(each for each in names if each not in self.host.programs)

    def launch(self, system: LaunchSystem, faults: str | PathLike[str] | None = None) -> None:
        """Start the nodes of a launch file by its rules, with the faults of a file; commands are left out."""
        launched = processes(system.entries)
        for each in launched:
            self._register(each)
        if faults is not None:
            self.program_faults.read(faults)
        for each in launched:
            if not each.members:
                logging.get_logger("robolink.testing").warning(
                    f"{each.name} is left out: a command knows no virtual time"
                )
        supervision = Supervision(
            self.host, launched, direct=system.direct, on_added=self._register, on_failure=self._on_launch_failure
        )
        self.supervisions.append(supervision)
        supervision.begin()
        self.run_until(lambda: False, 0.0)

    def _on_launch_failure(self, reason: str) -> None:
        self.failures.append(Failure("the launch file", self.now_ns(), reason, None))

    def _register(self, launched: Launched) -> None:
        self.program_faults.injector.register(launched.name, (entry.name for entry in launched.entries))

    def _node_of(self, program: Program) -> Any:
        """Return the node of a program, once it has made it; the program itself if it makes none at once."""
        self.run_until(lambda: bool(program.nodes) or program.is_over, 0.0)
        nodes = program.nodes
        return nodes[0] if nodes else program

    def settle(self, recorder: Recorder) -> None:
        """Do nothing: in memory all know each other at once."""

    def stop(self, program: str) -> None:
        """End a program in order."""
        with self._expecting(program):
            self.host.stop(program)

    def crash(self, program: str) -> None:
        """End a program at once."""
        with self._expecting(program):
            self.host.crash(program)

    def restart(self, program: str) -> Any:
        """Start a program anew."""
        with self._expecting(program):
            made = self.host.restart(program)
        return self._node_of(made)

    def supervision_of(self, program: str) -> Supervision | None:
        """Return the supervision of a program that a launch file started; None of another."""
        return next((each for each in self.supervisions if program in each.policy.processes), None)

    @contextmanager
    def _expecting(self, program: str) -> Iterator[None]:
        """Expect the end of a program: it is not a failure, and no rule of a launch file is applied."""
        self.expected.add(program)
        if not self.host.program(program).is_over:
            supervision = self.supervision_of(program)
            if supervision is not None:
                supervision.spare(program)
        try:
            yield
        finally:
            self.expected.discard(program)

    @property
    def programs(self) -> list[str]:
        """Names of all programs, ended ones too."""
        programs = [each for name, each in self.host.programs.items() if name != self._own]
        shown = Counter(map(_called, programs))
        return [each.name if shown[_called(each)] > 1 else _called(each) for each in programs]

    def program_of(self, node: str | Named) -> str:
        """Return the program of a node, or of the only one of this name in any namespace. Raises NotFoundError."""
        of_it = [] if isinstance(node, str) else [each for each, it in self.host.programs.items() if node in it.nodes]
        if of_it:
            return of_it[0]
        by_node: dict[str, str] = {}
        for program, names in self.program_faults.injector.network.programs.items():
            by_node.update((name, program) for name in names - by_node.keys())
        found = {by_node[each] for each in meant(full(node), by_node)}
        return found.pop() if len(found) == 1 else by_node[the_one("node", full(node), sorted(by_node))]

    def _on_exit(self, program: Program) -> None:
        code = program.returncode or 0
        is_expected = program.name in self.expected or is_orderly(code, Step.INTERRUPT)
        if program.error is not None or not is_expected:
            self.failures.append(Failure(_called(program), self.now_ns(), _why(program), program.error))

    # Time

    def run_until(self, condition: Callable[[], bool], within: float) -> bool:
        """Let time pass until the condition holds or `within` seconds are over; True if it holds."""
        return self.host.run_until(condition, within)

    # State of the programs

    def nodes(self) -> list[Node]:
        """Return all nodes."""
        return [node for program in self.host.programs.values() for node in program.nodes]

    def nodes_beside(self, started: Any) -> list[Node]:
        """Return the nodes of a program, or of a node's program."""
        program = started if isinstance(started, Program) else self.host.program(self.program_of(started))
        return program.nodes

    def class_of(self, topic: Topic) -> type[Message] | None:
        """Return the message class of a topic's publisher; None if no node here publishes it."""
        for node in self.nodes():
            for each in node.publishers:
                if each.topic_name == topic.name and type_hash(each.msg_type) == topic.type_hash:
                    found: type[Message] = each.msg_type
                    return found
        return None

    def real_time_use(self) -> list[str]:
        """Return which nodes slept or started threads in real time, and where."""
        return [f"{each.program} {each.what} ({each.place})" for each in self.host.real_time_use]

    def fault_reports(self) -> list[str]:
        """Return the effects of each fault of messages."""
        return [str(each) for each in self.program_faults.injector.network.reports]

    def faults_in_vain(self) -> list[str]:
        """Return faults that name what never existed, or whose time came and that met nothing; no wildcards."""
        unmet = self.program_faults.injector.unmet()
        return [each.text for each in unmet if each.why in (Why.WRONG_NAME, Why.IN_VAIN)]

    def close(self) -> None:
        """End all programs."""
        self._stack.close()


def _name_in(node_class: type[BaseNode]) -> str:
    """Return the name that the code of a class gives its nodes, if it stands there: programs are called so.

    A wrong clock must be known by it before there is a node: a context has its time from when it is made on, and the
    node gives its name only then. All other faults learn names as nodes are announced.
    """
    try:
        source = inspect.getsource(node_class.__init__)  # Python parses a whole file to find that of a class
        found = re.search(r"""__init__\(\s*(?:node_name=)?["'](\w+)["']""", source)
    except (OSError, TypeError):
        return ""
    return found[1] if found else ""


def _called(program: Program) -> str:
    """Return a program's name for people: that of its node, if it has one."""
    nodes = program.nodes
    return nodes[0].get_fully_qualified_name().strip("/") if len(nodes) == 1 else program.name


def _why(program: Program) -> str:
    """Return in one line why a program has ended."""
    error = program.error
    if error is None:
        return f"it ended with exit code {program.returncode}"
    frames = traceback.extract_tb(error.__traceback__)
    last = ([each for each in frames if is_users(each.filename)] or frames)[-1:]
    place = f" ({Path(last[0].filename).name}:{last[0].lineno})" if last else ""
    return f"{type(error).__name__}: {error}{place}"
