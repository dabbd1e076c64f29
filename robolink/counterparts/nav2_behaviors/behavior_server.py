"""Behaviour server: a managed node with an action for each of its behaviours."""

from __future__ import annotations

import contextlib
import functools
from typing import Any

from robolink.callback_groups import ReentrantCallbackGroup
from robolink.counterparts.nav2_behaviors.behaviors import DEFAULTS, PLUGINS, Behavior, BehaviorError
from robolink.counterparts.nav2_behaviors.collisions import CollisionChecker
from robolink.counterparts.nav2_util.managed_server import ManagedServer
from robolink.counterparts.nav2_util.options import PluginError, names_of, plugin_of
from robolink.counterparts.nav2_util.parameters import keep_unknown
from robolink.counterparts.nav2_util.robot_pose import robot_pose
from robolink.counterparts.nav2_util.simple_action_server import SimpleActionServer
from robolink.counterparts.nav2_util.twist_publisher import TwistPublisher
from robolink.counterparts.program import pause, spin_program
from robolink.duration import Duration
from robolink.exceptions import InvalidHandle, ParameterException
from robolink.geometry.plane import Pose, is_finite, pose_of
from robolink.lifecycle import LifecycleState, TransitionCallbackReturn
from robolink.parameters.descriptors import described
from robolink.tf2 import Buffer, TransformException, TransformListener

SUCCESS, FAILURE = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE

PARAMETERS: dict[str, tuple[Any, str, float | None, float | None]] = {
    "local_costmap_topic": ("local_costmap/costmap_raw", "topic of the local costmap", None, None),
    "global_costmap_topic": (
        "global_costmap/costmap_raw",
        "topic of a costmap, not used",
        None,
        None,
    ),
    "local_footprint_topic": ("local_costmap/published_footprint", "topic of the footprint", None, None),
    "global_footprint_topic": ("global_costmap/published_footprint", "topic of a footprint, not used", None, None),
    "cycle_frequency": (10.0, "steps in a second", 0.1, 1000.0),
    "local_frame": ("odom", "frame in which behaviours measure", None, None),
    "global_frame": ("map", "frame of the map, which is not used", None, None),
    "robot_base_frame": ("base_link", "frame of the robot", None, None),
    "transform_tolerance": (0.1, "greatest age of the robot's pose in seconds", 0.0, 1e6),
    "simulate_ahead_time": (2.0, "seconds ahead in which a collision is looked for", 0.0, 1e3),
    "max_rotational_vel": (1.0, "greatest turning speed in rad/s", 0.0, 1e3),
    "min_rotational_vel": (0.4, "least turning speed in rad/s", 0.0, 1e3),
    "rotational_acc_lim": (3.2, "braking of a turn in rad/s²", 0.0, 1e3),
    "projection_time": (1.0, "seconds ahead in which driving by hand looks for a collision", 0.01, 1e3),
    "simulation_time_step": (0.1, "seconds between two of these looks", 0.001, 1e3),
    "cmd_vel_teleop": ("cmd_vel_teleop", "topic of the speeds of driving by hand", None, None),
}
"""Parameters with their defaults, descriptions and ranges."""


