"""Faults that meet partitions and calls: late, lost and unanswered requests, and the report of what was done."""

from __future__ import annotations

import pytest

from robolink.faults import MessageFault, Partition, Why
from tests.support.faulty import System, arrived, ask, numbers


def test_a_partition_parts_groups_for_a_while() -> None:
    parted = Partition(between=["world", ["viewer", "follower"]], after=0.02, until=0.06)
    assert numbers(arrived(5, parted)) == [0, 3, 4]
    assert numbers(arrived(3, Partition(between=["world", "viewer"]))) == [0, 1, 2]
    assert numbers(arrived(3, Partition(between=["world", "**"]))) == []


def test_a_request_comes_late_and_so_does_its_answer() -> None:
    asked, answers, system = ask(MessageFault(service="/reset", latency=0.1))
    assert (asked, answers) == ([], [])
    system.time.go_on(0.15)
    assert (asked, answers) == ([b"now"], [])
    system.time.go_on(0.1)
    assert [each and each.payload for each in answers] == [b"NOW", None]


@pytest.mark.parametrize(("way", "heard"), [("caller", []), ("server", [b"now"])])
def test_who_asks_waits_when_its_request_or_the_answer_is_lost(way: str, heard: list[bytes]) -> None:
    asked, answers, system = ask(MessageFault(service="/reset", from_=way, loss=1.0))
    system.time.go_on(100.0)
    assert asked == heard
    assert answers == []


def test_who_asks_is_told_when_the_server_that_was_not_reached_goes() -> None:
    system = System()
    system.network.add(Partition(between=["server", "caller"]))
    server = system.program("server")
    server.serve("/reset")
    answers = system.program("caller").client("/reset")(b"now")
    assert answers == []
    server.session.close()
    assert answers == [None]


def test_a_fault_on_a_topic_is_none_on_a_service() -> None:
    _, answers, _ = ask(MessageFault(topic="**", loss=1.0))
    assert len(answers) == 2
    _, answers, _ = ask(MessageFault(loss=1.0))
    assert answers == []


def test_a_call_is_never_doubled() -> None:
    asked, answers, _ = ask(MessageFault(duplication=1.0))
    assert (len(asked), len(answers)) == (1, 2)


def test_a_report_counts_what_was_done() -> None:
    system = System()
    report = system.network.add(MessageFault(topic="/scan", loss=0.5, latency=0.1, after=1.0))
    system.program("follower").hear("/scan")
    publish = system.program("world").publisher("/scan")
    publish(0)
    system.time.go_on(1.0)
    for number in range(100):
        publish(number)
    assert report.met == 100
    assert report.lost + report.late == 100
    expected = f"{{topic: /scan, loss: 0.5, latency: 0.1, after: 1}}: {report.lost} lost, {report.late} late of 100"
    assert str(report) == expected


def test_a_fault_that_met_nothing_is_told_with_the_nearest_name() -> None:
    system = System()
    for fault in (MessageFault(topic="/scann", loss=0.5), MessageFault(from_="follower", to="world", loss=0.5)):
        system.network.add(fault)
    system.program("follower").hear("/scan")
    system.program("world").publisher("/scan")(1)
    system.time.go_on(0.1)
    assert [each.text for each in system.network.unmet()] == [
        "{topic: /scann, loss: 0.5} met nothing: no topic '/scann' was received by any node (did you mean '/scan'?)",
        (
            "{from: follower, to: world, loss: 0.5} met nothing: nothing went that way"
            " (what stays within a process never travels)"
        ),
    ]
    assert [each.why for each in system.network.unmet()] == [Why.WRONG_NAME, Why.IN_VAIN]
