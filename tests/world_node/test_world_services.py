"""The services of a simulated world, and their answers to invalid requests."""

from __future__ import annotations

import hashlib
import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robolink import Parameter
from robolink.exceptions import InvalidParameterTypeException
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.testing import System
from robolink.workspace.interfaces import WORKSPACE_TYPES
from robolink.world_node.services import MOST_STEPS, own_type
from tests.support.halls import Delete, SetRate, Spawn, Step, Teleport, asked, refused, robots, simulation
from tests.support.systems import START, ask

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


# Pausing


def test_a_paused_world_stands_still_until_it_is_resumed(system: System, world: Any) -> None:
    odometry = system.messages("/ada/odom")
    system.run(0.1)
    assert asked(system, "pause") == (True, "paused at 0.1 s")
    heard = len(odometry)
    system.run(5.0)
    assert len(odometry) == heard == 5
    assert asked(system, "resume")[0]
    system.run(0.105)
    assert len(odometry) == 10
    stamps = [each.header.stamp.sec * 10**9 + each.header.stamp.nanosec - START for each in odometry]
    assert stamps == [20_000_000 * (i + 1) for i in range(10)]  # what was slept through is not made up for


def test_steps_are_made_one_by_one_while_it_is_paused(system: System, world: Any) -> None:
    scans = system.messages("/ada/scan")
    asked(system, "pause")
    assert asked(system, "step") == (True, "1 steps, at 0.01 s")
    assert asked(system, "step", steps=299) == (True, "299 steps, at 3 s")
    assert len(scans) == 30  # none was lost: whoever listens has a turn between the steps
    system.run(1.0)
    assert world.simulation.world.steps == 300


def test_a_step_of_a_running_world_or_of_an_absurd_number_is_refused(system: System, world: Any) -> None:
    assert "pause it" in refused(asked(system, "step", steps=1))
    asked(system, "pause")
    for steps in (0, -1, -(2**31), MOST_STEPS + 1, 2**31 - 1):
        assert f"got {steps}" in refused(asked(system, "step", steps=steps))
    assert world.simulation.world.steps < 100


@pytest.mark.parametrize("other", ["pause", "resume"])
def test_who_waits_for_steps_is_told_when_something_else_comes_first(system: System, world: Any, other: str) -> None:
    asked(system, "pause")
    client = system.node.create_client(Step, "/world/step")
    future = client.call_async(Step.Request(steps=MOST_STEPS))
    system.wait_until(lambda: world.simulation.world.steps > 0)
    made = world.simulation.world.steps
    assert 0 < made < 100
    assert asked(system, other)[0]
    answer = system.result(future, within=1.0)
    assert answer is not None
    assert not answer.success
    assert "something else" in answer.message


# Reset


def trace(world: Any, system: System) -> str:
    """Have it live a second, with a command at its beginning; a hash of what was published, but for the stamps."""
    digest = hashlib.sha256()

    def note(message: Any) -> None:
        message.header.stamp.sec = message.header.stamp.nanosec = 0
        digest.update(repr(message).encode())

    kinds: dict[str, Any] = {"/ada/scan": LaserScan, "/ada/odom": Odometry, "/bob/ground_truth": Odometry}
    heard = [system.node.create_subscription(kind, topic, note, 100) for topic, kind in kinds.items()]
    cmd_vel = system.node.create_publisher(Twist, "/ada/cmd_vel", 10)
    cmd_vel.publish(Twist(linear=Vector3(x=0.4), angular=Vector3(z=0.3)))
    asked(system, "step", steps=100)
    for each in heard:
        system.node.destroy_subscription(each)
    system.node.destroy_publisher(cmd_vel)
    return digest.hexdigest()


@pytest.mark.slow
def test_after_a_reset_the_same_life_begins_again_and_time_goes_on(system: System, world: Any) -> None:
    asked(system, "pause")
    first, again = trace(world, system), trace(world, system)
    assert first != again
    assert asked(system, "spawn", name="eve", x=5.0, y=5.0)[0]
    assert asked(system, "delete", name="bob")[0]
    assert asked(system, "reset")[0]
    assert list(robots(world)) == ["ada", "bob"]
    assert robots(world)["ada"].pose.x == 2.0
    odometry = system.messages("/bob/odom")
    assert trace(world, system) == first
    assert odometry[0].header.stamp.sec * 10**9 + odometry[0].header.stamp.nanosec == START + 2_020_000_000


