"""Base of a system under test: its runner, its time, its graph, and the failures of its programs."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

from robolink.constants import MOST_SEED
from robolink.simulate.robots import robots_of, worlds_of
from robolink.testing.clock import SystemClock
from robolink.testing.conversation import Conversation
from robolink.testing.expectations import ClosedError, ExpectationError, NodeFailure
from robolink.testing.expecting import Expecting
from robolink.testing.parameters import Parameters
from robolink.testing.robots import RemoteRobots, SimulatedRobot, chosen
from robolink.testing.stage import Failure
from robolink.testing.stages import make_stage
from robolink.testing.story import Story

if TYPE_CHECKING:
    from robolink.logging import Record
    from robolink.node import Node
    from robolink.testing.faults import Faults
    from robolink.world_node import Simulation

SystemT = TypeVar("SystemT", bound="SystemBase")


class SystemBase:
    """A system that can be observed and whose time passes; `System` starts its programs and talks to them."""

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
        self._is_closed, self._reported = False, 0
        self._stage = make_stage(transport, seed)
        self.clock = SystemClock(self)
        self.story = Story(self._stage, replay or f"System(seed={seed})")
        """Log of the system for the text of a failure; `story.whole()` returns all of it as text."""
        self._conversation = Conversation(self._stage.node, self.story)
        self._expecting = Expecting(self._stage, self.story, self._conversation, self._run_until)
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
        """Types of all topics by name, without /rosout and /parameter_events, which every node has.

        Several types on one topic are separated by a comma.
        """
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

        Raises:
            NodeFailure: if a program failed meanwhile.
            ValueError: if `seconds` is negative or not finite.
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
            self._raise_failure()
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
        return not self.allow_failures and len(self._stage.failures) > self._reported

    def _raise_failure(self) -> None:
        __tracebackhide__ = True
        failures = self._stage.failures[self._reported :]
        self._reported = len(self._stage.failures)
        for each in failures:
            is_own = each.program == self.story.graph.own_name.strip("/")
            if each.error is not None and (is_own or not isinstance(each.error, Exception)):
                raise each.error  # what a callback of the test's own says, it says itself; so does pytest.skip()
        raise NodeFailure(self.story.failures_text(failures)) from failures[0].error

    # The end

    def close(self) -> None:
        """End all programs and release everything. Safe to call twice."""
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
