"""topic and node commands as processes over Zenoh: they find each other, and end quietly."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.support.commands import PATIENT
from tests.support.programs import PATIENCE, Program
from tests.support.transports import until

pytestmark = pytest.mark.processes

COMMAND = "import sys; from robolink.cli.main import main; sys.exit(main())"


@pytest.fixture
def start(tmp_path: Path, domain: int) -> Callable[..., Program]:
    """Run a command as a process on the domain of this test."""
    return lambda *args: Program(tmp_path, PATIENT, domain, *args)


def test_commands_see_what_other_processes_publish(start: Callable[..., Program]) -> None:
    with start("pub", "/chatter", "String", "{data: hi}", "-r", "50") as talker:
        assert talker.line() == "publisher: beginning loop"
        with (
            start("topic", "echo", "/chatter", "--once") as listener,
            start("topic", "list", "-t") as topics,
            start("node", "list", "--all") as nodes,
        ):
            assert [listener.line(), listener.line(), listener.end()] == ["data: hi", "---", 0]
            assert topics.line() == "/chatter [std_msgs/msg/String]"
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


def test_an_echo_that_waits_says_why_and_ends_quietly(tmp_path: Path, domain: int) -> None:
    with Program(tmp_path, COMMAND, domain, "topic", "echo", "/nothing") as listener:
        until(lambda: listener.errors != [])
        listener.interrupt()
        assert listener.end() == 130
    assert listener.errors == [f"waiting for a publisher of /nothing: nobody publishes it on domain {domain} yet"]


COUNTER = """
import time
import robolink
from robolink.interfaces.std_msgs.msg import Int32

robolink.init()
node = robolink.create_node("counter")
publisher = node.create_publisher(Int32, "/count", 10)
print("ready")
number = 0
while True:
    publisher.publish(Int32(data=number))
    number += 1
    time.sleep(0.002)
"""


def test_hz_loses_nothing_and_its_rate_is_that_of_the_arrivals(
    start: Callable[..., Program], tmp_path: Path, domain: int
) -> None:
    with Program(tmp_path, COUNTER, domain) as counter:
        assert counter.line() == "ready"
        echo = "topic", "echo", "/count", "--csv", "--qos-depth", "10000"  # however long the machine lets it wait
        with start("topic", "hz", "/count", "--json") as meter, start(*echo) as listener:
            found = [json.loads(meter.line()) for _ in range(2)]
            numbers = [int(listener.line()) for _ in range(100)]
            meter.interrupt()
            listener.interrupt()
            assert (meter.end(), listener.end()) == (130, 130)
        counter.kill()
    assert numbers == list(range(numbers[0], numbers[0] + 100))
    for each in found:
        assert each["min"] <= 1 / each["rate"] <= each["max"]
    assert found[1]["window"] == found[0]["new"] + found[1]["new"] - 1
    assert (meter.errors, listener.errors) == ([], [])


def test_a_type_that_only_the_publisher_knows_is_measured(
    start: Callable[..., Program], tmp_path: Path, domain: int
) -> None:
    program = """
    import time
    import robolink
    from robolink.message import Message, float64

    class Gripper(Message):
        force: float64

    robolink.init()
    node = robolink.create_node("gripper")
    publisher = node.create_publisher(Gripper, "/gripper", 10)
    print("ready")
    while True:
        publisher.publish(Gripper(force=2.5))
        robolink.spin_once(node, timeout_sec=0.01)
    """
    with Program(tmp_path, program, domain) as gripper:
        assert gripper.line() == "ready"
        with (
            start("topic", "bw", "/gripper", "--json") as meter,
            start("topic", "echo", "/gripper", "--once", "--filter", "m.force < 3", "--csv") as listener,
            start("pub", "/gripper", "{force: 3}", "-1", "-w", "0") as talker,
        ):
            while (size := json.loads(meter.line())["mean"]) is None:
                pass
            assert size == 12.0
            assert (listener.line(), listener.end()) == ("2.5", 0)
            assert talker.line() == "publisher: beginning loop"
            assert talker.line().endswith("Gripper(force=3.0)")
            assert talker.end() == 0


def test_nonsense_on_standard_input_is_one_line(domain: int) -> None:
    command = [sys.executable, "-m", "robolink", "pub", "/chatter", "String", "--stdin", "-1"]
    environ = os.environ | {"ROS_DOMAIN_ID": str(domain)}
    pipe = subprocess.PIPE
    with ExitStack() as stack:
        talkers = {
            content: stack.enter_context(subprocess.Popen(command, env=environ, stdin=pipe, stdout=pipe, stderr=pipe))
            for content in (b"\x00\xff\xfe" * 1000, b"data: [", b"")
        }
        for content, talker in talkers.items():
            out, err = talker.communicate(content, timeout=PATIENCE)
            assert (talker.returncode, out) == (1, b"")
            assert err.startswith(b"robolink: <standard input>")
            assert err.count(b"\n") == 1


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
