"""The nodes that a student opens first, and teleop: what they do in memory, and that they run as plain programs."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Parameter
from robolink.exceptions import InvalidParameterValueException
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import LaserScan
from tests.commands import Command
from tests.domains import free_domain
from tests.driving import Drive, drive
from tests.nodefiles import ROOT, load_node_file

first, velocity, scans, teleop = map(load_node_file, ("first_node", "velocity_publisher", "scan_subscriber", "teleop"))
COURSE = ["first_node", "velocity_publisher", "scan_subscriber"]


@pytest.fixture
def system() -> Iterator[Drive]:
    with drive() as made:
        yield made


# first_node


def test_the_first_node_greets_once_a_second_as_it_is_told(system: Drive) -> None:
    node = system.add(first.FirstNode)
    system.run(2.5)
    node.set_parameters([Parameter("greeting", value="good morning")])
    system.run(1.0)
    assert system.log == [
        "first_node is there",
        "hello, for the 1st time",
        "hello, for the 2nd time",
        "good morning, for the 3rd time",
    ]


def test_numbers_are_counted_in_english() -> None:
    assert [first.ordinal(each) for each in (1, 2, 3, 4, 11, 12, 13, 21, 102, 111, 113)] == [
        *("1st", "2nd", "3rd", "4th", "11th", "12th", "13th", "21st", "102nd", "111th", "113th"),
    ]


# velocity_publisher


def test_the_speed_rises_by_steps_to_the_top_and_begins_anew(system: Drive) -> None:
    heard = system.hear(Twist, "cmd_vel")
    node = system.add(velocity.VelocityPublisher, {"turn_speed": 0.5})
    system.run(13 * velocity.PERIOD + 0.01)
    assert [each.linear.x for each in heard] == pytest.approx([*(each / 10 for each in range(11)), 0.0, 0.1])
    assert {each.angular.z for each in heard} == {0.5}
    assert system.said("0.30 m/s ahead, turning at 0.50 rad/s") == 1
    node.stop()
    system.run(0.01)
    assert heard[-1] == Twist()


@given(st.floats(0.0, 10.0), st.floats(0.0, 2.0), st.floats(0.0, 10.0))
def test_no_speed_is_beyond_the_top(speed: float, step: float, top: float) -> None:
    assert 0.0 <= velocity.next_speed(speed, step, top) <= top


def test_it_can_be_slowed_down_while_it_runs(system: Drive) -> None:
    heard = system.hear(Twist, "cmd_vel")
    node = system.add(velocity.VelocityPublisher)
    system.run(10 * velocity.PERIOD + 0.01)
    node.set_parameters([Parameter("top_speed", value=0.2)])
    system.run(10 * velocity.PERIOD)
    assert max(each.linear.x for each in heard[11:]) == pytest.approx(0.2)


# scan_subscriber


def ring(*ranges: float) -> LaserScan:
    step = math.tau / max(1, len(ranges))
    return LaserScan(angle_min=-math.pi, angle_increment=step, range_min=0.1, range_max=10.0, ranges=list(ranges))


@pytest.mark.parametrize("scan", [ring(), ring(math.inf, math.nan), ring(0.0, 0.05, 11.0, -1.0), LaserScan()])
def test_a_scan_may_have_met_nothing(scan: LaserScan) -> None:
    assert scans.nearest(scan) == scans.Nearest(math.inf, 0.0)


SEEN = {
    "0.30 m, ahead": ring(4.0, 3.0, 0.3, 2.0),
    "0.40 m, 90 degrees to the left": ring(4.0, math.nan, 3.0, 0.4),
    "0.50 m, 90 degrees to the right": ring(math.inf, 0.5, 3.0, 0.6),
    "0.10 m, ahead": ring(1.0, 1.0, -math.inf, 1.0),  # nearer than the scanner can tell
}


@pytest.mark.parametrize(("words", "scan"), SEEN.items())
def test_it_says_where_the_nearest_thing_is(words: str, scan: LaserScan) -> None:
    assert scans.said(scans.nearest(scan)) == words


@given(st.lists(st.floats(width=32), max_size=20), st.floats(-1.0, 1.0))
def test_no_scan_is_too_odd(ranges: list[float], step: float) -> None:
    found = scans.nearest(LaserScan(angle_increment=step, range_min=0.1, range_max=10.0, ranges=ranges))
    assert found.distance == math.inf or 0.1 <= found.distance <= 10.0
    assert scans.said(found)


def test_it_warns_of_what_is_near_and_once_a_second_at_most(system: Drive) -> None:
    node = system.add(scans.ScanSubscriber)
    publisher = system.probe.create_publisher(LaserScan, "scan", 10)
    seen = [ring(2.0, 2.0, 1.0, 2.0)]
    system.probe.create_timer(0.1, lambda: publisher.publish(seen[0]))
    system.run(3.05)
    assert (system.said("the way is free: 1.00 m, ahead"), system.said("obstacle near")) == (3, 0)
    seen[0] = ring(2.0, 2.0, 0.4, 2.0)
    system.run(3.05)
    assert system.said("obstacle near: 0.40 m, ahead") in (3, 4)
    node.set_parameters([Parameter("warn_distance", value=0.3)])
    system.log.clear()
    system.run(2.0)
    assert system.said("obstacle near") == 0


# teleop


class Typed:
    """A keyboard that types what it is told."""

    def __init__(self) -> None:
        self.text, self.closed = "", False

    def read(self) -> str:
        text, self.text = self.text, ""
        return text

    def close(self) -> None:
        self.closed = True


SIDEWAYS = {
    "J": (0.0, 0.3),
    "L": (0.0, -0.3),
    "A": (0.0, 0.3),
    "D": (0.0, -0.3),
    "U": (0.3, 0.3),
    "O": (0.3, -0.3),
    "M": (-0.3, 0.3),
    ">": (-0.3, -0.3),
    "<": (-0.3, 0.0),
    "I": (0.3, 0.0),
}
"""As teleop_twist_keyboard has them for robots that go sideways: shift, and the key for the direction."""


@pytest.mark.parametrize(("key", "expected"), SIDEWAYS.items())
def test_with_shift_a_key_asks_for_a_way_to_the_side(key: str, expected: tuple[float, float]) -> None:
    (read,) = teleop.keys(key)
    assert teleop.wanted(read, teleop.Speeds()) == Twist(linear=Vector3(x=expected[0], y=expected[1]))


def test_the_keys_of_the_speeds_set_parameters_within_their_ranges(system: Drive) -> None:
    keyboard = Typed()
    node = system.add(teleop.Teleop, {"speed": 1.0, "turn_speed": 1.0}, keyboard=keyboard)
    for text, v, w in (("q", 1.1, 1.1), ("r", 1.21, 1.1), ("f", 1.1, 1.1), ("E", 1.1, 1.21), ("cz", 1.0, 1.0)):
        keyboard.text = text
        system.run(0.1)
        assert (node.get_parameter("speed").value, node.get_parameter("turn_speed").value) == pytest.approx((v, w))
    keyboard.text = "r" * 100
    system.run(0.1)
    assert 9.0 < node.get_parameter("speed").value <= 10.0
    assert any("out of range" in line for line in system.log)


def test_speeds_set_from_elsewhere_count_from_the_next_key_on(system: Drive) -> None:
    heard, keyboard = system.hear(Twist, "cmd_vel"), Typed()
    node = system.add(teleop.Teleop, keyboard=keyboard)
    node.set_parameters([Parameter("speed", value=0.7), Parameter("timeout", value=0.2)])
    keyboard.text = "w"
    system.run(1.0)
    assert [each.linear.x for each in heard] == [0.7] * 3 + [0.0]
    with pytest.raises(InvalidParameterValueException, match="not within"):
        system.add(teleop.Teleop, {"timeout": 60.0}, keyboard=Typed())


def test_who_ends_it_on_the_way_stops_the_robot(system: Drive) -> None:
    heard, keyboard = system.hear(Twist, "cmd_vel"), Typed()
    node = system.add(teleop.Teleop, keyboard=keyboard)
    keyboard.text = "w"
    system.run(0.2)
    assert heard[-1] != Twist()
    system.remove(node)
    system.run(0.1)
    assert heard[-1] == Twist()
    assert keyboard.closed


# All of them


@pytest.mark.parametrize("name", [*COURSE, "goto", "patrol", "square", "walker", "teleop"])
def test_each_file_says_what_it_is_for_and_each_parameter_too(system: Drive, name: str) -> None:
    module = load_node_file(name)
    assert (module.__doc__ or "").partition("\n")[0].endswith(".")
    (node_class,) = (each for each in vars(module).values() if _is_own_node(each, module))
    options: dict[str, Any] = {"keyboard": Typed()} if name == "teleop" else {}
    node = system.add(node_class, **options)
    everybody_s = ("use_sim_time", "start_type_description_service")
    own = [each for each in node.list_parameters([], 0).names if each not in everybody_s]
    assert own
    for each in node.describe_parameters(own):
        assert each.description, each.name
        is_number = each.type in (Parameter.Type.INTEGER.value, Parameter.Type.DOUBLE.value)
        assert is_number == bool(each.floating_point_range or each.integer_range), each.name


def _is_own_node(found: object, module: Any) -> bool:
    from robolink import Node

    return isinstance(found, type) and issubclass(found, Node) and found.__module__ == module.__name__


@pytest.mark.processes
def test_they_run_as_plain_programs_until_ctrl_c() -> None:
    with free_domain() as domain:
        python = [
            Command(domain, str(ROOT / "nodes" / f"{each}.py"), program=(sys.executable,), merged=True)
            for each in ("first_node", "velocity_publisher")
        ]
        for node, words in zip(python, ("hello, for the 1st time", "0.00 m/s ahead"), strict=True):
            with node:
                node.wait_for(words)
                node.interrupt()
                assert node.end() == 0
