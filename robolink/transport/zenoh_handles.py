"""What a Zenoh session hands out: publishers, subscriptions, servers, tokens, watches, calls and queries."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import zenoh

from robolink.exceptions import TransportClosedError, TransportError, shown
from robolink.logging import get_logger
from robolink.transport import lifetime
from robolink.transport.base import Sample, Sink, refuse_giant
from robolink.transport.network import LONGEST_WAIT, reason
from robolink.transport.zenoh_declare import Publishers, close_gate, is_matching, quietly

LARGE = 32 * 1024
"""From this many bytes on it is cheaper to ask whether anybody listens than to copy a payload for nobody."""


class Holdings:
    """What one session has declared, until it is closed or lost in a fork."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.why_closed = ""
        self.handles: dict[Declared, None] = {}
        self._topics: dict[str, Topic] = {}

    def topic(self, key: str) -> Topic:
        """Give the one Topic of this key."""
        with self.lock:
            return self._topics.setdefault(key, Topic())

    def end(self, why: str) -> list[Declared]:
        """Refuse further use; gives all that is still declared."""
        self.why_closed = self.why_closed or why
        handles, self.handles = list(self.handles), {}
        return handles

    def check(self) -> None:
        """Raise TransportClosedError after the end."""
        if self.why_closed:
            lifetime.end_if_daemon()
            raise TransportClosedError(self.why_closed)

    def failure(self, key: str, error: Exception) -> TransportError:
        """Turn Zenoh's error about `key` into one line."""
        if self.why_closed:
            lifetime.end_if_daemon()
            return TransportClosedError(self.why_closed)
        return TransportError(f"{key[:200]}: {reason(error)}")


class Topic:
    """The volatile subscriptions of one session to one key: they are served without Zenoh."""

    __slots__ = ("sinks",)

    def __init__(self) -> None:
        self.sinks: tuple[Sink, ...] = ()


_NOBODY = Topic()


class Declared:
    """Something declared with Zenoh, until it or its session is closed."""

    __slots__ = ("_entity", "_gate", "_holdings")

    def __init__(self, holdings: Holdings, entity: Any, gate: Sink | None = None) -> None:
        self._holdings, self._entity, self._gate = holdings, entity, gate
        with holdings.lock:
            holdings.handles[self] = None

    def close(self) -> None:
        """Undeclare. Safe to call twice."""
        with self._holdings.lock:
            self._holdings.handles.pop(self, None)
        left = self.shut("it has been closed")  # by name: `lifetime.end_if_daemon` keeps what has one
        for entity in left:
            quietly(entity.undeclare)

    def shut(self, why: str) -> list[Any]:
        """Let nothing through any more; gives what is left to undeclare."""
        if self._gate:
            close_gate(self._gate)
        entity, self._entity = self._entity, _Gone(why)
        return [entity]

    def disown(self, why: str) -> None:
        """Shut it in a forked child, where undeclaring or freeing it would wait for threads that are not there."""
        lifetime.bury(self.shut(why))


class _Gone:
    """Stands where a publisher has been."""

    def __init__(self, why: str) -> None:
        self._why = why

    def put(self, *_: object, **__: object) -> None:
        lifetime.end_if_daemon()
        raise TransportClosedError(self._why)

    def undeclare(self) -> None:
        pass

    @property
    def matching_status(self) -> _Gone:
        return self

    matching = False


class ZenohOutlet(Declared):
    """A publisher."""

    __slots__ = ("_asked", "_has_told", "_key", "_topic")

    def __init__(self, holdings: Holdings, key: str, publishers: Publishers) -> None:
        # First, since it may be shut from the moment on that the session has it.
        self._key, self._topic, self._asked = key, holdings.topic(key), publishers.asked
        self._has_told = False
        super().__init__(holdings, publishers.used)

    def put(self, payload: bytes, attachment: bytes) -> None:
        """Send to every matching subscription. Raises TransportClosedError after close, TransportError for giants."""
        large = len(payload) >= LARGE
        if large:
            refuse_giant(self._key, payload)
        sinks = self._topic.sinks
        if sinks:
            sample = Sample(payload, attachment)
            for sink in sinks:
                sink(sample)
        if not large or self._worth_a_copy():
            begin = time.monotonic() if large else 0.0
            try:
                self._entity.put(payload, attachment=attachment)
            except zenoh.ZError as error:
                raise self._holdings.failure(self._key, error) from None
            if large and time.monotonic() - begin >= LONGEST_WAIT:
                self._tell_of_no_room(len(payload))

    @property
    def matched(self) -> bool:
        """Whether anybody subscribes, here or elsewhere, as far as is known."""
        return bool(self._topic.sinks) or is_matching(self._asked)

    def _tell_of_no_room(self, size: int) -> None:
        """Warn, once: Zenoh does not say that it has dropped something, and who is to get it may never get anything."""
        if not self._has_told:
            self._has_told = True
            get_logger("robolink.transport").warning(
                f"{self._key[:200]}: a message of {size:,} bytes waited {LONGEST_WAIT:g} s for room and may not arrive:"
                " a subscriber's link is too slow for messages of this size, or it stands still (said once)"
            )

    def _worth_a_copy(self) -> bool:
        keeps_for_late_joiners = self._entity is not self._asked
        return keeps_for_late_joiners or is_matching(self._asked)

    def shut(self, why: str) -> list[Any]:
        """Send nothing any more; gives both publishers, the used and the asked."""
        self._topic = _NOBODY
        used = super().shut(f"the publisher of {self._key[:200]} is of no use any more: {why}")
        asked, self._asked = self._asked, _Gone(why)
        return used if asked in used else [*used, asked]


