"""Code that would keep a host's time from passing: it is let go on beside the others, or named in an error."""

from __future__ import annotations

import queue
import threading

import pytest

from robolink.host import HostError
from tests.support.hosts import Counter, Stage

_LOCK, _RLOCK, _QUEUE = threading.Lock(), threading.RLock(), queue.SimpleQueue[int]()


def test_all_who_wait_for_ever_are_told_of(stage: Stage) -> None:
    text = """
import rclpy
rclpy.init()
node = rclpy.create_node("lonely")
rclpy.spin(node)
"""
    stage.start("lonely", text)
    with pytest.raises(HostError, match=r"all programs wait for ever.*lonely at .*lonely\.py:5"):
        stage.host.scheduler.wait()
    stage.host.run(5.0)


@pytest.mark.slow
def test_a_script_that_blocks_is_named(stage: Stage) -> None:
    text = """
import _thread
import rclpy
rclpy.init()
node = rclpy.create_node("stuck")
lock = _thread.allocate_lock()
lock.acquire()
lock.acquire()
"""
    counter = stage.host.start_node(Counter)
    stage.host.scheduler.patience = 0.3
    with pytest.raises(HostError, match=r"stuck has kept all others waiting for 0\.3 s .*stuck\.py:8"):
        stage.start("stuck", text)
    assert stage.host.programs["stuck"].state == "crashed"
    stage.host.run(1.0)
    assert counter.count == 10


@pytest.mark.parametrize(
    "loop",
    [
        "while node.count < 5: time.sleep(0)",
        "end = time.monotonic() + 0.7\nwhile time.monotonic() < end: time.sleep((end - time.monotonic()) / 3)",
        "event = threading.Event()\nwhile node.count < 5: event.wait(0)",
        "thread = threading.Timer(0.7, print)\nthread.start()\nwhile thread.is_alive(): thread.join(0)",
        "while node.count < 5: client.wait_for_service(timeout_sec=0)",
        "full = queue.Queue(1)\nwhile node.count < 5:\n try: full.put(1, timeout=0.3)\n except queue.Full: pass",
    ],
)
def test_loops_that_ask_without_waiting_let_time_pass(stage: Stage, loop: str) -> None:
    program = stage.start("asks", ASKS + loop)
    assert stage.host.run_until(lambda: program.is_over, 2.0)
    assert (program.state, program.error) == ("ended", None)


ASKS = """
import queue, threading, time
import rclpy
from rclpy.node import Node
from std_srvs.srv import Trigger

class Ticks(Node):
    count = 0
    def tick(self):
        self.count += 1

rclpy.init()
node = Ticks("ticks")
node.create_timer(0.1, node.tick)
client = node.create_client(Trigger, "nobody")
threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
"""


def test_messages_that_go_round_without_end_are_named(stage: Stage) -> None:
    stage.host.scheduler.patience = 0.3
    stage.start("echo", ECHO)
    with pytest.raises(HostError, match=r"time has stood still for 0\.3 s of real time: .*, just now echo"):
        stage.host.run(10.0)


ECHO = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32

class Echo(Node):
    def __init__(self):
        super().__init__("echo")
        there, back = self.create_publisher(Int32, "there", 10), self.create_publisher(Int32, "back", 10)
        self.create_subscription(Int32, "there", back.publish, 10)
        self.create_subscription(Int32, "back", there.publish, 10)
        there.publish(Int32())
"""


def test_a_thread_that_waits_by_itself_for_another_is_passed_over_and_named(stage: Stage) -> None:
    text = """
import _thread, threading, time
lock = _thread.allocate_lock()
def hold():
    with lock:
        time.sleep(1.0)
thread = threading.Thread(target=hold)
thread.start()
time.sleep(0.5)
with lock:
    pass
