"""A whole navigation in virtual time: a world, its map, all servers, and a robot that drives from start to goal."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple, cast

from robolink.action import ActionClient
from robolink.companions.ament_index import get_package_share_directory
from robolink.geometry.plane import Pose
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from robolink.interfaces.nav2_msgs.action import NavigateToPose
from robolink.interfaces.nav2_msgs.srv import SaveMap
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.testing import System
from tests.support.navigation_worlds import NavigationWorld

PARAMETERS = Path(get_package_share_directory("nav2_bringup")) / "params/nav2_params.yaml"
NEAR = 0.35
"""Metres from the goal within which the robot has reached it: the goal checker's 0.25, and amcl's error."""
LONGEST = 3.0
"""Times the shortest way's time after which a goal is given up."""


class Life(NamedTuple):
    """Outcome of a robot's way to its goal."""

    has_reached: bool
    contacts: int
    seconds: float
    """Time from the goal to its end."""
    ratio: float
    """That time, as a multiple of the shortest way's at full speed."""
    recoveries: int
    words: str
    """Where the robot touched something, and why the goal was not reached."""
    speed: float
    """How many times as fast as life it was, on one core."""

    @property
    def is_good(self) -> bool:
        """True if the goal was reached without contact, within 1.5 of the shortest way's time."""
        return self.has_reached and self.contacts == 0 and self.ratio <= 1.5


def pose_message(pose: Pose, frame: str = "map") -> PoseStamped:
    made = PoseStamped()
    made.header.frame_id = frame
    made.pose.position.x, made.pose.position.y = pose.x, pose.y
    made.pose.orientation.z, made.pose.orientation.w = math.sin(pose.theta / 2), math.cos(pose.theta / 2)
    return made


class Navigation:
    """A system with a world and all servers, which are active once it is made.

    Args:
        system: The system.
        world: Path of the world file.
        chart: Path of the map's file; None makes a map, in the frame of odometry, which is the world's.
        start: Where the robot begins, which amcl is told.
        parameters: Path of a file of parameters.
        launch: Other arguments of the launch file.
    """

    def __init__(
        self,
        system: System,
        world: Path,
        chart: Path | None,
        start: Pose,
        parameters: Path = PARAMETERS,
        **launch: str,
    ) -> None:
        self.system, self.feedback = system, cast(Any, None)
        system.start("world", parameters={"world": str(world)})
        given = {"slam": "True"} if chart is None else {"map": str(chart)}
        system.launch("nav2_bringup bringup_launch.py", arguments={"params_file": str(parameters), **given, **launch})
        self.client = ActionClient(system.node, NavigateToPose, "navigate_to_pose")
        system.expect_log("Managed nodes are active", within=30.0)
        for name in ("slam" if chart is None else "localization", "navigation"):
            system.wait_until(lambda name=name: self._is_active(name), within=30.0)  # type: ignore[misc]
        if chart is not None:
            self.estimate(start)

    def _is_active(self, name: str) -> bool:
        return bool(self.system.call(Trigger, f"/lifecycle_manager_{name}/is_active").success)

    def estimate(self, start: Pose) -> None:
        """Say where the robot is."""
        message = PoseWithCovarianceStamped()
        message.header.frame_id, message.pose.pose = "map", pose_message(start).pose
        message.header.stamp = self.system.node.get_clock().now().to_msg()
        message.pose.covariance[0] = message.pose.covariance[7] = 0.01
        message.pose.covariance[35] = 0.01
        self.system.publish("/initialpose", message)

    def send(self, goal: Pose) -> Any:
        """Send a goal, and return its handle."""

        def hear(message: Any) -> None:
            self.feedback = message.feedback

        request = NavigateToPose.Goal(pose=pose_message(goal))
        return self.system.result(self.client.send_goal_async(request, hear))

    def end(self, handle: Any, within: float = 300.0) -> tuple[int, int, str]:
        """Wait for the end of a goal: its status, the error code and words."""
        answer = self.system.result(handle.get_result_async(), within=within)
        return answer.status, answer.result.error_code, answer.result.error_msg


def _why(answer: Any, is_near: bool) -> str:
    if not answer:
        return "no end"
    return str(answer.result.error_msg or ("" if is_near else "far from the goal"))


def places_on(way: Sequence[tuple[float, float]], spacing: float) -> list[Pose]:
    """Return places along a line, about `spacing` metres apart, without its ends."""
    found, left = [], spacing
    for (x1, y1), (x2, y2) in pairwise(way):
        left -= math.dist((x1, y1), (x2, y2))
        if left <= 0.0:
            found.append(Pose(x2, y2, math.atan2(y2 - y1, x2 - x1)))
            left = spacing
    return found


def mapped(world: NavigationWorld, folder: Path, parameters: Path = PARAMETERS) -> Path:
    """Let a robot make a map while somebody who sees the world leads it to the goal and back; return the map's file."""
    file, _ = world.write(folder)
    with System(seed=world.seed % 2**31) as system:
        navigation = Navigation(system, file, None, world.start, parameters)
        system.run(3.0)
        for pose in (*places_on(world.way, 2.0), world.goal, world.start):
            navigation.end(navigation.send(pose), within=LONGEST * world.seconds)
        request = SaveMap.Request(map_topic="map", map_url=str(folder / "own"), image_format="pgm")
        request.map_mode, request.free_thresh, request.occupied_thresh = "trinary", 0.15, 0.65
        assert system.call(SaveMap, "/map_saver/save_map", request, within=20.0).result
    return folder / "own.yaml"


def lived(world: NavigationWorld, folder: Path, parameters: Path = PARAMETERS, *, has_own_map: bool = False) -> Life:
    """Let a robot drive through a world, and return what became of it; with its own map it has been there before."""
    file, chart = world.write(folder)
    if has_own_map:
        chart = mapped(world, folder, parameters)
    with System(seed=world.seed % 2**31) as system:
        navigation = Navigation(system, file, chart, world.start, parameters)
        system.run(2.0)  # costmaps have seen what is around
        robot = system.robot()
        before, began, cpu = robot.contacts, system.time, time.process_time()
        ended = navigation.send(world.goal).get_result_async()
        touched: list[str] = []
        while not ended.done() and system.time - began < LONGEST * world.seconds:
            already = robot.contacts
            system.run(0.5)
            if robot.contacts > already:
                touched.append(f"touched at ({robot.pose.x:.2f}, {robot.pose.y:.2f}), {system.time - began:.1f} s")
        seconds = system.time - began
        answer: Any = ended.result()
        is_near = math.dist((robot.pose.x, robot.pose.y), world.goal[:2]) < NEAR
        status = answer.status if answer else 0
        return Life(
            has_reached=status == GoalStatus.STATUS_SUCCEEDED and is_near,
            contacts=robot.contacts - before,
            seconds=seconds,
            ratio=seconds / world.seconds,
            recoveries=navigation.feedback.number_of_recoveries if navigation.feedback else 0,
            words="; ".join(filter(None, [*touched, _why(answer, is_near)])),
            speed=seconds / max(1e-9, time.process_time() - cpu),
        )
