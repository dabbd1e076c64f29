"""Roaming transport: what was declared in one Zenoh session goes on in another one, behind the same handles.

It wraps the plain transport where a session leaves the machine, whose addresses change and whose links stand still, or
has keys that are renewed. For a while both sessions are open. What is published goes through the old one until the new
one has its links; what both bring is delivered once.
"""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable
from typing import Any, TypeVar

import zenoh

from robolink.exceptions import TransportClosedError, TransportError
from robolink.logging import get_logger
from robolink.qos import QoSProfile
from robolink.system import clocks
from robolink.transport import addresses, lifetime
from robolink.transport.addresses import Place, Probes, waiting
from robolink.transport.base import Handle, Outlet, Query, Sample, Sink, Transport
from robolink.transport.gates import make_gate
from robolink.transport.reach import Link, host_of, port_of
from robolink.transport.roaming_handles import (
    Declaration,
    Holdings,
    RoamingOutlet,
    RoamingSubscription,
    RoamingWatch,
)
from robolink.transport.zenoh import ZenohTransport
from robolink.transport.zenoh_declare import ask, is_over
from robolink.transport.zenoh_handles import LOOKS_AGAIN
from robolink.transport.zenoh_recovery import Recovery

LINKS_WITHIN = 1.0
"""Longest wait in seconds for the new session's links, while everything still goes through the old one."""

OVERLAP = 2.0
"""Time in seconds for which the old session still delivers, and calls that it has under way may be answered."""

SETTLED_AFTER = 5.0
"""Time in seconds after which nodes elsewhere that have not been found again count as gone."""

NOBODY = "@ros2_lv/nobody"
"""Token that nobody has."""

STEP = 0.02
"""Interval of the looks whether all are linked, or the session has been closed, in seconds."""

_Declaration = TypeVar("_Declaration", bound=Declaration)
_Made = TypeVar("_Made")


class Moves:
    """Record of a transport's moves."""

    def __init__(self) -> None:
        self.moving = threading.Lock()
        self.addresses: frozenset[str] | None = None
        self.reported = ""
        """Last error that has been logged."""
        self.probes = Probes()
        self.stuck: set[Place] = set()
        """Other ends of the links that stand still."""

    def is_news(self, now: frozenset[str]) -> bool:
        """True if an address is new, and nothing is being done about it; the first ones are those of the start."""
        if self.addresses is None:
            self.addresses = now
        return not now <= self.addresses and not self.moving.locked()


