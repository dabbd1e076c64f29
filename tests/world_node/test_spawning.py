"""Spawning and deleting robots in a simulated world."""

from __future__ import annotations

import math
from typing import Any

import pytest

from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.testing import System
from tests.support.halls import asked, refused, robots, simulation


def test_a_robot_is_spawned_with_its_topics_and_frames_and_deleted_with_them(system: System, world: Any) -> None:
    static, tf = system.messages("/tf_static"), system.messages("/tf")
    scans = system.messages("/eve/scan")
    system.run(0.1)
    assert asked(system, "spawn", name="eve", x=5.0, y=5.0, theta=1.0)[0]
    cmd_vel = system.node.create_publisher(Twist, "/eve/cmd_vel", 10)
    cmd_vel.publish(Twist(linear=Vector3(x=0.5)))
    system.run(0.5)
    assert scans[-1].header.frame_id == "eve/base_scan"
    assert len(scans[-1].ranges) == 8
    assert robots(world)["eve"].pose.y > 5.0
    assert "eve/base_link" in [each.child_frame_id for each in tf[-1].transforms]
    assert "eve/base_scan" in [each.child_frame_id for each in static[-1].transforms]
    assert asked(system, "delete", name="eve")[0]
    heard = len(scans)
    system.run(0.5)
    assert len(scans) == heard
    assert list(robots(world)) == ["ada", "bob"]
    assert "eve/base_scan" not in [each.child_frame_id for each in static[-1].transforms]
    assert system.node.count_publishers("/eve/scan") == 0
    assert asked(system, "spawn", name="eve", x=5.0, y=5.0)[0]


def test_a_robot_is_like_the_one_that_is_named(system: System, world: Any) -> None:
    assert asked(system, "spawn", name="bert", x=5.0, y=5.0, model="bob")[0]
    assert robots(world)["bert"].description.sensors == robots(world)["bob"].description.sensors


def test_a_robot_is_as_a_text_says(system: System, world: Any) -> None:
    model = "shape: {box: [0.4, 0.2]}\ndrive: {v_max: 1.5}\nsensors:\n  - {lidar: eyes, beams: 4}\n"
    eyes = system.messages("/box/eyes")
    assert asked(system, "spawn", name="box", x=5.0, y=5.0, model=model)[0]
    system.run(0.2)
    assert robots(world)["box"].description.drive.v_max == 1.5
    assert len(eyes[-1].ranges) == 4


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"name": "ada"}, "ada"),
        ({"name": ""}, "not a name"),
        ({"name": "a/b"}, "not a name"),
        ({"name": "eve", "x": math.nan}, "finite"),
        ({"name": "eve", "x": -5.0}, "outside of the world's size"),
        ({"name": "eve", "x": 2.0, "y": 2.0}, "another robot"),
        ({"name": "eve", "model": "bop"}, "did you mean 'bob'"),
        ({"name": "eve", "model": "{}["}, "model"),
        ({"name": "eve", "model": "- 1"}, "model:1:1: expected mapping, got list"),
        ({"name": "eve", "model": "drive: {type: dif}"}, "did you mean 'diff'"),
        ({"name": "eve", "model": "wheel: []"}, "wheel"),
        ({"name": "eve", "model": "sensors: [{lidar: scan, rate: 33}]"}, "model:1:31: sensors[0].rate: 33 Hz"),
        ({"name": "eve", "model": "mass: 2\nsensors: [{lidar: odom}]"}, "model:2:19: sensors[0].lidar: the simulation"),
        ({"name": "eve", "model": "drive: {steer_max: 1}"}, "model:1:9: drive.steer_max: a drive of type 'diff'"),
        ({"name": "eve", "model": "sensors: [{lidr: scan}]"}, "model:1:11: sensors[0]: this sensor has no kind (did"),
        ({"name": "eve", "model": "x" * 5000}, "xxx..."),
        ({"name": "e" * 5000}, "eee..."),
        ({"name": "eve", "model": "shape: {circle: .nan}"}, "circle"),
        ({"name": "eve", "model": "shape: {circle: 200}"}, "inside"),
        ({"name": "eve", "model": "a: &a [*a]"}, "model"),
        ({"name": "eve", "model": "\x01"}, "model"),  # a message ends at \x00
        ({"name": "eve", "model": "colour: rde"}, "model:1:9: colour: 'rde' is not a colour (did you mean 'red'?)"),
        (
            {"name": "eve", "model": "colour: #ff0000"},
            "model:1:1: colour: this colour is empty: one that begins with #",
        ),
        ({"name": "eve", "model": "signs: [{tag: 36h11/900, pose: [0, 0]}]"}, "signs[0].tag: '36h11/900' is not a tag"),
        ({"name": "eve", "model": "signs: [{image: no.png, pose: [0, 0]}]"}, "model:1:17: signs[0].image: no file 'no"),
    ],
)
def test_an_impossible_robot_is_refused(system: System, world: Any, fields: dict[str, Any], reason: str) -> None:
    assert reason in refused(asked(system, "spawn", **{"x": 5.0, "y": 5.0, **fields}))
    assert list(robots(world)) == ["ada", "bob"]


def test_an_unknown_robot_cannot_be_deleted(system: System, world: Any) -> None:
    assert "did you mean 'bob'" in refused(asked(system, "delete", name="bop"))


def test_all_robots_may_go_and_others_come(system: System, world: Any) -> None:
    for name in ("ada", "bob"):
        assert asked(system, "delete", name=name)[0]
    system.run(2.5)
    assert "no robot" in refused(asked(system, "spawn", name="eve", x=5.0, y=5.0))
    assert asked(system, "spawn", name="eve", x=5.0, y=5.0, model="sensors: [{lidar: scan}]")[0]


def test_the_only_robot_keeps_its_topics_when_others_come(system: System, hall: str) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": "empty_room"})
    first, second = system.messages("/scan"), system.messages("/eve/scan")
    assert asked(system, "spawn", name="eve", x=1.0, y=1.0)[0]
    system.run(1.005)
    asked(system, "reset")
    system.run(1.005)
    assert (len(first), len(second)) == (20, 10)
