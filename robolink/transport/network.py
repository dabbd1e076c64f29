"""Where a Zenoh session listens and whom it seeks: this machine only, unless the user asks for more."""

from __future__ import annotations

import contextlib
import json
import os
import re
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.exceptions import TransportError, nearest, shown
from robolink.transport.base import LARGEST_MESSAGE

if TYPE_CHECKING:
    import zenoh

FIRST_PORT = 17447
"""The rendezvous port of domain 0; domain d meets at FIRST_PORT + d."""

ROS_ROUTER = "tcp/127.0.0.1:7447"
"""Where `rmw_zenohd`, the router of ROS 2, listens."""

NAMES = ("localhost", "subnet", "off")
"""Networks that can be asked for by name; an endpoint of a router or a file of Zenoh's settings do as well."""

LEASE_MS = 60_000
"""Milliseconds without a sign of life after which a peer counts as gone, as in rmw_zenoh.

Who ends or is killed is gone at once, since the system closes its connections. So this is for who stands still (Ctrl-Z,
a debugger, a laptop that sleeps) and for cables: with 5 s such a node left the graph, and its links had to be made anew
(5 s after the cable was back, not 0.4). It costs others nothing: what finds no room for such a peer is dropped.
"""

WAIT_BEFORE_DROP_US = 130_000
"""Microseconds that a publisher waits for room on the way to a peer before it drops what is for that one.

Zenoh's own 1 ms is too short: a busy machine lets no thread run that fast, and a burst of a hundred scans lost a tenth.
A subscriber that takes a flood as fast as it can was away for 100 ms at a time; with 50 ms here it lost a twentieth.
A peer that stands still holds up one message by this; the next ones are dropped at once.
"""

WAIT_FOR_THE_REST_US = 60_000
"""Microseconds more for a message of several batches (64 kB), so that no `publish` waits longer than 0.19 s.

What its link does not carry in that time is dropped: 2 MB come over 100 Mbit/s, 6 MB do not (with Zenoh's own 50 ms not
even the 2), and within a machine 280 MB. What is latched is asked for again, and arrives.
"""

LONGEST_WAIT = (WAIT_BEFORE_DROP_US + WAIT_FOR_THE_REST_US) / 1e6
"""Seconds: the two together."""

MOST_PENDING = 10_000
"""Connections that may be silent at once, as in rmw_zenoh. With Zenoh's own 100 nobody else was let in for 10 s."""

SOUGHT_EVERY = 0.1
"""Seconds: so often a session whose rendezvous has gone looks whether somebody else has taken the port."""

OFTEN = f"retry_period_init_ms=50;retry_period_max_ms={SOUGHT_EVERY * 1000:.0f};retry_period_increase_factor=2"
"""The settings of an endpoint that is sought so often."""

_HIGHEST_DOMAIN = 232
_RANGES = {"": "localhost", "SYSTEM_DEFAULT": "localhost", "LOCALHOST": "localhost", "SUBNET": "subnet", "OFF": "off"}
_OVERRIDE = "ZENOH_CONFIG_OVERRIDE"
_ENDPOINT = re.compile(r"(tcp|tls|quic|ws)/\S+:\d+")
_NAMES_A_NETWORK = re.compile(r"mode|(connect|listen)(/endpoints.*)?")
_LOOPBACK = {"linux": "lo", "darwin": "lo0"}


class Wanted(NamedTuple):
    """Which network somebody asked for."""

    asked_by: str
    """The option or variable to name in an error."""
    value: str
    """One of NAMES, the endpoint of a router, the path of a file, or overrides that name a network of their own."""


def domain_id(environ: Mapping[str, str]) -> int:
    """Read ROS_DOMAIN_ID, 0 when unset; raises TransportError for what is no domain."""
    text = environ.get("ROS_DOMAIN_ID", "").strip() or "0"
    if not re.fullmatch(r"[0-9]{1,3}", text):
        raise TransportError(f"ROS_DOMAIN_ID must be a number from 0 to {_HIGHEST_DOMAIN}, got {text[:40]!r}")
    return checked_domain(int(text), "ROS_DOMAIN_ID")


