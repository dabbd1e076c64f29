"""Locks that programs make: in all that code asks of them they are as Python's, but who waits lets time pass."""

from __future__ import annotations

import queue
import subprocess
import sys
import threading

import pytest

from tests.support.hosts import Stage

_AT_MODULE_LEVEL = threading.Lock()


def run(stage: Stage, text: str, *, by_itself: bool = False) -> None:
    program = stage.start("locks", text)
    assert stage.host.run_until(lambda: program.is_over, 100.0)
    assert (program.error, program.returncode) == (None, 0)
    assert any("by itself" in use.what for use in stage.host.real_time_use) == by_itself


def test_they_can_all_that_pythons_can(stage: Stage) -> None:
    text = """
import copy, os, pickle, threading, weakref
for lock in threading.Lock(), threading.RLock():
    assert type(lock).__module__ == "robolink.host.patches.locks"
    assert "unlocked" in repr(lock)
    assert lock.acquire() and lock.acquire(False) == isinstance(lock, type(threading.RLock()))
    assert "<locked" in repr(lock)
    lock._at_fork_reinit()
    assert "unlocked" in repr(lock)
    for wrong in dict(blocking=False, timeout=1.0), dict(timeout=-2.0):
        try:
            lock.acquire(**wrong)
        except ValueError:
            continue
        assert False
    for doubled in copy.copy, copy.deepcopy, pickle.dumps:
        try:
            doubled(lock)
        except TypeError as error:
            assert "cannot pickle" in str(error)
            continue
        assert False
    assert weakref.ref(lock)() is lock and len({lock, lock}) == 1
    try:
        lock.release()
    except RuntimeError:
        continue
    assert False
assert isinstance(threading.Lock(), type(threading.Lock()))
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=threading.Lock()._at_fork_reinit)
lock = threading.Lock()
lock.acquire()
thread = threading.Thread(target=lock.release)  # who has taken it need not be who gives it back
thread.start()
assert lock.acquire(timeout=1.0) and lock.locked()
thread.join()
"""
    run(stage, text)


@pytest.mark.parametrize("make", ["threading.Lock()", "threading.RLock()", "None"])
def test_conditions_on_them_wait_in_virtual_time(stage: Stage, make: str) -> None:
    text = f"""
import threading, time
told, here = threading.Condition({make}), []
def wait(name):
    with told:
        time.sleep(0.5)  # who waits holds it, also when nobody notifies
        assert told.wait_for(lambda: here, timeout=10.0)
        here.append(name)
        time.sleep(0.5)
begin = time.monotonic()
threads = [threading.Thread(target=wait, args=(name,)) for name in "abc"]
for each in threads:
    each.start()
time.sleep(3.0)
with told:
    here.append("main")
    told.notify_all()
for each in threads:
    each.join()
assert here == ["main", "a", "b", "c"]
assert round(time.monotonic() - begin, 6) == 4.5
with told:
    assert not told.wait(timeout=0.25)
assert round(time.monotonic() - begin, 6) == 4.75
"""
    run(stage, text)


def test_what_python_makes_of_locks_waits_in_virtual_time(stage: Stage) -> None:
    text = """
import queue, threading, time
begin, done = time.monotonic(), []
free, meeting, over = threading.BoundedSemaphore(2), threading.Barrier(3), threading.Event()
for made in queue.Queue, queue.LifoQueue, queue.PriorityQueue, queue.SimpleQueue:
    things = made()
    def work(number):
        with free:
            time.sleep(1.0)
        meeting.wait(10.0)
        things.put((number, round(time.monotonic() - begin, 6)))
    for number in range(3):
        threading.Thread(target=work, args=(number,)).start()
    came = sorted(things.get(timeout=10.0) for _ in range(3))
    assert [at for _, at in came] == [2.0 + len(done)] * 3
    done += [made, made]
    try:
        things.get(timeout=0.5)
    except queue.Empty:
        begin += 0.5
full = queue.Queue(1)
def take():
    for _ in range(3):
        time.sleep(1.0)
        full.get()
        full.task_done()
threading.Thread(target=take).start()
for number in range(3):
    full.put(number)
full.join()
threading.Timer(1.0, over.set).start()
assert over.wait(5.0)
assert round(time.monotonic() - begin, 6) == 12.0
"""
    run(stage, text)


@pytest.mark.parametrize("make", ["Lock", "RLock"])
def test_nobody_keeps_one_for_ever_by_taking_it_again_at_once(stage: Stage, make: str) -> None:
    text = f"""
import threading, time
lock, stop = threading.{make}(), []
def again_and_again():
    while not stop:
        with lock:
            time.sleep(0.1)
thread = threading.Thread(target=again_and_again)
thread.start()
for _ in range(10):
    time.sleep(0.05)
    with lock:
        pass
stop.append(True)
thread.join()
"""
    run(stage, text)