class ZenohSubscription(Declared):
    """A subscription; without a topic the own session's samples come from Zenoh too."""

    __slots__ = ("_topic",)

    def __init__(self, holdings: Holdings, subscriber: Any, gate: Sink, topic: Topic | None) -> None:
        self._topic = topic
        super().__init__(holdings, subscriber, gate)
        if topic:
            with holdings.lock:
                topic.sinks = (*topic.sinks, gate)

    def close(self) -> None:
        """Undeclare. Safe to call twice."""
        if self._topic:
            with self._holdings.lock:
                self._topic.sinks = tuple(sink for sink in self._topic.sinks if sink is not self._gate)
        super().close()


class Changes:
    """Tells each change of a token once, although Zenoh may tell of one token as history and as news."""

    def __init__(self, on_change: Callable[[str, bool], object]) -> None:
        self._on_change: Callable[[str, bool], object] | None = on_change
        self._telling = threading.RLock()
        self.alive: set[str] = set()

    def __call__(self, sample: zenoh.Sample) -> None:
        """Hear of a token from Zenoh."""
        token, alive = str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT
        with self._telling:
            if self._on_change and alive != (token in self.alive):
                (self.alive.add if alive else self.alive.discard)(token)
                if self._on_change(token, alive) is False:
                    self.alive.discard(token)

    def end(self) -> None:
        """Tell nothing any more."""
        # Waits for what is just being told, but not for ever: its hearer may wait for whoever closes.
        waited = self._telling.acquire(timeout=0.1)
        self._on_change = None
        if waited:
            self._telling.release()


class ZenohWatch(Declared):
    """A watch of tokens."""

    __slots__ = ("_changes",)

    def __init__(self, holdings: Holdings, subscriber: Any, changes: Changes) -> None:
        self._changes = changes
        super().__init__(holdings, subscriber)

    def shut(self, why: str) -> list[Any]:
        """Tell nothing any more; gives what is left to undeclare."""
        self._changes.end()
        return super().shut(why)


class ZenohCall:
    """A call under way. Giving up is final: neither replies nor the end come after it."""

    def __init__(self, cancel: zenoh.CancellationToken, *gates: Sink) -> None:
        self._cancel, self._gates = cancel, gates

    def close(self) -> None:
        """Give up. Safe to call twice."""
        for gate in self._gates:
            close_gate(gate)
        quietly(self._cancel.cancel)


class ZenohQuery:
    """A call as its server sees it; forgetting it closes it."""

    def __init__(self, raw: zenoh.Query) -> None:
        self._raw, self._key = raw, raw.key_expr
        self.payload, self.attachment = content(raw.payload), content(raw.attachment)

    def reply(self, payload: bytes, attachment: bytes) -> None:
        """Answer, from any thread. Nothing happens when the caller is gone. Raises TransportError for giants."""
        refuse_giant(f"the answer to a call of {self._key}", payload)
        quietly(lambda: self._raw.reply(self._key, payload, attachment=attachment))

    def close(self) -> None:
        """Say that nothing more will come."""
        quietly(self._raw.drop)


def content(raw: zenoh.ZBytes | None) -> bytes:
    """Give the bytes, none for nothing."""
    return b"" if raw is None else raw.to_bytes()


def content_of_reply(reply: zenoh.Reply) -> Sample:
    """Give what was replied; raises TransportError when that is an error."""
    sample = reply.ok
    if sample is not None:
        return Sample(sample.payload.to_bytes(), content(sample.attachment))
    error = reply.err
    text = content(error.payload).decode(errors="replace") if error is not None else ""
    raise TransportError(f"the server replied with an error: {shown(text, 200)}")
