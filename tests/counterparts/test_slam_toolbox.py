"""slam_toolbox: a robot drives, a map grows, and it is saved, loaded and gone on with, in virtual time."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from robolink.counterparts.nav2_map_server.map_files import grid_of
from robolink.geometry.plane import Pose, placed_on, pose_of
from robolink.interfaces.geometry_msgs.msg import Pose2D, PoseWithCovarianceStamped, TransformStamped, Twist
from robolink.interfaces.lifecycle_msgs.msg import Transition
from robolink.interfaces.lifecycle_msgs.srv import ChangeState
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.nav_msgs.srv import GetMap
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.slam_toolbox.srv import (
    Clear,
    ClearQueue,
    DeserializePoseGraph,
    Pause,
    Reset,
    SaveMap,
    SerializePoseGraph,
)
from robolink.interfaces.std_msgs.msg import String
from robolink.interfaces.std_srvs.srv import Empty
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.interfaces.visualization_msgs.msg import Marker, MarkerArray
from robolink.launch.lookup import find
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.testing import System
from robolink.tf2 import TransformBroadcaster
from robolink.time import Time
from tests.support.mapping_drives import Driver, described
from tests.support.scanned_rooms import ROOM, ranges

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
ASYNC, SYNC, LOCALIZATION = (f"slam_toolbox {each}_slam_toolbox_node" for each in ("async", "sync", "localization"))
ANGLES = np.arange(360) * math.tau / 360


def change(system: System, transition: int) -> bool:
    request = ChangeState.Request(transition=Transition(id=transition))
    return bool(system.call(ChangeState, "/slam_toolbox/change_state", request).success)


def activated(system: System, node: str = ASYNC, **parameters: Any) -> Any:
    started = system.start(node, parameters={"base_frame": "base_link", "minimum_time_interval": 0.0, **parameters})
    assert change(system, Transition.TRANSITION_CONFIGURE)
    assert change(system, Transition.TRANSITION_ACTIVATE)
    return started


class Robot:
    """A robot without a world: it is somewhere in a room, and publishes odometry's transform and a scan there."""

    def __init__(self, system: System) -> None:
        self.system, self.seed = system, 0
        self.pose = self.odometry = Pose(2.0, 1.5)
        self.heard = system.messages("/tf", TFMessage)
        self._tf = TransformBroadcaster(system.node)

    def stamp(self) -> Any:
        return self.system.node.get_clock().now().to_msg()

    def publish_odometry(self) -> None:
        found = []
        for frame, child, pose in (("odom", "base_link", self.odometry), ("base_link", "laser", Pose())):
            transform = TransformStamped(child_frame_id=child)
            transform.header.frame_id, transform.header.stamp = frame, self.stamp()
            transform.transform.translation.x, transform.transform.translation.y = pose.x, pose.y
            transform.transform.rotation.z = math.sin(pose.theta / 2)
            transform.transform.rotation.w = math.cos(pose.theta / 2)
            found.append(transform)
        self._tf.sendTransform(found)

    def scan(self, **fields: Any) -> LaserScan:
        self.seed += 1
        scan = LaserScan(angle_min=0.0, angle_max=ANGLES[-1], angle_increment=math.tau / 360, range_min=0.1)
        scan.range_max, scan.ranges = 12.0, ranges(ROOM, self.pose, seed=self.seed).tolist()
        scan.header.frame_id, scan.header.stamp = "laser", self.stamp()
        for name, value in fields.items():
            setattr(scan, name, value)
        return scan

    def look(self, **fields: Any) -> None:
        self.publish_odometry()
        self.system.publish("/scan", self.scan(**fields))
        self.system.run(0.2)

    def go(self, *steps: Pose) -> None:
        """Make steps, each relative to the one before, and look after each; odometry is 2 % wrong."""
        for step in steps:
            self.pose = placed_on(self.pose, step)
            self.odometry = placed_on(self.odometry, Pose(step.x * 1.02, step.y * 1.02, step.theta * 0.98))
            self.look()


