"""Handles of a Zenoh session: publishers, subscriptions, servers, liveliness tokens, and both sides of a call."""

from __future__ import annotations

import threading
import time
from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from typing import Any

import zenoh

from robolink.exceptions import OverwrittenError, SessionReplacedError, TransportClosedError, TransportError
from robolink.logging import get_logger
from robolink.networks.settings import LONGEST_WAIT
from robolink.system import clocks, heap
from robolink.system.terminal import shown
from robolink.transport import lifetime
from robolink.transport import zenoh_declare as declare
from robolink.transport.base import Sample, Sink, refuse_giant
from robolink.transport.gates import close_gate
from robolink.transport.network import reason
from robolink.transport.pieces import LARGE, Pieces
from robolink.transport.shared_pool import Sharing
from robolink.transport.zenoh_declare import Publishers, is_matching, quietly

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
        self.sharing: Sharing | None = None
        """Memory that large payloads are written into; None where the session shares none."""

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

    __slots__ = (
        "_declare_remote",
        "_has_reported",
        "_matched_until",
        "_matcher",
        "_remote",
        "_topic",
        "_used",
        "key",
        "on_shared",
    )

    def __init__(self, holdings: Holdings, key: str, publishers: Publishers) -> None:
        # First, since it may be shut from the moment on that the session has it.
        self.key, self._topic = key, holdings.topic(key)
        self._used, self._matcher, self._declare_remote = publishers
        self._remote: Any = None
        self._has_reported, self._matched_until = False, 0.0
        self.on_shared: Callable[[], object] | None = None
        """Function that is called once when a payload was copied into shared memory: Pieces save the copy before."""
        super().__init__(holdings, [])

    def put(self, payload: bytes | Pieces, attachment: bytes) -> None:
        """Send to every matching subscription. Raises TransportClosedError after close, TransportError for giants.

        Pieces are of at least LARGE bytes.
        """
        if len(payload) >= LARGE:
            self._put_large(payload, attachment)
            return
        if self._topic.sinks:
            self._deliver_here(payload, attachment)  # type: ignore[arg-type] # bytes, being small
        try:  # `repeat` written out: this is run once a message
            self._used.put(payload, attachment=attachment)
        except zenoh.ZError as error:
            raise self._holdings.failure(self.key, error) from None

    def sender(
        self,
        encode: Callable[[Any], bytes | Pieces],
        attachment: Callable[[], bytes],
        lock: AbstractContextManager[object],
    ) -> Callable[[Any], None]:
        """Return a function that encodes a message and sends it; in one frame where it is small and goes elsewhere.

        Args:
            encode: Function that returns the payload of a message.
            attachment: Function that numbers the message.
            lock: Lock under which it is numbered and sent.
        """

        def send(message: Any) -> None:
            payload = encode(message)
            with lock:
                if len(payload) >= LARGE or self._topic.sinks:
                    self.put(payload, attachment())
                    return
                try:  # `put` written out: this is run once a message
                    self._used.put(payload, attachment=attachment())
                except zenoh.ZError as error:
                    raise self._holdings.failure(self.key, error) from None

        return send

    def repeat(self, payload: Any, attachment: bytes) -> None:
        """Send a message that the subscriptions of this session, but for latched ones, have already."""
        try:
            self._used.put(payload, attachment=attachment)
        except zenoh.ZError as error:
            raise self._holdings.failure(self.key, error) from None

    def _put_large(self, payload: bytes | Pieces, attachment: bytes) -> None:
        size = len(payload)
        refuse_giant(self.key, payload)
        if size >= heap.LARGE:
            heap.note(size)
        if self._topic.sinks:
            payload = bytes(payload)
            self._deliver_here(payload, attachment)
        begin = clocks.monotonic()
        if self._worth_a_copy(begin):
            shared = self._shared(payload)
            self.repeat(bytes(payload) if shared is None else shared, attachment)
            if clocks.monotonic() - begin >= LONGEST_WAIT:
                self._tell_of_no_room(size)

    def _shared(self, payload: bytes | Pieces) -> Any:
        """Return the payload in shared memory; None where Zenoh has to copy it itself."""
        sharing = self._holdings.sharing
        if sharing is None or self._used is not self._matcher:  # what is retained would hold its place for ever
            return None
        shared = sharing.filled(payload)
        if shared is not None and self.on_shared is not None:
            on_shared, self.on_shared = self.on_shared, None
            on_shared()
        return shared

    def _deliver_here(self, payload: bytes, attachment: bytes) -> None:
        sample = Sample(payload, attachment)
        for sink in self._topic.sinks:
            sink(sample)

    @property
    def matched(self) -> bool:
        """True if a subscription is known, here or elsewhere."""
        return bool(self._topic.sinks) or is_matching(self._matcher)

    def _tell_of_no_room(self, size: int) -> None:
        """Warn once about a full buffer: Zenoh drops silently, and the receiver may never get anything."""
        if not self._has_reported:
            self._has_reported = True
            get_logger("robolink.transport").warning(
                f"{self.key[:200]}: a message of {size:,} bytes waited {LONGEST_WAIT:g} s for room and may not arrive:"
                " a subscriber's link is too slow for messages of this size, or it stands still (said once)"
            )

    def _worth_a_copy(self, now: float) -> bool:
        retains_for_late_joiners = self._used is not self._matcher
        if retains_for_late_joiners or now < self._matched_until:
            return True
        found = is_matching(self._matcher) and (not self._topic.sinks or bool(self._topic.latched) or self._is_remote())
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
        left = self._used, self._matcher, self._remote
        self._used = _Gone(f"the publisher of {self.key[:200]} is of no use any more: {why}")
        self._matcher = self._remote = _Gone(why)
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


