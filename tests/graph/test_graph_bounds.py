"""The graph's bounds: how much of what others announce is taken in, and what that takes."""

from __future__ import annotations

import tracemalloc

import pytest

from robolink import Context
from robolink.graph import graph as graph_module
from robolink.graph.graph import Graph
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Int32
from robolink.message import type_hash
from robolink.qos import QoSProfile
from robolink.wire import EndpointKind, EndpointToken, NodeToken, format_token


def _crowd(session: str, count: int, begin: int = 0) -> list[str]:
    """The tokens of so many nodes of a session."""
    nodes = (NodeToken(0, session, str(number), "/", "/", f"n{number}") for number in range(begin, begin + count))
    return [format_token(each) for each in nodes]


def test_a_session_that_announces_too_much_is_told_of_once_and_the_others_are_seen(
    context: Context, log_lines: list[Record], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(graph_module, "MOST_OF_SESSION", 20)
    monkeypatch.setattr(graph_module, "MOST", 30)
    graph = Graph(context.transport, 0)
    crowd, others = _crowd("a1", 25), _crowd("b2", 15)
    assert [graph._on_news(each, True) for each in crowd] == [True] * 20 + [False] * 5
    assert [graph._on_news(each, True) for each in others] == [True] * 10 + [False] * 5
    assert (len(graph.nodes()), graph.too_many) == (30, 10)
    assert graph._on_news(crowd[0], True), "known ones may be told of again"
    (line,) = log_lines
    assert line.message == (
        "session a1 announces more than 20 nodes, topics and services on domain 0: further ones are not seen, that of"
        " /n20 is the first"
    )
    for each in crowd:
        graph._on_news(each, False)
    assert len(graph.nodes()) == 10
    assert all(graph._on_news(each, True) for each in _crowd("a1", 20, begin=100)), "there is room again"
    assert graph._index.of_session == {"a1": 20, "b2": 10}


@pytest.mark.slow
def test_a_token_takes_a_kilobyte(context: Context) -> None:
    graph, texts = Graph(context.transport, 0), []
    for number in range(2000):
        place = ("/", "/", f"n{number // 10}", f"/t{number}", Int32.__ros_type__, type_hash(Int32))
        token = EndpointToken(0, "a1", "1", str(number), EndpointKind.PUBLISHER, *place, QoSProfile(depth=10))
        texts.append(format_token(token))
    tracemalloc.start()
    try:
        for each in texts:
            graph._on_news(each, True)
        assert tracemalloc.get_traced_memory()[0] / len(texts) < 1024
    finally:
        tracemalloc.stop()
    assert len(graph._index.tokens) == 2000