AHEAD, LEFT = Pose(0.55), Pose(0.0, 0.0, 0.6)
ROUND = (*[AHEAD] * 5, LEFT, LEFT, *[AHEAD] * 3)


def map_to_odom(robot: Robot) -> Pose:
    """Return the last transform from map to odometry."""
    for message in reversed(robot.heard):
        for each in message.transforms:
            if each.header.frame_id == "map":
                turn, place = each.transform.rotation, each.transform.translation
                return Pose(place.x, place.y, 2.0 * math.atan2(turn.z, turn.w))
    raise AssertionError("no transform from map")


def where(robot: Robot) -> Pose:
    """Return where the node says that the robot is."""
    return placed_on(map_to_odom(robot), robot.odometry)


@pytest.fixture
def robot(system: System) -> Robot:
    return Robot(system)


@pytest.mark.slow
def test_a_robot_drives_and_a_map_grows(system: System, tmp_path: Path) -> None:
    world = described("lab", movers=False)
    (tmp_path / "lab.yaml").write_text(yaml.safe_dump(world), encoding="utf-8")
    system.start("world", parameters={"world": str(tmp_path / "lab.yaml")})
    node = activated(system, map_update_interval=5.0)
    maps = system.messages("/map", OccupancyGrid)
    driver, robot = Driver([(5.0, 1.0), (5.2, 3.6), (7.0, 3.6), (5.2, 3.6), (5.0, 1.0), (1.2, 1.2)]), system.robot()
    scans = system.messages("/scan", LaserScan)
    system.run(0.5)
    for _ in range(400):
        scan = scans[-1]
        angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
        ahead, turn = driver.speeds(Pose(robot.pose.x, robot.pose.y, robot.pose.theta), np.array(scan.ranges), angles)
        command = Twist()
        command.linear.x, command.angular.z = ahead, turn
        system.publish("/cmd_vel", command)
        system.run(0.1)
    assert len(maps) == pytest.approx(9, abs=1)
    assert maps[-1].info.width > maps[0].info.width - 5
    buffer = node._buffer
    found = buffer.lookup_transform("map", "base_link", Time()).transform.translation
    assert (
        math.dist((found.x, found.y), robot.pose[:2] if isinstance(robot.pose, tuple) else (robot.pose.x, robot.pose.y))
        < 0.1
    )
    answer = system.call(SaveMap, "/slam_toolbox/save_map", SaveMap.Request(name=String(data=str(tmp_path / "mine"))))
    assert answer.result == SaveMap.Response.RESULT_SUCCESS
    saved = grid_of(tmp_path / "mine.yaml")
    cells = np.array(saved.data).reshape(saved.info.height, saved.info.width)
    rows, columns = np.nonzero(cells == 100)
    x = saved.info.origin.position.x + (columns + 0.5) * 0.05
    y = saved.info.origin.position.y + (rows + 0.5) * 0.05
    outer = np.minimum.reduce([np.abs(x), np.abs(x - 10), np.abs(y), np.abs(y - 8)])
    assert outer.min() < 0.05
    assert (x > -0.1).all()
    assert (x < 10.1).all()


def test_nothing_is_offered_before_it_is_active(system: System) -> None:
    system.start(ASYNC)
    assert "/map" not in system.topics
    assert change(system, Transition.TRANSITION_CONFIGURE)
    assert "/slam_toolbox/serialize_map" not in system.services
    assert change(system, Transition.TRANSITION_ACTIVATE)
    assert {"/map", "/map_metadata", "/pose", "/slam_toolbox/graph_visualization"} <= set(system.topics)
    assert "/slam_toolbox/serialize_map" in system.services
    assert change(system, Transition.TRANSITION_DEACTIVATE)
    assert "/slam_toolbox/serialize_map" not in system.services
    assert change(system, Transition.TRANSITION_CLEANUP)
    assert change(system, Transition.TRANSITION_CONFIGURE)
    assert change(system, Transition.TRANSITION_ACTIVATE)
    assert change(system, Transition.TRANSITION_ACTIVE_SHUTDOWN)


