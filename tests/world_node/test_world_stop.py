"""STOP for simulated robots: they brake hard, stand whatever is sent, and drive on when it is released."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from robolink.control.stop_lock import QOS, TOPIC
from robolink.interfaces.geometry_msgs.msg import Twist, TwistStamped, Vector3
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.interfaces.std_msgs.msg import Bool
from robolink.launch import read_launch_file
from robolink.simulate import simulate
from robolink.testing import System
from robolink.workspace import list_worlds
from tests.support.halls import asked
from tests.support.nodefiles import ROOT, load_node_file
from tests.support.systems import said

simulation = load_node_file("world")

STANDS_WITHIN = 0.3
"""Longest time from the message to the stand, in seconds."""

ROBOTS = {
    "diff": "{type: diff, v_max: 0.6, w_max: 3.0}",
    "omni": "{type: omni, v_max: 1.0, w_max: 1.5, a_max: 1.0}",
    "ackermann": "{type: ackermann, v_max: 1.5, a_max: 2.0, wheelbase: 0.3}",
    "stamped": "{type: diff, stamped: true}",
}
WHEELS = "wheels: [{motor: left, at: [0, 0.1, 0]}, {motor: right, at: [0, -0.1, 0]}]"


class Pressed:
    """The lock as another node presses it."""

    def __init__(self, system: System, qos: Any = QOS) -> None:
        self._system = system
        self._publisher = system.node.create_publisher(Bool, TOPIC, qos)

    def __call__(self, held: bool) -> None:
        self._publisher.publish(Bool(data=held))

    def leave(self) -> None:
        self._system.node.destroy_publisher(self._publisher)


def world_of(folder: Path, drive: str, more: str = "") -> str:
    path = folder / "world.yaml"
    path.write_text(f"world: {{}}\nrobots: [{{name: ada, pose: [0, 0, 0], drive: {drive}, {more}}}]\n")
    return str(path)


def keep_sending(system: System, topic: str, message: Any) -> None:
    """Send a command again and again, at 50 Hz."""
    publisher = system.node.create_publisher(type(message), topic, 10)
    system.node.create_timer(0.02, lambda: publisher.publish(message))


def speed(robot: Any) -> float:
    return float(max(map(abs, robot.twist)))


def stands_soon_and_long(system: System, world: Any, long: float = 10.0) -> None:
    """Check that all robots stand in time, and stay so."""
    system.run(STANDS_WITHIN)
    places = {name: robot.pose for name, robot in world.simulation.world.robots.items()}
    for _ in range(round(long / 0.1)):
        assert max(map(speed, world.simulation.world.robots.values())) < 1e-6
        system.run(0.1)
    now = {name: robot.pose for name, robot in world.simulation.world.robots.items()}
    assert {name: now[name] == pytest.approx(pose, abs=1e-6) for name, pose in places.items()} == dict.fromkeys(
        places, True
    )


@pytest.mark.parametrize("name", ROBOTS)
def test_a_robot_stands_while_stop_holds_whatever_is_sent(system: System, tmp_path: Path, name: str) -> None:
    world = system.start(simulation.SimulatedWorld, parameters={"world": world_of(tmp_path, ROBOTS[name])})
    twist = Twist(linear=Vector3(x=2.0, y=1.0 * (name == "omni")), angular=Vector3(z=1.0 * (name != "ackermann")))
    keep_sending(system, "cmd_vel", TwistStamped(twist=twist) if name == "stamped" else twist)
    press = Pressed(system)
    system.run(3.0)
    robot = world.simulation.world.robots["ada"]
    fastest = speed(robot)
    assert fastest > 0.4
    press(True)
    stands_soon_and_long(system, world)
    press(False)
    system.run(3.0)
    assert speed(robot) == pytest.approx(fastest, rel=0.01)
    assert said(system, "STOP holds (/e_stop): ada stands, and commands of /test are ignored until it is released") == 1
    assert said(system, "STOP is released") == 1


def test_wheels_that_are_turned_one_by_one_stand_too(system: System, tmp_path: Path) -> None:
    path = world_of(tmp_path, ROBOTS["diff"], WHEELS)
    world = system.start(simulation.SimulatedWorld, parameters={"world": path})
    keep_sending(system, "joint_command", JointState(name=["left", "right"], velocity=[10.0, 9.0]))
    press = Pressed(system)
    system.run(2.0)
    robot = world.simulation.world.robots["ada"]
    assert speed(robot) > 0.4
    press(True)
    stands_soon_and_long(system, world, 2.0)
    press(False)
    system.run(1.0)
    assert speed(robot) > 0.4


def named(world: Any) -> Any:
    return world.simulation.world.robots


def test_who_pressed_may_go_and_the_robot_stands_until_anybody_releases(system: System, tmp_path: Path) -> None:
    world = system.start(simulation.SimulatedWorld, parameters={"world": world_of(tmp_path, ROBOTS["diff"])})
    keep_sending(system, "cmd_vel", Twist(linear=Vector3(x=0.5)))
    press = Pressed(system)
    system.run(1.0)
    press(True)
    press.leave()  # at once
    stands_soon_and_long(system, world, 2.0)
    late = system.messages(TOPIC, Bool)
    system.run(0.1)
    assert [each.data for each in late] == [True]  # the world itself says so to who comes later
    other = Pressed(system, 10)  # volatile, as that of a client of the page
    other(False)
    system.run(1.0)
    assert speed(named(world)["ada"]) == pytest.approx(0.5)
    assert not system.node.get_publishers_info_by_topic(TOPIC)[1:]  # only the one that has released


def test_a_world_that_starts_late_is_held(system: System, tmp_path: Path) -> None:
    Pressed(system)(True)
    keep_sending(system, "cmd_vel", Twist(linear=Vector3(x=0.5)))
    world = system.start(simulation.SimulatedWorld, parameters={"world": world_of(tmp_path, ROBOTS["diff"])})
    system.run(2.0)
    assert named(world)["ada"].pose.x < 0.001


def test_spawned_and_reset_robots_are_held_too(system: System, world: Any) -> None:
    for topic in ("ada/cmd_vel", "bob/cmd_vel", "eve/cmd_vel"):
        keep_sending(system, topic, Twist(linear=Vector3(x=0.3)))
    press = Pressed(system)
    press(True)
    system.run(0.5)
    asked(system, "spawn", name="eve", x=5.0, y=2.0)
    stands_soon_and_long(system, world, 2.0)
    asked(system, "reset")
    stands_soon_and_long(system, world, 2.0)
    press(False)
    system.run(1.0)
    assert {name: speed(robot) for name, robot in named(world).items()} == pytest.approx({"ada": 0.3, "bob": 0.3})


def test_pressing_again_and_again_ends_as_it_was_said_last(system: System, tmp_path: Path) -> None:
    world = system.start(simulation.SimulatedWorld, parameters={"world": world_of(tmp_path, ROBOTS["diff"])})
    one, other = Pressed(system), Pressed(system, 10)
    for turn in range(20):
        for press, held in ((one, True), (other, False), (other, True), (one, turn % 2 == 0)):
            press(held)
            system.run(0.01 * (turn % 3))
        system.run(0.5)
        assert named(world)["ada"].held is (turn % 2 == 0)


@pytest.mark.slow
def test_a_fleet_of_a_hundred_stands(system: System, tmp_path: Path) -> None:
    robots = "".join(f"  - {{name: r{i}, pose: [{i % 10}, {i // 10}, 0]}}\n" for i in range(100))
    path = tmp_path / "fleet.yaml"
    path.write_text(f"world: {{}}\nrobots:\n{robots}")
    world = system.start(simulation.SimulatedWorld, parameters={"world": str(path)})
    for i in range(100):
        keep_sending(system, f"r{i}/cmd_vel", Twist(angular=Vector3(z=1.5)))
    press = Pressed(system)
    system.run(0.5)
    assert min(map(speed, named(world).values())) > 1.0
    press(True)
    stands_soon_and_long(system, world, 0.3)
    press(False)
    system.run(0.5)
    assert min(map(speed, named(world).values())) > 1.0


@pytest.mark.parametrize("name", sorted(each.stem for each in list_worlds(workspace=ROOT)))
def test_in_each_world_the_fastest_robot_stands_in_time(system: System, name: str) -> None:
    world = system.start(simulation.SimulatedWorld, parameters={"world": name})
    for robot in named(world).values():
        prefix = "" if len(named(world)) == 1 else f"{robot.name}/"
        drive = robot.description.drive
        fast = Twist(linear=Vector3(x=drive.v_max), angular=Vector3(z=0.3))
        keep_sending(system, f"{prefix}cmd_vel", TwistStamped(twist=fast) if drive.stamped else fast)
    press = Pressed(system)
    system.run(0.8)
    press(True)
    stands_soon_and_long(system, world, 0.5)


def test_a_test_of_a_launched_system_presses_it(system: System) -> None:
    system.launch("wander")
    system.run(2.0)
    assert abs(system.robot().twist.v) > 0.1
    system.publish(TOPIC, Bool(data=True))
    system.run(STANDS_WITHIN)
    place = system.robot().pose
    system.run(10.0)
    assert system.robot().pose == pytest.approx(place, abs=1e-9)
    system.publish(TOPIC, Bool(data=False))
    system.run(2.0)
    assert abs(system.robot().twist.v) > 0.1


def test_a_world_without_a_robot_is_stopped_too(system: System, tmp_path: Path) -> None:
    path = tmp_path / "empty.yaml"
    path.write_text("world: {}\nrobots: []\n")
    system.start(simulation.SimulatedWorld, parameters={"world": str(path)})
    system.run(0.1)  # in its first turn it begins to listen
    system.publish(TOPIC, Bool(data=True))
    system.run(1.0)
    system.publish(TOPIC, Bool(data=False))
    system.run(1.0)
    assert (said(system, "STOP holds"), said(system, "STOP is released")) == (1, 1)


def test_that_robots_listen_changes_no_bit_of_a_run(monkeypatch: pytest.MonkeyPatch) -> None:
    runs = []
    for name in ("with", "without"):
        if name == "without":
            monkeypatch.setattr("robolink.world_node.simulation.StopLock", lambda *_: None)
        runs.append(simulate(read_launch_file(ROOT / "configs" / "follow.yaml", {}), duration=1.0).hash)
    assert runs[0] == runs[1]
