"""Settings of Zenoh for each kind of network, as JSON data: where a session listens and connects, and how it waits."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from typing import Any

from robolink.constants import LARGEST_MESSAGE
from robolink.networks.request import FIRST_PORT, ROS_ROUTER, checked_domain

LEASE_MS = 60_000
"""Lease of a silent peer, in milliseconds, after which it counts as gone, as in rmw_zenoh.

A process that ends or is killed is gone at once, since the system closes its connections. So this is for one that is
paused (Ctrl-Z, a debugger, a laptop that sleeps) and for cables: with 5 s such a node left the graph, and its links had
to be made again (5 s after the cable was back, not 0.4). It costs others nothing: messages for such a peer are dropped
when its buffer is full.
"""

WAIT_BEFORE_DROP_US = 130_000
"""Longest wait of a publisher for a peer's full buffer before it drops the message, in microseconds.

Zenoh's own 1 ms is too short: a busy machine lets no thread run that fast, and a burst of a hundred scans lost a tenth.
A subscriber that takes a flood as fast as it can was away for 100 ms at a time; with 50 ms here it lost a twentieth.
A paused peer delays one message by this; the next ones are dropped at once.
"""

WAIT_FOR_THE_REST_US = 60_000
"""Further wait for a message of several batches (64 kB), in microseconds, so that no `publish` takes over 0.19 s.

A message that the link does not carry in that time is dropped: 2 MB arrive over 100 Mbit/s, 6 MB do not (with Zenoh's
own 50 ms not even the 2), and within a machine 280 MB. Latched messages are requested again, and arrive.
"""

LONGEST_WAIT = (WAIT_BEFORE_DROP_US + WAIT_FOR_THE_REST_US) / 1e6
"""Longest wait of a `publish`: the sum of the two, in seconds."""

MOST_PENDING = 10_000
"""Most pending connections, as in rmw_zenoh. With Zenoh's own 100, silent ones kept others out for 10 s."""

SOUGHT_EVERY = 0.1
"""Longest retry interval of a session that has lost its rendezvous, in seconds: somebody else may take the port."""

OFTEN = f"retry_period_init_ms=50;retry_period_max_ms={SOUGHT_EVERY * 1000:.0f};retry_period_increase_factor=2"
"""Retry settings (exponential backoff) of an endpoint with this interval."""

RETRY = {"period_init_ms": 250, "period_max_ms": 1000, "period_increase_factor": 2}
"""Retry settings of endpoints. With Zenoh's own, a client was back at its router after 3.1 s, with these after 0.2."""


