"""Zenoh transport: a network between processes and machines, with Eclipse Zenoh as rmw_zenoh uses it.

No Python frame runs on Zenoh's threads for data: they call a `functools.partial` around the sink, and the
sink is meant to be C as well. Raw samples wait in queues until `read` converts them to bytes.
"""

from __future__ import annotations

import contextlib
import functools
import os
import queue
import time
import weakref
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import zenoh

from robolink.exceptions import OverwrittenError, TransportError
from robolink.networks import refusals
from robolink.networks.asked import FIRST_PORT, ROS_ROUTER, checked_domain
from robolink.networks.settings import OFTEN, SOUGHT_EVERY
from robolink.qos import DurabilityPolicy, QoSProfile, resolved
from robolink.system import clocks, heap
from robolink.transport import addresses, certificates, lifetime, network, port_heir, port_sharing
from robolink.transport import zenoh_calls as calls
from robolink.transport import zenoh_declare as declare
from robolink.transport import zenoh_handles as handles
from robolink.transport import zenoh_reunion as reunion
from robolink.transport.base import Handle, Outlet, Query, Sample, Sink, Transport, make_sample, refuse_giant
from robolink.transport.history import Latch, latched_depth
from robolink.transport.reach import Link, Reach, links_of, port_of, reach
from robolink.transport.shared_pools import PoolLimit
from robolink.transport.zenoh_recovery import Recovery
from robolink.transport.zenoh_sieve import Sieve
from robolink.transport.zenoh_tokens import Changes, ZenohToken, ZenohWatch, settled

CLOSE_WITHIN = 0.15
"""Longest `close`, in seconds; then it goes on in the background."""

LINK_WITHIN = 3.0
"""Timeout of the rendezvous port's holder, in seconds; it takes 2 ms, and 1 s on a very busy machine."""

REUNION = SOUGHT_EVERY + 0.05
"""Time in which the peers of an earlier holder of the rendezvous port find the new one, in seconds."""

SMALL = 4096
"""Payload size in bytes below which a message is read with nothing but Zenoh's calls."""

_ZenohSample = zenoh.Sample
_Handle = TypeVar("_Handle", bound=handles.Declared)