thread.join()
time.sleep(1.0)
"""
    program = stage.start("locks", text)
    assert stage.host.run_until(lambda: program.is_over, 10.0)
    assert (program.error, program.returncode) == (None, 0)
    place = f"{stage.folder / 'locks.py'}:10"
    assert ("locks", "wait by itself (not the same each time)", place) in stage.host.real_time_use


def test_a_pool_of_pythons_works(stage: Stage) -> None:
    text = """
import time
from concurrent.futures import ThreadPoolExecutor
with ThreadPoolExecutor(2) as pool:
    assert list(pool.map(abs, [-1, 2, -3])) == [1, 2, 3]
    assert pool.submit(abs, -4).result() == 4
"""
    program = stage.start("pool", text)
    assert stage.host.run_until(lambda: program.is_over, 10.0)
    assert (program.error, program.returncode) == (None, 0)


@pytest.mark.parametrize("make", ["threading.Lock()", "threading.RLock()", "Lock()", "threading.Condition(Lock())"])
def test_who_waits_for_a_lock_lets_virtual_time_pass(stage: Stage, make: str) -> None:
    text = f"""
import threading, time
from threading import Lock
lock, order = {make}, []
def hold(name):
    with lock:
        time.sleep(1.0)
        order.append((name, time.monotonic()))
def test(begin):
    threads = [threading.Thread(target=hold, args=(name,)) for name in "abc"]
    for each in threads:
        each.start()
        time.sleep(0.1)
    assert not lock.acquire(False)
    if hasattr(lock, "locked"):
        assert lock.locked()
        assert not lock.acquire(timeout=0.2)
        assert abs(time.monotonic() - begin - 0.5) < 1e-6
    for each in threads:
        each.join()
    assert [name for name, _ in order] == ["a", "b", "c"]
    assert [round(at - begin, 6) for _, at in order] == [1.0, 2.0, 3.0]
test(time.monotonic())
"""
    program = stage.start("locks", text)
    assert stage.host.run_until(lambda: program.is_over, 10.0)
    assert (program.error, program.returncode) == (None, 0)
    assert not any("lock" in use.what for use in stage.host.real_time_use)


def test_who_waits_at_a_simple_queue_lets_virtual_time_pass(stage: Stage) -> None:
    text = """
import queue, threading, time
from queue import SimpleQueue
came, begin = SimpleQueue(), time.monotonic()
def take():
    for _ in range(3):
        assert came.get() == round(time.monotonic() - begin, 6)
    try:
        came.get(timeout=0.25)
    except queue.Empty:
        came.put(round(time.monotonic() - begin, 6))
thread = threading.Thread(target=take)
thread.start()
for n in range(1, 4):
    time.sleep(n - (time.monotonic() - begin))
    came.put(float(n))
thread.join()
assert came.get_nowait() == 3.25 and came.empty() and came.qsize() == 0
"""
    program = stage.start("queues", text)
    assert stage.host.run_until(lambda: program.is_over, 10.0)
    assert (program.error, program.returncode) == (None, 0)
    assert not any("by itself" in use.what for use in stage.host.real_time_use)


def test_a_crash_frees_who_waits_for_a_lock(stage: Stage) -> None:
    text = """
import threading, time
lock = threading.Lock()
lock.acquire()
threading.Thread(target=lock.acquire).start()
lock.acquire()
"""
    stage.start("ticking", "import time\nwhile True:\n    time.sleep(0.1)\n")
    program = stage.start("locks", text)
    stage.host.run(1.0)
    assert program.state == "running"
    stage.host.crash("locks")
    stage.host.run(1.0)
    assert not stage.host.scheduler.runners.waiting(program)


def test_locks_and_queues_are_pythons_for_everybody_else(stage: Stage) -> None:
    assert type(threading.Lock()) is type(_LOCK)
    assert type(threading.RLock()) is type(_RLOCK)
    assert type(queue.SimpleQueue()) is type(_QUEUE)
    assert type(threading.Condition()._lock) is type(_RLOCK)  # type: ignore[attr-defined]