def test_a_reset_while_it_runs_keeps_its_pace(system: System, world: Any) -> None:
    system.run(0.5)
    assert asked(system, "reset")[0]
    system.run(1.0)
    assert world.simulation.world.time_ns == pytest.approx(1e9, abs=2e7)


def test_what_a_robot_was_told_before_a_reset_does_not_drive_it_afterwards(system: System, world: Any) -> None:
    cmd_vel = system.node.create_publisher(Twist, "/ada/cmd_vel", 10)
    cmd_vel.publish(Twist(linear=Vector3(x=0.4)))
    system.run(0.2)
    assert robots(world)["ada"].pose.x > 2.0
    asked(system, "reset")
    system.run(1.0)
    assert robots(world)["ada"].pose.x == 2.0


# Teleport


def test_a_robot_is_put_elsewhere(system: System, world: Any) -> None:
    static = system.messages("/tf_static")
    truth = system.messages("/ada/ground_truth")
    asked(system, "pause")
    assert asked(system, "teleport", robot="ada", x=5.0, y=4.0, theta=math.pi / 2)[0]
    asked(system, "step", steps=10)
    pose, odometry = truth[-1].pose.pose, robots(world)["ada"].odometry
    assert (pose.position.x, pose.position.y, pose.orientation.z) == pytest.approx((5.0, 4.0, math.sqrt(0.5)))
    assert (odometry.x, odometry.y, odometry.theta) == pytest.approx((2.0, 2.0, 0.0))
    on_map = static[-1].transforms[0]
    assert (on_map.header.frame_id, on_map.child_frame_id) == ("map", "ada/odom")
    # the map's frame, the odometry's (2, 2) ahead of it and turned by a quarter: there the robot stands
    assert (on_map.transform.translation.x, on_map.transform.translation.y) == pytest.approx((7.0, 2.0))
    assert on_map.transform.rotation.z == pytest.approx(math.sqrt(0.5))


@pytest.mark.parametrize(
    ("fields", "reason"),
    [
        ({"robot": "adda", "x": 5.0, "y": 5.0}, "did you mean 'ada'"),
        ({"robot": "ada", "x": math.nan, "y": 5.0}, "finite"),
        ({"robot": "ada", "x": 5.0, "y": math.inf}, "finite"),
        ({"robot": "ada", "x": 5.0, "y": 5.0, "theta": -math.inf}, "finite"),
        ({"robot": "ada", "x": 1e300, "y": 5.0}, "finite"),
        ({"robot": "ada", "x": 11.0, "y": 5.0}, "outside of the world's size"),
        ({"robot": "ada", "x": 0.1, "y": 5.0}, "wall"),
        ({"robot": "ada", "x": 7.0, "y": 7.0}, "an obstacle"),
        ({"robot": "ada", "x": 2.0, "y": 8.0}, "another robot"),
    ],
)
def test_an_impossible_place_is_refused(system: System, world: Any, fields: dict[str, Any], reason: str) -> None:
    assert reason in refused(asked(system, "teleport", **fields))
    assert robots(world)["ada"].pose.x == 2.0


# The pace


def test_the_pace_is_set_while_it_runs(system: System, world: Any) -> None:
    system.run(1.0)
    assert asked(system, "set_rate", rtf=4.0) == (True, "4 times real time")
    system.run(1.0)
    assert world.simulation.world.time_ns == pytest.approx(5e9, abs=5e7)
    assert world.get_parameter("rtf").value == 4.0
    assert asked(system, "set_rate", rtf=0.0) == (True, "as fast as it goes")


@pytest.mark.parametrize("rtf", [-1.0, math.nan, math.inf, 1000.1])
def test_an_impossible_pace_is_refused(system: System, world: Any, rtf: float) -> None:
    assert "rtf" in refused(asked(system, "set_rate", rtf=rtf))
    assert world.get_parameter("rtf").value == 1.0


