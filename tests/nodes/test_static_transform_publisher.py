"""The node static_transform_publisher: what its arguments mean, and what they cannot mean."""

from __future__ import annotations

import math
import sys
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.exceptions import InvalidParameterValueException, RobolinkError
from robolink.geometry.transformations import euler_from_quaternion
from robolink.impl.log_output import Record
from robolink.testing import System
from robolink.tf2 import Buffer, TransformListener
from robolink.time import Time
from tests.support.nodefiles import load_node_file
from tests.support.transforms import place, rotation

node_file = load_node_file("static_transform_publisher")
FRAMES = ["--frame-id", "map", "--child-frame-id", "base"]
NUMBER = st.floats(-10.0, 10.0)


def published(args: list[str]) -> Any:
    return node_file.checked({**node_file.DEFAULTS, **node_file.parameters(args)})


def test_frames_alone_are_the_identity() -> None:
    found = published(FRAMES)
    assert (found.header.frame_id, found.child_frame_id) == ("map", "base")
    assert place(found).tolist() == [0, 0, 0]
    assert rotation(found).as_quat().tolist() == [0, 0, 0, 1]


@given(NUMBER, NUMBER, st.floats(-3.0, 3.0), st.floats(-1.5, 1.5), st.floats(-3.0, 3.0))
def test_flags_of_ros_2(x: float, z: float, roll: float, pitch: float, yaw: float) -> None:
    flags = {"--x": x, "--z": z, "--roll": roll, "--pitch": pitch, "--yaw": yaw}
    found = published([*FRAMES, *(word for flag, value in flags.items() for word in (f"{flag}={value}",))])
    assert place(found).tolist() == [x, 0, z]
    assert euler_from_quaternion(rotation(found).as_quat()) == pytest.approx((roll, pitch, yaw), abs=1e-9)


def test_a_negative_number_may_stand_behind_its_flag() -> None:
    assert place(published(["--x", "-1.5", "--y", "-2e-3", *FRAMES])).tolist() == [-1.5, -0.002, 0]


def test_a_quaternion_is_made_a_unit() -> None:
    found = published(["--qz", "2", "--qw", "2", *FRAMES])
    assert rotation(found).as_quat().tolist() == pytest.approx([0, 0, math.sqrt(0.5), math.sqrt(0.5)])


@pytest.mark.parametrize(
    "args",
    [
        ["1", "-2", "3", "0.5", "0", "0", "map", "base"],
        ["1", "-2", "3", "0", "0", "0.247404", "0.968912", "map", "base"],
    ],
)
@pytest.mark.parametrize("sign", ["", "-"])
def test_the_older_form_without_flags(args: list[str], sign: str) -> None:
    found = published([sign + args[0], *args[1:]])
    assert place(found).tolist() == [float(f"{sign}1"), -2, 3]
    assert euler_from_quaternion(rotation(found).as_quat()) == pytest.approx((0, 0, 0.5), abs=1e-5)
    assert (found.header.frame_id, found.child_frame_id) == ("map", "base")


@pytest.mark.parametrize(
    ("args", "said"),
    [
        (["--x", "1"], "--frame-id: the name of a frame is needed"),
        (["--frame-id", "map"], "--child-frame-id: the name of a frame is needed"),
        (["--frame-id", "", "--child-frame-id", "b"], "--frame-id: the name of a frame is needed"),
        ([*FRAMES, "--x", "one"], "x: expected a number, got 'one'"),
        ([*FRAMES, "--x"], "--x: a value is needed"),
        ([*FRAMES, "--qv", "1"], "no such option: --qv .did you mean '--q.'"),
        ([*FRAMES, "--yaw", "1", "--qz", "1"], "either a quaternion .* or angles .*, not both"),
        (["1", "2", "3", "map", "base"], "the older form has 8 or 9 arguments, got 5"),
        (["1", "2", "3", "0", "0", "x", "map", "base"], "roll: expected a number, got 'x'"),
        (["1", "2", "3", "0", "0", "0", "map", "base", "--x", "1"], "either flags or the older form without, not both"),
        (["--frame-id", "a", "--child-frame-id", "/a"], "are both 'a'"),
        (["--frame-id", "/", "--child-frame-id", "a"], "names of two frames, got nothing"),
        ([*FRAMES, "--x", "nan"], "expected finite numbers"),
        ([*FRAMES, "--qw", "0"], "expected a quaternion"),
    ],
)
def test_what_is_no_transform_is_one_line(args: list[str], said: str) -> None:
    with pytest.raises(RobolinkError, match=said) as error:
        published(args)
    assert "\n" not in str(error.value)


def test_parameters_say_it_as_well_and_late_listeners_hear_it(system: System) -> None:
    values = {"frame_id": "map", "child_frame_id": "base", "translation.x": 2.0}
    node = system.start(node_file.StaticTransformPublisher, parameters=values)
    system.run(1.0)
    buffer = Buffer()
    listener = TransformListener(buffer, system.node)
    system.wait_until(lambda: buffer.can_transform("map", "base", Time()))
    assert buffer.lookup_transform("map", "base", Time()).transform.translation.x == 2
    listener.unregister()
    with pytest.raises(InvalidParameterValueException, match="read-only"):
        system.set_parameter(node.get_name(), "translation.x", 3.0)
    system.expect_log("translation: ('2.000000', '0.000000', '0.000000')", within=0.0)


def test_its_command_line_is_ros_2s(system: System) -> None:
    system.start("static_transform_publisher", args=[*FRAMES, "--x", "1.5"])
    (found,) = system.expect("/tf_static").transforms
    assert (found.header.frame_id, found.child_frame_id, found.transform.translation.x) == ("map", "base", 1.5)


def test_help_is_printed(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://static")
    monkeypatch.setattr(sys, "argv", ["x", "--help"])
    node_file.main()
    assert capsys.readouterr().out.startswith("usage: static_transform_publisher [FLAGS] --frame-id FRAME")


def test_main_takes_ros_arguments_too(monkeypatch: pytest.MonkeyPatch, log_lines: list[Record]) -> None:
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://static")
    monkeypatch.setattr(sys, "argv", ["x", *FRAMES, "--ros-args", "-r", "__node:=fixed"])
    names = []

    def spin(node: Any) -> None:
        names.append(node.get_name())
        raise KeyboardInterrupt

    monkeypatch.setattr("robolink.spin", spin, raising=False)
    node_file.main()
    assert names == ["fixed"]


def test_main_without_arguments_is_an_error_as_in_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory://static")
    monkeypatch.setattr(sys, "argv", ["x"])
    with pytest.raises(RobolinkError, match="--frame-id: the name of a frame is needed"):
        node_file.main()
