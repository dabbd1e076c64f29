"""Tokens of bridges: what is written can be read, and nothing else."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.exceptions import WireError
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import STARTING, BridgeToken, bridge_pattern, format_bridge, graph_pattern, parse_bridge

TOKEN = BridgeToken(7, "abc", "dds", "robot.local", STARTING, "12ef")


def test_a_token_is_read_as_it_was_written() -> None:
    text = format_bridge(TOKEN)
    assert text == "robolink_bridge/7/abc/12ef/dds/starting/robot.local"
    assert parse_bridge(text) == TOKEN
    assert parse_bridge(format_bridge(TOKEN._replace(mark=""))).mark == "abc"


@pytest.mark.parametrize(
    ("host", "shown"),
    [("Ana's PC", "Ana-s-PC"), ("", "-"), ("a/b*c", "a-b-c"), ("x" * 300, "x" * 253), ("máquina", "m-quina")],
)
def test_a_host_may_have_any_name(host: str, shown: str) -> None:
    assert parse_bridge(format_bridge(TOKEN._replace(host=host))).host == shown


def test_the_pattern_is_that_of_one_domain_and_no_graph_has_them() -> None:
    session = MemoryTransport(bus=Bus())
    texts = [format_bridge(TOKEN._replace(domain=domain)) for domain in (7, 8)]
    for text in texts:
        session.announce(text)
    assert session.tokens(bridge_pattern(7)) == texts[:1]
    assert session.tokens(graph_pattern()) == []


@given(st.text() | st.text("@/abdeginrst_01*", max_size=60).map("robolink_bridge/".__add__))
def test_nonsense_is_refused(text: str) -> None:
    try:
        found = parse_bridge(text)
    except WireError:
        return
    assert format_bridge(found) == text