def test_they_are_held_around_calls_and_messages(stage: Stage) -> None:
    text = """
import threading
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Int32
from std_srvs.srv import Trigger

class Locks(Node):
    def __init__(self):
        super().__init__("locks")
        self.lock, self.state, self.calls = threading.Lock(), threading.RLock(), 0
        group = ReentrantCallbackGroup()
        self.create_service(Trigger, "ask", self.answer, callback_group=group)
        self.client = self.create_client(Trigger, "ask", callback_group=group)
        self.numbers = self.create_publisher(Int32, "of_locks", 10)
        self.create_subscription(Int32, "of_locks", self.hear, 10, callback_group=group)
        for _ in range(3):
            self.create_timer(0.1, self.tick, callback_group=group)

    def answer(self, request, response):
        with self.state:
            self.get_clock().sleep_for(rclpy.duration.Duration(seconds=0.25))
        response.success = True
        return response

    def hear(self, message):
        with self.state:
            pass

    def tick(self):
        with self.lock, self.state:
            self.numbers.publish(Int32(data=self.calls))
        with self.lock:
            assert self.client.call(Trigger.Request()).success
            self.calls += 1
            if self.calls == 20:
                raise SystemExit(0)

rclpy.init()
executor = MultiThreadedExecutor(4)
executor.add_node(Locks())
executor.spin()
"""
    run(stage, text)


def test_callbacks_of_a_spin_within_a_callback_may_take_its_rlock_once_more(stage: Stage) -> None:
    stage.start("sleeps", "import time\nwhile True:\n    time.sleep(0.03)\n")  # who waits changes the host's threads
    text = """
import threading
import rclpy
from rclpy.node import Node

class Outer(Node):
    def __init__(self):
        super().__init__("outer")
        self.lock, self.seen = threading.RLock(), []
        self.other = rclpy.create_node("other")
        self.other.create_timer(0.1, self.inner)
        self.timer = self.create_timer(0.1, self.tick)

    def tick(self):
        self.timer.cancel()
        future = rclpy.task.Future()
        self.other.create_timer(0.55, lambda: future.set_result(True))
        with self.lock:
            rclpy.spin_until_future_complete(self.other, future)
        raise SystemExit(0 if len(self.seen) >= 5 else 5)

    def inner(self):
        assert self.lock.acquire(timeout=1.0)
        self.seen.append(1)
        self.lock.release()

def main():
    rclpy.init()
    rclpy.spin(Outer())

if __name__ == "__main__":
    main()
"""
    run(stage, text)


def test_a_lock_of_pythons_that_is_held_over_a_wait_is_named(stage: Stage, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(threading, "from_before", _AT_MODULE_LEVEL, raising=False)
    text = """
import threading, time
def hold():
    with threading.from_before:
        time.sleep(1.0)
threading.Thread(target=hold).start()
time.sleep(0.5)
with threading.from_before:
    pass
"""
    run(stage, text, by_itself=True)


@pytest.mark.parametrize("make", ["Lock", "RLock", "Condition"])
def test_threads_that_end_with_their_program_say_nothing_of_locks(stage: Stage, log: list[str], make: str) -> None:
    text = f"""
import threading, time
lock = threading.{make}()
def hold():
    with lock:
        if hasattr(lock, "wait"):
            lock.wait()
        time.sleep(1e6)
for _ in range(5):
    threading.Thread(target=hold, daemon=True).start()
time.sleep(1.0)
with lock if hasattr(lock, "wait") else threading.Condition():
    getattr(lock, "notify_all", str)()
time.sleep(1.0)
"""
    run(stage, text)
    stage.host.run(1.0)
    stage.host.close()
    assert log == []


def test_a_handler_of_pythons_logging_may_wait(stage: Stage) -> None:
    text = """
import logging, threading, time
class Slow(logging.Handler):
    def emit(self, record):
        time.sleep(0.1)
log = logging.getLogger("slow")
log.addHandler(Slow())
log.propagate = False
threads = [threading.Thread(target=log.error, args=("told",)) for _ in range(2)]
for each in threads:
    each.start()
for each in threads:
    each.join()
"""
    run(stage, text, by_itself=True)


@pytest.mark.processes
def test_without_a_host_nothing_is_pythons_no_more(stage: Stage) -> None:
    stage.host.close()
    for function in threading.Condition.__init__, threading.Condition.wait, threading.Thread.start, queue.Queue.get:
        assert not function.__module__.startswith("robolink")
    told = "import robolink, robolink.node, sys; print([each for each in sys.modules if 'robolink.host' in each])"
    done = subprocess.run([sys.executable, "-c", told], capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout == "[]\n"
