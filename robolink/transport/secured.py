"""Sessions with keys and rights: TLS and access control for Zenoh, and a word where something is not allowed.

Zenoh drops what is denied in silence. So the rights are looked at here, before anything is declared.
"""

from __future__ import annotations

import contextlib
import datetime
import functools
import threading
import time
import weakref
from collections.abc import Mapping
from typing import Any, Protocol

from robolink.exceptions import SecurityError, TransportError, WireError
from robolink.logging import get_logger
from robolink.networks.request import FIRST_PORT, checked_domain
from robolink.qos import QoSProfile
from robolink.security import session
from robolink.security.session import AUTHORITY, Security
from robolink.system import clocks
from robolink.transport import certificates, network
from robolink.transport.base import Handle, Outlet, Sample, Sink
from robolink.transport.certificates import Validity
from robolink.transport.roaming import RoamingTransport
from robolink.transport.secure_config import Keys
from robolink.transport.zenoh import ZenohTransport
from robolink.wire import parse_token


def open_secured(
    domain: int, requested: str | None, environ: Mapping[str, str], enclave: str | None
) -> SecuredTransport | None:
    """Open a session with the security that the environment requests; None if it is to be open to everybody.

    Args:
        domain: ROS domain id.
        requested: Network; None asks the environment.
        environ: Environment.
        enclave: Enclave of `--enclave`; None is `/`.
    """
    checked_domain(domain)
    security = session.requested(environ, domain, enclave)
    if not session.is_on(environ):  # False, written otherwise
        return None
    if security is None:
        get_logger("security").warning(
            f"enclave '{environ.get(session.OVERRIDE) or enclave or '/'}' has no keys, and "
            "ROS_SECURITY_STRATEGY is not Enforce: this session is open to everybody"
        )
        return None
    for warning in security.warnings:
        get_logger("security").warning(warning)
    return SecuredTransport(security, requested, {**environ, session.OVERRIDE: security.enclave})


class SecuredTransport(RoamingTransport):
    """A session of an enclave, which refuses what the enclave has no right to.

    Args:
        security: Keys and rights.
        requested: Network; None asks the environment.
        environ: Environment, which names the enclave.
    """

    def __init__(self, security: Security, requested: str | None, environ: Mapping[str, str]) -> None:
        self.enclave = security.enclave
        self._keys = Keys(security)
        domain = security.rights.domain
        try:
            super().__init__(
                functools.partial(ZenohTransport, domain, requested, dict(environ), self._keys.secure), domain
            )
        except SecurityError:
            raise
        except TransportError as error:
            raise SecurityError(f"{error}{_reasons(domain, requested, environ)}") from None
        watch(self)

    def fingerprint(self) -> object:
        """Return something that differs as soon as permissions or keys have changed."""
        return session.fingerprint(self._keys.security)

    def renew(self) -> None:
        """Go on with the permissions and keys that the keystore has now, behind the same handles; takes some seconds.

        Raises SecurityError, and changes nothing, where they allow no session; TransportError where nobody is met.
        """
        self._keys.take(session.read(self._keys.security))
        self.reopen()

    @property
    def validity(self) -> certificates.Validity:
        """Time in which its certificate counts."""
        return self._keys.valid

    def advertise(self, key: str, qos: QoSProfile) -> Outlet:
        """Declare a publisher; raises SecurityError where the enclave may not publish."""
        self._require("publish", key)
        return super().advertise(key, qos)

    def subscribe(self, key: str, qos: QoSProfile, sink: Sink) -> Handle:
        """Declare a subscription; raises SecurityError where the enclave may not hear."""
        self._require("subscribe", key)
        return super().subscribe(key, qos, _named(sink))

    def serve(self, key: str, sink: Sink) -> Handle:
        """Declare a server; raises SecurityError where the enclave may not reply."""
        self._require("reply", key)
        return super().serve(key, _named(sink))

    def call(self, key: str, payload: bytes, attachment: bytes, sink: Sink) -> Handle:
        """Send a request; raises SecurityError where the enclave may not call."""
        self._require("request", key)
        return super().call(key, payload, attachment, sink)

    def announce(self, token: str) -> Handle:
        """Declare a token; raises SecurityError for an endpoint that the enclave may not have, or another's token."""
        if why := self._refused_token(token):
            raise SecurityError(why)
        return super().announce(token)

    def _require(self, kind: str, key: str) -> None:
        if why := self._keys.refusal(kind, key):
            raise SecurityError(why)

    def _refused_token(self, text: str) -> str:
        try:
            token = parse_token(text)
        except WireError:
            return ""  # nobody reads it
        if token.domain != self._keys.security.rights.domain:
            return f"enclave '{self.enclave}' may not announce anything in domain {token.domain}"
        if token.enclave != self.enclave:
            return f"enclave '{self.enclave}' may not announce {token.full_node_name} of enclave '{token.enclave}'"
        kind = getattr(token, "kind", None)
        return self._keys.refusal(session.KINDS[kind], getattr(token, "name", "")) if kind else ""


