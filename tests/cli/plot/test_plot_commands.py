"""plot odom, path and topic: what they draw of what they hear, and what they say when there is nothing to draw."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Node
from robolink.bag.topic import BagTopic, message_definition
from robolink.bag.writer import BagWriter
from robolink.cli.main import main
from robolink.cli.plot import drawing, messages
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from robolink.interfaces.geometry_msgs.msg import Point, PointStamped, PoseStamped, TransformStamped, Twist, Vector3
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.nav_msgs.msg import Path as PathMessage
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import Bool, Float64, String
from robolink.interfaces.turtlesim.msg import Pose as TurtlePose
from robolink.message import type_hash, type_name
from robolink.parameter import Parameter
from robolink.serialization import serialize_message
from tests.support.seen_by_commands import a_node_that_commands_see, latch, made, spinning

Captured = pytest.CaptureFixture[str]
PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture
def node(monkeypatch: pytest.MonkeyPatch) -> Iterator[Node]:
    monkeypatch.setenv("MPLBACKEND", "agg")
    with a_node_that_commands_see(monkeypatch) as robot:
        yield robot


@pytest.fixture
def drawn(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The axes of the pictures that were drawn."""
    pictures: list[Any] = []
    show = messages.show

    def note(figure: Any, request: messages.Request) -> None:
        pictures.append(figure.axes[0])
        show(figure, request)

    monkeypatch.setattr(drawing, "show", note)
    monkeypatch.setattr(drawing, "show", note)
    return pictures


def odometry(x: float, y: float, sec: int = 0) -> Odometry:
    message = Odometry()
    message.pose.pose.position.x, message.pose.pose.position.y = x, y
    message.header.stamp.sec = sec
    return message


def pose(x: float, y: float) -> PoseStamped:
    message = PoseStamped()
    message.pose.position.x, message.pose.position.y = x, y
    return message


def plot(*arguments: str | Path) -> int:
    return main(["plot", *map(str, arguments), "--duration", "0.1"])


# What messages say


@pytest.mark.parametrize(
    "message",
    [
        odometry(1.0, 2.0),
        pose(1.0, 2.0),
        pose(1.0, 2.0).pose,
        Point(x=1.0, y=2.0),
        PointStamped(point=Point(x=1.0, y=2.0)),
        TurtlePose(x=1.0, y=2.0),
    ],
    ids=lambda message: type(message).__name__,
)
def test_a_place_is_found_in_every_message_that_has_one(message: Any) -> None:
    assert drawing.positions(message) == [(1.0, 2.0)]


def test_a_transform_is_a_place_and_other_messages_are_none() -> None:
    transform = TransformStamped()
    transform.transform.translation = Vector3(x=1.0, y=2.0)
    assert drawing.positions(transform) == [(1.0, 2.0)]
    assert drawing.positions(String()) == drawing.positions(LaserScan()) == []
    assert drawing.path_points(String()) == []


@given(st.floats(), st.floats())
def test_a_place_that_is_nowhere_is_none(x: float, y: float) -> None:
    found = drawing.positions(Point(x=x, y=y))
    assert found == ([(x, y)] if math.isfinite(x) and math.isfinite(y) else [])


def test_a_way_goes_on_and_a_path_is_replaced() -> None:
    way, path = drawing.Way("/odom", drawing.POSES), drawing.Way("/plan", drawing.PATHS)
    for x in (0.0, 1.0, 1.0, 2.0):
        way.take(odometry(x, 0.0))
        path.take(PathMessage(poses=[pose(x, 0.0), pose(x, 1.0)]))
    path.take(PathMessage())
    assert way.points == [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)]
    assert path.points == []


# The commands


@pytest.mark.slow
def test_a_way_is_drawn_with_its_length(node: Node, tmp_path: Path, drawn: list[Any], capsys: Captured) -> None:
    latch(node, "odom", odometry(0.0, 0.0), odometry(3.0, 4.0), odometry(3.0, 5.0))
    out = tmp_path / "way.png"
    with spinning(node):
        assert plot("odom", "/lab/odom", "--out", out) == 0
    assert out.read_bytes().startswith(PNG)
    (axes,) = drawn
    assert axes.lines[0].get_xydata().tolist() == [[0, 0], [3, 4], [3, 5]]
    assert [each.get_text() for each in axes.get_legend().get_texts()] == ["/lab/odom: 6.00 m"]
    assert capsys.readouterr().err == f"listening to /lab/odom for 0.1 s\nwrote {out}\n"


@pytest.mark.slow
def test_several_ways_are_in_one_picture_and_a_silent_topic_does_no_harm(
    node: Node, tmp_path: Path, drawn: list[Any]
) -> None:
    latch(node, "odom", odometry(0.0, 0.0), odometry(1.0, 0.0))
    latch(node, "goal", pose(2.0, 2.0))
    node.create_publisher(Odometry, "silent", 10)
    with spinning(node):
        assert plot("odom", "lab/odom", "lab/goal", "lab/silent", "--out", tmp_path / "way.svg") == 0
    assert len(drawn[0].get_legend().get_texts()) == 2


