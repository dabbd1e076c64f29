"""Tokens of assertions of liveliness: what is written can be read, and nothing else."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.exceptions import WireError
from robolink.transport.patterns import matcher
from robolink.wire import assertion_pattern, format_assertion, graph_pattern, parse_assertion

GID = bytes(range(16))


def test_a_token_is_read_as_it_was_written() -> None:
    text = format_assertion(7, "/arm/state", GID, 12)
    assert text == "robolink_alive/7/arm%state/000102030405060708090a0b0c0d0e0f/12"
    assert parse_assertion(text) == GID


def test_the_pattern_is_that_of_one_topic_of_one_domain_and_no_graph_has_them() -> None:
    texts = [format_assertion(domain, topic, GID, 1) for domain in (7, 8) for topic in ("/a", "/a/b")]
    assert list(filter(matcher(assertion_pattern(7, "/a")), texts)) == texts[:1]
    assert not any(map(matcher(graph_pattern(7)), texts))


@given(st.one_of(st.text(), st.text().map("robolink_alive/0/a/".__add__), st.binary().map(lambda raw: raw.hex())))
def test_anything_else_is_refused(text: str) -> None:
    with pytest.raises(WireError):
        parse_assertion(text)


def test_a_gid_that_is_too_short_is_refused() -> None:
    with pytest.raises(WireError, match="a gid"):
        parse_assertion("robolink_alive/0/a/00ff/1")