def checked_domain(domain: int, asked_by: str = "the domain id") -> int:
    """Give `domain` back; raises TransportError unless it is one of ROS 2's, 0 to 232."""
    if not 0 <= domain <= _HIGHEST_DOMAIN:
        raise TransportError(f"{asked_by} must be a number from 0 to {_HIGHEST_DOMAIN}, got {domain}")
    return domain


def wanted(network: str | None, environ: Mapping[str, str]) -> Wanted:
    """Find out which network is asked for: by argument, by variable, or else this machine's own.

    The variables are ROBOLINK_NETWORK, ZENOH_SESSION_CONFIG_URI and ROS_AUTOMATIC_DISCOVERY_RANGE, in this order.
    Whoever names endpoints or a mode in ZENOH_CONFIG_OVERRIDE asks for that network, and not for this machine's own.
    """
    found = _asked_for(network, environ)
    named = _network_of_overrides(environ)
    return Wanted(_OVERRIDE, named) if named and found.value == "localhost" else found


def _asked_for(network: str | None, environ: Mapping[str, str]) -> Wanted:
    if network:
        return Wanted("network", network)
    for variable in ("ROBOLINK_NETWORK", "ZENOH_SESSION_CONFIG_URI"):
        if environ.get(variable):
            return Wanted(variable, environ[variable])
    variable = "ROS_AUTOMATIC_DISCOVERY_RANGE"
    reach = environ.get(variable, "")
    if reach.upper() not in _RANGES:
        known = ", ".join(filter(None, _RANGES))
        raise TransportError(f"{variable} must be one of {known}, got {reach[:40]!r}")
    return Wanted(variable, _RANGES[reach.upper()])


def settings(value: str, domain: int, *, holds_port: bool = True, platform: str = sys.platform) -> dict[str, Any]:
    """Give Zenoh's settings for a network by name or for the endpoint of a router, as JSON would have them.

    Without `holds_port` the session leaves the rendezvous port to another process.
    """
    if _ENDPOINT.fullmatch(value):
        return _client(value)
    if value == "off":
        return _BASE | {"listen": {"endpoints": []}, "scouting": _scouting(gossip=_OFF)}
    port = FIRST_PORT + checked_domain(domain)
    if value == "subnet":
        return _subnet(port, holds_port)
    return _localhost(port, holds_port, platform)


def _most_pending() -> int:
    """Return how many connections may be silent at once: they leave the process half of the files that it may open."""
    if sys.platform == "win32":
        return MOST_PENDING
    import resource

    files = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
    return MOST_PENDING if files == resource.RLIM_INFINITY else min(MOST_PENDING, files // 2)


_PATIENCE = {"wait_before_drop": WAIT_BEFORE_DROP_US, "max_wait_before_drop_fragments": WAIT_FOR_THE_REST_US}

_BASE: dict[str, Any] = {
    "mode": "peer",
    # Publishers that keep samples for late joiners stamp them.
    "timestamping": {"enabled": True},
    "transport": {
        "unicast": {"accept_pending": _most_pending()},
        "link": {
            "protocols": ["tcp", "tls", "quic", "ws"],
            "tx": {
                "lease": LEASE_MS,
                "queue": {"congestion_control": {"drop": _PATIENCE}},
            },
            "rx": {"max_message_size": LARGEST_MESSAGE},
        },
        "shared_memory": {"enabled": True},
    },
    "adminspace": {"enabled": False},
}


def _localhost(port: int, holds_port: bool, platform: str) -> dict[str, Any]:
    loopback = _LOOPBACK.get(platform)
    peers = _holder(port, holds_port) + ([ROS_ROUTER] if loopback else [])
    # Windows names its interfaces in ways that cannot be known before a link is up, so that there is no access
    # control there, and without it a session follows gossip to other machines (seen on Linux). A ROS 2 router is
    # what brings such gossip in: on Windows it has to be asked for, `--network tcp/127.0.0.1:7447`.
    control = {"access_control": _only_on(loopback)} if loopback else {}
    # Of two peers that hear of each other the one with the greater id connects: both would do the work twice, and here
    # each can reach the other. 30 processes that start at once are meshed with a quarter less of it.
    one_connects = {"to_router": "always", "to_peer": "greater-zid"}
    gossip = {"enabled": True, "autoconnect_strategy": {"peer": one_connects}}
    return _meeting("127.0.0.1", port, holds_port, peers) | {"scouting": _scouting(gossip=gossip)} | control


def _subnet(port: int, holds_port: bool) -> dict[str, Any]:
    peers = [*_holder(port, holds_port), ROS_ROUTER]
    # A group of its own: what else speaks Zenoh here (224.0.0.224:7446) is not drawn in.
    return _meeting("0.0.0.0", port, holds_port, peers) | {
        "scouting": _scouting(delay=200, multicast={"enabled": True, "address": f"224.0.0.224:{port}"})
    }


def _holder(port: int, holds_port: bool) -> list[str]:
    """Give whom to seek at the rendezvous port: nobody, for who is there; else whoever has it, now and later."""
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
            "retry": {"period_init_ms": 250, "period_max_ms": 1000, "period_increase_factor": 2},
        },
    }


