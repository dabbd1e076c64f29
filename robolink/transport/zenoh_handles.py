"""Handles of a Zenoh session: publishers, subscriptions and servers."""

from __future__ import annotations

import contextlib
import functools
import threading
from collections import Counter
from collections.abc import Callable
from typing import Any, NamedTuple

import zenoh

from robolink.exceptions import TransportClosedError, TransportError
from robolink.logging import get_logger
from robolink.networks.settings import LONGEST_WAIT
from robolink.system import clocks, heap
from robolink.transport import lifetime
from robolink.transport.base import Sample, Sink, refuse_giant
from robolink.transport.history import Latch
from robolink.transport.network import reason
from robolink.transport.zenoh_declare import Publishers, aim_gate, close_gate, is_matching, quietly
from robolink.transport.zenoh_mending import Mending
from robolink.transport.zenoh_sieve import Sieve

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


class Made(NamedTuple):
    """Declaration: the session, the entity, and a function that declares the same elsewhere."""

    session: Any
    entity: Any
    declare: Callable[[Any], Any]
    """Declares the same in another session."""


class Declared:
    """A declaration with Zenoh, until it or its session is closed."""

    __slots__ = ("_declare", "_entity", "_gate", "_holdings", "_session")

    def __init__(self, holdings: Holdings, made: Made, gate: Sink | None = None) -> None:
        self._holdings, self._gate = holdings, gate
        self._session, self._entity, self._declare = made
        with holdings.lock:
            holdings.handles[self] = None

    def declare_in(self, session: Any) -> Any:
        """Declare the same in another session; `adopt` takes it."""
        return self._declare(session)

    def adopt(self, made: Any, session: Any) -> list[Any]:
        """Go on with what `declare_in` has made in this session; return what is of no use any more."""
        with self._holdings.lock:
            if self not in self._holdings.handles or self._session is session:
                return self._entities_of(made)
            self._session = session
            return self._replace(made)

    def move_to(self, session: Any) -> list[Any]:
        """Go on in this session, unless it is there already; return what is of no use any more."""
        return [] if self._session is session else self.adopt(self.declare_in(session), session)

    def settle_in(self) -> None:
        """Begin what has to wait until everything has moved to another session."""

    def _entities_of(self, made: Any) -> list[Any]:
        return [made]

    def _replace(self, made: Any) -> list[Any]:
        entity, self._entity = self._entity, made
        return [entity]

    def close(self) -> None:
        """Undeclare. Safe to call twice."""
        with self._holdings.lock:
            self._holdings.handles.pop(self, None)
        left = self.shut("it has been closed")  # by name: `lifetime.end_if_daemon` keeps what has one
        for entity in left:
            quietly(entity.undeclare)

    def shut(self, why: str) -> list[Any]:
        """Close the gate; return the entities to undeclare."""
        if self._gate:
            close_gate(self._gate)
        entity, self._entity = self._entity, _Gone(why)
        return [entity]

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

    __slots__ = (
        "_asked",
        "_declare_remote",
        "_has_told",
        "_latch",
        "_matched_until",
        "_remote",
        "_topic",
        "cache",
        "key",
    )

    def __init__(
        self,
        holdings: Holdings,
        key: str,
        made: Made,
        latch: Latch[tuple[bytes, bytes]] | None = None,
        cache: Latch[tuple[bytes, bytes]] | None = None,
    ) -> None:
        # First, since it may be shut from the moment on that the session has it.
        publishers: Publishers = made.entity
        self.cache = cache
        self.key, self._topic, self._asked = key, holdings.topic(key), publishers.asked
        self._declare_remote, self._latch = publishers.declare_remote, latch
        self._remote: Any = None
        self._has_told, self._matched_until = False, 0.0
        super().__init__(holdings, made._replace(entity=publishers.used))

    def adopt(self, made: Any, session: Any) -> list[Any]:
        """Go on with these publishers; what is retained for late joiners is retained by the new one."""
        if self._latch is None:
            return super().adopt(made, session)
        with self._latch.lock:
            for payload, attachment in self._latch.last():
                quietly(functools.partial(made.used.put, payload, attachment=attachment))
            return super().adopt(made, session)

    def _entities_of(self, made: Publishers) -> list[Any]:
        return [made.used, made.asked]

    def _replace(self, made: Publishers) -> list[Any]:
        left = [self._entity, self._asked, self._remote]
        self._declare_remote, self._remote, self._matched_until = made.declare_remote, None, 0.0
        self._asked, self._entity = made.asked, made.used
        return [each for each in left if each is not None]

    def put(self, payload: bytes, attachment: bytes) -> None:
        """Send to every matching subscription. Raises TransportClosedError after close, TransportError for giants."""
        if self.cache is not None:
            self.cache.retain((payload, attachment), len(payload))
        if self._latch is not None or len(payload) >= LARGE:
            self._put_rarely(payload, attachment)
            return
        if self._topic.sinks:
            self._deliver_here(payload, attachment)
        entity = self._entity
        try:  # not by `_send`: this is run once a message
            entity.put(payload, attachment=attachment)
        except zenoh.ZError as error:
            self._send_again(entity, error, payload, attachment)

    def _put_rarely(self, payload: bytes, attachment: bytes) -> None:
        """Send a large message, or one of a latched topic."""
        with self._latch.lock if self._latch is not None else contextlib.nullcontext():
            if self._latch is not None:
                self._latch.retain((payload, attachment))
            if len(payload) >= LARGE:
                self._put_large(payload, attachment)
            else:
                self._deliver_here(payload, attachment)
                self._send(payload, attachment)

    def _send(self, payload: bytes, attachment: bytes) -> None:
        entity = self._entity
        try:
            entity.put(payload, attachment=attachment)
        except zenoh.ZError as error:
            self._send_again(entity, error, payload, attachment)

    def _send_again(self, entity: Any, error: Exception, payload: bytes, attachment: bytes) -> None:
        if entity is self._entity:
            raise self._holdings.failure(self.key, error) from None
        self._send(payload, attachment)  # it was replaced meanwhile, and its session closed

    def _put_large(self, payload: bytes, attachment: bytes) -> None:
        refuse_giant(self.key, payload)
        if len(payload) >= heap.LARGE:
            heap.note(len(payload))
        self._deliver_here(payload, attachment)
        begin = clocks.monotonic()
        if self._worth_a_copy(begin):
            self._send(payload, attachment)
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
        keeps_for_late_joiners = self._entity is not self._asked
        if keeps_for_late_joiners or now < self._matched_until:
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
        used = super().shut(f"the publisher of {self.key[:200]} is of no use any more: {why}")
        asked, self._asked = self._asked, _Gone(why)
        remote, self._remote = self._remote, _Gone(why)
        return [*used, *(each for each in (asked, remote) if each is not None and each not in used)]


