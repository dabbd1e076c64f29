"""Whoever connects to a launcher without knowing its words can neither disturb it nor have it do anything."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.exceptions import RobolinkError
from robolink.supervisor.control import client, protocol, server
from robolink.supervisor.control.client import running
from robolink.supervisor.control.protocol import Connection, Request, connect
from robolink.supervisor.control.server import Control
from tests.support.launchers import PATIENCE, FakeSupervisor, the_only


def address_of(launcher: client.Launcher) -> str | int:
    return launcher._registration.address


def says_garbage(connection: socket.socket) -> None:
    connection.sendall(b"GET / HTTP/1.1\r\nHost: robot\r\n\r\n")


def says_without_the_key(connection: socket.socket) -> None:
    line = Connection(connection, "00" * 32, time.monotonic() + PATIENCE)
    with pytest.raises((EOFError, ConnectionError)):
        greeted_and_asked(line)


def greeted_and_asked(line: Connection) -> None:
    line.be_greeted()
    line.ask(Request("stop"))


def says_too_much(connection: socket.socket) -> None:
    try:
        for _ in range(1 << 8):
            connection.sendall(b"x" * (1 << 16))
    except OSError:  # it has hung up by then
        return


def says_half(connection: socket.socket) -> None:
    connection.sendall(b"0123 {")


def says_nothing(connection: socket.socket) -> None:
    return


def wait_for_the_end(connection: socket.socket) -> None:
    try:
        while connection.recv(1 << 16):
            continue
    except ConnectionError:
        return


STRANGERS = [says_garbage, says_without_the_key, says_too_much, says_half, says_nothing]


@pytest.mark.parametrize("behave", STRANGERS)
def test_a_stranger_disturbs_nobody(
    kind: str, behave: Callable[[socket.socket], None], supervisor: FakeSupervisor
) -> None:
    with Control(supervisor, name="follow", patience=PATIENCE):
        launcher = the_only()
        with connect(address_of(launcher), PATIENCE) as connection:
            behave(connection)
            assert launcher.status().nodes == supervisor.nodes
    assert not supervisor.stopped.is_set()


@pytest.mark.parametrize("behave", STRANGERS)
def test_a_stranger_is_hung_up_on(
    kind: str, behave: Callable[[socket.socket], None], supervisor: FakeSupervisor
) -> None:
    with Control(supervisor, name="follow", patience=0.1), connect(address_of(the_only()), PATIENCE) as connection:
        behave(connection)
        wait_for_the_end(connection)


def test_a_hundred_that_say_nothing_only_make_others_wait(
    supervisor: FakeSupervisor, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(client, "ANSWER_WITHIN", PATIENCE)
    with Control(supervisor, name="follow", patience=PATIENCE), ThreadPoolExecutor(1) as pool:
        launcher = the_only()
        silent = [connect(address_of(launcher), PATIENCE) for _ in range(60)]
        nodes = pool.submit(lambda: launcher.status().nodes)
        threads = [each for each in threading.enumerate() if each.name == "control client"]
        assert len(threads) <= server.MOST_CLIENTS
        for each in silent:
            each.close()
        assert nodes.result(PATIENCE) == supervisor.nodes


class Recorder:
    """A socket that notes what is sent."""

    def __init__(self, connection: socket.socket) -> None:
        self.settimeout, self.recv, self._connection = connection.settimeout, connection.recv, connection
        self.sent: list[bytes] = []

    def sendall(self, data: bytes) -> None:
        self.sent.append(data)
        self._connection.sendall(data)


def test_a_question_counts_once(launched: Control, supervisor: FakeSupervisor) -> None:
    launcher = the_only()
    with connect(address_of(launcher), PATIENCE) as connection:
        recorder = Recorder(connection)
        line = Connection(recorder, launcher._registration.key, time.monotonic() + PATIENCE)  # type: ignore[arg-type]
        line.be_greeted()
        line.ask(Request("restart", "world"))
    with connect(address_of(launcher), PATIENCE) as connection:
        connection.sendall(recorder.sent[0])
        wait_for_the_end(connection)
    assert supervisor.restarted == ["world"]


def test_a_line_without_an_end_is_too_long_in_the_end() -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs, ThreadPoolExecutor(1) as pool:
        hearing = pool.submit(Connection(ours, "00", time.monotonic() + PATIENCE).hear)
        theirs.sendall(b"x" * (protocol.LONGEST_QUESTION + 2))
        with pytest.raises(protocol.ProtocolError, match="more than 65536 bytes at once"):
            hearing.result(PATIENCE)


def test_an_end_waits_for_nobody_at_the_door(supervisor: FakeSupervisor) -> None:
    with Control(supervisor, name="follow"):
        silent = [connect(address_of(the_only()), PATIENCE) for _ in range(2 * server.MOST_CLIENTS)]
    assert running() == []
    for each in silent:
        each.close()


def test_a_question_that_this_version_does_not_know_is_hung_up_on(
    launched: Control, supervisor: FakeSupervisor
) -> None:
    class Other(msgspec.Struct):
        ask: str

    launcher = the_only()
    with connect(address_of(launcher), PATIENCE) as connection:
        line = Connection(connection, launcher._registration.key, time.monotonic() + PATIENCE)
        line.be_greeted()
        with pytest.raises(EOFError):
            line.ask(Other("dance"))  # type: ignore[arg-type]
    assert launcher.status().nodes == supervisor.nodes


@given(st.binary(max_size=200))
def test_any_bytes_are_refused_in_order(received: bytes) -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        theirs.sendall(received + b"\n")
        theirs.shutdown(socket.SHUT_WR)
        with pytest.raises((RobolinkError, EOFError, OSError)):
            Connection(ours, "00", time.monotonic() + PATIENCE).hear()