QUIET = 0.03
"""Quiet time after which no more peers are expected, in seconds: a young session does not know how many there are."""

PATIENCE = 0.5
"""Quiet time after which peers that have not answered count as frozen, in seconds."""

LONGEST = 3.0
"""Timeout of the discovery in seconds: even a busy machine's peers have announced everything by then."""


class ZenohToken(Declared):
    """A token that is announced."""

    __slots__ = ("_token",)

    def __init__(self, holdings: Holdings, announced: Any, token: str) -> None:
        self._token = token
        super().__init__(holdings, [announced])
        with holdings.lock:
            holdings.tokens[token] += 1

    def close(self) -> None:
        """Undeclare. Safe to call twice."""
        with self._holdings.lock:
            if self in self._holdings.handles:
                tokens = self._holdings.tokens
                tokens[self._token] -= 1
                if not tokens[self._token]:
                    del tokens[self._token]
        super().close()


class Changes:
    """Deduplicates token changes: Zenoh may report one token both as history and as a change."""

    def __init__(self, on_change: Callable[[str, bool], object], own: Mapping[str, int] | None = None) -> None:
        self._own: Mapping[str, int] = {} if own is None else own
        self._on_change: Callable[[str, bool], object] | None = on_change
        self._telling = threading.RLock()
        self._found: set[str] | None = None
        self.alive: set[str] = set()

    def __call__(self, sample: zenoh.Sample) -> None:
        """Handle a token change from Zenoh."""
        token, alive = str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT
        if alive or not self._own.get(token):  # else the end of another session in which it was announced, too
            self.change(token, alive)

    def change(self, token: str, alive: bool) -> object:
        """Report a token that has come or gone, unless that is known; return what `on_change` returns."""
        with self._telling:
            if self._found is not None:
                (self._found.add if alive else self._found.discard)(token)
            return self._tell(token, alive)

    def _tell(self, token: str, alive: bool) -> object:
        if self._on_change is None or alive == (token in self.alive):
            return None
        (self.alive.add if alive else self.alive.discard)(token)
        answer = self._on_change(token, alive)
        if answer is False:
            self.alive.discard(token)
        return answer

    def count_again(self) -> None:
        """Note from now on which tokens are found again, in another session."""
        with self._telling:
            self._found = set()

    def settle(self) -> None:
        """Report those as gone that have not been found again."""
        with self._telling:
            found, self._found = self._found, None
            for token in sorted(self.alive - found) if found is not None else ():
                self._tell(token, False)

    def end(self) -> None:
        """Stop reporting changes."""
        # Waits for what is just being told, but not for ever: its hearer may wait for whoever closes.
        waited = self._telling.acquire(timeout=0.1)
        self._on_change = None
        if waited:
            self._telling.release()


class ZenohWatch(Declared):
    """A watch of tokens."""

    __slots__ = ("_changes",)

    def __init__(self, holdings: Holdings, made: tuple[Any, Sink], changes: Changes) -> None:
        self._changes = changes
        subscriber, feed = made
        super().__init__(holdings, [subscriber], feed)

    def shut(self, why: str) -> list[Any]:
        """Stop reporting changes; return the entities to undeclare."""
        self._changes.end()
        return super().shut(why)