class ZenohSubscription(Declared):
    """A subscription; to a latched one, samples of its own session come from Zenoh too."""

    __slots__ = ("_sink", "_topic")

    def __init__(self, holdings: Holdings, made: Made, gate: Sink, topic: Topic, sink: Sink, *, latched: bool) -> None:
        self._topic, self._sink = topic, sink
        super().__init__(holdings, made, gate)
        with holdings.lock:
            if latched:
                topic.latched = (*topic.latched, gate)
            else:
                topic.sinks = (*topic.sinks, gate)

    def sift(self, on: bool) -> None:
        """Deliver nothing twice from now on, or again whatever comes: two sessions may bring the same for a while."""
        with self._holdings.lock:
            if self in self._holdings.handles and type(self._sink) is not Sieve:  # one that is latched always does
                aim_gate(self._gate, Sieve(self._sink) if on else self._sink)

    def close(self) -> None:
        """Undeclare. Safe to call twice."""
        with self._holdings.lock:
            self._topic.sinks = tuple(sink for sink in self._topic.sinks if sink is not self._gate)
            self._topic.latched = tuple(sink for sink in self._topic.latched if sink is not self._gate)
        super().close()

    def shut(self, why: str) -> list[Any]:
        """Deliver nothing any more."""
        if isinstance(self._sink, Mending):  # an answer may be on its way
            self._sink.close()
        return super().shut(why)
