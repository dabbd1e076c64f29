"""BasicNavigator: a node whose methods send goals to Nav2's servers, wait for them, and read and clear costmaps."""

from __future__ import annotations

from collections.abc import Sequence
from operator import attrgetter
from typing import Any

from robolink.companions.nav2_simple_commander.goals import (
    KINDS,
    RESULTS,
    Goals,
    RunningTask,
    TaskError,
    TaskResult,
    poses_in,
    spot,
    straight,
    time_of,
    with_ends,
)
from robolink.interfaces.geographic_msgs.msg import GeoPose
from robolink.interfaces.geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from robolink.interfaces.lifecycle_msgs.srv import GetState
from robolink.interfaces.nav2_msgs import action, srv
from robolink.interfaces.nav2_msgs.msg import Costmap, Route
from robolink.interfaces.nav_msgs.msg import Goals as GoalsMsg
from robolink.interfaces.nav_msgs.msg import Path
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.spinning import spin_until_future_complete

__all__ = ["BasicNavigator", "RunningTask", "TaskResult"]

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""QoS of amcl_pose: its last pose comes at once."""
A_LOOK = 2.0
"""Time between two looks at the state of a node that is not active, in s."""
A_SECOND = 1.0
"""Time between two initial poses, in s, until localization has answered one."""
CHECKS = "they check for collisions"
"""Checks that Jazzy's servers make, whatever `disable_collision_checks` is."""
BY_HAND = "robot_localization"
"""Name of the localizer that has no lifecycle to wait for."""


def _of(path: str) -> Any:
    """Return a property that reads the running goals, for an attribute that ROS 2's class has."""
    return property(attrgetter(f"_goals_.{path}"))


