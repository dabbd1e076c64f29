"""BasicNavigator: a node whose methods send goals to Nav2's servers, wait for them, and read and clear costmaps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from robolink.companions.nav2_simple_commander.running import Tasks
from robolink.companions.nav2_simple_commander.tasks import RunningTask, TaskResult, poses_in, spot, time_of
from robolink.interfaces.geographic_msgs.msg import GeoPose
from robolink.interfaces.geometry_msgs.msg import Point, PoseStamped
from robolink.interfaces.nav2_msgs import action
from robolink.interfaces.nav_msgs.msg import Goals, Path

__all__ = ["BasicNavigator", "RunningTask", "TaskResult"]

KINDS = {
    RunningTask.NAVIGATE_TO_POSE: action.NavigateToPose,
    RunningTask.NAVIGATE_THROUGH_POSES: action.NavigateThroughPoses,
    RunningTask.FOLLOW_PATH: action.FollowPath,
    RunningTask.FOLLOW_WAYPOINTS: action.FollowWaypoints,
    RunningTask.FOLLOW_GPS_WAYPOINTS: action.FollowGPSWaypoints,
    RunningTask.SPIN: action.Spin,
    RunningTask.BACKUP: action.BackUp,
    RunningTask.DRIVE_ON_HEADING: action.DriveOnHeading,
    RunningTask.ASSISTED_TELEOP: action.AssistedTeleop,
    RunningTask.DOCK_ROBOT: action.DockRobot,
    RunningTask.UNDOCK_ROBOT: action.UndockRobot,
}
"""Actions by the kind of task."""


class BasicNavigator(Tasks):
    """Node that navigates: goals for Nav2's actions, and calls of its services, for a script without callbacks.

        navigator = BasicNavigator()
        navigator.goToPose(pose)
        while not navigator.isTaskComplete():
            print(navigator.getFeedback().distance_remaining)
        print(navigator.getResult())

    A method that starts a task waits for the server and its answer, and returns the kind of task, or None if the goal
    was rejected. There is one task at a time: a further one takes its place in `isTaskComplete` and the like.

    Args:
        node_name: Name of the node.
        namespace: Namespace of the node and of the servers that it uses.
    """

    def __init__(self, node_name: str = "basic_navigator", namespace: str = "") -> None:
        super().__init__(node_name, namespace)

    # Tasks

    def goToPose(self, pose: PoseStamped, behavior_tree: str = "") -> RunningTask | None:
        """Drive to a pose.

        Args:
            pose: Pose to reach, in the frame of its header.
            behavior_tree: File with the behaviour tree to use; an empty one takes the usual.

        Returns:
            The kind of task, None if the goal was rejected.
        """
        goal = action.NavigateToPose.Goal(pose=pose, behavior_tree=behavior_tree)
        words = f"Navigating to goal: {spot(pose)}"
        return self._task_(RunningTask.NAVIGATE_TO_POSE, goal, words)

    def goThroughPoses(self, poses: Sequence[PoseStamped] | Goals, behavior_tree: str = "") -> RunningTask | None:
        """Drive through poses to the last of them.

        Args:
            poses: Poses in their order: a list, or Kilted's Goals.
            behavior_tree: File with the behaviour tree to use; an empty one takes the usual.

        Returns:
            The kind of task, None if the goal was rejected.
        """
        goal = action.NavigateThroughPoses.Goal(poses=poses_in(poses), behavior_tree=behavior_tree)
        words = f"Navigating with {len(goal.poses)} goals"
        return self._task_(RunningTask.NAVIGATE_THROUGH_POSES, goal, words)

    def followWaypoints(self, poses: Sequence[PoseStamped]) -> RunningTask | None:
        """Drive to poses one after the other, and do at each what the server is set up for.

        Args:
            poses: Poses in their order.

        Returns:
            The kind of task, None if the goal was rejected.
        """
        goal = action.FollowWaypoints.Goal(poses=poses_in(poses))
        words = f"Following {len(goal.poses)} goals"
        return self._task_(RunningTask.FOLLOW_WAYPOINTS, goal, words)

    def followGpsWaypoints(self, gps_poses: Sequence[GeoPose]) -> RunningTask | None:
        """Drive to positions on the Earth one after the other.

        Args:
            gps_poses: Poses in their order, in degrees.

        Returns:
            The kind of task, None if the goal was rejected.
        """
        goal = action.FollowGPSWaypoints.Goal(gps_poses=gps_poses)
        words = f"Following {len(gps_poses)} gps goals"
        return self._task_(RunningTask.FOLLOW_GPS_WAYPOINTS, goal, words)

    def followPath(self, path: Path, controller_id: str = "", goal_checker_id: str = "") -> RunningTask | None:
        """Follow a path with a controller.

        Args:
            path: Path to follow.
            controller_id: Name of the controller; an empty one takes the usual.
            goal_checker_id: Name of the goal checker; an empty one takes the usual.

        Returns:
            The kind of task, None if the goal was rejected.
        """
        goal = action.FollowPath.Goal(path=path, controller_id=controller_id, goal_checker_id=goal_checker_id)
        return self._task_(RunningTask.FOLLOW_PATH, goal, "Executing path")

    def spin(
        self, spin_dist: float = 1.57, time_allowance: float = 10, disable_collision_checks: bool = False
    ) -> RunningTask | None:
        """Turn on the spot.

        Args:
            spin_dist: Angle in radians, positive to the left.
            time_allowance: Time after which the server gives up, in s.
            disable_collision_checks: Kilted's; Jazzy's servers always check, and a note says so.

        Returns:
            The kind of task, None if the goal was rejected.
        """
        goal = action.Spin.Goal(target_yaw=float(spin_dist), time_allowance=time_of(time_allowance))
        self._note_checks_(disable_collision_checks)
        return self._task_(RunningTask.SPIN, goal, f"Spinning to angle {goal.target_yaw}")

    def backup(
        self,
        backup_dist: float = 0.15,
        backup_speed: float = 0.025,
        time_allowance: float = 10,
        disable_collision_checks: bool = False,
    ) -> RunningTask | None:
        """Drive backwards.

        Args:
            backup_dist: Distance in metres.
            backup_speed: Speed in m/s.
            time_allowance: Time after which the server gives up, in s.
            disable_collision_checks: Kilted's; Jazzy's servers always check, and a note says so.

        Returns:
            The kind of task, None if the goal was rejected.
        """
        self._note_checks_(disable_collision_checks)
        goal = _straight(action.BackUp.Goal, backup_dist, backup_speed, time_allowance)
        return self._task_(RunningTask.BACKUP, goal, f"Backing up {backup_dist} m at {backup_speed} m/s")

    def driveOnHeading(
        self,
        dist: float = 0.15,
        speed: float = 0.025,
        time_allowance: float = 10,
        disable_collision_checks: bool = False,
    ) -> RunningTask | None:
        """Drive straight ahead.

        Args:
            dist: Distance in metres.
            speed: Speed in m/s.
            time_allowance: Time after which the server gives up, in s.
            disable_collision_checks: Kilted's; Jazzy's servers always check, and a note says so.

        Returns:
            The kind of task, None if the goal was rejected.
        """
        self._note_checks_(disable_collision_checks)
        goal = _straight(action.DriveOnHeading.Goal, dist, speed, time_allowance)
        return self._task_(RunningTask.DRIVE_ON_HEADING, goal, f"Driving {dist} m on the heading at {speed} m/s")

    def assistedTeleop(self, time_allowance: float = 30) -> RunningTask | None:
        """Let a person drive, with stops before collisions.

        Args:
            time_allowance: Time after which the server ends it, in s.

        Returns:
            The kind of task, None if the goal was rejected.
        """
        goal = action.AssistedTeleop.Goal(time_allowance=time_of(time_allowance))
        return self._task_(RunningTask.ASSISTED_TELEOP, goal, "Running assisted teleop")

    def dockRobotByPose(
        self, dock_pose: PoseStamped, dock_type: str = "", nav_to_dock: bool = True
    ) -> RunningTask | None:
        """Drive onto a dock whose pose is known.

        Args:
            dock_pose: Pose of the dock.
            dock_type: Kind of the dock; an empty one does where there is one kind.
            nav_to_dock: True drives to the place before the dock first; False if the robot stands there.

        Returns:
            The kind of task, None if the goal was rejected.
        """
        goal = action.DockRobot.Goal(
            use_dock_id=False, dock_pose=dock_pose, dock_type=dock_type, navigate_to_staging_pose=nav_to_dock
        )
        return self._task_(RunningTask.DOCK_ROBOT, goal, f"Docking at pose {spot(dock_pose)}")

    def dockRobotByID(self, dock_id: str, nav_to_dock: bool = True) -> RunningTask | None:
        """Drive onto a dock of the server's database.

        Args:
            dock_id: Name of the dock.
            nav_to_dock: True drives to the place before the dock first; False if the robot stands there.

        Returns:
            The kind of task, None if the goal was rejected.
        """
        goal = action.DockRobot.Goal(use_dock_id=True, dock_id=dock_id, navigate_to_staging_pose=nav_to_dock)
        return self._task_(RunningTask.DOCK_ROBOT, goal, f"Docking at dock '{dock_id}'")

    def undockRobot(self, dock_type: str = "") -> RunningTask | None:
        """Drive off the dock.

        Args:
            dock_type: Kind of the dock; an empty one does where the robot was docked by the server.

        Returns:
            The kind of task, None if the goal was rejected.
        """
        goal = action.UndockRobot.Goal(dock_type=dock_type)
        return self._task_(RunningTask.UNDOCK_ROBOT, goal, "Undocking from dock")

    def _task_(self, task: RunningTask, goal: Any, words: str) -> RunningTask | None:
        return task if self._begin_(KINDS[task], goal, words) else None

    def _note_checks_(self, disabled: bool) -> None:
        if disabled:
            self.warn("Jazzy's servers have no disable_collision_checks: they check for collisions")


def _straight(goal_type: type[Any], distance: float, speed: float, time_allowance: float) -> Any:
    """Return the goal of a way straight ahead, or back."""
    return goal_type(target=Point(x=float(distance)), speed=float(speed), time_allowance=time_of(time_allowance))
