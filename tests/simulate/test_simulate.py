"""Simulating a launch file: what is counted, that a run is the same twice, faults, and what counts as a failure."""

from __future__ import annotations

import os
import random
import re
from pathlib import Path

import numpy as np
import pytest

from robolink import logging
from robolink.exceptions import NotFoundError
from robolink.faults.injector import FaultError
from robolink.launch import read_launch_file
from robolink.logging import Record
from robolink.simulate import Watching, failed_by, simulate, with_parameters
from robolink.simulate.settings import SettingError, parse_settings
from robolink.workspace import find_launch
from tests.support.simulations import simulated, workspace

ROUGH = """
messages:
  - {topic: /chatter, loss: 0.2, duplication: 0.1, latency: 0.05, jitter: 0.05}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return workspace(
        tmp_path,
        fails="nodes:\n  - {node: talker, parameters: {fails_at: 21}}\n  - {node: listener}\n",
        ignored="nodes:\n  - {node: talker, on_exit: ignore, parameters: {fails_at: 21}}\n  - {node: listener}\n",
        again="nodes:\n  - {node: talker, respawn: always, parameters: {fails_at: 21}}\n  - {node: listener}\n",
        waits_in_vain="nodes:\n  - {node: listener, start_after: {topic: /nothing}}\n  - {node: talker}\n",
        waits="nodes:\n  - {node: listener, start_after: talker}\n  - {node: talker}\n",
        gambles="nodes:\n  - {node: gambler}\n  - {node: talker}\n",
        fixed="nodes:\n  - {node: gambler, parameters: {seed: 7}}\n",
        command="nodes:\n  - {node: talker}\n  - {run: [echo, hello], name: echo}\n",
        spares="nodes:\n  - {node: talker, on_exit: ignore}\n  - {node: listener}\n",
    )


def test_messages_are_counted_by_topic(folder: Path) -> None:
    result = simulated(folder)
    assert (result.messages["/chatter"], result.messages["/heard"]) == (100, 100)
    assert (result.seconds, result.failures) == (10.0, [])
    assert [(each.name, each.state) for each in result.programs] == [("talker", "running"), ("listener", "running")]


def test_a_run_is_the_same_twice_and_another_seed_is_another_run(folder: Path) -> None:
    first, again, other = (simulated(folder, seed=seed, faults=ROUGH) for seed in (3, 3, 4))
    assert first.hash == again.hash
    assert first.messages == again.messages
    assert first.hash != other.hash
    assert 60 < first.messages["/heard"] < 100


def test_the_domain_of_the_shell_changes_nothing(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    one = simulated(folder)
    monkeypatch.setenv("ROS_DOMAIN_ID", "8")
    assert simulated(folder).hash == one.hash


def test_whoever_watches_changes_nothing(folder: Path) -> None:
    times: list[float] = []
    watched = simulated(folder, duration=3.5, watching=Watching(time=times.append))
    assert watched.hash == simulated(folder, duration=3.5).hash
    assert times == [1.0, 2.0, 3.0, 3.5]


def test_ctrl_c_ends_a_run_with_what_has_come_until_then(folder: Path) -> None:
    def interrupt(seconds: float) -> None:
        if seconds >= 2.0:
            raise KeyboardInterrupt

    result = simulated(folder, watching=Watching(time=interrupt))
    assert (result.interrupted, result.seconds, result.messages["/chatter"]) == (True, 2.0, 20)
    assert (result.warnings, result.failures) == (["interrupted at 2 of 10 s"], [])


@pytest.mark.slow
def test_a_robots_way_contacts_and_pose_are_told() -> None:
    entries = read_launch_file(find_launch("follow"), {})
    result = simulate(entries, duration=10.0)
    (robot,) = result.robots
    assert robot.name == "robot"
    assert robot.contacts == 0
    assert 2.0 < robot.driven < 3.5
    assert robot.x - 3.0 == pytest.approx(robot.driven, abs=0.2)  # along the first wall
    assert robot.area.width == pytest.approx(robot.driven, abs=0.2)
    assert robot.area.height < 0.6


CIRCLER = '''
"""Drives in a circle of 0.3 m radius."""

from robolink import Node
from robolink.interfaces.geometry_msgs.msg import Twist


class Circler(Node):
    def __init__(self, **options):
        super().__init__("circler", **options)
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.1, self.tick)

    def tick(self):
        twist = Twist()
        twist.linear.x, twist.angular.z = 0.3, 1.0
        self.cmd_vel.publish(twist)
'''


@pytest.mark.slow
def test_a_robot_that_circles_on_the_spot_is_told_from_one_that_gets_on(folder: Path) -> None:
    (folder / "nodes" / "circler.py").write_text(CIRCLER)
    world = "{node: world, parameters: {world: empty_room}}"
    (folder / "configs" / "circle.yaml").write_text(f"nodes:\n  - {world}\n  - {{node: circler}}\n")
    result = simulated(folder, "circle", duration=60.0)
    (robot,) = result.robots
    assert robot.driven > 15.0
    assert (robot.area.width, robot.area.height) == pytest.approx((0.6, 0.6), abs=0.05)  # 0.3 m/s at 1 rad/s
    assert any(
        re.match(r"robot: drove 1\d\.\d\d m within 0\.6\d x 0\.6\d m, 0 contacts", each) for each in result.lines()
    )


def test_robots_of_two_worlds_are_told_apart(folder: Path) -> None:
    world = "{node: world, parameters: {world: empty_room}, namespace: "
    (folder / "configs" / "two.yaml").write_text(f"nodes:\n  - {world}one}}\n  - {world}two}}\n")
    assert [each.name for each in simulated(folder, "two", duration=0.1).robots] == ["one/robot", "two/robot"]


def test_what_a_fault_did_is_told(folder: Path) -> None:
    (report,) = simulated(folder, seed=1, faults=ROUGH).faults
    assert report.met == 100
    assert 5 < report.lost < 40
    assert report.late > 60


def test_a_partition_and_its_end(folder: Path) -> None:
    faults = "partitions: [{between: [talker, listener], after: 2, until: 7}]"
    assert simulated(folder, faults=faults).messages["/heard"] == pytest.approx(50, abs=2)


def test_a_crash_and_a_new_start_are_no_failure(folder: Path) -> None:
    faults = "crashes: [{node: talker, at: 2.05, restart_after: 3}]"
    result = simulated(folder, faults=faults)
    talker = result.programs[0]
    assert (talker.state, talker.crashes, talker.restarts, result.failures) == ("running", 1, 1, [])
    assert result.messages["/chatter"] == 20 + 49


def test_a_crash_without_a_new_start_is_left_to_the_launch_file(folder: Path) -> None:
    faults = "crashes: [{node: talker, at: 2.05}]"
    ended, spared = simulated(folder, faults=faults), simulated(folder, "spares", faults=faults)
    assert ended.seconds == pytest.approx(2.05, abs=0.01)
    assert (spared.seconds, spared.programs[0].state) == (10.0, "crashed")
    assert ended.failures == spared.failures == []


def test_a_clock_that_is_wrong(folder: Path) -> None:
    right = simulated(folder)
    ahead = simulated(folder, faults="clocks: [{node: listener, offset: 0.5}]")
    fast = simulated(folder, faults="clocks: [{node: talker, drift: 0.1}]")
    assert right.messages == ahead.messages
    assert right.hash != ahead.hash
    assert fast.messages["/chatter"] == 110


def test_a_node_that_fails_ends_the_run_and_fails_it(folder: Path) -> None:
    said: list[str] = []
    result = simulated(folder, "fails", watching=Watching(say=said.append))
    assert result.seconds == pytest.approx(2.1)
    assert result.failures == ["talker ended with exit code 1 at 2.100 s: ZeroDivisionError: it was to fail"]
    assert result.programs[0].error == "ZeroDivisionError: it was to fail"
    assert said == ["talker ended with exit code 1: ZeroDivisionError: it was to fail"]


def test_a_node_that_fails_and_is_ignored_fails_the_run_all_the_same(folder: Path) -> None:
    result = simulated(folder, "ignored")
    assert (result.seconds, len(result.failures)) == (10.0, 1)


def test_respawn_holds_in_virtual_time(folder: Path) -> None:
    result = simulated(folder, "again", duration=8.05)
    assert result.programs[0].restarts == 2  # it fails at 2.1 s and at 5.2 s, and waits 1 s and then 2 s
    assert result.messages["/chatter"] == 20 + 20 + 8


def test_start_after_holds_in_virtual_time(folder: Path) -> None:
    assert simulated(folder, "waits").messages["/heard"] == 100


def test_what_waits_for_what_has_ended_ends_the_system(folder: Path) -> None:
    (folder / "nodes" / "gone.py").write_text("print('gone')")
    vain = "nodes: [{node: gone, on_exit: ignore}, {node: listener, start_after: gone}]"
    (folder / "configs" / "vain.yaml").write_text(vain)
    result = simulated(folder, "vain")
    assert result.seconds == 0.0
    assert [(each.name, each.state) for each in result.programs] == [("gone", "ended")]


def test_commands_are_left_out(folder: Path) -> None:
    result = simulated(folder, "command")
    assert result.warnings == ["echo is left out: a command knows no virtual time"]
    assert result.messages["/chatter"] == 100


def test_a_fault_on_a_topic_that_is_not_there_is_a_failure(folder: Path) -> None:
    result = simulated(folder, faults="messages: [{topic: /chater, loss: 1}]")
    (failure,) = result.failures
    assert failure.endswith("no topic '/chater' was received by any node (did you mean '/chatter'?)")
    assert result.warnings == []


def test_a_fault_that_met_nothing_is_told(folder: Path) -> None:
    faults = "messages: [{topic: /chatter, from: listener, loss: 1}, {topic: '*/chater', loss: 1}]"
    result = simulated(folder, faults=faults)
    assert [each.partition(" met ")[2][:32] for each in result.warnings] == ["nothing: nothing went that way ("] * 2
    assert result.failures == []


@pytest.mark.parametrize(
    ("faults", "told"),
    [
        ("messages: [{topic: /chatter, loss: 1, after: 50}]", "/chatter, loss: 1, after: 50} met nothing: the run"),
        ("partitions: [{between: [talker, listener], after: 50}]", "after: 50} met nothing: the run ended before"),
        ("crashes: [{node: talker, at: 50}]", "{node: talker, at: 50} did not happen: the run ended before"),
    ],
)
def test_a_fault_that_would_have_come_later_is_told(folder: Path, faults: str, told: str) -> None:
    (warning,) = simulated(folder, faults=faults).warnings
    assert told in warning


def test_a_node_that_does_not_run_cannot_crash_nor_be_started_by_it(folder: Path) -> None:
    faults = "crashes: [{node: talker, at: 2.05, restart_after: 5}, {node: talker, at: 3, restart_after: 1}]"
    result = simulated(folder, faults=faults)
    assert result.messages["/chatter"] == 20 + 29
    assert result.warnings == ["{node: talker, at: 3, restart_after: 1} did not happen: the node did not run then"]


def test_a_node_that_waits_for_another_cannot_crash(folder: Path) -> None:
    result = simulated(folder, "waits_in_vain", faults="crashes: [{node: listener, at: 1, restart_after: 1}]")
    assert [each.name for each in result.programs] == ["talker"]
    assert result.warnings[0].endswith("did not happen: the node did not run then")


def test_a_clock_that_would_be_before_all_time_is_refused(folder: Path) -> None:
    with pytest.raises(FaultError, match="the clock of listener cannot be 5 s behind: it is 1 s now"):
        simulated(folder, faults="clocks: [{node: listener, offset: -5}]")
    assert simulated(folder, faults="clocks: [{node: listener, offset: -0.5}]").messages["/heard"] == 100


def test_a_seed_is_that_of_random_of_numpy_and_of_parameters(folder: Path) -> None:
    state, array_state = random.getstate(), str(np.random.get_state())
    logs: list[Record] = []
    runs = [simulated(folder, "gambles", seed=seed, watching=Watching(log=logs.append)) for seed in (5, 5, 6)]
    assert runs[0].hash == runs[1].hash != runs[2].hash
    assert [each.message for each in logs if each.severity >= logging.LoggingSeverity.WARN] == []
    assert (random.getstate(), str(np.random.get_state())) == (state, array_state)


CHANCES = """
'Publishes all the chance that Python has from the operating system.'

