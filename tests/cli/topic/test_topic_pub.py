"""topic pub: what it reads, which stamps it puts in, for whom it waits, and with which profile it publishes."""

from __future__ import annotations

import io
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from robolink import Node
from robolink.cli.main import main
from robolink.cli.topic import pub
from robolink.cli.topic.options import (
    DURABILITIES,
    HISTORIES,
    LIVELINESSES,
    PROFILES,
    RELIABILITIES,
    QoSFlags,
)
from robolink.cli.topic.pub import Stamped
from robolink.exceptions import DocumentError, EncodeError, RobolinkError
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.interfaces.geometry_msgs.msg import PoseStamped, Twist, TwistStamped, Vector3
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)
from robolink.time import Time
from robolink.wire import EndpointKind
from tests.support.seen_by_commands import LATCHED, a_node_that_commands_see, latch, press_ctrl_c, when_said
from tests.support.spins import spin_until

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


def received(node: Node, message_class: type[Any], topic: str) -> list[Any]:
    got: list[Any] = []
    node.create_subscription(message_class, topic, got.append, 1000)
    return got


def taken(node: Node, got: list[Any], count: int) -> list[Any]:
    """Spin until so many have been received."""
    with SingleThreadedExecutor(context=node.context) as executor:
        executor.add_node(node)
        spin_until(executor, lambda: len(got) >= count)
    return got


def typed(monkeypatch: pytest.MonkeyPatch, content: bytes) -> None:
    """Have this on standard input."""
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(content)))


# --- the type and the values ----------------------------------------------------------------------------------


@pytest.mark.parametrize("args", [["{linear: {x: 0.3}}"], ["linear: {x: 0.3}"], ["Twist", "{linear: {x: 0.3}}"]])
def test_the_type_may_be_left_out_of_a_known_topic(node: Node, args: list[str]) -> None:
    got = received(node, Twist, "/cmd_vel")
    assert main(["pub", "cmd_vel", *args, "-1"]) == 0
    assert taken(node, got, 1) == [Twist(linear=Vector3(x=0.3))]


