"""What a test sees of a system: messages, log lines, parameters, services, and who is there."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, TypeVar, cast

from robolink.interfaces import find
from robolink.testing.expectations import ExpectationError, named, no_such, seconds, span
from robolink.testing.reporting import Reporting

if TYPE_CHECKING:
    from robolink.logging import Record
    from robolink.message import Message
    from robolink.publisher import Publisher
    from robolink.qos import QoSProfile
    from robolink.task import Future
    from robolink.testing.recorder import Ear
    from robolink.testing.stage import Stage

T = TypeVar("T")

PATIENCE = 5.0
"""Seconds that are waited for what is expected."""


class Observing(Reporting):
    """The part of a system that looks. Relative names are resolved as by a node in /; times are in seconds."""

    def __init__(self, stage: Stage, replay: str) -> None:
        super().__init__(stage, replay)
        self._kept: list[tuple[Ear, list[Any], type[Message] | None]] = []
        self._publishers: dict[tuple[str, type[Message]], Publisher[Any]] = {}
        self._read_logs = 0

    def _run_until(self, condition: Callable[[], bool], within: float) -> bool:
        raise NotImplementedError

    # Messages

    def publish(self, topic: str, message: Message, qos: QoSProfile | int = 10) -> None:
        """Publish a message from the test's own node; it arrives when time passes next."""
        name = self.node.resolve_topic_name(topic)
        key = (name, type(message))
        if key not in self._publishers:
            self._publishers[key] = self.node.create_publisher(type(message), name, qos)
        self._publishers[key].publish(message)

    def messages(self, topic: str, type: type[Message] | None = None) -> list[Any]:  # noqa: A002 - what it is
        """Give a list that fills with what is published on a topic from now on, whenever time passes.

        What publishers keep for those who come late (TRANSIENT_LOCAL) comes first. The class is the publishers' own;
        over Zenoh it must be installed or given as `type`.
        """
        heard: list[Any] = []
        self._kept.append((self.recorder.listen(self.node.resolve_topic_name(topic)), heard, type))
        self._hear()
        return heard

    def _hear(self) -> None:
        for ear, heard, given in self._kept:
            heard.extend(self._decoded(topic, payload, given) for topic, payload in ear.take())

    def expect(
        self,
        topic: str,
        predicate: Callable[[Any], object] | None = None,
        within: float = PATIENCE,
        *,
        type: type[Message] | None = None,  # noqa: A002 - what it is
    ) -> Any:
        """Wait for a message for which `predicate(message)` is true, or for any; give it.

        Only what is published from now on counts, and what publishers keep for those who come late. Raises
        ExpectationError after `within` seconds, with the last messages of the topics concerned.
        """
        __tracebackhide__ = True
        name, begin = self.node.resolve_topic_name(topic), self.time
        met, tried = self._met(name, predicate, within, type)
        if not met:
            headline = self._nothing_came(name, tried, span(begin, begin + within), named(predicate))
            raise ExpectationError(self._told(headline, self._concerned(name)))
        return met[0]

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
        name = self.node.resolve_topic_name(topic)
        met, _ = self._met(name, predicate, during, type)
        if met:
            which = f"that fulfils {named(predicate) or 'the condition'}" if predicate else "at all"
            headline = f"a message came on {name} at {seconds(self.time)}, where none {which} was expected"
            raise ExpectationError(self._told(headline, self._concerned(name)))

    def _met(
        self, name: str, predicate: Callable[[Any], object] | None, within: float, given: type[Message] | None
    ) -> tuple[list[Any], int]:
        """Wait for a message that fulfils a condition: give it, if it came, and how many were looked at."""
        __tracebackhide__ = True
        met: list[Any] = []
        tried = 0
        with self.recorder.listening(name) as ear:

            def came() -> bool:
                nonlocal tried
                for topic, payload in ear.take():
                    message = self._decoded(topic, payload, given)
                    tried += 1
                    if predicate is None or predicate(message):
                        met.append(message)
                        return True
                return False

            self._run_until(came, within)
        return met, tried

    # Anything else that is waited for

    def wait_until(self, condition: Callable[[], object], within: float = PATIENCE) -> None:
        """Let time pass until `condition()` is true; it is asked after each callback.

        Raises ExpectationError after `within` seconds.
        """
        __tracebackhide__ = True
        begin = self.time

        def holds() -> bool:
            self._hear()
            return bool(condition())

        if not self._run_until(holds, within):
            what = named(condition) or "what was waited for"
            headline = f"{what} did not come true {span(begin, begin + within)}"
            raise ExpectationError(self._told(headline, self._listened()))

    def result(self, future: Future[T], within: float = 60.0) -> T:
        """Let time pass until a future is done; give its result, or raise what it holds.

        Raises ExpectationError after `within` seconds.
        """
        __tracebackhide__ = True
        begin = self.time
        if not self._run_until(lambda: future.done() or future.cancelled(), within):
            raise ExpectationError(self._told(f"the future was not done {span(begin, begin + within)}", ()))
        return cast(T, future.result())

    # Log lines

    @property
    def logs(self) -> list[Record]:
        """All that was logged so far: each with `message`, `name` (the logger's), `severity` and `stamp_ns`."""
        return list(self._stage.logs)

    def expect_log(self, words: str, within: float = PATIENCE) -> Record:
        """Wait for a log line that has these words in it; give it.

        Looked at are the lines after the one that the last `expect_log` found, also those logged before this call: so
        several calls ask for an order. Raises ExpectationError after `within` seconds.
        """
        __tracebackhide__ = True
        begin = self.time
        found: list[Record] = []
        lines = self._stage.logs

        def came() -> bool:
            while self._read_logs < len(lines) and not found:
                line = lines[self._read_logs]
                self._read_logs += 1
                if words in line.message:
                    found.append(line)
            return bool(found)

        first = self._read_logs
        if not self._run_until(came, within):
            self._read_logs = first
            headline = f"nobody logged '{words}' {span(begin, begin + within)}"
            raise ExpectationError(self._told(headline, (), all_logs=True))
        return found[0]

    # Services and parameters

    def call(self, srv_type: type[Any] | str, name: str, request: Any = None, within: float = PATIENCE) -> Any:
        """Call a service and give its answer; without a `request`, with the default one.

        `srv_type` is a class or a name such as ``std_srvs/srv/Trigger``. Raises ExpectationError when nobody answers
        within so many seconds.
        """
        __tracebackhide__ = True
        kind = find(srv_type, "srv") if isinstance(srv_type, str) else srv_type
        full, begin = self.node.resolve_service_name(name), self.time
        client = self.node.create_client(kind, name)
        try:
            if not self._run_until(client.service_is_ready, within):
                why = no_such("service", full, self.services.items(), span(begin, begin + within))
                raise ExpectationError(self._told(why, ()))
            future = client.call_async(kind.Request() if request is None else request)
            if not self._run_until(future.done, within):
                raise ExpectationError(self._told(f"{full} did not answer {span(begin, self.time)}", ()))
            return future.result()
        finally:
            self.node.destroy_client(client)

    def parameter(self, node: str, name: str, within: float = PATIENCE) -> Any:
        """Give the value of a node's parameter. Raises ParameterNotDeclaredException, with the nearest name."""
        __tracebackhide__ = True
        from robolink.testing import parameters

        return parameters.value_of(self, full(node), name, within)

    def set_parameter(self, node: str, name: str, value: Any, within: float = PATIENCE) -> None:
        """Set a node's parameter. Raises InvalidParameterValueException with the reason when the node refuses."""
        __tracebackhide__ = True
        from robolink.testing import parameters

        parameters.set_value(self, full(node), name, value, within)

    # The graph

    @property
    def nodes(self) -> list[str]:
        """The full names of all nodes that are there, but the test's own."""
        return sorted({each.full_node_name for each in self.graph.nodes()} - {self.own_name})

    @property
    def topics(self) -> dict[str, str]:
        """All topics of the nodes with their types, but /rosout and /parameter_events, which every node has.

        Two types that meet on one topic are parted by a comma.
        """
        return dict(self._known_topics())

    @property
    def services(self) -> dict[str, str]:
        """All services of the nodes with their types, but those for parameters and types, which every node has."""
        return dict(self._known_services())

    def publishers(self, topic: str) -> list[str]:
        """The nodes that publish a topic, but the test's own."""
        return list(self._ends(self.node.resolve_topic_name(topic)).given)

    def subscribers(self, topic: str) -> list[str]:
        """The nodes that subscribe to a topic, but the test's own."""
        return list(self._ends(self.node.resolve_topic_name(topic)).taken)

    def _listened(self) -> Iterable[str]:
        """The topics that `messages` keeps, then those that the test publishes."""
        return dict.fromkeys([*(ear.name for ear, _, _ in self._kept), *(name for name, _ in self._publishers)])

    def _concerned(self, name: str) -> Iterable[str]:
        """A topic, what those hear that publish it, and what the test itself publishes."""
        heard = [topic for node in self._ends(name).given for topic in self._heard_by(node)]
        return dict.fromkeys([name, *heard, *self._listened()])

    def _close_ears(self) -> None:
        self._kept.clear()
        self.recorder.close()


def full(node: str) -> str:
    """Spell a node's name with its leading slash."""
    return f"/{node.strip('/')}"
