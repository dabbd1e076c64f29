"""Joining a Zenoh network: how a session is opened, by whom the rendezvous port is held, and how it is left again."""

from __future__ import annotations

import contextlib
import functools
import threading
import time
import weakref
from collections.abc import Callable, Mapping
from typing import NamedTuple

import zenoh

from robolink.exceptions import TransportError
from robolink.networks.request import FIRST_PORT, OVERRIDE, ROS_ROUTER, checked_domain
from robolink.networks.settings import OFTEN
from robolink.system import clocks
from robolink.transport import lifetime, network, port_sharing
from robolink.transport import zenoh_declare as declare
from robolink.transport.port_sharing import PortClaim, is_taken
from robolink.transport.reach import Reach, port_of, reach
from robolink.transport.zenoh_declare import close_session

CLOSE_WITHIN = 0.15
"""Longest `leave`, in seconds; then it goes on in the background."""

LINK_WITHIN = 3.0
"""Timeout of the rendezvous port's holder, in seconds; it takes 2 ms, and 1 s on a very busy machine."""


class Joined(NamedTuple):
    """A session that has joined a network."""

    session: zenoh.Session
    claim: port_sharing.PortClaim | None = None
    holds_port: bool = False
    leaves_machine: bool = False
    """True if others may be met on other machines, at addresses that change."""
    has_own_settings: bool = False
    """True if no keys, and no access control of the user's, name what may be declared."""
    thinned: list[str] | None = None
    """Key expressions of the topics of which nothing is sent again after a cut; None if nothing at all is."""


def join(
    domain: int,
    requested: str | None,
    environ: Mapping[str, str],
    secure: Callable[[zenoh.Config], object] | None,
    named: frozenset[str] = frozenset(),
) -> Joined:
    """Open a session on a network; raises TransportError when there is no joining it.

    Args:
        domain: ROS domain id.
        requested: Network, as in `robolink.networks.request.requested`; None is the one that the environment requests.
        environ: Environment.
        secure: Function that closes a configuration to whoever has no keys; None does as the environment says.
        named: Addresses at which the session is to be found; none for those that Zenoh knows.
    """
    if "RUST_LOG" in environ:
        show_log: Callable[[], object] = zenoh.try_init_log_from_env
        show_log()
    port = FIRST_PORT + checked_domain(domain)
    found = network.plan(requested, domain, environ, secure)

    def load(holds_port: bool = False) -> zenoh.Config:  # usually nobody looks for it at the rendezvous port
        config = found.config(holds_port=holds_port)
        if not named:
            return config
        from robolink.transport import addresses  # late, as all that few sessions need: sockets take 3 ms to import

        return addresses.named(config, named)

    try:
        config = load()
        within = reach(config)
        thinned = found.thinned() if within.leaves_machine else None
        if found.meets and within.listens:  # not if it goes nowhere, its certificate having ended
            joined = _meet(port, lambda holds: zenoh.open(load(True) if holds else config), within)
            network.await_host(joined.session, found)
            has_own = found.secure is None and not environ.get(OVERRIDE)
            return joined._replace(leaves_machine=within.leaves_machine, thinned=thinned, has_own_settings=has_own)
        from robolink.transport import certificates

        if wrong := certificates.faults(config):
            raise TransportError(f"cannot join the network '{found.request.value}': {'; '.join(wrong)}")
        return _listen_beside(load)._replace(leaves_machine=within.leaves_machine, thinned=thinned)
    except zenoh.ZError as error:
        from robolink.transport import certificates

        reasons = [network.reason(error), *certificates.refusals(found.config(holds_port=False))]
        raise TransportError(f"cannot join the network '{found.request.value}': {'; '.join(reasons)}") from None


def _listen_beside(load: Callable[[], zenoh.Config]) -> Joined:
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
                return Joined(session, claim, bool(fixed) and not taken)
            lifetime.finish(functools.partial(declare.close_session, session), CLOSE_WITHIN)
            from robolink.transport import certificates

            refusals = certificates.refusals(config, holders)
    hint = "; ".join(refusals) or "stop it, or listen elsewhere in this process's configuration"
    where = " and ".join(taken) or "its port"
    raise TransportError(f"{where} is taken, and who listens there has not let this process in: {hint}")