def test_a_topic_of_several_types_needs_one_said(node: Node, capsys: Captured) -> None:
    node.create_publisher(String, "/both", 10)
    node.create_publisher(Int32, "/both", 10)
    assert main(["pub", "/both", "{}", "-1"]) == 1
    assert "/both has several types: say which" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("content", "published"),
    [
        (b"data: hi", ["hi"]),
        (b"\xef\xbb\xbfdata: hi\n---\n", ["hi"]),
        (b"---\ndata: a\n---\ndata: b\n...\n", ["a", "b"]),
        (b"data: a\n---\n---\ndata: |\n  x\n  ---\n", ["a", "x\n---\n"]),
        ("data: ä".encode(), ["ä"]),
        (b"data: " + b"x" * 1_000_000, ["x" * 1_000_000]),
    ],
)
def test_standard_input_is_a_stream_of_messages(
    node: Node, content: bytes, published: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    got = received(node, String, "/chatter")
    typed(monkeypatch, content)
    args = ["-t", str(len(published)), "-r", "500", "-p", "0"]
    assert main(["pub", "/chatter", "String", "--stdin", *args]) == 0
    assert taken(node, got, len(published)) == [String(data=each) for each in published]


def test_several_messages_are_published_in_turn(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    got = received(node, Int32, "/count")
    typed(monkeypatch, b"data: 1\n---\ndata: 2\n")
    assert main(["pub", "/count", "--stdin", "-t", "5", "-r", "500"]) == 0
    assert [each.data for each in taken(node, got, 5)] == [1, 2, 1, 2, 1]


def test_messages_of_a_file_are_published_in_turn(node: Node, tmp_path: Path) -> None:
    got = received(node, Int32, "/count")
    file = tmp_path / "counts.yaml"
    file.write_bytes(b"data: 1\n---\ndata: 2\n---\n")
    assert main(["pub", "/count", "--yaml-file", str(file), "-t", "3", "-r", "500"]) == 0
    assert [each.data for each in taken(node, got, 3)] == [1, 2, 1]


@pytest.mark.parametrize(
    ("content", "report"),
    [
        (None, "cannot be read: No such file or directory"),
        (b"", "there is nothing to publish in it"),
        (b"data: 1\ndata: \xff\n", "not UTF-8 text"),
        (b"data: 1\n---\ndata: {\n", "document 2"),
        (b"data: 1\n---\nnumber: 2\n", "counts.yaml, document 2: Int32: no field 'number'"),
        (b"- 1\n", "counts.yaml: Int32: expected a mapping of data"),
    ],
)
def test_a_file_that_cannot_be_published_is_told(
    node: Node, content: bytes | None, report: str, tmp_path: Path, capsys: Captured
) -> None:
    file = tmp_path / "counts.yaml"
    if content is not None:
        file.write_bytes(content)
    assert main(["pub", "/count", "Int32", "--yaml-file", str(file), "-1", "-w", "0"]) == 1
    said, told = capsys.readouterr()
    assert (said, told.count("\n")) == ("", 1)
    assert report in told
    assert "counts.yaml" in told


def test_what_echo_shows_can_be_published_again(node: Node, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    latch(node, "/a", String(data="one"), String(data="two"))
    assert main(["topic", "echo", "/a", "--timeout", "0.5"]) == 0
    typed(monkeypatch, capsys.readouterr().out.encode())
    got = received(node, String, "/b")
    assert main(["pub", "/b", "--stdin", "-t", "2", "-r", "500"]) == 0
    assert taken(node, got, 2) == [String(data="one"), String(data="two")]


@pytest.mark.parametrize(
    ("content", "report"),
    [
        (b"", "<standard input>: there is nothing to publish in it"),
        (b"\n---\n---\n", "<standard input>: there is nothing to publish in it"),
        (b"data: hi\n\xff\xfe\x00", "<standard input>:2: not UTF-8 text"),
        (b"data: \x00\x01", "<standard input>:1:7: character U+0000 is not allowed in YAML"),
        (b"data: a\n---\ndate: 2", "<standard input>, document 2: String: no field 'date' (did you mean 'data'?)"),
        (b"data: a\n---\ndata: [", "<standard input>, document 2:1:8: "),
        (b"3", "<standard input>: String: expected a mapping of data, got 3"),
        (
            b"a: &a [x,x,x,x,x,x,x,x,x]\n"
            + b"".join(
                b"%c: &%c [*%c,*%c,*%c,*%c,*%c,*%c,*%c,*%c,*%c]\n" % ((c + 1,) * 2 + (c,) * 9) for c in range(97, 110)
            ),
            "<standard input>:",
        ),
    ],
)
@pytest.mark.usefixtures("node")
def test_bad_input_is_one_line(content: bytes, report: str, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    typed(monkeypatch, content)
    assert main(["pub", "/chatter", "String", "--stdin", "-1", "-w", "0"]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"robolink: {report}")
    assert err.count("\n") == 1


def test_too_much_input_is_refused(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    monkeypatch.setattr(pub, "LONGEST_INPUT", 2**20)
    typed(monkeypatch, b"#" * (2**20 + 1))
    assert main(["pub", "/x", "String", "--stdin"]) == 1
    assert capsys.readouterr().err == "robolink: <standard input>: more than 1 MiB\n"
    monkeypatch.setattr(sys, "stdin", None)
    assert main(["pub", "/x", "String", "--stdin"]) == 1
    assert "there is nothing to publish" in capsys.readouterr().err


@given(st.text("ab: -.\n{}[]\"'&*|>#", max_size=60) | st.text(max_size=30))
@example("---\n...\n--- a\n---b\n")
def test_any_stream_is_documents_or_refused_in_one_line(text: str) -> None:
    try:
        report = f"{pub.INPUT}: {len(list(pub.documents_of(text)))}"
    except DocumentError as error:
        report = str(error)
    assert report.startswith(pub.INPUT)
    assert "\n" not in report


# --- stamps ---------------------------------------------------------------------------------------------------

NOW = Time(seconds=12, nanoseconds=34)
STAMP = TimeMsg(sec=12, nanosec=34)


@pytest.mark.parametrize(
    ("message_class", "data", "stamp_of"),
    [
        (TwistStamped, {"header": "auto"}, lambda m: m.header.stamp),
        (TwistStamped, {"header": {"stamp": "now", "frame_id": "odom"}}, lambda m: m.header.stamp),
        (Clock, {"clock": "now"}, lambda m: m.clock),
        (TFMessage, {"transforms": [{}, {"header": "auto"}]}, lambda m: m.transforms[1].header.stamp),
    ],
)
def test_words_become_the_time_of_sending(message_class: type[Any], data: Any, stamp_of: Any) -> None:
    stamped = Stamped(message_class, data)
    assert stamp_of(stamped.message) == TimeMsg()
    stamped.stamp(NOW)
    assert stamp_of(stamped.message) == STAMP
    stamped.stamp(Time(seconds=13))
    assert stamp_of(stamped.message) == TimeMsg(sec=13)


def test_what_is_said_beside_the_words_stays() -> None:
    stamped = Stamped(PoseStamped, {"header": {"stamp": "now", "frame_id": "odom"}, "pose": {"position": {"x": 2}}})
    stamped.stamp(NOW)
    assert stamped.message.header.frame_id == "odom"
    assert stamped.message.pose.position.x == 2.0
    plain = Stamped(PoseStamped, {"header": {"stamp": {"sec": 5}}})
    plain.stamp(NOW)
    assert plain.message.header.stamp == TimeMsg(sec=5)


def test_the_words_are_texts_where_a_text_may_stand() -> None:
    assert Stamped(String, {"data": "now"}).message == String(data="now")


@pytest.mark.parametrize(
    ("message_class", "data", "report"),
    [
        (TwistStamped, {"header": "now"}, "TwistStamped.header: expected a mapping of stamp, frame_id, got 'now'"),
        (TwistStamped, {"header": {"stamp": "auto"}}, "TwistStamped.header.stamp: expected a mapping of sec, nanosec"),
        (Twist, {"linear": "auto"}, "Twist.linear: expected a mapping of x, y, z, got 'auto'"),
        (TFMessage, {"transforms": "auto"}, "TFMessage.transforms: expected"),
        (Twist, "auto", "Twist: expected a mapping of linear, angular, got 'auto'"),
    ],
)
def test_words_elsewhere_are_refused(message_class: type[Any], data: Any, report: str) -> None:
    with pytest.raises(EncodeError) as caught:
        Stamped(message_class, data)
    assert str(caught.value).startswith(report)


VALUES = st.recursive(
    st.sampled_from(["auto", "now", None, 1, 0.5, "x"]),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(["header", "stamp", "transforms", "frame_id", "transform", "y"]), inner)
    ),
    max_leaves=8,
)


@given(VALUES)
def test_any_values_are_stamped_or_refused(data: Any) -> None:
    try:
        Stamped(TFMessage, data).stamp(NOW)
        report = "TFMessage"
    except RobolinkError as error:
        report = str(error)
    assert report.startswith("TFMessage")


def test_each_message_has_its_own_stamp(node: Node) -> None:
    got = received(node, TwistStamped, "/x")
    before = node.get_clock().now().nanoseconds
    assert main(["pub", "/x", "TwistStamped", "{header: auto}", "-t", "3", "-r", "200"]) == 0
    stamps = [Time.from_msg(each.header.stamp).nanoseconds for each in taken(node, got, 3)]
    assert before < stamps[0] < stamps[1] < stamps[2]


def test_stamps_follow_clock_where_asked(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    got = received(node, TwistStamped, "/x")
    clock = node.create_publisher(Clock, "/clock", 10)
    when_said(monkeypatch, pub, "say", lambda _: clock.publish(Clock(clock=TimeMsg(sec=100))))
    when_said(monkeypatch, pub, "say", lambda text: press_ctrl_c(text) if "#2" in text else None)
    assert main(["pub", "/x", "TwistStamped", "{header: auto}", "-s", "-t", "1"]) == 0
    assert taken(node, got, 1)[0].header.stamp.sec == 0  # no /clock was heard yet


# --- whom it waits for, and how ---------------------------------------------------------------------------------


def test_it_gives_up_waiting_where_asked(node: Node, capsys: Captured) -> None:
    node.create_subscription(String, "/chatter", print, 10)
    assert main(["pub", "/chatter", "String", "-1", "-w", "2", "--max-wait-time-secs", "0.05"]) == 1
    out, err = capsys.readouterr()
    assert out == "Waiting for at least 2 matching subscription(s)...\n"
    assert err == (
        "robolink: timed out waiting for subscribers: expected 2, but there are only 1 of /chatter"
        " with type std_msgs/msg/String\n"
    )


@pytest.mark.usefixtures("node")
def test_ctrl_c_ends_the_waiting(monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    when_said(monkeypatch, pub, "say", press_ctrl_c)
    assert main(["pub", "/chatter", "String", "-1", "--max-wait-time-secs", "0.2"]) == 130
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(("every", "said"), [("0", []), ("1", [1, 2, 3, 4]), ("2", [2, 4]), ("3", [3])])
@pytest.mark.usefixtures("node")
def test_every_nth_message_is_printed(every: str, said: list[int], capsys: Captured) -> None:
    assert main(["pub", "/x", "Int32", "-t", "4", "-r", "500", "-w", "0", "-p", every]) == 0
    shown = capsys.readouterr().out
    assert [number for number in range(9) if f"publishing #{number}: " in shown] == said


def test_the_profile_and_the_name_are_as_asked(node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    found: list[Any] = []
    when_said(
        monkeypatch,
        pub,
        "say",
        lambda _: found.extend(node.context.graph.endpoints(EndpointKind.PUBLISHER, name="/x")),
    )
    flags = ["--qos-profile", "sensor_data", "--qos-depth", "7", "--qos-durability", "transient_local", "-n", "mouth"]
    assert main(["pub", "/x", "Int32", "-1", "-w", "0", *flags]) == 0
    qos = found[0].qos
    assert (qos.depth, qos.durability, qos.reliability) == (7, LATCHED.durability, ReliabilityPolicy.BEST_EFFORT)
    assert found[0].node_name == "mouth"


# --- flags of the quality of service ----------------------------------------------------------------------------


def test_the_choices_are_those_of_rclpy() -> None:
    assert QoSPresetProfiles.short_keys() == PROFILES
    assert HistoryPolicy.short_keys() == HISTORIES
    assert ReliabilityPolicy.short_keys() == RELIABILITIES
    assert DurabilityPolicy.short_keys() == DURABILITIES
    assert LivelinessPolicy.short_keys() == LIVELINESSES


@pytest.mark.parametrize("profile", PROFILES)
def test_what_is_not_said_is_the_presets(profile: str) -> None:
    assert QoSFlags().over(profile) == QoSPresetProfiles.get_from_short_key(profile)
    assert QoSFlags(profile=profile).over("default") == QoSPresetProfiles.get_from_short_key(profile)
    assert not QoSFlags().given


def test_what_is_said_counts() -> None:
    flags = QoSFlags("", 3, "keep_all", "best_effort", "transient_local", "manual_by_topic", 1.5)
    found = flags.over("default")
    assert flags.given
    assert isinstance(found, QoSProfile)
    assert (found.depth, found.history, found.reliability) == (3, HistoryPolicy.KEEP_ALL, ReliabilityPolicy.BEST_EFFORT)
    assert (found.durability, found.liveliness) == (DurabilityPolicy.TRANSIENT_LOCAL, LivelinessPolicy.MANUAL_BY_TOPIC)
    assert found.liveliness_lease_duration.nanoseconds == 1_500_000_000
    assert QoSPresetProfiles.DEFAULT.value.depth == 10  # the preset itself stays as it is
    assert QoSFlags(durability="transient_local").over("system_default").depth == 1


@pytest.mark.parametrize("verb", [["pub", "/x", "Int32"], ["topic", "echo", "/x"]])
@pytest.mark.parametrize(
    ("flag", "value", "report"),
    [
        ("profile", "sensor", "'sensor' is none of unknown, default, system_default, sensor_data, services_default, "),
        ("history", "keep_lst", "'keep_lst' is none of system_default, keep_last, keep_all, unknown (did you mean 'k"),
        ("reliability", "RELIABLE", "'RELIABLE' is none of system_default, reliable, best_effort, unknown, best_avai"),
        ("durability", "latched", "'latched' is none of system_default, transient_local, volatile, unknown, best_ava"),
        ("liveliness", "x" * 10_000, "'" + "x" * 100 + "' is none of system_default, automatic, manual_by_topic"),
    ],
)
@pytest.mark.usefixtures("node")
def test_a_wrong_flag_lists_the_choices(verb: list[str], flag: str, value: str, report: str, capsys: Captured) -> None:
    assert main([*verb, f"--qos-{flag}", value]) == 2
    err = capsys.readouterr().err
    assert err.startswith(f"robolink: Invalid value for '--qos-{flag}': {report}")
    assert err.count("\n") == 1
