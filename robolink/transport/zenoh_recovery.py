"""Recovery of messages that a lost link has cost: publishers keep their last ones, and who lost some asks for them.

Only RELIABLE topics, and only on networks that leave the machine. Each session with such publishers announces a token.
When that is gone and back, or comes from another session of the same transport, or a link of it stands still, whoever
knew it asks for what is newer than the last message that it has. Gaps alone are not a reason to ask: `limits`
thin topics on purpose.
"""

from __future__ import annotations

import contextlib
import functools
import struct
import threading
import time
import weakref
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

import msgspec
import zenoh

from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, resolved
from robolink.system import clocks
from robolink.transport import lifetime
from robolink.transport import zenoh_declare as declare
from robolink.transport.base import Handle, Sink
from robolink.transport.gates import close_gate, make_gate
from robolink.transport.history import stored_depth
from robolink.transport.roaming_handles import Declaration, Holdings, Retained, RoamingOutlet
from robolink.transport.zenoh import ZenohTransport
from robolink.transport.zenoh_mending import Mending
from robolink.wire import fields_of

ANSWERED_WITHIN = 2.0
"""Timeout of a question in seconds; messages behind a gap wait so long for the answer at most."""

ASKS_AFTER = 0.0, 0.25
"""Times of the questions in seconds: what is sent after the first may find no way yet, as the second will know."""

LONGEST_GONE = 60.0
"""Age in seconds of the oldest messages of a publisher that has not been heard before; Zenoh's lease is as long."""

MOST_KNOWN = 10_000
"""Most transports elsewhere that are remembered."""

MOST_WAITING = 1000
"""Most questions that wait for their turn, those to be asked and those to be answered."""

Add = Callable[[Declaration], object]
"""Function that declares something in the transport's present session."""


class _Question(NamedTuple):
    """Question to be asked."""

    due: float
    """Time by `clocks.monotonic`."""
    session: Any
    key: str
    mendings: list[Mending]


class _Generation:
    """Tokens of other transports, as one session has seen them."""

    def __init__(self, session: Any) -> None:
        self.session = session
        self.seen: set[str] = set()


class _Offered:
    """Offer to send messages again, in one session: a server of questions, and a token that tells of it."""

    def __init__(self, plain: ZenohTransport, key: str, answer: Callable[[_Offered, Any], object]) -> None:
        self.session, self.key = plain.session, key
        self.answers = threading.Event()
        """Set when publishers use this session: an answer before would have less than they send elsewhere."""
        self._answer = answer
        self._declared = plain.declare(key, self._declare)

    def _declare(self, session: Any) -> list[Any]:
        # Not a FifoChannel: when that is full, Zenoh stops all that comes by the same link.
        queryable = session.declare_queryable(self.key, zenoh.handlers.RingChannel(MOST_WAITING), complete=True)
        declare.follow(queryable.handler, functools.partial(self._answer, self), "robolink again")
        return [queryable, session.liveliness().declare_token(self.key)]

    def ask_me(self) -> None:
        """Send all who know the token a call to ask."""
        with lifetime.inside:
            # Not by another token: a declaration waits for what is being sent, for seconds if a link is full.
            self.session.put(
                self.key,
                b"",
                priority=zenoh.Priority.REAL_TIME,
                congestion_control=zenoh.CongestionControl.DROP,
            )

    def close(self) -> None:
        """Answer no more."""
        self.answers.set()
        self._declared.close()


class _Offer(Declaration):
    """Offer to send messages again."""

    _handle: _Offered

    def begin(self, plain: ZenohTransport, handle: Handle) -> None:
        """Answer from the beginning on."""
        super().begin(plain, handle)
        self.settle_in()

    def settle_in(self) -> None:
        """Answer from now on."""
        self._handle.answers.set()

    def ask_me(self) -> None:
        """Send all who know the token of the present session a call to ask."""
        self._handle.ask_me()


