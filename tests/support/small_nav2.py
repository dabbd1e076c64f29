"""A small Nav2 in one node: all servers that a navigator uses, with goals that take as long as they are far."""

from __future__ import annotations

import functools
from typing import Any

from robolink.action import ActionServer, CancelResponse, GoalResponse
from robolink.companions.nav2_simple_commander.goals import ACTIONS
from robolink.interfaces.geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from robolink.interfaces.lifecycle_msgs.srv import GetState
from robolink.interfaces.nav2_msgs import srv
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.task import Future

CLEARING: dict[str, type[Any]] = {
    "local_costmap/clear_entirely_local_costmap": srv.ClearEntireCostmap,
    "global_costmap/clear_entirely_global_costmap": srv.ClearEntireCostmap,
    "local_costmap/clear_costmap_except_region": srv.ClearCostmapExceptRegion,
    "local_costmap/clear_costmap_around_robot": srv.ClearCostmapAroundRobot,
    "local_costmap/clear_costmap_around_pose": srv.ClearCostmapAroundPose,
    "global_costmap/clear_costmap_around_pose": srv.ClearCostmapAroundPose,
}


class Nav2(Node):
    """Nav2's servers: a goal at x takes x seconds, one at x < 0 fails at once, one at x > 100 is refused."""

    def __init__(self) -> None:
        super().__init__("nav2")
        self.got, self.poses, self.active_from = list[Any](), list[float](), 0.0
        for kind, name in ACTIONS.items():
            ActionServer(
                self,
                kind,
                name,
                self.execute,
                goal_callback=self.on_goal,
                cancel_callback=lambda _: CancelResponse.ACCEPT,
            )
        for name, service in CLEARING.items():
            self.create_service(service, name, self.on_clear)
        for node in ("amcl", "bt_navigator"):
            self.create_service(GetState, f"{node}/get_state", self.on_state)
        for name in ("local_costmap", "global_costmap"):
            self.create_service(srv.GetCostmap, f"{name}/get_costmap", functools.partial(self.on_get, name))
        self.create_service(srv.Toggle, "collision_monitor/toggle", self.on_toggle)
        self.create_service(srv.LoadMap, "map_server/load_map", self.on_load)
        self.create_service(srv.ManageLifecycleNodes, "lifecycle_manager_navigation/manage_nodes", self.on_manage)
        self.amcl = self.create_publisher(
            PoseWithCovarianceStamped, "amcl_pose", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        )
        self.create_subscription(PoseWithCovarianceStamped, "initialpose", self.on_initial_pose, 10)

    def seconds(self) -> float:
        return self.get_clock().now().nanoseconds / 1e9

    def on_goal(self, goal: Any) -> GoalResponse:
        self.got.append(goal)
        return GoalResponse.REJECT if where(goal) > 100 else GoalResponse.ACCEPT

    async def execute(self, handle: Any) -> Any:
        kind = next(each for each in ACTIONS if isinstance(handle.request, each.Goal))
        left = where(handle.request)
        if left < 0:
            handle.abort()
            fields = {"error_code": 208, "error_msg": "a wall"} if "error_msg" in kind.Result.__ros_fields__ else {}
            return kind.Result(**fields)
        while left > 0:
            await self.pause(min(left, 0.5))
            left -= 0.5
            distance = {"distance_remaining": left} if "distance_remaining" in kind.Feedback.__ros_fields__ else {}
            handle.publish_feedback(kind.Feedback(**distance))
            if handle.is_cancel_requested:
                handle.canceled()
                return kind.Result()
        handle.succeed()
        result: Any = kind.Result()
        if "path" in kind.Result.__ros_fields__:
            result.path.poses = [PoseStamped(), PoseStamped()]
        return result

    def pause(self, seconds: float) -> Future[None]:
        future: Future[None] = Future()

        def end() -> None:
            timer.destroy()
            future.set_result(None)

        timer = self.create_timer(seconds, end)
        return future

    def on_state(self, _: Any, response: GetState.Response) -> GetState.Response:
        response.current_state.label = "active" if self.seconds() >= self.active_from else "inactive"
        return response

    def on_initial_pose(self, pose: PoseWithCovarianceStamped) -> None:
        self.poses.append(pose.pose.pose.position.x)
        if len(self.poses) > 1:
            self.amcl.publish(pose)

    def on_clear(self, request: Any, response: Any) -> Any:
        self.got.append(request)
        return response

    def on_toggle(self, request: srv.Toggle.Request, response: srv.Toggle.Response) -> srv.Toggle.Response:
        self.got.append(request.enable)
        response.success, response.message = request.enable, "it stays on"
        return response

    def on_get(self, name: str, _: Any, response: srv.GetCostmap.Response) -> srv.GetCostmap.Response:
        response.map.metadata.layer = name
        return response

    def on_load(self, request: srv.LoadMap.Request, response: srv.LoadMap.Response) -> srv.LoadMap.Response:
        response.result = 0 if request.map_url == "lab.yaml" else response.RESULT_MAP_DOES_NOT_EXIST
        return response

    def on_manage(self, request: Any, response: Any) -> Any:
        self.got.append(request.command)
        response.success = request.command == request.STARTUP
        return response


def where(goal: Any) -> float:
    """Where a goal is: the x of its pose, its last or its first; 1 of a goal without."""
    for name in ("pose", "goal", "start"):
        if hasattr(goal, name):
            return float(getattr(goal, name).pose.position.x)
    poses = getattr(goal, "poses", None) or getattr(goal, "goals", None)
    return float(poses[-1].pose.position.x) if poses else 1.0
