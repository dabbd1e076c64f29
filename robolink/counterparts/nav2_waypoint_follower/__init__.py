"""Counterpart of nav2_waypoint_follower: it drives to places one after the other, and waits at each."""

from __future__ import annotations

from typing import Any, cast

from robolink.callback_groups import ReentrantCallbackGroup
from robolink.counterparts.nav2_util.calls import ActionCall, Outcome
from robolink.counterparts.nav2_util.managed_server import ManagedServer
from robolink.counterparts.nav2_util.parameters import keep_unknown
from robolink.counterparts.nav2_util.simple_action_server import SimpleActionServer
from robolink.counterparts.program import pause, spin_program
from robolink.interfaces.nav2_msgs.action import FollowWaypoints, NavigateToPose
from robolink.interfaces.nav2_msgs.msg import MissedWaypoint
from robolink.lifecycle import LifecycleState, TransitionCallbackReturn
from robolink.parameters.descriptors import described
from robolink.task import Future

SUCCESS, FAILURE = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE
Result = FollowWaypoints.Result

NO_VALID_WAYPOINTS, STOP_ON_MISSED_WAYPOINT = 602, 603
"""Kilted's error codes that Jazzy's action lacks."""
PATIENCE = 1.0
"""Wait for bt_navigator in seconds, at each waypoint."""
PLUGIN = "nav2_waypoint_follower::WaitAtWaypoint"


class WaypointFollower(ManagedServer):
    """A managed node with the action follow_waypoints. `options` are those of `Node`.

    It has no GPS waypoints, and one task to do at a waypoint: to wait.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("waypoint_follower", **options)
        self.get_logger().info("Creating")
        self.declare_parameter("stop_on_failure", True, described("end with the first waypoint that is missed"))
        self.declare_parameter("loop_rate", 20, described("looks in a second at what happened", 1, 1000))
        words = "name of the task at each waypoint, whose parameters begin with it"
        self.declare_parameter("waypoint_task_executor_plugin", "wait_at_waypoint", described(words))
        self._group = ReentrantCallbackGroup()
        self._drive: ActionCall | None = None
        self._pause = 0.0

    # Transitions

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make server and client."""
        self.get_logger().info("Configuring")
        task = self.get_parameter("waypoint_task_executor_plugin").value
        if not self._configure_task(task):
            return FAILURE
        self._drive = ActionCall(self, NavigateToPose, "navigate_to_pose", self._group)
        self.actions.append(SimpleActionServer(self, FollowWaypoints, "follow_waypoints", self._execute))
        keep_unknown(self)
        return SUCCESS

    def _configure_task(self, task: str) -> bool:
        """Read the parameters of the task at waypoints; False for one that is not known."""
        for name, default, words in (
            ("plugin", PLUGIN, "what is done at each waypoint"),
            ("enabled", True, "do it"),
            ("waypoint_pause_duration", 0, "milliseconds to wait"),
        ):
            if not self.has_parameter(f"{task}.{name}"):
                self.declare_parameter(f"{task}.{name}", default, described(words))
        plugin, is_enabled, milliseconds = (
            self.get_parameter(f"{task}.{name}").value for name in ("plugin", "enabled", "waypoint_pause_duration")
        )
        if plugin != PLUGIN:
            self.get_logger().fatal(
                f"Failed to create waypoint_task_executor: {task}.plugin is '{plugin}', and robolink has '{PLUGIN}'"
            )
            return False
        self._pause = max(0, milliseconds) / 1000 if is_enabled else 0.0
        return True

    def withdraw(self) -> None:
        """Withdraw server and client."""
        super().withdraw()
        if self._drive is not None:
            self._drive.destroy()
        self._drive = None

    # Goals

    async def _execute(self) -> None:
        assert self._drive is not None
        try:
            await self._follow(self.actions[0], self._drive)
        finally:
            self._drive.cancel()

    async def _follow(self, server: SimpleActionServer, drive: ActionCall) -> None:
        """Drive to the waypoints of the current goal, and of those that take over from it."""
        missed: list[MissedWaypoint] = []
        goal, index, loops = server.goal, server.goal.goal_index, 0
        self.get_logger().info(f"Received follow waypoint request with {len(goal.poses)} waypoints.")
        while True:
            if index >= len(goal.poses):
                words = f"no waypoint has the number {index}: the goal has {len(goal.poses)}, which count from 0"
                return self._give_up(server, missed, NO_VALID_WAYPOINTS, words)
            outcome = await self._at(server, drive, goal.poses[index], index)
            if outcome is None:  # the goal is cancelled, or another one takes over
                if not server.is_preempt_requested or server.is_cancel_requested:
                    return server.terminate_all(Result(missed_waypoints=missed))
                self.get_logger().info("Preempting the goal pose.")
                goal, index, loops, missed = server.accept_pending_goal(), 0, 0, []
                continue
            if not outcome.succeeded:
                code = outcome.code or Result.UNKNOWN
                self.get_logger().warning(f"Failed to process waypoint {index}: {outcome.words}")
                missed.append(MissedWaypoint(index=index, goal=goal.poses[index], error_code=code))
                if self.get_parameter("stop_on_failure").value:
                    words = (
                        f"Failed to process waypoint {index} in waypoint list and stop on failure is enabled:"
                        f" {outcome.words}"
                    )
                    return self._give_up(server, missed, STOP_ON_MISSED_WAYPOINT, words)
            index += 1
            if index == len(goal.poses):
                if loops >= goal.number_of_loops:
                    self.get_logger().info(f"Completed all {len(goal.poses)} waypoints requested.")
                    return server.succeeded_current(Result(missed_waypoints=missed))
                self.get_logger().info(f"Starting a new loop, current loop count is {loops}")
                index, loops = 0, loops + 1

    def _give_up(self, server: SimpleActionServer, missed: list[MissedWaypoint], code: int, words: str) -> None:
        self.get_logger().error(words)
        server.terminate_current(Result(missed_waypoints=missed, error_code=code, error_msg=words))

    async def _at(self, server: SimpleActionServer, drive: ActionCall, pose: Any, index: int) -> Outcome | None:
        """Drive to a waypoint, and do its task; None if the goal is to be cancelled or replaced before."""
        executor = self.executor
        assert executor is not None
        pose.header.stamp = self.get_clock().now().to_msg()
        call = executor.create_task(drive.run(NavigateToPose.Goal(pose=pose), PATIENCE))
        if not await self._is_over(server, call, index):
            return None
        outcome = cast(Outcome, call.result())
        if outcome.succeeded and self._pause > 0:
            wait = round(self._pause * 1000)
            self.get_logger().info(f"Arrived at {index}'th waypoint, sleeping for {wait} milliseconds")
            if not await self._is_over(server, executor.create_task(pause(self, self._pause, self._group)), index):
                return None
        return outcome

    async def _is_over(self, server: SimpleActionServer, work: Future[Any], index: int) -> bool:
        """Wait for some work, with feedback; False as soon as the goal is to be cancelled or replaced."""
        while not work.over():
            if server.is_cancel_requested or server.is_preempt_requested:
                return False
            server.publish_feedback(FollowWaypoints.Feedback(current_waypoint=index))
            await pause(self, 1.0 / self.get_parameter("loop_rate").value, self._group)
        return True


def main(args: list[str] | None = None) -> None:
    """Follow waypoints until Ctrl-C."""
    spin_program(lambda words: WaypointFollower(), args)