import os, random, secrets, uuid

import numpy

from robolink import Node
from robolink.interfaces.std_msgs.msg import String


class Chances(Node):
    def __init__(self, **options):
        super().__init__("chances", **options)
        random.seed()
        numpy.random.seed()
        self.drawn = self.create_publisher(String, "drawn", 10)
        self.create_timer(0.1, self.tick)

    def tick(self):
        system = random.SystemRandom().random(), secrets.token_hex(), uuid.uuid4(), os.urandom(8)
        seeded = random.Random().random(), random.random(), numpy.random.default_rng().random(), numpy.random.random()
        self.drawn.publish(String(data=f"{system} {seeded}"))
"""


def test_chance_of_the_operating_system_is_the_seeds(folder: Path) -> None:
    (folder / "nodes" / "chances.py").write_text(CHANCES)
    (folder / "configs" / "two.yaml").write_text("nodes:\n  - {node: chances, count: 2, name: 'c{i}'}\n")
    before = os.urandom, random.Random.seed, random.seed
    first, again, other = (simulated(folder, "two", duration=0.55, seed=seed) for seed in (3, 3, 4))
    assert first.messages["/drawn"] == 10
    assert first.hash == again.hash != other.hash
    assert (os.urandom, random.Random.seed, random.seed) == before
    assert random.Random().random() != random.Random().random()


def test_a_seed_that_a_node_was_given_stays(folder: Path) -> None:
    seeds = [simulated(folder, "fixed", seed=seed).bytes["/seed"] for seed in (5, 6)]
    assert seeds[0] == seeds[1]


CHOOSY = """
'Has a seed that is not just a whole number, but of the kind that it is told.'

