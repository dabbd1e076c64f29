"""A KEEP_ALL subscription tells what was lost on the way to it, and that it does not keep up."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from collections import deque

import pytest

from robolink import Context, Node
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Int32
from robolink.message import encode
from robolink.qos import HistoryPolicy, QoSProfile
from robolink.running.backlog import MOST_LATE, Backlog, Gaps
from robolink.subscription import Subscription
from robolink.transport.base import Outlet, Sample
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import Attachment, pack_attachment
from tests.support.spins import spin_for

KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)
MILLISECOND = 1_000_000


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("slow", context=virtual)
    executor.add_node(made)
    return made


class Sender:
    """A publisher of another process, whose messages may be lost."""

    def __init__(self, bus: Bus, subscription: Subscription[Int32]) -> None:
        transport = MemoryTransport(bus=bus)
        self._outlet: Outlet = transport.advertise(subscription._endpoint.key, subscription.qos_profile)

    def send(self, number: int, gid: bytes = b"a" * 16, apart: int = MILLISECOND) -> None:
        self._outlet.put(encode(Int32(data=number)), pack_attachment(number, number * apart, gid))


def test_what_is_lost_is_told_once_and_counted(
    bus: Bus, node: Node, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    got: list[int] = []
    subscription = node.create_subscription(Int32, "topic", lambda message: got.append(message.data), KEEP_ALL)
    sender = Sender(bus, subscription)
    for number in (5, 6, 9, 10, 14):
        sender.send(number)
        sender.send(number, gid=b"b" * 16)
    spin_for(executor, 0.1)
    assert got == [5, 5, 6, 6, 9, 9, 10, 10, 14, 14]
    assert subscription.lost == 10
    (line,) = log_lines
    assert line.message == (
        "/topic: messages were published that did not arrive, or not in their order (2 so far): this process or its"
        " link stood still, or it took them too slowly (more are only counted, in `Subscription.lost`)"
    )


def test_what_only_comes_late_is_not_lost(
    bus: Bus, node: Node, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    subscription = node.create_subscription(Int32, "topic", lambda _: None, KEEP_ALL)
    sender = Sender(bus, subscription)
    lost = []
    for number in (3, 5, 4, 9, 7, 7, 2, 12, 9, 10):
        sender.send(number)
        spin_for(executor, 0.1)
        lost.append(subscription.lost)
    assert lost == [0, 1, 0, 3, 2, 2, 2, 4, 4, 3]
    assert len(log_lines) == 1


@pytest.mark.slow
def test_a_stranger_with_gaps_costs_neither_memory_nor_time() -> None:
    gaps = Gaps()
    for number in range(2000):
        assert gaps.before(Attachment(number * 100, 0, b"a" * 16)) == (99 if number else 0)
    assert gaps.before(Attachment(2**62, 0, b"a" * 16)) == 2**62 - 199_901
    assert len(gaps._missing) == MOST_LATE


def test_callbacks_side_by_side_lose_nothing(bus: Bus, two: MultiThreadedExecutor, context: Context) -> None:
    """What arrives is counted in its order, whichever thread takes it first."""
    made, got = Node("quick", context=context), list[int]()
    two.add_node(made)
    group = ReentrantCallbackGroup()
    subscription = made.create_subscription(
        Int32, "topic", lambda message: got.append(message.data), KEEP_ALL, callback_group=group
    )
    sender = Sender(bus, subscription)
    for number in range(500):
        sender.send(number)
    while len(got) < 500:
        two.spin_once(timeout_sec=1.0)
    assert subscription.lost == 0


def test_keep_last_counts_nothing(bus: Bus, node: Node, executor: SingleThreadedExecutor) -> None:
    subscription = node.create_subscription(Int32, "topic", lambda _: None, 10)
    sender = Sender(bus, subscription)
    sender.send(1)
    sender.send(9)
    spin_for(executor, 0.1)
    assert subscription.lost == 0


class Slow:
    """A backlog of which nothing is taken."""

    def __init__(self) -> None:
        self.now = 0
        self.waiting: deque[Sample] = deque()
        self.backlog = Backlog("/topic", Gaps(), lambda: self.now)

    def add(self, count: int, gid: bytes = b"a" * 16, apart: int = MILLISECOND, ahead: int = 0, own: int = -1) -> None:
        """Have so many come, which were sent so far apart by a clock that is so far ahead; by ours it is `own`."""
        for _ in range(count):
            self.now += apart if own < 0 else own
            sample = Sample(b"", pack_attachment(len(self.waiting) + 1, self.now + ahead, gid))
            self.backlog.add(sample.attachment, self.waiting)
            self.waiting.append(sample)

    def take_all(self) -> None:
        self.waiting.clear()


def does_not_keep_up(waiting: int, age: str) -> str:
    return (
        f"/topic: the callback does not keep up: {waiting} messages wait, the first of them since {age} s, and KEEP_ALL"
        " keeps them all: make the callback faster, or use KEEP_LAST"
    )


def test_who_does_not_keep_up_is_told_after_a_second_with_a_thousand_and_at_ten_times_as_many() -> None:
    slow = Slow()
    slow.add(25_000)
    assert [*slow.backlog.warnings] == [does_not_keep_up(2000, "2.0"), does_not_keep_up(20_000, "20.0")]


def test_a_burst_is_no_reason_to_warn() -> None:
    slow = Slow()
    for _ in range(3):
        slow.add(5000, apart=MILLISECOND // 10)
        slow.take_all()
        slow.add(900)
    assert not slow.backlog.warnings


def test_what_has_piled_up_while_the_process_stood_still_is_no_reason_to_warn() -> None:
    slow = Slow()
    slow.now = 60_000 * MILLISECOND
    for number in range(15_000):
        slow.add(1, ahead=(number - 15_000) * MILLISECOND, own=0)
    assert not slow.backlog.warnings


def test_clocks_that_differ_are_not_compared() -> None:
    slow = Slow()
    slow.add(10, gid=b"b" * 16, ahead=-(10**18))
    slow.add(3000)
    assert [*slow.backlog.warnings] == [does_not_keep_up(2000, "2.0")]


def test_a_warning_that_another_thread_has_told_already_stops_nobody(
    bus: Bus, node: Node, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    class Raced(deque[str]):
        def __bool__(self) -> bool:
            return True

    subscription = node.create_subscription(Int32, "topic", lambda _: None, KEEP_ALL)
    assert subscription._backlog is not None
    subscription._backlog.warnings = Raced()
    Sender(bus, subscription).send(1)
    spin_for(executor, 0.1)
    assert log_lines == []


def test_a_message_without_ros_2s_attachment_is_refused_when_it_is_taken(
    bus: Bus, node: Node, executor: SingleThreadedExecutor
) -> None:
    subscription = node.create_subscription(Int32, "topic", lambda _: None, KEEP_ALL)
    MemoryTransport(bus=bus).advertise(subscription._endpoint.key, KEEP_ALL).put(encode(Int32()), b"nonsense")
    spin_for(executor, 0.1)
    assert (subscription.malformed, subscription.lost) == (1, 0)


def test_a_thread_that_publishes_is_not_overtaken_between_a_number_and_the_wire(
    node: Node, executor: SingleThreadedExecutor
) -> None:
    got: list[int] = []
    subscription = node.create_subscription(Int32, "topic", lambda message: got.append(message.data), KEEP_ALL)
    publisher = node.create_publisher(Int32, "topic", KEEP_ALL)
    number = publisher._attachment
    other = threading.Thread(target=lambda: publisher.publish(Int32(data=2)))

    def be_slow() -> bytes:
        attachment = number()
        if not other.ident:
            other.start()
            other.join(0.2)  # it does not end before this message is sent
        return attachment

    publisher._attachment = be_slow
    publisher.publish(Int32(data=1))
    other.join()
    spin_for(executor, 0.1)
    assert (got, subscription.lost) == ([1, 2], 0)


FORK = """
import os, signal, threading, warnings
from robolink import Context, Node
from robolink.interfaces.std_msgs.msg import Int32
from robolink.transport.memory import Bus, MemoryTransport

warnings.simplefilter("ignore")
context = Context(transport=MemoryTransport(bus=Bus()))
context.init([])
publisher = Node("node", context=context).create_publisher(Int32, "topic", 10)
held, ended = threading.Event(), threading.Event()

def publish():
    number = publisher._attachment
    publisher._attachment = lambda: (held.set(), ended.wait(), number())[-1]
    publisher.publish(Int32())

other = threading.Thread(target=publish)
other.start()
held.wait()
child = os.fork()
if not child:
    signal.alarm(10)
    ended.set()
    publisher.publish(Int32())
    os._exit(5)
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
ended.set()
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="Windows cannot fork")
@pytest.mark.processes
def test_a_forked_child_does_not_wait_for_a_thread_that_was_publishing() -> None:
    done = subprocess.run([sys.executable, "-c", FORK], capture_output=True, text=True, check=False, timeout=60.0)
    assert (done.stdout, done.stderr) == ("5\n", "")
