"""Planner server: the actions that compute paths to a pose and through poses, and the service that checks one."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from robolink.callback_groups import ReentrantCallbackGroup
from robolink.counterparts.nav2_costmap_2d.costmap_2d_ros import Costmap2DROS
from robolink.counterparts.nav2_planner.paths import joined, path_message
from robolink.counterparts.nav2_planner.planners import DEFAULTS, Planner, PlannerError
from robolink.counterparts.nav2_util.managed_server import ManagedServer
from robolink.counterparts.nav2_util.parameters import keep_unknown
from robolink.counterparts.nav2_util.robot_pose import fault
from robolink.counterparts.nav2_util.simple_action_server import SimpleActionServer
from robolink.counterparts.program import pause, spin_program
from robolink.exceptions import ParameterException, RobolinkError
from robolink.geometry.plane import Pose
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.interfaces.nav2_msgs.action import ComputePathThroughPoses, ComputePathToPose
from robolink.interfaces.nav2_msgs.srv import IsPathValid
from robolink.interfaces.nav_msgs.msg import Path
from robolink.interfaces.std_msgs.msg import Header
from robolink.lifecycle import LifecyclePublisher, LifecycleState, TransitionCallbackReturn
from robolink.navigation.footprint import FREE, INSCRIBED, LETHAL, UNKNOWN, cover, highest_costs
from robolink.navigation.grid import Floats
from robolink.navigation.planning import PlanError, plan
from robolink.parameters.descriptors import described
from robolink.tf2.exceptions import TransformException
from robolink.time import Time

SUCCESS, FAILURE = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE
LOOK = 0.05
"""Seconds between two looks at a costmap that is not current."""


class RequestError(RobolinkError, ValueError):
    """A goal for which no path is planned. `code` is the name of the error code in the action's result."""

    def __init__(self, code: str, text: str) -> None:
        super().__init__(text)
        self.code = code


class _Trip(NamedTuple):
    """Request for a path, from either action: the poses to go through, and whence."""

    goals: list[PoseStamped]
    start: PoseStamped | None
    planner_id: str


