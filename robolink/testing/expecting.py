"""Waiting for messages, log lines, futures and responses, with an ExpectationError at the timeout, or a failure."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar, cast

from robolink.testing.expectations import ExpectationError, NodeFailure, named, no_such, seconds, span

if TYPE_CHECKING:
    from robolink.logging import Record
    from robolink.message import Message
    from robolink.task import Future
    from robolink.testing.recorder import Topic
    from robolink.testing.stage import Stage
    from robolink.testing.story import Conversation, Story
    from robolink.transport import Sample

T = TypeVar("T")

Predicate = Callable[[Any], object]


class Expecting:
    """The waits of a system, each with an ExpectationError at timeout; `run_until(condition, within)` passes time."""

    def __init__(
        self,
        stage: Stage,
        story: Story,
        conversation: Conversation,
        run_until: Callable[[Callable[[], bool], float], bool],
    ) -> None:
        self._stage, self._story, self._conversation, self._run_until = stage, story, conversation, run_until
        self._read_logs = 0
        self._begin = 0
        self._found: dict[str, int] = {}

    def begin(self) -> None:
        """Make only messages from now on count."""
        self._begin = self._story.recorder.now()

    # Messages

    def message(self, topic: str, predicate: Predicate | None, within: float, given: type[Message] | None) -> Any:
        """Return the first message that meets a condition, or any; it is of the class `given`, if there is one."""
        __tracebackhide__ = True
        name, begin = self._stage.node.resolve_topic_name(topic), self._story.time
        met, tried = self._met(name, predicate, within, given)
        if not met:
            headline = self._story.why_nothing_came(name, tried, span(begin, begin + within), named(predicate))
            raise ExpectationError(self._story.failure_text(headline, name, others=self._concerned(name)))
        return met[0]

    def no_message(self, topic: str, predicate: Predicate | None, during: float, given: type[Message] | None) -> None:
        """Let time pass in which no message may meet a condition, or none may come at all."""
        __tracebackhide__ = True
        name = self._stage.node.resolve_topic_name(topic)
        met, _ = self._met(name, predicate, during, given)
        if met:
            which = f"that fulfils {named(predicate) or 'the condition'}" if predicate else "at all"
            headline = f"a message came on {name} at {seconds(self._story.time)}, where none {which} was expected"
            raise ExpectationError(self._story.failure_text(headline, name, others=self._concerned(name)))

    def _met(
        self, name: str, predicate: Predicate | None, within: float, given: type[Message] | None
    ) -> tuple[list[Any], int]:
        """Wait for a message that meets a condition: return it, if it came, and the number that was looked at."""
        __tracebackhide__ = True
        if isinstance(predicate, type):
            raise TypeError(f"{predicate.__name__} is not a condition: give it as type={predicate.__name__}")
        met: list[Any] = []
        tried, recorder = 0, self._story.recorder
        with recorder.listening(name) as queue:
            begin, own = max(self._begin, self._found.get(name, 0)), self._story.graph.own_name
            # The queue repeats what was kept for late subscriptions. The recorder has what came while the queue was
            # made, and tells of it later where messages come on a thread of their own: so both are looked at each time.
            # An attachment has the publisher's id and a sequence number: no two messages share one.
            waiting: deque[tuple[Topic, Sample]] = deque()
            numbers: set[int] = set()
            attachments: set[bytes] = set()

            def take() -> None:
                for each in (*recorder.since(name, begin, but=own, seen=numbers), *queue.take()):
                    attachment = each[1].attachment
                    if not attachment or attachment not in attachments:
                        attachments.add(attachment)
                        waiting.append(each)

            def came() -> bool:
                nonlocal tried
                take()
                while waiting:
                    topic, sample = waiting.popleft()
                    self._found[name] = recorder.after(name, sample)
                    message = self._story.decoded(topic, sample.payload, given)
                    tried += 1
                    if predicate is None or predicate(message):
                        met.append(message)
                        return True
                return False

            self._run_until(came, within)
        return met, tried

    def _concerned(self, name: str) -> list[str]:
        """Return a topic, the inputs of its publishers, and what the test itself records and publishes."""
        heard = self._story.graph.heard_by_publishers_of(name)
        return list(dict.fromkeys([name, *heard, *self._conversation.topics]))

    # Anything else

    def condition(self, condition: Callable[[], object], within: float) -> None:
        """Wait until a condition holds, which may look at what is recorded."""
        __tracebackhide__ = True
        begin = self._story.time

        def holds() -> bool:
            self._conversation.hear()
            return bool(condition())

        if not self._run_until(holds, within):
            what = named(condition) or "what was waited for"
            headline = f"{what} did not come true {span(begin, begin + within)}"
            involved = dict.fromkeys(self._conversation.topics)
            raise ExpectationError(self._story.failure_text(headline, others=involved or self._story.topics()))

    def result(self, future: Future[T], within: float) -> T:
        """Return the result of a future, or raise its exception."""
        __tracebackhide__ = True
        begin = self._story.time
        if not self._run_until(lambda: future.done() or future.cancelled(), within):
            raise ExpectationError(self._story.failure_text(f"the future was not done {span(begin, begin + within)}"))
        return cast("T", future.result())

    def log_line(self, words: str, within: float) -> Record:
        """Return the next log record with these words, behind the one that was found last."""
        __tracebackhide__ = True
        begin, first = self._story.time, self._read_logs
        found: list[Record] = []
        lines = self._stage.logs

        def came() -> bool:
            while self._read_logs < len(lines) and not found:
                line = lines[self._read_logs]
                self._read_logs += 1
                if words in line.message:
                    found.append(line)
            return bool(found)

        if not self._run_until(came, within):
            self._read_logs = first
            headline = f"nobody logged '{words}' {span(begin, begin + within)}"
            raise ExpectationError(self._story.failure_text(headline, all_logs=True))
        return found[0]

    def answer(self, kind: type[Any], name: str, request: Any, within: float) -> Any:
        """Return the response of a service."""
        __tracebackhide__ = True
        node = self._stage.node
        full, begin = node.resolve_service_name(name), self._story.time
        client = node.create_client(kind, name)
        try:
            if not self._run_until(client.service_is_ready, within):
                raise ExpectationError(
                    self._story.failure_text(self._no_service(full, kind, span(begin, begin + within)))
                )
            future = client.call_async(kind.Request() if request is None else request)
            if not self._run_until(future.done, within):
                raise ExpectationError(
                    self._story.failure_text(f"{full} did not answer {span(begin, self._story.time)}")
                )
            return future.result()
        finally:
            node.destroy_client(client)

    def _no_service(self, name: str, kind: type[Any], when: str) -> str:
        known = self._story.graph.services()
        there = known.get(name)
        if there is not None:
            return f"{name} has the type {there}, not {kind.__ros_type__}"
        return no_such("service", name, known.items(), when)


class Failures:
    """Failures of a system's programs, of which the test hears at its next wait, once."""

    def __init__(self, stage: Stage, story: Story) -> None:
        self._stage, self._story, self._reported = stage, story, 0

    def are_new(self) -> bool:
        """True if a program failed that the test has not heard of."""
        return len(self._stage.failures) > self._reported

    def raise_new(self) -> NoReturn:
        """Raise NodeFailure with all new ones, or what a callback of the test's own node raised."""
        __tracebackhide__ = True
        failures = self._stage.failures[self._reported :]
        self._reported = len(self._stage.failures)
        for each in failures:
            is_own = each.program == self._story.graph.own_name.strip("/")
            if each.error is not None and (is_own or not isinstance(each.error, Exception)):
                raise each.error  # what a callback of the test's own says, it says itself; so does pytest.skip()
        raise NodeFailure(self._story.failures_text(failures)) from failures[0].error