@pytest.mark.slow
def test_the_last_path_is_drawn(node: Node, tmp_path: Path, drawn: list[Any]) -> None:
    latch(node, "plan", PathMessage(poses=[pose(9, 9)]), PathMessage(poses=[pose(0, 0), pose(1, 0), pose(1, 2)]))
    with spinning(node):
        assert plot("path", "/lab/plan", "--out", tmp_path / "plan.pdf") == 0
    assert drawn[0].lines[0].get_xydata().tolist() == [[0, 0], [1, 0], [1, 2]]


@pytest.mark.slow
def test_the_simulated_world_is_drawn_below(node: Node, tmp_path: Path, drawn: list[Any]) -> None:
    world = Node("world", context=node.context, parameter_overrides=[Parameter("world", value="corners")])
    world.declare_parameter("world", "")
    latch(node, "odom", odometry(3.0, 1.0), odometry(4.0, 1.0))
    with spinning(node, world):
        assert plot("odom", "/lab/odom", "--out", tmp_path / "a.png") == 0
        assert plot("odom", "/lab/odom", "--out", tmp_path / "b.png", "--world", "none") == 0
        assert plot("odom", "/lab/odom", "--out", tmp_path / "c.png", "--world", "empty_room") == 0
    pieces = [len(axes.lines) + len(axes.patches) + len(axes.collections) for axes in drawn]
    assert pieces[0] > pieces[1] < pieces[2]
    assert drawn[0].get_xlim()[1] > 6.9  # the corners' room is 7 m wide


@pytest.mark.slow
@pytest.mark.annex("webots")
def test_what_is_left_out_of_a_world_of_webots_is_told_in_a_line(
    node: Node, tmp_path: Path, drawn: list[Any], capsys: Captured
) -> None:
    latch(node, "odom", odometry(3.0, 1.0), odometry(4.0, 1.0))
    path = tmp_path / "w.wbt"
    path.write_text("#VRML_SIM R2023b utf8\nFridge { }\n")
    with spinning(node):
        assert plot("odom", "/lab/odom", "--out", tmp_path / "a.png", "--world", path) == 0
    assert capsys.readouterr().err.startswith(f"robolink: {path}: not known here, so this is not there: Fridge\n")


@pytest.mark.slow
def test_a_world_that_cannot_be_found_is_told_of_and_the_way_is_drawn(
    node: Node, tmp_path: Path, drawn: list[Any], capsys: Captured
) -> None:
    world = Node("world", context=node.context, parameter_overrides=[Parameter("world", value="atlantis")])
    world.declare_parameter("world", "")
    latch(node, "odom", odometry(3.0, 1.0), odometry(4.0, 1.0))
    with spinning(node, world):
        assert plot("odom", "/lab/odom", "--out", tmp_path / "a.png") == 0
        assert plot("odom", "/lab/odom", "--out", tmp_path / "a.png", "--world", "atlantis") == 1
    reported = capsys.readouterr().err.splitlines()
    assert reported[0] == "robolink: drawn without the world: no world named 'atlantis'"
    assert reported[-1] == "robolink: no world named 'atlantis'"


@pytest.mark.slow
@pytest.mark.parametrize("field", ["/lab/odom.twist.twist.linear.x", "lab/odom/twist/twist/linear/x"])
def test_values_are_drawn_over_the_time_of_their_stamps(
    node: Node, tmp_path: Path, drawn: list[Any], field: str
) -> None:
    messages = [odometry(0.0, 0.0, sec) for sec in (10, 11, 13)]
    for index, message in enumerate(messages):
        message.twist.twist.linear.x = index / 2
    latch(node, "odom", *messages)
    with spinning(node):
        assert plot("topic", field, "--out", tmp_path / "values.png") == 0
    assert drawn[0].lines[0].get_xydata().tolist() == [[0, 0], [1, 0.5], [3, 1]]


@pytest.mark.slow
def test_elements_of_sequences_and_booleans_are_values(node: Node, tmp_path: Path, drawn: list[Any]) -> None:
    latch(node, "scan", LaserScan(ranges=[1.0, 2.0]))
    latch(node, "bumper", Bool(data=True))
    with spinning(node):
        assert plot("topic", "lab/scan.ranges[1]", "lab/bumper/data", "--out", tmp_path / "values.png") == 0
    assert [line.get_ydata().tolist() for line in drawn[0].lines] == [[2.0], [1.0]]


