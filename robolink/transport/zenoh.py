"""A network between processes and machines: Eclipse Zenoh as rmw_zenoh uses it.

No Python frame runs on Zenoh's threads for data: what they call is a `functools.partial` around the sink, and the
sink is meant to be C as well. Raw samples wait in queues until `read` turns them into bytes.
"""

from __future__ import annotations

import contextlib
import functools
import os
import queue
import sys
import time
import weakref
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import zenoh

from robolink.exceptions import TransportError
from robolink.qos import DurabilityPolicy, QoSProfile, resolved
from robolink.queues import get_within
from robolink.transport import beside, certificates, lifetime, network
from robolink.transport import zenoh_declare as declare
from robolink.transport import zenoh_handles as handles
from robolink.transport.base import Handle, Outlet, Query, Sample, Sink, Transport, make_sample, refuse_giant
from robolink.transport.reach import Link, port_of

QUIET = 0.03
"""Seconds without news after which no more peers are expected."""

PATIENCE = 0.5
"""Seconds without any news after which peers that have not answered are taken for frozen."""

LONGEST = 3.0
"""Seconds in which even a busy machine's peers have told what they announce."""

CLOSE_WITHIN = 0.15
"""Seconds that closing may take before it goes on in the background."""

LINK_WITHIN = 3.0
"""Seconds in which whoever holds the rendezvous port has to answer; it takes 2 ms, and 1 s on a very busy machine."""

REUNION = network.SOUGHT_EVERY + 0.05
"""Seconds in which those that are left of an earlier holder of the rendezvous port find the new one."""

_ZenohSample = zenoh.Sample


