"""nav2_costmap_2d: costmaps of a map and of scans, in virtual time."""

from __future__ import annotations

import math
import random
from typing import Any

import numpy as np
import pytest

from robolink.interfaces.geometry_msgs.msg import Polygon, PolygonStamped, PoseStamped, TransformStamped
from robolink.interfaces.lifecycle_msgs.msg import Transition
from robolink.interfaces.lifecycle_msgs.srv import ChangeState
from robolink.interfaces.nav2_msgs.msg import Costmap as CostmapMsg
from robolink.interfaces.nav2_msgs.srv import (
    ClearCostmapAroundPose,
    ClearCostmapAroundRobot,
    ClearCostmapExceptRegion,
    ClearEntireCostmap,
    GetCostmap,
    GetCosts,
)
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.sensor_msgs.msg import LaserScan, PointCloud2
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.testing import System
from robolink.tf2.static_transform_broadcaster import StaticTransformBroadcaster
from tests.support.hostile_values import Hostile

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
SCAN = {
    "obstacle_layer.observation_sources": "scan",
    "obstacle_layer.scan.clearing": True,
    "obstacle_layer.scan.max_obstacle_height": 2.0,
}
PLAIN = {"resolution": 0.1, "robot_radius": 0.12, "footprint_padding": 0.0, "publish_frequency": 5.0}


def change(system: System, transition: int) -> bool:
    request = ChangeState.Request(transition=Transition(id=transition))
    return bool(system.call(ChangeState, "/costmap/change_state", request).success)


def started(system: System, **parameters: Any) -> None:
    """Start a costmap that is active."""
    system.start("nav2_costmap_2d nav2_costmap_2d", parameters=PLAIN | parameters)
    assert change(system, Transition.TRANSITION_CONFIGURE)
    assert change(system, Transition.TRANSITION_ACTIVATE)


def transform(system: System, child: str, parent: str, x: float, y: float, z: float = 0.0) -> None:
    found = TransformStamped(child_frame_id=child)
    found.header.frame_id = parent
    found.transform.translation.x, found.transform.translation.y, found.transform.translation.z = x, y, z
    StaticTransformBroadcaster(system.node).sendTransform(found)


def publish_map(system: System, cells: np.ndarray, resolution: float = 0.1) -> None:
    message = OccupancyGrid(data=cells.astype(np.int8).ravel())
    message.header.frame_id = "map"
    message.info.resolution = resolution
    message.info.height, message.info.width = cells.shape
    system.publish("/map", message, qos=LATCHED)


def scan(system: System, ranges: list[float], frame: str = "laser") -> None:
    """Publish a scan of four beams: ahead, to the left, back, to the right."""
    message = LaserScan(angle_increment=math.pi / 2, range_min=0.05, range_max=10.0, ranges=ranges)
    message.header.frame_id = frame
    message.header.stamp = system.node.get_clock().now().to_msg()
    system.publish("/scan", message)


def costs(system: System) -> np.ndarray:
    """Return the costs by the service."""
    found = system.call(GetCostmap, "/get_costmap").map
    return np.array(found.data, np.uint8).reshape(found.metadata.size_y, found.metadata.size_x)


def test_a_map_is_inflated_and_published(system: System) -> None:
    started(system, **{"track_unknown_space": True, "inflation_layer.inflation_radius": 0.5})
    transform(system, "base_link", "map", 1.0, 1.0)
    cells = np.zeros((20, 30))
    cells[10, 20], cells[:, :3] = 100, -1
    publish_map(system, cells)
    heard: list[OccupancyGrid] = []
    raw: list[CostmapMsg] = []
    system.node.create_subscription(OccupancyGrid, "/costmap", heard.append, LATCHED)
    system.node.create_subscription(CostmapMsg, "/costmap_raw", raw.append, LATCHED)
    system.run(1.0)
    grid = np.array(heard[-1].data, int).reshape(20, 30)
    assert (grid[10, 20], grid[10, 21], grid[0, 0], grid[0, 15]) == (100, 99, -1, 0)
    assert 99 > grid[10, 22] > grid[10, 23] > 0
    assert grid[10, 22] == grid[12, 20] == grid[8, 20]
    found = np.array(raw[-1].data, int).reshape(20, 30)
    assert (found[10, 20], found[10, 21], found[0, 0]) == (254, 253, 255)
    assert found[10, 22] == int(252 * math.exp(-10 * (0.2 - 0.12 * math.cos(math.pi / 16))))
    assert (heard[-1].header.frame_id, raw[-1].metadata.layer) == ("map", "master")
    assert len(heard) == 6  # with the map, and then each 0.2 s
    system.expect_log("Resizing costmap to 30 X 20 at 0.1")


def test_a_map_of_another_size_leaves_no_moment_without_costs(system: System) -> None:
    node = system.start("nav2_costmap_2d nav2_costmap_2d", parameters=PLAIN | {"update_frequency": 0.5})
    assert change(system, Transition.TRANSITION_CONFIGURE)
    assert change(system, Transition.TRANSITION_ACTIVATE)
    transform(system, "base_link", "map", 1.0, 1.0)
    for size in (20, 30):
        cells = np.zeros((size, size))
        cells[15, 15] = 100
        publish_map(system, cells)
        system.run(0.01)
        assert node.is_current()
        assert costs(system)[15, 15] == 254