class Recovery:
    """Keeps what a transport publishes, and asks for what its subscriptions have lost.

    Args:
        holdings: Declarations of the transport.
        name: Name of the transport among others, the same in all of its sessions.
        domain: ROS domain id.
        thinned: Key expressions of the topics that the transport's own limits thin: nothing of these is kept;
            None if nothing at all is.
    """

    def __init__(self, holdings: Holdings, name: str, domain: int, thinned: list[str] | None) -> None:
        self._holdings, self._name = holdings, name
        self._prefix = f"@robolink/again/{domain}"
        self._thinned = None if thinned is None else [zenoh.KeyExpr(each) for each in thinned]
        self._lock = threading.Lock()
        self._mendings: weakref.WeakKeyDictionary[Mending, tuple[str, float]] = weakref.WeakKeyDictionary()
        self._known: dict[str, None] = {}
        self._to_ask: list[_Question] = []
        self._gates: weakref.WeakSet[Any] = weakref.WeakSet()
        self._offer: _Offer | None = None
        self._is_asking = self._has_watched = self._has_offered = False

    def cache(self, key: str, qos: QoSProfile, add: Add) -> Retained | None:
        """Return the latch of a publisher, for those who have lost some; None if it needs none.

        `add` declares, the first time, that messages are sent again to who asks.
        """
        if not self._recovers(qos) or any(each.includes(key) for each in self._thinned or ()):
            return None
        with self._lock:
            has_offered, self._has_offered = self._has_offered, True
        if not has_offered:
            offer = _Offer(self._holdings, self._declare_offer)
            add(offer)
            self._offer = offer  # not before: the look at links that stand still uses it on another thread
        return Retained(min(stored_depth(qos) or MOST_RETAINED, MOST_RETAINED), MOST_BYTES)

    def mend(self, key: str, qos: QoSProfile, sink: Sink, add: Add) -> Mending | None:
        """Return a sink in front of a subscription's, which puts in order what comes again; None if nothing does.

        `add` begins, the first time, to look for the tokens of others.
        """
        if not self._recovers(qos):
            return None
        mending = Mending(sink)
        with self._lock:
            self._mendings[mending] = key, clocks.monotonic()
            has_watched, self._has_watched = self._has_watched, True
        if not has_watched:
            # A former session's watch stays until that is left: what it brings must not come before its sender's token.
            add(Declaration(self._holdings, self._declare_watch))
        return mending

    def _recovers(self, qos: QoSProfile) -> bool:
        reliable = resolved(qos).reliability is ReliabilityPolicy.RELIABLE
        return self._thinned is not None and reliable and qos.durability is not DurabilityPolicy.TRANSIENT_LOCAL

    def ask_me(self) -> None:
        """Call others to ask, since they may be about to lose some: a link stands still, and its buffers are finite.

        Zenoh sends this before all that waits for the link, so that nobody takes messages behind a gap for the next.
        """
        if self._offer is not None:
            with contextlib.suppress(zenoh.ZError):  # closed meanwhile
                self._offer.ask_me()

    def _declare_offer(self, plain: ZenohTransport) -> _Offered:
        return _Offered(plain, f"{self._prefix}/{self._name}/{plain.session_id}", self._answer)

    def _answer(self, offered: _Offered, query: Any) -> None:
        offered.answers.wait(ANSWERED_WITHIN)
        payload = query.payload
        try:
            positions = msgspec.msgpack.decode(b"" if payload is None else payload.to_bytes(), type=list[Position])
            for each in together(positions):  # so that nobody gets a topic twice
                for part in self._retained(each):
                    with lifetime.inside:
                        query.reply(offered.key, part)  # dropped where its link is full, as the question asks
        except (msgspec.DecodeError, msgspec.ValidationError, zenoh.ZError):  # nonsense, or who asked is gone
            pass
        finally:
            declare.quietly(query.drop)

    def _retained(self, position: Position) -> Iterator[bytes]:
        for each in self._holdings.all():
            if isinstance(each, RoamingOutlet) and each.cache is not None and each.key == position.key:
                yield from parts(position.key, newer(each.cache.last(), position))

    def _declare_watch(self, plain: ZenohTransport) -> Handle:
        generation, pattern = _Generation(plain.session), f"{self._prefix}/*/*"
        changed = make_gate(functools.partial(self._on_token, generation))
        called = make_gate(functools.partial(self._on_call, plain.session))

        def watch(session: Any) -> list[Any]:
            remote = zenoh.Locality.REMOTE
            return [
                session.declare_subscriber(pattern, declare.direct(called), allowed_origin=remote),
                session.liveliness().declare_subscriber(pattern, declare.direct(changed), history=True),
            ]

        return plain.declare(self._prefix, watch, changed, called)

    def _on_token(self, generation: _Generation, sample: zenoh.Sample) -> None:
        """Note a token; called on Zenoh's thread, before any message that comes by the same link."""
        key = str(sample.key_expr)
        name = key.split("/")[-2]
        if name == self._name:
            return
        with self._lock:
            if sample.kind != zenoh.SampleKind.PUT:
                generation.seen.discard(key)
                return
            is_back = name in self._known and key not in generation.seen
            generation.seen.add(key)
            self._known[name] = None
            if len(self._known) > MOST_KNOWN:
                del self._known[next(iter(self._known))]
        if is_back:
            self._begin(generation.session, key)

    def _on_call(self, session: Any, sample: zenoh.Sample) -> None:
        """Ask who wants to be asked, if it is known; called on Zenoh's thread, too."""
        key = str(sample.key_expr)
        if key.split("/")[-2] in self._known:
            self._begin(session, key)

    def _begin(self, session: Any, key: str) -> None:
        with self._lock:
            if len(self._to_ask) >= MOST_WAITING:  # somebody's nonsense: no system has so many that come back at once
                return
            mendings = list(self._mendings)
        for each in mendings:
            each.begin(len(ASKS_AFTER), ASKS_AFTER[-1] + ANSWERED_WITHIN)
        if mendings:
            now = clocks.monotonic()
            self._ask_soon([_Question(now + after, session, key, mendings) for after in ASKS_AFTER])

    def _ask_soon(self, questions: list[_Question]) -> None:
        """Ask on a thread of its own, since this one is Zenoh's."""
        with self._lock:
            self._to_ask += questions
            is_asking, self._is_asking = self._is_asking, True
        if not is_asking:
            try:
                threading.Thread(target=self._ask_all, name="robolink recovery", daemon=True).start()
            except RuntimeError:  # Python 3.12 starts no threads any more at exit
                self._is_asking = False

    def _ask_all(self) -> None:
        while True:
            with self._lock:
                if not self._to_ask:
                    self._is_asking = False
                    return
                question = min(self._to_ask, key=lambda each: each.due)
                if (wait := question.due - clocks.monotonic()) <= 0:
                    self._to_ask.remove(question)
            if wait > 0:
                time.sleep(min(wait, 0.05))  # one that is due earlier may come meanwhile
                continue
            try:
                self._ask(question.session, question.key, question.mendings)
            except zenoh.ZError:  # closed meanwhile
                _end(question.mendings)

    def _ask(self, session: Any, key: str, mendings: list[Mending]) -> None:
        positions, by_topic = list[Position](), dict[str, list[Mending]]()
        for each in mendings:
            topic, since = self._mendings.get(each) or ("", 0.0)
            if topic:
                age = min(clocks.monotonic() - since, LONGEST_GONE)
                positions.append(Position(topic, int(age * 1e9), each.positions()))
                by_topic.setdefault(topic, []).append(each)
        question = msgspec.msgpack.encode(together(positions))
        gate, end = make_gate(functools.partial(_take, by_topic)), make_gate(_end, mendings)
        self._gates.update((gate, end))
        with lifetime.inside:
            session.get(
                key,
                declare.direct(gate, end),
                payload=question,
                priority=zenoh.Priority.BACKGROUND,  # the answers have it too: all that is new goes before them
                congestion_control=zenoh.CongestionControl.DROP,
                consolidation=zenoh.ConsolidationMode.NONE,
                timeout=ANSWERED_WITHIN,
            )

    def close(self) -> None:
        """Take no more answers."""
        for each in lifetime.all_of(self._gates):
            close_gate(each)


