"""Threads inside Zenoh: neither publishers that end while their own process receives nor its exit stumble on them."""

from __future__ import annotations

import queue
import threading
from pathlib import Path

import pytest
import zenoh

from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.transport import lifetime
from robolink.transport.zenoh import ZenohTransport
from tests.support.programs import Program
from tests.support.transports import CHATTER, PATIENCE

LATCHED = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)

CHURN = """
    import sys, threading
    from robolink.qos import DurabilityPolicy, QoSProfile
    from robolink.transport.zenoh import ZenohTransport

    KEY = "0/chatter/std_msgs::msg::dds_::String_/TypeHashNotSupported"
    LATCHED = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    near, far = (ZenohTransport(int(sys.argv[1])) for _ in range(2))
    near.subscribe(KEY, LATCHED, lambda arrived: None)
    stop = threading.Event()


    def flood():
        outlet = far.advertise(KEY, LATCHED)
        while not stop.is_set():
            outlet.put(b"x", b"")


    thread = threading.Thread(target=flood)
    thread.start()
    for _ in range(300):
        near.advertise(KEY, LATCHED).close()
    stop.set()
    thread.join()
    near.close()
    far.close()
    print("done")
"""


@pytest.mark.processes
def test_latched_publishers_come_and_go_while_messages_arrive(tmp_path: Path, domain: int) -> None:
    """Zenoh locks an advanced subscriber while it calls: what it calls must not need Python's lock."""
    with Program(tmp_path, CHURN, domain, str(domain)) as program:
        assert program.line() == "done"


def test_the_exit_waits_for_every_thread_that_is_inside_zenoh(domain: int) -> None:
    """Python's end aborts a process when one of them comes back during it."""
    before = set(threading.enumerate())
    transport = ZenohTransport(domain)
    transport.watch("@ros2_lv/**", lambda token, alive: None)
    transport.subscribe("0/chatter/std_msgs::msg::dds_::String_/TypeHashNotSupported", LATCHED, lambda arrived: None)
    started = set(threading.enumerate()) - before
    assert len(started) == 2
    assert started <= set(lifetime._unfinished)
    transport.close()
    for thread in started:
        thread.join(30.0)
        assert not thread.is_alive()


def test_what_tells_a_latched_topics_last_number_waits_for_no_full_link(domain: int) -> None:
    """Zenoh's own would stop, for 5 s, all that comes by links which its session has dialed."""
    transport = ZenohTransport(domain)
    arrived: queue.SimpleQueue[zenoh.Sample] = queue.SimpleQueue()
    heartbeats = transport.session.declare_subscriber(f"{CHATTER}/@adv/pub/**", arrived.put)
    transport.advertise(CHATTER, LATCHED).put(b"x", b"")
    try:
        heartbeat = arrived.get(timeout=PATIENCE)
        assert heartbeat.congestion_control == zenoh.CongestionControl.DROP
        assert heartbeat.priority == zenoh.Priority.DATA_HIGH  # not in the buffer that images fill
    finally:
        heartbeats.undeclare()  # type: ignore[no-untyped-call]
        transport.close()
