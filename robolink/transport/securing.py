"""Security of a session's configuration: mutual TLS and access control, as the environment asks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from robolink.networks.asked import domain_id
from robolink.security import session
from robolink.security.keystore import ROUTER
from robolink.transport.reach import reach

if TYPE_CHECKING:
    import zenoh


def secure(config: zenoh.Config, domain: int, environ: Mapping[str, str]) -> None:
    """Change a session's configuration as the environment asks: see `robolink.security.session.secure`."""
    security = session.wanted(environ, domain)
    if security is not None:
        session.secure(config, security, reach(config).interfaces)


def is_secured(domain: int, environ: Mapping[str, str]) -> bool:
    """True if sessions of this environment have keys; raises SecurityError where they must and cannot."""
    return session.wanted(environ, domain) is not None


def secure_router(config: zenoh.Config, environ: Mapping[str, str]) -> None:
    """Change a router's configuration as the environment asks; its enclave is `/router` unless that names another.

    It passes on what each enclave may send, in the domain of ROS_DOMAIN_ID and in no other.
    """
    named = {session.OVERRIDE: environ.get(session.OVERRIDE) or ROUTER}
    secure(config, domain_id(environ), {**environ, **named})
