"""Capture of network frames (AF_PACKET): counts what passes an interface, apart from what the kernel sends by itself.

    python -m tests.support.frames INTERFACE [--sent]

It prints `ready` once it captures, and for each line of its standard input the frames since the last one, as JSON: how
many there were of each kind; with --sent, only those that this machine sent. Linux, root.
"""

from __future__ import annotations

import json
import select
import socket
import sys
from collections import Counter

KERNEL = "the kernel's own"
"""Kind of the frames by which a kernel looks for neighbours of its IPv6 addresses, whatever programs do."""

_IPV6, _ARP, _IPV4 = 0x86DD, 0x0806, 0x0800
_EVERY_PROTOCOL = 0x0003
_ICMPV6, _HOP_BY_HOP = 58, 0
_NEIGHBOURS = range(133, 137)
"""ICMPv6 types of neighbour discovery."""

_LISTENERS = 143
"""ICMPv6 type of a report of multicast groups (MLDv2)."""

_OWN_GROUP = bytes.fromhex("ff0200000000000000000001ff")
"""Start of the multicast group that belongs to each IPv6 address; programs join others."""


def kind_of(frame: bytes) -> str:
    """Return the kind of an Ethernet frame: KERNEL, or what a person would call it."""
    protocol, packet = int.from_bytes(frame[12:14], "big"), frame[14:]
    if protocol == _ARP:
        return "ARP"  # asked for the first packet to somebody, so that a program is behind it
    if protocol == _IPV4:
        return f"IPv4, protocol {packet[9]}, to {socket.inet_ntop(socket.AF_INET, packet[16:20])}"
    if protocol != _IPV6:
        return f"Ethernet protocol {protocol:#06x}"
    following, rest = packet[6], packet[40:]
    if following == _HOP_BY_HOP:
        following, rest = rest[0], rest[8 * (rest[1] + 1) :]
    if following == _ICMPV6 and (rest[0] in _NEIGHBOURS or (rest[0] == _LISTENERS and _joins_own_groups(rest))):
        return KERNEL
    return f"IPv6, protocol {following}, to {socket.inet_ntop(socket.AF_INET6, packet[24:40])}"


def _joins_own_groups(report: bytes) -> bool:
    """True if a report of multicast groups names none but those of the kernel's own addresses."""
    records, at = int.from_bytes(report[6:8], "big"), 8
    for _ in range(records):
        sources, group = int.from_bytes(report[at + 2 : at + 4], "big"), report[at + 4 : at + 20]
        if not group.startswith(_OWN_GROUP):
            return False
        at += 20 + 16 * sources + 4 * report[at + 1]
    return True


def main() -> None:
    """Count frames, and answer whoever asks."""
    if sys.platform != "linux":
        sys.exit("AF_PACKET is Linux's")
    sent_only = "--sent" in sys.argv
    with socket.socket(socket.AF_PACKET, socket.SOCK_RAW, socket.htons(_EVERY_PROTOCOL)) as capture:
        capture.bind((sys.argv[1], _EVERY_PROTOCOL))
        print("ready", flush=True)  # noqa: T201
        found = Counter[str]()
        while True:
            ready, _, _ = select.select([capture, sys.stdin], [], [])
            if capture in ready:  # first: what came before the question counts
                frame, source = capture.recvfrom(65536)
                if source[2] == socket.PACKET_OUTGOING or not sent_only:
                    found[kind_of(frame)] += 1
            elif not sys.stdin.readline():
                return
            else:
                print(json.dumps(found), flush=True)  # noqa: T201
                found.clear()


if __name__ == "__main__":
    main()
