"""Settings of a router, as rmw_zenoh's own has them, so that ROS 2 nodes use it as well."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from robolink.constants import LARGEST_MESSAGE
from robolink.exceptions import TransportError
from robolink.networks import hosts
from robolink.networks.request import ROUTER_PORT
from robolink.networks.settings import LEASE_MS, MOST_PENDING, RETRY, most_pending

EVERYWHERE = ("0.0.0.0", "::")
"""Addresses that stand for all of this machine's."""

_WORDS = {"localhost": "127.0.0.1", "lan": "0.0.0.0", "subnet": "0.0.0.0", "off": ""}
_PROTOCOLS = ("tcp/", "quic/", "ws/")
_FOR_ROS_MS = 60_000
_QUERIES_MS = 600_000
"""Timeout of calls that name none: rmw_zenoh's, since a service may take long while everything starts."""


def endpoint_of(text: str, option: str) -> str:
    """Return Zenoh's endpoint for HOST[:PORT], tls/HOST[:PORT], `localhost` or `lan` (all of this machine's addresses).

    Raises TransportError, which names the `option`, for anything else; an endpoint of Zenoh's stays as it is.

    >>> endpoint_of("lan", "--listen"), endpoint_of("robot:8000", "--connect")
    ('tcp/0.0.0.0:7447', 'tcp/robot:8000')
    """
    if text.startswith(_PROTOCOLS) and hosts.parse(text.partition("/")[2]) is not None:
        host = hosts.parse(text.partition("/")[2])
        if host and host.port:
            return text
    host = hosts.parse(_WORDS.get(text, text))
    if host is None:
        raise TransportError(f"{option}: '{text[:80]}' is not an address: write HOST, HOST:PORT or tls/HOST:PORT")
    return host.endpoint(host.port or ROUTER_PORT)


def target_of(text: str) -> str:
    """Return Zenoh's endpoint of another router, as `endpoint_of`; raises TransportError also where it names no other.

    >>> target_of("robot")
    'tcp/robot:7447'
    """
    endpoint = endpoint_of(text, "--connect")
    host = hosts.parse(endpoint.partition("/")[2])
    if host and host.name in EVERYWHERE:
        raise TransportError(
            f"--connect: '{text[:80]}' is this machine and no other router: name its HOST, such as robot.local "
            "(what opens this router to others is --listen lan)"
        )
    return endpoint


def router_settings(listen: Sequence[str], connect: Sequence[str]) -> dict[str, Any]:
    """Return Zenoh's settings of a router that listens at some endpoints, and keeps connecting to others."""
    return {
        "mode": "router",
        "listen": {"endpoints": [*listen], "exit_on_failure": True, "timeout_ms": 0},
        "connect": {
            "endpoints": [*connect],
            "exit_on_failure": False,
            "timeout_ms": -1,
            "retry": RETRY,
        },
        # Peers learn of each other here and link themselves; routers are joined only where that is asked for.
        "scouting": {
            "multicast": {"enabled": False},
            "gossip": {"enabled": True, "autoconnect": {"router": [], "peer": ["router", "peer"]}},
        },
        "routing": {"router": {"peers_failover_brokering": False}},
        "timestamping": {"enabled": True},
        "queries_default_timeout": _QUERIES_MS,
        "transport": {
            "unicast": {
                "accept_pending": most_pending(),
                "max_sessions": MOST_PENDING,
                "open_timeout": _FOR_ROS_MS,
                "accept_timeout": _FOR_ROS_MS,
            },
            "link": {"tx": {"lease": LEASE_MS}, "rx": {"max_message_size": LARGEST_MESSAGE}},
            # A router that may lock too little memory loses large messages without a word.
            "shared_memory": {"enabled": False},
        },
        "adminspace": {"enabled": False},
    }
