"""Reasons why a process at a port lets nobody in: it asks for keys, or it has none where this side does."""

from __future__ import annotations

import contextlib
import socket

from robolink.networks.port_probe import HOST, listening

WITHIN = 1.0
"""Timeout of an answer, in seconds; it takes a few milliseconds."""

WANTS_KEYS = (
    "which lets nobody in without keys: set ROS_SECURITY_ENABLE=true and ROS_SECURITY_KEYSTORE here, "
    "as they are set there (docs/why/security.md)"
)
HAS_NO_KEYS = (
    "which has no keys, while ROS_SECURITY_ENABLE is true here: end it and start it again with security, "
    "or choose another ROS_DOMAIN_ID"
)


def of_holder(port: int, *, secured: bool) -> str:
    """Return why the holder of a port of this machine has not answered a session, and what to do.

    Args:
        port: The port, on which somebody listens.
        secured: True if the session that got no answer has keys.
    """
    if secured and any(each.speaks_zenoh for each in listening([port], WITHIN).values()):
        return f"port {port} is taken by a process {HAS_NO_KEYS}"
    if not secured and wants_keys(HOST, port):
        return f"port {port} is taken by a process with security, {WANTS_KEYS}"
    return (
        f"port {port} is taken by a program that does not answer as a robolink session does: "
        "go on with it if it was suspended (Ctrl-Z; `fg`), stop it, or choose another ROS_DOMAIN_ID"
    )


def wants_keys(host: str, port: int) -> bool:
    """True if TLS is spoken there, and nobody is let in without a certificate."""
    import ssl

    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_mode = ssl.CERT_NONE  # nothing is sent that anybody might read
    try:
        plain = socket.create_connection((host, port), WITHIN)
        with contextlib.closing(plain), contextlib.closing(context.wrap_socket(plain)) as secured:
            secured.recv(1)  # with TLS 1.3 the refusal comes after the handshake
    except ssl.SSLError as error:
        return "CERTIFICATE_REQUIRED" in (error.reason or "")
    except (OSError, UnicodeError):
        return False
    return False
