"""Reunion of a Zenoh session: what was declared in one session goes on in another one, behind the same handles.

For a while both are open. What is published goes through the old one until the new one has its links; what both bring
is delivered once.
"""

from __future__ import annotations

import contextlib
import functools
import queue
import threading
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import zenoh

from robolink.exceptions import TransportError
from robolink.logging import get_logger
from robolink.system import clocks
from robolink.system.waits import get_within
from robolink.transport import lifetime
from robolink.transport.port_sharing import PortClaim
from robolink.transport.reach import Link, host_of, port_of
from robolink.transport.stuck_links import Place, Probes, waiting
from robolink.transport.zenoh_declare import Heard, ask, close_gate
from robolink.transport.zenoh_handles import Declared, Holdings, ZenohSubscription
from robolink.transport.zenoh_tokens import ZenohWatch

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


class Former:
    """A session that is used no longer: it is left after a while, or when the process ends."""

    def __init__(self, session: Any, leave: Callable[[Any, list[object]], object]) -> None:
        self._session, self._leave = session, leave
        self._lock, self._has_left = threading.Lock(), False
        self.entities: list[object] = []
        """Entities still declared in it: kept, since freeing one before the session is closed undeclares it."""
        lifetime.watch_over(self)

    def close(self) -> None:
        """Leave the network. Safe to call twice."""
        with self._lock:
            has_left, self._has_left = self._has_left, True
        if not has_left:
            for each in self.entities:
                if isinstance(each, Heard):  # closing takes seconds where a link stands still: peers may find it then
                    close_gate(each.gate)
            self._leave(self._session, self.entities)
            lifetime.forget(self)

    def disown(self) -> None:
        """Refuse every further use in a forked child."""
        self._has_left = True
        lifetime.leak((self._session, self.entities))


class Joined(NamedTuple):
    """A session that has joined a network."""

    session: zenoh.Session
    claim: PortClaim | None = None
    holds_port: bool = False
    moves: bool = False
    """True if others may be met at addresses that change."""
    thinned: list[str] | None = None
    """Key expressions of the topics of which nothing is sent again after a cut; None if nothing at all is."""


class Opened(NamedTuple):
    """A new session, and how to use it instead of the present one."""

    session: Any
    take: Callable[[], Former]
    """Function that replaces the present session by it, and returns the one not used any more."""


class State:
    """Record of a transport's moves; it refers to nothing else, so that a transport that nobody holds is freed."""

    def __init__(self) -> None:
        self.moving = threading.Lock()
        self.addresses: frozenset[str] | None = None
        self.told = ""
        self.probes = Probes()
        self.stuck: set[Place] = set()
        """Other ends of the links that stand still."""

    def is_news(self, now: frozenset[str]) -> bool:
        """True if an address is new, and nothing is being done about it; the first ones are those of the start."""
        if self.addresses is None:
            self.addresses = now
        return not now <= self.addresses and not self.moving.locked()


