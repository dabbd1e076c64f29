"""The run of `robolink bridge dds`: what it says at the start, what it has met, and its end."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable, Mapping
from types import FrameType
from typing import TYPE_CHECKING

from robolink.cli.shared.output import say
from robolink.exceptions import TransportError
from robolink.networks.request import RANGE, ask, checked_domain, domain_id, requested
from robolink.system.terminal import shown

if TYPE_CHECKING:
    from robolink.dds.mirror import Count

LOOK_EVERY = 0.5
"""Interval of the looks at what has been met, in seconds."""

_INTERFACE, _STATIC_PEERS = "ROBOLINK_DDS_INTERFACE", "ROS_STATIC_PEERS"


def run(domain: int | None, network: str | None, interface: str) -> None:
    """Run a bridge to DDS until Ctrl-C or SIGTERM.

    Args:
        domain: ROS domain id; None is that of the environment.
        network: Zenoh network; None is that of the environment.
        interface: Interface on which DDS is met beside this machine; "" is none.
    """
    from robolink.dds.bridge import Bridge

    environ = dict(os.environ)
    number = domain_id(environ) if domain is None else checked_domain(domain, "--domain")
    if network is not None:
        ask(environ, network, "--network")
    name = checked_network(environ)
    sys.setswitchinterval(0.0005)  # the lanes take turns with the participant's thread, and each message waits for it
    try:
        signal.signal(signal.SIGTERM, _end)
        bridge = Bridge(number, None, environ, dds_environ(environ, interface))
        try:
            for line in opening(number, name, interface, environ):
                say(line)
            report(bridge.count, bridge.check, say)
        finally:
            bridge.close()
    except KeyboardInterrupt:
        say("the bridge has ended")


def _end(number: int, frame: FrameType | None) -> None:
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    raise KeyboardInterrupt


def checked_network(environ: Mapping[str, str]) -> str:
    """Return the requested Zenoh network; raises TransportError if it is DDS, which is on the other side."""
    origin, value = requested(None, environ)
    if value == "dds":
        raise TransportError(
            f"{origin}: 'dds' is the other side of the bridge: name the Zenoh network, such as localhost"
        )
    return value


def dds_environ(environ: Mapping[str, str], interface: str) -> dict[str, str]:
    """Return the environment for the side of DDS: it leaves the machine only by an interface that is named."""
    if not interface:
        others = {name: value for name, value in environ.items() if name not in (_INTERFACE, _STATIC_PEERS)}
        return others | {RANGE: "OFF" if environ.get(RANGE, "").upper() == "OFF" else "LOCALHOST"}
    return {RANGE: "SUBNET"} | {**environ, _INTERFACE: interface}


def opening(domain: int, network: str, interface: str, environ: Mapping[str, str]) -> list[str]:
    """Return the first lines of a bridge: what it joins, and who hears what.

    Args:
        domain: ROS domain id.
        network: Name of the Zenoh network.
        interface: Interface on which DDS is met beside this machine; "" is none.
        environ: Environment.
    """
    where = f"this machine and {interface}" if interface else "this machine"
    lines = [f"robolink bridge: DDS on {where} and Zenoh ({shown(network)}), domain {domain}; Ctrl-C ends it"]
    if network not in ("localhost", "off"):
        lines.append(
            "all nodes on DDS here are now on that network, too: whoever is there may hear and command them"
            " (docs/why/security.md)"
        )
    if interface:
        lines.append(f"whoever reaches {interface} may hear and command all nodes over DDS (docs/why/security.md)")
    elif environ.get(_STATIC_PEERS):
        lines.append(f"WARN {_STATIC_PEERS} has no effect without --interface")
    return lines


def report(
    count: Callable[[], Count],
    check: Callable[[], object],
    say: Callable[[str], object],
    pause: Callable[[float], object] = time.sleep,
) -> None:
    """Report what has been met whenever it changes, for ever.

    Args:
        count: Function that returns the figures.
        check: Function that raises an error if the bridge must end.
        say: Function that says a line.
        pause: Function that waits so many seconds.
    """
    before: Count | None = None
    printed = ""
    while True:
        check()
        now = count()
        # Once it has settled: at the start each node would have lines of its own.
        if now == before and (text := met(now)) != printed:
            say(text)
            printed = text
        before = now
        pause(LOOK_EVERY)


def met(count: Count) -> str:
    """Return in words what a bridge has met."""
    zenoh, dds = count.nodes
    parts = [
        f"nodes: {zenoh} on Zenoh, {dds} on DDS",
        f"topics flowing: {count.topics}",
        f"services: {count.services}",
    ]
    if count.dropped:
        parts.append(f"messages dropped: {count.dropped}")
    if count.failed:
        parts.append(f"not carried: {count.failed}")
    return "; ".join(parts)
