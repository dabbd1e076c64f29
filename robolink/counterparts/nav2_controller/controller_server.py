"""Controller server: a managed node that drives along the path of the action follow_path."""

from __future__ import annotations

import contextlib
import math
from typing import Any

import numpy as np

from robolink.callback_groups import ReentrantCallbackGroup
from robolink.counterparts.nav2_controller.checkers import GoalChecker, ProgressChecker, goal_checker, progress_checker
from robolink.counterparts.nav2_controller.controllers import Controller, controller
from robolink.counterparts.nav2_controller.following import (
    Drive,
    DriveError,
    FollowedPath,
    fresh_transform,
    path_message,
)
from robolink.counterparts.nav2_controller.pace import Pace
from robolink.counterparts.nav2_controller.surroundings import MoverWatch, Outline
from robolink.counterparts.nav2_costmap_2d.costmap_2d_ros import Costmap2DROS
from robolink.counterparts.nav2_util.managed_server import ManagedServer
from robolink.counterparts.nav2_util.options import PluginError, names_of
from robolink.counterparts.nav2_util.parameters import keep_unknown
from robolink.counterparts.nav2_util.simple_action_server import SimpleActionServer
from robolink.counterparts.nav2_util.twist_publisher import TwistPublisher
from robolink.counterparts.program import pause, spin_program
from robolink.exceptions import InvalidHandle, ParameterException
from robolink.geometry.plane import Pose, Speeds
from robolink.interfaces.nav2_msgs.action import FollowPath
from robolink.interfaces.nav2_msgs.msg import SpeedLimit
from robolink.interfaces.nav_msgs.msg import Odometry, Path
from robolink.lifecycle import LifecycleState, TransitionCallbackReturn
from robolink.navigation.local_path import LocalPath
from robolink.navigation.rollouts import Command
from robolink.parameters.descriptors import described

SUCCESS, FAILURE = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE
Result = FollowPath.Result

LOOK = 0.01
"""Seconds between two looks for a costmap that is not current."""
OLDEST = 1.0
"""Age in seconds from which a transform, the odometry and what sensors saw do not count: nobody drives blind."""

PARAMETERS: dict[str, tuple[Any, str, float | None, float | None]] = {
    "controller_frequency": (20.0, "commands in a second", 0.1, 1000.0),
    "min_x_velocity_threshold": (0.0001, "speed in m/s below which odometry counts as 0", 0.0, 1e6),
    "min_y_velocity_threshold": (0.0001, "speed to the side in m/s below which odometry counts as 0", 0.0, 1e6),
    "min_theta_velocity_threshold": (0.0001, "turning speed in rad/s below which odometry counts as 0", 0.0, 1e6),
    "speed_limit_topic": ("speed_limit", "topic of speed limits", None, None),
    "odom_topic": ("odom", "topic of odometry", None, None),
    "failure_tolerance": (0.0, "seconds without a valid command until it fails; -1 for ever", -1.0, 1e6),
    "publish_zero_velocity": (True, "stop the robot at the goal", None, None),
    "costmap_update_timeout": (0.3, "seconds without a current costmap until it fails", 0.0, 1e6),
}
"""Parameters with their defaults, descriptions and ranges."""