class Mover:
    """Moves what a transport has declared to a new session when this machine's addresses change.

    Args:
        state: Record of the moves before this one.
        holdings: What is declared.
        open_beside: Function of the addresses to name, which opens a session beside the present one.
        links: Function that returns the links of the present session.
        end_calls: Function that ends the calls that a former session has under way.
        has_left: Function that says if the transport has been closed.
    """

    def __init__(
        self,
        state: State,
        holdings: Holdings,
        open_beside: Callable[[frozenset[str]], Opened],
        links: Callable[[], list[Link]],
        end_calls: Callable[[], object],
        has_left: Callable[[], bool],
    ) -> None:
        self._holdings, self._open_beside, self._links = holdings, open_beside, links
        self._end_calls, self._has_left = end_calls, has_left
        self._state = state

    def move(self, now: frozenset[str], *, again: bool = False) -> None:
        """Do `reopen` on a background thread."""
        arguments = {"again": again}
        with contextlib.suppress(RuntimeError):  # Python 3.12 starts no threads any more at exit
            threading.Thread(
                target=self._go_on, args=(now,), kwargs=arguments, name="robolink reunion", daemon=True
            ).start()

    def unstick(self) -> bool:
        """Do `reopen` on a background thread if TCP waits on a link to another machine, though packets pass again.

        Returns True if another one than before stands still.
        """
        if self._state.moving.locked():
            return False
        stuck = waiting([(_place(each.here), _place(each.there)) for each in self._links() if each.leaves_machine])
        before, self._state.stuck = self._state.stuck, {each.there for each in stuck}
        if self._state.probes.passes(stuck):
            get_logger("robolink.transport").info("packets pass again, but TCP still waits: links are made again")
            self.move(self._state.addresses or frozenset(), again=True)
        return not self._state.stuck <= before

    def _go_on(self, now: frozenset[str], *, again: bool) -> None:
        try:
            self.reopen(now, again=again)
        except TransportError as error:  # the next look tries again
            if (text := str(error)) != self._state.told:
                self._state.told = text
                get_logger("robolink.transport").warning(
                    f"this machine is to be found at {', '.join(sorted(now))}, but is not yet: {text}"
                )

    def reopen(self, named: frozenset[str] = frozenset(), *, again: bool = False) -> None:
        """Go on in a new session that is found at these addresses; returns when all has settled.

        Args:
            named: Addresses; none for those that Zenoh knows.
            again: True does it also where none of them is new.
        """
        with self._state.moving:
            if not again and self._state.addresses is not None and named and named <= self._state.addresses:
                return
            begin, watches = clocks.monotonic(), self._replace(named)
        self._wait(begin + SETTLED_AFTER - clocks.monotonic())
        for each in watches:
            each.settle()

    def _replace(self, named: frozenset[str]) -> list[ZenohWatch]:
        with lifetime.inside:
            peers = {each.session for each in self._links() if _is_alive(each, named)}
        opened = self._open_beside(named)
        is_news = named != self._state.addresses
        if named:
            self._state.addresses, self._state.told = named, ""
        subscriptions = [each for each in self._declared() if isinstance(each, ZenohSubscription)]
        for each in subscriptions:
            each.sift(True)
        made = self._declare_in(opened.session)
        self._wait(LINKS_WITHIN, lambda: peers <= _linked(opened.session))
        _hear_out(opened.session)
        former = opened.take()
        for handle, entity in made:
            former.entities += handle.adopt(entity, opened.session)
        for handle in self._declared():  # those that were declared meanwhile
            former.entities += handle.move_to(opened.session)
        for handle in self._declared():
            handle.settle_in()
        if named and is_news:
            where = ", ".join(sorted(named))
            get_logger("robolink.transport").info(f"this machine's addresses have changed: found at {where} now")
        self._wait(OVERLAP)
        self._end_calls()
        former.close()
        for each in subscriptions:
            each.sift(False)
        return [each for each in self._declared() if isinstance(each, ZenohWatch)]

    def _declare_in(self, session: Any) -> list[tuple[Declared, Any]]:
        """Declare all in another session too, where nothing uses it yet."""
        made = []
        for each in self._declared():
            try:
                with lifetime.inside:
                    made.append((each, each.declare_in(session)))
            except zenoh.ZError as error:  # the others go on
                get_logger("robolink.transport").error(f"a declaration is lost with the old address: {error}")
        return made

    def _declared(self) -> list[Declared]:
        with self._holdings.lock:
            return list(self._holdings.handles)

    def _wait(self, seconds: float, is_enough: Callable[[], bool] = bool) -> None:
        """Wait so long at most, and no longer than until the transport has been closed."""
        deadline = clocks.monotonic() + seconds
        while clocks.monotonic() < deadline and not self._has_left() and not is_enough():
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
    answered: queue.SimpleQueue[None] = queue.SimpleQueue()
    with contextlib.suppress(queue.Empty, zenoh.ZError):
        with lifetime.inside:
            ask(session, NOBODY, functools.partial(answered.put, None), LINKS_WITHIN)
        get_within(answered, LINKS_WITHIN)