def most_pending() -> int:
    """Return the limit of pending connections: at most half of the files that the process may open."""
    if sys.platform == "win32":
        return MOST_PENDING
    import resource

    files = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
    return MOST_PENDING if files == resource.RLIM_INFINITY else min(MOST_PENDING, files // 2)


HEARTBEATS = {"congestion_control": "drop", "priority": "data_high"}
"""Options of the messages by which a latched topic's publisher tells its last number: others see what they lost.

Zenoh sends them on the one thread that serves all links which a session has dialed, and has them wait for room in a
full buffer, for 5 s: a machine out of reach stopped for so long what came from the others. Dropped instead, in a buffer
that little else uses, they stop nothing, and pass beside what fills a slow link.
"""

_PATIENCE = {"wait_before_drop": WAIT_BEFORE_DROP_US, "max_wait_before_drop_fragments": WAIT_FOR_THE_REST_US}

_BASE: dict[str, Any] = {
    "mode": "peer",
    # Publishers that keep samples for late joiners stamp them.
    "timestamping": {"enabled": True},
    "transport": {
        "unicast": {"accept_pending": most_pending()},
        "link": {
            "protocols": ["tcp", "tls", "quic", "ws"],
            "tx": {
                "lease": LEASE_MS,
                "queue": {"congestion_control": {"drop": _PATIENCE}},
            },
            "rx": {"max_message_size": LARGEST_MESSAGE},
        },
    },
    "adminspace": {"enabled": False},
    "qos": {"publication": [{"key_exprs": ["**/@adv/**"], "config": HEARTBEATS}]},
}


def settings(
    value: str, domain: int, *, holds_port: bool = True, peers: Sequence[str] = (), platform: str = sys.platform
) -> dict[str, Any]:
    """Return Zenoh's settings, as JSON data, for a network of NAMES; `peers` are endpoints to connect to besides.

    Without `holds_port` the session leaves the rendezvous port to another process. With `peers` a session of
    `localhost` may go to other machines, to these and whom they know, but listens on this one only, as before.
    """
    if value == "off":
        return _BASE | {"listen": {"endpoints": []}, "scouting": _scouting(gossip=_OFF)}
    port = FIRST_PORT + checked_domain(domain)
    if value == "lan":
        found = _lan(port, holds_port)
    elif peers:
        # No access control, which would confine it. Both ends dial: a peer over there cannot reach this loopback.
        found = _meeting("127.0.0.1", port, holds_port, [*_holder(port, holds_port), ROS_ROUTER])
        found |= {"scouting": _scouting()}
    else:
        return _localhost(port, holds_port, platform)
    found["connect"]["endpoints"] += peers
    return found


def _localhost(port: int, holds_port: bool, platform: str) -> dict[str, Any]:
    loopback = _LOOPBACK.get(platform)
    peers = _holder(port, holds_port) + ([ROS_ROUTER] if loopback else [])
    # Windows names its interfaces in ways that cannot be known before a link is up, so that there is no access
    # control there, and without it a session follows gossip to other machines (seen on Linux). A ROS 2 router is
    # what brings such gossip in: on Windows it has to be asked for, `--network tcp/127.0.0.1:7447`.
    control = {"access_control": only_on(loopback)} if loopback else {}
    # Of two peers that hear of each other the one with the greater id connects: both would do the work twice, and here
    # each can reach the other. 30 processes that start at once are meshed with a quarter less of it.
    one_connects = {"to_router": "always", "to_peer": "greater-zid"}
    gossip = {"enabled": True, "autoconnect_strategy": {"peer": one_connects}}
    scouting = _scouting(delay=_DELAY_ON_LOOPBACK_MS, gossip=gossip)
    return _meeting("127.0.0.1", port, holds_port, peers) | {"scouting": scouting} | control


def _lan(port: int, holds_port: bool) -> dict[str, Any]:
    peers = [*_holder(port, holds_port), ROS_ROUTER]
    # A group of its own: what else speaks Zenoh here (224.0.0.224:7446) is not drawn in.
    return _meeting("0.0.0.0", port, holds_port, peers) | {
        "scouting": _scouting(delay=200, multicast={"enabled": True, "address": f"224.0.0.224:{port}"})
    }


def _holder(port: int, holds_port: bool) -> list[str]:
    """Return the endpoints to connect to at the rendezvous port: none for its holder."""
    return [] if holds_port else [f"tcp/127.0.0.1:{port}#{OFTEN}"]


def _meeting(host: str, port: int, holds_port: bool, peers: list[str]) -> dict[str, Any]:
    own = [f"tcp/{host}:{port}", f"tcp/{host}:0"]
    return _BASE | {
        # No retry: a listener that retries for ever makes close() hang for 10 s (seen with Zenoh 1.10.2). When
        # the holder of the port dies, the next process to start takes it, and the others find it there.
        "listen": {
            "endpoints": own if holds_port else own[1:],
            "exit_on_failure": holds_port,
            "timeout_ms": 0,
        },
        "connect": {
            "endpoints": peers,
            "exit_on_failure": False,
            "timeout_ms": -1,
            "retry": RETRY,
        },
    }


def client(*endpoints: str) -> dict[str, Any]:
    """Return the settings of a client of the first of these endpoints that answers."""
    # A client and not a peer: since 2024 routers of ROS 2 forward between a client and a peer, not between peers.
    return _BASE | {
        "mode": "client",
        "connect": {"endpoints": [*endpoints], "exit_on_failure": True, "timeout_ms": 3000, "retry": RETRY},
        "scouting": _scouting(gossip=_OFF),
    }


def as_ros(mode: str) -> dict[str, Any]:
    """Return rmw_zenoh's session settings, for a session whose overrides name its network."""
    if mode.strip("\"'") == "client":
        return client(ROS_ROUTER)
    peer = _meeting("127.0.0.1", 0, False, [ROS_ROUTER])
    peer["listen"]["exit_on_failure"] = True  # where it is to listen is the user's word
    return peer | {"scouting": _scouting(gossip=_ON)}


_DELAY_ON_LOOPBACK_MS = 1
"""Wait of `open()` for ROS 2's router, in milliseconds: nearly nobody has one here, and each node would wait.

With 20 as elsewhere a node started a sixth later, and heard no more: of messages that were published at once, to a
process that neither end knew and to one behind a router, as many arrived, also on a busy machine.
"""
_LOOPBACK = {"linux": "lo", "darwin": "lo0"}
_ON: Mapping[str, object] = {"enabled": True}
_OFF: Mapping[str, object] = {"enabled": False}


def _scouting(
    delay: int = 20, gossip: Mapping[str, object] = _ON, multicast: Mapping[str, object] = _OFF
) -> dict[str, Any]:
    # The delay is what open() waits for endpoints that do not answer.
    return {"delay": delay, "multicast": multicast, "gossip": gossip}


def only_on(interface: str) -> dict[str, Any]:
    """Return the access control that confines a session to one network interface."""
    # ** does not match what begins with @: the graph and the history of latched topics. Zenoh looks up each new key for
    # each kind of message, in both directions, at each link: where thousands of announcements come, what is not needed
    # for a kind costs. A graph's token is neither data nor a subscription.
    data = ["**", "**/@adv/**"]
    rules = {
        "data": (data, ["put", "delete", "declare_subscriber", "query", "reply", "declare_queryable"]),
        "graph": (
            ["@ros2_lv/**", *data],
            ["liveliness_token", "liveliness_query", "declare_liveliness_subscriber"],
        ),
    }
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": [
            {
                "id": name,
                "permission": "allow",
                "flows": ["ingress", "egress"],
                "key_exprs": keys,
                "messages": messages,
            }
            for name, (keys, messages) in rules.items()
        ],
        "subjects": [{"id": "loopback", "interfaces": [interface]}],
        "policies": [{"rules": [*rules], "subjects": ["loopback"]}],
    }