class PlannerServer(ManagedServer):
    """A managed node that plans paths through its costmap. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("planner_server", **options)
        self.get_logger().info("Creating")
        self.declare_parameter("planner_plugins", list(DEFAULTS), described("names of the planners"))
        words = "plans each second that are expected; one that takes longer is reported, 0 for none"
        self.declare_parameter("expected_planner_frequency", 1.0, described(words, 0.0, 1000.0))
        words = "seconds to wait for a costmap that is not current"
        self.declare_parameter("costmap_update_timeout", 1.0, described(words, 0.0, 3600.0))
        self.costmap = Costmap2DROS("global_costmap", self)
        self._planners: dict[str, Planner] = {}
        self._group = ReentrantCallbackGroup()
        self._paths: LifecyclePublisher[Path] | None = None
        self._served: Any = None

    # Transitions

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make the costmap and the planners, and offer the actions."""
        self.get_logger().info("Configuring")
        if self.costmap.trigger_configure() is not SUCCESS:
            self.get_logger().error("the costmap cannot be configured: see its own messages")
            return FAILURE
        try:
            for name in self.get_parameter("planner_plugins").value:
                self._planners[name] = Planner(self, name)
                self.get_logger().info(f"Created global planner plugin {name} of type {self._planners[name].plugin}")
        except (PlannerError, ParameterException) as error:
            self.get_logger().fatal(f"Failed to create global planner. Exception: {error}")
            self.withdraw()
            return FAILURE
        self.get_logger().info(f"Planner Server has {' '.join(self._planners)} planners available.")
        self._paths = self.create_lifecycle_publisher(Path, "plan", 1)
        self.actions = [
            SimpleActionServer(self, ComputePathToPose, "compute_path_to_pose", self.compute_to_pose),
            SimpleActionServer(self, ComputePathThroughPoses, "compute_path_through_poses", self.compute_through_poses),
        ]
        self._served = self.create_service(IsPathValid, "is_path_valid", self.on_is_path_valid)
        keep_unknown(self)
        return SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Accept goals, once the costmap is active."""
        return super().on_activate(state) if self.costmap.trigger_activate() is SUCCESS else FAILURE

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Accept no goals."""
        result = super().on_deactivate(state)
        self.costmap.trigger_deactivate()
        return result

    def withdraw(self) -> None:
        """Withdraw the actions and what else is offered."""
        super().withdraw()
        if self._paths is not None:
            self.destroy_lifecycle_publisher(self._paths)
        if self._served is not None:
            self.destroy_service(self._served)
        self._paths = self._served = None
        self._planners = {}
        self.costmap.end()

    def destroy_node(self) -> None:
        """Destroy the costmap's node, too."""
        if hasattr(self, "costmap"):  # a parameter that is refused ends the making before it
            self.costmap.destroy_node()
        super().destroy_node()

    # Actions

    async def compute_to_pose(self) -> None:
        """Plan a path to a pose."""
        self.get_logger().info("Computing path to goal.")
        await self._compute(self.actions[0])

    async def compute_through_poses(self) -> None:
        """Plan a path through poses."""
        self.get_logger().info("Computing path through poses to goal.")
        await self._compute(self.actions[1])

    async def _compute(self, server: SimpleActionServer) -> None:
        """Carry out the goal of a server, and end it with the path or with an error code."""
        began = self.get_clock().now()
        result = server.action_type.Result()
        trip = _trip(server.goal)
        try:
            is_current = await self._wait_for_costmap(server)
            if server.is_cancel_requested:
                self.get_logger().info("Goal was canceled. Canceling planning action.")
                return server.terminate_all()
            if server.is_preempt_requested:
                trip = _trip(server.accept_pending_goal())
            if not is_current:
                raise RequestError("TIMEOUT", "Costmap timed out waiting for update")
            result.path = self._planned(trip)
        except (RequestError, PlanError) as error:
            code = error.code if isinstance(error, RequestError) else error.failure.name
            result.error_code = getattr(server.action_type.Result, code)
            result.error_msg = self._reason(trip, error)
            self.get_logger().warning(result.error_msg)
            return server.terminate_current(result)
        if self._paths is not None and self._paths.get_subscription_count():
            self._paths.publish(result.path)
        result.planning_time = self._time_since(began).to_msg()
        return server.succeeded_current(result)

    async def _wait_for_costmap(self, server: SimpleActionServer) -> bool:
        """Wait until the costmap may be relied on; False if it takes too long."""
        patience = self.get_parameter("costmap_update_timeout").value
        began = self.get_clock().now().nanoseconds
        while not self.costmap.is_current():
            late = self.get_clock().now().nanoseconds - began > patience * 1e9
            if late or server.is_cancel_requested:
                return False
            await pause(self, LOOK, self._group)
        return True

    def _time_since(self, began: Time) -> Any:
        """Return how long planning took, and report what took too long."""
        took = self.get_clock().now() - began
        expected = self.get_parameter("expected_planner_frequency").value
        if expected and took.nanoseconds * expected > 1e9:
            self.get_logger().warning(
                f"Planner loop missed its desired rate of {expected:.4f} Hz. Current loop rate is "
                f"{1e9 / took.nanoseconds:.4f} Hz"
            )
        return took

    # Planning

    def _planned(self, trip: _Trip) -> Path:
        """Return the path of a request. Raises RequestError and PlanError."""
        if not trip.goals:
            raise RequestError("NO_VIAPOINTS_GIVEN", "No viapoints given")
        planner = self._planner(trip.planner_id)
        start = self.costmap.robot_pose() if trip.start is None else self._in_costmap(trip.start, "START")
        if start is None:
            base, frame = self.costmap.base_frame, self.costmap.global_frame
            raise RequestError("TF_ERROR", f"Unable to get start pose: no transform from '{base}' to '{frame}'")
        parts: list[Floats] = []
        for each in trip.goals:
            parts.append(plan(self.costmap.grid, start, self._in_costmap(each, "GOAL"), planner.options()))
            start = Pose(*parts[-1][-1].tolist())
        stamp = self.get_clock().now().to_msg()
        return path_message(joined(parts), Header(stamp=stamp, frame_id=self.costmap.global_frame))

    def _planner(self, name: str) -> Planner:
        """Return a planner by its name. Raises RequestError."""
        if name in self._planners:
            return self._planners[name]
        if not name and len(self._planners) == 1:
            (only,) = self._planners.values()
            self.get_logger().warning(
                f"No planners specified in action call. Server will use only plugin {only.name} in server. "
                "This warning will appear once.",
                once=True,
            )
            return only
        known = " ".join(self._planners)
        raise RequestError("INVALID_PLANNER", f"Planner id {name} is invalid. Planner names are: {known}")

    def _in_costmap(self, pose: PoseStamped, which: str) -> Pose:
        """Return a pose in the costmap's frame. Raises RequestError."""
        if mistake := fault(pose.pose):
            raise RequestError(f"{which}_OUTSIDE_MAP", f"the {which.lower()}: {mistake}")
        try:
            return self.costmap.transformed(pose)
        except TransformException as error:
            raise RequestError("TF_ERROR", f"Unable to transform poses to global frame: {error}") from error

    def _reason(self, trip: _Trip, error: Exception) -> str:
        """Return the line that says why there is no path."""
        goal = f" to ({_place(trip.goals[-1])})" if trip.goals else ""
        start = f" from ({_place(trip.start)})" if trip.start is not None else ""
        return f'{trip.planner_id or "The planner"} failed to plan{start}{goal}: "{error}"'

    # Service

    def on_is_path_valid(self, request: IsPathValid.Request, response: IsPathValid.Response) -> IsPathValid.Response:
        """Answer whether a path is free from where the robot is on."""
        try:
            path = np.array([self._in_costmap(each, "GOAL") for each in request.path.poses])
        except RequestError as error:
            self.get_logger().warning(f"is_path_valid: {error}")
            return response
        if not len(path):
            return response
        robot = self.costmap.robot_pose()
        first = 0 if robot is None else int(np.hypot(path[:, 0] - robot.x, path[:, 1] - robot.y).argmin())
        grid = self.costmap.grid
        grid = grid._replace(cells=np.where(grid.cells == UNKNOWN, np.uint8(FREE), grid.cells))
        uses_radius = self.costmap.uses_radius
        points = np.zeros((1, 2)) if uses_radius else cover(self.costmap.footprint, grid.resolution * 2 / 3)
        costs = highest_costs(grid, points, path[first:])
        bad = np.flatnonzero(costs >= (INSCRIBED if uses_radius else LETHAL)) + first
        response.is_valid, response.invalid_pose_indices = not len(bad), bad.tolist()
        return response


def _trip(goal: Any) -> _Trip:
    """Return the request of a goal of either action."""
    goals = [goal.goal] if isinstance(goal, ComputePathToPose.Goal) else list(goal.goals)
    return _Trip(goals, goal.start if goal.use_start else None, goal.planner_id)


def _place(pose: PoseStamped) -> str:
    return f"{pose.pose.position.x:.2f}, {pose.pose.position.y:.2f}"


def main(args: list[str] | None = None) -> None:
    """Plan paths until Ctrl-C."""
    spin_program(lambda words: PlannerServer(), args)
