"""Router: the installed Zenoh in router mode, for those who have none, ROS 2 nodes included."""

from __future__ import annotations

import contextlib
import functools
import json
import os
import time
from collections.abc import Iterable, Iterator, Sequence

import zenoh

from robolink.exceptions import TransportError
from robolink.networks import hosts, limits
from robolink.networks.request import domain_id
from robolink.networks.router import router_settings
from robolink.security import session
from robolink.security.session import Security
from robolink.system import clocks
from robolink.transport import lifetime, secure_config, secured
from robolink.transport import zenoh_declare as declare
from robolink.transport.certificates import Validity
from robolink.transport.network import reason
from robolink.transport.port_sharing import PortClaim, is_taken
from robolink.transport.reach import Link, address_of, links_of, port_of, reach
from robolink.transport.secure_config import Keys

CLOSE_WITHIN = 0.5
"""Longest `close`, in seconds; then it goes on in the background, for 10 s if a handshake is not answered."""

REOPENS_WITHIN, REOPENS_EVERY = 10.0, 0.05
"""Longest wait for the own ports to be free again, and interval of the attempts to listen there, in seconds."""


class Router:
    """A running router; made by `running`.

    Args:
        listen: Zenoh's endpoints on which it listens.
        connect: Those to which it connects.
        security: Keys and rights; None for a router without.

    Raises:
        SecurityError: where nobody would let a router with these keys in.
    """

    def __init__(self, listen: Sequence[str], connect: Sequence[str], security: Security | None) -> None:
        self._endpoints = listen, connect
        self._keys = Keys(security) if security else None
        self.enclave = security.enclave if security else ""
        """Its enclave; '' without security."""
        self._reach = reach(self._config())
        self._sessions: list[zenoh.Session] = []
        self.has_left = False
        self._watch = secured.Watch(self) if security else None
        lifetime.watch_over(self)

    @property
    def listens(self) -> Sequence[str]:
        """Endpoints on which it listens: those of TLS, if it has keys."""
        return self._reach.listens

    @property
    def connects(self) -> Sequence[str]:
        """Endpoints to which it connects."""
        return self._reach.connects

    def open(self) -> None:
        """Open its session; raises ZError. A Ctrl-C meanwhile must not free it, since closing may take 10 s."""
        self._sessions.extend(map(zenoh.open, [self._config()]))  # one step of C

    def links(self) -> list[Link]:
        """Return the connections to others; none while its session could not be opened again."""
        return [] if self._sessions[-1].is_closed() else links_of(self._sessions[-1])

    def close(self) -> None:
        """Leave the network. Safe to call twice."""
        self.has_left = True
        self._close_sessions()
        lifetime.forget(self)

    def follow(self) -> None:
        """Go on with the permissions and keys of the files, if they have changed: every link is made anew then."""
        if self._watch:
            self._watch.look()

    def fingerprint(self) -> object:
        """Return something that differs as soon as permissions or keys have changed."""
        return session.fingerprint(self._secured.security)

    @property
    def validity(self) -> Validity:
        """Time in which its certificate counts."""
        return self._secured.valid

    def renew(self) -> None:
        """Go on with the permissions and keys that the keystore has now.

        Raises SecurityError, and changes nothing, where they allow no router; TransportError as `reopen` does.
        """
        self._secured.take(session.read(self._secured.security))
        self.reopen()

    def reopen(self) -> None:
        """Go on in a new session at the same ports; raises TransportError where they are not free in time."""
        self._close_sessions()
        deadline = clocks.monotonic() + REOPENS_WITHIN
        while True:
            try:
                self.open()
                del self._sessions[:-1]
                return
            except zenoh.ZError as error:
                if clocks.monotonic() > deadline:
                    raise TransportError(f"cannot listen at {' and '.join(self.listens)}: {reason(error)}") from None
            time.sleep(REOPENS_EVERY)

    @property
    def _secured(self) -> Keys:
        assert self._keys, "only a router with keys is watched"
        return self._keys

    def _close_sessions(self) -> None:
        for each in self._sessions:
            lifetime.finish(functools.partial(declare.close_session, each), CLOSE_WITHIN)

    def disown(self) -> None:
        """Refuse every further use in a forked child."""
        lifetime.leak(self._sessions)

    def faults(self) -> list[str]:
        """Return a line for each router to connect to that it is not linked to; each takes a second at most."""
        return faults(self.connects, str(self._sessions[-1].info.zid()), self.links())

    def _config(self) -> zenoh.Config:
        config: zenoh.Config = zenoh.Config.from_json5(json.dumps(router_settings(*self._endpoints)))
        if limited := limits.requested(os.environ):
            limits.apply(config, limited, domain_id(os.environ))
        if self._keys:
            self._keys.secure(config)
        return config