def test_scans_mark_and_free(system: System) -> None:
    started(system, **SCAN)
    transform(system, "base_link", "map", 1.05, 1.05)
    transform(system, "laser", "base_link", 0.0, 0.0, 0.2)
    publish_map(system, np.zeros((30, 30)))
    scan(system, [1.0, 1.0, math.inf, math.nan])
    system.run(0.5)
    found = costs(system)
    assert (found[10, 20], found[20, 10]) == (254, 254)
    scan(system, [1.5, 1.0, math.inf, math.nan])
    system.run(0.5)
    found = costs(system)
    assert found[10, 20] < 100  # inflated, but no obstacle any more
    assert (found[10, 25], found[20, 10]) == (254, 254)


def test_services_clear_what_was_seen(system: System) -> None:
    started(system, **SCAN)
    transform(system, "base_link", "map", 1.05, 1.05)
    transform(system, "laser", "base_link", 0.0, 0.0, 0.2)
    publish_map(system, np.zeros((30, 30)))
    system.run(0.3)

    def seen() -> tuple[bool, bool]:
        found = costs(system)
        return bool(found[10, 15] == 254), bool(found[20, 10] == 254)

    def saw() -> None:
        scan(system, [0.5, 1.0, math.inf, math.nan])
        system.run(0.3)
        assert seen() == (True, True)
        scan(system, [math.nan] * 4)  # so that the update which follows marks nothing again
        system.run(0.3)
        assert seen() == (True, True)

    saw()
    system.call(ClearEntireCostmap, "/clear_entirely_costmap")
    assert seen() == (False, False)
    saw()
    system.call(ClearCostmapExceptRegion, "/clear_except_costmap", ClearCostmapExceptRegion.Request(reset_distance=1.5))
    assert seen() == (True, False)
    saw()
    system.call(ClearCostmapAroundRobot, "/clear_around_costmap", ClearCostmapAroundRobot.Request(reset_distance=1.5))
    assert seen() == (False, True)
    saw()
    system.call(
        ClearCostmapAroundRobot, "/clear_around_costmap", ClearCostmapAroundRobot.Request(reset_distance=math.nan)
    )
    system.expect_log("expected a reset_distance of 0 or more metres, got nan")
    request = ClearCostmapAroundPose.Request(reset_distance=0.5)
    request.pose.header.frame_id = "base_link"
    request.pose.pose.position.y = 1.0
    system.call(ClearCostmapAroundPose, "/clear_around_pose_costmap", request)
    assert seen() == (True, False)


def test_a_rolling_costmap_follows_the_robot(system: System) -> None:
    started(system, **SCAN, rolling_window=True, width=3, height=3, global_frame="odom", plugins=["obstacle_layer"])
    transform(system, "odom", "map", 0.0, 0.0)
    transform(system, "base_link", "odom", 10.05, -3.95)
    transform(system, "laser", "base_link", 0.0, 0.0, 0.2)
    system.run(0.3)
    scan(system, [1.0, 1.0, 0.5, 0.5])
    footprints = system.messages("/published_footprint", PolygonStamped)
    system.run(1.0)
    assert np.argwhere(costs(system) == 254).tolist() == [[10, 15], [15, 10], [15, 25], [25, 15]]
    found = system.call(GetCostmap, "/get_costmap").map.metadata
    assert (found.origin.position.x, found.origin.position.y) == pytest.approx((8.5, -5.5))
    assert len(footprints[-1].polygon.points) == 16
    assert footprints[-1].polygon.points[0].x == pytest.approx(10.17)
    transform(system, "base_link", "odom", 10.55, -3.95)
    system.run(0.5)
    # What was seen stays where it is in the world.
    assert [15, 20] in np.argwhere(costs(system) == 254).tolist()


def test_costs_of_poses(system: System) -> None:
    started(system)
    transform(system, "base_link", "map", 1.0, 1.0)
    cells = np.zeros((30, 30))
    cells[10, 20] = 100
    publish_map(system, cells)
    system.run(0.5)
    request = GetCosts.Request(poses=[PoseStamped(), PoseStamped(), PoseStamped()])
    for pose, x in zip(request.poses, (2.05, 0.05, 9.0), strict=True):
        pose.header.frame_id, pose.pose.position.x, pose.pose.position.y = "map", x, 1.05
    answer = system.call(GetCosts, "/get_cost_costmap", request)
    assert (list(answer.costs), answer.success) == ([254, 0, 254], False)
    request.poses = request.poses[:1]
    request.poses[0].header.frame_id = "nowhere"
    answer = system.call(GetCosts, "/get_cost_costmap", request)
    assert (list(answer.costs), answer.success) == ([255], False)