from robolink import Node
from robolink.interfaces.rcl_interfaces.msg import IntegerRange, ParameterDescriptor, SetParametersResult
from robolink.interfaces.std_msgs.msg import String

KINDS = {
    "text": ("as it is",),
    "dynamic": ("as it is", ParameterDescriptor(dynamic_typing=True)),
    "range": (3, ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=9, step=1)])),
    "refused": (3,),
    "flag": (False,),
    "double": (0.5,),
    "whole": (3,),
}


class Choosy(Node):
    def __init__(self, **options):
        super().__init__("choosy", **options)
        kind = self.declare_parameter("kind", "").value
        if kind == "refused":
            self.add_on_set_parameters_callback(lambda given: SetParametersResult(successful=given[0].value < 9))
        self.get_logger().warning(repr(self.declare_parameter("seed", *KINDS[kind]).value))
"""


@pytest.mark.parametrize(
    ("kind", "value"),
    [
        ("text", "'as it is'"),
        ("dynamic", "'as it is'"),
        ("range", "3"),
        ("refused", "3"),
        ("flag", "False"),
        ("double", "4711.0"),
        ("whole", "4711"),
    ],
)
def test_a_seed_yields_where_a_node_wants_no_such(folder: Path, kind: str, value: str) -> None:
    (folder / "nodes" / "choosy.py").write_text(CHOOSY)
    (folder / "configs" / "chooses.yaml").write_text(f"nodes:\n  - {{node: choosy, parameters: {{kind: {kind}}}}}\n")
    logs: list[Record] = []
    result = simulated(folder, "chooses", duration=0.1, seed=4711, watching=Watching(log=logs.append))
    assert result.failures == []
    assert [each.message for each in logs if each.severity >= logging.LoggingSeverity.WARN] == [value]


@pytest.mark.slow
def test_a_seed_in_the_faults_is_everybodys(folder: Path) -> None:
    assert simulated(folder, "gambles", faults="seed: 5").hash == simulated(folder, "gambles", seed=5).hash
    assert simulated(folder, "gambles", seed=6, faults="seed: 5").hash == simulated(folder, "gambles", seed=6).hash


def test_parameters_are_set_by_node(folder: Path) -> None:
    entries = read_launch_file(folder / "configs" / "talk.yaml", {})
    changed = with_parameters(entries, parse_settings(["talker.fails_at:=5"]))
    assert simulate(changed, duration=1.0).failures == [
        "talker ended with exit code 1 at 0.500 s: ZeroDivisionError: it was to fail"
    ]
    with pytest.raises(NotFoundError, match=r"no node named 'taker' in the launch file \(did you mean 'talker'\?\)"):
        with_parameters(entries, {"taker.fails_at": 5})


@pytest.mark.parametrize("text", ["talker", "talker:=5", "talker.x", ".x:=1", "talker.:=1"])
def test_a_setting_that_is_none(text: str) -> None:
    with pytest.raises(SettingError, match=r"expected NODE\.PARAMETER:=VALUE"):
        parse_settings([text])


def test_what_else_may_count_as_a_failure(folder: Path) -> None:
    result = simulated(folder, "ignored")
    assert failed_by(result, ["contact", "real-time"]).failures == result.failures
    assert failed_by(result, ["error"]).failures[-1] == "1 error logged"