def test_the_transform_corrects_odometry(system: System, robot: Robot) -> None:
    activated(system)
    poses = system.messages("/pose", PoseWithCovarianceStamped)
    robot.look()
    assert map_to_odom(robot) == pytest.approx(Pose())
    robot.go(*ROUND)
    found = where(robot)
    assert math.dist(robot.odometry[:2], robot.pose[:2]) > 0.08
    assert math.dist(found[:2], robot.pose[:2]) < 0.03
    assert found.theta == pytest.approx(robot.pose.theta, abs=0.01)
    assert len(poses) == 1 + len(ROUND)
    assert poses[-1].header.frame_id == "map"
    assert math.dist(pose_of(poses[-1].pose.pose)[:2], robot.pose[:2]) < 0.03
    assert 0 < poses[-1].pose.covariance[0] < 0.01


def test_transforms_are_stamped_into_the_future(system: System, robot: Robot) -> None:
    activated(system, transform_timeout=0.25, transform_publish_period=0.02)
    robot.publish_odometry()
    scan = robot.scan()
    system.publish("/scan", scan)
    system.run(0.2)
    (own,) = [each for m in robot.heard for each in m.transforms if each.header.frame_id == "map"]
    later = Time.from_msg(own.header.stamp) - Time.from_msg(scan.header.stamp)
    assert later.nanoseconds == 250_000_000


def test_without_a_period_no_transform_is_published(system: System, robot: Robot) -> None:
    activated(system, transform_publish_period=0.0)
    robot.go(*ROUND[:2])
    with pytest.raises(AssertionError, match="no transform from map"):
        map_to_odom(robot)


def test_the_map_is_latched_and_served(system: System, robot: Robot) -> None:
    activated(system, map_update_interval=1.0)
    assert system.call(GetMap, "/slam_toolbox/dynamic_map").map.info.width == 0
    robot.look()
    first = system.expect("/map")
    assert first.header.frame_id == "map"
    robot.go(*ROUND)
    system.run(1.5)
    grid = system.call(GetMap, "/slam_toolbox/dynamic_map").map
    latched = system.expect("/map")
    assert list(latched.data) == list(grid.data)
    assert system.expect("/map_metadata").width == grid.info.width
    values = set(np.array(grid.data).tolist())
    assert values == {-1, 0, 100}
    assert sum(np.array(grid.data) == 0) > 10_000


def test_the_graph_is_published_where_somebody_listens(system: System, robot: Robot) -> None:
    activated(system, map_update_interval=1.0)
    heard: list[MarkerArray] = []
    system.node.create_subscription(MarkerArray, "/slam_toolbox/graph_visualization", heard.append, 1)
    robot.look()
    robot.go(*ROUND[:3])
    system.run(1.0)
    clear, *balls, lines = heard[-1].markers
    assert clear.action == Marker.DELETEALL
    assert [ball.id for ball in balls] == [0, 1, 2, 3]
    assert len(lines.points) == 6


def test_a_scan_waits_for_odometry(system: System, robot: Robot) -> None:
    node = activated(system)
    system.publish("/scan", robot.scan())
    system.run(0.1)
    assert node.mapper.keyframes == []
    robot.publish_odometry()
    system.run(0.5)
    system.publish("/scan", robot.scan())  # a newer one: the first can never be used
    robot.publish_odometry()
    system.run(0.1)
    assert len(node.mapper.keyframes) == 1


def test_scans_without_odometry_are_dropped_with_the_reason(system: System, robot: Robot) -> None:
    activated(system, base_frame="base_footprint")
    for _ in range(3):
        robot.look()
    system.expect_log("dropped a scan: no transform from base_frame 'base_footprint' to odom_frame 'odom'")


def test_a_scan_whose_frame_is_unknown_is_dropped(system: System, robot: Robot) -> None:
    node = activated(system)
    scan = robot.scan()
    scan.header.frame_id = "camera"
    robot.publish_odometry()
    system.publish("/scan", scan)
    system.expect_log("dropped a scan: where is its frame 'camera' on the robot?")
    assert node.mapper.keyframes == []


