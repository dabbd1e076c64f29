"""Inputs of costmaps: the topics of a map and of sensors, for the layers that know no messages."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from robolink.counterparts.nav2_costmap_2d.sensors import moved, points_of
from robolink.counterparts.nav2_costmap_2d.settings import FARTHEST, Parameters, SettingsError, declare_source
from robolink.geometry.plane import Pose, pose_of
from robolink.interfaces.geometry_msgs.msg import Transform
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.sensor_msgs.msg import LaserScan, PointCloud2
from robolink.navigation.costmap import Observation, ObstacleLayer, Occupancies, StaticLayer
from robolink.navigation.grid import Grid
from robolink.navigation.tracing import Span
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.tf2.exceptions import TransformException
from robolink.time import Time

if TYPE_CHECKING:
    from robolink.counterparts.nav2_costmap_2d.costmap_2d_ros import Costmap2DROS

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
SENSOR_DEPTH = 50
"""Messages of a sensor that wait for their transforms, as in Nav2."""
FINEST, COARSEST = 1e-4, 1e3
"""Bounds of the side of a map's cells in metres, as map_server has them here."""
PATIENCE = 5.0
"""Seconds between two warnings of the same matter."""


class _Placed(NamedTuple):
    """A transform with the names of a pose."""

    position: Any
    orientation: Any


def planar(transform: Transform) -> Pose:
    """Return the pose in the plane of a transform."""
    return pose_of(_Placed(transform.translation, transform.rotation))


class MapInput:
    """Subscription to a map, for a layer.

    Args:
        costmap: Node of the costmap.
        layer: The layer that has the map.
        parameters: Parameters of the layer.
        take: Called with the geometry of each map that a costmap of a fixed place is to have.
    """

    def __init__(
        self, costmap: Costmap2DROS, layer: StaticLayer, parameters: Parameters, take: Callable[[Grid], None]
    ) -> None:
        self._node, self.layer, self._take = costmap, layer, take
        self._frame = ""
        topic = costmap.in_parent(parameters["map_topic"])
        qos = LATCHED if parameters["map_subscribe_transient_local"] else QoSProfile(depth=1)
        self._subscription = costmap.create_subscription(OccupancyGrid, topic, self.on_map, qos)

    def on_map(self, message: OccupancyGrid) -> None:
        """Hand a map to the layer, unless it contradicts itself."""
        info = message.info
        cells = np.asarray(message.data, np.int8)
        origin = pose_of(info.origin)
        fault = ""
        if not cells.size or cells.size != info.width * info.height:
            fault = f"{info.width} x {info.height} cells, and data has {cells.size}"
        elif not (FINEST <= info.resolution <= COARSEST and all(abs(each) <= FARTHEST for each in origin)):
            fault = f"resolution {info.resolution:g}, origin ({origin.x:g}, {origin.y:g}, {origin.theta:g})"
        if fault:
            self._node.get_logger().error(f"Received map message is malformed. Rejecting: {fault}")
            return
        # The float32 0.05 stands for the double 0.05.
        resolution = float(np.float32(info.resolution).astype(str))
        costs = self._meaning().costs_of(cells.reshape(info.height, info.width))
        grid = Grid(costs, resolution, (origin.x, origin.y, origin.theta))
        if self._frame != message.header.frame_id:
            self._frame = message.header.frame_id
            self._look_at_frame()
        self._take(grid)
        self.layer.take(grid)
        self._node.renew()

    def _look_at_frame(self) -> None:
        frame = self._node.global_frame
        if self._frame != frame and not self._node.rolls:
            self._node.get_logger().warning(
                f"the map is in the frame '{self._frame}' and the costmap in '{frame}': taken as if they were one"
            )

    def _meaning(self) -> Occupancies:
        values = {name: self._node.get_parameter(name).value for name in Occupancies._fields}
        return Occupancies(**values)

    def look(self) -> None:
        """Find out where the costmap's frame is in the map's, before an update."""
        node = self._node
        if not node.rolls or self._frame in ("", node.global_frame):
            self.layer.frame = Pose()
            return
        try:
            found = node.tf_buffer.lookup_transform_core(self._frame, node.global_frame, Time())
        except TransformException as error:
            node.get_logger().warning(f"StaticLayer: {error}", throttle_duration_sec=PATIENCE)
            self.layer.frame = None
        else:
            self.layer.frame = planar(found.transform)

    def is_current(self) -> bool:
        """Return whether a map has come."""
        return self.layer.map is not None or not self.layer.enabled

    def reset(self) -> None:
        """Do nothing: a map stays."""

    def destroy(self) -> None:
        """Withdraw the subscription."""
        self._node.destroy_subscription(self._subscription)


