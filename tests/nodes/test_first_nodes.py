"""The nodes that a student opens first: what they do in memory, and that they run as plain programs."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink import Context, Node, Parameter
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.testing import System
from robolink.transport.zenoh import ZenohTransport
from tests.support.commands import Command
from tests.support.domains import free_domain
from tests.support.nodefiles import ROOT, load_node_file
from tests.support.spins import spin_until
from tests.support.systems import Typed, log, made_with, said

first, velocity, scans = map(load_node_file, ("first_node", "velocity_publisher", "scan_subscriber"))
COURSE = ["first_node", "velocity_publisher", "scan_subscriber"]
SEERS = ["line_follower", "blob_chaser", "state_machine"]


# first_node


def test_the_first_node_greets_once_a_second_as_it_is_told(system: System) -> None:
    node = system.start(first.FirstNode)
    system.run(2.5)
    node.set_parameters([Parameter("greeting", value="good morning")])
    system.run(1.0)
    assert log(system) == [
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


def test_the_speed_rises_by_steps_to_the_top_and_begins_anew(system: System) -> None:
    heard = system.messages("cmd_vel")
    node = system.start(velocity.VelocityPublisher, parameters={"turn_speed": 0.5})
    system.run(13 * velocity.PERIOD + 0.01)
    assert [each.linear.x for each in heard] == pytest.approx([*(each / 10 for each in range(11)), 0.0, 0.1])
    assert {each.angular.z for each in heard} == {0.5}
    assert said(system, "0.30 m/s ahead, turning at 0.50 rad/s") == 1
    system.stop(node)
    system.run(0.01)
    assert heard[-1] == Twist()


@given(st.floats(0.0, 10.0), st.floats(0.0, 2.0), st.floats(0.0, 10.0))
def test_no_speed_is_beyond_the_top(speed: float, step: float, top: float) -> None:
    assert 0.0 <= velocity.next_speed(speed, step, top) <= top


def test_it_can_be_slowed_down_while_it_runs(system: System) -> None:
    heard = system.messages("cmd_vel")
    node = system.start(velocity.VelocityPublisher)
    system.run(10 * velocity.PERIOD + 0.01)
    node.set_parameters([Parameter("top_speed", value=0.2)])
    system.run(10 * velocity.PERIOD)
    assert max(each.linear.x for each in heard[11:]) == pytest.approx(0.2)


def test_its_pace_can_be_changed_while_it_runs(system: System) -> None:
    heard = system.messages("cmd_vel")
    node = system.start(velocity.VelocityPublisher, parameters={"period": 1.0})
    system.run(2.5)
    assert len(heard) == 2
    assert not node.set_parameters([Parameter("period", value=0.0)])[0].successful
    node.set_parameters([Parameter("period", value=0.1)])
    system.run(1.05)
    assert len(heard) == 12


def test_it_stops_the_robot_when_ctrl_c_ends_it(system: System) -> None:
    heard = system.messages("cmd_vel")
    system.start("velocity_publisher")
    system.run(3 * velocity.PERIOD + 0.01)
    system.stop("velocity_publisher")
    system.run(0.0)
    assert len(heard) == 4
    assert heard[-2].linear.x > 0.0
    assert heard[-1] == Twist()


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


def test_it_warns_of_what_is_near_and_once_a_second_at_most(system: System) -> None:
    node = system.start(scans.ScanSubscriber)
    publisher = system.node.create_publisher(LaserScan, "scan", 10)
    seen = [ring(2.0, 2.0, 1.0, 2.0)]
    system.node.create_timer(0.1, lambda: publisher.publish(seen[0]))
    system.run(3.05)
    assert (said(system, "the way is free: 1.00 m, ahead"), said(system, "obstacle near")) == (3, 0)
    seen[0] = ring(2.0, 2.0, 0.4, 2.0)
    system.run(3.05)
    assert said(system, "obstacle near: 0.40 m, ahead") in (3, 4)
    node.set_parameters([Parameter("warn_distance", value=0.3)])
    before = said(system, "obstacle near")
    system.run(2.0)
    assert said(system, "obstacle near") == before


# All of them


@pytest.mark.parametrize("name", [*COURSE, *SEERS, "goto", "patrol", "square", "walker", "teleop"])
def test_each_file_says_what_it_is_for_and_each_parameter_too(system: System, name: str) -> None:
    module = load_node_file(name)
    assert (module.__doc__ or "").partition("\n")[0].endswith(".")
    (node_class,) = (each for each in vars(module).values() if _is_own_node(each, module))
    options: dict[str, Any] = {"keyboard": Typed()} if name == "teleop" else {}
    node = system.start(made_with(node_class, **options))
    everybody_s = ("use_sim_time", "start_type_description_service")
    own = [each for each in node.list_parameters([], 0).names if each not in everybody_s]
    assert own
    for each in node.describe_parameters(own):
        assert each.description, each.name
        is_number = each.type in (Parameter.Type.INTEGER.value, Parameter.Type.DOUBLE.value)
        assert is_number == bool(each.floating_point_range or each.integer_range), each.name


def _is_own_node(found: object, module: Any) -> bool:
    return isinstance(found, type) and issubclass(found, Node) and found.__module__ == module.__name__


@pytest.mark.processes
def test_they_run_as_plain_programs_until_ctrl_c_and_leave_the_robot_standing() -> None:
    with free_domain() as domain, a_listener(domain) as (executor, heard):
        python = [
            Command(domain, str(ROOT / "nodes" / f"{each}.py"), program=(sys.executable,), merged=True)
            for each in ("first_node", "velocity_publisher")
        ]
        for node, words in zip(python, ("hello, for the 1st time", "0.20 m/s ahead"), strict=True):
            with node:
                node.wait_for(words)
                node.interrupt()
                assert node.end() == 0
        spin_until(executor, lambda: len(heard) >= 4 and heard[-1] == Twist())


@contextmanager
def a_listener(domain: int) -> Iterator[tuple[SingleThreadedExecutor, list[Twist]]]:
    """Somebody in this process who hears what is said on cmd_vel there."""
    context, heard = Context(transport=ZenohTransport(domain, environ={})), list[Twist]()
    context.init([], domain_id=domain)
    with context, SingleThreadedExecutor(context=context) as executor:
        node = Node("listener", context=context)
        node.create_subscription(Twist, "cmd_vel", heard.append, 100)
        executor.add_node(node)
        yield executor, heard
