"""Faults of a router's connections: itself, one router twice, nobody, and what else answers instead of a router."""

from __future__ import annotations

import socket

import pytest

from robolink.networks import hosts
from robolink.networks.port_probe import PEER, ROUTER, STRANGER, Port
from robolink.transport.reach import Link
from robolink.transport.router import faults, running


def link(session: str, there: str = "tcp/10.0.0.2:7447") -> Link:
    return Link(ROUTER, "tcp/10.0.0.1:40000", there, session)


@pytest.fixture
def answering(monkeypatch: pytest.MonkeyPatch) -> dict[str, Port]:
    """The sessions that answer, by the name of their host."""
    found: dict[str, Port] = {}
    monkeypatch.setattr(hosts, "seek", lambda host, *_: found.get(host.name))
    return found


def test_who_is_linked_has_no_fault(answering: dict[str, Port]) -> None:
    answering |= {"a": Port(7447, ROUTER, "1a"), "b": Port(7447, ROUTER, "1b")}
    assert faults(["tcp/a:7447", "tcp/b:7447"], "1c", [link("1a"), link("1b")]) == []


def test_nobody_and_somebody_else(answering: dict[str, Port]) -> None:
    answering |= {"b": Port(7447, PEER, "1b"), "c": Port(7447, STRANGER)}
    assert faults(["tcp/a:7447", "tcp/b:7447", "tcp/c:7447"], "1c", []) == [
        "tcp/a:7447: nobody answers there; it is tried again and again",
        "tcp/b:7447: a peer answers, but is not linked",
        "tcp/c:7447: what listens there does not answer as a router does; it is tried again and again",
    ]


def test_two_routers_of_one_id(answering: dict[str, Port]) -> None:
    """Zenoh keeps one link of the two, and says nothing."""
    answering |= {"a": Port(7447, ROUTER, "1a"), "b": Port(7447, ROUTER, "1a")}
    (line,) = faults(["tcp/a:7447", "tcp/b:7447"], "1c", [link("1a")])
    assert line.startswith("tcp/b:7447: is tcp/a:7447 once more, by its id 1a: one of the two is enough")


def test_with_tls_the_link_itself_counts() -> None:
    assert faults(["tls/a:7447"], "1c", [link("1a", "tls/10.0.0.2:7447")]) == []
    assert "with keys of this authority?" in faults(["tls/a:7447"], "1c", [link("1a")])[0]


def test_a_name_that_is_not_known(monkeypatch: pytest.MonkeyPatch) -> None:
    def unknown(*_: object) -> Port:
        raise hosts.UnknownHostError

    monkeypatch.setattr(hosts, "seek", unknown)
    assert faults(["tcp/a:7447"], "1c", []) == [
        "tcp/a:7447: no machine of this name is known; it is tried again and again"
    ]


@pytest.mark.processes  # not that it starts one: it opens a session
def test_a_router_that_connects_to_itself() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        endpoint = f"tcp/127.0.0.1:{server.getsockname()[1]}"
    with running([endpoint], [endpoint]) as it:
        assert it.faults() == [f"{endpoint}: that is this router itself: name another one's address"]