class SensorInput:
    """Subscription to a sensor, for a layer of obstacles. Messages wait until an update needs the newest.

    Args:
        costmap: Node of the costmap.
        layer: The layer.
        layer_name: Its name.
        name: Name of the sensor.

    Raises:
        SettingsError: for another type of messages than LaserScan and PointCloud2.
    """

    def __init__(self, costmap: Costmap2DROS, layer: ObstacleLayer, layer_name: str, name: str) -> None:
        self._node, self._layer, self._layer_name = costmap, layer, layer_name
        self._name = f"{layer_name}.{name}"
        self._parameters = Parameters(costmap, f"{self._name}.")
        declare_source(self._parameters, name)
        kind = self._parameters["data_type"]
        if kind not in ("LaserScan", "PointCloud2"):
            raise SettingsError(f"{self._name}.data_type: expected LaserScan or PointCloud2, got '{kind}'")
        self._pending: deque[LaserScan | PointCloud2] = deque(maxlen=SENSOR_DEPTH)
        self._observed: deque[tuple[int, Observation]] = deque(maxlen=SENSOR_DEPTH)
        self.data_type = kind
        self.last_ns = costmap.get_clock().now().nanoseconds
        self.topic = costmap.in_parent(self._parameters["topic"])
        qos = QoSProfile(depth=SENSOR_DEPTH, reliability=ReliabilityPolicy.BEST_EFFORT)
        types = {"LaserScan": LaserScan, "PointCloud2": PointCloud2}
        self._subscription: Any = costmap.create_subscription(types[kind], self.topic, self._pending.append, qos)

    def observations(self) -> list[Observation]:
        """Return the observations for the next update."""
        persistence = round(self._parameters["observation_persistence"] * 1e9)
        self._take_pending(only_newest=not persistence)
        now = self._node.get_clock().now().nanoseconds
        while persistence and self._observed and not 0 <= now - self._observed[0][0] <= persistence:
            self._observed.popleft()
        return [observation for _, observation in self._observed]

    def _take_pending(self, *, only_newest: bool) -> None:
        """Turn messages whose transforms are known into observations; those after the last of them go on waiting."""
        waiting: list[LaserScan | PointCloud2] = []
        found: list[tuple[int, Observation]] = []
        reason = ""
        while self._pending and not (only_newest and found):
            message = self._pending.pop()
            try:
                found.append((Time.from_msg(message.header.stamp).nanoseconds, self._observation(message)))
            except TransformException as error:
                waiting.append(message)
                reason = str(error)
            except ValueError as error:
                self._warn(f"ignored a message: {error}")
        self._pending.clear()
        self._pending.extend(reversed(waiting[:SENSOR_DEPTH]))
        if found:
            self.last_ns = self._node.get_clock().now().nanoseconds
            if only_newest:
                self._observed.clear()
            self._observed.extend(reversed(found))
        elif len(self._pending) == SENSOR_DEPTH:
            self._warn(f"its messages cannot be brought into the frame '{self._node.global_frame}': {reason}")

    def _observation(self, message: LaserScan | PointCloud2) -> Observation:
        """Return the points of a message. Raises TransformException where they are not known yet, and ValueError."""
        parameters, lookup = self._parameters, self._node.tf_buffer.lookup_transform_core
        frame, stamp = self._node.global_frame, message.header.stamp
        transform = lookup(frame, message.header.frame_id, stamp).transform
        own = parameters["sensor_frame"]
        place = (lookup(frame, own, stamp).transform if own else transform).translation
        x, y, z = moved(transform, *points_of(message, inf_is_valid=parameters["inf_is_valid"]))
        layer = Parameters(self._node, f"{self._layer_name}.")
        low = max(each["min_obstacle_height"] for each in (parameters, layer))
        high = min(each["max_obstacle_height"] for each in (parameters, layer))
        right = (z >= low) & (z <= high)
        if len(z) and not right.any():
            self._warn(
                f"no point is from {low:g} to {high:g} m high; they are at {z.min():.2f} to {z.max():.2f} m: "
                f"set {self._name}.max_obstacle_height"
            )
        if not right.all():
            x, y = x[right], y[right]
        marks = Span(parameters["obstacle_min_range"], parameters["obstacle_max_range"])
        clears = Span(parameters["raytrace_min_range"], parameters["raytrace_max_range"])
        return Observation(
            (place.x, place.y),
            x,
            y,
            marks if parameters["marking"] else None,
            clears if parameters["clearing"] else None,
        )

    def _warn(self, text: str) -> None:
        self._node.get_logger().warning(f"{self._name} ({self.topic}): {text}", throttle_duration_sec=PATIENCE)

    def is_current(self) -> bool:
        """Return whether messages come as often as they are expected."""
        expected = self._parameters["expected_update_rate"]
        late = (self._node.get_clock().now().nanoseconds - self.last_ns) / 1e9
        if not expected or late <= expected or not self._layer.enabled:
            return True
        self._warn(f"not updated for {late:.2f} s, and expected every {expected:.2f} s")
        return False

    def reset(self) -> None:
        """Count from now on how long nothing has come."""
        self.last_ns = self._node.get_clock().now().nanoseconds

    def destroy(self) -> None:
        """Withdraw the subscription."""
        self._node.destroy_subscription(self._subscription)
