"""nav2_amcl: where a robot is on a map, from its odometry and its scans."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from robolink.geometry.plane import Pose, pose_of
from robolink.interfaces.geometry_msgs.msg import PoseWithCovarianceStamped
from robolink.interfaces.nav2_msgs.msg import ParticleCloud
from robolink.interfaces.nav2_msgs.srv import SetInitialPose
from robolink.interfaces.std_srvs.srv import Empty
from robolink.qos import qos_profile_sensor_data
from robolink.testing import System
from robolink.world_node.services import own_type
from tests.support.localization_lives import Files, Judge, initial, search, start, track, written


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Files:
    return written("lab", tmp_path_factory.mktemp("lab"))


@pytest.mark.slow
@pytest.mark.parametrize(("world", "seed"), [("lab", 2), ("office", 1)])
def test_a_wandering_robot_is_followed(world: str, seed: int, tmp_path: Path) -> None:
    """To 5 cm and 1 degree for three minutes, and the covariance holds the truth in 90 % of moments."""
    with System(seed) as system:
        judge = track(system, written(world, tmp_path, seed), seed)
    distance, turn = judge.rms(since=5.0)
    assert (distance < 0.05, turn < 1.0) == (True, True), (distance, turn)
    assert judge.held(since=5.0) >= 0.9
    assert len(judge.moments) > 3500
    assert 0.05 < sum(judge.nees(5.0)) / len(judge.nees(5.0)) < 6.0  # 3 is ideal


@pytest.mark.slow
@pytest.mark.parametrize(("world", "seed"), [("lab", 2), ("office", 4)])
def test_a_robot_that_may_be_anywhere_is_found(world: str, seed: int, tmp_path: Path) -> None:
    with System(seed) as system:
        judge, began = search(system, written(world, tmp_path, seed), seed, 40.0)
        assert system.expect_log("Global initialisation done!")
    assert judge.found_at() - began < 25.0


@pytest.mark.slow
def test_a_robot_that_was_carried_away_is_found_again(tmp_path: Path) -> None:
    """Within half a minute with recovery, at which the log says it; without, the log says what to do."""
    files = written("lab", tmp_path)
    for recovery, words in ((0.1, "it is searched everywhere"), (0.0, "call reinitialize_global_localization")):
        with System(1) as system:
            judge = Judge(system)
            start(system, files, 1, recovery_alpha_fast=recovery, recovery_alpha_slow=0.001, **initial(files.start))
            system.run(20.0)
            at = system.node.get_clock().now().nanoseconds / 1e9
            teleport = own_type("Teleport")
            request = teleport.Request(robot="robot", x=7.0, y=7.0, theta=2.0)
            assert system.call(teleport, "/world/teleport", request).success
            assert "the robot may be elsewhere" in system.expect_log(words, within=15.0).message
            if recovery:
                system.run(40.0)
                assert judge.found_at() - at < 30.0
                assert judge.rms(at + 30.0)[0] < 0.1


@pytest.mark.slow
def test_the_pose_is_published_with_covariance_particles_and_transform(system: System, lab: Files) -> None:
    clouds: list[ParticleCloud] = []
    system.node.create_subscription(ParticleCloud, "particle_cloud", clouds.append, qos_profile_sensor_data)
    heard = system.messages("amcl_pose", PoseWithCovarianceStamped)
    start(system, lab, wander=False, **initial(lab.start))
    pose: PoseWithCovarianceStamped = system.expect("amcl_pose", within=2.0)
    assert pose.header.frame_id == "map"
    assert pose_of(pose.pose.pose) == pytest.approx(lab.start, abs=0.1)
    covariance = pose.pose.covariance
    assert 0.0 < covariance[0] < 0.05
    assert 0.0 < covariance[35] < 0.05
    assert covariance[5] == covariance[30]
    assert not covariance[14]
    first, transform = system.expect("tf", lambda tf: tf.transforms[0].header.frame_id == "map").transforms
    assert transform.child_frame_id == "odom"
    assert first.header.stamp == pose.header.stamp  # so that the pose is known at once
    assert transform.header.stamp.sec + transform.header.stamp.nanosec * 1e-9 > system.time  # it holds for a second
    system.run(0.01)
    assert clouds[-1].header.frame_id == "map"
    assert 500 <= len(clouds[-1].particles) <= 2000
    assert sum(each.weight for each in clouds[-1].particles) == pytest.approx(1.0)
    system.run(1.0)
    assert len(heard) == 1  # at rest only once
    system.call(Empty, "request_nomotion_update")
    system.run(0.3)
    assert len(heard) == 2


def test_without_a_pose_nothing_is_published_and_a_warning_says_what_to_do(system: System, lab: Files) -> None:
    start(system, lab, wander=False)
    system.expect_log("Please set the initial pose", within=3.0)
    system.expect_none("amcl_pose", during=3.0)
    publish_pose(system, lab.start)
    assert pose_of(system.expect("amcl_pose").pose.pose) == pytest.approx(lab.start, abs=0.1)


def publish_pose(system: System, pose: Pose, frame: str = "map", **values: Any) -> PoseWithCovarianceStamped:
    message = PoseWithCovarianceStamped()
    message.header.frame_id = frame
    place, turn = message.pose.pose.position, message.pose.pose.orientation
    place.x, place.y, turn.z, turn.w = pose.x, pose.y, math.sin(pose.theta / 2), math.cos(pose.theta / 2)
    for name, value in values.items():
        setattr(turn if name in "xyzw" else message.pose, name, value)
    system.publish("initialpose", message)
    system.run(0.2)
    return message


@pytest.mark.parametrize(
    ("frame", "values", "words"),
    [
        ("odom", {}, "Ignoring initial pose in frame 'odom': it must be in the global frame, 'map'"),
        ("", {}, "its frame_id is empty"),
        ("map", {"z": 0.0, "w": 0.0}, "expected a quaternion of length 1"),
        ("map", {"w": math.nan}, "expected a quaternion of length 1"),
        ("map", {"covariance": [math.nan] * 36}, "its covariance is not finite"),
    ],
)
def test_an_initial_pose_with_a_mistake_is_refused(
    system: System, lab: Files, frame: str, values: dict[str, Any], words: str
) -> None:
    start(system, lab, wander=False)
    system.run(0.5)
    publish_pose(system, lab.start, frame, **values)
    system.expect_log(words)
    system.expect_none("amcl_pose", during=1.0)


def test_a_pose_by_service_and_one_before_activation(system: System, lab: Files) -> None:
    start(system, lab, wander=False)
    system.run(0.5)
    message = publish_pose(system, Pose(3, 2, 1))
    system.call(SetInitialPose, "set_initial_pose", SetInitialPose.Request(pose=message))
    assert pose_of(system.expect("amcl_pose").pose.pose) == pytest.approx((3, 2, 1), abs=1.0)


@pytest.mark.slow
def test_two_lives_are_the_same(lab: Files) -> None:
    found = []
    for _ in range(2):
        with System(3) as system:
            judge = Judge(system)
            start(system, lab, **initial(lab.start), random_seed=-1)  # its own seed is that of its name
            system.run(5.0)
        found.append([(each.pose.pose, list(each.pose.covariance)) for each in judge.poses])
    assert found[0] == found[1]
    assert len(found[0]) > 5