def _client(endpoint: str) -> dict[str, Any]:
    # A client and not a peer: since 2024 routers of ROS 2 forward between a client and a peer, not between peers.
    return _BASE | {
        "mode": "client",
        "connect": {"endpoints": [endpoint], "exit_on_failure": True, "timeout_ms": 3000},
        "scouting": _scouting(gossip=_OFF),
    }


def _as_ros(mode: str) -> dict[str, Any]:
    """Return the settings of a session whose overrides say where to go: those of rmw_zenoh's sessions."""
    if mode.strip("\"'") == "client":
        return _client(ROS_ROUTER)
    peer = _meeting("127.0.0.1", 0, False, [ROS_ROUTER])
    peer["listen"]["exit_on_failure"] = True  # where it is to listen is the user's word
    return peer | {"scouting": _scouting(gossip=_ON)}


_ON: Mapping[str, object] = {"enabled": True}
_OFF: Mapping[str, object] = {"enabled": False}


def _scouting(
    delay: int = 20, gossip: Mapping[str, object] = _ON, multicast: Mapping[str, object] = _OFF
) -> dict[str, Any]:
    # The delay is what open() waits for endpoints that do not answer.
    return {"delay": delay, "multicast": multicast, "gossip": gossip}


def _only_on(interface: str) -> dict[str, Any]:
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": [
            {
                "id": "all",
                "permission": "allow",
                "flows": ["ingress", "egress"],
                # ** does not match what begins with @: the graph and the history of latched topics.
                "key_exprs": ["**", "@ros2_lv/**", "**/@adv/**"],
                "messages": [
                    *("put", "delete", "declare_subscriber", "query", "reply", "declare_queryable"),
                    *("liveliness_token", "liveliness_query", "declare_liveliness_subscriber"),
                ],
            }
        ],
        "subjects": [{"id": "loopback", "interfaces": [interface]}],
        "policies": [{"rules": ["all"], "subjects": ["loopback"]}],
    }


def load(network: str | None, domain: int, environ: Mapping[str, str], *, holds_port: bool = True) -> zenoh.Config:
    """Make Zenoh's configuration of what is asked for; raises TransportError that names who asked.

    ZENOH_CONFIG_OVERRIDE, `path=json5;path=json5`, has the last word.
    """
    asked_by, value = wanted(network, environ)
    overrides = _overrides(environ)
    if asked_by == _OVERRIDE:
        config = _config(_as_ros(dict(overrides).get("mode", "")))
    elif value in NAMES or _ENDPOINT.fullmatch(value):
        wished = settings(value, domain, holds_port=holds_port)
        if any(path.startswith("access_control") for path, _ in overrides):  # theirs, and not a mixture with ours
            wished.pop("access_control", None)
        config = _config(wished)
    else:
        config = _from_file(asked_by, value)
    return _overridden(config, overrides)


def _config(wished: dict[str, Any]) -> zenoh.Config:
    import zenoh

    config: zenoh.Config = zenoh.Config.from_json5(json.dumps(wished))
    return config


