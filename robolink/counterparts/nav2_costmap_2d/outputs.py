"""Outputs of costmaps: the topics of costs and footprint, and the services that return and clear costs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from robolink.counterparts.nav2_costmap_2d.inputs import LATCHED
from robolink.geometry.plane import Pose
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.interfaces.geometry_msgs.msg import Point, Point32, Polygon, PolygonStamped, Quaternion
from robolink.interfaces.geometry_msgs.msg import Pose as PoseMsg
from robolink.interfaces.nav2_msgs.msg import Costmap as CostmapMsg
from robolink.interfaces.nav2_msgs.msg import CostmapMetaData
from robolink.interfaces.nav2_msgs.srv import (
    ClearCostmapAroundPose,
    ClearCostmapAroundRobot,
    ClearCostmapExceptRegion,
    ClearEntireCostmap,
    GetCostmap,
    GetCosts,
)
from robolink.interfaces.nav_msgs.msg import MapMetaData, OccupancyGrid
from robolink.interfaces.std_msgs.msg import Header
from robolink.navigation.costmap import Costs
from robolink.navigation.footprint import INSCRIBED, LETHAL, UNKNOWN, cover, highest_costs
from robolink.navigation.grid import Floats, Grid
from robolink.tf2.exceptions import TransformException

if TYPE_CHECKING:
    from robolink.counterparts.nav2_costmap_2d.costmap_2d_ros import Costmap2DROS


def _occupancies() -> Costs:
    """Return the occupancy by the cost, as a byte: 1 to 252 are spread over 1 to 98."""
    table = np.array([0, *(1 + 97 * (cost - 1) // 251 for cost in range(1, INSCRIBED)), 99, 100, 255], np.uint8)
    assert table[INSCRIBED], table[LETHAL] == (99, 100)
    return table


_OCCUPANCY = _occupancies()


def occupancy_grid(grid: Grid, header: Header) -> OccupancyGrid:
    """Return costs as occupancies from 0 to 100, -1 for unknown."""
    height, width = grid.cells.shape
    information = MapMetaData(
        map_load_time=header.stamp, resolution=grid.resolution, width=width, height=height, origin=_pose(grid)
    )
    return OccupancyGrid(header=header, info=information, data=_OCCUPANCY[grid.cells].ravel().view(np.int8))


def raw_costmap(grid: Grid, header: Header) -> CostmapMsg:
    """Return costs as they are."""
    height, width = grid.cells.shape
    information = CostmapMetaData(
        map_load_time=header.stamp,
        update_time=header.stamp,
        layer="master",
        resolution=grid.resolution,
        size_x=width,
        size_y=height,
        origin=_pose(grid),
    )
    return CostmapMsg(header=header, metadata=information, data=grid.cells.ravel())


def _pose(grid: Grid) -> PoseMsg:
    x, y, theta = grid.origin
    turn = Quaternion(z=math.sin(theta / 2), w=math.cos(theta / 2))
    return PoseMsg(position=Point(x=x, y=y), orientation=turn)


class Topics:
    """Topics of a costmap."""

    def __init__(self, node: Costmap2DROS) -> None:
        self._node = node
        make = node.create_lifecycle_publisher
        self._costs = make(OccupancyGrid, "costmap", LATCHED)
        self._raw = make(CostmapMsg, "costmap_raw", LATCHED)
        self._footprint = make(PolygonStamped, "published_footprint", 1)
        self._sent = -math.inf

    def publish(self, grid: Grid) -> None:
        """Publish the costs if it is time, to those who listen; the first ones anyway, for those who come."""
        now = self._node.get_clock().now()
        frequency = self._node.get_parameter("publish_frequency").value
        seconds = now.nanoseconds / 1e9
        # A timer may come a little early, hence the margin; time that has gone back delays nothing.
        if not frequency or 0 <= seconds - self._sent < 0.99 / frequency:
            return
        is_first, self._sent = self._sent == -math.inf, seconds
        header = self._header(now.to_msg())
        if is_first or self._costs.get_subscription_count():
            self._costs.publish(occupancy_grid(grid, header))
        if is_first or self._raw.get_subscription_count():
            self._raw.publish(raw_costmap(grid, header))

    def publish_footprint(self, polygon: Floats, robot: Pose) -> None:
        """Publish the outline of the robot where it is."""
        cos, sin = math.cos(robot.theta), math.sin(robot.theta)
        points = [Point32(x=robot.x + cos * x - sin * y, y=robot.y + sin * x + cos * y) for x, y in polygon.tolist()]
        header = self._header(self._node.get_clock().now().to_msg())
        self._footprint.publish(PolygonStamped(header=header, polygon=Polygon(points=points)))

    def _header(self, stamp: TimeMsg) -> Header:
        return Header(stamp=stamp, frame_id=self._node.global_frame)

    def destroy(self) -> None:
        """Withdraw the topics."""
        for each in (self._costs, self._raw, self._footprint):
            self._node.destroy_lifecycle_publisher(each)


class Services:
    """Services of a costmap."""

    def __init__(self, node: Costmap2DROS) -> None:
        self._node = node
        name = node.get_name()
        make = node.create_service
        self._services = [
            make(GetCostmap, "get_costmap", self.on_get_costmap),
            make(GetCosts, f"get_cost_{name}", self.on_get_costs),
            make(ClearEntireCostmap, f"clear_entirely_{name}", self.on_clear_entirely),
            make(ClearCostmapExceptRegion, f"clear_except_{name}", self.on_clear_except),
            make(ClearCostmapAroundRobot, f"clear_around_{name}", self.on_clear_around),
            make(ClearCostmapAroundPose, f"clear_around_pose_{name}", self.on_clear_around_pose),
        ]

    def destroy(self) -> None:
        """Withdraw the services."""
        for each in self._services:
            self._node.destroy_service(each)

    def on_get_costmap(self, request: GetCostmap.Request, response: GetCostmap.Response) -> GetCostmap.Response:
        """Answer with the costs."""
        stamp = self._node.get_clock().now().to_msg()
        response.map = raw_costmap(self._node.grid, Header(stamp=stamp, frame_id=self._node.global_frame))
        return response

    def on_get_costs(self, request: GetCosts.Request, response: GetCosts.Response) -> GetCosts.Response:
        """Answer with the costs at poses."""
        grid = self._node.grid
        points = cover(self._node.footprint, grid.resolution * 2 / 3)
        response.success = True
        for each in request.poses:
            try:
                pose = self._node.transformed(each)
            except TransformException as error:
                self._node.get_logger().error(f"no cost of a pose in the frame '{each.header.frame_id}': {error}")
                response.success = False
                response.costs.append(UNKNOWN)
                continue
            row, column = map(int, grid.world_to_cell(pose.x, pose.y))
            if not grid.contains(row, column):
                response.success = False
                response.costs.append(LETHAL)
            elif request.use_footprint:
                response.costs.append(float(highest_costs(grid, points, np.array([pose]))[0]))
            else:
                response.costs.append(float(grid.cells[row, column]))
        return response

    def on_clear_entirely(self, request: Any, response: Any) -> Any:
        """Forget what sensors saw."""
        self._log("clear entirely")
        self._node.clear()
        return response

    def on_clear_except(self, request: Any, response: Any) -> Any:
        """Forget what sensors saw, but near the robot."""
        self._log("clear except a region")
        if (robot := self._robot()) is not None:
            self._node.clear_square(robot.x, robot.y, request.reset_distance, inside=False)
        return response

    def on_clear_around(self, request: Any, response: Any) -> Any:
        """Forget what sensors saw near the robot."""
        self._log("clear around robot")
        if (robot := self._robot()) is not None:
            self._node.clear_square(robot.x, robot.y, request.reset_distance, inside=True)
        return response

    def on_clear_around_pose(self, request: Any, response: Any) -> Any:
        """Forget what sensors saw near a pose."""
        self._log("clear around pose")
        try:
            pose = self._node.transformed(request.pose)
        except TransformException as error:
            self._node.get_logger().error(f"Cannot clear map around the pose: {error}")
        else:
            self._node.clear_square(pose.x, pose.y, request.reset_distance, inside=True)
        return response

    def _robot(self) -> Pose | None:
        robot = self._node.robot_pose()
        if robot is None:
            self._node.get_logger().error("Cannot clear map because robot pose cannot be retrieved.")
        return robot

    def _log(self, what: str) -> None:
        self._node.get_logger().info(f"Received request to {what} the {self._node.get_name()}")
