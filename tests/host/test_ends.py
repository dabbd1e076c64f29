"""How programs of a host end: asked to, by Ctrl-C, killed, against their will; and what they leave behind."""

from __future__ import annotations

import random
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from robolink import logging
from robolink.host import Host, scheduler
from robolink.host.participants import Killed
from robolink.host.threads import end_thread
from tests.support.hosts import Counter, Listener, Stage
from tests.support.scripts import SCRIPTS, SERVER

PATIENCE = 30.0


def test_stop_interrupts_a_script_as_ctrl_c_does(stage: Stage, log: list[str]) -> None:
    server = stage.start("server", SERVER)
    stage.host.run(1.0)
    assert [each.get_name() for each in server.nodes] == ["adder"]
    stage.host.stop("server")
    assert (server.state, server.returncode, stage.host.now) == ("ended", 0, 1.0)
    assert "interrupted" in log


@pytest.mark.parametrize("wait", ["time.sleep(1e6)", "client.wait_for_service()", "client.call(AddTwoInts.Request())"])
def test_stop_breaks_into_what_a_script_waits_for(stage: Stage, wait: str) -> None:
    text = f"""
import time
import rclpy
from example_interfaces.srv import AddTwoInts
rclpy.init()
node = rclpy.create_node("waits")
client = node.create_client(AddTwoInts, "add")
own = node.create_service(AddTwoInts, "never", lambda request, response: response)
if "call" in {wait!r}:
    client = node.create_client(AddTwoInts, "never")  # served by itself, and nobody spins
try:
    {wait}
except KeyboardInterrupt:
    raise SystemExit(7)
"""
    program = stage.start("waits", text)
    stage.host.run(2.0)
    assert program.state == "running"
    stage.host.stop("waits")
    assert (program.state, program.returncode, stage.host.now) == ("ended", 7, 2.0)


def test_a_script_that_does_not_obey_is_killed(stage: Stage) -> None:
    text = """
import time
while True:
    try:
        time.sleep(1.0)
    except KeyboardInterrupt:
        pass
"""
    program = stage.start("stubborn", text)
    stage.host.run(3.0)
    stage.host.stop("stubborn")
    assert (program.state, program.returncode, stage.host.now) == ("crashed", -9, 8.0)


@pytest.mark.parametrize(
    ("handler", "returncode"),
    [("told.append(number)", 0), ("told.append(number); raise SystemExit(9)", 9), ("rclpy.shutdown()", 0)],
)
def test_a_handler_of_its_own_gets_the_interrupt(stage: Stage, handler: str, returncode: int) -> None:
    text = f"""
import signal, time
import rclpy
rclpy.init()
told = []
def handle(number, frame):
    {handler}
assert signal.signal(signal.SIGINT, handle) is signal.default_int_handler
while not told and rclpy.ok():
    time.sleep(0.5)
"""
    program = stage.start("handles", text)
    stage.host.run(1.25)
    stage.host.stop("handles")
    assert (program.state, program.returncode, program.error) == ("ended", returncode, None)


def test_a_crash_unwinds_a_script_that_could_not_be_told(stage: Stage) -> None:
    listener = stage.host.start_node(Listener)
    text = """
import rclpy, time
from std_msgs.msg import Int32
rclpy.init()
node = rclpy.create_node("loop")
numbers = node.create_publisher(Int32, "numbers", 10)
try:
    while True:
        numbers.publish(Int32(data=1))
        time.sleep(1.0)
except BaseException:
    numbers.publish(Int32(data=-1))
"""
    program = stage.start("loop", text)
    stage.host.at(2.5, lambda: stage.host.crash("loop"))
    stage.host.at(4.0, lambda: stage.host.restart("loop"))
    stage.host.run(6.5)
    assert listener.heard == [1] * 6
    assert (program.lives, program.state) == (2, "running")


