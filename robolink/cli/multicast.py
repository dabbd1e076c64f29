"""robolink multicast: try whether datagrams to a multicast group pass between machines."""

from __future__ import annotations

import socket
import struct
from collections.abc import Callable
from ipaddress import IPv4Address
from typing import Annotated, Any

import typer

from robolink.cli.shared.options import seconds
from robolink.cli.shared.output import say
from robolink.exceptions import RobolinkError
from robolink.system import clocks

app = typer.Typer(no_args_is_help=True, help="Send or receive a multicast packet, to test the network.")

GROUP, PORT = "225.0.0.1", 49150
"""Address and port that ros2's commands have, too."""
_SLICE = 0.25
"""Longest single wait, in seconds: on Windows Ctrl-C does not end a wait."""


class MulticastError(RobolinkError, OSError):
    """A datagram cannot be sent or received."""


def _checked_group(group: str) -> str:
    try:
        is_group = IPv4Address(group).is_multicast
    except ValueError:
        is_group = False
    if not is_group:
        raise typer.BadParameter(f"'{group[:50]}' is not a multicast address: 224.0.0.0 to 239.255.255.255")
    return group


Group = Annotated[
    str, typer.Option("--group", metavar="ADDRESS", help="Multicast group address.", callback=_checked_group)
]
Port = Annotated[int, typer.Option("--port", min=1, max=65535, help="Multicast port.")]


@app.command("send")
def send(
    group: Group = GROUP,
    port: Port = PORT,
    ttl: Annotated[int, typer.Option("--ttl", min=0, max=255, help="Multicast TTL: 1 stays on this network.")] = 1,
) -> None:
    """Send one UDP multicast packet."""
    say("Sending one UDP multicast datagram...")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, ttl)
        _tried(lambda: sender.sendto(b"Hello World!", (group, port)), f"cannot send to {group}:{port}")


@app.command("receive")
def receive(
    group: Group = GROUP,
    port: Port = PORT,
    timeout: Annotated[float, seconds("--timeout", "Longest time to wait, in seconds; 0 for no limit.")] = 0.0,
) -> None:
    """Wait for one UDP multicast packet, and print it."""
    say("Waiting for UDP multicast datagram...")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver:
        receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        _tried(lambda: _join(receiver, group, port), f"cannot listen at {group}:{port}")
        data, (host, source) = _awaited(receiver, timeout or float("inf"))
    say(f"Received from {host}:{source}: {data.decode('utf-8', errors='replace')!r}")


def _join(receiver: socket.socket, group: str, port: int) -> None:
    receiver.bind(("", port))
    receiver.setsockopt(
        socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, struct.pack("4sL", socket.inet_aton(group), socket.INADDR_ANY)
    )


def _awaited(receiver: socket.socket, timeout: float) -> tuple[bytes, tuple[str, int]]:
    deadline = clocks.monotonic() + timeout
    while (left := deadline - clocks.monotonic()) > 0:
        receiver.settimeout(min(left, _SLICE))
        try:
            data, address = receiver.recvfrom(4096)
        except TimeoutError:
            continue
        return data, (address[0], address[1])
    raise MulticastError(f"nothing came within {timeout:g} s: is multicast allowed between the machines?")


def _tried(act: Callable[[], Any], what: str) -> None:
    try:
        act()
    except OSError as error:
        raise MulticastError(f"{what}: {error.strerror or error}") from None
