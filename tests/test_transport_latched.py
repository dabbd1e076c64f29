"""Latched topics over Zenoh: publishers that end while their own process receives do not bring it to a halt."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.programs import Program

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
