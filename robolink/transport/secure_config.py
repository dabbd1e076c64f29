"""Security of a session's configuration: mutual TLS and access control, and the keys and rights of the present."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from robolink.exceptions import SecurityError
from robolink.logging import get_logger
from robolink.networks.request import domain_id
from robolink.security import session
from robolink.security.keystore import CERTIFICATE, KEY, ROUTER
from robolink.security.session import Security
from robolink.system import clocks
from robolink.transport import certificates
from robolink.transport.reach import reach

if TYPE_CHECKING:
    import zenoh

_NOWHERE = {
    "listen/endpoints": "[]",
    "connect/endpoints": "[]",
    "scouting/multicast/enabled": "false",
    "mode": '"peer"',
}


def secure(security: Security, config: zenoh.Config) -> None:
    """Change a session's configuration by its keys and rights: see `robolink.security.session.secure`."""
    session.secure(config, security, reach(config).interfaces)


def isolate(config: zenoh.Config) -> None:
    """Change a session's configuration so that it neither listens nor goes anywhere."""
    for path, value in _NOWHERE.items():
        config.insert_json5(path, value)


def secure_as(domain: int, environ: Mapping[str, str]) -> Callable[[zenoh.Config], None] | None:
    """Return the function that changes a session's configuration as the environment asks; None where it asks nothing.

    Args:
        domain: Domain of the session.
        environ: Environment, which names the enclave.

    Raises:
        SecurityError: where the session must have keys and cannot.
    """
    security = session.requested(environ, domain)
    return None if security is None else functools.partial(secure, security)


def router_security(environ: Mapping[str, str]) -> Security | None:
    """Return the security of a router; None where the environment asks for none, or has no keys and is Permissive.

    Its enclave is `/router` unless the environment names another. It passes on what each enclave may send, in the
    domain of ROS_DOMAIN_ID and in no other. Raises SecurityError where it must have keys and cannot.
    """
    security = session.requested(environ, domain_id(environ), ROUTER)
    if security is None and session.is_on(environ):
        get_logger("security").warning(
            f"enclave '{environ.get(session.OVERRIDE) or ROUTER}' has no keys, and "
            "ROS_SECURITY_STRATEGY is not Enforce: this router is open to everybody"
        )
    for warning in security.warnings if security else ():
        get_logger("security").warning(warning)
    return security


class Keys:
    """Keys and rights of a session. They do not refer to it, so that it is freed when nobody holds it.

    Raises SecurityError where nobody would let a session with these keys in.
    """

    def __init__(self, security: Security) -> None:
        self.take(security)

    def take(self, security: Security) -> None:
        """Use others from now on; raises SecurityError, and changes nothing, where nobody would let a session in."""
        files = (str(security.folder / each) for each in (CERTIFICATE, KEY, session.AUTHORITY))
        try:
            self.valid = certificates.validity_of(*files)
        except SecurityError as error:
            raise SecurityError(f"enclave '{security.enclave}': {error}") from None
        self.security = security
        self.refusal = functools.lru_cache(maxsize=1024)(security.rights.refusal)

    def secure(self, config: zenoh.Config) -> None:
        """Close a configuration to whoever has no keys, and to everybody once the certificate has ended."""
        secure(self.security, config)
        if clocks.time_of_day() >= self.valid.end:
            isolate(config)