def test_bad_input_is_refused_with_a_reason(system: System) -> None:
    started(system, **SCAN)
    transform(system, "base_link", "map", 1.05, 1.05)
    transform(system, "laser", "base_link", 0.0, 0.0, 0.2)
    message = OccupancyGrid(data=np.zeros(5, np.int8))
    message.info.width = message.info.height = 2
    system.publish("/map", message, qos=LATCHED)
    system.expect_log("Received map message is malformed. Rejecting: 2 x 2 cells, and data has 5")
    publish_map(system, np.zeros((0, 0)))
    system.expect_log("0 x 0 cells, and data has 0")
    publish_map(system, np.zeros((20, 20)), math.nan)
    system.expect_log("resolution nan")
    publish_map(system, np.zeros((20, 20)))
    scan(system, [math.nan, -1.0, math.inf, -math.inf])
    strange = LaserScan(angle_increment=math.nan, ranges=[1.0])
    strange.header.frame_id = "laser"
    system.publish("/scan", strange)
    system.expect_log("obstacle_layer.scan (/scan): ignored a message: 1 beams")
    scan(system, [1.0] * 4, "nowhere")
    system.run(1.0)
    assert not costs(system).any()


def test_a_scan_from_too_high_is_reported(system: System) -> None:
    started(system, **{"obstacle_layer.observation_sources": "scan"})
    transform(system, "base_link", "map", 1.05, 1.05)
    transform(system, "laser", "base_link", 0.0, 0.0, 0.2)
    publish_map(system, np.zeros((30, 30)))
    scan(system, [1.0] * 4)
    system.expect_log("m high; they are at 0.20 to 0.20 m: set obstacle_layer.scan.max_obstacle_height")


def test_an_unknown_plugin_is_refused(system: System) -> None:
    parameters = {"plugins": ["sonar"], "sonar.plugin": "nav2_costmap_2d::RangeSensorLayer"}
    system.start("nav2_costmap_2d nav2_costmap_2d", parameters=parameters)
    assert not change(system, Transition.TRANSITION_CONFIGURE)
    system.expect_log("got 'nav2_costmap_2d::RangeSensorLayer' (did you mean 'nav2_costmap_2d::VoxelLayer'?)")


def test_it_can_be_cleaned_up_and_configured_again(system: System) -> None:
    started(system, **SCAN)
    for transition in (
        Transition.TRANSITION_DEACTIVATE,
        Transition.TRANSITION_CLEANUP,
        Transition.TRANSITION_CONFIGURE,
        Transition.TRANSITION_ACTIVATE,
    ):
        assert change(system, transition)
    transform(system, "base_link", "map", 1.05, 1.05)
    publish_map(system, np.zeros((30, 30)))
    system.run(0.5)
    assert costs(system).shape == (30, 30)


def test_parameters_change_while_it_runs(system: System) -> None:
    started(system)
    transform(system, "base_link", "map", 1.0, 1.0)
    cells = np.zeros((30, 30))
    cells[10, 20] = 100
    publish_map(system, cells)
    system.run(0.5)
    assert costs(system)[10, 13] == 0
    system.set_parameter("/costmap", "inflation_layer.inflation_radius", 1.5)
    system.set_parameter("/costmap", "inflation_layer.cost_scaling_factor", 1.0)
    system.run(0.5)
    assert costs(system)[10, 13] > 100
    system.set_parameter("/costmap", "footprint", "[[0.5, 0.5], [0.5, -0.5], [-0.5, -0.5], [-0.5, 0.5]]")
    system.run(0.5)
    assert (costs(system)[10, 15], costs(system)[10, 14]) == (253, int(252 * math.exp(-0.1)))


def test_without_a_robot_there_are_no_costs_and_a_reason(system: System) -> None:
    started(system, initial_transform_timeout=2.0)
    publish_map(system, np.zeros((30, 30)))
    system.expect_log("no transform from 'base_link' to 'map'")
    system.run(3.0)
    system.expect_log("the transform from base_link to map did not become available before timeout")


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_hostile_messages_end_no_costmap_that_is_active(system: System, seed: int) -> None:
    sources = {"obstacle_layer.observation_sources": "scan cloud", "obstacle_layer.cloud.data_type": "PointCloud2"}
    started(system, **SCAN | sources, **{"obstacle_layer.cloud.clearing": True, "track_unknown_space": True})
    transform(system, "base_link", "map", 1.05, 1.05)
    transform(system, "laser", "base_link", 0.0, 0.0, 0.2)
    dice = random.Random(seed)
    hostile = Hostile(dice, ["laser", "base_link", "map"])
    for _ in range(40):
        kinds = [("/scan", LaserScan), ("/cloud", PointCloud2), ("/map", OccupancyGrid), ("/footprint", Polygon)]
        topic, kind = dice.choice(kinds)
        message = hostile.message(kind)
        if hasattr(message, "header"):
            message.header.frame_id = dice.choice(["laser", "map", message.header.frame_id])
        system.publish(topic, message, LATCHED if topic == "/map" else 10)
        system.run(dice.choice([0.0, 0.1, 0.3]))
    publish_map(system, np.zeros((30, 30)))
    system.run(0.5)
    assert costs(system).shape == (30, 30)
    assert system.failures == []