@pytest.mark.slow
def test_a_byte_is_a_value_and_messages_that_lack_the_element_are_left_out(
    node: Node, tmp_path: Path, drawn: list[Any]
) -> None:
    latch(node, "level", DiagnosticStatus(level=DiagnosticStatus.WARN))
    latch(node, "scan", LaserScan(ranges=[1.0]), LaserScan(ranges=[1.0, 2.0]), LaserScan())
    with spinning(node):
        assert plot("topic", "lab/level.level", "lab/scan.ranges[1]", "--out", tmp_path / "values.png") == 0
    assert [line.get_ydata().tolist() for line in drawn[0].lines] == [[1.0], [2.0]]


@pytest.mark.processes
@pytest.mark.parametrize("backend", ["tkagg", "module://of_a_notebook"])
def test_a_file_needs_no_screen_whatever_the_shell_says(tmp_path: Path, backend: str) -> None:
    program = """
import sys; from pathlib import Path; from robolink.cli.plot.messages import Request, check
check(Request(Path(sys.argv[1])))
import matplotlib.pyplot as plt; plt.subplots()
"""
    environment = {**os.environ, "MPLBACKEND": backend, "DISPLAY": "", "WAYLAND_DISPLAY": ""}
    command = [sys.executable, "-c", program, str(tmp_path / "x.png")]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


# What goes wrong


def test_what_cannot_be_drawn_is_said_in_a_line(node: Node, tmp_path: Path, capsys: Captured) -> None:
    latch(node, "name", String(data="r2"))
    latch(node, "cmd_vel", Twist())
    latch(node, "scan", LaserScan(ranges=[1.0, 2.0]))
    node.create_publisher(Odometry, "silent", 10)
    node.create_publisher(Float64, "value", 10)
    out = tmp_path / "x.png"
    wrong = {
        ("odom", "/lab/name"): "/lab/name is of std_msgs/msg/String: expected one with a position, such as",
        ("path", "/lab/cmd_vel"): "expected one with a list of poses, such as nav_msgs/msg/Path",
        ("odom", "/lab/silent"): "nothing was heard on /lab/silent",
        ("topic", "/lab/value.data"): "nothing was heard on /lab/value",
        ("topic", "/lab/name.data"): "/lab/name.data is not a number but string",
        ("topic", "/lab/cmd_vel.linear"): "is not a number but geometry_msgs/msg/Vector3: name a field of it: x, y, z",
        ("topic", "/lab/cmd_vel"): "/lab/cmd_vel is a topic: name a number in it, as in /lab/cmd_vel.FIELD",
        ("topic", "/lab/cmd_vel.linear.z1"): "no field 'z1' (did you mean 'z'?); there is x, y, z",
        ("topic", "/lab/cmd_vel.linear.w"): "robolink: linear.w: no field 'w'; there is x, y, z",
        ("topic", "/lab/scan.ranges"): "is a sequence of float32: say which, as in /lab/scan.ranges[0]",
        ("topic", "/lab/scan.ranges[9]"): "ranges[9]: there are 2 elements, no [9]",
    }
    with spinning(node):
        for arguments, expected in wrong.items():
            assert plot(*arguments, "--out", out) == 1
            (*_, line) = capsys.readouterr().err.splitlines()
            assert line.startswith("robolink: ")
            assert expected in line
    assert not out.exists()