def _named(sink: Sink) -> Sink:
    """Return a sink that drops what was sent to a key with wildcards.

    Zenoh lets such a key pass where a right with a wildcard includes it, and no denial does: it reaches what is denied.
    """

    def pass_on(arrived: Any) -> None:
        if type(arrived) is Sample or "*" not in str(arrived.key_expr):
            sink(arrived)

    return pass_on


def _reasons(domain: int, requested: str | None, environ: Mapping[str, str]) -> str:
    """Return why who listens at the rendezvous port refuses this enclave, after a semicolon; '' if he does not."""
    place = f"tls/127.0.0.1:{FIRST_PORT + domain}"
    found = certificates.refusals(network.load(requested, domain, environ, holds_port=False), [place])
    return f"; {found[0]}" if found else ""


LOOKS_EVERY = 1.0
"""Interval of the looks at the files, in seconds; a look at 30 enclaves takes 1.3 ms."""

SETTLES = 0.1
"""Time in seconds for which files stay as they are before they count: a key and its certificate are two."""

WARNS_BEFORE = datetime.timedelta(days=30).total_seconds()
"""Time in seconds before the end of a certificate from which on there is a warning; a tenth of a short validity."""


class Renewable(Protocol):
    """A session that can go on with other permissions and keys."""

    enclave: str

    @property
    def has_left(self) -> bool:
        """True once it is closed."""

    @property
    def validity(self) -> Validity:
        """Time in which its certificate counts."""

    def fingerprint(self) -> object:
        """Return something that differs as soon as permissions or keys have changed."""

    def renew(self) -> None:
        """Go on with what the files say now.

        Raises SecurityError for mistakes in the files, and TransportError if nobody is met with them.
        """

    def reopen(self) -> None:
        """Go on in a new session; alone, if the certificate has ended. Raises TransportError."""


def watch(session: Renewable) -> None:
    """Call `session.renew` when its files have changed, on a background thread, for as long as it is open."""
    watched = Watch(session)
    thread = threading.Thread(target=watched.run, name="robolink permissions", daemon=True)
    with contextlib.suppress(RuntimeError):  # Python 3.12 starts no threads any more at exit
        thread.start()


class Watch:
    """The looks at the files of one session, which it does not keep alive.

    Zenoh reads its rules and keys once. So a session whose keystore has changed goes on in a new one, behind the same
    handles: who was withdrawn is out, whose turn it is may go on, and a renewed certificate is in use before the old
    one ends. A session whose certificate has ended goes on alone, since it would keep others from the port that it
    holds.
    """

    def __init__(self, session: Renewable) -> None:
        self._session = weakref.ref(session)
        self._seen = session.fingerprint()
        self._reported = ""
        self._warned_of: Validity | None = None
        self._has_ended = False

    def run(self) -> None:
        """Look until the session is closed, or nobody has it any more."""
        while self.look():
            time.sleep(LOOKS_EVERY)

    def look(self) -> bool:
        """Look once, and renew the session if its files have changed; return False once it is closed."""
        session = self._session()
        if session is None or session.has_left:
            return False
        with contextlib.suppress(OSError):  # files that come and go just now: the next look sees them
            now = session.fingerprint()
            if now != self._seen:
                while now != (now := _later(session)):
                    pass
                if self._renew(session):
                    self._seen = now  # else who was withdrawn would stay in for good: the next look tries again
        self._judge(session)
        return True

    def _renew(self, session: Renewable) -> bool:
        """Renew a session; return whether it could be. Why it cannot be is told once."""
        logger = get_logger("security")
        try:
            session.renew()
        except TransportError as error:
            if (why := str(error)) != self._reported and not session.has_left:
                logger.error(f"permissions or keys have changed, and do not count yet: {why}")
            self._reported = why
            return False
        self._reported, self._has_ended = "", clocks.time_of_day() >= session.validity.end
        logger.info(f"enclave '{session.enclave}': permissions or keys have changed, and count from now on")
        return True

    def _judge(self, session: Renewable) -> None:
        """Warn some time before the end of the certificate, and take the session out of the others' way after it."""
        valid, now = session.validity, clocks.time_of_day()
        has_ended = now >= valid.end
        if has_ended != self._has_ended:
            self._has_ended = has_ended
            if has_ended:
                get_logger("security").error(
                    f"{_of(session)} has ended, and nobody lets it in any more: {_remedy(session)}"
                )
            with contextlib.suppress(TransportError):  # a host that does not answer: nobody is in its way
                session.reopen()
        elif valid != self._warned_of and now >= valid.end - min(WARNS_BEFORE, (valid.end - valid.begin) / 10):
            self._warned_of = valid
            get_logger("security").warning(f"{_of(session)} ends at {_spelled(valid.end)}: {_remedy(session)}")


def _later(session: Renewable) -> object:
    time.sleep(SETTLES)
    return session.fingerprint()


def _of(session: Renewable) -> str:
    return f"enclave '{session.enclave}': {session.validity.file}"


def _remedy(session: Renewable) -> str:
    if session.validity.file.endswith(AUTHORITY):
        return "make a new keystore"
    return f"'robolink security create_enclave KEYSTORE {session.enclave} --renew', and no restart is needed"


def _spelled(when: float) -> str:
    return f"{datetime.datetime.fromtimestamp(when, datetime.timezone.utc):%Y-%m-%d %H:%M:%S} UTC"
