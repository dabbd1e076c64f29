"""State of STOP, for commands that look at a running system: from the messages that publishers of /e_stop retain."""

from __future__ import annotations

import queue
from collections.abc import Iterable
from typing import Any

from robolink.control.stop_lock import QOS, TOPIC, TYPE
from robolink.exceptions import RobolinkError, SecurityError
from robolink.graph.endpoint import keys_of
from robolink.interfaces.std_msgs.msg import Bool
from robolink.message import decode
from robolink.qos import DurabilityPolicy
from robolink.system import clocks
from robolink.system.waits import get_within
from robolink.transport.base import Transport
from robolink.wire import EndpointKind, EndpointToken, unpack_attachment

HOLDS = f"STOP holds ({TOPIC}), so robots do not move: robolink topic pub --once {TOPIC} Bool 'data: false' releases it"
"""Line that says so, with the way out."""

WITHIN = 0.3
"""Longest wait for what the publishers keep, in seconds; there is none where nobody keeps anything."""


def stop_holds(transport: Transport, ends: Iterable[EndpointToken]) -> bool:
    """Return whether STOP holds: what was said last by who still keeps it.

    Args:
        transport: Network to listen on.
        ends: All that is announced; a keeper is a publisher of /e_stop that is transient local.
    """
    keepers = [each for each in ends if is_keeper(each)]
    if not keepers:
        return False
    arrived: queue.SimpleQueue[Any] = queue.SimpleQueue()
    keys = {key for each in keepers for key in keys_of(each)}
    try:
        handles = [transport.subscribe(key, QOS, arrived.put) for key in sorted(keys)]
    except SecurityError:  # this enclave may not know
        return False
    try:
        values = _values(transport, arrived, len(keepers))
    finally:
        for each in handles:
            each.close()
    return values[max(values)] if values else False


def is_keeper(end: EndpointToken) -> bool:
    """True for a publisher that keeps what it says of STOP for who comes later."""
    latched = end.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL
    return latched and (end.kind, end.name, end.type_name) == (EndpointKind.PUBLISHER, TOPIC, TYPE)


def _values(transport: Transport, arrived: queue.SimpleQueue[Any], keepers: int) -> dict[int, bool]:
    """Return the values by the times at which they were sent, once all keepers were heard, or after a while."""
    found: dict[int, bool] = {}
    heard: set[bytes] = set()
    deadline = clocks.monotonic() + WITHIN
    while len(heard) < keepers and (left := deadline - clocks.monotonic()) > 0:
        try:
            sample = transport.read(get_within(arrived, left))
            sender = unpack_attachment(sample.attachment)
            found[sender.timestamp] = decode(Bool, sample.payload).data
            heard.add(sender.gid)
        except queue.Empty:
            break
        except RobolinkError:  # nonsense says nothing
            continue
    return found