def test_a_topic_that_nobody_publishes_is_waited_for_and_given_up(
    node: Node, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(messages, "LEAST_WAIT", 0.1)
    node.create_publisher(Odometry, "odom", 10)
    with spinning(node):
        assert plot("odom", "/odom", "--out", tmp_path / "x.png") == 1
    assert "nobody publishes /odom (did you mean '/lab/odom'?): see" in capsys.readouterr().err
    for arguments in (["odom", "/nothing"], ["topic", "/nothing.x"], ["topic", "nothing/x"]):
        assert plot(*arguments, "--out", tmp_path / "x.png") == 1
        assert "nothing" in capsys.readouterr().err


def test_a_picture_that_could_not_be_written_is_refused_before_listening(
    node: Node, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert plot("odom", "/odom", "--out", tmp_path / "way.txt") == 1
    assert "end its name in .png, .svg, .pdf" in capsys.readouterr().err
    assert plot("odom", "/odom", "--out", tmp_path / "no" / "way.png") == 1
    assert "no folder" in capsys.readouterr().err
    assert plot("odom", "/odom") == 1
    assert capsys.readouterr().err == f"robolink: {messages.WINDOW_NEEDED}\n"
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    for out in ([], ["--out", str(tmp_path / "way.png")]):
        assert plot("odom", "/odom", *out) == 1
        assert "needs matplotlib, which is not installed: pip install matplotlib\n" in capsys.readouterr().err


@pytest.mark.slow
def test_ctrl_c_draws_what_was_heard(
    node: Node, tmp_path: Path, drawn: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    latch(node, "odom", odometry(0.0, 0.0), odometry(3.0, 4.0))
    take = drawing.Way.take

    def press(way: drawing.Way, message: Any) -> None:
        take(way, message)
        if len(way.points) == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(drawing.Way, "take", press)
    with spinning(node):
        assert main(["plot", "odom", "/lab/odom", "--out", str(tmp_path / "way.png")]) == 0
    assert len(drawn[0].lines[0].get_xydata()) == 2


@pytest.mark.slow
def test_other_nodes_called_world_do_no_harm(node: Node, tmp_path: Path, drawn: list[Any]) -> None:
    world = made(node.context, "world")  # it has no parameters to ask for
    latch(node, "odom", odometry(3.0, 1.0), odometry(4.0, 1.0))
    with pytest.MonkeyPatch.context() as patch, spinning(node, world):
        patch.setattr(drawing, "ANSWER_WITHIN", 0.05)
        assert plot("odom", "/lab/odom", "--out", tmp_path / "a.png") == 0
    assert len(drawn) == 1


# --- bags -----------------------------------------------------------------------------------------------------


@pytest.fixture
def lap(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A bag of an odometry, a pose and a number, with one message that is broken."""
    monkeypatch.setenv("MPLBACKEND", "agg")
    monkeypatch.chdir(tmp_path)
    with BagWriter(tmp_path / "lap") as writer:
        numbers = {
            name: writer.add_topic(
                BagTopic(name, type_name(kind), "cdr", type_hash(kind), (), message_definition(kind))
            )
            for name, kind in (("/odom", Odometry), ("/arm/goal", PoseStamped), ("/speed", Float64))
        }
        for second in range(5):
            stamp = second * 10**9
            writer.write(numbers["/odom"], stamp, stamp, second, serialize_message(odometry(second, 0.0)))
            writer.write(numbers["/arm/goal"], stamp, stamp, second, serialize_message(pose(0.0, 2.0 * second)))
            writer.write(numbers["/speed"], stamp, stamp, second, serialize_message(Float64(data=second / 2)))
        writer.write(numbers["/odom"], 5 * 10**9, 0, 5, b"\0\1\0\0\x07")
    return tmp_path / "lap"


@pytest.mark.slow
def test_a_bags_trajectories_are_drawn(lap: Path, drawn: list[Any], capsys: Captured) -> None:
    assert main(["plot", "odom", "--bag", "lap", "--out", "way.png"]) == 0
    assert [each.get_label() for each in drawn[-1].lines[::3]] == ["/odom: 4.00 m", "/arm/goal: 8.00 m"]
    assert "/odom: " in (reported := capsys.readouterr().err)
    assert "it is left out" in reported
    assert main(["plot", "odom", "odom", "--bag", "lap", "--world", "obstacles", "--out", "way.png"]) == 0
    assert [each.get_text() for each in drawn[-1].get_legend().get_texts()] == ["/odom: 4.00 m"]
    assert Path("way.png").read_bytes().startswith(PNG)


@pytest.mark.slow
@pytest.mark.parametrize("requested", ["speed.data", "/speed/data"])
def test_a_bags_values_are_drawn_over_the_times_at_which_they_came(lap: Path, drawn: list[Any], requested: str) -> None:
    assert main(["plot", "topic", requested, "--bag", "lap", "--out", "speed.png"]) == 0
    (curve,) = drawn[-1].lines
    assert list(curve.get_xdata()) == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert list(curve.get_ydata()) == [0.0, 0.5, 1.0, 1.5, 2.0]


@pytest.mark.parametrize(
    ("arguments", "reported"),
    [
        ("odom odm --bag lap", "lap has no topic /odm (did you mean '/odom'?); it has /odom, /arm/goal, /speed"),
        ("odom speed --bag lap", "/speed is of std_msgs/msg/Float64: expected one with a position"),
        ("path --bag lap", "lap: nothing to draw: no topic has a list of poses"),
        ("topic speed.dat --bag lap", "no field 'dat'"),
        ("topic /spd/data --bag lap", "'/spd/data' names no field of a topic in the bag"),
        ("odom --bag nowhere", "no bag 'nowhere'"),
        ("odom", "name the topics to draw, such as /odom, or a bag: --bag FOLDER"),
    ],
)
def test_what_a_bag_lacks_is_told(lap: Path, capsys: Captured, arguments: str, reported: str) -> None:
    assert main(["plot", *arguments.split(), "--out", "x.png"]) == 1
    assert reported in capsys.readouterr().err


def test_a_bag_that_is_named_as_a_topic_is_told_at_once(
    lap: Path, node: Node, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert main(["plot", "odom", "lap", "--out", "x.png"]) == 1
    assert "nobody publishes /lap, and 'lap' is a bag: write --bag lap" in capsys.readouterr().err
