"""A host in real time: programs side by side in threads, and `robolink launch --in-process`."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink import logging
from robolink.exceptions import DocumentError
from robolink.launch import Entry, read_launch_file
from robolink.oneprocess import Host, run
from robolink.oneprocess.parts import Killed
from robolink.oneprocess.threads import end_thread
from tests.hosts import Counter, Listener, Stage
from tests.scripts import CLIENT, SERVER

PATIENCE = 30.0


@pytest.fixture
def host() -> Iterator[Host]:
    logging.set_console_handler(None)
    with Host(virtual=False) as made:
        yield made


def launched(folder: Path, text: str, **files: str) -> list[Entry]:
    for name in ("nodes", "configs"):
        (folder / name).mkdir()
    for name, program in files.items():
        (folder / "nodes" / f"{name}.py").write_text(program)
    path = folder / "configs" / "system.yaml"
    path.write_text(text)
    return list(read_launch_file(path))


def test_nodes_talk_in_real_time(host: Host) -> None:
    counter, listener = host.start_node(Counter), host.start_node(Listener)
    assert host.run_until(lambda: len(listener.heard) >= 3, PATIENCE)
    heard = listener.heard[-3:]
    assert heard == list(range(heard[0], heard[0] + 3))
    assert threading.current_thread() is threading.main_thread()
    host.stop("Counter")
    assert (host.programs["Counter"].state, host.programs["Counter"].returncode) == ("ended", 0)
    assert not counter.context.ok()
    assert host.programs["Listener"].state == "running"


def test_acts_are_done_by_whoever_runs_the_host(host: Host) -> None:
    threads: list[threading.Thread] = []
    host.at(0.05, lambda: threads.append(threading.current_thread()))
    assert host.run_until(lambda: bool(threads), PATIENCE)
    assert threads == [threading.current_thread()]


def test_scripts_end_with_their_exit_codes_and_crashes_stay_their_own(host: Host, tmp_path: Path) -> None:
    stage = Stage(tmp_path, host)
    server = stage.start("server", SERVER)
    client = stage.start("client", CLIENT)
    breaks = stage.start("breaks", "raise ValueError('no')")
    assert host.run_until(lambda: client.is_over and breaks.is_over, PATIENCE)
    assert (client.state, client.returncode) == ("ended", 3)
    assert (breaks.state, breaks.returncode, str(breaks.error)) == ("crashed", 1, "no")
    assert server.state == "running"
    host.crash("server")
    assert (server.state, server.returncode) == ("crashed", -9)
    assert host.restart("server").lives == 2


def test_stop_breaks_into_a_sleep(host: Host, tmp_path: Path) -> None:
    text = "import time\ntry:\n    time.sleep(1e6)\nexcept KeyboardInterrupt:\n    raise SystemExit(7)"
    program = Stage(tmp_path, host).start("sleeps", text)
    host.stop("sleeps")
    assert (program.state, program.returncode) == ("ended", 7)


def test_a_thread_is_ended_where_it_is() -> None:
    there, met = threading.Event(), threading.Event()

    def go_on() -> None:
        try:
            there.set()
            while True:
                pass
        except Killed:
            met.set()

    thread = threading.Thread(target=go_on, daemon=True)
    thread.start()
    assert there.wait(PATIENCE)
    end_thread(thread)
    assert met.wait(PATIENCE)


TRACED = """
import queue, sys, threading
from robolink.oneprocess.threads import end_thread

def go_on():
    print("goes on")

stuck = threading.Thread(target=queue.SimpleQueue().get, daemon=True)
stuck.start()
sys.settrace(lambda *_: None)
end_thread(stuck)
go_on()
"""


def test_a_process_that_is_traced_goes_on_beside_a_thread_that_cannot_be_ended() -> None:
    """As under a debugger, or where coverage is measured: 3.11 would spin at the next call for as long as it takes."""
    done = subprocess.run(
        [sys.executable, "-c", TRACED], capture_output=True, text=True, check=False, timeout=2 * PATIENCE
    )
    assert (done.stdout, done.stderr, done.returncode) == ("goes on\n", "", 0)


def test_a_launch_file_in_one_process_ends_with_its_first_program(tmp_path: Path, log: list[str]) -> None:
    logging.set_console_handler(None)
    text = """
nodes:
  - {node: server}
  - {node: client, start_after: {service: add}}
"""
    assert run(launched(tmp_path, text, server=SERVER, client=CLIENT)) == 3
    assert "waiting" not in log
    assert "interrupted" in log


def test_respawn_until_it_is_given_up(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    logging.set_console_handler(None)
    text = """
nodes:
  - {node: server}
  - {node: fails, respawn: {delay: 0.01, most: 3}}