class ZenohTransport(Transport):
    """A session on a Zenoh network: this machine's, or what `network` or the environment asks for.

    See `robolink.networks.asked.wanted`. `secure` closes each configuration to whoever has no keys, in place of what
    the environment says of security. Raises TransportError when there is no joining it.
    """

    threaded = True

    def __init__(
        self,
        domain: int = 0,
        network: str | None = None,
        environ: Mapping[str, str] | None = None,
        secure: Callable[[zenoh.Config], object] | None = None,
    ) -> None:
        self.url = "zenoh://"
        lifetime.refuse_if_forked()
        self._holdings = handles.Holdings()
        self._ends: weakref.WeakSet[Sink] = weakref.WeakSet()
        self._moved = reunion.State()
        self._calls: weakref.WeakSet[calls.ZenohCall] = weakref.WeakSet()
        self._has_left = False
        with lifetime.inside:
            before = clocks.time_of_day()
            environ = dict(os.environ if environ is None else environ)
            self._join = functools.partial(_join, domain, network, environ, secure)
            self._session, self._claim, holds_port, self._moves, thinned = self._join()
            self._met_at = clocks.monotonic() + (REUNION if holds_port else 0.0)
            self._pools = PoolLimit(before)
            self.session_id = str(self._session.info.zid())
            lifetime.watch_over(self)
        self._recovery = Recovery(self._holdings, self.session_id, domain, thinned)
        if self._moves:
            addresses.watch(self)

    def advertise(self, key: str, qos: QoSProfile) -> Outlet:
        """Declare a publisher. With TRANSIENT_LOCAL it keeps the last `qos.depth` samples for late joiners."""
        made, full = self._make(key, declare.declare_publishers, key, resolved(qos)), resolved(qos)
        keeps = self._moves and qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
        kept = Latch[tuple[bytes, bytes]](latched_depth(qos)) if keeps else None
        cache = self._recovery.cache(key, full, self._make, self._settle)
        return self._settle(handles.ZenohOutlet(self._holdings, key, made, kept, cache))

    def subscribe(self, key: str, qos: QoSProfile, sink: Sink) -> Handle:
        """Call `sink` for every sample published on `key`; with TRANSIENT_LOCAL what was kept comes first."""
        latched = qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
        if latched and self._moves:  # who has moved, here or elsewhere, sends again what it keeps
            sink = Sieve(sink)
        else:
            sink = self._recovery.mend(key, resolved(qos), sink, self._make, self._settle)
        gate = declare.make_gate(sink)
        subscribe = declare.declare_heard if self._moves else declare.declare_subscriber
        made = self._make(key, subscribe, key, gate, resolved(qos))
        topic = self._holdings.topic(key)
        return self._settle(handles.ZenohSubscription(self._holdings, made, gate, topic, sink, latched=latched))

    def serve(self, key: str, sink: Sink) -> Handle:
        """Call `sink` for every call on `key`; `accept` turns what it gets into a Query."""
        gate = declare.make_gate(sink)
        return self._settle(handles.Declared(self._holdings, self._make(key, declare.declare_server, key, gate), gate))

    def call(self, key: str, payload: bytes, attachment: bytes, sink: Sink) -> Handle:
        """Send a request to all servers of `key`. `sink` gets each reply, then None once as the end."""
        refuse_giant(key, payload)
        gate, end = declare.make_gate(sink), declare.make_gate(sink, None)
        self._ends.add(end)
        made = self._make(key, declare.call, key, payload, attachment, gate, end)
        call = calls.ZenohCall(made.session, made.entity, gate, end)
        self._calls.add(call)
        return call

    def announce(self, token: str) -> Handle:
        """Declare a liveliness token, visible to all watches until it is closed or this process is gone."""
        return self._settle(ZenohToken(self._holdings, self._make(token, declare.declare_token, token), token))

    def watch(self, pattern: str, on_change: Callable[[str, bool], object]) -> Handle:
        """Call `on_change(token, alive)` for each token that matches `pattern`, on a thread of its own."""

        def on_token(token: str, alive: bool) -> object:
            self._pools.look()  # somebody new has come, perhaps
            return on_change(token, alive)

        changes = Changes(on_token, self._holdings.tokens)
        made = self._make(pattern, declare.declare_watch, pattern, changes)
        return self._settle(ZenohWatch(self._holdings, made, changes))

    def tokens(self, pattern: str) -> list[str]:
        """Return the tokens that match `pattern`, sorted: also those of peers that this session only just found.

        A session that has just taken the rendezvous port waits for those that may still be there without one.
        """
        time.sleep(max(0.0, self._met_at - clocks.monotonic()))
        arrived: queue.SimpleQueue[Any] = queue.SimpleQueue()
        subscriber = self._try(pattern, declare.declare_look, pattern, arrived.put)
        try:
            return sorted(settled(arrived, functools.partial(self._try, pattern, declare.ask, pattern), self._peers))
        finally:
            declare.quietly(subscriber.undeclare)

    def links(self) -> list[Link]:
        """Return the connections to other sessions."""
        with lifetime.inside:
            return links_of(self._session)

    def read(self, arrived: Any) -> Sample:
        """Convert an item of a subscription's or a call's sink to bytes.

        Raises TransportError on an error reply, OverwrittenError for a message that its sender has overwritten.
        """
        kind = type(arrived)
        if kind is _ZenohSample:  # the usual case first, and without calls: this is run once a message
            attachment, payload = arrived.attachment, arrived.payload
            sample = make_sample((payload.to_bytes(), b"" if attachment is None else attachment.to_bytes()))
            shared = payload.as_shm()
            if shared is not None:
                if not shared.is_valid():  # asked after the copy: it may happen during it
                    raise OverwrittenError(sample.attachment)
                self._pools.look()
            if len(sample[0]) >= heap.LARGE:
                heap.note(len(sample[0]))
            return sample
        if kind is Sample:
            own: Sample = arrived
            return own
        return calls.content_of_reply(arrived)

    def opener(self, check: Callable[[bytes], object], decode: Callable[[bytes], Any]) -> Callable[[Any], Any]:
        """Return a function that does `read`, `check` and `decode`; in one frame where the message is small."""
        read = self.read

        def opened(arrived: Any) -> Any:
            if type(arrived) is _ZenohSample and len(raw := arrived.payload) < SMALL and raw.as_shm() is None:
                beside = arrived.attachment
                payload, attachment = raw.to_bytes(), b"" if beside is None else beside.to_bytes()
            else:
                payload, attachment = read(arrived)
            check(attachment)
            return decode(payload)

        return opened

    def size(self, arrived: Any) -> int:
        """Return the payload size, in bytes, of an item of a subscription's sink, without copying it."""
        return len(arrived.payload)

    def attachment(self, arrived: Any) -> bytes:
        """Return the attachment of an item of a subscription's sink, without copying the payload."""
        attachment = arrived.attachment
        return b"" if attachment is None else attachment.to_bytes()

    def accept(self, arrived: Any) -> Query:
        """Convert an item of a server's sink to a Query. Raises OverwrittenError, and ends the call, as `read` does."""
        return calls.ZenohQuery(arrived)

    def close(self) -> None:
        """Undeclare everything and leave the network; calls under way end. Safe to call twice."""
        if self._has_left:
            return
        if lifetime.is_ending():  # whoever waits ends as well, and shall not complain that nobody answers
            for end in lifetime.all_of(self._ends):
                declare.close_gate(end)
        why = f"session {self.session_id} has been closed"
        self._recovery.close()
        with self._holdings.lock:
            declared = self._holdings.end(why)
        _leave(self._claim, self._session, [entity for handle in declared for entity in handle.shut(why)])
        self._has_left = True  # so late: a Ctrl-C that breaks into this must not keep the exit from doing it
        lifetime.forget(self)
        addresses.forget(self)

    def move(self, now: frozenset[str]) -> None:
        """Go on from these addresses, on a background thread, if any of them is new."""
        if self._moved.is_news(now):
            self._mover().move(now)

    def unstick(self) -> None:
        """Go on in a new session, on a background thread, if links of this one wait though packets pass again."""
        if self._mover().unstick():
            self._recovery.ask_me()

    def reopen(self, named: frozenset[str] = frozenset()) -> None:
        """Go on in a new session that is found at these addresses, behind the same handles; takes some seconds."""
        self._mover().reopen(named)

    def disown(self) -> None:
        """Refuse every further use in a forked child."""
        self._has_left = True
        for handle in self._holdings.end(lifetime.AFTER_FORK):  # not locked: whoever holds the lock may be gone
            handle.disown(lifetime.AFTER_FORK)
        lifetime.leak(self._session)

    def _mover(self) -> reunion.Mover:
        opens, ends = self._open_beside, self._end_calls
        return reunion.Mover(self._moved, self._holdings, opens, self.links, ends, lambda: self._has_left)

    def _open_beside(self, named: frozenset[str]) -> reunion.Opened:
        with lifetime.inside:
            joined = self._join(named)
            opened = reunion.Former(joined.session, functools.partial(_leave, joined.claim))  # if the process ends now
        former = self._session, self._claim

        def take() -> reunion.Former:
            """Use the new session from now on, unless this transport has been closed meanwhile."""
            with self._holdings.lock:
                if self._holdings.why_closed:
                    return opened
                self._session, self._claim = joined.session, joined.claim
            lifetime.forget(opened)
            session, claim = former
            return reunion.Former(session, functools.partial(_leave, claim))

        return reunion.Opened(joined.session, take)

    def _end_calls(self) -> None:
        for each in lifetime.all_of(self._calls):
            if each.session is not self._session:  # its answers could not come any more
                each.lose()

    def _make(self, key: str, action: Callable[..., Any], *arguments: Any) -> handles.Made:
        self._holdings.check()
        session = self._session
        try:
            with lifetime.inside:
                return handles.Made(session, action(session, *arguments), lambda other: action(other, *arguments))
        except zenoh.ZError as error:
            if session is not self._session:  # replaced meanwhile, and closed
                return self._make(key, action, *arguments)
            raise self._holdings.failure(key, error) from None

    def _settle(self, handle: _Handle) -> _Handle:
        """Return what has just been declared; if its session was replaced meanwhile, declared in the new one."""
        left = handle.move_to(self._session)
        for entity in left:
            declare.quietly(entity.undeclare)
        return handle

    def _peers(self) -> set[str]:
        with lifetime.inside:
            return {str(peer) for peer in self._session.info.peers_zid()}

    def _try(self, key: str, action: Callable[..., Any], *arguments: object) -> Any:
        return self._make(key, action, *arguments).entity


