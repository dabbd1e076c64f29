"""Measurements of `robolink top`: rates, sizes and losses of messages, and which process a session is."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import pytest

from robolink import Node
from robolink.cli.shared.session import node_of, opened
from robolink.cli.top.measuring import Meter, sessions_here
from robolink.cli.top.table import Shown
from robolink.interfaces.std_msgs.msg import String
from robolink.transport.reach import Link
from tests.support.seen_by_commands import a_node_that_commands_see, spinning
from tests.support.transports import until


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


@contextlib.contextmanager
def meter(*, with_traffic: bool = True) -> Iterator[Meter]:
    with opened() as context, contextlib.closing(Meter(node_of(context), with_traffic=with_traffic)) as made:
        yield made


def test_what_is_published_is_counted_for_its_topic_and_its_node(node: Node) -> None:
    publisher = node.create_publisher(String, "said", 10)
    node.create_subscription(String, "said", lambda message: None, 10)
    with meter() as measured:
        first = measured.look()
        assert [(each.names, each.rate) for each in first.nodes] == [(("/lab/robot",), None)]
        for _ in range(3):
            publisher.publish(String(data="hello"))
        seen: list[Shown] = []

        def counted() -> bool:
            seen.append(measured.look())
            return sum(row.rate or 0 for row in seen[-1].topics) > 0

        until(counted)
        said = next(each for each in seen[-1].topics if each.name == "/lab/said")
        assert (said.types, said.publishers, said.subscriptions) == (("std_msgs/msg/String",), 1, 1)
        assert said.age is not None
        assert said.age < 30
        assert said.lost == 0
        assert seen[-1].nodes[0].rate == pytest.approx(said.rate)


def test_messages_that_the_publisher_has_numbered_and_that_did_not_come_are_lost(node: Node) -> None:
    publisher = node.create_publisher(String, "said", 10)
    with meter() as measured:
        publisher.publish(String())
        for _ in range(4):
            publisher._attachment()
        publisher.publish(String())
        until(lambda: [each.lost for each in measured.look().topics if each.name == "/lab/said"] == [4])


def test_without_traffic_nothing_is_subscribed_to(node: Node) -> None:
    node.create_publisher(String, "said", 10)
    with meter(with_traffic=False) as measured:
        assert node.count_subscribers("said") == 0
        measured.look()
        row = next(each for each in measured.look().topics if each.name == "/lab/said")
        assert (row.rate, row.bandwidth, row.age, row.publishers) == (None, None, None, 1)


def test_its_own_subscriptions_are_left_out(node: Node) -> None:
    node.create_publisher(String, "said", 10)
    with meter() as measured:
        until(lambda: node.count_subscribers("said") == 1)
        assert [each.subscriptions for each in measured.look().topics if each.name == "/lab/said"] == [0]


def test_a_session_is_the_process_that_holds_the_other_end_of_its_connection() -> None:
    links = [
        Link("peer", "tcp/127.0.0.1:40001", "tcp/127.0.0.1:50001?rel=1", "near"),
        Link("peer", "tcp/[::1]:40002", "tcp/[::1]:50002", "six"),
        Link("peer", "tcp/10.0.0.1:40003", "tcp/10.0.0.2:50003", "far"),
    ]
    holders = {("127.0.0.1:50001", "127.0.0.1:40001"): 11, ("127.0.0.1:40001", "127.0.0.1:50001"): 12}
    assert sessions_here(links, {**holders, ("::1:50002", "::1:40002"): 13}) == {"near": 11, "six": 13}


def test_what_nodes_have_missed_is_shown_beside_what_is_lost_on_the_way_here(node: Node) -> None:
    publisher = node.create_publisher(String, "said", 10)
    node.create_subscription(String, "said", lambda message: None, 2)
    with meter(with_traffic=False) as measured:
        assert [each.missed for each in measured.look().topics if each.name == "/lab/said"] == [0]
        for _ in range(5):
            publisher.publish(String())
        with spinning(node):
            until(lambda: [each.missed for each in measured.look().topics if each.name == "/lab/said"] == [3])