class ZenohTransport(Transport):
    """A session on a Zenoh network: this machine's, or what `network` or the environment asks for.

    See `robolink.transport.network.wanted`. Raises TransportError when there is no joining it.
    """

    threaded = True

    def __init__(self, domain: int = 0, network: str | None = None, environ: Mapping[str, str] | None = None) -> None:
        self.url = "zenoh://"
        lifetime.refuse_if_forked()
        self._holdings = handles.Holdings()
        self._ends: weakref.WeakSet[Sink] = weakref.WeakSet()
        self._has_left = False
        with lifetime.inside:
            self._session, self._claim, holds_port = _join(domain, network, os.environ if environ is None else environ)
            self._met_at = time.monotonic() + (REUNION if holds_port else 0.0)
            self.session_id = str(self._session.info.zid())
            lifetime.watch_over(self)

    def advertise(self, key: str, qos: QoSProfile) -> Outlet:
        """Declare a publisher. With TRANSIENT_LOCAL it keeps the last `qos.depth` samples for late joiners."""
        publishers = self._try(key, declare.declare_publishers, key, resolved(qos))
        return handles.ZenohOutlet(self._holdings, key, publishers)

    def subscribe(self, key: str, qos: QoSProfile, sink: Sink) -> Handle:
        """Call `sink` for every sample published on `key`; with TRANSIENT_LOCAL what was kept comes first."""
        gate = declare.make_gate(sink)
        subscriber = self._try(key, declare.declare_subscriber, key, gate, resolved(qos))
        latched = qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
        topic = None if latched else self._holdings.topic(key)
        return handles.ZenohSubscription(self._holdings, subscriber, gate, topic)

    def serve(self, key: str, sink: Sink) -> Handle:
        """Call `sink` for every call on `key`; `accept` turns what it gets into a Query."""
        gate = declare.make_gate(sink)
        return handles.Declared(self._holdings, self._try(key, declare.declare_server, key, gate), gate)

    def call(self, key: str, payload: bytes, attachment: bytes, sink: Sink) -> Handle:
        """Ask whoever serves `key`. `sink` gets each reply, then None once: no more will come."""
        refuse_giant(key, payload)
        gate, end = declare.make_gate(sink), declare.make_gate(sink, None)
        self._ends.add(end)
        cancel = self._try(key, declare.call, key, payload, attachment, gate, end)
        return handles.ZenohCall(cancel, gate, end)

    def announce(self, token: str) -> Handle:
        """Show `token` to all who watch, until closed or until this process is gone."""
        return handles.Declared(self._holdings, self._try(token, declare.declare_token, token))

    def watch(self, pattern: str, on_change: Callable[[str, bool], object]) -> Handle:
        """Call `on_change(token, alive)` for each token that matches `pattern`, on a thread of its own."""
        changes = handles.Changes(on_change)
        subscriber = self._try(pattern, declare.declare_watch, pattern, changes)
        return handles.ZenohWatch(self._holdings, subscriber, changes)

    def tokens(self, pattern: str) -> list[str]:
        """List the tokens that match `pattern`, sorted: also those of peers that this session only just found.

        A session that has just taken the rendezvous port waits for those that may still be there without one.
        """
        time.sleep(max(0.0, self._met_at - time.monotonic()))
        arrived: queue.SimpleQueue[Any] = queue.SimpleQueue()
        subscriber = self._try(pattern, declare.declare_look, pattern, arrived.put)
        try:
            return sorted(_settled(arrived, functools.partial(self._try, pattern, declare.ask, pattern), self._peers))
        finally:
            declare.quietly(subscriber.undeclare)

    def links(self) -> list[Link]:
        """List the connections to other sessions."""
        with lifetime.inside:
            info = self._session.info
            roles = {str(each.zid): str(each.whatami) for each in info.transports()}
            found = [(str(each.zid), str(each.src), str(each.dst)) for each in info.links()]
        return [Link(roles.get(session, "peer"), here, there, session) for session, here, there in found]

    def read(self, arrived: Any) -> Sample:
        """Turn what a subscription's or a call's sink got into bytes. Raises TransportError on an error reply."""
        kind = type(arrived)
        if kind is _ZenohSample:  # the usual case first, and without calls: this is run once a message
            attachment = arrived.attachment
            return make_sample((arrived.payload.to_bytes(), b"" if attachment is None else attachment.to_bytes()))
        if kind is Sample:
            own: Sample = arrived
            return own
        return handles.content_of_reply(arrived)

    def size(self, arrived: Any) -> int:
        """Tell how many bytes the payload of what a subscription's sink got has, without copying them."""
        return len(arrived.payload)

    def accept(self, arrived: Any) -> Query:
        """Turn what a server's sink got into a Query."""
        return handles.ZenohQuery(arrived)

    def close(self) -> None:
        """Undeclare everything and leave the network; calls under way end. Safe to call twice."""
        if self._has_left:
            return
        if lifetime.is_ending():  # whoever waits ends as well, and shall not complain that nobody answers
            for end in lifetime.all_of(self._ends):
                declare.close_gate(end)
        why = f"session {self.session_id} has been closed"
        with self._holdings.lock:
            declared = self._holdings.end(why)
        _leave(self._session, self._claim, [entity for handle in declared for entity in handle.shut(why)])
        self._has_left = True  # so late: a Ctrl-C that breaks into this must not keep the exit from doing it
        lifetime.forget(self)

    def disown(self) -> None:
        """Refuse every further use in a forked child."""
        self._has_left = True
        for handle in self._holdings.end(lifetime.AFTER_FORK):  # not locked: whoever holds the lock may be gone
            handle.disown(lifetime.AFTER_FORK)
        lifetime.bury(self._session)

    def _peers(self) -> set[str]:
        with lifetime.inside:
            return {str(peer) for peer in self._session.info.peers_zid()}

    def _try(self, key: str, action: Callable[..., Any], *arguments: object) -> Any:
        self._holdings.check()
        try:
            with lifetime.inside:
                return action(self._session, *arguments)
        except zenoh.ZError as error:
            raise self._holdings.failure(key, error) from None


def _leave(session: zenoh.Session, claim: network.PortClaim | None, entities: list[object]) -> None:
    """Close it, but wait no longer than a moment.

    Each peer takes Zenoh some 5 ms, one that is frozen or does not shake hands 10 s.
    """

    def close() -> None:
        _close(session)
        if claim:
            claim.release()

    lifetime.finish(close, CLOSE_WITHIN)
    # A daemon thread that is inside Zenoh when the interpreter ends aborts the process: let it come back first.
    deadline = time.monotonic() + CLOSE_WITHIN  # from now on: at the exit of Python 3.12 it has just been closed here
    while _in_use(entities) and time.monotonic() < deadline:
        time.sleep(0.001)


def _close(session: Any) -> None:
    with contextlib.suppress(zenoh.ZError, RuntimeError):  # as in `declare.quietly`, but the exit does begin it
        session.close()


def _in_use(entities: list[object]) -> bool:
    """Tell whether some thread is just inside a method of one of them, which nobody else refers to."""
    (idle,) = (sys.getrefcount(each) for each in [object()])
    return any(sys.getrefcount(each) > idle for each in entities)