"""
    assert run(launched(tmp_path, text, server=SERVER, fails="raise SystemExit(4)")) == 4
    assert capsys.readouterr().out.count("[launch] fails ended with exit code 4") == 4


def test_the_duration_ends_it(tmp_path: Path, log: list[str]) -> None:
    logging.set_console_handler(None)
    assert run(launched(tmp_path, "nodes: [{node: server}]", server=SERVER), duration=0.1) == 0
    assert log[-1] == "interrupted"


def test_ctrl_c_ends_the_system_in_order(tmp_path: Path, log: list[str]) -> None:
    logging.set_console_handler(None)
    ready = SERVER.replace("node = Adder()", "node = Adder(); node.get_logger().info('ready')")
    entries = launched(tmp_path, "nodes: [{node: server}]", server=ready)

    def press(record: logging.Record) -> None:
        if record.message == "ready":
            signal.raise_signal(signal.SIGINT)

    logging.add_handler(press)
    try:
        assert run(entries) == 0
    finally:
        logging.remove_handler(press)
    assert log[-1] == "interrupted"


def test_threads_and_callbacks_in_threads_have_their_programs_default_context(tmp_path: Path, log: list[str]) -> None:
    logging.set_console_handler(None)
    assert run(launched(tmp_path, "nodes: [{node: threaded}]", threaded=THREADED)) == 0
    assert sorted(log) == ["pool: True", "thread: True"]


THREADED = """
import threading
import rclpy
from rclpy.executors import MultiThreadedExecutor

rclpy.init()
node = rclpy.create_node("threaded")
told = threading.Event()


def tell(what):
    node.get_logger().info(f"{what}: {rclpy.ok()}")


def tick():
    timer.cancel()
    tell("pool")
    told.set()


thread = threading.Thread(target=tell, args=("thread",))
thread.start()
thread.join()
timer = node.create_timer(0.01, tick)
executor = MultiThreadedExecutor(2)
executor.add_node(node)
while not told.is_set():
    executor.spin_once(timeout_sec=0.1)
"""


def test_the_environment_is_there_while_nodes_are_made(tmp_path: Path, log: list[str]) -> None:
    logging.set_console_handler(None)
    made = "os.environ['WHO'], sys.argv[0][-6:]"
    node_class = f"""
import os, sys
import rclpy
from rclpy.node import Node

class Reader(Node):
    def __init__(self):
        super().__init__("reader")
        self.get_logger().info(str(({made})))
"""
    script = node_class + "rclpy.init()\nnode = Reader()\nrclpy.spin_once(node, timeout_sec=0)\n"
    text = "nodes: [{node: first, env: {WHO: a}}, {node: second, env: {WHO: b}}]"
    arguments = sys.argv
    assert run(launched(tmp_path, text, first=node_class, second=script)) == 0
    assert log[:2] == ["('a', 'rst.py')", "('b', 'ond.py')"]
    assert sys.argv is arguments
    assert "WHO" not in os.environ


def test_who_is_interrupted_while_a_node_is_made_has_not_failed(tmp_path: Path, log: list[str]) -> None:
    logging.set_console_handler(None)
    text = """
from rclpy.node import Node

class Slow(Node):
    def __init__(self):
        super().__init__("slow")
        while self.context.ok():
            pass
        Node("part")
"""
    assert run(launched(tmp_path, "nodes: [{node: slow}]", slow=text), duration=0.2) == 0
    assert log == []


@pytest.mark.skipif(sys.platform == "win32", reason="no Ctrl-C for one process on Windows")
def test_a_callback_that_blocks_in_a_pool_does_not_keep_the_process(tmp_path: Path) -> None:
    launched(tmp_path, "nodes: [{node: blocks}]", blocks=BLOCKS)
    command = [sys.executable, "-m", "robolink", "launch", "configs/system.yaml", "--in-process"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "blocks\n"
        process.send_signal(signal.SIGINT)
        assert process.wait(PATIENCE) == 0


BLOCKS = """
import time
import rclpy
from rclpy.executors import MultiThreadedExecutor

def tick():
    print("blocks", flush=True)
    time.sleep(600)

rclpy.init()
node = rclpy.create_node("blocks")
node.create_timer(0.01, tick)
executor = MultiThreadedExecutor(2)
executor.add_node(node)
try:
    executor.spin()
except KeyboardInterrupt:
    pass
"""


def test_commands_are_refused(tmp_path: Path) -> None:
    entries = launched(tmp_path, f"nodes: [{{run: [{sys.executable}, -V], name: version}}]")
    with pytest.raises(DocumentError, match=r"system\.yaml:1:\d+: .*a command needs a process of its own"):
        run(entries)
