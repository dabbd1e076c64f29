"""Programs as rclpy's users write them run in a host unchanged: main(), loops, waits, threads, other executors."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep
from typing import Any

import pytest

from robolink import logging
from robolink.host import Host
from robolink.launch.shared_process import Member
from robolink.system.processes import set_ros_version
from tests.support.hosts import Counter, Listener, Stage, start_files, traced
from tests.support.scripts import CLIENT, MIXED, PARALLEL, SCRIPTS, SERVER, THREADED


def line_of(text: str, words: str) -> int:
    return text[: text.index(words)].count("\n") + 1


def test_a_script_waits_for_a_service_asks_and_sleeps(stage: Stage, log: list[str]) -> None:
    host = stage.host
    listener = host.start_node(Listener)
    client = stage.start("client", CLIENT)
    host.run(1.5)
    server = stage.start("server", SERVER)
    host.run(5.0)
    assert listener.heard == [0, 2, 6, 12, 20]
    assert (client.state, client.returncode, server.state) == ("ended", 3, "running")
    assert "waiting" in log
    assert "took 0.500 s" in log
    assert [(use.program, use.what) for use in host.real_time_use] == [("client", "time.sleep")]
    assert host.real_time_use[0].place == f"{stage.folder / 'client.py'}:{line_of(CLIENT, 'time.sleep')}"


def test_a_spinning_thread_and_a_rate(stage: Stage) -> None:
    listener = stage.host.start_node(Listener)
    program = stage.start("threaded", THREADED)
    stage.host.run(10.0)
    assert (program.state, program.returncode, program.error) == ("ended", 0, None)
    assert listener.times[1] - listener.times[0] == pytest.approx(0.1)
    assert [use.what for use in stage.host.real_time_use] == ["threading.Thread"]


def test_a_multi_threaded_executor_goes_on_while_callbacks_wait(stage: Stage) -> None:
    listener = stage.host.start_node(Listener)
    stage.start("parallel", PARALLEL)
    stage.start("server", SERVER)
    stage.host.run(4.0)
    assert listener.heard == [13110, 23120, 33130]  # 1 + 9 + 100 at the first second, and 13 ticks when it has slept


@pytest.mark.parametrize(
    "loop",
    [
        "while rclpy.ok() and len(heard) < 20: rclpy.spin_once(node, timeout_sec=0.05)",
        "while rclpy.ok() and len(heard) < 20: rclpy.spin_once(node, timeout_sec=0)",
        "while len(heard) < 20: rclpy.spin_once(node)",
        "begin = time.monotonic()\nwhile time.monotonic() - begin < 2.05: rclpy.spin_once(node, timeout_sec=0.01)",
    ],
)
def test_loops_of_spin_once(stage: Stage, loop: str) -> None:
    stage.host.start_node(Counter)
    text = f"""
import time
import rclpy
from std_msgs.msg import Int32
rclpy.init()
node = rclpy.create_node("spins")
heard = []
node.create_subscription(Int32, "numbers", lambda message: heard.append(message.data), 10)
{loop}
assert heard == list(range(1, 21)), heard
"""
    program = stage.start("spins", text)
    stage.host.run(4.0)
    assert (program.error, program.returncode) == (None, 0)


def test_wait_for_message_and_a_nested_spin_in_a_callback(stage: Stage) -> None:
    text = """
import rclpy
from rclpy.node import Node
from rclpy.task import Future
from rclpy.wait_for_message import wait_for_message
from std_msgs.msg import Int32

class Nested(Node):
    def __init__(self):
        super().__init__("nested")
        self.found, self.spun = [], 0
        self.create_timer(0.35, self.look)
        self.create_timer(0.1, self.tick)
        there, message = wait_for_message(Int32, self, "numbers", time_to_wait=5.0)
        self.found.append(message.data)

    def tick(self):
        self.spun += 1

    def look(self):
        before = self.spun
        there, message = wait_for_message(Int32, self, "numbers", time_to_wait=5.0)
        self.found.append(message.data)
        assert self.spun == before
        rclpy.spin_until_future_complete(self, Future(), timeout_sec=0.25)
"""
    stage.host.start_node(Counter)
    program = stage.start("nested", text)
    stage.host.run(2.0)
    assert program.error is None
    node: Any = program.nodes[0]
    assert node.found[:2] == [1, 4]
    assert node.spun > 5


def test_actions_and_transforms_between_threads(stage: Stage) -> None:
    program = stage.start("mixed", MIXED)
    stage.host.run(10.0)
    assert (program.state, program.returncode, program.error) == ("ended", 0, None)


def test_the_callbacks_of_a_script_that_spins_switch_no_threads(stage: Stage) -> None:
    text = """
