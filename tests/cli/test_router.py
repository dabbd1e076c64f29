"""robolink router: where it listens, who comes and goes, and what it refuses."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator

import pytest
import zenoh

from robolink.cli import router
from robolink.cli.main import main
from robolink.exceptions import TransportError
from robolink.networks.router import endpoint_of, router_settings
from robolink.transport.reach import Link


@pytest.mark.parametrize(
    ("text", "endpoint"),
    [
        ("localhost", "tcp/127.0.0.1:7447"),
        ("lan", "tcp/0.0.0.0:7447"),
        ("subnet", "tcp/0.0.0.0:7447"),
        ("10.0.0.1", "tcp/10.0.0.1:7447"),
        ("[::]:8000", "tcp/[::]:8000"),
        ("tls/gate.example.org:443", "tls/gate.example.org:443"),
        ("tcp/10.0.0.1:8000", "tcp/10.0.0.1:8000"),
        ("quic/10.0.0.1:8000", "quic/10.0.0.1:8000"),
    ],
)
def test_addresses(text: str, endpoint: str) -> None:
    assert endpoint_of(text, "--listen") == endpoint


@pytest.mark.parametrize("text", ["", "a b", "tcp/10.0.0.1", "x/y:1", "host:99999", "off"])
def test_no_addresses(text: str) -> None:
    with pytest.raises(
        TransportError, match=r"--listen: '.*' is not an address: write HOST, HOST:PORT or tls/HOST:PORT"
    ):
        endpoint_of(text, "--listen")


@pytest.mark.parametrize("text", ["lan", "subnet", "0.0.0.0:8000", "[::]", "tls/0.0.0.0", "tcp/[::]:7447"])
def test_a_router_connects_to_none_that_has_no_name(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    """It dialled 0.0.0.0, which is itself."""
    assert main(["router", "--connect", text, "--listen", "127.0.0.1:1"]) == 1
    assert capsys.readouterr().err == (
        f"robolink: --connect: '{text}' is this machine and no other router: name its HOST, such as robot.local "
        "(what opens this router to others is --listen lan)\n"
    )


def test_zenoh_accepts_the_settings() -> None:
    wished = router_settings(["tcp/127.0.0.1:7447"], ["tcp/10.0.0.1:7447"])
    config = zenoh.Config.from_json5(json.dumps(wished))
    assert json.loads(config.get_json("mode")) == "router"
    assert json.loads(config.get_json("scouting/multicast/enabled")) is False
    assert json.loads(config.get_json("routing/router/peers_failover_brokering")) is False


def test_it_says_who_can_reach_it() -> None:
    assert router.opening(["tcp/127.0.0.1:7447"], [])[1].startswith("only this machine reaches it")
    assert router.opening(["tcp/0.0.0.0:7447"], ["tcp/10.0.0.1:7447"])[1:] == [
        "whoever reaches it there may hear and command all nodes behind it (docs/reference/networks.md)",
        "connects to tcp/10.0.0.1:7447",
    ]


def test_it_says_who_gets_in_with_keys() -> None:
    assert router.opening(["tls/0.0.0.0:7447"], ["tls/10.0.0.1:7447"], "/router") == [
        "robolink router: listens at tls/0.0.0.0:7447; Ctrl-C ends it",
        "only enclaves of the keystore of '/router' get in, with their rights (docs/why/security.md)",
        "connects to tls/10.0.0.1:7447",
    ]
    assert router.opening(["tls/127.0.0.1:7447"], [], "/router")[2].startswith("only this machine reaches it")


def test_who_comes_and_goes() -> None:
    peer = Link("peer", "tcp/127.0.0.1:7447", "tcp/127.0.0.1:5000", "aaaaaaaabbbb")
    looks: Iterator[list[Link]] = iter([[], [peer], [peer], []])
    said: list[str] = []
    with pytest.raises(StopIteration):  # the looks are used up
        router.report(lambda: next(looks), said.append, lambda seconds: None)
    whom = "peer aaaaaaaa from tcp/127.0.0.1:5000"
    assert said == [f"+ {whom} (1 connected)", f"- {whom} (0 connected)"]


def test_what_is_wrong_is_said_once() -> None:
    looks: Iterator[list[Link]] = iter([[]] * (3 * router.LINKED_AFTER))
    said: list[str] = []
    with pytest.raises(StopIteration):
        router.report(lambda: next(looks), said.append, lambda seconds: None, lambda: ["nobody answers"])
    assert said == ["WARN nobody answers"]


def test_a_taken_port_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        assert main(["router", "--listen", f"127.0.0.1:{port}"]) == 1
    said = capsys.readouterr().err
    assert said.startswith(f"robolink: tcp/127.0.0.1:{port} is taken, perhaps by another router")
    assert said.count("\n") == 1


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no SIGINT to one process")
def test_it_ends_by_ctrl_c() -> None:
    assert interrupted() == (0, "the router has ended\n", "")


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no SIGINT to one process")
def test_it_ends_by_ctrl_c_where_a_router_it_connects_to_is_silent() -> None:
    """Zenoh waits 10 s for its handshake, and then crashed."""
    with socket.create_server(("127.0.0.1", 0)) as silent:
        code, out, err = interrupted("--connect", f"127.0.0.1:{silent.getsockname()[1]}")
    assert (code, err) == (0, "")
    assert out.endswith("the router has ended\n")


def interrupted(*options: str) -> tuple[int, str, str]:
    """Run a router until Ctrl-C; return its exit code, and what it has said last."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
    command = [sys.executable, "-m", "robolink", "router", "--listen", f"127.0.0.1:{port}", *options]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == f"robolink router: listens at tcp/127.0.0.1:{port}; Ctrl-C ends it\n"
            assert process.stdout.readline().startswith("only this machine")
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=60)
        finally:
            process.kill()
    return process.returncode, out, err
