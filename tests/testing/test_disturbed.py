"""Systems under test with faults: messages lost, late and doubled, nodes parted and crashed, clocks that are wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink import logging
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.testing import ExpectationError, System
from tests.counting import Counter, Doubler


def counted(tested: System, seconds: float) -> tuple[list[int], list[float]]:
    """What a doubler hears of a counter, and when."""
    node = tested.start(Doubler)
    tested.start(Counter, parameters={"first": 100})
    tested.run(seconds)
    return node.heard, [(each - 1_000_000_000) / 1e9 for each in node.stamps]


def test_messages_are_lost_for_a_while(tested: System) -> None:
    tested.faults.lose("count", 1.0, during=1.05)
    heard, _ = counted(tested, 2.0)
    assert heard == list(range(110, 120))


def test_messages_come_late_and_twice(tested: System) -> None:
    tested.faults.delay("count", 0.05, receiver="doubler")
    tested.faults.duplicate("count", 1.0, sender="counter")
    heard, times = counted(tested, 0.26)
    assert heard == [100, 100, 101, 101]
    assert times == pytest.approx([0.15, 0.15, 0.25, 0.25])


def test_nodes_are_parted_until_all_is_well_again(tested: System) -> None:
    tested.faults.partition("counter")
    heard, _ = counted(tested, 1.05)
    assert heard == []
    tested.faults.clear()
    tested.run(0.1)
    assert heard == [110]


def test_a_program_crashes_and_comes_back_and_a_clock_is_wrong(tested: System) -> None:
    tested.start(Counter, parameters={"first": 100})
    tested.faults.crash("counter", after=0.55, restart_after=1.0)
    tested.faults.skew("doubler", 100.0)
    node = tested.start(Doubler)
    tested.run(2.0)
    assert node.heard == [100, 101, 102, 103, 104, 100, 101, 102, 103]
    assert node.stamps[0] == 101_100_000_000
    tested.run(0.0)
    assert tested.failures == []


def test_a_service_call_can_be_lost(tested: System) -> None:
    tested.start(Doubler)
    tested.faults.lose("doubler/enable", 1.0, service=True)
    with pytest.raises(ExpectationError, match="/doubler/enable did not answer within 5 s"):
        tested.call(SetBool, "doubler/enable")


def test_a_file_of_faults(tested: System, tmp_path: Path) -> None:
    file = tmp_path / "faults.yaml"
    file.write_text("messages: [{topic: count, loss: 1.0, until: 1.05}]\n")
    tested.faults.read(file)
    heard, _ = counted(tested, 1.5)
    assert heard == list(range(110, 115))


def test_the_same_seed_says_the_same() -> None:
    def run(seed: int) -> list[int]:
        with System(seed=seed) as tested:
            node = tested.start(Doubler)
            tested.faults.lose("count", 0.5)
            for each in range(100, 150):
                tested.publish("count", Int32(data=each))
                tested.run(0.1)
            node_heard: list[int] = node.heard
            return node_heard

    logging.set_console_handler(None)
    assert run(1) == run(1) != run(2)