def _leave(claim: port_sharing.PortClaim | None, session: zenoh.Session, entities: list[object]) -> None:
    """Close a session, but wait no longer than CLOSE_WITHIN.

    Each peer takes Zenoh some 5 ms, one that is frozen or does not shake hands 10 s.
    """

    def close() -> None:
        declare.close_session(session)
        if claim:
            claim.release()

    lifetime.finish(close, CLOSE_WITHIN)
    # A daemon thread that is inside Zenoh when the interpreter ends aborts the process: let it come back first.
    deadline = clocks.monotonic() + CLOSE_WITHIN  # from now on: at the exit of Python 3.12 it has just been closed here
    while lifetime.in_use(entities) and clocks.monotonic() < deadline:
        time.sleep(0.001)


def _join(
    domain: int,
    asked: str | None,
    environ: Mapping[str, str],
    secure: Callable[[zenoh.Config], object] | None,
    named: frozenset[str] = frozenset(),
) -> reunion.Joined:
    if "RUST_LOG" in environ:
        show_log: Callable[[], object] = zenoh.try_init_log_from_env
        show_log()
    port = FIRST_PORT + checked_domain(domain)
    found = network.plan(asked, domain, environ, secure)

    def load(holds_port: bool = False) -> zenoh.Config:  # usually nobody looks for it at the rendezvous port
        return addresses.named(found.config(holds_port=holds_port), named)

    try:
        config = load()
        within = reach(config)
        moves = within.leaves_machine
        thinned = found.thinned() if moves else None
        if found.meets and within.listens:  # not if it goes nowhere, its certificate having ended
            joined = _meet(port, lambda holds: zenoh.open(load(True) if holds else config), within)
            network.await_host(joined.session, found)
            return joined._replace(moves=moves, thinned=thinned)
        if wrong := certificates.faults(config):
            raise TransportError(f"cannot join the network '{found.asked.value}': {'; '.join(wrong)}")
        return _listen_beside(load)._replace(moves=moves, thinned=thinned)
    except zenoh.ZError as error:
        reasons = [network.reason(error), *certificates.refusals(found.config(holds_port=False))]
        raise TransportError(f"cannot join the network '{found.asked.value}': {'; '.join(reasons)}") from None


