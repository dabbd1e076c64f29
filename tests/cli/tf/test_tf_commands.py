"""tf echo, monitor and tree: what they show of transforms, and what they tell when something is wrong."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given

from robolink import Node
from robolink.cli.main import main
from robolink.cli.shared import output
from robolink.cli.tf import watch
from robolink.geometry.transformations import euler_from_quaternion, quaternion_from_euler, quaternion_matrix
from robolink.tf2 import StaticTransformBroadcaster
from tests.support.commands import Command
from tests.support.seen_by_commands import made, press_ctrl_c, when_said
from tests.support.transforms import transform
from tests.tf2.test_tf2_core import TURN

Captured = pytest.CaptureFixture[str]


def static(node: Node, *transforms: Any) -> None:
    StaticTransformBroadcaster(node).sendTransform(transforms)


SHOWN = [
    "At time 0.000000000",
    "- Translation: [4.000, 2.000, -0.500]",
    "- Rotation: in Quaternion [0.000, 0.000, 0.707, 0.707]",
    "- Rotation: in RPY (radian) [0.000, 0.000, 1.571]",
    "- Rotation: in RPY (degree) [0.000, 0.000, 90.000]",
    "- Matrix:",
    "  0.000 -1.000  0.000  4.000",
    "  1.000  0.000  0.000  2.000",
    "  0.000  0.000  1.000 -0.500",
    "  0.000  0.000  0.000  1.000",
]

# --- echo -----------------------------------------------------------------------------------------------------


def test_echo_shows_what_tf2_echo_shows(node: Node, capsys: Captured) -> None:
    turned = (0, 0, math.sqrt(0.5), math.sqrt(0.5))
    static(node, transform("map", "odom", 0, (1, 2, 0)), transform("odom", "base", 0, (3, 0, -0.5), turned))
    assert main(["tf", "echo", "map", "base", "--once"]) == 0
    out, err = capsys.readouterr()
    assert (out.splitlines(), err) == (SHOWN, "")


def test_echo_as_json_goes_on_at_a_rate(
    again: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    again(transform("map", "base", place=(2, 0, 0)))
    count = iter(range(3))
    original = output.say_json

    def speak(value: Any) -> None:
        original(value)
        if next(count) == 2:
            raise KeyboardInterrupt

    monkeypatch.setattr(watch, "say_json", speak)
    assert main(["tf", "echo", "base", "map", "100", "--json"]) == 130
    lines = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert len(lines) == 3
    assert lines[0]["stamp"] <= lines[1]["stamp"] <= lines[2]["stamp"]
    assert lines[0] | {"stamp": 0} == {
        "stamp": 0,
        "frame_id": "base",
        "child_frame_id": "map",
        "translation": {"x": -2.0, "y": 0.0, "z": 0.0},
        "rotation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0},
        "rpy": [0.0, 0.0, 0.0],
    }


@given(TURN)
def test_angles_and_matrix_are_those_of_transformations(turn: tuple[float, float, float, float]) -> None:
    found = quaternion_matrix(turn)
    assert np.allclose(watch.matrix((0, 0, 0, *turn)), found)
    roll, pitch, yaw = watch.roll_pitch_yaw(*turn)
    wanted = euler_from_quaternion(turn)
    if abs(abs(pitch) - math.pi / 2) > 1e-3:
        assert all(abs(math.remainder(a - b, math.tau)) < 1e-6 for a, b in zip((roll, pitch, yaw), wanted, strict=True))


@pytest.mark.parametrize("up", [1.0, -1.0])
def test_angles_straight_up_and_down(up: float) -> None:
    turn = quaternion_from_euler(0.4, up * math.pi / 2, 0.0)
    assert watch.roll_pitch_yaw(*turn) == pytest.approx((0.4, up * math.pi / 2, 0.0), abs=1e-6)


@pytest.mark.parametrize(
    ("frames", "reason"),
    [
        (("map", "camera"), "Could not find a connection between 'map' and 'camera'"),
        (("map", "bas"), "\"bas\" passed to robolink tf does not exist. (did you mean 'base'?)"),
        (("/map", "base"), 'Invalid argument "/map" passed to robolink tf - in tf2 frame_ids cannot start'),
    ],
)
def test_echo_tells_why_there_is_none_and_gives_up(
    frames: tuple[str, str], reason: str, node: Node, capsys: Captured
) -> None:
    static(node, transform("map", "base"), transform("rig", "camera"))
    assert main(["tf", "echo", *frames, "--timeout", "0.3"]) == 1
    out, err = capsys.readouterr()
    waiting, gave_up = err.splitlines()  # told once, though it waited longer
    assert out == ""
    assert waiting.startswith(f"waiting: {reason}")
    assert gave_up.startswith(f"robolink: gave up after 0.3 s: {reason}")


def test_echo_where_nobody_publishes(node: Node, capsys: Captured) -> None:
    assert main(["tf", "echo", "a", "b", "--timeout", "0.1"]) == 1
    assert "waiting for a publisher of /tf: nobody publishes it on domain 7 yet" in capsys.readouterr().err


def test_echo_goes_on_when_the_tree_falls_apart(node: Node, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    broadcaster = StaticTransformBroadcaster(node)
    broadcaster.sendTransform([transform("map", "odom"), transform("odom", "base")])

    def after(text: str) -> None:
        if text.startswith("Failure"):
            raise KeyboardInterrupt
        broadcaster.sendTransform(transform("moon", "odom"))

    when_said(monkeypatch, watch, "say", after)
    assert main(["tf", "echo", "map", "base", "100"]) == 130
    out = capsys.readouterr().out
    assert re.search(r"Failure at \d+\.\d{6}\nException thrown:Could not find a connection between 'map' and", out)
    assert "The current list of frames is:\nFrame odom exists with parent moon.\n" in out


@pytest.mark.parametrize("rate", ["0", "nan", "inf", "-1"])
@pytest.mark.usefixtures("node")
def test_a_rate_is_above_zero(rate: str, capsys: Captured) -> None:
    assert main(["tf", "echo", "--", "a", "b", rate]) == 1
    assert capsys.readouterr() == ("", f"robolink: RATE: expected a number of Hz above 0, got {rate}\n")


def test_echo_ends_on_ctrl_c_while_it_waits(node: Node, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    when_said(monkeypatch, watch, "tell", press_ctrl_c)
    assert main(["tf", "echo", "a", "b"]) == 130
    assert capsys.readouterr().out == ""


# --- monitor --------------------------------------------------------------------------------------------------


def test_monitor_says_who_publishes_how_often_and_how_late(
    node: Node, again: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    again(transform("odom", "base"), age=3.0)
    static(made(node.context, "fixed"), transform("base", "lidar"))
    when_said(monkeypatch, watch, "say", lambda text: press_ctrl_c(text) if "static" in text and "Hz" in text else None)
    assert main(["tf", "monitor", "--period", "0.2"]) == 130
    out, err = capsys.readouterr()
    assert err == ""
    lines = out.splitlines()
    assert lines[0] == "Gathering data on all frames for 0.2 seconds..."
    end = lines[lines.index("RESULTS: for all Frames", len(lines) - 12) :]
    assert re.fullmatch(r"Frame: base, published by /lab/robot, Average Delay: 3\.\d+, Max Delay: \d[\d.]+", end[3])
    assert end[4] == "Frame: lidar, published by /fixed, static"
    assert end[6:8] == ["All Broadcasters:", "Node: /fixed static"]
    assert re.fullmatch(r"Node: /lab/robot [\d.]+ Hz, Average Delay: 3\.\d+ Max Delay: \d[\d.]+", end[8])


def test_monitor_of_a_chain(
    node: Node, again: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    again(transform("odom", "base"), transform("odom", "other"))
    static(node, transform("base", "lidar"))
    when_said(monkeypatch, watch, "say", lambda text: press_ctrl_c(text) if "Chain" in text else None)
    assert main(["tf", "monitor", "odom", "lidar", "--period", "0.1"]) == 130
    out = capsys.readouterr().out
    assert "RESULTS: for odom to lidar\nChain is: odom -> base -> lidar\nNet delay     now = " in out
    assert "Frame: other" not in out


def test_monitor_as_json(again: Callable[..., None], monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    again(transform("odom", "base"))
    original = output.say_json

    def speak(value: Any) -> None:
        original(value)
        if value["frames"][0]["rate"]:
            raise KeyboardInterrupt

    monkeypatch.setattr(watch, "say_json", speak)
    assert main(["tf", "monitor", "base", "odom", "--period", "0.3", "--json"]) == 130
    found = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert found["chain"] == ["base", "odom"]
    (frame,) = found["frames"]
    assert (frame["frame"], frame["parent"], frame["publisher"], frame["static"]) == (
        "base",
        "odom",
        "/lab/robot",
        False,
    )
    assert frame["rate"] > 1


def test_monitor_tells_once_why_there_is_nothing(node: Node, monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    when_said(monkeypatch, watch, "tell", press_ctrl_c)
    assert main(["tf", "monitor", "--period", "0.1"]) == 130
    assert "nobody publishes it on domain 7 yet" in capsys.readouterr().err
    static(node, transform("a", "b"))
    assert main(["tf", "monitor", "a", "c", "--period", "0.1"]) == 130
    assert '"c" passed to robolink tf does not exist' in capsys.readouterr().err
    assert main(["tf", "monitor", "a"]) == 2


# --- processes ------------------------------------------------------------------------------------------------


@pytest.mark.processes
def test_a_static_transform_of_another_process_is_echoed(domain: int) -> None:
    words = ["run", "static_transform_publisher", "--x", "1", "--yaw", "0.5", "--frame-id", "map"]
    with Command(domain, *words, "--child-frame-id", "base") as publisher:
        with Command(domain, "tf", "echo", "map", "base", "--once") as echoed:
            assert echoed.end() == 0
        assert [line.text for line in echoed.lines][1:4] == [
            "- Translation: [1.000, 0.000, 0.000]",
            "- Rotation: in Quaternion [0.000, 0.000, 0.247, 0.969]",
            "- Rotation: in RPY (radian) [0.000, 0.000, 0.500]",
        ]
        with Command(domain, "tf", "tree") as drawn:
            assert drawn.end() == 0
        assert drawn.lines[0].text == "map"
        assert re.fullmatch(r"└─ base  static +/static_transform_publisher_\w+", drawn.lines[1].text)
        publisher.interrupt()
        assert publisher.end() == 0
    assert [line.text for line in publisher.errors if "Traceback" in line.text] == []