import rclpy
from tests.support.hosts import Counter, Listener
rclpy.init()
rclpy.spin({kind}())
"""
    stage.start("counter", text.format(kind="Counter"))
    stage.start("listener", text.format(kind="Listener"))
    before = stage.host.scheduler.switches
    stage.host.run(100.0)
    assert stage.host.scheduler.switches - before == 2


def test_what_a_module_took_of_time_before_there_was_a_host(stage: Stage) -> None:
    class Naps(Counter):
        def tick(self) -> None:
            super().tick()
            sleep(0.5)
            self.woke = monotonic()

    node = stage.host.start_node(Naps)
    stage.host.run(0.65)
    assert (node.count, node.woke) == (2, 1.6)
    assert [use.what for use in stage.host.real_time_use] == ["time.sleep"]


def test_the_calendar_is_of_virtual_time_too(stage: Stage) -> None:
    text = """
import time
time.sleep(1.0)
now = 2.0  # time begins at 1 s
assert time.gmtime() == time.gmtime(None) == time.gmtime(now)
assert time.localtime() == time.localtime(now)
assert time.ctime() == time.asctime() == time.ctime(now)
assert time.strftime("%j %S") == time.strftime("%j %S", time.localtime(now))
assert time.strftime("%Y", time.gmtime(1e9)) == "2001" and time.ctime(1e9).endswith("2001")
"""
    program = stage.start("calendar", text)
    assert stage.host.run_until(lambda: program.is_over, 5.0)
    assert (program.error, program.returncode) == (None, 0)


def test_as_often_as_possible_is_every_millisecond(stage: Stage) -> None:
    class Hurries(Counter):
        def __init__(self) -> None:
            super().__init__()
            self.timer.timer_period_ns = 0
            self.timer.reset()

    node = stage.host.start_node(Hurries)
    stage.host.run(0.1)
    assert node.count in (99, 100, 101)


def test_two_programs_of_one_file_share_no_globals(stage: Stage) -> None:
    text = """
from rclpy.node import Node
seen = []

class Counts(Node):
    def __init__(self):
        super().__init__("counts")
        seen.append(1)
        self.seen = seen
"""
    path = stage.write("counts", text)
    one = stage.host.start("one", [Member("one", str(path), [])])
    two = stage.host.start("two", [Member("two", str(path), [])])
    stage.host.restart("one")
    nodes: list[Any] = [*one.nodes, *two.nodes]
    assert [each.seen for each in nodes] == [[1], [1]]


def test_the_command_line_and_the_environment_are_a_programs_own(stage: Stage) -> None:
    text = """
import os, sys, time
import rclpy
for _ in range(3):
    found = (sys.argv[1:], os.environ["SPECIAL"], sys.modules["__main__"].__file__ == __file__)
    assert found == (expected := ([os.environ["SPECIAL"]], sys.argv[1], True)), found
    time.sleep(1.0)
rclpy.init()
node = rclpy.create_node("own", namespace="space")
assert node.get_fully_qualified_name() == "/space/own", node.get_fully_qualified_name()
assert input is not None
try:
    input()
except EOFError:
    sys.exit(5)
"""
    set_ros_version()  # as it is when a program has been loaded, whatever another test has taken out
    argv, environ = sys.argv, dict(os.environ)
    programs = [stage.start(name, text, name, env={"SPECIAL": name}) for name in ("one", "two")]
    assert (sys.argv, dict(os.environ)) == (argv, environ)
    stage.host.run(10.0)
    assert [(each.error, each.returncode) for each in programs] == [(None, 5), (None, 5)]
    assert (sys.argv, dict(os.environ)) == (argv, environ)


def test_log_levels_are_a_programs_own(stage: Stage, log: list[str]) -> None:
    text = """
import sys
import rclpy
rclpy.init()
node = rclpy.create_node(sys.argv[1])
node.get_logger().debug("from " + sys.argv[1])
"""
    stage.start("loud", text, "loud", "--ros-args", "--log-level", "debug")
    stage.start("calm", text, "calm")
    stage.host.run(0.1)
    assert [line for line in log if line.startswith("from")] == ["from loud"]
    logging.set_logger_level("loud", logging.LoggingSeverity.UNSET)


@pytest.mark.processes
def test_a_system_of_scripts_publishes_the_same_bytes_each_time(tmp_path: Path) -> None:
    logging.set_console_handler(None)
    files = []
    for name, text in SCRIPTS.items():
        path = tmp_path / f"{name}.py"
        path.write_text(text)
        files.append(str(path))

    def start(host: Host) -> Any:
        start_files(host, files)

    digest, counts = traced(6.0, start)
    assert counts["/numbers"] == 30
    assert traced(6.0, start)[0] == digest
    command = [sys.executable, "-m", "tests.support.hosts", "6.0", *files]
    found = subprocess.run(
        command, env={**os.environ, "PYTHONHASHSEED": "77"}, capture_output=True, check=True, text=True
    )
    assert found.stdout.split()[0] == digest
