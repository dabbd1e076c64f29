"""Network reach of a Zenoh session: the machines that its configuration allows, its links, and who answers it."""

from __future__ import annotations

import re
import time
from collections.abc import Collection
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec

from robolink.system import clocks

if TYPE_CHECKING:
    import zenoh

SECURED = ("tls/", "quic/")
"""Prefixes of the endpoints that use certificates."""

_LOCAL_PROTOCOLS = ("unixpipe", "unixsock-stream", "vsock")
_LOOPBACK_INTERFACES = ("lo", "lo0")


class Reach(NamedTuple):
    """Reachable sessions, by a configuration."""

    mode: str = "peer"
    connects: tuple[str, ...] = ()
    """Endpoints to which it connects."""
    listens: tuple[str, ...] = ()
    """Endpoints on which it accepts connections."""
    multicast: str = ""
    """Multicast group of its discovery; empty if it uses none."""
    interfaces: tuple[str, ...] = ()
    """Network interfaces to which access control confines it; empty if it does not."""

    @property
    def leaves_machine(self) -> bool:
        """True if it may connect to other machines directly; a router may lead there in any case."""
        if self.interfaces and set(self.interfaces) <= set(_LOOPBACK_INTERFACES):
            return False
        return bool(self.multicast) or not all(map(on_this_machine, (*self.connects, *self.listens)))

    @property
    def secured(self) -> bool:
        """True if any of its endpoints uses TLS."""
        return any(each.startswith(SECURED) for each in (*self.connects, *self.listens))

    def __str__(self) -> str:
        if self.mode == "client" and self.connects:
            return f"whoever is behind {' or '.join(self.connects)}, as its client"
        if not (self.connects or self.listens or self.multicast):
            return "no other process"
        if not self.leaves_machine:
            return f"those on this machine only{f' (interface {self.interfaces[0]})' if self.interfaces else ''}"
        there = [each for each in self.connects if not on_this_machine(each)]
        parts = [
            f"the local network (multicast {self.multicast})" if self.multicast else "",
            f"whoever answers at {' and '.join(there)}" if there else "",
            f"whoever connects to {' or '.join(self.listens)}"
            if self.listens and not (self.multicast or there)
            else "",
        ]
        return ", ".join(filter(None, parts))


class Link(NamedTuple):
    """A connection to another session."""

    role: str
    """Mode of the other session: `router`, `peer` or `client`."""
    here: str
    """Local address, such as ``tcp/10.0.0.1:40000``."""
    there: str
    session: str = ""
    """Id of the other session; two links may lead to one."""
    certificate: str = ""
    """Name in the certificate of the other session, which is its enclave; '' where there is none."""

    @property
    def leaves_machine(self) -> bool:
        """True if the other session is on another machine: then the two addresses differ."""
        return host_of(self.here) != host_of(self.there)


def links_of(session: zenoh.Session) -> list[Link]:
    """Return the connections of a session to others."""
    roles = {str(each.zid): str(each.whatami) for each in session.info.transports()}
    return [
        Link(roles.get(zid := str(each.zid), "peer"), str(each.src), str(each.dst), zid, each.auth_identifier or "")
        for each in session.info.links()
    ]


def reach(config: zenoh.Config) -> Reach:
    """Return the reach of sessions with this configuration."""
    mode = mode_of(config)
    enabled = read(config, "scouting/multicast/enabled")
    group = msgspec.json.decode(config.get_json("scouting/multicast/address")) or "224.0.0.224:7446"
    return Reach(
        mode,
        tuple(address_of(each) for each in read(config, "connect/endpoints") or ()),
        () if mode == "client" else tuple(address_of(each) for each in read(config, "listen/endpoints") or ()),
        "" if enabled is False else group,
        _interfaces(msgspec.json.decode(config.get_json("access_control"))),
    )


def as_json(setting: Any) -> str:
    """Return a setting as JSON, which Zenoh reads, also one with bytes that are not UTF-8."""
    try:
        return msgspec.json.encode(setting).decode()  # without `json`, which takes 1.5 ms to import
    except UnicodeEncodeError:
        import json

        return json.dumps(setting)


def mode_of(config: zenoh.Config) -> str:
    """Return the mode of sessions with this configuration: `peer`, `client` or `router`."""
    return msgspec.json.decode(config.get_json("mode")) or "peer"


def read(config: zenoh.Config, path: str) -> Any:
    """Return a setting that may be one value or one for each mode."""
    value = msgspec.json.decode(config.get_json(path))
    return value.get(mode_of(config)) if isinstance(value, dict) else value


def on_this_machine(endpoint: str) -> bool:
    """True if an endpoint or address can lead to this machine only.

    >>> on_this_machine("tcp/[::1]:7447"), on_this_machine("tcp/localhost:0"), on_this_machine("tls/0.0.0.0:0")
    (True, True, False)
    """
    import ipaddress  # late: it costs every node's start 2 ms

    host = host_of(endpoint)
    if host == "localhost" or endpoint.partition("/")[0] in _LOCAL_PROTOCOLS:
        return True
    try:
        return ipaddress.ip_address(host.partition("%")[0]).is_loopback
    except ValueError:
        return False


def host_of(endpoint: str) -> str:
    """Return the host of an endpoint.

    >>> host_of("tls/[fe80::1%eth0]:7447#iface=eth0")
    'fe80::1%eth0'
    """
    address = re.split(r"[#?]", endpoint.partition("/")[2])[0]
    return address.rpartition(":")[0].strip("[]")


def port_of(endpoint: str) -> int:
    """Return the port of an endpoint, 0 where there is none.

    >>> port_of("tls/[::]:7447#iface=eth0")
    7447
    """
    number = address_of(endpoint).rpartition(":")[2]
    return int(number) if number.isascii() and number.isdigit() and len(number) < 6 else 0


def address_of(endpoint: str) -> str:
    """Return an endpoint without its settings, which stand after `#` or `?`."""
    return re.split(r"[#?]", endpoint)[0]


def _interfaces(control: dict[str, Any]) -> tuple[str, ...]:
    """Return the interfaces to which access control confines all traffic."""
    if not control["enabled"] or control["default_permission"] != "deny":
        return ()
    named = [subject.get("interfaces") for subject in control["subjects"] or ()]
    return tuple(sorted({each for some in named for each in some})) if named and all(named) else ()


STEP = 0.005
"""Interval at which answers are looked for, in seconds."""


def answering(config: zenoh.Config, sought: Collection[str], within: float) -> frozenset[str]:
    """Return the ids of sessions that answer a multicast, once all that are sought have, or the time is over.

    Args:
        config: Zenoh's configuration of a session, which has the group and the interface.
        sought: Ids of sessions.
        within: Timeout of their answers, in seconds.
    """
    import zenoh  # late: it takes the command line 40 ms, and few commands scout

    found = set[str]()
    deadline = clocks.monotonic() + within
    try:
        scout = zenoh.scout(what="peer|router", config=config)
    except zenoh.ZError:  # there is no interface for it
        return frozenset()
    try:
        while not found.issuperset(sought) and clocks.monotonic() < deadline:
            if (hello := scout.try_recv()) is None:
                time.sleep(STEP)
            else:
                found.add(str(hello.zid))
    finally:
        scout.stop()  # type: ignore[no-untyped-call]
    return frozenset(found)
