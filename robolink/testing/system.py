"""The system under test: nodes are started, observed, called and disturbed, in one process and in virtual time."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.constants import MOST_SEED
from robolink.interfaces import find
from robolink.simulate.nodes import robots_of, worlds_of
from robolink.testing.bags import BagRecording, Bags
from robolink.testing.clock import SystemClock
from robolink.testing.expectations import ClosedError, ExpectationError
from robolink.testing.expecting import Expecting, Failures
from robolink.testing.parameters import Parameters
from robolink.testing.robots import RemoteRobots, SimulatedRobot, chosen
from robolink.testing.stage import Failure, Named, NodeRequest, Startable, full, startable
from robolink.testing.stages import make_stage
from robolink.testing.story import Conversation, Story

if TYPE_CHECKING:
    from robolink.bag.playing.playback import Playback
    from robolink.logging import Record
    from robolink.message import Message
    from robolink.node import Node
    from robolink.qos import QoSProfile
    from robolink.task import Future
    from robolink.testing.faults import Faults
    from robolink.world_node import Simulation

T = TypeVar("T")
SystemT = TypeVar("SystemT", bound="System")

PATIENCE = 5.0
"""Default timeout of everything a test waits for, in seconds of the system's time."""


class System:
    """A system of nodes under test, on a network and a clock of their own.

    With `transport` ``memory`` all nodes live in this process, and their time passes only while the test waits: a
    minute takes a fraction of a second, and is the same in every run with the same `seed`. With ``zenoh`` they are
    processes in real time. Relative names are resolved as by a node in ``/``; times are in seconds.

    A program that fails by itself fails the test at its next wait, with a NodeFailure, unless `allow_failures`.
    Every method that lets time pass may raise NodeFailure, and ValueError for a time that is negative or not finite.
    After `close` every method that starts, publishes or waits raises ClosedError.
    """

    def __init__(
        self, seed: int = 0, *, transport: str = "memory", replay: str = "", allow_failures: bool = False
    ) -> None:
        """Create a system without programs.

        Args:
            seed: Seed of all chance: faults, `random`, numpy, the simulated world. From 0 to 2**32 - 1.
            transport: ``memory`` for one process in virtual time, ``zenoh`` for processes in real time.
            replay: Command that repeats the test, for the text of a failure; default ``System(seed=...)``.
            allow_failures: True keeps programs that fail from failing the test; `failures` has them all the same.

        Raises:
            ValueError: if `seed` is out of range, or `transport` is another word.
        """
        if not isinstance(seed, int) or not 0 <= seed <= MOST_SEED:
            raise ValueError(f"expected a seed from 0 to {MOST_SEED}, got {seed!r}")
        self.seed, self.allow_failures = seed, allow_failures
        self._is_closed = False
        self._stage = make_stage(transport, seed)
        self.clock = SystemClock(self)
        self.story = Story(self._stage, replay or f"System(seed={seed})")
        """Log of the system for the text of a failure; `story.whole()` returns all of it as text."""
        self.bags = Bags(self._stage, self.story.recorder)
        self._conversation = Conversation(self._stage.node, self.story)
        self._expecting = Expecting(self._stage, self.story, self._conversation, self._run_until)
        self._failures = Failures(self._stage, self.story)
        self._parameters = Parameters(self._stage, self.story.graph, self._expecting)
        self._elsewhere = [] if self.virtual else RemoteRobots(self.story.recorder).robots

    @property
    def virtual(self) -> bool:
        """True if time is virtual: it passes only while the test waits."""
        return self._stage.virtual

    @property
    def node(self) -> Node:
        """The test's own node, ``/test``, for publishers, subscriptions and clients. Faults concern it, too."""
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
        """Start a node in a program of its own, and return the node.

        Args:
            what: A Node class, a name as `robolink run` finds it, a path to a file, or the `main` function of a file.
            name: Name of the node; by default the one that its code gives.
            namespace: Namespace of the node; by default the one that its code gives.
            parameters: Values by parameter name. One that no node of the program declares fails the test.
            remappings: New names by old names, as ``{"scan": "front/scan"}``.
            args: Words of its command line, without the program's name.

        Returns:
            The node; with ``zenoh`` a stand-in that knows its names. A file with a `main` of its own that makes no node
            at once returns its program: it begins when time passes, and then `nodes` lists its nodes.

        Raises:
            TypeError: if `what` is nothing that can be started.
            NotFoundError: if there is no node or file of this name.
            OnlyInMemoryError: with ``zenoh``, for a class inside of a function, which another process cannot import.
            NodeFailure: with ``zenoh``, if the process ends before its node is made. In memory, whatever the node's
                constructor raises is raised as it is.
        """
        __tracebackhide__ = True
        self._check_open()
        request = NodeRequest(startable(what), name, namespace, parameters or {}, remappings or {}, tuple(args))
        started = self._stage.start(request)
        self._stage.settle(self.story.recorder)
        self._parameters.note_given(started, request.parameters)
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
        """Start the nodes of a launch file.

        Commands of the file are left out in virtual time, with a warning.

        Args:
            file: Path, or a name as `robolink launch` finds it, or a package and a name: ``my_robot bot.launch.py``.
            arguments: Values of the launch file's own arguments, by name.
            set: Parameter values that go before the file's, as ``{"wall_follower.speed": 0.2}``.
            faults: Path of a file of faults, which hold from the very start of the nodes.

        Raises:
            NotFoundError: if a file, node or argument does not exist.
            DocumentError: if a file has a mistake, with `file:line:column`.
            TypeError: if `faults` is not a path.
        """
        __tracebackhide__ = True
        from robolink.testing.launching import read

        self._check_open()
        self._stage.launch(read(file, arguments or {}, set or {}), faults)
        self._stage.settle(self.story.recorder)
        self._parameters.note_set(set or {})
        self._begin()

    def stop(self, node: str | Named) -> None:
        """End a node's program in order, as Ctrl-C does: its clean-up code runs.

        Args:
            node: The node, or its name (with its namespace, where the name alone is not unique).

        Raises:
            NotFoundError: if no program has such a node, or several have.
        """
        __tracebackhide__ = True
        self._stage.stop(self._stage.program_of(node))
        self._begin()

    def crash(self, node: str | Named) -> None:
        """End the program of `node` at once, as `kill -9` does, which is not a failure. Raises what `stop` raises."""
        __tracebackhide__ = True
        self._stage.crash(self._stage.program_of(node))
        self._begin()

    def restart(self, node: str | Named) -> Any:
        """Start the program of `node` again as it was started, ended first if it still runs; return the new node.

        Raises what `stop` and `start` raise.
        """
        __tracebackhide__ = True
        self._check_open()
        started = self._stage.restart(self._stage.program_of(node))
        self._stage.settle(self.story.recorder)
        self._begin()
        return started

    @property
    def programs(self) -> list[str]:
        """Names of the system's programs, ended ones included: that of the node, if one program alone has it."""
        return self._stage.programs

    @property
    def failures(self) -> list[Failure]:
        """Programs that ended and should not have, oldest first: each with `program`, `time_ns`, `why` and `error`."""
        return list(self._stage.failures)

    @property
    def logs(self) -> list[Record]:
        """All log records so far: each with `message`, `name` (the logger's), `severity` and `stamp_ns`."""
        return list(self._stage.logs)

    # The graph

    @property
    def nodes(self) -> list[str]:
        """Full names of all nodes, without the test's own, sorted."""
        return self.story.graph.nodes()

    @property
    def topics(self) -> dict[str, str]:
        """Types of all topics by name, several with commas, without /rosout and /parameter_events of every node."""
        return self.story.graph.topics()

    @property
    def services(self) -> dict[str, str]:
        """Types of all services by name, without those for parameters and types, which every node has."""
        return self.story.graph.services()

    def publishers(self, topic: str) -> list[str]:
        """Return the full names of the nodes that publish `topic`, without the test's own."""
        return list(self.story.graph.ends(self.node.resolve_topic_name(topic)).publishers)

    def subscribers(self, topic: str) -> list[str]:
        """Return the full names of the nodes that subscribe to `topic`, without the test's own."""
        return list(self.story.graph.ends(self.node.resolve_topic_name(topic)).subscribers)

    # Messages

    def publish(self, topic: str, message: Message, qos: QoSProfile | int = 10) -> None:
        """Publish a message from the test's own node. It arrives when time passes next.

        Args:
            topic: Name of the topic.
            message: The message; its class is the topic's type.
            qos: Profile or depth of the publisher, which is made at the first message of a topic and kept.

        Raises:
            TypeError: if `topic` is not text, or `message` no message.
        """
        __tracebackhide__ = True
        self._check_open()
        self._begin()
        self._conversation.publish(topic, message, qos)

    def messages(self, topic: str, type: type[Message] | None = None) -> list[Any]:  # noqa: A002 - what it is
        """Return a list that fills with the messages of a topic, from now on, whenever time passes.

        Messages that publishers keep for late subscriptions (TRANSIENT_LOCAL) come first.

        Args:
            topic: Name of the topic, which need not exist yet.
            type: Message class; by default the publishers' own, which over Zenoh must be installed.

        Returns:
            The list of messages, oldest first.
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
        """Wait for a message that meets a condition, and return it.

        A message counts if it was published after the test's last act (publish, call, set, start, end, let time pass)
        and after the message that `expect` found last on the topic. Messages that publishers keep for late
        subscriptions (TRANSIENT_LOCAL) count, too.

        Args:
            topic: Name of the topic.
            predicate: Called with each message; the first for which it returns true is taken. None takes any message.
            within: Timeout in seconds of the system's time.
            type: Message class; by default the publishers' own, which over Zenoh must be installed.

        Returns:
            The message.

        Raises:
            ExpectationError: if no such message came in time; the text has the last messages of the topics concerned.
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
        """Let time pass in which no message that meets a condition may come.

        Args:
            topic: Name of the topic.
            predicate: Called with each message; one for which it returns true fails the test. None means any message.
            during: Duration in seconds of the system's time.
            type: Message class; by default the publishers' own, which over Zenoh must be installed.

        Raises:
            ExpectationError: as soon as such a message comes.
        """
        __tracebackhide__ = True
        self._expecting.no_message(topic, predicate, during, type)
        self._begin()

    # Anything else that is waited for

    def wait_until(self, condition: Callable[[], object], within: float = PATIENCE) -> None:
        """Let time pass until a condition holds.

        Args:
            condition: Called after each callback of the system, without arguments, until it returns true.
            within: Timeout in seconds of the system's time.

        Raises:
            ExpectationError: if it did not hold in time.
        """
        __tracebackhide__ = True
        self._expecting.condition(condition, within)
        self._begin()

    def result(self, future: Future[T], within: float = 60.0) -> T:
        """Let time pass until a future is done, and return its result or raise its exception.

        Args:
            future: The future, such as one of `call_async` or `send_goal_async`.
            within: Timeout in seconds of the system's time.

        Raises:
            ExpectationError: if it was not done in time.
        """
        __tracebackhide__ = True
        result = self._expecting.result(future, within)
        self._begin()
        return result

    def expect_log(self, words: str, within: float = PATIENCE) -> Record:
        """Wait for a log line that contains some words, and return it.

        The search begins behind the line that the last `expect_log` found, with lines logged before this call too:
        several calls check an order.

        Args:
            words: Text that the line must contain, in the same case.
            within: Timeout in seconds of the system's time.

        Returns:
            The log record, with `message`, `name`, `severity` and `stamp_ns`.

        Raises:
            ExpectationError: if no such line came in time.
        """
        __tracebackhide__ = True
        return self._expecting.log_line(words, within)

    # Services and parameters

    def call(self, srv_type: type[Any] | str, name: str, request: Any = None, within: float = PATIENCE) -> Any:
        """Call a service and return its response.

        Args:
            srv_type: Service class, or its name such as ``std_srvs/srv/Trigger``.
            name: Name of the service.
            request: The request; None sends one of default values.
            within: Timeout in seconds of the system's time, for the service to appear and again for its response.

        Raises:
            ExpectationError: if there is no such service, or no response in time.
        """
        __tracebackhide__ = True
        self._check_open()
        kind = find(srv_type, "srv") if isinstance(srv_type, str) else srv_type
        self._begin()
        return self._expecting.answer(kind, name, request, within)

    def parameter(self, node: str | Named, name: str, within: float = PATIENCE) -> Any:
        """Return the value of a node's parameter.

        Args:
            node: The node, or its full name.
            name: Name of the parameter.
            within: Timeout in seconds of each service call, if the node lives in another process.

        Raises:
            NotFoundError: if there is no such node.
            ParameterNotDeclaredException: if the node has not declared it, with the nearest name that it has.
            ExpectationError: if the node did not answer in time.
        """
        __tracebackhide__ = True
        return self._parameters.value_of(full(node), name, within)

    def set_parameter(self, node: str | Named, name: str, value: Any, within: float = PATIENCE) -> None:
        """Set a node's parameter. Raises what `parameter` raises, and one error more.

        Args:
            node: The node, or its full name.
            name: Name of the parameter.
            value: The new value. An integer serves for a parameter that is a double.
            within: Timeout in seconds of each service call, if the node lives in another process.

        Raises:
            InvalidParameterValueException: if the node refuses the value, with its reason.
        """
        __tracebackhide__ = True
        self._begin()
        self._parameters.set_value(full(node), name, value, within)

    # Bags

    def play(
        self,
        bag: str | PathLike[str],
        topics: Sequence[str] | None = None,
        *,
        exclude: Sequence[str] = (),
        rate: float = 1.0,
        start_offset: float = 0.0,
        duration: float | None = None,
        loop: bool = False,
        clock: float = 0.0,
        remappings: Mapping[str, str] | None = None,
    ) -> Playback:
        """Play a bag into the system, by a node ``rosbag2_player``, from now on while time passes.

        In virtual time the messages keep their distances to the nanosecond, so that each run is the same.

        Args:
            bag: The bag: a folder, or one .mcap or .db3 file.
            topics: Topics to play; None is all.
            exclude: Topics to leave out.
            rate: Seconds of the bag in a second of the system.
            start_offset: Point of the bag to begin at, in seconds from its start.
            duration: Length of what is played, in seconds of the bag; None is all.
            loop: True to begin again at the end.
            clock: Messages on /clock in a second, for nodes with `use_sim_time`; 0 for none.
            remappings: New names by old names, as ``{"/scan": "/front/scan"}``.

        Returns:
            The playback, to `pause`, `resume`, `seek`, `play_next` or `stop`; `is_over` is true after its end.

        Raises:
            BagError: (a ValueError) if the bag cannot be read.
            PlayError: (a ValueError) if a value is out of range, or nothing is selected.
        """
        __tracebackhide__ = True
        self._check_open()
        options = {"rate": rate, "loop": loop, "start_offset": start_offset, "duration": duration, "clock_rate": clock}
        playback = self.bags.play(bag, topics, exclude, remappings or {}, **options)
        self._begin()
        return playback

    def record(self, path: str | PathLike[str] | None = None, topics: Sequence[str] | None = None) -> BagRecording:
        """Record the system into a bag from now on, until `stop` of what is returned, or the end of the system.

        Nobody in the system sees it. The bag of a test that fails is kept, and the failure says where.

        Args:
            path: Folder of the bag, which must not be there yet. None makes one, which a test that passes deletes.
            topics: Topics to record; None is all.

        Returns:
            The recording: `path`, `messages` and `stop()`; also for a `with`.

        Raises:
            BagError: (a ValueError) if the folder is there already.
            OSError: if it cannot be made.
        """
        __tracebackhide__ = True
        self._check_open()
        return self.bags.record(path, topics)

    # Faults, and the simulated world

    @property
    def faults(self) -> Faults:
        """Fault injection: lost and late messages, partitions, crashes, wrong clocks."""
        return self._stage.faults

    def robot(self, name: str | None = None) -> SimulatedRobot:
        """Return a robot of the simulated world in its true state, which no sensor noise changes.

        Args:
            name: Name of the robot; in a namespace ``one/robot``, or the last part where it is unique. None is the only
                robot of the world.

        Returns:
            The robot, with `pose`, `twist`, `contacts`, `driven` (in m) and `area` (the box in which it has been, with
            `width` and `height` in m). It follows the world as time passes.

        Raises:
            NotFoundError: if there is no world, no such robot, or several that may be meant.
        """
        __tracebackhide__ = True
        elsewhere = ((each.name, each) for each in self._elsewhere)
        return chosen([*robots_of(self._stage.nodes()), *elsewhere], name)

    def simulations(self) -> list[Simulation]:
        """Return the simulated worlds of this process with their shapes, for pictures; none with ``zenoh``."""
        return [each for _, each in worlds_of(self._stage.nodes())]

    # Time

    @property
    def time(self) -> float:
        """Seconds since the beginning of the system."""
        return self.story.time

    def run(self, seconds: float) -> None:
        """Let time pass.

        Args:
            seconds: Duration in seconds of the system's time.
        """
        __tracebackhide__ = True
        self._run_until(lambda: False, seconds)
        self._begin()

    def check(self) -> None:
        """Raise NodeFailure if a program has failed since the test waited last. Lets no time pass."""
        __tracebackhide__ = True
        self._run_until(lambda: True, 0.0)

    def check_faults(self) -> None:
        """Raise ExpectationError if a fault had no effect: a test with it would pass whatever the nodes do.

        Such a fault names what never existed, or its time came and it met nothing. Faults with wildcards are not
        checked. The end of a test, and of a `with`, calls this by itself.
        """
        __tracebackhide__ = True
        self._check_open()
        if in_vain := self._stage.faults_in_vain():
            raise ExpectationError(self.story.failure_text("\n".join(in_vain)))

    def _run_until(self, condition: Callable[[], bool], within: float) -> bool:
        """Let time pass until a condition holds; True if it does. Raises NodeFailure if a program fails first."""
        __tracebackhide__ = True
        self._check_open()
        if not (math.isfinite(within) and within >= 0):
            raise ValueError(f"expected seconds, 0 or more, got {within!r}")
        begin = self.time
        met = self._stage.run_until(lambda: self._has_failed() or condition(), within)
        self._conversation.hear()
        if self._has_failed():
            self._failures.raise_new()
        if self.time > begin:
            self._parameters.check_given()
        return met

    def _begin(self) -> None:
        """Make only messages from now on count; earlier ones are already in the lists that are kept."""
        self._conversation.hear()
        self._expecting.begin()

    def _check_open(self) -> None:
        """Raise ClosedError if the system is closed."""
        __tracebackhide__ = True
        if self._is_closed:
            raise ClosedError("this system is closed: it lasts as long as its `with`, or the test whose fixture it is")

    def _has_failed(self) -> bool:
        return not self.allow_failures and self._failures.are_new()

    # The end

    def close(self) -> None:
        """End all programs and release everything. Safe to call twice."""
        self.bags.close()
        self._is_closed = True
        self._conversation.close()
        self.story.recorder.close()
        self._stage.close()

    def __enter__(self: SystemT) -> SystemT:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        __tracebackhide__ = True
        try:
            if kind is None and not self._is_closed:
                self.check_faults()
        finally:
            self.close()
