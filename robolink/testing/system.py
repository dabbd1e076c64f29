"""A system of nodes under test: started, watched, asked and disturbed, in one process and in virtual time."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.faults.description import MOST_SEED
from robolink.interfaces import find
from robolink.simulating.robots import robots_of
from robolink.testing.clock import SystemClock
from robolink.testing.conversation import Conversation
from robolink.testing.expectations import ClosedError, ExpectationError, NodeFailure
from robolink.testing.expecting import Expecting
from robolink.testing.parameters import Parameters
from robolink.testing.robots import RobotsElsewhere, SimulatedRobot, chosen
from robolink.testing.stage import Failure, Named, Startable, Wanted, full, startable
from robolink.testing.stages import make_stage
from robolink.testing.story import Story

if TYPE_CHECKING:
    from robolink.logging import Record
    from robolink.message import Message
    from robolink.node import Node
    from robolink.qos import QoSProfile
    from robolink.task import Future
    from robolink.testing.faults import Faults

T = TypeVar("T")

PATIENCE = 5.0
"""Seconds that are waited for what is expected."""


class System:
    """The nodes of one test, on a network and a clock of their own.

    With `transport` ``memory`` all of them live in this process, and their time passes only while the test waits: a
    minute takes a fraction of a second, and is the same in every run with this `seed`. With ``zenoh`` they are
    processes. `replay` is what a failure says should be typed to see it again.

    A program that fails by itself fails the test as soon as it waits, with a NodeFailure, unless `allow_failures`.
    Relative names are resolved as by a node in /; times are in seconds.
    """

    def __init__(
        self, seed: int = 0, *, transport: str = "memory", replay: str = "", allow_failures: bool = False
    ) -> None:
        if not isinstance(seed, int) or not 0 <= seed <= MOST_SEED:
            raise ValueError(f"expected a seed from 0 to {MOST_SEED}, got {seed!r}")
        self.seed, self.allow_failures = seed, allow_failures
        self._is_closed, self._reported = False, 0
        self._stage = make_stage(transport, seed)
        self.clock = SystemClock(self)
        self.story = Story(self._stage, replay or f"System(seed={seed})")
        """What a test is told when something did not come true; `story.whole()` tells all of it."""
        self._conversation = Conversation(self._stage.node, self.story)
        self._expecting = Expecting(self._stage, self.story, self._conversation, self._run_until)
        self._parameters = Parameters(self._stage, self.story.graph, self._expecting)
        self._elsewhere = [] if self.virtual else RobotsElsewhere(self.story.recorder).robots

    @property
    def virtual(self) -> bool:
        """Whether time passes only while the test waits."""
        return self._stage.virtual

    @property
    def node(self) -> Node:
        """The test's own node, /test: for publishers, subscriptions and clients; faults concern it as any other."""
        return self._stage.node

    # Programs

    def start(
        self,
        what: Startable,
        *,
        name: str = "",
        namespace: str = "",
        parameters: Mapping[str, Any] | None = None,
        remappings: Mapping[str, str] | None = None,
        args: Sequence[str] = (),
    ) -> Any:
        """Start a node: its class, a name as `robolink run` finds it, a file, or a main() of one; give it.

        `args` are words of its command line. What its constructor raises is raised here. Of a file with a main() of its
        own its program is given: it begins when time passes, and then `nodes` has its nodes.
        """
        __tracebackhide__ = True
        self._check_open()
        wanted = Wanted(startable(what), name, namespace, parameters or {}, remappings or {}, tuple(args))
        started = self._stage.start(wanted)
        self._parameters.note_given(started, wanted.parameters)
        self._begin()
        return started

    def launch(
        self,
        file: str | PathLike[str],
        arguments: Mapping[str, Any] | None = None,
        *,
        set: Mapping[str, Any] | None = None,  # noqa: A002 - as `simulate --set`
        faults: str | PathLike[str] | None = None,
    ) -> None:
        """Start what a launch file says: a file, or a name as `robolink launch` finds it.

        `arguments` are the file's own, `set` gives parameters as ``{"wall_follower.speed": 0.2}``, and `faults` is a
        file of faults. Raises NotFoundError, and DocumentError with `file:line:column`.
        """
        __tracebackhide__ = True
        from robolink.testing.launching import read

        self._check_open()
        self._stage.launch(read(file, arguments or {}, set or {}), faults)
        self._parameters.note_set(set or {})
        self._begin()

    def stop(self, node: str | Named) -> None:
        """End a node's program as Ctrl-C does: it may still say its last words."""
        __tracebackhide__ = True
        self._stage.stop(self._stage.program_of(node))
        self._begin()

    def crash(self, node: str | Named) -> None:
        """End a node's program at once, as `kill -9` does. That is no failure of the test."""
        __tracebackhide__ = True
        self._stage.crash(self._stage.program_of(node))
        self._begin()

    def restart(self, node: str | Named) -> Any:
        """Start a node's program anew, with all that it was started with; give what `start` gave."""
        __tracebackhide__ = True
        self._check_open()
        started = self._stage.restart(self._stage.program_of(node))
        self._begin()
        return started

    @property
    def programs(self) -> list[str]:
        """The names of the programs of this system, also of those that have ended."""
        return self._stage.programs

    @property
    def failures(self) -> list[Failure]:
        """The programs that ended and should not have, the first one first."""
        return list(self._stage.failures)

    # Messages

    def publish(self, topic: str, message: Message, qos: QoSProfile | int = 10) -> None:
        """Publish a message from the test's own node; it arrives when time passes next."""
        __tracebackhide__ = True
        self._check_open()
        self._begin()
        self._conversation.publish(topic, message, qos)

    def messages(self, topic: str, type: type[Message] | None = None) -> list[Any]:  # noqa: A002 - what it is
        """Give a list that fills with what is published on a topic from now on, whenever time passes.

        What publishers keep for those who come late (TRANSIENT_LOCAL) comes first. The class is the publishers' own;
        over Zenoh it must be installed or given as `type`.
        """
        __tracebackhide__ = True
        self._check_open()
        return self._conversation.keep(topic, type)

    def expect(
        self,
        topic: str,
        predicate: Callable[[Any], object] | None = None,
        within: float = PATIENCE,
        *,
        type: type[Message] | None = None,  # noqa: A002 - what it is
    ) -> Any:
        """Wait for a message for which `predicate(message)` is true, or for any; give it.

        What counts is published since the test last published, called, set, started or ended something or let time
        pass, and after what `expect` found last on the topic; and what publishers keep for those who come late. Raises
        ExpectationError after `within` seconds, with the last messages of the topics concerned.
        """
        __tracebackhide__ = True
        return self._expecting.message(topic, predicate, within, type)

    def expect_none(
        self,
        topic: str,
        predicate: Callable[[Any], object] | None = None,
        during: float = PATIENCE,
        *,
        type: type[Message] | None = None,  # noqa: A002 - what it is
    ) -> None:
        """Let so many seconds pass. Raises ExpectationError as soon as a message comes that fulfils the condition."""
        __tracebackhide__ = True
        self._expecting.no_message(topic, predicate, during, type)
        self._begin()

    # Anything else that is waited for

    def wait_until(self, condition: Callable[[], object], within: float = PATIENCE) -> None:
        """Let time pass until `condition()` is true; it is asked after each callback.

        Raises ExpectationError after `within` seconds.
        """
        __tracebackhide__ = True
        self._expecting.condition(condition, within)
        self._begin()

    def result(self, future: Future[T], within: float = 60.0) -> T:
        """Let time pass until a future is done; give its result, or raise what it holds.

        Raises ExpectationError after `within` seconds.
        """
        __tracebackhide__ = True
        result = self._expecting.result(future, within)
        self._begin()
        return result

    def expect_log(self, words: str, within: float = PATIENCE) -> Record:
        """Wait for a log line that has these words in it; give it.

        Looked at are the lines after the one that the last `expect_log` found, also those logged before this call: so
        several calls ask for an order. Raises ExpectationError after `within` seconds.
        """
        __tracebackhide__ = True
        return self._expecting.log_line(words, within)

    @property
    def logs(self) -> list[Record]:
        """All that was logged so far: each with `message`, `name` (the logger's), `severity` and `stamp_ns`."""
        return list(self._stage.logs)

    # Services and parameters

    def call(self, srv_type: type[Any] | str, name: str, request: Any = None, within: float = PATIENCE) -> Any:
        """Call a service and give its answer; without a `request`, with the default one.

        `srv_type` is a class or a name such as ``std_srvs/srv/Trigger``. Raises ExpectationError when nobody answers
        within so many seconds.
        """
        __tracebackhide__ = True
        self._check_open()
        kind = find(srv_type, "srv") if isinstance(srv_type, str) else srv_type
        self._begin()
        return self._expecting.answer(kind, name, request, within)

    def parameter(self, node: str | Named, name: str, within: float = PATIENCE) -> Any:
        """Give the value of a node's parameter. Raises ParameterNotDeclaredException, with the nearest name."""
        __tracebackhide__ = True
        return self._parameters.value_of(full(node), name, within)

    def set_parameter(self, node: str | Named, name: str, value: Any, within: float = PATIENCE) -> None:
        """Set a node's parameter. Raises InvalidParameterValueException with the reason when the node refuses."""
        __tracebackhide__ = True
        self._begin()
        self._parameters.set_value(full(node), name, value, within)

    # The graph

    @property
    def nodes(self) -> list[str]:
        """The full names of all nodes that are there, but the test's own."""
        return self.story.graph.nodes()

    @property
    def topics(self) -> dict[str, str]:
        """All topics of the nodes with their types, but /rosout and /parameter_events, which every node has.

        Two types that meet on one topic are parted by a comma.
        """
        return self.story.graph.topics()

    @property
    def services(self) -> dict[str, str]:
        """All services of the nodes with their types, but those for parameters and types, which every node has."""
        return self.story.graph.services()

    def publishers(self, topic: str) -> list[str]:
        """The nodes that publish a topic, but the test's own."""
        return list(self.story.graph.ends(self.node.resolve_topic_name(topic)).given)

    def subscribers(self, topic: str) -> list[str]:
        """The nodes that subscribe to a topic, but the test's own."""
        return list(self.story.graph.ends(self.node.resolve_topic_name(topic)).taken)

    # Faults, and the simulated world

    @property
    def faults(self) -> Faults:
        """What goes wrong on purpose: lost and late messages, parted nodes, crashes, wrong clocks."""
        return self._stage.faults

    def robot(self, name: str | None = None) -> SimulatedRobot:
        """Give a robot of the simulated world in this system, as it truly is.

        It has a `pose`, a `twist`, `contacts`, the metres that it has `driven`, and the `area` in which it has been
        (`width` and `height` in metres). The robot of a world in a namespace is called ``one/robot``; its last name
        serves too, where no other has it. Raises NotFoundError when there is no world, no such robot, or several that
        may be meant.
        """
        __tracebackhide__ = True
        elsewhere = ((each.name, each) for each in self._elsewhere)
        return chosen([*robots_of(self._stage.nodes()), *elsewhere], name)

    # Time

    @property
    def time(self) -> float:
        """Seconds since the beginning of the system."""
        return self.story.time

    def run(self, seconds: float) -> None:
        """Let so many seconds pass. Raises NodeFailure when a program fails meanwhile."""
        __tracebackhide__ = True
        self._run_until(lambda: False, seconds)
        self._begin()

    def check(self) -> None:
        """Raise NodeFailure when a program has failed since the test waited last."""
        __tracebackhide__ = True
        self._run_until(lambda: True, 0.0)

    def check_faults(self) -> None:
        """Raise ExpectationError when a fault has come to nothing: a test of it would pass whatever the nodes do.

        That is a fault with a name that nobody ever had, or whose time came and that met nothing, unless it has
        wildcards. The end of a test, and of a `with`, looks by itself.
        """
        __tracebackhide__ = True
        self._check_open()
        if in_vain := self._stage.faults_in_vain():
            raise ExpectationError(self.story.told("\n".join(in_vain)))

    def _run_until(self, condition: Callable[[], bool], within: float) -> bool:
        """Let time pass until a condition holds; whether it does. Raises NodeFailure when a program fails first."""
        __tracebackhide__ = True
        self._check_open()
        if not (math.isfinite(within) and within >= 0):
            raise ValueError(f"expected seconds, 0 or more, got {within!r}")
        begin = self.time
        met = self._stage.run_until(lambda: self._has_failed() or condition(), within)
        self._conversation.hear()
        if self._has_failed():
            self._raise_failure()
        if self.time > begin:
            self._parameters.check_given()
        return met

    def _begin(self) -> None:
        """Have only what comes from now on count; what came before is in the lists that are kept."""
        self._conversation.hear()
        self._expecting.begin()

    def _check_open(self) -> None:
        """Raise ClosedError once there is nothing left that could be asked."""
        __tracebackhide__ = True
        if self._is_closed:
            raise ClosedError("this system is closed: it lasts as long as its `with`, or the test whose fixture it is")

    def _has_failed(self) -> bool:
        return not self.allow_failures and len(self._stage.failures) > self._reported

    def _raise_failure(self) -> None:
        __tracebackhide__ = True
        failures = self._stage.failures[self._reported :]
        self._reported = len(self._stage.failures)
        for each in failures:
            is_own = each.program == self.story.graph.own_name.strip("/")
            if each.error is not None and (is_own or not isinstance(each.error, Exception)):
                raise each.error  # what a callback of the test's own says, it says itself; so does pytest.skip()
        raise NodeFailure(self.story.told_of(failures)) from failures[0].error

    # The end

    def close(self) -> None:
        """End all programs; nothing of them is left. Safe to call twice."""
        self._is_closed = True
        self._conversation.close()
        self.story.recorder.close()
        self._stage.close()

    def __enter__(self) -> System:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        __tracebackhide__ = True
        try:
            if kind is None and not self._is_closed:
                self.check_faults()
        finally:
            self.close()
