"""topic and node commands as processes over Zenoh: they find each other, and end quietly."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.programs import PATIENCE, Program
from tests.transports import until

pytestmark = pytest.mark.processes

COMMAND = "import sys; from robolink.cli import main; sys.exit(main())"


@pytest.fixture
def start(tmp_path: Path, domain: int) -> Callable[..., Program]:
    """Run a command as a process on the domain of this test."""
    return lambda *args: Program(tmp_path, COMMAND, domain, *args)


def test_commands_see_what_other_processes_publish(start: Callable[..., Program]) -> None:
    with start("pub", "/chatter", "String", "{data: hi}", "-r", "50") as talker:
        assert talker.line() == "publisher: beginning loop"
        with start("topic", "echo", "/chatter", "--once") as listener:
            assert [listener.line(), listener.line(), listener.end()] == ["data: hi", "---", 0]
        with start("topic", "list", "-t") as topics:
            assert topics.line() == "/chatter [std_msgs/msg/String]"
        with start("node", "list", "--all") as nodes:
            assert nodes.line().startswith("/_robolink_cli_")
        talker.interrupt()
        assert talker.end() == 130
    assert (talker.errors, listener.errors, topics.errors, nodes.errors) == ([], [], [], [])


def test_pub_once_waits_for_an_echo_that_starts_later(start: Callable[..., Program]) -> None:
    with start("pub", "/chatter", "String", "{data: hi}", "-1") as talker:
        assert talker.line() == "Waiting for at least 1 matching subscription(s)..."
        with start("topic", "echo", "/chatter", "String", "--once", "--json") as listener:
            assert (listener.line(), listener.end()) == ('{"data":"hi"}', 0)
        assert talker.end() == 0


def test_an_echo_that_waits_says_why_and_ends_quietly(start: Callable[..., Program], domain: int) -> None:
    with start("topic", "echo", "/nothing") as listener:
        until(lambda: listener.errors != [])
        listener.interrupt()
        assert listener.end() == 130
    assert listener.errors == [f"waiting for a publisher of /nothing: nobody publishes it on domain {domain} yet"]


def test_a_closed_pipe_ends_a_command_quietly(domain: int) -> None:
    command = [sys.executable, "-m", "robolink", "pub", "/chatter", "String", "-r", "100"]
    environ = os.environ | {"ROS_DOMAIN_ID": str(domain)}
    pipe = subprocess.PIPE
    with subprocess.Popen(command, env=environ, stdout=pipe, stderr=pipe, text=True) as talker:
        assert talker.stdout is not None
        assert talker.stderr is not None
        assert talker.stdout.readline() == "publisher: beginning loop\n"
        talker.stdout.close()
        assert talker.wait(PATIENCE) != 0
        assert talker.stderr.read() == ""
