"""What topic hz, bw and delay compute with: figures, stamps, and arrivals timed where they arrive."""

from __future__ import annotations

import math
import struct
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Node
from robolink.cli.shared.layout import figures_of
from robolink.cli.topic import meters
from robolink.cli.topic.arrivals import Arrivals
from robolink.exceptions import DecodeError, RobolinkError
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.interfaces.geometry_msgs.msg import Twist, TwistStamped
from robolink.interfaces.std_msgs.msg import Header, Int32, String
from robolink.message import Message, encode
from tests.support.seen_by_commands import a_node_that_commands_see, made
from tests.support.transports import until

MS = 1_000_000


class HeaderLast(Message):
    """A message whose header does not come first."""

    name: str
    header: Header


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


# --- figures --------------------------------------------------------------------------------------------------


def test_the_rate_and_the_gaps_are_those_of_the_times() -> None:
    times = [0, 100 * MS, 200 * MS, 400 * MS]
    assert meters.frequency(times) == pytest.approx(7.5)
    mean, low, high, deviation, number = meters.gaps(times) or (0, 0, 0, 0, 0)
    assert (mean, low, high) == pytest.approx((0.4 / 3, 0.1, 0.2))
    assert deviation == pytest.approx(math.sqrt(2) / 30)
    assert number == 3


def test_the_bandwidth_counts_what_came_after_the_first() -> None:
    assert meters.bandwidth([0, 500 * MS, 1000 * MS], [7_000_000, 1000, 2000]) == 3000.0


@pytest.mark.parametrize("times", [[], [5], [5, 5]])
def test_too_few_messages_have_no_rate(times: list[int]) -> None:
    assert (meters.frequency(times), meters.bandwidth(times, times)) == (None, None)
    assert figures_of([]) is None


@pytest.mark.parametrize(
    ("number", "like", "shown"),
    [(999, 999, "999 B"), (1000, 1000, "1.00 KB"), (50, 1234, "0.05 KB"), (6_220_800, 186e6, "6.22 MB")],
)
def test_bytes_are_spelled_as_in_ros2(number: float, like: float, shown: str) -> None:
    assert meters.as_bytes(number, like) == shown


def test_a_table_is_laid_out_as_in_ros2() -> None:
    assert meters.table(["topic", "rate"], [["/a", "1.000"], ["/image", "30.000"]]) == (
        "topic     rate \n===============\n/a       1.000 \n/image   30.000\n"
    )


def test_a_window_keeps_the_last_and_forgets_what_was_before_time_began_anew() -> None:
    window = meters.Window(3)
    for at in (1, 2, 3, 4):
        window.add(at, at * 10)
    assert window.look() == ([2, 3, 4], [20, 30, 40], 4)
    assert window.look() == ([2, 3, 4], [20, 30, 40], 0)
    window.add(1, 5)
    assert window.look() == ([1], [5], 1)
    assert window.total == 5


@given(st.lists(st.integers(0, 2**62), max_size=50), st.integers(2, 10))
def test_any_times_have_figures_or_none(times: list[int], size: int) -> None:
    window = meters.Window(size)
    for at in times:
        window.add(at, at)
    kept, values, new = window.look()
    assert kept == sorted(kept)
    assert len(kept) == len(values) <= size
    assert new == len(times)
    for figure in (meters.frequency(kept), meters.bandwidth(kept, values)):
        assert figure is None or figure >= 0
    meters._rate(kept, values), meters._bandwidth(kept, values), meters._delay(kept, values)


# --- arrivals -------------------------------------------------------------------------------------------------


class Ticks:
    """A clock that a test sets."""

    now = 0

    def __call__(self) -> int:
        return self.now


def test_a_moment_is_that_of_the_arrival_however_late_it_is_taken(node: Node) -> None:
    clock, release, taken = Ticks(), threading.Event(), []

    def take(content: Any, at: int) -> None:
        release.wait(30)
        taken.append(at)

    publisher = node.create_publisher(Int32, "/x", 10)
    arrivals = Arrivals(node, clock)
    arrivals.listen("/x", lambda _: take)
    for clock.now in range(1000):
        publisher.publish(Int32())
    release.set()
    until(lambda: len(taken) == 1000)
    arrivals.close()
    assert taken == list(range(1000))


def test_nothing_is_dropped_in_a_flood(node: Node) -> None:
    window = meters.Window(100_000)
    publisher = node.create_publisher(Int32, "/x", 10)
    arrivals = Arrivals(node)
    arrivals.listen("/x", lambda _: lambda content, at: window.add(at))
    for _ in range(20_000):
        publisher.publish(Int32())
    until(lambda: window.total == 20_000)
    arrivals.close()
    publisher.publish(Int32())
    assert window.look()[2] == 20_000


def test_publishers_that_come_later_are_heard_in_their_own_type(node: Node) -> None:
    heard: list[str] = []
    arrivals = Arrivals(node)
    arrivals.listen("/x", lambda publisher: lambda content, at: heard.append(publisher.type_name))
    assert node.count_subscribers("/x") == 0
    publishers = [node.create_publisher(Int32, "/x", 10), node.create_publisher(Int32, "/x", 10)]
    publishers.append(made(node.context, "other").create_publisher(String, "/x", 10))  # type: ignore[arg-type]
    arrivals.wait(time.monotonic())
    assert node.count_subscribers("/x") == 2  # one a type
    for publisher in publishers:
        publisher.publish(publisher.msg_type())
    until(lambda: len(heard) == 3)
    arrivals.close()
    assert heard == ["std_msgs/msg/Int32", "std_msgs/msg/Int32", "std_msgs/msg/String"]
    assert node.count_subscribers("/x") == 0


def test_an_error_in_a_take_is_raised_where_somebody_waits(node: Node) -> None:
    def take(content: Any, at: int) -> None:
        raise RobolinkError("broken")

    publisher = node.create_publisher(Int32, "/x", 10)
    arrivals = Arrivals(node)
    arrivals.listen("/x", lambda _: take)
    publisher.publish(Int32())
    with pytest.raises(RobolinkError, match="broken"):
        arrivals.wait(time.monotonic() + 60)
    arrivals.close()


# --- stamps ---------------------------------------------------------------------------------------------------

STAMPED = Header(stamp=TimeMsg(sec=3, nanosec=4))


def big_endian(payload: bytes) -> bytes:
    return b"\x00\x00\x00\x00" + struct.pack(">iI", *struct.unpack_from("<iI", payload, 4)) + payload[12:]


def test_a_stamp_is_read_without_the_rest() -> None:
    payload = encode(TwistStamped(header=STAMPED))
    read = meters.stamp_reader(TwistStamped)
    assert read is meters.first_stamp
    assert [read(payload), read(payload[:12]), read(big_endian(payload))] == [3_000_000_004] * 3


def test_a_header_that_comes_later_is_read_too() -> None:
    assert meters.stamp_reader(HeaderLast)(encode(HeaderLast(name="x", header=STAMPED))) == 3_000_000_004


@pytest.mark.parametrize("message_class", [Twist, Header, String])
def test_a_type_without_a_header_is_refused(message_class: type[Any]) -> None:
    with pytest.raises(meters.NoHeaderError, match="needs a std_msgs/msg/Header named header"):
        meters.stamp_reader(message_class)


@given(st.binary(max_size=20))
def test_any_bytes_have_a_stamp_or_are_refused(payload: bytes) -> None:
    for read in (meters.first_stamp, meters.stamp_reader(HeaderLast)):
        try:
            report = f"{read(payload)} ns"
        except DecodeError as error:
            report = str(error)
        assert "\n" not in report
