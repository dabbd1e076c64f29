"""Counterpart of nav2_bt_navigator: it drives to poses, by planner, controller and recoveries."""

from __future__ import annotations

from typing import Any

from robolink.action import ActionClient
from robolink.counterparts.nav2_bt_navigator.navigator import Navigator
from robolink.counterparts.nav2_bt_navigator.servers import Servers
from robolink.counterparts.nav2_util.managed_server import ManagedServer
from robolink.counterparts.nav2_util.parameters import keep_unknown
from robolink.counterparts.program import spin_program
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.interfaces.nav2_msgs.action import NavigateThroughPoses, NavigateToPose
from robolink.lifecycle import LifecycleState, TransitionCallbackReturn
from robolink.parameters.descriptors import described
from robolink.subscription import Subscription
from robolink.tf2 import Buffer, TransformListener

SUCCESS = TransitionCallbackReturn.SUCCESS

TO_POSE = ("navigate_to_pose_w_replanning_and_recovery",)
THROUGH_POSES = ("navigate_through_poses_w_replanning_and_recovery",)
"""Names of Nav2's default trees, which are what the navigators do."""


class BtNavigator(ManagedServer):
    """A managed node with the actions navigate_to_pose and navigate_through_poses. `options` are those of `Node`.

    It has no engine for behaviour trees: what Nav2's two default trees do is built in. A message on goal_pose makes a
    goal.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("bt_navigator", **options)
        self.get_logger().info("Creating")
        self.declare_parameter("global_frame", "map", described("frame of maps and plans"))
        self.declare_parameter("robot_base_frame", "base_link", described("frame of the robot"))
        for name, (own,) in (
            ("default_nav_to_pose_bt_xml", TO_POSE),
            ("default_nav_through_poses_bt_xml", THROUGH_POSES),
        ):
            self.declare_parameter(name, "", described(f"has no effect: what {own} does is built in"))
        words = "milliseconds to wait for a server that is not there"
        self.declare_parameter("wait_for_service_timeout", 1000, described(words, 0, 3_600_000))
        self._servers: Servers | None = None
        self._listener: TransformListener | None = None
        self._goals: ActionClient | None = None
        self._goal_poses: Subscription[Any] | None = None
        self._is_navigating = False

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make the servers and clients."""
        self.get_logger().info("Configuring")
        for name, own in (
            ("default_nav_to_pose_bt_xml", TO_POSE),
            ("default_nav_through_poses_bt_xml", THROUGH_POSES),
        ):
            tree = self.get_parameter(name).value
            if tree and not any(each in tree for each in own):
                self.get_logger().warning(f"{name}: robolink has no behaviour trees; {own[0]} serves instead of {tree}")
        buffer = Buffer()
        self._listener = TransformListener(buffer, self)
        self._servers = Servers(self, self.get_parameter("wait_for_service_timeout").value / 1000)
        shared: dict[str, Any] = {"buffer": buffer, "servers": self._servers, "claim": self._claim}
        navigators = (
            Navigator(self, NavigateToPose, "navigate_to_pose", period=1.0, trees=TO_POSE, **shared),
            Navigator(self, NavigateThroughPoses, "navigate_through_poses", period=3.0, trees=THROUGH_POSES, **shared),
        )
        self.actions = [each.server for each in navigators]
        self._goals = ActionClient(self, NavigateToPose, "navigate_to_pose")
        self._goal_poses = self.create_subscription(PoseStamped, "goal_pose", self.on_goal_pose, 10)
        keep_unknown(self)
        return SUCCESS

    def withdraw(self) -> None:
        """Withdraw servers and clients."""
        super().withdraw()
        for part in (self._servers, self._goals):
            if part is not None:
                part.destroy()
        if self._goal_poses is not None:
            self.destroy_subscription(self._goal_poses)
        if self._listener is not None:
            self._listener.unregister()
        self._servers = self._goals = self._goal_poses = self._listener = None

    def _claim(self, begin: bool) -> bool:
        """Let one navigator work at a time: False if another one does."""
        if begin and self._is_navigating:
            return False
        self._is_navigating = begin
        return True

    def on_goal_pose(self, pose: PoseStamped) -> None:
        """Make a goal of a pose, as RViz and the page send it."""
        if self._goals is not None:
            self._goals.send_goal_async(NavigateToPose.Goal(pose=pose))


def main(args: list[str] | None = None) -> None:
    """Navigate until Ctrl-C."""
    spin_program(lambda words: BtNavigator(), args)