class BasicNavigator(Node):
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

    goal_handle, result_future, feedback = _of("task.handle"), _of("task.result"), _of("task.last_feedback")
    """Handle of the task's goal, future of its result, and its last feedback; None if there is none."""
    route_goal_handle, route_result_future = _of("route.handle"), _of("route.result")
    route_feedback = _of("route.feedback")
    status, last_action_error_code, last_action_error_msg = _of("status"), _of("error.code"), _of("error.message")
    """Status of the goal that has ended last (`action_msgs.msg.GoalStatus`), and the code and words of its error."""

    def __init__(self, node_name: str = "basic_navigator", namespace: str = "") -> None:
        super().__init__(node_name, namespace=namespace)
        self._goals_ = Goals(self, self)
        self._clients_ = self._goals_.clients
        self.initial_pose = PoseStamped()
        self.initial_pose.header.frame_id = "map"
        self.initial_pose_received = False
        self.initial_pose_pub = self.create_publisher(PoseWithCovarianceStamped, "initialpose", 10)
        self.localization_pose_sub = self.create_subscription(
            PoseWithCovarianceStamped, "amcl_pose", self._on_amcl_pose_, LATCHED
        )

    # Tasks

    def goToPose(self, pose: PoseStamped, behavior_tree: str = "") -> RunningTask | None:
        """Drive to a pose; return the kind of task, None if the goal was rejected.

        Args:
            pose: Pose to reach, in the frame of its header.
            behavior_tree: File with the behaviour tree to use; an empty one takes the usual.
        """
        goal = action.NavigateToPose.Goal(pose=pose, behavior_tree=behavior_tree)
        return self._task_(RunningTask.NAVIGATE_TO_POSE, goal, f"Navigating to goal: {spot(pose)}")

    def goThroughPoses(self, poses: Sequence[PoseStamped] | GoalsMsg, behavior_tree: str = "") -> RunningTask | None:
        """Drive through poses to the last of them; return the kind of task, None if the goal was rejected.

        Args:
            poses: Poses in their order: a list, or Kilted's Goals.
            behavior_tree: File with the behaviour tree to use; an empty one takes the usual.
        """
        goal = action.NavigateThroughPoses.Goal(poses=poses_in(poses), behavior_tree=behavior_tree)
        return self._task_(RunningTask.NAVIGATE_THROUGH_POSES, goal, f"Navigating with {len(goal.poses)} goals")

    def followWaypoints(
        self, poses: Sequence[PoseStamped], number_of_loops: int = 0, goal_index: int = 0
    ) -> RunningTask | None:
        """Drive to poses one after the other; return the kind of task, None if the goal was rejected.

        Args:
            poses: Poses in their order. At each the robot does what the server is set up for.
            number_of_loops: How many more times to go through all of them.
            goal_index: Index of the pose to begin with.
        """
        goal = action.FollowWaypoints.Goal(
            poses=poses_in(poses), number_of_loops=number_of_loops, goal_index=goal_index
        )
        return self._task_(RunningTask.FOLLOW_WAYPOINTS, goal, f"Following {len(goal.poses)} goals")

    def followGpsWaypoints(self, gps_poses: Sequence[GeoPose]) -> RunningTask | None:
        """Drive to positions on the Earth one after the other; return the kind of task, None if it was rejected.

        Args:
            gps_poses: Poses in their order, in degrees.
        """
        goal = action.FollowGPSWaypoints.Goal(gps_poses=gps_poses)
        return self._task_(RunningTask.FOLLOW_GPS_WAYPOINTS, goal, f"Following {len(gps_poses)} gps goals")

    def followPath(
        self,
        path: Path,
        controller_id: str = "",
        goal_checker_id: str = "",
        progress_checker_id: str = "",
        path_handler_id: str = "",
    ) -> RunningTask | None:
        """Follow a path with a controller; return the kind of task, None if the goal was rejected.

        Args:
            path: Path to follow.
            controller_id: Name of the controller; an empty one takes the usual.
            goal_checker_id: Name of the goal checker; an empty one takes the usual.
            progress_checker_id: Name of the progress checker; an empty one takes the usual.
            path_handler_id: Lyrical's; Jazzy's servers have none, and a note says so.
        """
        goal = action.FollowPath.Goal(
            path=path,
            controller_id=controller_id,
            goal_checker_id=goal_checker_id,
            progress_checker_id=progress_checker_id,
        )
        self._note_lack_("path_handler_id", path_handler_id, "they follow the path as it is")
        return self._task_(RunningTask.FOLLOW_PATH, goal, "Executing path")

    def spin(
        self, spin_dist: float = 1.57, time_allowance: float = 10, disable_collision_checks: bool = False
    ) -> RunningTask | None:
        """Turn on the spot; return the kind of task, None if the goal was rejected.

        Args:
            spin_dist: Angle in radians, positive to the left.
            time_allowance: Time after which the server gives up, in s.
            disable_collision_checks: Kilted's; Jazzy's servers always check, and a note says so.
        """
        goal = action.Spin.Goal(target_yaw=float(spin_dist), time_allowance=time_of(time_allowance))
        self._note_lack_("disable_collision_checks", disable_collision_checks, CHECKS)
        return self._task_(RunningTask.SPIN, goal, f"Spinning to angle {goal.target_yaw}")

    def backup(
        self,
        backup_dist: float = 0.15,
        backup_speed: float = 0.025,
        time_allowance: float = 10,
        disable_collision_checks: bool = False,
    ) -> RunningTask | None:
        """Drive backwards; return the kind of task, None if the goal was rejected.

        Args:
            backup_dist: Distance in metres.
            backup_speed: Speed in m/s.
            time_allowance: Time after which the server gives up, in s.
            disable_collision_checks: Kilted's; Jazzy's servers always check, and a note says so.
        """
        self._note_lack_("disable_collision_checks", disable_collision_checks, CHECKS)
        goal = straight(action.BackUp.Goal, backup_dist, backup_speed, time_allowance)
        return self._task_(RunningTask.BACKUP, goal, f"Backing up {backup_dist} m at {backup_speed} m/s")

    def driveOnHeading(
        self,
        dist: float = 0.15,
        speed: float = 0.025,
        time_allowance: float = 10,
        disable_collision_checks: bool = False,
    ) -> RunningTask | None:
        """Drive straight ahead; return the kind of task, None if the goal was rejected.

        Args:
            dist: Distance in metres.
            speed: Speed in m/s.
            time_allowance: Time after which the server gives up, in s.
            disable_collision_checks: Kilted's; Jazzy's servers always check, and a note says so.
        """
        self._note_lack_("disable_collision_checks", disable_collision_checks, CHECKS)
        goal = straight(action.DriveOnHeading.Goal, dist, speed, time_allowance)
        return self._task_(RunningTask.DRIVE_ON_HEADING, goal, f"Driving {dist} m on the heading at {speed} m/s")

    def assistedTeleop(self, time_allowance: float = 30) -> RunningTask | None:
        """Let a person drive, with stops before collisions; return the kind of task, None if it was rejected.

        Args:
            time_allowance: Time after which the server ends it, in s.
        """
        goal = action.AssistedTeleop.Goal(time_allowance=time_of(time_allowance))
        return self._task_(RunningTask.ASSISTED_TELEOP, goal, "Running assisted teleop")

    def dockRobotByPose(
        self, dock_pose: PoseStamped, dock_type: str = "", nav_to_dock: bool = True
    ) -> RunningTask | None:
        """Drive onto a dock whose pose is known; return the kind of task, None if the goal was rejected.

        Args:
            dock_pose: Pose of the dock.
            dock_type: Kind of the dock; an empty one does where there is one kind.
            nav_to_dock: True drives to the place before the dock first; False if the robot stands there.
        """
        goal = action.DockRobot.Goal(
            use_dock_id=False, dock_pose=dock_pose, dock_type=dock_type, navigate_to_staging_pose=nav_to_dock
        )
        return self._task_(RunningTask.DOCK_ROBOT, goal, f"Docking at pose {spot(dock_pose)}")

    def dockRobotByID(self, dock_id: str, nav_to_dock: bool = True) -> RunningTask | None:
        """Drive onto a dock of the server's database; return the kind of task, None if the goal was rejected.

        Args:
            dock_id: Name of the dock.
            nav_to_dock: True drives to the place before the dock first; False if the robot stands there.
        """
        goal = action.DockRobot.Goal(use_dock_id=True, dock_id=dock_id, navigate_to_staging_pose=nav_to_dock)
        return self._task_(RunningTask.DOCK_ROBOT, goal, f"Docking at dock '{dock_id}'")

    def undockRobot(self, dock_type: str = "") -> RunningTask | None:
        """Drive off the dock; return the kind of task, None if the goal was rejected.

        Args:
            dock_type: Kind of the dock; an empty one does where the robot was docked by the server.
        """
        goal = action.UndockRobot.Goal(dock_type=dock_type)
        return self._task_(RunningTask.UNDOCK_ROBOT, goal, "Undocking from dock")

    def followObjectByTopic(self, topic: str, max_duration: float = 0) -> RunningTask | None:
        """Follow an object whose pose is published; return the kind of task, None if the goal was rejected.

        Args:
            topic: Topic of the pose.
            max_duration: Time after which the server ends it, in s; 0 has no end.
        """
        goal = action.FollowObject.Goal(pose_topic=topic, max_duration=time_of(max_duration))
        return self._task_(RunningTask.FOLLOW_OBJECT, goal, f"Following object on topic {topic}")

    def followObjectByFrame(self, frame: str, max_duration: float = 0) -> RunningTask | None:
        """Follow an object whose frame tf knows; return the kind of task, None if the goal was rejected.

        Args:
            frame: The object's frame.
            max_duration: Time after which the server ends it, in s; 0 has no end.
        """
        goal = action.FollowObject.Goal(tracked_frame=frame, max_duration=time_of(max_duration))
        return self._task_(RunningTask.FOLLOW_OBJECT, goal, f"Following object in frame {frame}")

    # The running task

    def isTaskComplete(self, task: RunningTask | None = RunningTask.NONE) -> bool:
        """Wait a tenth of a second at most for the end of the task, and return whether it has ended.

        Callbacks of the node run meanwhile. True as well when no task was begun.

        Args:
            task: Kind of task. Only COMPUTE_AND_TRACK_ROUTE matters, which goes on beside another task.
        """
        goals = self._goals_
        return goals.is_complete(goals.route if task is RunningTask.COMPUTE_AND_TRACK_ROUTE else goals.task)

    def getFeedback(self, task: RunningTask | None = RunningTask.NONE) -> Any:
        """Return the last feedback of the task, a message of its action's ``Feedback``; None before the first.

        Args:
            task: Kind of task. Of COMPUTE_AND_TRACK_ROUTE each call returns the next feedback, None after the last.
        """
        if task is RunningTask.COMPUTE_AND_TRACK_ROUTE:
            progress = self._goals_.route.feedback
            return progress.popleft() if progress else None
        return self.feedback

    def getResult(self) -> TaskResult:
        """Return the outcome of the task, UNKNOWN until `isTaskComplete` has seen its end."""
        return RESULTS.get(self._goals_.status, TaskResult.UNKNOWN)

    def getTaskError(self) -> tuple[int, str]:
        """Return the code and the words with which the task failed; 0 and nothing if it did not."""
        return self._goals_.error.code, self._goals_.error.message

    def clearTaskError(self) -> None:
        """Forget the error of the last task."""
        self.setTaskError(0, "")

    def clearPreviousState(self) -> None:
        """Forget the last feedback and the error of the last task."""
        self._goals_.task.feedback.clear()
        self.clearTaskError()

    def setTaskError(self, error_code: int, error_msg: str) -> None:
        """Set the error that `getTaskError` returns: `error_code` of the action's result, `error_msg` for people."""
        self._goals_.error = TaskError(error_code, error_msg)

    def cancelTask(self) -> None:
        """Cancel the task, and the tracking of a route. Its end is seen by `isTaskComplete`."""
        self.info("Canceling current task.")
        self._goals_.cancel()
        self.clearPreviousState()

    # Planning

    def getPath(
        self, start: PoseStamped, goal: PoseStamped, planner_id: str = "", use_start: bool = False
    ) -> Path | None:
        """Plan a path to a pose, and wait for it.

        Args:
            start: Pose at which the path begins, if `use_start`.
            goal: Pose at which it ends.
            planner_id: Name of the planner; an empty one takes the usual.
            use_start: False begins where the robot is.

        Returns:
            The path, None if there is none; `getTaskError` tells why.
        """
        request = action.ComputePathToPose.Goal(start=start, goal=goal, planner_id=planner_id, use_start=use_start)
        result = self._goals_.result_of(action.ComputePathToPose, request, "Getting path")
        return None if result is None else result.path

    def getPathThroughPoses(
        self, start: PoseStamped, goals: Sequence[PoseStamped] | GoalsMsg, planner_id: str = "", use_start: bool = False
    ) -> Path | None:
        """Plan a path through poses, and wait for it.

        Args:
            start: Pose at which the path begins, if `use_start`.
            goals: Poses in their order: a list, or Kilted's Goals.
            planner_id: Name of the planner; an empty one takes the usual.
            use_start: False begins where the robot is.

        Returns:
            The path, None if there is none; `getTaskError` tells why.
        """
        request = action.ComputePathThroughPoses.Goal(
            start=start, goals=poses_in(goals), planner_id=planner_id, use_start=use_start
        )
        result = self._goals_.result_of(action.ComputePathThroughPoses, request, "Getting path")
        return None if result is None else result.path

    def getRoute(
        self, start: int | PoseStamped, goal: int | PoseStamped, use_start: bool = False
    ) -> list[Path | Route] | None:
        """Find a route through the graph of the route server, and wait for it.

        Args:
            start: Pose or number of a node at which the route begins.
            goal: Pose or number of a node at which it ends.
            use_start: False begins where the robot is, if `start` is a pose.

        Returns:
            The path and the route, None if there are none; `getTaskError` tells why.

        Raises:
            TypeError: if one end is a pose and the other a number.
        """
        request = with_ends(action.ComputeRoute.Goal(use_start=use_start), start, goal)
        result = self._goals_.result_of(action.ComputeRoute, request, "Getting route")
        return None if result is None else [result.path, result.route]

    def getAndTrackRoute(
        self, start: int | PoseStamped, goal: int | PoseStamped, use_start: bool = False
    ) -> RunningTask | None:
        """Find a route and report the robot's progress on it, beside a task that drives there.

        Args:
            start: Pose or number of a node at which the route begins.
            goal: Pose or number of a node at which it ends.
            use_start: False begins where the robot is, if `start` is a pose.

        Returns:
            The kind of task, for `isTaskComplete` and `getFeedback`; None if the goal was rejected.

        Raises:
            TypeError: if one end is a pose and the other a number.
        """
        request = with_ends(action.ComputeAndTrackRoute.Goal(use_start=use_start), start, goal)
        words = "Computing and tracking route"
        begun = self._goals_.begin(self._goals_.route, action.ComputeAndTrackRoute, request, words)
        return RunningTask.COMPUTE_AND_TRACK_ROUTE if begun else None

    def smoothPath(
        self, path: Path, smoother_id: str = "", max_duration: float = 2.0, check_for_collision: bool = False
    ) -> Path | None:
        """Smooth a path, and wait for the result.

        Args:
            path: Path to smooth.
            smoother_id: Name of the smoother; an empty one takes the usual.
            max_duration: Time that the smoother may take, in s.
            check_for_collision: True refuses a smoother path that touches something.

        Returns:
            The path, None if there is none; `getTaskError` tells why.
        """
        request = action.SmoothPath.Goal(
            path=path,
            smoother_id=smoother_id,
            max_smoothing_duration=time_of(max_duration),
            check_for_collisions=check_for_collision,
        )
        result = self._goals_.result_of(action.SmoothPath, request, "Smoothing path")
        return None if result is None else result.path

    def destroyNode(self) -> None:
        """Destroy the node, as `destroy_node` does."""
        self.destroy_node()

    def destroy_node(self) -> None:
        """Destroy the node with the clients that it made."""
        self._clients_.destroy()
        super().destroy_node()

    # Beginning

    def setInitialPose(self, initial_pose: PoseStamped) -> None:
        """Publish `initial_pose`, in the map's frame, from which localization begins."""
        self.initial_pose_received = False
        self.initial_pose = initial_pose
        self._send_initial_pose_()

    def waitUntilNav2Active(self, navigator: str = "bt_navigator", localizer: str = "amcl") -> None:
        """Wait until the navigator and the localizer are active.

        With `amcl` the initial pose is sent once a second until localization has answered with a pose.

        Args:
            navigator: Name of the node that navigates.
            localizer: Name of the node that localizes; `robot_localization`, which has no lifecycle, is not waited for.
        """
        if localizer != BY_HAND:
            self._wait_until_active_(localizer)
        if localizer == "amcl":
            while not self.initial_pose_received:
                self._send_initial_pose_()
                self._clients_.pause(A_SECOND)
        self._wait_until_active_(navigator)
        self.info("Nav2 is ready for use!")

    def lifecycleStartup(self) -> None:
        """Start all nodes of all lifecycle managers that are on the network; the initial pose is sent meanwhile."""
        self._manage_(srv.ManageLifecycleNodes.Request.STARTUP, "Starting up")
        self.info("Nav2 is ready for use!")

    def lifecycleShutdown(self) -> None:
        """Shut down all nodes of all lifecycle managers that are on the network."""
        self._manage_(srv.ManageLifecycleNodes.Request.SHUTDOWN, "Shutting down")

    # Maps

    def changeMap(self, map_filepath: str) -> bool:
        """Load another map, the YAML file `map_filepath` as the server finds it; return True if it was loaded."""
        response = self._call_(srv.LoadMap, "map_server/load_map", map_url=map_filepath)
        if response.result == srv.LoadMap.Response.RESULT_SUCCESS:
            self.info("Change map request was successful!")
            return True
        codes = {value: name for name, (_, value) in srv.LoadMap.Response.__ros_constants__.items()}
        self.error(f"Change map request failed: {codes.get(response.result, response.result)}")
        return False

    def clearAllCostmaps(self) -> None:
        """Clear the local and the global costmap."""
        self.clearLocalCostmap()
        self.clearGlobalCostmap()

    def clearLocalCostmap(self) -> None:
        """Clear the local costmap."""
        self._call_(srv.ClearEntireCostmap, "local_costmap/clear_entirely_local_costmap")

    def clearGlobalCostmap(self) -> None:
        """Clear the global costmap."""
        self._call_(srv.ClearEntireCostmap, "global_costmap/clear_entirely_global_costmap")

    def clearCostmapExceptRegion(self, reset_distance: float) -> None:
        """Clear the local costmap but for a square around the robot, `reset_distance` metres from it to a side."""
        kind, name = srv.ClearCostmapExceptRegion, "local_costmap/clear_costmap_except_region"
        self._call_(kind, name, reset_distance=float(reset_distance))

    def clearCostmapAroundRobot(self, reset_distance: float) -> None:
        """Clear a square of the local costmap around the robot, `reset_distance` metres from it to a side."""
        kind, name = srv.ClearCostmapAroundRobot, "local_costmap/clear_costmap_around_robot"
        self._call_(kind, name, reset_distance=float(reset_distance))

    def clearLocalCostmapAroundPose(self, pose: PoseStamped, reset_distance: float) -> None:
        """Clear a square of the local costmap around `pose`, `reset_distance` metres from it to a side."""
        kind, name = srv.ClearCostmapAroundPose, "local_costmap/clear_costmap_around_pose"
        self._call_(kind, name, pose=pose, reset_distance=float(reset_distance))

    clearCostmapAroundPose = clearLocalCostmapAroundPose  # noqa: N815 - its name in Kilted

    def clearGlobalCostmapAroundPose(self, pose: PoseStamped, reset_distance: float) -> None:
        """Clear a square of the global costmap around `pose`, `reset_distance` metres from it to a side."""
        kind, name = srv.ClearCostmapAroundPose, "global_costmap/clear_costmap_around_pose"
        self._call_(kind, name, pose=pose, reset_distance=float(reset_distance))

    def getGlobalCostmap(self) -> Costmap:
        """Return the global costmap."""
        costmap: Costmap = self._call_(srv.GetCostmap, "global_costmap/get_costmap").map
        return costmap

    def getLocalCostmap(self) -> Costmap:
        """Return the local costmap."""
        costmap: Costmap = self._call_(srv.GetCostmap, "local_costmap/get_costmap").map
        return costmap

    def toggleCollisionMonitor(self, enable: bool) -> None:
        """Switch the collision monitor on (`enable`) or off."""
        response = self._call_(srv.Toggle, "collision_monitor/toggle", enable=enable)
        if not response.success:
            self.error(f"Toggle collision monitor request failed! {response.message}")

    # Logging

    def info(self, msg: str) -> None:
        """Log `msg` at the level INFO."""
        self.get_logger().info(msg)

    def warn(self, msg: str) -> None:
        """Log `msg` at the level WARN."""
        self.get_logger().warning(msg)

    def error(self, msg: str) -> None:
        """Log `msg` at the level ERROR."""
        self.get_logger().error(msg)

    def debug(self, msg: str) -> None:
        """Log `msg` at the level DEBUG."""
        self.get_logger().debug(msg)

    # Used by the methods above

    def _call_(self, kind: Any, name: str, **fields: Any) -> Any:
        return self._clients_.call(kind, name, kind.Request(**fields))

    def _wait_until_active_(self, node_name: str) -> None:
        while (state := self._call_(GetState, f"{node_name}/get_state").current_state.label) != "active":
            self.debug(f"{node_name} is {state}")
            self._clients_.pause(A_LOOK)

    def _manage_(self, command: int, words: str) -> None:
        request = srv.ManageLifecycleNodes.Request(command=command)
        for name, types in self.get_service_names_and_types():
            if "nav2_msgs/srv/ManageLifecycleNodes" not in types:
                continue
            self.info(f"{words} {name}")
            answered = self._clients_.begin_call(srv.ManageLifecycleNodes, name, request)
            while not answered.done():  # a manager may wait for the transforms that follow from a pose
                if command == request.STARTUP and not self.initial_pose_received:
                    self._send_initial_pose_()
                spin_until_future_complete(self, answered, timeout_sec=A_SECOND)
            if not self._clients_.complete(answered).success:
                self.error(f"{words} {name} failed")

    def _send_initial_pose_(self) -> None:
        message = PoseWithCovarianceStamped(header=self.initial_pose.header)
        message.pose.pose = self.initial_pose.pose
        self.info("Publishing initial pose")
        self.initial_pose_pub.publish(message)

    def _on_amcl_pose_(self, _: PoseWithCovarianceStamped) -> None:
        self.initial_pose_received = True

    def _task_(self, task: RunningTask, goal: Any, words: str) -> RunningTask | None:
        return task if self._goals_.begin(self._goals_.task, KINDS[task], goal, words) else None

    def _note_lack_(self, name: str, value: Any, instead: str) -> None:
        if value:
            self.warn(f"Jazzy's servers have no {name}: {instead}")
