"""topic hz, bw and delay as commands: ros2's output, JSON, sim time, and what is said when nothing comes."""

from __future__ import annotations

import itertools
import json
import re
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from robolink import Node
from robolink.cli.main import main
from robolink.cli.shared.output import say_json
from robolink.cli.topic import meters
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.interfaces.geometry_msgs.msg import TwistStamped
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.interfaces.std_msgs.msg import Header, Int32, String
from robolink.message import encode
from robolink.wire import EndpointKind
from tests.support.seen_by_commands import a_node_that_commands_see, latch, made, press_ctrl_c, when_said

Captured = pytest.CaptureFixture[str]
MS = 1_000_000
STAMPED = Header(stamp=TimeMsg(sec=3, nanosec=4))


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


# --- the commands ---------------------------------------------------------------------------------------------


@pytest.fixture
def publishing(node: Node, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., None]]:
    """Publish something every 5 ms until the end, from a thread: `publishing(topic, make)`."""
    monkeypatch.setattr(meters, "PERIOD", 0.1)
    end, threads = threading.Event(), []

    def start(topic: str, make: Callable[[], Any]) -> None:
        publisher = node.create_publisher(type(make()), topic, 10)

        def publish() -> None:
            while not end.wait(0.005):
                publisher.publish(make())

        threads.append(threading.Thread(target=publish))
        threads[-1].start()

    yield start
    end.set()
    for thread in threads:
        thread.join()


