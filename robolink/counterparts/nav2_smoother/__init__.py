"""Counterpart of nav2_smoother: it rounds the corners of a path, as far as a costmap allows."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from robolink.counterparts.nav2_util.managed_server import ManagedServer
from robolink.counterparts.nav2_util.parameters import keep_unknown
from robolink.counterparts.nav2_util.robot_pose import fault
from robolink.counterparts.nav2_util.simple_action_server import SimpleActionServer
from robolink.counterparts.program import spin_program
from robolink.exceptions import RobolinkError
from robolink.geometry.plane import pose_of
from robolink.interfaces.geometry_msgs.msg import Quaternion
from robolink.interfaces.nav2_msgs.action import SmoothPath
from robolink.interfaces.nav2_msgs.msg import Costmap
from robolink.interfaces.nav_msgs.msg import Path
from robolink.lifecycle import LifecycleState, TransitionCallbackReturn
from robolink.navigation.grid import Floats, Grid
from robolink.navigation.planning import weights_of
from robolink.navigation.search import BLOCKED
from robolink.navigation.smoothing import rounded
from robolink.parameters.descriptors import described
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.subscription import Subscription

SUCCESS, FAILURE = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
Result = SmoothPath.Result

SIMPLE = "nav2_smoother::SimpleSmoother"
PLUGINS = (SIMPLE, "nav2_smoother::SavitzkyGolaySmoother", "nav2_constrained_smoother::ConstrainedSmoother")
"""Smoothers of Nav2; one stands for all."""
SPARE = 1.0
"""Metres around a path where there is no costmap."""


class SmoothingError(RobolinkError, ValueError):
    """A path that cannot be smoothed, with the error code of the action's result."""

    def __init__(self, code: int, text: str) -> None:
        super().__init__(text)
        self.code = code


class SmootherServer(ManagedServer):
    """A managed node with the action smooth_path. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("smoother_server", **options)
        self.get_logger().info("Creating smoother server")
        self.declare_parameter("smoother_plugins", ["simple_smoother"], described("names of the smoothers"))
        words = "topic of the costmap that says where a path may lead"
        self.declare_parameter("costmap_topic", "global_costmap/costmap_raw", described(words))
        self._names: list[str] = []
        self._subscription: Subscription[Any] | None = None
        self._costmap: Costmap | None = None

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make the server."""
        self.get_logger().info("Configuring smoother server")
        self._names = list(self.get_parameter("smoother_plugins").value)
        for name in self._names:
            if not self.has_parameter(f"{name}.plugin"):
                self.declare_parameter(f"{name}.plugin", SIMPLE, described("kind of this smoother"))
            plugin = self.get_parameter(f"{name}.plugin").value.replace("/", "::")
            if plugin not in PLUGINS:
                self.get_logger().fatal(f"{name}.plugin: expected one of {', '.join(PLUGINS)}, got '{plugin}'")
                return FAILURE
        topic = self.get_parameter("costmap_topic").value
        self._subscription = self.create_subscription(Costmap, topic, self.on_costmap, LATCHED)
        self.actions.append(SimpleActionServer(self, SmoothPath, "smooth_path", self._execute))
        keep_unknown(self)
        return SUCCESS

    def withdraw(self) -> None:
        """Withdraw the server."""
        super().withdraw()
        if self._subscription is not None:
            self.destroy_subscription(self._subscription)
        self._subscription = self._costmap = None

    def on_costmap(self, costmap: Costmap) -> None:
        """Take the newest costmap."""
        self._costmap = costmap

    async def _execute(self) -> None:
        """Smooth the path of the current goal."""
        self.get_logger().info("Received a path to smooth.")
        (server,) = self.actions
        goal, began = server.goal, self.get_clock().now()
        try:
            path = self._smoothed(goal)
        except SmoothingError as error:
            self.get_logger().error(str(error))
            return server.terminate_current(Result(error_code=error.code, error_msg=str(error)))
        took = (self.get_clock().now() - began).to_msg()
        return server.succeeded_current(Result(path=path, smoothing_duration=took, was_completed=True))

    def _smoothed(self, goal: Any) -> Path:
        """Return the smooth path of a goal. Raises SmoothingError."""
        if goal.smoother_id and goal.smoother_id not in self._names:
            known = ", ".join(self._names)
            raise SmoothingError(
                Result.INVALID_SMOOTHER, f"no smoother is called '{goal.smoother_id}': there is {known}"
            )
        if not goal.path.poses:
            raise SmoothingError(Result.INVALID_PATH, "Requested path to smooth is empty")
        mistake = next(filter(None, (fault(each.pose) for each in goal.path.poses)), "")
        if mistake:
            raise SmoothingError(Result.INVALID_PATH, f"a pose of the path: {mistake}")
        points = np.array([(each.pose.position.x, each.pose.position.y) for each in goal.path.poses])
        grid = self._grid(goal.path.header.frame_id, points)
        weights = weights_of(grid.cells, allow_unknown=True)
        origin = np.array(grid.origin[:2])
        found = rounded((points - origin) / grid.resolution, weights) * grid.resolution + origin
        if goal.check_for_collisions:
            rows, columns = grid.world_to_cell(found[:, 0], found[:, 1])
            inside = grid.contains(rows, columns)
            if not inside.all() or (weights[rows[inside], columns[inside]] == BLOCKED).any():
                raise SmoothingError(Result.SMOOTHED_PATH_IN_COLLISION, "the path leads through an obstacle")
        return _path_of(goal.path, found)

    def _grid(self, frame: str, points: Floats) -> Grid:
        """Return the costmap's cells; where none has come, free ones around some points. Raises SmoothingError."""
        costmap = self._costmap
        if costmap is None:
            self.get_logger().warning("no costmap has come: the path is smoothed as if nothing stood beside it")
            low, high = points.min(axis=0) - SPARE, points.max(axis=0) + SPARE
            width, height = (min(10_000, math.ceil(each / 0.05)) for each in high - low)
            return Grid(np.zeros((height, width), np.uint8), 0.05, (float(low[0]), float(low[1]), 0.0))
        own = costmap.header.frame_id
        if frame and frame != own:
            raise SmoothingError(
                Result.FAILED_TO_SMOOTH_PATH, f"the path is in the frame '{frame}', and the costmap in '{own}'"
            )
        about = costmap.metadata
        cells = np.frombuffer(bytes(costmap.data), np.uint8).reshape(about.size_y, about.size_x)
        return Grid(cells, about.resolution, tuple(pose_of(about.origin)))  # type: ignore[arg-type]


def _path_of(path: Path, points: Floats) -> Path:
    """Return a path of other points; its poses look along it, the last one as before."""
    ways = np.diff(points, axis=0)
    headings = np.arctan2(ways[:, 1], ways[:, 0]).tolist()
    made = Path(header=path.header, poses=list(path.poses))
    for index, ((x, y), pose) in enumerate(zip(points.tolist(), path.poses, strict=True)):
        pose.pose.position.x, pose.pose.position.y = x, y
        if index < len(headings):
            half = headings[index] / 2
            pose.pose.orientation = Quaternion(z=math.sin(half), w=math.cos(half))
    return made


def main(args: list[str] | None = None) -> None:
    """Smooth paths until Ctrl-C."""
    spin_program(lambda words: SmootherServer(), args)