def _take(mendings: dict[str, list[Mending]], reply: Any) -> None:
    """Deliver an answer; called on Zenoh's thread."""
    if reply.ok is None:
        return
    with contextlib.suppress(msgspec.DecodeError, msgspec.ValidationError):  # somebody's nonsense
        answer = msgspec.msgpack.decode(reply.ok.payload.to_bytes(), type=Answer)
        for each in mendings.get(answer.key, ()):
            each.take(answer.messages)


def _end(mendings: list[Mending]) -> None:
    for each in mendings:
        each.end()


MOST_RETAINED = 4096
"""Most messages that a publisher retains: with KEEP_ALL, 40 s of 100 Hz."""

MOST_BYTES = 1 << 24
"""Most bytes that a publisher retains; of larger messages there are fewer."""

PART = 1 << 16
"""Size in bytes from which an answer is sent in several parts."""


class Position(NamedTuple):
    """State of one subscription, for the publishers of its topic."""

    key: str
    age: int
    """Nanoseconds since it was made: messages of unknown publishers that are older are none of its own."""
    last: dict[bytes, int]
    """Number of the last message of each publisher, by its gid."""


class Answer(NamedTuple):
    """Messages of one topic, in their order: payloads and attachments."""

    key: str
    messages: list[tuple[bytes, bytes]]


def newer(retained: Iterable[tuple[bytes, bytes]], position: Position) -> list[tuple[bytes, bytes]]:
    """Return the messages newer than those that a subscription has, in the order of its numbers."""
    since = clocks.now() - position.age
    found = [(number, each) for each in retained if (number := _newer(each[1], position, since)) is not None]
    return [each for _, each in sorted(found, key=_number)]  # threads that publish may overtake each other


def _newer(attachment: bytes, position: Position, since: int) -> int | None:
    """Return the number of a message; None if it is not newer than what has come."""
    try:
        number, at, _, gid = fields_of(attachment)
    except struct.error:  # not ROS 2's: without a number nothing can be asked for
        return None
    last = position.last.get(gid)
    is_newer = at >= since if last is None else number > last
    return number if is_newer else None


def _number(found: tuple[int, tuple[bytes, bytes]]) -> int:
    return found[0]


def together(positions: Iterable[Position]) -> list[Position]:
    """Return one question for each topic: for what any of its subscriptions lacks."""
    found = dict[str, Position]()
    for each in positions:
        other = found.get(each.key, each)
        last = other.last | {gid: min(number, other.last.get(gid, number)) for gid, number in each.last.items()}
        found[each.key] = Position(each.key, max(each.age, other.age), last)
    return list(found.values())


def parts(key: str, messages: Iterable[tuple[bytes, bytes]]) -> Iterator[bytes]:
    """Yield answers with these messages, each of PART bytes or one message more."""
    part, size = list[tuple[bytes, bytes]](), 0
    for each in messages:
        part.append(each)
        size += len(each[0])
        if size >= PART:
            yield msgspec.msgpack.encode(Answer(key, part))
            part, size = [], 0
    if part:
        yield msgspec.msgpack.encode(Answer(key, part))
