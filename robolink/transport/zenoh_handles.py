"""Handles of a Zenoh session: publishers, subscriptions and servers."""

from __future__ import annotations

import threading
from collections import Counter
from typing import Any

import zenoh

from robolink.exceptions import TransportClosedError, TransportError
from robolink.logging import get_logger
from robolink.networks.settings import LONGEST_WAIT
from robolink.system import clocks, heap
from robolink.transport import lifetime
from robolink.transport.base import Sample, Sink, refuse_giant
from robolink.transport.network import reason
from robolink.transport.zenoh_declare import Publishers, close_gate, is_matching, quietly

LARGE = 32 * 1024
"""Payload size in bytes from which it is cheaper to check for subscriptions first than to copy it for nobody."""

MATCH_LASTS = 0.5
"""Time in seconds for which a subscription that was found is taken to be there still: the check takes 25-50 us."""


class Holdings:
    """Declarations of one session, until it is closed or lost in a fork."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.why_closed = ""
        self.handles: dict[Declared, None] = {}
        self.tokens: Counter[str] = Counter()
        """Tokens that are announced, and how often."""
        self._topics: dict[str, Topic] = {}

    def topic(self, key: str) -> Topic:
        """Return the one Topic of this key."""
        with self.lock:
            return self._topics.setdefault(key, Topic())

    def end(self, why: str) -> list[Declared]:
        """Refuse further use; return all that is still declared."""
        self.why_closed = self.why_closed or why
        handles, self.handles = list(self.handles), {}
        return handles

    def check(self) -> None:
        """Raise TransportClosedError after the end."""
        if self.why_closed:
            lifetime.end_if_daemon()
            raise TransportClosedError(self.why_closed)

    def failure(self, key: str, error: Exception) -> TransportError:
        """Return the TransportError, in one line, for Zenoh's error about `key`."""
        if self.why_closed:
            lifetime.end_if_daemon()
            return TransportClosedError(self.why_closed)
        return TransportError(f"{key[:200]}: {reason(error)}")


class Topic:
    """Subscriptions of one session to one key. Within the session the volatile ones are served without Zenoh."""

    __slots__ = ("latched", "sinks")

    def __init__(self) -> None:
        self.sinks: tuple[Sink, ...] = ()
        """Sinks of the volatile ones."""
        self.latched: tuple[Sink, ...] = ()
        """Sinks of those with a history: theirs is Zenoh's, and so is all that they get."""


_NOBODY = Topic()


class Declared:
    """Declarations with Zenoh, until they or their session are closed, and the gates through which they call."""

    __slots__ = ("_entities", "_gates", "_holdings")

    def __init__(self, holdings: Holdings, entities: list[Any], *gates: Sink) -> None:
        self._holdings, self._entities, self._gates = holdings, entities, gates
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
        """Close the gates; return the entities to undeclare. What uses them from now on raises `why`."""
        for each in self._gates:
            close_gate(each)
        left, self._entities = self._entities, []
        return left

    def disown(self, why: str) -> None:
        """Shut it in a forked child, where undeclaring or freeing it would wait for threads that do not exist."""
        lifetime.leak(self.shut(why))


class _Gone:
    """Null object in place of a closed publisher."""

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

    __slots__ = ("_asked", "_declare_remote", "_has_told", "_matched_until", "_remote", "_topic", "_used", "key")

    def __init__(self, holdings: Holdings, key: str, publishers: Publishers) -> None:
        # First, since it may be shut from the moment on that the session has it.
        self.key, self._topic = key, holdings.topic(key)
        self._used, self._asked, self._declare_remote = publishers
        self._remote: Any = None
        self._has_told, self._matched_until = False, 0.0
        super().__init__(holdings, [])

    def put(self, payload: bytes, attachment: bytes) -> None:
        """Send to every matching subscription. Raises TransportClosedError after close, TransportError for giants."""
        if len(payload) >= LARGE:
            self._put_large(payload, attachment)
            return
        if self._topic.sinks:
            self._deliver_here(payload, attachment)
        try:  # `repeat` written out: this is run once a message
            self._used.put(payload, attachment=attachment)
        except zenoh.ZError as error:
            raise self._holdings.failure(self.key, error) from None

    def repeat(self, payload: bytes, attachment: bytes) -> None:
        """Send a message that the subscriptions of this session, but for latched ones, have already."""
        try:
            self._used.put(payload, attachment=attachment)
        except zenoh.ZError as error:
            raise self._holdings.failure(self.key, error) from None

    def _put_large(self, payload: bytes, attachment: bytes) -> None:
        refuse_giant(self.key, payload)
        if len(payload) >= heap.LARGE:
            heap.note(len(payload))
        self._deliver_here(payload, attachment)
        begin = clocks.monotonic()
        if self._worth_a_copy(begin):
            self.repeat(payload, attachment)
            if clocks.monotonic() - begin >= LONGEST_WAIT:
                self._tell_of_no_room(len(payload))

    def _deliver_here(self, payload: bytes, attachment: bytes) -> None:
        sample = Sample(payload, attachment)
        for sink in self._topic.sinks:
            sink(sample)

    @property
    def matched(self) -> bool:
        """True if a subscription is known, here or elsewhere."""
        return bool(self._topic.sinks) or is_matching(self._asked)

    def _tell_of_no_room(self, size: int) -> None:
        """Warn once about a full buffer: Zenoh drops silently, and the receiver may never get anything."""
        if not self._has_told:
            self._has_told = True
            get_logger("robolink.transport").warning(
                f"{self.key[:200]}: a message of {size:,} bytes waited {LONGEST_WAIT:g} s for room and may not arrive:"
                " a subscriber's link is too slow for messages of this size, or it stands still (said once)"
            )

    def _worth_a_copy(self, now: float) -> bool:
        retains_for_late_joiners = self._used is not self._asked
        if retains_for_late_joiners or now < self._matched_until:
            return True
        found = is_matching(self._asked) and (not self._topic.sinks or bool(self._topic.latched) or self._is_remote())
        if found:
            self._matched_until = now + MATCH_LASTS
        return found

    def _is_remote(self) -> bool:
        """True if another session listens; Zenoh counts this session's own subscriptions as matching, too."""
        if self._remote is None:
            try:
                with lifetime.inside:
                    self._remote = self._declare_remote()
            except zenoh.ZError:  # closed meanwhile, as `put` will tell
                return True
        return is_matching(self._remote)

    def shut(self, why: str) -> list[Any]:
        """Stop sending; return all publishers, the one for sending and those for matching."""
        self._topic = _NOBODY
        left = self._used, self._asked, self._remote
        self._used = _Gone(f"the publisher of {self.key[:200]} is of no use any more: {why}")
        self._asked = self._remote = _Gone(why)
        return list({id(each): each for each in left if each is not None}.values())


class ZenohSubscription(Declared):
    """A subscription; to a latched one, samples of its own session come from Zenoh too."""

    __slots__ = ("_gate", "_topic")

    def __init__(self, holdings: Holdings, subscriber: Any, gate: Sink, topic: Topic, *, latched: bool) -> None:
        self._topic, self._gate = topic, gate
        super().__init__(holdings, [subscriber], gate)
        with holdings.lock:
            if latched:
                topic.latched = (*topic.latched, gate)
            else:
                topic.sinks = (*topic.sinks, gate)

    def close(self) -> None:
        """Undeclare. Safe to call twice."""
        with self._holdings.lock:
            self._topic.sinks = tuple(sink for sink in self._topic.sinks if sink is not self._gate)
            self._topic.latched = tuple(sink for sink in self._topic.latched if sink is not self._gate)
        super().close()