def _listen_beside(load: Callable[[], zenoh.Config]) -> reunion.Joined:
    """Listen on the configured endpoints, or connect to the process of this machine that does so already."""
    taken, refusals = list[str](), list[str]()
    for _ in range(2):  # twice, since another process may come first, or the holder leave in between
        config = load()
        fixed = port_sharing.fixed_listeners(config)
        claim = port_sharing.PortClaim(port_of(fixed[0])) if fixed else None
        taken = [each for each in fixed if (claim and not claim.granted) or port_sharing.is_taken(each)]
        holders = port_sharing.step_aside(config, taken, OFTEN) if taken else []
        with contextlib.ExitStack() as undo:
            if claim:
                undo.callback(claim.release)
            try:
                session = declare.open_session(config)
            except zenoh.ZError:
                if taken or not any(map(port_sharing.is_taken, fixed)):
                    raise
                continue
            if not taken or _linked(session):
                undo.pop_all()
                return reunion.Joined(session, claim, bool(fixed) and not taken)
            lifetime.finish(functools.partial(declare.close_session, session), CLOSE_WITHIN)
            refusals = certificates.refusals(config, holders)
    hint = "; ".join(refusals) or "stop it, or listen elsewhere in this process's configuration"
    where = " and ".join(taken) or "its port"
    raise TransportError(f"{where} is taken, and who listens there has not let this process in: {hint}")


def _meet(port: int, open_session: Callable[[bool], zenoh.Session], within: Reach) -> reunion.Joined:
    """Listen on the rendezvous port, or connect to its holder."""
    for _ in range(2):  # twice, since the holder may leave in between
        claim = port_sharing.PortClaim(port)
        if claim.granted:
            try:
                return reunion.Joined(open_session(True), claim, True)
            except zenoh.ZError:  # taken
                claim.release()
        session = open_session(False)
        if _linked(session):
            return reunion.Joined(session, port_heir.claim_of(claim, port, open_session, within))
        lifetime.finish(functools.partial(declare.close_session, session), CLOSE_WITHIN)
    raise TransportError(refusals.of_holder(port, secured=within.secured))


def _linked(session: zenoh.Session) -> bool:
    deadline = clocks.monotonic() + LINK_WITHIN
    while clocks.monotonic() < deadline:
        if any(str(link.dst)[4:] != ROS_ROUTER[4:] for link in session.info.links()):  # after tcp/ or tls/
            return True
        time.sleep(0.002)
    return False