@pytest.mark.parametrize(
    "fields",
    [
        {"ranges": np.full(360, np.nan, np.float32)},
        {"ranges": np.full(360, np.inf, np.float32)},
        {"ranges": np.zeros(0, np.float32)},
        {"range_max": 0.0},
        {"range_min": math.nan},
        {"angle_increment": math.nan},
        {"angle_min": math.inf},
        {"ranges": np.full(3, 1.0, np.float32)},
    ],
)
def test_odd_scans_do_no_harm(system: System, robot: Robot, fields: dict[str, Any]) -> None:
    activated(system)
    robot.look(**fields)
    robot.go(AHEAD)
    robot.look(**fields)
    robot.go(*ROUND)
    assert math.dist(where(robot)[:2], robot.pose[:2]) < 0.15


def test_odometry_that_is_not_finite_is_dropped(system: System, robot: Robot) -> None:
    node = activated(system)
    robot.odometry = Pose(1e200, 0.0)
    robot.look()
    system.expect_log("dropped a scan: odometry says")
    assert node.mapper.keyframes == []


def test_time_that_goes_back_begins_odometry_anew(system: System, robot: Robot) -> None:
    activated(system)
    system.run(20.0)
    robot.look()
    robot.go(*ROUND)
    robot.odometry = Pose(-3.0, 7.0, 1.0)
    early = Time(seconds=5).to_msg()
    robot.stamp = lambda: early  # type: ignore[method-assign]
    robot.look()
    robot.look()
    system.expect_log("odometry begins anew")
    assert math.dist(where(robot)[:2], robot.pose[:2]) < 0.05


def test_measurements_are_paused_and_go_on(system: System, robot: Robot) -> None:
    node = activated(system)
    robot.look()
    assert system.call(Pause, "/slam_toolbox/pause_new_measurements").status
    assert system.parameter("/slam_toolbox", "paused_new_measurements") is True
    robot.go(AHEAD, AHEAD)
    assert len(node.mapper.keyframes) == 1
    assert system.call(Pause, "/slam_toolbox/pause_new_measurements").status
    robot.go(AHEAD)
    assert len(node.mapper.keyframes) == 2
    system.call(Clear, "/slam_toolbox/clear_changes")
    system.expect_log("interactive mode disabled")


@pytest.mark.parametrize("pause", [False, True])
def test_a_reset_begins_with_an_empty_map(system: System, robot: Robot, pause: bool) -> None:
    node = activated(system)
    robot.look()
    robot.go(AHEAD, AHEAD)
    request = Reset.Request(pause_new_measurements=pause)
    assert system.call(Reset, "/slam_toolbox/reset", request).result == Reset.Response.RESULT_SUCCESS
    assert node.mapper.keyframes == []
    robot.go(AHEAD)
    assert len(node.mapper.keyframes) == (0 if pause else 1)


def saved(system: System, robot: Robot, path: Path) -> None:
    robot.look()
    robot.go(*ROUND)
    request = SerializePoseGraph.Request(filename=str(path))
    answer = system.call(SerializePoseGraph, "/slam_toolbox/serialize_map", request)
    assert answer.result == SerializePoseGraph.Response.RESULT_SUCCESS


def test_a_map_is_saved_and_gone_on_with(system: System, robot: Robot, tmp_path: Path) -> None:
    node = activated(system)
    saved(system, robot, tmp_path / "mine")
    assert [each.name for each in tmp_path.iterdir()] == ["mine.posegraph"]
    before, count = robot.pose, len(node.mapper.keyframes)
    assert system.call(Reset, "/slam_toolbox/reset").result == 0
    robot.odometry = Pose(50.0, 3.0, -2.0)  # as after a start of the robot's own
    request = DeserializePoseGraph.Request(filename=str(tmp_path / "mine"), match_type=2)
    request.initial_pose = Pose2D(x=before.x + 0.3, y=before.y - 0.2, theta=before.theta + 0.1)
    system.call(DeserializePoseGraph, "/slam_toolbox/deserialize_map", request)
    robot.look()
    assert math.dist(where(robot)[:2], robot.pose[:2]) < 0.05
    robot.go(Pose(-0.6), Pose(-0.6))
    assert math.dist(where(robot)[:2], robot.pose[:2]) < 0.05
    assert len(node.mapper.keyframes) == count + 3