class ControllerServer(ManagedServer):
    """A managed node with the action follow_path and a local costmap. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("controller_server", **options)
        self.get_logger().info("Creating controller server")
        for name, (default, words, low, high) in PARAMETERS.items():
            self.declare_parameter(name, default, described(words, low, high))
        self.costmap = Costmap2DROS("local_costmap", self)
        self._group = ReentrantCallbackGroup()
        self._controllers: dict[str, Controller] = {}
        self._goal_checkers: dict[str, GoalChecker] = {}
        self._progress_checkers: dict[str, ProgressChecker] = {}
        self._twists: TwistPublisher | None = None
        self._watch: MoverWatch | None = None
        self._subscriptions_made: list[Any] = []
        self._plans: Any = None
        self._parts: Any = None
        self._outline = Outline()
        self._odometry: Odometry | None = None
        self._odometry_time = -math.inf

    # Transitions

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Configure the costmap and the plugins, and offer the action."""
        self.get_logger().info("Configuring controller interface")
        if self.costmap.trigger_configure() is not SUCCESS:
            self.get_logger().error("Failed to configure the local costmap")
            return FAILURE
        try:
            self._make_plugins()
        except (PluginError, ParameterException) as error:
            self.get_logger().fatal(f"Failed to create controller. Exception: {error}")
            self.withdraw()
            return FAILURE
        self._twists = TwistPublisher(self, "cmd_vel", self.costmap.base_frame)
        self._plans = self.create_lifecycle_publisher(Path, "local_plan", 1)
        self._parts = self.create_lifecycle_publisher(Path, "transformed_global_plan", 1)
        self.actions.append(SimpleActionServer(self, FollowPath, "follow_path", self._execute))
        topics = (self.get_parameter(each).value for each in ("speed_limit_topic", "odom_topic"))
        self._subscriptions_made = [
            self.create_subscription(SpeedLimit, next(topics), self.on_speed_limit, 10),
            self.create_subscription(Odometry, next(topics), self.on_odometry, 1),
        ]
        if any(each.follows_movers for each in self._controllers.values()):
            self._watch = MoverWatch(self, self.costmap, self.costmap.scan_topics())
        keep_unknown(self)
        return SUCCESS

    def _make_plugins(self) -> None:
        period = 1.0 / self.get_parameter("controller_frequency").value
        words = "names of the {}, whose parameters begin with them"
        for kind, made, default, make in (
            ("progress_checker", self._progress_checkers, "progress_checker", progress_checker),
            ("goal_checker", self._goal_checkers, "goal_checker", goal_checker),
        ):
            for name in names_of(self, f"{kind}_plugins", [default], words.format(f"{kind}s")):
                made[name] = make(self, name)  # type: ignore[assignment]
        height, width = self.costmap.grid.cells.shape
        reach, inscribed = max(height, width) * self.costmap.grid.resolution / 2, self.costmap.radii.inscribed
        for name in names_of(self, "controller_plugins", ["FollowPath"], words.format("controllers")):
            made_one = controller(self, name, period=period, inscribed=inscribed, reach=reach)
            self._controllers[name] = made_one
        for title, found in (("progress checkers", self._progress_checkers), ("goal checkers", self._goal_checkers)):
            self.get_logger().info(f"Controller Server has {' '.join(found) or '(none)'} {title} available.")
        self.get_logger().info(f"Controller Server has {' '.join(self._controllers)} controllers available.")

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Take goals from now on, once the costmap is active."""
        return super().on_activate(state) if self.costmap.trigger_activate() is SUCCESS else FAILURE

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop the robot, and take no more goals."""
        self._stop()  # before its publisher is deactivated; a goal that runs stops it once more when it is closed
        result = super().on_deactivate(state)
        self.costmap.trigger_deactivate()
        return result

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw the action, the topics and the costmap."""
        result = super().on_cleanup(state)
        self.costmap.trigger_cleanup()
        return result

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop, and withdraw what is left."""
        self._stop()
        result = super().on_shutdown(state)
        self.costmap.trigger_shutdown()
        return result

    def destroy_node(self) -> None:
        """Destroy the costmap with the server."""
        if hasattr(self, "costmap"):  # a parameter that is refused ends the making before it
            self.costmap.destroy_node()
        super().destroy_node()

    def withdraw(self) -> None:
        """Withdraw the action and the topics."""
        super().withdraw()
        for part in (self._twists, self._watch):
            if part is not None:
                part.destroy()
        for each in self._subscriptions_made:
            self.destroy_subscription(each)
        for each in (self._plans, self._parts):
            if each is not None:
                self.destroy_lifecycle_publisher(each)
        self._twists = self._watch = self._plans = self._parts = None
        self._subscriptions_made = []
        self._controllers, self._goal_checkers, self._progress_checkers = {}, {}, {}

    # Messages

    def on_odometry(self, odometry: Odometry) -> None:
        """Note the robot's speed."""
        self._odometry, self._odometry_time = odometry, self._now()

    def on_speed_limit(self, limit: SpeedLimit) -> None:
        """Take over a speed limit: 0 is none."""
        if not math.isfinite(limit.speed_limit) or limit.speed_limit < 0.0:
            self.get_logger().error(f"ignored a speed limit: expected 0 or more, got {limit.speed_limit:g}")
            return
        for each in self._controllers.values():
            each.limit(limit.speed_limit, percentage=limit.percentage)

    def _now(self) -> float:
        return self.get_clock().now().nanoseconds / 1e9

    def _speed(self) -> Speeds:
        """Return the robot's speed; 0.0 below the thresholds. Raises DriveError if odometry is silent."""
        if self._odometry is None or self._now() - self._odometry_time > OLDEST:
            topic, age = self.get_parameter("odom_topic").value, self._now() - self._odometry_time
            since = f"for {age:.1f} s" if self._odometry is not None else "yet"
            raise DriveError(Result.TF_ERROR, f"No odometry on '{topic}' {since}: the robot's speed is not known")
        twist = self._odometry.twist.twist
        v, w = twist.linear.x, twist.angular.z
        if not (math.isfinite(v) and math.isfinite(w)):
            raise DriveError(Result.TF_ERROR, f"The odometry is not finite: {v:g} m/s, {w:g} rad/s")
        v = v if abs(v) > self.get_parameter("min_x_velocity_threshold").value else 0.0
        return Speeds(v, w if abs(w) > self.get_parameter("min_theta_velocity_threshold").value else 0.0)

    # Driving

    async def _execute(self) -> None:
        """Carry out a goal, and those that take over from it."""
        (server,) = self.actions
        self.get_logger().info("Received a goal, begin computing control effort.")
        is_reached = False
        try:
            is_reached = await self._follow(server)
        except DriveError as error:
            self.get_logger().error(str(error))
            server.terminate_current(Result(error_code=error.code, error_msg=str(error)))
        finally:  # the coroutine may be closed where it awaits
            if not is_reached or self.get_parameter("publish_zero_velocity").value:
                self._stop()
            for each in self._controllers.values():
                each.reset()
        if is_reached:
            server.succeeded_current()

    async def _follow(self, server: SimpleActionServer) -> bool:
        """Drive along the path of the goal; True at its end, False if it was cancelled. Raises DriveError."""
        drive = self._drive(server.goal, None)
        period = 1.0 / self.get_parameter("controller_frequency").value
        pace = Pace(self, period, self._group)
        try:
            return await self._go_on(server, drive, pace)
        finally:
            pace.destroy()

    async def _go_on(self, server: SimpleActionServer, drive: Drive, pace: Pace) -> bool:
        while True:
            if server.is_cancel_requested:
                self.get_logger().info("Cancellation was successful. Stopping the robot.")
                self._stop()
                server.terminate_all()
                return False
            await self._wait_for_costmap()
            if server.is_preempt_requested:
                self.get_logger().info("Passing new path to controller.")
                drive = self._drive(server.accept_pending_goal(), drive)
            if self._step(server, drive):
                self.get_logger().info("Reached the goal!")
                return True
            await pace.next()

    async def _wait_for_costmap(self) -> None:
        """Wait, at a standstill, until the costmap is current. Raises DriveError after the timeout."""
        since, timeout = self._now(), self.get_parameter("costmap_update_timeout").value
        while not self.costmap.is_current():
            self._stop()
            if self._now() - since > timeout:
                raise DriveError(Result.CONTROLLER_TIMED_OUT, "Costmap timed out waiting for update")
            await pause(self, LOOK, self._group)

    def _drive(self, goal: Any, before: Drive | None) -> Drive:
        """Return the drive of a goal; `before` is the one that it takes over from. Raises DriveError."""
        name = self._chosen(goal.controller_id, self._controllers, "controller", Result.INVALID_CONTROLLER)
        goals = self._chosen(goal.goal_checker_id, self._goal_checkers, "goal checker", Result.UNKNOWN)
        progress = ""
        if self._progress_checkers or goal.progress_checker_id:
            requested = goal.progress_checker_id
            progress = self._chosen(requested, self._progress_checkers, "progress checker", Result.UNKNOWN)
        path = FollowedPath(goal.path, self.costmap.global_frame)
        drive = Drive(path, self._controllers[name], self._goal_checkers[goals], self._progress_checkers.get(progress))
        drive.goal_checker.reset()
        if drive.progress is not None and (before is None or before.progress is not drive.progress):
            drive.progress.reset()
        drive.valid_time = self._now() if before is None else before.valid_time
        return drive

    def _chosen(self, name: str, known: dict[str, Any], kind: str, code: int) -> str:
        """Return the name of a plugin; an empty one is the only one there is. Raises DriveError."""
        if name in known:
            return name
        if not name and len(known) == 1:
            return next(iter(known))
        raise DriveError(
            code, f"FollowPath called with {kind} name '{name}', which does not exist. Available: {' '.join(known)}"
        )

    def _step(self, server: SimpleActionServer, drive: Drive) -> bool:
        """Send one command; True at the goal. Raises DriveError."""
        pose = self._pose()
        if drive.progress is not None and not drive.progress.gets_on(pose, self._now()):
            raise DriveError(Result.FAILED_TO_MAKE_PROGRESS, "Failed to make progress")
        speed, silence = self._speed(), self.costmap.silence()
        if silence > OLDEST:
            raise DriveError(Result.CONTROLLER_TIMED_OUT, f"The local costmap's sensors are silent for {silence:.1f} s")
        frame = fresh_transform(self.costmap, drive.path.frame, OLDEST)
        path, goal = drive.path.ahead(pose, frame, drive.controller.prune_distance)
        movers = self._watch.movers(self.costmap.radii.circumscribed) if self._watch is not None else []
        around = self._outline.around(self.costmap, movers)
        command = drive.controller.step(pose, speed, path, goal, around, drive.goal_checker.tolerance)
        self._send(command, drive)
        self._publish_paths(path, command)
        server.publish_feedback(FollowPath.Feedback(distance_to_goal=path.remaining, speed=abs(command.v)))
        return drive.goal_checker.is_reached(pose, goal, speed)

    def _pose(self) -> Pose:
        """Return the robot's pose in the costmap's frame. Raises DriveError."""
        tolerance = max(self.costmap.get_parameter("transform_tolerance").value, 0.0)
        try:
            return fresh_transform(self.costmap, self.costmap.base_frame, tolerance)
        except DriveError as error:
            raise DriveError(error.code, f"Failed to obtain robot pose: {error}") from error

    def _send(self, command: Command, drive: Drive) -> None:
        """Send a command, or a stop while there is none that is valid. Raises DriveError if that takes too long."""
        now = self._now()
        if command.is_valid:
            drive.valid_time = now
        else:
            words = "No valid command: every way ahead is obstructed"
            tolerance = self.get_parameter("failure_tolerance").value
            if tolerance == 0.0:
                raise DriveError(Result.NO_VALID_CONTROL, words)
            self.get_logger().warning(words, throttle_duration_sec=1.0)
            if 0.0 < tolerance < now - drive.valid_time:
                raise DriveError(Result.PATIENCE_EXCEEDED, "Controller patience exceeded")
        if self._twists is not None:
            self._twists.publish(command.v, command.w)

    def _stop(self) -> None:
        with contextlib.suppress(InvalidHandle):  # the program may have ended, and its publishers with it
            if self._twists is not None:
                self._twists.stop()

    def _publish_paths(self, path: LocalPath, command: Command) -> None:
        """Publish the part of the path ahead and the way that the robot is about to take, if anybody listens."""
        if self._parts.get_subscription_count():
            self._parts.publish(self._path_of(np.stack((path.x, path.y, path.theta), axis=1)))
        if self._plans.get_subscription_count():
            self._plans.publish(self._path_of(command.trajectory))

    def _path_of(self, poses: Any) -> Path:
        path = path_message(poses)
        path.header.frame_id, path.header.stamp = self.costmap.global_frame, self.get_clock().now().to_msg()
        return path


def main(args: list[str] | None = None) -> None:
    """Drive along paths until Ctrl-C."""
    spin_program(lambda words: ControllerServer(), args)