def until_said(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    """Press Ctrl-C once this has been said."""
    for function in ("say", "tell"):
        when_said(monkeypatch, meters, function, lambda said: press_ctrl_c(said) if text in said else None)


RATE = r"average rate: (\d+\.\d{3})\n\tmin: (\d\.\d{3})s max: (\d\.\d{3})s std dev: (\d\.\d{5})s window: (\d+)\n"


def test_hz_says_the_rate_as_ros2_does(
    publishing: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    publishing("/x", Int32)
    grown = re.compile(r"window: (?!1$)")  # on a busy machine only two messages may have come at first
    when_said(monkeypatch, meters, "say", lambda said: press_ctrl_c(said) if grown.search(said) else None)
    assert main(["topic", "hz", "/x"]) == 130
    out, err = capsys.readouterr()
    assert err == ""
    *_, match = re.finditer(RATE, out)
    assert out.endswith(match[0])
    rate, low, high, _, window = map(float, match.groups())
    assert rate < 201  # the thread sleeps 5 ms at least
    assert 0.005 <= low <= 1 / rate + 0.0006 <= high + 0.0012  # they are rounded to milliseconds
    assert window >= 2


def test_several_topics_make_a_table(
    publishing: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    publishing("/a", Int32)
    publishing("/long/name", String)
    # On a busy machine one of them may come first, in a table of its own.
    when_said(monkeypatch, meters, "say", lambda said: press_ctrl_c(said) if said.count("\n") == 4 else None)
    assert main(["topic", "hz", "/a", "/long/name", "/a"]) == 130
    lines = capsys.readouterr().out.splitlines()
    assert lines[:2] == ["Subscribed to [/a]", "Subscribed to [/long/name]"]
    del lines[2:-5]
    assert lines[2].split() == ["topic", "rate", "min_delta", "max_delta", "std_dev", "window"]
    assert set(lines[3]) == {"="}
    assert [line.split()[0] for line in lines[4:6]] == ["/a", "/long/name"]
    assert len({len(line) for line in lines[2:6]}) == 1


@pytest.mark.parametrize("verb", ["hz", "bw"])
def test_all_topics_are_measured_new_ones_too(
    verb: str, publishing: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    publishing("/a", Int32)
    publishing("/_hidden", Int32)
    came: list[bool] = []

    def on_said(said: str) -> None:
        rows = [line.split()[0] for line in said.splitlines()[2:]]
        if "/a" in rows and not came:
            came.append(True)
            publishing("/new", String)
        elif rows == ["/a", "/new"]:
            press_ctrl_c(said)

    when_said(monkeypatch, meters, "say", on_said)
    assert main(["topic", verb, "--all"]) == 130
    out, err = capsys.readouterr()
    assert err == ""
    assert "Subscribed" not in out
    assert "/_hidden" not in out
    assert "\x1b" not in out  # not a terminal


def test_a_filter_counts_only_what_passes(
    publishing: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    count = itertools.count()
    publishing("/x", lambda: Int32(data=next(count)))
    until_said_json(monkeypatch, lambda found: found["rate"] is not None)
    assert main(["topic", "hz", "/x", "--filter", "m.data % 2 == 0", "--json"]) == 130
    found = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert found["min"] > 0.0099


def test_json_is_a_line_a_period(
    publishing: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    publishing("/x", Int32)
    until_said_json(monkeypatch, lambda found: found["new"] > 1)
    assert main(["topic", "hz", "/x", "/nothing", "--json"]) == 130
    found = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert {each["topic"] for each in found} <= {"/x", "/nothing"}
    keys = {"topic", "rate", "min", "max", "std_dev", "window", "new"}
    assert all(set(each) == keys for each in found)
    assert found[-1]["min"] * 0.999 < 1 / found[-1]["rate"] < found[-1]["max"] * 1.001


def until_said_json(monkeypatch: pytest.MonkeyPatch, condition: Callable[[Any], bool]) -> None:
    original = say_json

    def speak(value: Any) -> None:
        original(value)
        if condition(value):
            raise KeyboardInterrupt

    monkeypatch.setattr(meters, "say_json", speak)


def test_bw_says_bytes_as_ros2_does(
    publishing: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    image = Image(data=bytes(100_000))
    size = len(encode(image)) / 1e6
    publishing("/image", lambda: image)
    until_said(monkeypatch, "MB/s")
    assert main(["topic", "bw", "/image"]) == 130
    out = capsys.readouterr().out
    each = f"{size:.2f} MB"
    match = re.search(
        rf"(\d+\.\d\d) MB/s from \d+ messages\n\tMessage size mean: {each} min: {each} max: {each}\n", out
    )
    assert match is not None
    assert 0 < float(match[1]) < 201 * size


def test_bw_of_several_topics_is_a_table_or_json(
    publishing: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    publishing("/x", Int32)
    with monkeypatch.context() as patch:
        until_said(patch, "===")
        assert main(["topic", "bw", "/x", "/y"]) == 130
    assert "topic   bandwidth" in capsys.readouterr().out
    until_said_json(monkeypatch, lambda found: found["new"] > 1)
    assert main(["topic", "bw", "/x", "--json"]) == 130
    found = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert (found["mean"], found["min"], found["max"]) == (8, 8, 8)
    assert found["bytes_per_second"] > 0


def test_delay_is_from_the_stamp_to_the_arrival(
    publishing: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    def half_a_second_old() -> TwistStamped:
        seconds, nanoseconds = divmod(time.time_ns() - 500 * MS, 10**9)
        return TwistStamped(header=Header(stamp=TimeMsg(sec=seconds, nanosec=nanoseconds)))

    publishing("/x", half_a_second_old)
    until_said(monkeypatch, "average delay")
    assert main(["topic", "delay", "/x"]) == 130
    match = re.match(r"average delay: (\d+\.\d{3})\n\tmin: (\d+\.\d{3})s max: ", capsys.readouterr().out)
    assert match is not None
    assert 0.5 <= float(match[2]) <= float(match[1]) < 30.0


def test_under_sim_time_moments_are_those_of_clock(
    node: Node, publishing: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    clock, ticks = node.create_publisher(Clock, "/clock", 10), itertools.count(1)

    def ten_seconds_on() -> TwistStamped:
        now = next(ticks) * 10
        clock.publish(Clock(clock=TimeMsg(sec=now)))
        return TwistStamped(header=Header(stamp=TimeMsg(sec=now - 2)))

    publishing("/x", ten_seconds_on)
    with monkeypatch.context() as patch:
        until_said(patch, "average rate")
        assert main(["topic", "hz", "/x", "-s"]) == 130
    assert "average rate: 0.100\n\tmin: 10.000s max: 10.000s std dev: 0.00000s" in capsys.readouterr().out
    with monkeypatch.context() as patch:
        until_said(patch, "average delay")
        assert main(["topic", "delay", "/x", "-s"]) == 130
    assert "average delay: 2.000\n\tmin: 2.000s max: 2.000s" in capsys.readouterr().out
    until_said(monkeypatch, "average rate")
    assert main(["topic", "hz", "/x", "-s", "--wall-time"]) == 130
    assert "average rate: 0.100" not in capsys.readouterr().out


def test_silence_is_told_and_then_the_reason(node: Node, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setattr(meters, "PERIOD", 0.02)
    monkeypatch.setattr(meters, "PATIENCE", 0.05)
    publisher = node.create_publisher(Int32, "/x", 10)

    def publish_twice(text: str) -> None:
        publisher.publish(Int32())
        publisher.publish(Int32())

    when_said(monkeypatch, meters, "tell", publish_twice)
    when_said(monkeypatch, meters, "say", lambda said: press_ctrl_c(said) if said == meters.NO_NEWS else None)
    assert main(["topic", "hz", "/x"]) == 130
    out, err = capsys.readouterr()
    assert err == "waiting: /x is published by /lab/robot, which has sent nothing since this began\n"
    assert out.startswith("average rate: ")
    assert out.endswith("window: 1\nno new messages\n")


@pytest.mark.parametrize("verb", ["hz", "bw", "delay"])
def test_a_topic_of_nobody_is_told(node: Node, verb: str, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setattr(meters, "PERIOD", 0.02)
    monkeypatch.setattr(meters, "PATIENCE", 0.05)
    node.create_publisher(Int32, "/xx", 10)
    until_said(monkeypatch, "waiting")
    assert main(["topic", verb, "/x"]) == 130
    reported = "waiting for a publisher of /x: nobody publishes it on domain 7 yet (did you mean '/xx'?)\n"
    assert capsys.readouterr() == ("", reported)


def test_what_cannot_be_read_is_left_out_and_told_once(
    node: Node, publishing: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    publishing("/x", lambda: TwistStamped(header=STAMPED))
    bad = made(node.context, "bad").create_publisher(TwistStamped, "/x", 10)

    def one_more() -> Int32:
        bad.publish(b"\x00\x01\x00\x00")
        return Int32()

    publishing("/y", one_more)
    for args in (["delay", "/x"], ["hz", "/x", "--filter", "m.header.stamp.sec == 3"]):
        with monkeypatch.context() as patch:
            until_said(patch, "average")
            assert main(["topic", *args]) == 130
        out, err = capsys.readouterr()
        assert out.startswith("average")
        assert err.startswith("robolink: a message cannot be read: ")
        assert err.count("\n") == 1


def test_what_was_sent_before_is_no_arrival(node: Node, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setattr(meters, "PERIOD", 0.02)
    monkeypatch.setattr(meters, "PATIENCE", 0.02)
    latch(node, "/x", Int32(), Int32())
    assert node.context.graph.count(EndpointKind.PUBLISHER, "/x") == 1
    until_said(monkeypatch, "waiting: /x is published by /lab/robot")
    assert main(["topic", "hz", "/x"]) == 130
    assert capsys.readouterr().out == ""
