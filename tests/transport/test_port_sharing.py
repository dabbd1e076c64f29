"""Processes with one configuration that listens: the first listens there, the others join it."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack, closing
from pathlib import Path
from typing import Any

import pytest
import zenoh
from hypothesis import given
from hypothesis import strategies as st

from robolink.exceptions import TransportError
from robolink.transport import port_sharing
from robolink.transport.reach import port_of
from robolink.transport.zenoh import ZenohTransport
from tests.support.ports import free_port
from tests.support.transports import GRAPH, until

ALONE: dict[str, Any] = {"scouting": {"multicast": {"enabled": False}}}

PROGRAM = """
import sys
from robolink.transport.zenoh import ZenohTransport
session = ZenohTransport(0, sys.argv[1], {})
token = session.announce("@ros2_lv/0/" + sys.argv[2])
print("ready", flush=True)
sys.stdin.read()
"""


def config(listen: list[str], **more: Any) -> zenoh.Config:
    found: zenoh.Config = zenoh.Config.from_json5(json.dumps(ALONE | {"listen": {"endpoints": listen}} | more))
    return found


def test_only_peers_ports_that_are_fixed_are_relied_on() -> None:
    listed = ["tcp/0.0.0.0:7447", "tls/[::]:0", "tls/[::]:7448#iface=eth0", "udp/0.0.0.0:7449", "unixpipe/a:1"]
    assert port_sharing.fixed_listeners(config(listed)) == [listed[0], listed[2]]
    assert port_sharing.fixed_listeners(config(listed, mode="client")) == []
    assert port_sharing.fixed_listeners(config(listed, mode="router")) == []
    assert port_sharing.fixed_listeners(zenoh.Config()) == []


def test_stepping_aside_leaves_the_port_and_seeks_its_holder() -> None:
    listed = ["tls/[::]:7448#iface=eth0", "tcp/10.0.0.1:0", "tcp/0.0.0.0:7447"]
    found = config(listed, connect={"endpoints": ["tcp/robot:7447"]})
    assert port_sharing.step_aside(found, [listed[0], listed[2]], "a=1") == ["tls/[::1]:7448", "tcp/127.0.0.1:7447"]
    listens = json.loads(found.get_json("listen/endpoints"))
    assert listens[:2] == ["tls/[::]:0#iface=eth0", "tls/[::1]:0#iface=eth0"]
    assert listens[2:] == ["tcp/10.0.0.1:0", "tcp/0.0.0.0:0", "tcp/127.0.0.1:0"]
    sought = ["tls/[::1]:7448#a=1", "tcp/127.0.0.1:7447#a=1", "tcp/robot:7447"]
    assert json.loads(found.get_json("connect/endpoints")) == sought


def test_a_port_is_taken_while_somebody_listens() -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        assert port_sharing.is_taken(f"tcp/127.0.0.1:{port}")
    assert not port_sharing.is_taken(f"tcp/127.0.0.1:{port}")
    for nowhere in ("tcp/192.0.2.77:7", "tcp/no.such.host.invalid:7", "tcp/" + "x" * 300 + ":7", "tcp/\0:7"):
        assert not port_sharing.is_taken(nowhere)


@given(st.text())
def test_any_endpoint_has_a_port_or_none(text: str) -> None:
    assert 0 <= port_of(text) <= 99_999
    assert port_of(f"tcp/127.0.0.1:7447#{text}") == 7447


@pytest.fixture
def shared(tmp_path: Path) -> str:
    """A configuration that listens on a fixed port."""
    path = tmp_path / "shared.json5"
    path.write_text(json.dumps(ALONE | {"listen": {"endpoints": [f"tcp/127.0.0.1:{free_port()}"]}}))
    return str(path)


@pytest.fixture
def processes(shared: str) -> Iterator[list[subprocess.Popen[str]]]:
    """Six processes that were started at the same time with it."""
    with ExitStack() as stack:
        started = []
        for number in range(6):
            command = [sys.executable, "-c", PROGRAM, shared, str(number)]
            child = stack.enter_context(
                subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
            )
            stack.callback(child.kill)
            started.append(child)
        for child in started:
            assert child.stdout
            assert child.stdout.readline() == "ready\n"
        yield started


@pytest.mark.processes
@pytest.mark.usefixtures("patient_looks")
def test_one_file_serves_all_processes_of_a_machine(shared: str, processes: list[subprocess.Popen[str]]) -> None:
    all_of_them = [f"@ros2_lv/0/{number}" for number in range(6)]
    with closing(ZenohTransport(0, shared, {})) as session:
        until(lambda: session.tokens(GRAPH) == all_of_them)


@pytest.mark.processes
@pytest.mark.usefixtures("patient_looks")
def test_whoever_comes_after_the_holder_takes_its_port(shared: str) -> None:
    with closing(ZenohTransport(0, shared, {})) as first, closing(ZenohTransport(0, shared, {})) as second:
        second.announce("@ros2_lv/0/second")
        first.close()
        with closing(ZenohTransport(0, shared, {})) as third:
            until(lambda: third.tokens(GRAPH) == ["@ros2_lv/0/second"])


@pytest.mark.slow
def test_a_stranger_on_the_port_is_named(shared: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robolink.transport.joining.LINK_WITHIN", 0.1)
    (endpoint,) = json.loads(Path(shared).read_text())["listen"]["endpoints"]
    refusal = pytest.raises(TransportError, match=f"^{endpoint} is taken, and who listens there has not let this ")
    with socket.create_server(("127.0.0.1", port_of(endpoint))), refusal:
        ZenohTransport(0, shared, {})


def test_an_overridden_endpoint_serves_all_processes_too() -> None:
    environ = {"ZENOH_CONFIG_OVERRIDE": f'listen/endpoints=["tcp/127.0.0.1:{free_port()}"];connect/endpoints=[]'}
    with closing(ZenohTransport(0, None, environ)) as first, closing(ZenohTransport(0, None, environ)) as second:
        first.announce("@ros2_lv/0/first")
        until(lambda: second.tokens(GRAPH) == ["@ros2_lv/0/first"])


def test_only_one_process_holds_the_port_on_windows(tmp_path: Path) -> None:
    def claim() -> port_sharing.PortClaim:
        return port_sharing.PortClaim(17447, platform="win32", folder=str(tmp_path))

    first, second = claim(), claim()
    assert (first.granted, second.granted) == (True, False)
    second.release()
    assert not claim().granted
    first.release()
    first.release()
    third = claim()
    assert third.granted
    third.release()


def test_a_lock_that_has_outlived_its_process_gives_way_where_nobody_listens(tmp_path: Path) -> None:
    """After a power cut Windows still has it."""
    with socket.socket() as busy:
        busy.bind(("127.0.0.1", 0))
        busy.listen()
        port = busy.getsockname()[1]
        lock = tmp_path / f"robolink-{port}.lock"
        lock.touch()

        def is_granted() -> bool:
            claim = port_sharing.PortClaim(port, platform="win32", folder=str(tmp_path))
            claim.release()
            return claim.granted

        os.utime(lock, (1, 1))
        assert not is_granted()  # somebody listens
        busy.close()
        os.utime(lock)
        assert not is_granted()  # its process may be about to
        os.utime(lock, (1, 1))
        assert is_granted()
    assert not lock.exists()


def test_elsewhere_nothing_needs_to_be_held(tmp_path: Path) -> None:
    claims = [port_sharing.PortClaim(1, platform="linux", folder=str(tmp_path)) for _ in range(2)]
    assert [claim.granted for claim in claims] == [True, True]
    assert not list(tmp_path.iterdir())