def _meet(port: int, open_session: Callable[[bool], zenoh.Session], within: Reach) -> Joined:
    """Listen on the rendezvous port, or connect to its holder."""
    for _ in range(2):  # twice, since the holder may leave in between
        claim = port_sharing.PortClaim(port)
        if claim.granted:
            try:
                return Joined(open_session(True), claim, True)
            except zenoh.ZError:  # taken
                claim.release()
        session = open_session(False)
        if _linked(session):
            return Joined(session, claim_of(claim, port, open_session, within))
        lifetime.finish(functools.partial(declare.close_session, session), CLOSE_WITHIN)
    from robolink.networks import refusals

    raise TransportError(refusals.of_holder(port, secured=within.secured))


def _linked(session: zenoh.Session) -> bool:
    deadline = clocks.monotonic() + LINK_WITHIN
    while clocks.monotonic() < deadline:
        if any(str(link.dst)[4:] != ROS_ROUTER[4:] for link in session.info.links()):  # after tcp/ or tls/
            return True
        time.sleep(0.002)
    return False


def leave(claim: port_sharing.PortClaim | None, session: zenoh.Session, entities: list[object]) -> None:
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


LOOKS_EVERY = 0.5
"""Interval of the looks, in seconds. Two of them must find the port free: a system that ends is gone then."""


def claim_of(claim: PortClaim, port: int, open_session: Callable[[bool], zenoh.Session], within: Reach) -> PortClaim:
    """Return the claim of a session that does not hold the port of its domain: an heir's, if others may come there.

    None with security: permissions that change would not reach the second session.

    Args:
        claim: The session's own.
        port: The port.
        open_session: Function that opens a session, with True one that listens at the port, or raises ZError.
        within: Reach of the session.
    """
    return Heir(port, open_session) if within.multicast and not within.secured else claim


class Heir(PortClaim):
    """Claim of the rendezvous port while another process holds it: granted when that one has ended.

    Who names this machine from elsewhere knows no other port. A session of Zenoh's listens on nothing that it did not
    begin with, so a second one is opened, which declares nothing: it tells newcomers of all others, by gossip.
    """

    def __init__(self, port: int, open_session: Callable[[bool], zenoh.Session]) -> None:
        self._port, self._open_session = port, open_session
        self._claim: PortClaim | None = None
        self._sessions: list[zenoh.Session] = []
        self._lock, self._is_over = threading.Lock(), False
        self.granted = False
        lifetime.watch_over(self)
        with contextlib.suppress(RuntimeError):  # Python 3.12 starts no threads any more at exit
            threading.Thread(target=_watch, args=(port, weakref.ref(self)), name="robolink port", daemon=True).start()

    @property
    def waits(self) -> bool:
        """True while the port may come to it."""
        return not self.granted and not self._is_over

    def take(self) -> None:
        """Listen on the port, unless another heir was faster."""
        with self._lock:
            claim = PortClaim(self._port)
            if not claim.granted or not self.waits:
                return
            try:
                with lifetime.inside:
                    self._sessions.append(self._open_session(True))
            except zenoh.ZError:
                claim.release()
            else:
                self._claim, self.granted = claim, True

    def release(self) -> None:
        """Leave the port. Safe to call twice."""
        with self._lock:
            self._is_over = True
            while self._sessions:
                close_session(self._sessions.pop())
            if self._claim:
                self._claim.release()
        lifetime.forget(self)

    def close(self) -> None:
        """Leave the port, in the background if it takes long."""
        lifetime.finish(self.release, CLOSE_WITHIN)

    def disown(self) -> None:
        """Refuse every further use in a forked child."""
        self._is_over = True
        lifetime.leak(self._sessions)


def _watch(port: int, of: weakref.ref[Heir]) -> None:
    was_free = False
    while (heir := of()) is not None and heir.waits:
        is_free = not is_taken(f"tcp/0.0.0.0:{port}")
        if is_free and was_free:
            heir.take()
        was_free = is_free
        del heir  # not kept alive while this sleeps
        time.sleep(LOOKS_EVERY)