@contextlib.contextmanager
def running(listen: Sequence[str], connect: Sequence[str]) -> Iterator[Router]:
    """Run a router while a `with` lasts.

    Args:
        listen: Zenoh's endpoints on which it listens.
        connect: Those to which it connects, and goes on trying to.

    Raises:
        TransportError: if a port is taken, or if it cannot listen there; SecurityError if the environment asks for
            security, and keys are missing.
    """
    router = Router(listen, connect, secure_config.router_security(os.environ))
    with contextlib.ExitStack() as stack:
        for each in listen:
            claim = PortClaim(port_of(each))
            stack.callback(claim.release)
            if not claim.granted or is_taken(each):
                raise TransportError(
                    f"{each} is taken, perhaps by another router ('robolink doctor' says by whom): "
                    "stop that one, use it, or choose another port with --listen HOST:PORT"
                )
        stack.callback(router.close)
        try:
            router.open()
        except zenoh.ZError as error:
            raise TransportError(f"cannot listen at {' and '.join(listen)}: {reason(error)}") from None
        yield router


WITHIN = 1.0
"""Timeout of the answer of each of them, in seconds."""

_TRIED = "it is tried again and again"


def faults(connects: Sequence[str], own: str, links: Iterable[Link]) -> list[str]:
    """Return a line for each endpoint that has brought no link; none if all is well. It takes a second for each.

    Args:
        connects: Zenoh's endpoints to which a router connects.
        own: Its session id.
        links: Its connections.
    """
    linked = list(links)
    known: dict[str, str] = {}
    texts = ((each, _fault(each, own, linked, known)) for each in connects)
    return [f"{endpoint}: {text}" for endpoint, text in texts if text]


def _fault(endpoint: str, own: str, links: list[Link], known: dict[str, str]) -> str:
    """Return the fault of one endpoint, '' if there is none; `known` has the endpoints of the sessions met so far."""
    protocol, _, rest = address_of(endpoint).partition("/")
    host = hosts.parse(rest)
    if protocol != "tcp" or host is None:  # whose greeting cannot be read
        met = any(each.there.startswith(f"{protocol}/") and port_of(each.there) == port_of(endpoint) for each in links)
        return "" if met else f"nobody there has let this router in: is one on, with keys of this authority? {_TRIED}"
    try:
        port = hosts.seek(host, 0, WITHIN, WITHIN)
    except hosts.UnknownHostError:
        return f"no machine of this name is known; {_TRIED}"
    if port is None:
        return f"nobody answers there; {_TRIED}"
    if not port.speaks_zenoh:
        return f"what listens there does not answer as a router does; {_TRIED}"
    if port.session == own:
        return "that is this router itself: name another one's address"
    if port.session in known:
        return (
            f"is {known[port.session]} once more, by its id {port.session[:8]}: one of the two is enough; "
            "if they are two routers, give each an id of its own"
        )
    known[port.session] = endpoint
    return "" if any(each.session == port.session for each in links) else f"a {port.role} answers, but is not linked"