class RoamingTransport(Transport):
    """A Zenoh transport that goes on when its session has to be replaced, and recovers what a lost link has cost.

    Args:
        open_plain: Function that opens a plain transport of the same network, `named` at some addresses.
        domain: ROS domain id.
        plain: The first one; None opens it.
    """

    threaded = True

    def __init__(
        self, open_plain: Callable[..., ZenohTransport], domain: int, plain: ZenohTransport | None = None
    ) -> None:
        self.plain = open_plain() if plain is None else plain
        """The transport of the present session."""
        self.url, self.session_id = self.plain.url, self.plain.session_id  # the id stays that of the first session
        self.has_left = False
        self._open_plain = open_plain
        self._holdings = Holdings()
        self._moves = Moves()
        self._recovery = Recovery(self._holdings, self.session_id, domain, self.plain.thinned)
        lifetime.watch_over(self)
        if self.plain.leaves_machine:
            addresses.watch(self)

    # Transport

    def advertise(self, key: str, qos: QoSProfile) -> Outlet:
        """Declare a publisher. With TRANSIENT_LOCAL it retains the last `qos.depth` samples for late joiners."""
        cache = self._recovery.cache(key, qos, self._add)
        return self._add(RoamingOutlet(self._holdings, key, qos, cache))

    def subscribe(self, key: str, qos: QoSProfile, sink: Sink) -> Handle:
        """Call `sink` for every sample published on `key`; with TRANSIENT_LOCAL what was retained comes first."""
        mending = self._recovery.mend(key, qos, sink, self._add)
        return self._add(RoamingSubscription(self._holdings, key, qos, sink, mending))

    def serve(self, key: str, sink: Sink) -> Handle:
        """Call `sink` for every call on `key`; `accept` turns what it gets into a Query."""
        gate = make_gate(sink)
        return self._add(Declaration(self._holdings, lambda plain: plain.serve(key, gate), gate))

    def call(self, key: str, payload: bytes, attachment: bytes, sink: Sink) -> Handle:
        """Send a request to all servers of `key`. `sink` gets each reply, then None once as the end."""
        return self._in_present(lambda plain: plain.call(key, payload, attachment, sink))

    def announce(self, token: str) -> Handle:
        """Declare a liveliness token, visible to all watches until it is closed or this process is gone."""
        return self._add(Declaration(self._holdings, lambda plain: plain.announce(token)))

    def watch(self, pattern: str, on_change: Callable[[str, bool], object]) -> Handle:
        """Call `on_change(token, alive)` for each token that matches `pattern`, on a thread of its own."""
        return self._add(RoamingWatch(self._holdings, pattern, on_change))

    def tokens(self, pattern: str) -> list[str]:
        """Return the tokens that match `pattern`, sorted: also those of peers that this session only just found."""
        return self._in_present(lambda plain: plain.tokens(pattern))

    def links(self) -> list[Link]:
        """Return the connections to other sessions."""
        return self.plain.links()

    def read(self, arrived: Any) -> Sample:
        """Convert an item of a subscription's or a call's sink to bytes.

        Raises TransportError on an error reply, OverwrittenError for a message that its sender has overwritten.
        """
        return self.plain.read(arrived)

    def opener(self, check: Callable[[bytes], object], decode: Callable[[bytes], Any]) -> Callable[[Any], Any]:
        """Return a function that does `read`, `check` and `decode`."""
        return self.plain.opener(check, decode)  # that of another session's would do the same

    def size(self, arrived: Any) -> int:
        """Return the payload size, in bytes, of an item of a subscription's sink, without copying it."""
        return self.plain.size(arrived)

    def attachment(self, arrived: Any) -> bytes:
        """Return the attachment of an item of a subscription's sink, without copying the payload."""
        return self.plain.attachment(arrived)

    def accept(self, arrived: Any) -> Query:
        """Convert an item of a server's sink to a Query. Raises OverwrittenError, and ends the call, as `read` does."""
        return self.plain.accept(arrived)

    def close(self) -> None:
        """Undeclare everything and leave the network; calls under way end. Safe to call twice."""
        if self.has_left:
            return
        self._recovery.close()
        for each in self._holdings.end(f"session {self.session_id} has been closed"):
            each.end()
        self.plain.close()
        self.has_left = True  # so late: a Ctrl-C that breaks into this must not keep the exit from doing it
        lifetime.forget(self)
        addresses.forget(self)

    def disown(self) -> None:
        """Refuse every further use in a forked child."""
        self.has_left, self._holdings.why_closed = True, lifetime.AFTER_FORK

    def _in_present(self, action: Callable[[ZenohTransport], _Made]) -> _Made:
        """Return the result of `action` in the present session, or in the next one if that is left meanwhile."""
        while True:
            self._holdings.check()
            plain = self.plain
            try:
                return action(plain)
            except TransportClosedError:
                if plain is self.plain:
                    raise

    def _add(self, declaration: _Declaration) -> _Declaration:
        """Return a declaration, declared in the present session: in the next one if that is replaced meanwhile."""
        plain, handle = self._in_present(lambda plain: (plain, declaration.declare_in(plain)))
        declaration.begin(plain, handle)
        declaration.move_to(self.plain)
        return declaration

    # Moves

    def move(self, now: frozenset[str]) -> None:
        """Go on from these addresses, on a background thread, if any of them is new."""
        if self._moves.is_news(now):
            self._move(now)

    def unstick(self) -> None:
        """Go on in a new session, on a background thread, if links of this one wait though packets pass again."""
        moves = self._moves
        if moves.moving.locked():
            return
        stuck = waiting([(_place(each.here), _place(each.there)) for each in self.links() if each.leaves_machine])
        before, moves.stuck = moves.stuck, {each.there for each in stuck}
        if moves.probes.passes(stuck):
            get_logger("robolink.transport").info("packets pass again, but TCP still waits: links are made again")
            self._move(moves.addresses or frozenset(), again=True)
        if not moves.stuck <= before:
            self._recovery.ask_me()

    def reopen(self, named: frozenset[str] = frozenset(), *, again: bool = False) -> None:
        """Go on in a new session, behind the same handles; takes some seconds, and returns when all has settled.

        Args:
            named: Addresses at which it is found; none for those that Zenoh knows.
            again: True does it also where none of them is new.
        """
        moves = self._moves
        with moves.moving:
            if not again and moves.addresses is not None and named and named <= moves.addresses:
                return
            begin, watches = clocks.monotonic(), self._replace(named)
        self._wait(begin + SETTLED_AFTER - clocks.monotonic())
        for each in watches:
            each.settle()

    def _move(self, now: frozenset[str], *, again: bool = False) -> None:
        """Do `reopen` on a background thread."""

        def go_on() -> None:
            try:
                self.reopen(now, again=again)
            except TransportError as error:  # the next look tries again
                if (text := str(error)) != self._moves.reported:
                    self._moves.reported = text
                    get_logger("robolink.transport").warning(
                        f"this machine is to be found at {', '.join(sorted(now))}, but is not yet: {text}"
                    )

        with contextlib.suppress(RuntimeError):  # Python 3.12 starts no threads any more at exit
            threading.Thread(target=go_on, name="robolink reunion", daemon=True).start()

    def _replace(self, named: frozenset[str]) -> list[RoamingWatch]:
        with lifetime.inside:
            peers = {each.session for each in self.links() if _is_alive(each, named)}
        opened = self._open_plain(named=named)
        is_news = named != self._moves.addresses
        if named:
            self._moves.addresses, self._moves.reported = named, ""
        subscriptions = [each for each in self._holdings.all() if isinstance(each, RoamingSubscription)]
        for each in subscriptions:
            each.sift(True)
        made = self._declare_in(opened)
        self._wait(LINKS_WITHIN, lambda: peers <= _linked(opened.session))
        _hear_out(opened.session)
        former = self._take(opened)
        for declaration, handle in made:
            declaration.adopt(opened, handle)
        for declaration in self._holdings.all():  # those that were declared meanwhile
            declaration.move_to(opened)
        for declaration in self._holdings.all():
            declaration.settle_in()
        if named and is_news:
            where = ", ".join(sorted(named))
            get_logger("robolink.transport").info(f"this machine's addresses have changed: found at {where} now")
        self._wait(OVERLAP)
        former.lose_calls()
        former.close()
        for each in subscriptions:
            each.sift(False)
        return [each for each in self._holdings.all() if isinstance(each, RoamingWatch)]

    def _take(self, opened: ZenohTransport) -> ZenohTransport:
        """Use another session from now on, unless this transport has been closed; return the one that is left."""
        with self._holdings.lock:
            if self._holdings.why_closed:
                return opened
            former, self.plain = self.plain, opened
            return former

    def _declare_in(self, plain: ZenohTransport) -> list[tuple[Declaration, Handle]]:
        """Declare all in another session too, where nothing uses it yet."""
        made = []
        for each in self._holdings.all():
            try:
                made.append((each, each.declare_in(plain)))
            except TransportError as error:  # the others go on
                get_logger("robolink.transport").error(f"a declaration is lost with the old address: {error}")
        return made

    def _wait(self, seconds: float, is_enough: Callable[[], bool] = bool) -> None:
        """Wait so long at most, and no longer than until the transport has been closed."""
        deadline = clocks.monotonic() + seconds
        while clocks.monotonic() < deadline and not self.has_left and not is_enough():
            time.sleep(STEP)


def _place(end: str) -> Place:
    return host_of(end).partition("%")[0], port_of(end)


def _is_alive(link: Link, addresses: frozenset[str]) -> bool:
    """True if this machine still has the address from which a link starts."""
    return not link.leaves_machine or not addresses or host_of(link.here) in addresses


def _linked(session: Any) -> set[str]:
    with lifetime.inside:
        return {str(each) for each in (*session.info.peers_zid(), *session.info.routers_zid())}


def _hear_out(session: Any) -> None:
    """Wait until those linked have told what they subscribe to: the answer to a question comes after that."""
    with contextlib.suppress(zenoh.ZError):
        with lifetime.inside:
            question = ask(session, NOBODY, LINKS_WITHIN)
        deadline = clocks.monotonic() + LINKS_WITHIN
        while not is_over(question) and clocks.monotonic() < deadline:
            time.sleep(LOOKS_AGAIN)
