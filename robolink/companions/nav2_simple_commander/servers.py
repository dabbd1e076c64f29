"""The services of Nav2's servers that a navigator uses: costmaps, maps, lifecycles, and the pose to begin with."""

from __future__ import annotations

from typing import Any

from robolink.companions.nav2_simple_commander.clients import Clients
from robolink.interfaces.geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from robolink.interfaces.lifecycle_msgs.srv import GetState
from robolink.interfaces.nav2_msgs import srv
from robolink.interfaces.nav2_msgs.msg import Costmap
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.spinning import spin_until_future_complete

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
"""QoS of amcl_pose: its last pose comes at once."""
A_LOOK = 2.0
"""Time between two looks at the state of a node that is not active, in s."""
A_SECOND = 1.0
"""Time between two initial poses, in s, until localization has answered one."""
BY_HAND = "robot_localization"
"""Name of the localizer that has no lifecycle to wait for."""


class Servers(Node):
    """Node that uses the services of Nav2's servers. Each method waits until its service is there.

    Args:
        node_name: Name of the node.
        namespace: Namespace of the node and of the servers that it uses.
    """

    def __init__(self, node_name: str, namespace: str) -> None:
        super().__init__(node_name, namespace=namespace)
        self._clients_ = Clients(self)
        self.initial_pose = PoseStamped()
        self.initial_pose.header.frame_id = "map"
        self.initial_pose_received = False
        self.initial_pose_pub = self.create_publisher(PoseWithCovarianceStamped, "initialpose", 10)
        self.localization_pose_sub = self.create_subscription(
            PoseWithCovarianceStamped, "amcl_pose", self._on_amcl_pose_, LATCHED
        )

    def destroyNode(self) -> None:
        """Destroy the node, as `destroy_node` does."""
        self.destroy_node()

    def destroy_node(self) -> None:
        """Destroy the node with the clients that it made."""
        self._clients_.destroy()
        super().destroy_node()

    # Beginning

    def setInitialPose(self, initial_pose: PoseStamped) -> None:
        """Publish the pose from which localization begins.

        Args:
            initial_pose: The pose, in the map's frame.
        """
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
        """Load another map into the map server.

        Args:
            map_filepath: The map's YAML file, as the server finds it.

        Returns:
            True if the map was loaded.
        """
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
        """Clear the local costmap but for a square around the robot.

        Args:
            reset_distance: Half a side of the square, in metres.
        """
        kind, name = srv.ClearCostmapExceptRegion, "local_costmap/clear_costmap_except_region"
        self._call_(kind, name, reset_distance=float(reset_distance))

    def clearCostmapAroundRobot(self, reset_distance: float) -> None:
        """Clear a square of the local costmap around the robot.

        Args:
            reset_distance: Half a side of the square, in metres.
        """
        kind, name = srv.ClearCostmapAroundRobot, "local_costmap/clear_costmap_around_robot"
        self._call_(kind, name, reset_distance=float(reset_distance))

    def clearCostmapAroundPose(self, pose: PoseStamped, reset_distance: float) -> None:
        """Clear a square of the local costmap around a pose.

        Args:
            pose: Centre of the square.
            reset_distance: Half a side of the square, in metres.
        """
        kind, name = srv.ClearCostmapAroundPose, "local_costmap/clear_costmap_around_pose"
        self._call_(kind, name, pose=pose, reset_distance=float(reset_distance))

    def getGlobalCostmap(self) -> Costmap:
        """Return the global costmap."""
        costmap: Costmap = self._call_(srv.GetCostmap, "global_costmap/get_costmap").map
        return costmap

    def getLocalCostmap(self) -> Costmap:
        """Return the local costmap."""
        costmap: Costmap = self._call_(srv.GetCostmap, "local_costmap/get_costmap").map
        return costmap

    # Logging

    def info(self, msg: str) -> None:
        """Log at the level INFO.

        Args:
            msg: Text to log.
        """
        self.get_logger().info(msg)

    def warn(self, msg: str) -> None:
        """Log at the level WARN.

        Args:
            msg: Text to log.
        """
        self.get_logger().warning(msg)

    def error(self, msg: str) -> None:
        """Log at the level ERROR.

        Args:
            msg: Text to log.
        """
        self.get_logger().error(msg)

    def debug(self, msg: str) -> None:
        """Log at the level DEBUG.

        Args:
            msg: Text to log.
        """
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
