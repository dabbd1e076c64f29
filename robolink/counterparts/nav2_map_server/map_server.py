"""Map server, which publishes a map of a file, and the node that publishes the meaning of a mask."""

from __future__ import annotations

from typing import Any

from robolink.counterparts.nav2_map_server.map_files import LoadResult, grid_of, path_of, result_of
from robolink.counterparts.program import spin_program
from robolink.documents.foreign import warnings_to
from robolink.exceptions import DocumentError
from robolink.interfaces.lifecycle_msgs.msg import State
from robolink.interfaces.nav2_msgs.msg import CostmapFilterInfo
from robolink.interfaces.nav2_msgs.srv import LoadMap
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.nav_msgs.srv import GetMap
from robolink.lifecycle import LifecycleNode, LifecyclePublisher, LifecycleState, TransitionCallbackReturn
from robolink.parameters.descriptors import described
from robolink.qos import DurabilityPolicy, QoSProfile

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
SUCCESS, FAILURE = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE


class MapServer(LifecycleNode):
    """A managed node that publishes the map of a file. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("map_server", **options)
        self.get_logger().info("Creating")
        self.declare_parameter("yaml_filename", "", described("the map's YAML file"))
        self.declare_parameter("topic_name", "map", described("topic of the map"))
        self.declare_parameter("frame_id", "map", described("frame of the map"))
        self.map: OccupancyGrid | None = None
        self._maps: LifecyclePublisher[OccupancyGrid] | None = None
        self._served: list[Any] = []

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Read the map, and offer the services."""
        self.get_logger().info("Configuring")
        file = self.get_parameter("yaml_filename").value
        if not file:
            self.get_logger().info("yaml_filename is empty: set the map by the service ~/load_map")
        elif self.load(file) is not LoadResult.SUCCESS:
            return FAILURE
        self._served = [
            self.create_service(GetMap, "~/map", self.on_get_map),
            self.create_service(LoadMap, "~/load_map", self.on_load_map),
        ]
        topic = self.get_parameter("topic_name").value
        self._maps = self.create_lifecycle_publisher(OccupancyGrid, topic, LATCHED)
        return SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Publish the map."""
        self.get_logger().info("Activating")
        result = super().on_activate(state)
        self._publish()
        return result

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Publish no longer."""
        self.get_logger().info("Deactivating")
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw the services and the topic."""
        self.get_logger().info("Cleaning up")
        self._withdraw()
        return SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw what is left."""
        self.get_logger().info("Shutting down")
        self._withdraw()
        return SUCCESS

    def _withdraw(self) -> None:
        for each in self._served:
            self.destroy_service(each)
        if self._maps is not None:
            self.destroy_lifecycle_publisher(self._maps)
        self._served, self._maps, self.map = [], None, None

    def load(self, file: str) -> LoadResult:
        """Take the map of a file, and log what is wrong with it."""
        path = path_of(file)
        self.get_logger().info(f"Loading yaml file: {path}")
        try:
            with warnings_to(self.get_logger().warning):
                found = grid_of(path)
        except DocumentError as error:
            self.get_logger().error(f"Failed to load map yaml file: {error}")
            return result_of(error)
        now = self.get_clock().now().to_msg()
        found.header.frame_id, found.header.stamp = self.get_parameter("frame_id").value, now
        found.info.map_load_time = now
        size = f"{found.info.width} X {found.info.height} map @ {found.info.resolution:g} m/cell"
        self.get_logger().info(f"Read map {path}: {size}")
        self.map = found
        return LoadResult.SUCCESS

    def _publish(self) -> None:
        if self._maps is not None and self.map is not None:
            self._maps.publish(self.map)

    def _is_active(self, request: str) -> bool:
        active = self._state_machine.current_state[0] == State.PRIMARY_STATE_ACTIVE
        if not active:
            self.get_logger().warning(f"Received {request} request but not in ACTIVE state, ignoring!")
        return active

    def on_get_map(self, request: GetMap.Request, response: GetMap.Response) -> GetMap.Response:
        """Answer with the map."""
        if self._is_active("GetMap"):
            self.get_logger().info("Handling GetMap request")
            if self.map is not None:
                response.map = self.map
        return response

    def on_load_map(self, request: LoadMap.Request, response: LoadMap.Response) -> LoadMap.Response:
        """Load another map, and publish it."""
        if not self._is_active("LoadMap"):
            response.result = LoadMap.Response.RESULT_UNDEFINED_FAILURE
            return response
        self.get_logger().info("Handling LoadMap request")
        response.result = self.load(request.map_url)
        if response.result == LoadResult.SUCCESS and self.map is not None:
            response.map = self.map
            self._publish()
        return response


def run_map_server(args: list[str] | None = None) -> None:
    """Serve a map until Ctrl-C."""
    spin_program(lambda words: MapServer(), args)


class CostmapFilterInfoServer(LifecycleNode):
    """A managed node that publishes one message. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("costmap_filter_info_server", **options)
        self.declare_parameter("filter_info_topic", "costmap_filter_info", described("topic of the message"))
        self.declare_parameter(
            "type", 0, described("0 keepout or lanes, 1 limits in percent, 2 in m/s, 3 binary", 0, 255)
        )
        self.declare_parameter("mask_topic", "filter_mask", described("topic of the mask, a map"))
        self.declare_parameter("base", 0.0, described("value of a cell of 0"))
        self.declare_parameter("multiplier", 1.0, described("value of each unit of a cell"))
        self._information: LifecyclePublisher[CostmapFilterInfo] | None = None

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Make the publisher."""
        self.get_logger().info("Configuring")
        topic = self.get_parameter("filter_info_topic").value
        self._information = self.create_lifecycle_publisher(CostmapFilterInfo, topic, LATCHED)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Publish the message."""
        self.get_logger().info("Activating")
        result = super().on_activate(state)
        base, multiplier, kind = (self.get_parameter(each).value for each in ("base", "multiplier", "type"))
        message = CostmapFilterInfo(type=kind, base=base, multiplier=multiplier)
        message.filter_mask_topic = self.get_parameter("mask_topic").value
        message.header.frame_id, message.header.stamp = "map", self.get_clock().now().to_msg()
        if self._information is not None:
            self._information.publish(message)
        return result

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw the topic."""
        self.get_logger().info("Cleaning up")
        if self._information is not None:
            self.destroy_lifecycle_publisher(self._information)
            self._information = None
        return TransitionCallbackReturn.SUCCESS


def run_filter_info_server(args: list[str] | None = None) -> None:
    """Publish until Ctrl-C."""
    spin_program(lambda words: CostmapFilterInfoServer(), args)