@pytest.mark.parametrize("rtf", ["fast", True, [1.0]])
def test_a_pace_that_is_no_number_is_refused(system: System, world: Any, hall: str, rtf: Any) -> None:
    assert not world.set_parameters([Parameter("rtf", value=rtf)])[0].successful
    with pytest.raises(InvalidParameterTypeException, match=r"'rtf' to .*, expecting type 'DOUBLE'"):
        system.start(simulation.SimulatedWorld, parameters={"world": hall, "rtf": rtf})
    assert world.set_parameters([Parameter("rtf", value=2.0)])[0].successful
    system.run(1.0)
    assert world.simulation.world.time_ns == pytest.approx(2e9, abs=5e7)


def test_as_fast_as_it_goes_all_others_have_their_turn(system: System, hall: str) -> None:
    world = system.start(simulation.SimulatedWorld, parameters={"world": hall, "rtf": 0.0})
    odometry = system.messages("/ada/odom")
    system.wait_until(lambda: len(odometry) > 50)
    assert 0 <= world.simulation.world.steps // 2 - len(odometry) <= 1  # one may be under way
    assert asked(system, "pause")[0]
    paused_at = world.simulation.world.steps
    system.run(1.0)
    assert world.simulation.world.steps == paused_at


# Bad input


def test_the_types_are_found_from_everywhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    found = WORKSPACE_TYPES.names("srv")["robolink_interfaces"]
    assert {"Step", "Teleport", "Spawn", "Delete", "SetRate"} <= set(found)
    assert Step.Request().steps == 1


def test_a_users_types_of_the_same_names_change_nothing(
    system: System, hall: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    theirs = tmp_path / "interfaces" / "robolink_interfaces" / "srv"
    theirs.mkdir(parents=True)
    for name in ("Spawn", "Step", "Teleport", "Delete", "SetRate"):
        (theirs / f"{name}.srv").write_text("string who\n---\nbool ok\n")
    monkeypatch.setenv("ROBOLINK_WORKSPACE", str(tmp_path))
    assert WORKSPACE_TYPES.get("robolink_interfaces", "srv", "Spawn") is not Spawn
    assert own_type("Spawn") is Spawn
    world = system.start(simulation.SimulatedWorld, parameters={"world": hall})
    assert asked(system, "spawn", name="eve", x=5.0, y=5.0) == (True, "spawned eve at (5, 5)")
    assert set(robots(world)) == {"ada", "bob", "eve"}


@pytest.mark.processes
def test_nodes_of_users_import_them(tmp_path: Path) -> None:
    program = "from robolink_interfaces.srv import Spawn; print(Spawn.Request(name='eve').name)"
    text = f"from robolink.workspace import use_interfaces; use_interfaces(); {program}"
    found = subprocess.run([sys.executable, "-c", text], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert found.stdout == "eve\n"


numbers = st.floats(allow_nan=True, allow_infinity=True) | st.floats(0, 10)
texts = st.sampled_from(["ada", "bob", "eve", "", "robots: x", "{", "sensors: [{lidar: 3}]"]) | st.text(max_size=30)
REQUESTS = st.one_of(
    st.builds(dict, name=st.just("teleport"), robot=texts, x=numbers, y=numbers, theta=numbers),
    st.builds(dict, name=st.just("delete"), robot=texts),
    st.builds(dict, name=st.just("spawn"), robot=texts, x=numbers, y=numbers, theta=numbers, model=texts),
    st.builds(dict, name=st.just("step"), steps=st.integers(-(2**31), 10)),
    st.builds(dict, name=st.just("set_rate"), rtf=numbers),
    st.builds(dict, name=st.sampled_from(["reset", "pause", "resume"])),
)


@pytest.mark.slow
@given(st.lists(REQUESTS, max_size=12))
@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_no_request_ends_the_node(hall: str, requests: list[dict[str, Any]]) -> None:
    with System() as system:
        world = system.start(simulation.SimulatedWorld, parameters={"world": hall})
        for request in requests:
            name = request.pop("name")
            if name in ("spawn", "delete"):
                request["name"] = request.pop("robot")
            kinds = {"step": Step, "teleport": Teleport, "spawn": Spawn, "delete": Delete, "set_rate": SetRate}
            success, message = ask(system, kinds.get(name, Trigger), f"/world/{name}", **request)
            assert success or message
        system.run(0.02)
        for robot in robots(world).values():
            assert 0.0 <= robot.pose.x <= 10.0
            assert 0.0 <= robot.pose.y <= 10.0
