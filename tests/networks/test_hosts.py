"""Hosts as they are written, and what answers there: a robolink peer, a router, a stranger or nobody."""

from __future__ import annotations

import json
import socket
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
import zenoh

from robolink.networks import hosts
from robolink.networks.hosts import Host, parse, seek
from robolink.networks.port_probe import PEER, ROUTER, SILENT, STRANGER, Port, listening
from robolink.networks.request import FIRST_PORT
from robolink.transport import network
from robolink.transport.zenoh import ZenohTransport
from tests.support.domains import free_domain


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("robot", Host("robot")),
        ("robot.local:7447", Host("robot.local", 7447)),
        ("10.0.0.1", Host("10.0.0.1")),
        ("tls/robot", Host("robot", tls=True)),
        ("tls/robot:443", Host("robot", 443, tls=True)),
        ("::1", Host("::1")),
        ("[fe80::1%eth0]:80", Host("fe80::1%eth0", 80)),
        ("fe80::1%eth0", Host("fe80::1%eth0")),
    ],
)
def test_hosts(text: str, expected: Host) -> None:
    assert parse(text) == expected


@pytest.mark.parametrize(
    "text", ["", "a/b", "robot:", "robot:0", "robot:65536", "ro bot", "C:\\lab.json5", "-x", "robot:7447#iface=lo", "é"]
)
def test_no_hosts(text: str) -> None:
    assert parse(text) is None


def test_a_peer_is_sought_before_a_router() -> None:
    assert Host("robot").ports(3) == (FIRST_PORT + 3, 7447)
    assert Host("robot", 80).ports(3) == (80,)


def test_endpoints() -> None:
    assert Host("::1").endpoint(7447) == "tcp/[::1]:7447"
    assert Host("robot", tls=True).endpoint(7447) == "tls/robot:7447"


NO_MULTICAST = {"multicast": {"enabled": False}}


def test_nobody_answers() -> None:
    with socket.socket() as bound:  # and does not listen
        bound.bind(("127.0.0.1", 0))
        assert seek(Host("127.0.0.1", bound.getsockname()[1]), 0, within=0.2) is None


def test_somebody_who_does_not_answer() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        assert seek(Host("127.0.0.1", port), 0, within=0.2, silent_within=0.2) == Port(port, SILENT)


def test_a_stranger_at_a_named_port_is_known_at_once() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server, ThreadPoolExecutor(1) as pool:
        port = server.getsockname()[1]

        def hang_up() -> None:
            connection, _ = server.accept()
            with connection:
                connection.sendall(b"SSH-2.0-OpenSSH_9\r\n")

        done = pool.submit(hang_up)
        assert seek(Host("127.0.0.1", port), 0, within=60.0) == Port(port, STRANGER)
        done.result()


def test_one_that_hangs_up_is_asked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A router that has too many connections, or ends and starts again, does so, and answers later."""
    answers = [{7447: Port(7447, STRANGER, hung_up=True)}, {7447: Port(7447, ROUTER, "2")}]
    monkeypatch.setattr(hosts, "listening", lambda *_, **__: answers.pop(0))
    assert seek(Host("127.0.0.1", 7447), 0, within=60.0) == Port(7447, ROUTER, "2")


def test_one_that_hangs_up_is_known() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server, ThreadPoolExecutor(1) as pool:
        port = server.getsockname()[1]
        done = pool.submit(lambda: server.accept()[0].close())
        assert listening([port], 60.0) == {port: Port(port, STRANGER, hung_up=True)}
        done.result()


def test_an_address_of_a_kind_that_this_machine_has_not(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> Any:
        raise OSError("Address family not supported by protocol")

    monkeypatch.setattr(hosts, "_addresses", lambda name, within: [name])
    monkeypatch.setattr(hosts, "listening", refuse)
    assert seek(Host("::1"), 0, within=0.3) is None


def test_what_listens_has_more_time_to_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """A router that was there was not found by clients of a machine on which sixty processes wanted to run."""
    given: list[float] = []

    def slow(_: object, within: float, *__: object, **___: object) -> dict[int, Port]:
        given.append(within)
        return {7447: Port(7447, ROUTER, "2") if within > 2.0 else Port(7447, SILENT)}

    monkeypatch.setattr(hosts, "listening", slow)
    assert seek(Host("127.0.0.1"), 0, within=0.2, silent_within=60.0) == Port(7447, ROUTER, "2")
    assert given == [pytest.approx(0.2, abs=0.1), 2.0, 4.0]


def test_a_name_without_an_address(monkeypatch: pytest.MonkeyPatch) -> None:
    def unknown(*_: object, **__: object) -> Any:
        raise socket.gaierror("Name or service not known")

    monkeypatch.setattr(socket, "getaddrinfo", unknown)
    with pytest.raises(hosts.UnknownHostError):
        seek(Host("robot"), 0)


def test_ipv4_comes_first_and_each_address_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """A robot's name often has an IPv6 address too, at which nodes do not listen."""
    six, four = (socket.AF_INET6, 1, 6, "", ("fe80::1", 0, 0, 2)), (socket.AF_INET, 1, 6, "", ("10.0.0.1", 0))
    monkeypatch.setattr(socket, "getaddrinfo", lambda *_, **__: [six, four, six])
    assert hosts._addresses("robot", 5.0) == ["10.0.0.1", "fe80::1"]


def test_the_peer_is_chosen_where_both_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    peer, router = Port(FIRST_PORT, PEER, "1"), Port(7447, ROUTER, "2")
    monkeypatch.setattr(hosts, "listening", lambda *_, **__: {7447: router, FIRST_PORT: peer})
    assert seek(Host("127.0.0.1"), 0) == peer
    monkeypatch.setattr(hosts, "listening", lambda *_, **__: {7447: router})
    assert seek(Host("127.0.0.1"), 0) == router


@pytest.fixture
def domain() -> Iterator[int]:
    with free_domain() as found:
        yield found


@pytest.mark.processes  # not that it starts one: it opens sessions
def test_a_robolink_session_is_found_and_joined_as_a_peer(domain: int) -> None:
    there = ZenohTransport(domain, "localhost", {})
    try:
        found = network.plan(f"127.0.0.1:{FIRST_PORT + domain}", domain, {})
        assert found.place is not None
        assert (found.place.is_client, found.place.session, found.meets) == (False, there.session_id, True)
    finally:
        there.close()


@pytest.mark.processes
def test_a_router_is_joined_as_a_client(domain: int) -> None:
    port = FIRST_PORT + domain
    config = zenoh.Config.from_json5(
        json.dumps({"mode": "router", "listen": {"endpoints": [f"tcp/127.0.0.1:{port}"]}, "scouting": NO_MULTICAST})
    )
    with zenoh.open(config):
        found = network.plan(f"127.0.0.1:{port}", domain, {})
        assert found.place is not None
        assert (found.place.is_client, found.meets) == (True, False)
        assert found.config().get_json("mode") == '"client"'


def test_with_tls_nothing_is_sent_before_the_handshake() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        assert seek(Host("127.0.0.1", port, tls=True), 0, 5.0) == Port(port, SILENT)
        connection, _ = server.accept()
        with connection:
            assert connection.recv(100) == b""  # it has gone without a word
