"""Systems under test with faults: messages lost, late and doubled, nodes parted and crashed, clocks that are wrong."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from robolink import logging
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.testing import ExpectationError, System
from tests.support.counting import Counter, Doubler


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


# Faults that come to nothing


def in_vain(seconds: float, add: Callable[[System], object]) -> str:
    """What a system says at its end of a fault that it was given."""
    logging.set_console_handler(None)
    told = "fine"
    try:
        with System(seed=7) as tested:
            tested.start(Doubler)
            add(tested)
            tested.start(Counter)
            tested.run(seconds)
    except ExpectationError as error:
        told = str(error).partition("\n")[0]
    return told


@pytest.mark.parametrize(
    ("add", "told"),
    [
        (
            lambda each: each.faults.lose("cuont", 0.5),
            "met nothing: no topic 'cuont' was received by any node (did you mean '/count'?)",
        ),
        (lambda each: each.faults.lose("ada/count", 0.5), "received by any node (did you mean '/count'?)"),
        (lambda each: each.faults.lose(["count", "cuont"], 0.5), "met something, but no topic 'cuont' was received"),
        (
            lambda each: each.faults.delay("doubler/enabel", 0.5, service=True),
            "no service 'doubler/enabel' was received by any node (did you mean '/doubler/enable'?)",
        ),
        (lambda each: each.faults.duplicate("count", 0.5, sender="cuonter"), "no node was ever named 'cuonter' (did"),
        (lambda each: each.faults.delay("count", 1.0, receiver="counter"), "met nothing: nothing went that way"),
        (lambda each: each.faults.partition("doublr"), "met nothing: no node was ever named 'doublr' (did you mean"),
        (lambda each: each.faults.skew("cuonter", 1.0), "no node was ever named 'cuonter' (did you mean 'counter'?)"),
        (lambda each: each.faults.skew("doubler", 1.0), "offset: 1} met nothing: no such node was started with this"),
        (lambda each: (each.faults.lose("cuont", 1.0), each.run(0.1), each.faults.clear()), "no topic 'cuont' was"),
        (lambda each: (each.crash("doubler"), each.faults.crash("doubler")), "the node did not run then"),
    ],
)
def test_a_fault_that_comes_to_nothing_fails_the_test(add: Callable[[System], object], told: str) -> None:
    assert told in in_vain(1.0, add)


@pytest.mark.parametrize(
    "add",
    [
        lambda each: each.faults.lose("count", 1e-9),
        lambda each: each.faults.lose("cuont", 0.0),
        lambda each: each.faults.skew("cuonter"),
        lambda each: each.faults.partition("test"),
        lambda each: each.faults.lose("**/cuont", 0.5),
        lambda each: each.faults.lose("count", 0.5, receiver="robot*"),
        lambda each: each.faults.partition("robot*"),
        lambda each: each.faults.skew("robot*", 1.0),
        lambda each: each.faults.crash("doubler", after=5.0),
        lambda each: (each.faults.lose("count", 1.0), each.run(0.1), each.start(Counter), each.run(1.0)),
    ],
)
def test_a_fault_whose_time_has_not_come_or_that_has_wildcards_does_not(add: Callable[[System], object]) -> None:
    assert in_vain(1.0, add) == "fine"


def test_a_fault_of_a_later_time_is_no_mistake(tested: System, tmp_path: Path) -> None:
    file = tmp_path / "faults.yaml"
    file.write_text("messages: [{topic: cuont, loss: 1.0, after: 60}]\n")
    tested.faults.read(file)
    tested.run(1.0)
    tested.check_faults()


def test_what_goes_wrong_before_is_told_instead() -> None:
    def fail() -> None:
        with System() as tested:
            tested.faults.lose("cuont", 1.0)
            tested.expect("count")

    with pytest.raises(ExpectationError, match="there is no topic /count"):
        fail()


def test_the_faults_of_a_launch_are_there_when_its_nodes_begin(tested: System, tmp_path: Path) -> None:
    launch, faults = tmp_path / "drive.yaml", tmp_path / "faults.yaml"
    launch.write_text("nodes: [{node: world, parameters: {world: corners}}]\n")
    faults.write_text("clocks: [{node: world, offset: 100}]\ncrashes: [{node: world, at: 60}]\n")
    tested.launch(launch, faults=faults)
    assert tested.expect("odom").header.stamp.sec == 101
    tested.check_faults()
