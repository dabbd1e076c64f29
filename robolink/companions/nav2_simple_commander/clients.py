"""Clients of Nav2's actions and services, each made at its first use, with waits that spin the node."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.action import ActionClient
from robolink.action.client import ClientGoalHandle
from robolink.client import Client
from robolink.exceptions import ROSInterruptException
from robolink.interfaces.nav2_msgs import action
from robolink.message import Action, Service
from robolink.node import Node
from robolink.spinning import spin_until_future_complete
from robolink.task import Future

ACTIONS: dict[type[Action], str] = {
    action.NavigateToPose: "navigate_to_pose",
    action.NavigateThroughPoses: "navigate_through_poses",
    action.FollowWaypoints: "follow_waypoints",
    action.FollowGPSWaypoints: "follow_gps_waypoints",
    action.FollowPath: "follow_path",
    action.ComputePathToPose: "compute_path_to_pose",
    action.ComputePathThroughPoses: "compute_path_through_poses",
    action.ComputeRoute: "compute_route",
    action.ComputeAndTrackRoute: "compute_and_track_route",
    action.SmoothPath: "smooth_path",
    action.Spin: "spin",
    action.BackUp: "backup",
    action.DriveOnHeading: "drive_on_heading",
    action.AssistedTeleop: "assisted_teleop",
    action.DockRobot: "dock_robot",
    action.UndockRobot: "undock_robot",
}
"""Names under which Nav2 serves its actions, relative to the namespace of the robot."""

PATIENCE = 1.0
"""Time between two notes that a server is not there yet, in s."""


class Clients:
    """Clients of one node. Waiting spins the node, so that its callbacks run.

    Args:
        node: Node to which the clients belong.
    """

    def __init__(self, node: Node) -> None:
        self.node = node
        self.actions: dict[type[Action], ActionClient] = {}
        self.services: dict[str, Client] = {}

    def send(self, kind: type[Action], goal: Any, on_feedback: Callable[[Any], None] | None) -> ClientGoalHandle:
        """Send a goal as soon as there is a server; return its handle, accepted or not.

        Args:
            kind: Action, one of `ACTIONS`.
            goal: Message of the action's ``Goal``.
            on_feedback: Called with each feedback message of this goal.
        """
        client = self.actions.get(kind)
        if client is None:
            client = self.actions[kind] = ActionClient(self.node, kind, ACTIONS[kind])
        self._wait(client.wait_for_server, f"'{kind.__name__}' action server not available, waiting...")
        sent = client.send_goal_async(goal, on_feedback)
        handle: ClientGoalHandle = self.complete(sent)
        return handle

    def call(self, kind: type[Service], name: str, request: Any) -> Any:
        """Call a service as soon as there is one; return its response.

        Args:
            kind: Type of the service.
            name: Name of the service.
            request: Message of the service's ``Request``.
        """
        return self.complete(self.begin_call(kind, name, request))

    def begin_call(self, kind: type[Service], name: str, request: Any) -> Future[Any]:
        """Call a service as soon as there is one; return the future of its response.

        Args:
            kind: Type of the service.
            name: Name of the service.
            request: Message of the service's ``Request``.
        """
        client = self.services.get(name)
        if client is None:
            client = self.services[name] = self.node.create_client(kind, name)
        self._wait(client.wait_for_service, f"'{name}' service not available, waiting...")
        return client.call_async(request)

    def complete(self, future: Future[Any]) -> Any:
        """Spin until a future is done; return its result.

        Args:
            future: Future to wait for.
        """
        spin_until_future_complete(self.node, future)
        return future.result()

    def pause(self, seconds: float) -> None:
        """Spin for a while.

        Args:
            seconds: Length of the pause in s.
        """
        spin_until_future_complete(self.node, Future(), timeout_sec=seconds)

    def _wait(self, is_there: Callable[[float], bool], note: str) -> None:
        while not is_there(PATIENCE):
            if not self.node.context.ok():
                raise ROSInterruptException
            self.node.get_logger().info(note)

    def destroy(self) -> None:
        """Destroy the clients of actions; the node destroys the others."""
        for client in self.actions.values():
            client.destroy()
        self.actions.clear()