def _overrides(environ: Mapping[str, str]) -> list[tuple[str, str]]:
    """Split ZENOH_CONFIG_OVERRIDE, `path=json5;path=json5`, into paths and values."""
    parts = (each.partition("=") for each in environ.get(_OVERRIDE, "").split(";") if each.strip())
    return [(path.strip(), value.strip()) for path, _, value in parts]


def _network_of_overrides(environ: Mapping[str, str]) -> str:
    """Return those overrides that name endpoints or a mode, in one line; empty where none does."""
    named = (f"{path}={value}" for path, value in _overrides(environ) if _NAMES_A_NETWORK.fullmatch(path))
    return ";".join(" ".join(each.split()) for each in named)


def meets_at_port(value: str, environ: Mapping[str, str]) -> bool:
    """Tell whether the sessions of this network find each other at the rendezvous port of their domain."""
    return value in ("localhost", "subnet") and not _network_of_overrides(environ)


def _from_file(asked_by: str, value: str) -> zenoh.Config:
    import zenoh

    path = file_of(value)
    if not path.is_file():
        known = f"the networks are {', '.join(NAMES)} and tcp/HOST:PORT of a router"
        raise TransportError(f"{asked_by}: no network or file '{value[:200]}'{nearest(value[:200], NAMES)}; {known}")
    try:
        config: zenoh.Config = zenoh.Config.from_file(path)
    except zenoh.ZError as error:
        raise TransportError(f"{asked_by}: {path}: {reason(error)}") from None
    config.insert_json5("timestamping/enabled", "true")  # latched topics cannot do without
    return config


def file_of(value: str) -> Path:
    """Give the file that a path or an address names.

    >>> file_of("file:///C:/robot.json5").as_posix()
    'C:/robot.json5'
    """
    return Path(re.sub(r"^file://(/(?=[A-Za-z]:))?", "", value)).expanduser()


def _overridden(config: zenoh.Config, overrides: list[tuple[str, str]]) -> zenoh.Config:
    import zenoh

    for path, value in overrides:
        try:
            config.insert_json5(path, value)
        except (zenoh.ZError, UnicodeEncodeError) as error:  # the latter: bytes that are no UTF-8
            override = shown(f"{path}={value}")
            raise TransportError(f"{_OVERRIDE}: '{override}': {reason(error)}") from None
    return config


def reason(error: Exception) -> str:
    """Give what a Zenoh error says in one line, without the places in Zenoh's own source.

    >>> reason(Exception("Timeout! at /home/a/zenoh/src/b.rs:388."))
    'Timeout!'
    """
    text = str(error)
    quoted = re.search(r'(?:msg: |Str\()"((?:[^"\\]|\\.)*)"', text)
    text = quoted[1].replace("\\n", "\n") if quoted else text
    syntax = re.search(r"--> (\d+):(\d+)\n.*= (expected [^\n]*)", text, re.DOTALL)
    text = f"line {syntax[1]}, column {syntax[2]}: {syntax[3]}" if syntax else text
    return " ".join(re.sub(r" at [^\s]+\.rs:\d+\.?", "", text).split())


_DELETE_ON_CLOSE: int = getattr(os, "O_TEMPORARY", 0)  # Windows has it


class PortClaim:
    """Says whether this session may listen on the rendezvous port.

    Zenoh sets SO_REUSEADDR, with which Windows lets two processes bind one port. So there a file that only one
    process can create stands for the port, and disappears with its process. Elsewhere the second bind fails.
    """

    def __init__(self, port: int, platform: str = sys.platform, folder: str | None = None) -> None:
        self._file = -1
        self.granted = platform != "win32" or self._create(port, folder)

    def _create(self, port: int, folder: str | None) -> bool:
        import tempfile  # late: it costs every node's start a few ms, and only Windows wants it

        self.path = Path(folder or tempfile.gettempdir()) / f"robolink-{port}.lock"
        with contextlib.suppress(OSError):
            self._file = os.open(self.path, os.O_CREAT | os.O_EXCL | os.O_RDWR | _DELETE_ON_CLOSE)
        return self._file >= 0

    def release(self) -> None:
        """Let another session have the port. Safe to call twice."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1
            if not _DELETE_ON_CLOSE:
                self.path.unlink(missing_ok=True)
