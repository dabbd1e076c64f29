"""robolink view, as a process: its address, what it serves, ports in use, and its end."""

from __future__ import annotations

import re
import signal
import socket
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from websockets.sync.client import connect

from robolink import Context, Node, spin_once
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.serialization import serialize_message
from tests.support.bags import ten_messages, write
from tests.support.commands import Command
from tests.support.view_clients import WITHIN, Client

pytestmark = pytest.mark.processes

ADDRESS = re.compile(r"http://localhost:(\d+)/\?token=(\S+)|http://127\.0\.0\.1:(\d+)/\?token=(\S+)")


@contextmanager
def context_on(domain: int) -> Iterator[Context]:
    context = Context()
    context.init(args=[], initialize_logging=False, domain_id=domain)
    try:
        yield context
    finally:
        context.try_shutdown()


def address_of(command: Command) -> tuple[int, str]:
    found = ADDRESS.search(command.wait_for("robolink view: http").text)
    assert found is not None
    port, token = (each for each in found.groups() if each is not None)
    return int(port), token


def test_the_address_opens_the_page_and_ctrl_c_ends_it(domain: int) -> None:
    with Command(domain, "view", "--port", "0", "--no-browser") as command:
        port, token = address_of(command)
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/") as page:
            assert b"<!doctype html>" in page.read().lower()
        with connect(f"ws://127.0.0.1:{port}/?token={token}", subprotocols=["robolink.v1"]) as wire:  # type: ignore[list-item]
            assert not Client(wire).wait_for("serverInfo")["robolink"]["readOnly"]
        command.interrupt()
        assert command.end() in {0, 130}
        assert not any("Traceback" in each.text for each in command.errors)


def test_a_port_in_use_is_one_line_and_without_port_the_next_one_is_taken(domain: int) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with Command(domain, "view", "--port", str(port), "--no-browser") as command:
            assert command.end() == 1
            assert [each.text for each in command.errors] == [
                f"robolink: port {port} is in use: leave --port out, and the next free one is taken"
            ]


def test_an_address_that_is_not_of_this_machine(domain: int) -> None:
    with Command(domain, "view", "--host", "203.0.113.7", "--no-browser") as command:
        assert command.end() == 1
        assert "cannot listen at 203.0.113.7" in command.errors[0].text


def test_beyond_loopback_it_says_what_it_opens_and_asks_for_the_token(domain: int) -> None:
    with Command(domain, "view", "--host", "0.0.0.0", "--port", "0", "--no-browser") as command:
        port, token = address_of(command)
        with pytest.raises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(f"http://127.0.0.1:{port}/")
        refused.value.close()
        assert refused.value.code == 403
        with connect(f"ws://127.0.0.1:{port}/?token={token}", subprotocols=["robolink.v1"]) as wire:  # type: ignore[list-item]
            Client(wire).wait_for("serverInfo")
        assert any("can drive the robots" in each.text for each in command.errors)


@pytest.mark.parametrize("what", ["nothing", "text.mcap"])
def test_a_bag_that_is_none(tmp_path: Path, domain: int, what: str) -> None:
    (tmp_path / "text.mcap").write_text("no bag", encoding="utf-8")
    with Command(domain, "view", "--bag", str(tmp_path / what), "--no-browser") as command:
        assert command.end() == 1
        assert len(command.errors) == 1
        assert what in command.errors[0].text


def test_a_bag_is_shown(tmp_path: Path, domain: int) -> None:
    write(tmp_path / "bag", ten_messages())
    with Command(domain, "view", "--bag", str(tmp_path / "bag"), "--port", "0", "--no-browser") as command:
        port, _ = address_of(command)
        with connect(f"ws://127.0.0.1:{port}/", subprotocols=["foxglove.sdk.v1"]) as wire:  # type: ignore[list-item]
            client = Client(wire)
            assert client.next(client.subscribe("/chatter"))
        if sys.platform != "win32":
            command.process.terminate()
            command.end()


def test_a_launch_shows_its_system_and_goes_on_without_the_view(domain: int) -> None:
    with Command(domain, "launch", "wander", "--view") as command:
        found = ADDRESS.search(command.wait_for("robolink view: http").text)
        assert found is not None
        port, token = (each for each in found.groups() if each is not None)
        with connect(f"ws://127.0.0.1:{port}/?token={token}", subprotocols=["robolink.v1"]) as wire:  # type: ignore[list-item]
            client = Client(wire)
            assert client.next(client.subscribe("/odom"))
        command.interrupt()
        assert command.end() in {0, 130}
        assert command.left() == []


@pytest.mark.skipif(sys.platform == "win32", reason="there a process is ended without being asked")
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_a_server_that_is_terminated_stops_the_robot_that_a_client_drove(domain: int, name: str) -> None:
    number = signal.Signals[name]
    if signal.getsignal(number) is signal.SIG_IGN:
        pytest.skip(f"{name} is ignored here, as nohup has it, and so by all that is started")
    heard: list[float] = []
    with context_on(domain) as context, Command(domain, "view", "--port", "0", "--no-browser") as command:
        robot = Node("robot", context=context)
        robot.create_subscription(Twist, "/cmd_vel", lambda twist: heard.append(twist.linear.x), 10)
        port, token = address_of(command)
        with connect(f"ws://127.0.0.1:{port}/?token={token}", subprotocols=["foxglove.sdk.v1"]) as wire:  # type: ignore[list-item]
            client = Client(wire)
            channel = {"id": 1, "topic": "/cmd_vel", "encoding": "cdr", "schemaName": "geometry_msgs/msg/Twist"}
            client.send("advertise", channels=[channel])
            twist = Twist()
            twist.linear.x = 0.5
            while not heard:  # until the two have found each other
                client.publish(1, serialize_message(twist))
                spin_once(robot, timeout_sec=0.05)
            command.process.send_signal(number)
            begin = time.monotonic()
            while heard[-1] and time.monotonic() - begin < WITHIN:
                spin_once(robot, timeout_sec=0.05)
            assert heard[-1] == 0.0
        command.end()