@pytest.mark.slow
@pytest.mark.parametrize("wait", [lambda host: host.run(10.0), lambda host: host.run_until(lambda: False, 10.0)])
def test_ctrl_c_leaves_code_behind_that_blocks(
    stage: Stage, wait: Callable[[Host], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scheduler, "INTERRUPT_PATIENCE", 0.2)
    before = set(threading.enumerate())
    program = stage.start("blocks", BLOCKS_IN_A_CALLBACK)
    with pytest.raises(KeyboardInterrupt):
        wait(stage.host)
    assert program.state == "crashed"
    assert "blocks did not go on after Ctrl-C: it is at" in str(program.error)
    stage.host.run(1.0)
    stage.host.close()  # would never end if the turn were still the callback's
    threads = set(threading.enumerate()) - before
    for each in threads:
        each.join(10.0)
    assert not any(each.is_alive() for each in threads)


BLOCKS_IN_A_CALLBACK = """
import _thread
from rclpy.node import Node

class Blocks(Node):
    def __init__(self):
        super().__init__("blocks")
        self.create_timer(0.5, self.tick)

    def tick(self):
        _thread.interrupt_main()
        while True:
            pass
"""


def test_a_thread_that_never_began_when_its_program_ends_keeps_nobody(stage: Stage) -> None:
    brief = stage.start("brief", "import threading\nthreading.Thread(target=print, daemon=True).start()")
    counter = stage.host.start_node(Counter)
    stage.host.run(1.0)
    assert (brief.state, counter.count) == ("ended", 10)


def test_threads_that_are_left_are_told_of(tmp_path: Path, log: list[str]) -> None:
    text = """
import threading, time
def work():
    while True:
        time.sleep(1.0)
threading.Thread(target=work, name="worker").start()
threading.Thread(target=work, name="daemon", daemon=True).start()
"""
    logging.set_console_handler(None)
    with Host() as host:
        program = Stage(tmp_path, host).start("threads", text)
        host.run(2.0)
        assert (program.state, program.returncode) == ("ended", 0)
    place = f"{tmp_path / 'threads.py'}:5"
    assert [line for line in log if "thread" in line] == [
        f"threads: its thread worker goes on after its end, at {place}"
    ]
    assert not any(each.name in ("worker", "daemon") for each in threading.enumerate())


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_any_order_of_starts_and_ends_leaves_nothing_behind(tmp_path: Path, seed: int) -> None:
    logging.set_console_handler(None)
    before = set(threading.enumerate())
    drawn = random.Random(seed)
    with Host(seed=seed) as host:
        stage = Stage(tmp_path, host)
        for _ in range(30):
            name = drawn.choice(sorted(SCRIPTS))
            program = host.programs.get(name)
            if program is None:
                stage.start(name, SCRIPTS[name])
            else:
                drawn.choice([host.stop, host.crash, host.restart, host.interrupt])(name)
                if program.is_over:
                    host.restart(name)
            host.run(drawn.choice([0.0, 0.1, 1.0]))
        assert {each.state for each in host.programs.values()} <= {"running", "ended", "crashed"}
    assert all(each.is_over for each in host.programs.values())
    assert set(threading.enumerate()) <= before
    assert not host.bus.tokens


@pytest.mark.parametrize("end", [Host.close, lambda host: (host.crash("pool"), host.run(0.0))])
def test_what_waits_in_a_pool_of_pythons_ends_with_its_program(
    stage: Stage, end: Callable[[Host], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    ended = threading.Event()
    monkeypatch.setattr(threading, "told_by_the_pool", ended, raising=False)
    text = """
import threading, time
from concurrent.futures import ThreadPoolExecutor
def work():
    try:
        time.sleep(1e6)
    finally:
        pool.shutdown(wait=False)
        threading.told_by_the_pool.set()
pool = ThreadPoolExecutor(1)
pool.submit(work)
while True:
    time.sleep(0.1)
"""
    stage.start("pool", text)
    stage.host.run(1.0)
    assert not ended.is_set()
    end(stage.host)
    assert ended.wait(30.0), "its thread would keep Python from ending"


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
from robolink.host.threads import end_thread

def go_on():
    print("goes on")

stuck = threading.Thread(target=queue.SimpleQueue().get, daemon=True)
stuck.start()
sys.settrace(lambda *_: None)
end_thread(stuck)
go_on()
"""


@pytest.mark.processes
def test_a_process_that_is_traced_goes_on_beside_a_thread_that_cannot_be_ended() -> None:
    """As under a debugger, or where coverage is measured: 3.11 would spin at the next call for as long as it takes."""
    done = subprocess.run(
        [sys.executable, "-c", TRACED], capture_output=True, text=True, check=False, timeout=2 * PATIENCE
    )
    assert (done.stdout, done.stderr, done.returncode) == ("goes on\n", "", 0)
