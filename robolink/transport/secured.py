"""Sessions with keys and rights: TLS and access control for Zenoh, and a word where something is not allowed.

Zenoh drops what is denied in silence. So the rights are looked at here, before anything is declared.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from typing import Any

from robolink.exceptions import SecurityError, TransportError, WireError
from robolink.logging import get_logger
from robolink.networks.asked import FIRST_PORT, checked_domain
from robolink.qos import QoSProfile
from robolink.security import session
from robolink.security.session import Security
from robolink.transport import certificates, network, permission_watch
from robolink.transport.base import Handle, Outlet, Sample, Sink
from robolink.transport.enclave_keys import Keys
from robolink.transport.roaming import RoamingTransport
from robolink.transport.zenoh import ZenohTransport
from robolink.wire import parse_token


def open_secured(
    domain: int, asked: str | None, environ: Mapping[str, str], enclave: str | None
) -> SecuredTransport | None:
    """Open a session with the security that the environment requests; None if it is to be open to everybody.

    Args:
        domain: ROS domain id.
        asked: Network; None asks the environment.
        environ: Environment.
        enclave: Enclave of `--enclave`; None is `/`.
    """
    checked_domain(domain)
    security = session.wanted(environ, domain, enclave)
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
    return SecuredTransport(security, asked, {**environ, session.OVERRIDE: security.enclave})


class SecuredTransport(RoamingTransport):
    """A session of an enclave, which refuses what the enclave has no right to.

    Args:
        security: Keys and rights.
        asked: Network; None asks the environment.
        environ: Environment, which names the enclave.
    """

    def __init__(self, security: Security, asked: str | None, environ: Mapping[str, str]) -> None:
        self.enclave = security.enclave
        self._keys = Keys(security)
        domain = security.rights.domain
        try:
            super().__init__(functools.partial(ZenohTransport, domain, asked, dict(environ), self._keys.secure), domain)
        except SecurityError:
            raise
        except TransportError as error:
            raise SecurityError(f"{error}{_reasons(domain, asked, environ)}") from None
        permission_watch.watch(self)

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


def _reasons(domain: int, asked: str | None, environ: Mapping[str, str]) -> str:
    """Return why who listens at the rendezvous port refuses this enclave, after a semicolon; '' if he does not."""
    place = f"tls/127.0.0.1:{FIRST_PORT + domain}"
    found = certificates.refusals(network.load(asked, domain, environ, holds_port=False), [place])
    return f"; {found[0]}" if found else ""