LOOKS_AGAIN = 0.0003
"""Interval between two looks for what peers have announced, in seconds."""


def settled(look: Any, ask: Callable[[float], Any], peers: Callable[[], set[str]]) -> set[str]:
    """Return the tokens of all peers, once they have announced theirs and no more peers turn up.

    Args:
        look: Channel of token changes (`zenoh_declare.declare_look`).
        ask: Asks all peers for their tokens, with a timeout in seconds (`zenoh_declare.ask`).
        peers: Returns the ids of the peers that this session has found.
    """
    changes, known = Changes(lambda token, alive: None), set[str]()
    begin = news = clocks.monotonic()

    def left() -> float:
        return min(news + PATIENCE, begin + LONGEST) - clocks.monotonic()

    def collect(quiet: float, question: Any = None) -> None:
        """Collect until the peers have answered, or nothing has come for `quiet` seconds."""
        nonlocal news
        since = clocks.monotonic()
        while left() > 0 and clocks.monotonic() - since < quiet:
            # Looked at first: an answer comes after all tokens of the peer.
            is_answered = question is not None and declare.is_over(question)
            while (sample := declare.taken(look)) is not None:
                news = since = clocks.monotonic()
                changes(sample)
            if is_answered:
                return
            time.sleep(LOOKS_AGAIN)

    was_quiet = False
    while left() > 0:
        before = peers()
        if not before <= known:
            news, known = clocks.monotonic(), known | before
        # Silence alone proves nothing: a busy peer is silent too. Its answer comes after all its tokens.
        collect(LONGEST, ask(LONGEST))
        if was_quiet and peers() == before:
            break
        collect(max(QUIET, (clocks.monotonic() - begin) / 2))  # what has taken long so far may have longer gaps
        was_quiet = True
    return changes.alive


LOST = object()
"""Item of a call's sink in place of an answer that cannot come any more."""


class ZenohCall:
    """A pending call. Giving up is final: neither replies nor the end come after it."""

    def __init__(self, cancel: zenoh.CancellationToken, gate: Any, end: Any) -> None:
        self._cancel, self._gate, self._end = cancel, gate, end
        self._lock, self._has_closed = threading.Lock(), False

    def lose(self) -> None:
        """End it now, since its session is left; unless it has ended, the sink gets LOST, and then the end."""
        with self._lock:
            if not self._has_closed:  # the end is called once at most: nothing comes of this after it
                self._end.__setstate__((_tell_lost, (self._gate.func,), {}, None))
        quietly(self._cancel.cancel)

    def close(self) -> None:
        """Cancel the call. Safe to call twice."""
        with self._lock:
            self._has_closed = True
            close_gate(self._gate)
            close_gate(self._end)
        quietly(self._cancel.cancel)


def _tell_lost(sink: Sink) -> None:
    sink(LOST)
    sink(None)


class ZenohQuery:
    """Server's side of a call; freeing it closes it."""

    def __init__(self, raw: zenoh.Query) -> None:
        self._raw, self._key = raw, raw.key_expr
        try:
            self.payload, self.attachment = content(raw.payload), content(raw.attachment)
        except OverwrittenError:
            self.close()
            raise

    def reply(self, payload: bytes, attachment: bytes) -> None:
        """Send a reply, from any thread. Does nothing when the caller is gone. Raises TransportError for giants."""
        if len(payload) >= LARGE:
            refuse_giant(f"the answer to a call of {self._key}", payload)
        quietly(lambda: self._raw.reply(self._key, payload, attachment=attachment))

    def close(self) -> None:
        """Finish the call: no more replies will come."""
        quietly(self._raw.drop)


def content(raw: zenoh.ZBytes | None) -> bytes:
    """Return the bytes, empty for None. Raises OverwrittenError if they are no longer what was sent."""
    if raw is None:
        return b""
    copied, shared = raw.to_bytes(), raw.as_shm()
    if shared is not None and not shared.is_valid():
        raise OverwrittenError
    return copied


def content_of_reply(reply: Any) -> Sample:
    """Return the sample of a reply; raises TransportError for an error reply, SessionReplacedError for LOST."""
    if reply is LOST:
        raise SessionReplacedError
    sample = reply.ok
    if sample is not None:
        return Sample(content(sample.payload), content(sample.attachment))
    error = reply.err
    text = content(error.payload).decode(errors="replace") if error is not None else ""
    raise TransportError(f"the server replied with an error: {shown(text, 200)}")