def test_a_map_is_gone_on_with_from_its_first_pose(system: System, robot: Robot, tmp_path: Path) -> None:
    activated(system)
    saved(system, robot, tmp_path / "mine")
    robot.pose, robot.odometry = Pose(2.1, 1.5), Pose()
    request = DeserializePoseGraph.Request(filename=str(tmp_path / "mine.posegraph"), match_type=1)
    system.call(DeserializePoseGraph, "/slam_toolbox/deserialize_map", request)
    robot.look()
    assert math.dist(where(robot)[:2], (2.1, 1.5)) < 0.05


@pytest.mark.parametrize(
    ("request_", "said"),
    [
        (DeserializePoseGraph.Request(filename="", match_type=1), "No map file given!"),
        (DeserializePoseGraph.Request(filename="/nowhere/x", match_type=1), "x.posegraph: No such file or directory"),
        (DeserializePoseGraph.Request(filename="x", match_type=0), "match_type: expected 1"),
        (DeserializePoseGraph.Request(filename="x", match_type=3), "in non-localization mode"),
        (
            DeserializePoseGraph.Request(filename="x", match_type=2, initial_pose=Pose2D(x=math.nan)),
            "initial_pose: expected finite numbers",
        ),
    ],
)
def test_a_load_that_fails_leaves_the_map(system: System, robot: Robot, request_: Any, said: str) -> None:
    node = activated(system)
    robot.look()
    system.call(DeserializePoseGraph, "/slam_toolbox/deserialize_map", request_)
    system.expect_log(said)
    assert len(node.mapper.keyframes) == 1


def test_what_cannot_be_saved_says_so(system: System, robot: Robot, tmp_path: Path) -> None:
    activated(system)
    result = system.call(
        SerializePoseGraph, "/slam_toolbox/serialize_map", SerializePoseGraph.Request(filename="x")
    ).result
    assert result == SerializePoseGraph.Response.RESULT_FAILED_TO_WRITE_FILE
    system.expect_log("there is nothing to save")
    assert system.call(SaveMap, "/slam_toolbox/save_map").result == SaveMap.Response.RESULT_NO_MAP_RECEIEVD
    robot.look()
    request = SerializePoseGraph.Request(filename=str(tmp_path / "no/x"))
    assert system.call(SerializePoseGraph, "/slam_toolbox/serialize_map", request).result != 0
    system.expect_log("Failed to save the pose graph")
    name = String(data=str(tmp_path / "no/x"))
    assert system.call(SaveMap, "/slam_toolbox/save_map", SaveMap.Request(name=name)).result == 255


@pytest.mark.parametrize(
    ("start", "error"), [([2.0, 1.5, 0.0], ""), ([], ""), ([1.0], "expected [x, y, theta], got [1.0]")]
)
def test_a_map_named_by_parameters_is_loaded(
    system: System, robot: Robot, tmp_path: Path, start: list[float], error: str
) -> None:
    activated(system)
    saved(system, robot, tmp_path / "mine")
    assert change(system, Transition.TRANSITION_DEACTIVATE)
    assert change(system, Transition.TRANSITION_CLEANUP)
    system.set_parameter("/slam_toolbox", "map_file_name", str(tmp_path / "mine"))
    system.set_parameter("/slam_toolbox", "map_start_pose", start)
    system.set_parameter("/slam_toolbox", "map_start_at_dock", True)
    assert change(system, Transition.TRANSITION_CONFIGURE)
    assert change(system, Transition.TRANSITION_ACTIVATE)
    if error:
        system.expect_log(error)
    robot.pose, robot.odometry = Pose(2.0, 1.5), Pose(9.0, 9.0)
    robot.look()
    assert math.dist(where(robot)[:2], (2.0, 1.5)) < 0.05