class BehaviorServer(ManagedServer):
    """A managed node with actions such as spin, backup and wait. `options` are those of `Node`."""

    collisions: CollisionChecker
    """Checker of collisions; there while the node is configured."""

    def __init__(self, **options: Any) -> None:
        super().__init__("behavior_server", **options)
        for name, (default, words, low, high) in PARAMETERS.items():
            self.declare_parameter(name, default, described(words, low, high))
        self._group = ReentrantCallbackGroup()
        self._buffer = Buffer()
        self._listener: TransformListener | None = None
        self._twists: TwistPublisher | None = None
        self._behaviors: list[Behavior] = []
        self._checker: CollisionChecker | None = None

    # Transitions

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make the behaviours with their actions."""
        self.get_logger().info("Configuring")
        try:
            self._make_behaviors()
        except (PluginError, ParameterException) as error:
            self.get_logger().fatal(f"Failed to create behavior: {error}")
            self.withdraw()
            return FAILURE
        base = self.value("robot_base_frame")
        self._listener = TransformListener(self._buffer, self)
        topics = self.value("local_costmap_topic"), self.value("local_footprint_topic")
        self.collisions = self._checker = CollisionChecker(self, self._buffer, base, *topics)
        self._twists = TwistPublisher(self, "cmd_vel", base)
        for behavior in self._behaviors:
            execute = functools.partial(self._execute, behavior, len(self.actions))
            self.actions.append(SimpleActionServer(self, behavior.action, behavior.name, execute))
        keep_unknown(self)
        return SUCCESS

    def _make_behaviors(self) -> None:
        words = "names of the behaviours, which are those of their actions"
        for name in names_of(self, "behavior_plugins", list(DEFAULTS), words):
            plugin = plugin_of(self, name, DEFAULTS.get(name, ""), PLUGINS)
            self.get_logger().info(f"Creating behavior plugin {name} of type {plugin}")
            self._behaviors.append(PLUGINS[plugin](self, name))

    def withdraw(self) -> None:
        """Withdraw actions, behaviours and topics."""
        super().withdraw()
        parts: list[Any] = [*self._behaviors, self._checker, self._twists]
        for part in parts:
            if part is not None:
                part.destroy()
        if self._listener is not None:
            self._listener.unregister()
        self._behaviors = []
        self._checker = self._twists = self._listener = None

    # For the behaviours

    def value(self, name: str) -> Any:
        """Return the value of a parameter."""
        return self.get_parameter(name).value

    def seconds(self) -> float:
        """Return the time in seconds."""
        return self.get_clock().now().nanoseconds / 1e9

    def pose(self) -> Pose | str:
        """Return the robot's pose in the local frame, or the reason why it is not known."""
        frame, base = self.value("local_frame"), self.value("robot_base_frame")
        try:
            found = robot_pose(self._buffer, self, frame, base, self.value("transform_tolerance"))
        except TransformException as error:
            return str(error)
        pose = pose_of(found.pose)
        return pose if is_finite(pose) else f"the transform from '{base}' to '{frame}' is not finite"

    def drive(self, v: float, w: float) -> None:
        """Send speeds: m/s ahead, rad/s to the left."""
        with contextlib.suppress(InvalidHandle):  # the program may have ended, and its publishers with it
            if self._twists is not None:
                self._twists.publish(v, w)

    # Goals

    async def _execute(self, behavior: Behavior, index: int) -> None:
        """Carry out a goal of one behaviour."""
        server, name = self.actions[index], behavior.name
        self.get_logger().info(f"Running {name}")
        try:
            behavior.begin(server.goal)
            await self._run(server, behavior)
        except BehaviorError as error:
            self.get_logger().warning(f"{name} failed: {error}")
            server.terminate_current(self._result(behavior, error.code, f"{name} failed: {error}"))
        finally:  # the coroutine may be closed where it awaits
            if behavior.drives:
                self.drive(0.0, 0.0)

    async def _run(self, server: SimpleActionServer, behavior: Behavior) -> None:
        """Go on until the behaviour is at its end, or its goal at another. Raises BehaviorError."""
        period = 1.0 / self.value("cycle_frequency")
        while True:
            if server.is_preempt_requested:
                words = "Received a preemption request, which no behaviour has: aborting and stopping"
                self.get_logger().error(f"{behavior.name}: {words}")
                return server.terminate_current(self._result(behavior))
            if server.is_cancel_requested:
                self.get_logger().info(f"Canceling {behavior.name}")
                return server.terminate_all(self._result(behavior))
            feedback = behavior.step()
            if feedback is True:
                self.get_logger().info(f"{behavior.name} completed successfully")
                return server.succeeded_current(self._result(behavior))
            server.publish_feedback(feedback)
            await pause(self, period, self._group)

    def _result(self, behavior: Behavior, code: int = 0, words: str = "") -> Any:
        spent = Duration(seconds=max(0.0, self.seconds() - behavior.started)).to_msg()
        return behavior.action.Result(total_elapsed_time=spent, error_code=code, error_msg=words)


def main(args: list[str] | None = None) -> None:
    """Offer behaviours until Ctrl-C."""
    spin_program(lambda words: BehaviorServer(), args)
