"""Programs as rclpy's users write them run in a host unchanged: main(), loops, waits, threads, other executors."""

from __future__ import annotations

import os
import random
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from time import monotonic, sleep
from typing import Any

import pytest

from robolink import logging
from robolink.oneprocess import Host, HostError, turns
from tests.hosts import Counter, Listener, Stage, start_files, traced

SERVER = """
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts

class Adder(Node):
    def __init__(self):
        super().__init__("adder")
        self.create_service(AddTwoInts, "add", self.add)

    def add(self, request, response):
        response.sum = request.a + request.b
        return response

def main():
    rclpy.init()
    node = Adder()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        node.get_logger().info("interrupted")
    finally:
        node.destroy_node()
        rclpy.shutdown()

if __name__ == "__main__":
    main()
"""

CLIENT = """
import sys, time
import rclpy
from example_interfaces.srv import AddTwoInts
from std_msgs.msg import Int32

def main():
    rclpy.init()
    node = rclpy.create_node("asker")
    numbers = node.create_publisher(Int32, "numbers", 10)
    client = node.create_client(AddTwoInts, "add")
    while not client.wait_for_service(timeout_sec=1.0):
        node.get_logger().info("waiting")
    begin, total = time.time(), 0
    for n in range(5):
        future = client.call_async(AddTwoInts.Request(a=n, b=n))
        rclpy.spin_until_future_complete(node, future)
        total += future.result().sum
        numbers.publish(Int32(data=total))
        time.sleep(0.1)
    node.get_logger().info(f"took {time.time() - begin:.3f} s")
    rclpy.shutdown()
    return 3

if __name__ == "__main__":
    sys.exit(main())
"""

THREADED = """
import threading
import rclpy
from std_msgs.msg import Int32

rclpy.init()
node = rclpy.create_node("threaded")
numbers = node.create_publisher(Int32, "numbers", 10)
heard = []
node.create_subscription(Int32, "numbers", lambda message: heard.append(message.data), 10)
thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
thread.start()
rate = node.create_rate(10)
for n in range(20):
    numbers.publish(Int32(data=n))
    rate.sleep()
assert heard == list(range(20)), heard
rclpy.shutdown()
thread.join()
"""

PARALLEL = """
import threading, time
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts
from std_msgs.msg import Int32

class Parallel(Node):
    def __init__(self):
        super().__init__("parallel")
        group = ReentrantCallbackGroup()
        self.numbers = self.create_publisher(Int32, "numbers", 10)
        self.client = self.create_client(AddTwoInts, "add", callback_group=group)
        self.client.wait_for_service()
        self.ticks = 0
        self.create_timer(1.0, self.ask, callback_group=group)
        self.create_timer(0.1, self.tick, callback_group=group)

    def tick(self):
        self.ticks += 1

    def ask(self):
        first = self.client.call(AddTwoInts.Request(a=1, b=self.ticks))
        done = threading.Event()
        future = self.client.call_async(AddTwoInts.Request(a=100, b=0))
        future.add_done_callback(lambda _: done.set())
        assert done.wait(5.0)
        time.sleep(0.35)
        self.numbers.publish(Int32(data=first.sum + future.result().sum + 1000 * self.ticks))

def main():
    rclpy.init()
    executor = MultiThreadedExecutor(4)
    executor.add_node(Parallel())
    try:
        executor.spin()
    except KeyboardInterrupt:
        pass

main()
"""


def line_of(text: str, words: str) -> int:
    return text[: text.index(words)].count("\n") + 1


@pytest.fixture
def host() -> Iterator[Host]:
    logging.set_console_handler(None)
    with Host() as made:
        yield made


@pytest.fixture
def stage(tmp_path: Path, host: Host) -> Stage:
    return Stage(tmp_path, host)


@pytest.fixture
def log() -> Iterator[list[str]]:
    lines: list[str] = []

    def note(record: logging.Record) -> None:
        lines.append(record.message)

    logging.add_handler(note)
    yield lines
    logging.remove_handler(note)


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
    from robolink.launch.together import Member

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


def test_all_who_wait_for_ever_are_told_of(stage: Stage) -> None:
    text = """
import rclpy
rclpy.init()
node = rclpy.create_node("lonely")
rclpy.spin(node)
"""
    stage.start("lonely", text)
    with pytest.raises(HostError, match=r"all programs wait for ever.*lonely at .*lonely\.py:5"):
        stage.host.the_turns.wait()
    stage.host.run(5.0)


def test_a_script_that_blocks_is_named(stage: Stage) -> None:
    text = """
import threading
import rclpy
rclpy.init()
node = rclpy.create_node("stuck")
lock = threading.Lock()
lock.acquire()
lock.acquire()
"""
    counter = stage.host.start_node(Counter)
    stage.host.the_turns.patience = 0.3
    with pytest.raises(HostError, match=r"stuck has kept all others waiting for 0\.3 s .*stuck\.py:8"):
        stage.start("stuck", text)
    assert stage.host.programs["stuck"].state == "crashed"
    stage.host.run(1.0)
    assert counter.count == 10