def test_every_scan_is_used_by_the_synchronous_node(system: System, robot: Robot) -> None:
    node = activated(system, SYNC)
    system.publish("/scan", robot.scan())
    system.run(0.1)
    robot.pose = robot.odometry = placed_on(robot.pose, AHEAD)
    late = robot.scan()
    system.publish("/scan", late)
    system.run(0.1)
    robot.publish_odometry()
    system.run(0.2)
    assert system.call(ClearQueue, "/slam_toolbox/clear_queue").status
    robot.go(AHEAD)
    assert len(node.mapper.keyframes) >= 1


@pytest.mark.slow
def test_a_robot_is_localized_in_a_saved_map(system: System, robot: Robot, tmp_path: Path) -> None:
    activated(system)
    saved(system, robot, tmp_path / "mine")
    system.stop("/slam_toolbox")
    robot.pose, robot.odometry = Pose(2.0, 1.5), Pose(9.0, 9.0, 1.0)
    start = [2.3, 1.3, 0.1]
    node = activated(system, LOCALIZATION, map_file_name=str(tmp_path / "mine"), map_start_pose=start)
    robot.look()
    count = len(node.mapper.keyframes)
    robot.go(*ROUND)
    assert len(node.mapper.keyframes) == count
    assert math.dist(where(robot)[:2], robot.pose[:2]) < 0.06
    robot.pose = Pose(4.0, 1.8, 2.0)  # carried, and told so
    message = PoseWithCovarianceStamped()
    message.header.frame_id, message.pose.pose.orientation.z = "map", math.sin(1.1)
    message.pose.pose.orientation.w = math.cos(1.1)
    message.pose.pose.position.x, message.pose.pose.position.y = 4.2, 1.6
    system.publish("/initialpose", message)
    system.run(0.1)
    robot.look()
    assert math.dist(where(robot)[:2], robot.pose[:2]) < 0.06
    system.call(Empty, "/slam_toolbox/clear_localization_buffer")
    request = DeserializePoseGraph.Request(filename=str(tmp_path / "mine"), match_type=1)
    system.call(DeserializePoseGraph, "/slam_toolbox/deserialize_map", request)
    system.expect_log("Requested a non-localization deserialization in localization mode.")
    message.pose.pose.position.x = math.nan
    system.publish("/initialpose", message)
    system.expect_log("Ignoring initial pose: expected finite numbers")


def test_localization_without_a_map_says_what_to_do(system: System, robot: Robot) -> None:
    activated(system, LOCALIZATION)
    robot.look()
    system.expect_log("set map_file_name, or call slam_toolbox/deserialize_map")


@pytest.mark.slow
def test_a_robot_that_is_carried_away_is_reported(system: System, robot: Robot) -> None:
    activated(system)
    robot.look()
    robot.go(*ROUND)
    robot.pose = Pose(8.0, 2.0, 1.5)
    robot.go(*[Pose(0.3, 0.0, 0.4)] * 6)
    system.expect_log("was it carried away?")


def test_parameters_that_make_no_sense_are_replaced(system: System, robot: Robot) -> None:
    node = activated(system, resolution=-1.0, throttle_scans=0, ceres_loss_function="None", minimum_travel_distance=1e9)
    system.expect_log("resolution: expected 0.005 to 10, got -1: using 0.05")
    system.expect_log("parameters without effect in robolink: ceres_loss_function")
    robot.look()
    assert node.mapper.options.resolution == 0.05
    assert len(node.mapper.keyframes) == 1


@pytest.mark.slow
@pytest.mark.parametrize("name", ["online_async", "online_sync", "localization"])
def test_the_package_s_launch_files_activate_a_node(system: System, robot: Robot, name: str) -> None:
    file = find(("slam_toolbox", f"{name}_launch.py"))
    system.launch(str(file), arguments={"use_sim_time": "false"})
    if name == "localization":
        system.expect_log("map.posegraph: No such file or directory")
    system.expect_log("Activating")
    robot.look()
    if name != "localization":
        assert system.expect("/map").header.frame_id == "map"