def _settled(
    arrived: queue.SimpleQueue[Any], ask: Callable[[Callable[[], object], float], object], peers: Callable[[], set[str]]
) -> set[str]:
    """Collect tokens until all peers have told theirs and no more peers turn up."""
    changes, known = handles.Changes(lambda token, alive: None), set[str]()
    begin = news = time.monotonic()

    def left() -> float:
        return min(news + PATIENCE, begin + LONGEST) - time.monotonic()

    def collect(quiet: float) -> None:
        """Take what comes, until the peers have answered or nothing has come for so long."""
        nonlocal news
        while (longest := min(left(), quiet)) > 0:
            try:
                sample = get_within(arrived, longest)
            except queue.Empty:
                return
            if sample is None:
                return
            news = time.monotonic()
            changes(sample)

    was_quiet = False
    while left() > 0:
        before = peers()
        if not before <= known:
            news, known = time.monotonic(), known | before
        # Silence alone proves nothing: a busy peer is silent too. Its answer comes after all its tokens.
        ask(functools.partial(arrived.put, None), LONGEST)
        collect(LONGEST)
        if was_quiet and peers() == before:
            break
        collect(max(QUIET, (time.monotonic() - begin) / 2))  # what has taken long so far may have longer gaps
        was_quiet = True
    return changes.alive


class _Joined(NamedTuple):
    session: zenoh.Session
    claim: network.PortClaim | None = None
    holds_port: bool = False


def _join(domain: int, asked: str | None, environ: Mapping[str, str]) -> _Joined:
    if "RUST_LOG" in environ:
        show_log: Callable[[], object] = zenoh.try_init_log_from_env
        show_log()
    port = network.FIRST_PORT + network.checked_domain(domain)
    value = network.wanted(asked, environ).value
    load = functools.partial(network.load, asked, domain, environ)
    try:
        if network.meets_at_port(value, environ):
            return _meet(port, lambda holds_port: zenoh.open(load(holds_port=holds_port)))
        config = load(holds_port=False)  # nobody looks for it at the rendezvous port
        if wrong := certificates.faults(config):
            raise TransportError(f"cannot join the network '{value}': {'; '.join(wrong)}")
        return _listen_beside(functools.partial(load, holds_port=False))
    except zenoh.ZError as error:
        reasons = [network.reason(error), *certificates.refusals(load(holds_port=False))]
        raise TransportError(f"cannot join the network '{value}': {'; '.join(reasons)}") from None


def _listen_beside(load: Callable[[], zenoh.Config]) -> _Joined:
    """Listen where a configuration says, or join the process of this machine that does so already."""
    taken, refusals = list[str](), list[str]()
    for _ in range(2):  # twice, since another process may come first, or the holder leave in between
        config = load()
        fixed = beside.fixed_listeners(config)
        claim = network.PortClaim(port_of(fixed[0])) if fixed else None
        taken = [each for each in fixed if (claim and not claim.granted) or beside.is_taken(each)]
        holders = beside.step_aside(config, taken, network.OFTEN) if taken else []
        with contextlib.ExitStack() as undo:
            if claim:
                undo.callback(claim.release)
            try:
                session = zenoh.open(config)
            except zenoh.ZError:
                if taken or not any(map(beside.is_taken, fixed)):
                    raise
                continue
            if not taken or _linked(session):
                undo.pop_all()
                return _Joined(session, claim, bool(fixed) and not taken)
            lifetime.finish(functools.partial(_close, session), CLOSE_WITHIN)
            refusals = certificates.refusals(config, holders)
    hint = "; ".join(refusals) or "stop it, or listen elsewhere in this process's configuration"
    where = " and ".join(taken) or "its port"
    raise TransportError(f"{where} is taken, and who listens there has not let this process in: {hint}")


def _meet(port: int, open_session: Callable[[bool], zenoh.Session]) -> _Joined:
    """Hold the rendezvous port, or meet whoever does."""
    for _ in range(2):  # twice, since the holder may leave in between
        claim = network.PortClaim(port)
        if claim.granted:
            try:
                return _Joined(open_session(True), claim, True)
            except zenoh.ZError:  # taken
                claim.release()
        session = open_session(False)
        if _linked(session):
            return _Joined(session, claim)
        lifetime.finish(functools.partial(_close, session), CLOSE_WITHIN)
    raise TransportError(
        f"port {port} is taken by a program that does not answer as a robolink session does: "
        "go on with it if it was suspended (Ctrl-Z; `fg`), stop it, or choose another ROS_DOMAIN_ID"
    )


def _linked(session: zenoh.Session) -> bool:
    deadline = time.monotonic() + LINK_WITHIN
    while time.monotonic() < deadline:
        if any(str(link.dst) != network.ROS_ROUTER for link in session.info.links()):
            return True
        time.sleep(0.002)
    return False