@pytest.mark.parametrize("wait", [lambda host: host.run(10.0), lambda host: host.run_until(lambda: False, 10.0)])
def test_ctrl_c_leaves_code_behind_that_blocks(
    stage: Stage, wait: Callable[[Host], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(turns, "INTERRUPT_PATIENCE", 0.2)
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
    stage.host.the_turns.patience = 0.3
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


def test_a_thread_that_never_began_when_its_program_ends_keeps_nobody(stage: Stage) -> None:
    brief = stage.start("brief", "import threading\nthreading.Thread(target=print, daemon=True).start()")
    counter = stage.host.start_node(Counter)
    stage.host.run(1.0)
    assert (brief.state, counter.count) == ("ended", 10)


def test_a_thread_that_waits_for_a_lock_of_another_is_passed_over(stage: Stage) -> None:
    text = """
import threading, time
lock = threading.Lock()
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


def test_a_pool_of_pythons_works_beside(stage: Stage) -> None:
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


MIXED = """
import threading, time
import rclpy
from rclpy.action import ActionClient, ActionServer
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time
from example_interfaces.action import Fibonacci
from geometry_msgs.msg import TransformStamped
from tf2_ros import Buffer, TransformBroadcaster, TransformListener

class Server(Node):
    def __init__(self):
        super().__init__("server")
        self.server = ActionServer(self, Fibonacci, "fibonacci", self.count)
        self.frames = TransformBroadcaster(self)
        self.create_timer(0.1, self.send)

    def send(self):
        frame = TransformStamped()
        frame.header.stamp = self.get_clock().now().to_msg()
        frame.header.frame_id, frame.child_frame_id = "map", "base"
        self.frames.sendTransform(frame)

    def count(self, goal):
        numbers = [0, 1]
        for _ in range(goal.request.order):
            numbers.append(numbers[-1] + numbers[-2])
            goal.publish_feedback(Fibonacci.Feedback(sequence=numbers))
            time.sleep(0.2)
        goal.succeed()
        return Fibonacci.Result(sequence=numbers)

rclpy.init()
executor = MultiThreadedExecutor(2)
executor.add_node(Server())
threading.Thread(target=executor.spin, daemon=True).start()
asks, goals = rclpy.create_node("asks"), rclpy.create_node("goals")
buffer = Buffer()
listener = TransformListener(buffer, asks, spin_thread=True)
found = buffer.lookup_transform("map", "base", Time(), timeout=Duration(seconds=2.0))
assert found.header.stamp.sec == 1 and found.header.stamp.nanosec == 100000000
client = ActionClient(goals, Fibonacci, "fibonacci")
assert client.wait_for_server(timeout_sec=3.0)
fed = []
sent = client.send_goal_async(Fibonacci.Goal(order=5), feedback_callback=lambda back: fed.append(back))
rclpy.spin_until_future_complete(goals, sent)
result = sent.result().get_result_async()
rclpy.spin_until_future_complete(goals, result)
assert list(result.result().result.sequence) == [0, 1, 1, 2, 3, 5, 8] and len(fed) == 5
assert time.time() == 2.1, time.time()
rclpy.shutdown()
"""


def test_actions_and_transforms_between_threads(stage: Stage) -> None:
    program = stage.start("mixed", MIXED)
    stage.host.run(10.0)
    assert (program.state, program.returncode, program.error) == ("ended", 0, None)


def test_the_callbacks_of_a_script_that_spins_switch_no_threads(stage: Stage) -> None:
    text = """
import rclpy
from tests.hosts import Counter, Listener
rclpy.init()
rclpy.spin({kind}())
"""
    stage.start("counter", text.format(kind="Counter"))
    stage.start("listener", text.format(kind="Listener"))
    before = stage.host.the_turns.switches
    stage.host.run(100.0)
    assert stage.host.the_turns.switches - before == 2


ALL = {"server": SERVER, "client": CLIENT, "threaded": THREADED, "parallel": PARALLEL, "mixed": MIXED}


def test_a_system_of_scripts_publishes_the_same_bytes_each_time(tmp_path: Path) -> None:
    logging.set_console_handler(None)
    files = []
    for name, text in ALL.items():
        path = tmp_path / f"{name}.py"
        path.write_text(text)
        files.append(str(path))

    def start(host: Host) -> Any:
        start_files(host, files)

    digest, counts = traced(6.0, start)
    assert counts["/numbers"] == 30
    assert traced(6.0, start)[0] == digest
    command = [sys.executable, "-m", "tests.hosts", "6.0", *files]
    found = subprocess.run(
        command, env={**os.environ, "PYTHONHASHSEED": "77"}, capture_output=True, check=True, text=True
    )
    assert found.stdout.split()[0] == digest


@pytest.mark.parametrize("seed", range(3))
def test_any_order_of_starts_and_ends_leaves_nothing_behind(tmp_path: Path, seed: int) -> None:
    logging.set_console_handler(None)
    before = threading.active_count()
    drawn = random.Random(seed)
    with Host(seed=seed) as host:
        stage = Stage(tmp_path, host)
        for _ in range(30):
            name = drawn.choice(sorted(ALL))
            program = host.programs.get(name)
            if program is None:
                stage.start(name, ALL[name])
            else:
                drawn.choice([host.stop, host.crash, host.restart, host.interrupt])(name)
                if program.is_over:
                    host.restart(name)
            host.run(drawn.choice([0.0, 0.1, 1.0]))
        assert {each.state for each in host.programs.values()} <= {"running", "ended", "crashed"}
    assert all(each.is_over for each in host.programs.values())
    assert threading.active_count() == before
    assert not host.bus.tokens


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


def test_as_often_as_possible_is_every_millisecond(stage: Stage) -> None:
    class Hurries(Counter):
        def __init__(self) -> None:
            super().__init__()
            self.timer.timer_period_ns = 0
            self.timer.reset()

    node = stage.host.start_node(Hurries)
    stage.host.run(0.1)
    assert node.count in (99, 100, 101)
