"""A system of nodes under test: started, watched, asked and disturbed, in one process and in virtual time."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

from robolink.simulating.robots import robots_of
from robolink.testing.clock import SystemClock
from robolink.testing.expectations import NodeFailure, seconds
from robolink.testing.observing import Observing
from robolink.testing.robots import RobotsElsewhere, SimulatedRobot, chosen
from robolink.testing.stage import Failure, Stage, Startable, Wanted

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.testing.faults import Faults


class System(Observing):
    """The nodes of one test, on a network and a clock of their own.

    With `transport` ``memory`` all of them live in this process, and their time passes only while the test waits: a
    minute takes a fraction of a second, and is the same in every run with this `seed`. With ``zenoh`` they are
    processes. `replay` is what a failure says should be typed to see it again.

    A program that fails by itself fails the test as soon as it waits, with a NodeFailure, unless `allow_failures`.
    """

    def __init__(
        self, seed: int = 0, *, transport: str = "memory", replay: str = "", allow_failures: bool = False
    ) -> None:
        self.seed, self.allow_failures = seed, allow_failures
        super().__init__(_stage(transport, seed), replay or f"System(seed={seed})")
        self.clock = SystemClock(self)
        self._elsewhere = [] if self.virtual else RobotsElsewhere(self.recorder).robots
        self._reported = 0

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
        """Start a node: its class, a name as `robolink run` finds it, or a file; give it.

        What its constructor raises is raised here. Of a file with a main() of its own, which also gets `args`, its
        program is given: it begins when time passes, and then `nodes` has its nodes.
        """
        __tracebackhide__ = True
        return self._stage.start(Wanted(what, name, namespace, parameters or {}, remappings or {}, tuple(args)))

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

        self._stage.launch(read(file, arguments or {}, set or {}))
        if faults is not None:
            self.faults.read(faults)

    def stop(self, node: str | Node) -> None:
        """End a node's program as Ctrl-C does: it may still say its last words."""
        self._stage.stop(self._program(node))

    def crash(self, node: str | Node) -> None:
        """End a node's program at once, as `kill -9` does. That is no failure of the test."""
        self._stage.crash(self._program(node))

    def restart(self, node: str | Node) -> Any:
        """Start a node's program anew, with all that it was started with; give what `start` gave."""
        __tracebackhide__ = True
        return self._stage.restart(self._program(node))

    @property
    def programs(self) -> list[str]:
        """The names of the programs of this system, also of those that have ended."""
        return self._stage.programs

    @property
    def failures(self) -> list[Failure]:
        """The programs that ended and should not have, the first one first."""
        return list(self._stage.failures)

    def _program(self, node: str | Node) -> str:
        return self._stage.program_of(node if isinstance(node, str) else node.get_fully_qualified_name())

    # Faults, and the simulated world

    @property
    def faults(self) -> Faults:
        """What goes wrong on purpose: lost and late messages, parted nodes, crashes, wrong clocks."""
        return self._stage.faults

    def robot(self, name: str | None = None) -> SimulatedRobot:
        """Give a robot of the simulated world in this system, as it truly is.

        It has a `pose`, a `twist`, `contacts`, and the metres that it has `driven`. Raises NotFoundError when there
        is no world, no such robot, or several and no `name`.
        """
        return chosen([*robots_of(self._stage.nodes()), *self._elsewhere], name)

    # Time

    @property
    def time(self) -> float:
        """Seconds since the beginning of the system."""
        return (self._stage.now_ns() - self._stage.begin_ns) / 1e9

    def run(self, seconds: float) -> None:
        """Let so many seconds pass. Raises NodeFailure when a program fails meanwhile."""
        __tracebackhide__ = True
        self._run_until(lambda: False, seconds)

    def _run_until(self, condition: Callable[[], bool], within: float) -> bool:
        """Let time pass until a condition holds; whether it does. Raises NodeFailure when a program fails first."""
        __tracebackhide__ = True
        met = self._stage.run_until(lambda: self._has_failed() or condition(), within)
        self._hear()
        if self._has_failed():
            self._raise_failure()
        return met

    def _has_failed(self) -> bool:
        return not self.allow_failures and len(self._stage.failures) > self._reported

    def _raise_failure(self) -> None:
        __tracebackhide__ = True
        failures = self._stage.failures[self._reported :]
        self._reported = len(self._stage.failures)
        for each in failures:
            if each.error is not None and each.program == self.own_name.strip("/"):
                raise each.error  # what a callback of the test's own says, it says itself
        told = [f"{each.program} failed at {seconds(self._since(each.time_ns))}: {each.why}" for each in failures]
        raise NodeFailure(self._told("\n".join(told), ())) from failures[0].error

    # The end

    def close(self) -> None:
        """End all programs; nothing of them is left. Safe to call twice."""
        self._close_ears()
        self._stage.close()

    def __enter__(self) -> System:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _stage(transport: str, seed: int) -> Stage:
    if transport == "zenoh":
        from robolink.testing.processes import Processes

        return Processes()
    if transport == "memory":
        from robolink.testing.one_process import OneProcess

        return OneProcess(seed)
    raise ValueError(f"no transport '{transport}' for tests: expected memory or zenoh")
