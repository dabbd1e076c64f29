"""The state machine: its table, each state by itself, and a walk through all of them in the world `blobs`."""

from __future__ import annotations

import ast
import math
from typing import Any

import pytest

from robolink import Node
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import Image, LaserScan
from robolink.logging import LoggingSeverity
from robolink.testing import System
from tests.support.cameras import BAD, RED, Camera, floor, thing
from tests.support.nodefiles import ROOT, load_node_file
from tests.support.scans import BLIND, ring

machine = load_node_file("state_machine")
STATES = set(machine.TIMEOUTS)


class Senses(Camera):
    """A camera, and a scanner beside it."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.seen: LaserScan | None = ring(*[5.0] * 36)
        self.scans = self.create_publisher(LaserScan, "scan", 10)

    def on_timer(self) -> None:
        super().on_timer()
        if self.seen is not None:
            self.scans.publish(self.seen)


def view(offset: float | None = None, free: float = 9.0, behind: float = 9.0, lasted: float = 0.0) -> Any:
    return machine.View(offset, free, behind, True, lasted)


@pytest.fixture
def node(system: System) -> Any:
    return system.start("state_machine")


def lines(system: System) -> list[str]:
    """The log of the node, without the numbers of seconds."""
    return [each.message.partition(" after")[0] for each in system.logs if each.name == "state_machine"]


def test_every_event_of_a_state_has_a_transition_and_every_transition_an_event(node: Node) -> None:
    told: dict[str, set[str]] = {each: set() for each in STATES}
    for state in STATES - {"wait"}:
        told[state].add("timeout")
    tree = ast.parse((ROOT / "nodes" / "state_machine.py").read_text(encoding="utf-8"))
    (own,) = (each for each in tree.body if isinstance(each, ast.ClassDef) and each.name == "StateMachine")
    for method in own.body:
        if isinstance(method, ast.FunctionDef) and method.name in STATES:
            returned = [each for each in ast.walk(method) if isinstance(each, ast.Return)]
            texts = [each.value for one in returned for each in ast.walk(one) if isinstance(each, ast.Constant)]
            told[method.name] |= {each for each in texts if each and isinstance(each, str)}
    assert {(state, event) for state, events in told.items() for event in events} == set(machine.TRANSITIONS)
    assert set(machine.TRANSITIONS.values()) | {"wait"} == STATES
    assert all(each > 0.0 for each in machine.TIMEOUTS.values())


def test_every_parameter_says_what_it_is_and_which_values_it_takes(node: Node) -> None:
    for name in machine.Settings._fields:
        descriptor, value = node.describe_parameter(name), node.get_parameter(name).value
        limits = (descriptor.floating_point_range or descriptor.integer_range)[0]
        assert descriptor.description
        assert limits.from_value <= value <= limits.to_value


def test_wander_drives_slows_down_and_turns_until_it_sees(node: Any) -> None:
    assert node.wander(view())[0].linear.x == pytest.approx(0.3)
    assert 0.0 < node.wander(view(free=0.7))[0].linear.x < 0.2
    twist, event = node.wander(view(free=0.4))
    assert (twist.linear.x, twist.angular.z, event) == (0.0, 1.0, "")
    assert node.wander(view(offset=0.9)) == (Twist(), "seen")


def test_see_turns_to_the_blob_until_it_is_sure(node: Any) -> None:
    assert node.see(view(offset=0.5))[0].angular.z == pytest.approx(-0.5)
    assert node.see(view(offset=0.1, lasted=0.5))[1] == ""
    assert node.see(view(offset=0.1, lasted=1.5)) == (Twist(), "sure")
    assert node.see(view(lasted=0.5)) == (Twist(), "")
    assert node.see(view(lasted=1.5)) == (Twist(), "lost")


def test_approach_stops_where_something_is_near(node: Any) -> None:
    twist, event = node.approach(view(offset=-0.2))
    assert event == ""
    assert 0.1 < twist.linear.x < 0.3
    assert twist.angular.z == pytest.approx(0.2)
    assert node.approach(view(offset=0.0, free=0.51))[0].linear.x == machine.SLOWEST
    assert node.approach(view(offset=0.0, free=0.5)) == (Twist(), "reached")
    assert node.approach(view(free=3.0)) == (Twist(), "lost")


def test_back_off_drives_back_if_there_is_room_and_turns_about(node: Any) -> None:
    assert node.back_off(view(lasted=0.5))[0].linear.x == pytest.approx(-0.15)
    assert node.back_off(view(lasted=0.5, behind=0.3))[0].linear.x == 0.0
    assert node.back_off(view(lasted=2.0))[0].angular.z == pytest.approx(1.0)
    assert node.back_off(view(lasted=5.0)) == (Twist(), "done")


def test_a_state_that_lasts_too_long_ends(system: System, node: Any) -> None:
    senses = system.start(Senses)
    system.run(21.0)
    assert lines(system) == ["wait -> wander: ready", "wander -> back_off: timeout"]
    senses.show(thing(RED, slice(40, 60), slice(0, 20)))  # wherever it turns
    system.run(12.0)
    assert lines(system)[2:5] == ["back_off -> wander: done", "wander -> see: seen", "see -> back_off: timeout"]


@pytest.mark.parametrize("sensor", ["image", "scan"])
def test_without_a_sensor_it_stands_says_so_once_and_begins_anew(system: System, node: Any, sensor: str) -> None:
    senses = system.start(Senses)
    system.run(2.0)
    assert senses.heard[-1].linear.x > 0.2
    shown, seen = senses.shown, senses.seen
    senses.show(None) if sensor == "image" else setattr(senses, "seen", None)
    system.run(5.0)
    assert senses.heard[-1] == Twist()
    warnings = [each.message for each in system.logs if each.severity >= LoggingSeverity.WARN]
    topic = "/camera/image_raw" if sensor == "image" else "/scan"
    assert warnings == [f"no {sensor} on {topic} for 1 s: the robot stands until one comes"]
    assert lines(system)[1] == f"wander -> wait: no {sensor}"
    count = len(senses.heard)
    system.run(1.0)
    assert len(senses.heard) == count, "others may drive it meanwhile"
    senses.shown, senses.seen = shown, seen
    system.run(1.0)
    assert senses.heard[-1].linear.x > 0.2


def test_at_the_start_it_waits_for_the_sensors(system: System, node: Any) -> None:
    system.run(4.9)
    assert lines(system) == []
    system.run(10.0)
    assert lines(system) == ["no image on /camera/image_raw for 5 s: the robot stands until one comes"]


@pytest.mark.slow
@pytest.mark.parametrize("image", [each for each, _ in BAD.values()], ids=BAD)
def test_bad_images_are_none(system: System, node: Any, image: Image) -> None:
    senses = system.start(Senses)
    system.run(2.0)
    senses.show(image)
    system.run(4.0)
    assert senses.heard[-1] == Twist()
    assert len([each for each in system.logs if each.severity >= LoggingSeverity.WARN]) <= 2
    senses.show(floor())
    system.run(1.0)
    assert senses.heard[-1].linear.x > 0.2


@pytest.mark.parametrize("scan", BLIND)
def test_it_does_not_drive_blindly(system: System, node: Any, scan: LaserScan) -> None:
    senses = system.start(Senses)
    senses.seen = scan
    system.run(7.0)
    assert senses.heard == []
    assert "ignored a scan that does not look ahead" in lines(system)


def test_it_stops_the_robot_at_its_end(system: System, node: Any) -> None:
    senses = system.start(Senses)
    system.run(2.0)
    system.stop(node)
    system.run(0.01)
    assert senses.heard[-1] == Twist()


@pytest.mark.slow
def test_it_visits_a_blob_and_goes_through_all_states(system: System) -> None:
    system.start("world", parameters={"world": "blobs"})
    node = system.start("state_machine")
    states = system.messages("/state")
    system.wait_until(lambda: "approach -> back_off: reached" in lines(system), within=120.0)
    robot = system.robot().pose
    assert math.dist((robot.x, robot.y), (1.2, 4.8)) < 0.8
    system.run(10.0)
    assert node.state in STATES
    assert {each.data for each in states} >= {"wander", "see", "approach", "back_off"}
    assert system.robot().contacts == 0
