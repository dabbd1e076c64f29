"""Costmap node: costs from a map and from sensors, for the server that owns it or for itself."""

from __future__ import annotations

from typing import Any

import numpy as np

from robolink.counterparts.nav2_costmap_2d.inputs import PATIENCE, MapInput, SensorInput, planar
from robolink.counterparts.nav2_costmap_2d.outputs import Services, Topics
from robolink.counterparts.nav2_costmap_2d.settings import (
    INFLATION,
    STATIC,
    VOXEL,
    Parameters,
    SettingsError,
    declare_costmap,
    declare_inflation,
    declare_obstacles,
    declare_static,
    layers_of,
)
from robolink.counterparts.nav2_util.parameters import keep_unknown
from robolink.counterparts.nav2_util.robot_pose import fault, in_frame
from robolink.counterparts.program import spin_program
from robolink.exceptions import ParameterException
from robolink.geometry.plane import Pose, is_finite, pose_of
from robolink.interfaces.geometry_msgs.msg import Polygon as PolygonMsg
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.interfaces.lifecycle_msgs.msg import State
from robolink.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from robolink.navigation.costmap import Costmap, Costs, InflationLayer, Layer, ObstacleLayer, StaticLayer
from robolink.navigation.footprint import (
    FREE,
    UNKNOWN,
    FootprintError,
    Radii,
    circle,
    padded,
    parse_footprint,
    radii,
)
from robolink.navigation.grid import Floats, Grid
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.tf2.buffer import Buffer
from robolink.tf2.exceptions import InvalidArgumentException, TransformException
from robolink.tf2.transform_listener import TransformListener
from robolink.time import Time

SUCCESS, FAILURE = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE

MOST_CELLS = 100_000_000
"""Most cells of a costmap whose size is a parameter."""


class Costmap2DROS(LifecycleNode):
    """A managed node with a costmap; `options` are those of `Node`.

    A server that owns one makes it in its constructor with itself as `parent`, spins it by its own executor, and drives
    it by `trigger_configure` and its sisters. Its parameters are those of the node `/NAME/NAME`, or below the parent's
    namespace.

    Args:
        name: Name of the node: `costmap`, `local_costmap` or `global_costmap`.
        parent: Node that owns the costmap; None for a program of its own.
    """

    def __init__(self, name: str = "costmap", parent: Node | None = None, **options: Any) -> None:
        if parent is not None:
            options = _options_of_child(name, parent) | options
        super().__init__(name, **options)
        self.get_logger().info("Creating Costmap")
        self._owner: Node = self if parent is None else parent
        self._costmap = Costmap(Grid(np.zeros((1, 1), np.uint8), 1.0), [])
        self._layers: dict[str, Layer] = {}
        self._inputs: list[MapInput | SensorInput] = []
        self._sensors: list[tuple[ObstacleLayer, SensorInput]] = []
        self._outputs: list[Topics | Services] = []
        self._topics: Topics | None = None
        self._others: list[Any] = []
        self._listener: TransformListener | None = None
        self._timer: Any = None
        self._is_updated = False
        self._lost_ns: int | None = None
        self.tf_buffer = Buffer()
        """Transforms that the server may use, too: filled while the node is configured."""
        self.global_frame, self.base_frame, self.rolls = "map", "base_link", False
        self.footprint: Floats = circle(0.1)
        """Outline of the robot in its frame, with its padding: array of shape (corners, 2) in metres."""
        self.uses_radius = True
        """True if the footprint is a circle."""
        self.add_post_set_parameters_callback(self._on_set)
        if parent is not None:
            _spin_with(parent, self)

    # State, for the owner

    @property
    def grid(self) -> Grid:
        """The costs with their geometry: cells of uint8, which are replaced and never changed."""
        return self._costmap.grid

    def cells(self) -> Costs:
        """Return the costs: rows from the bottom, columns from the left. They are never changed."""
        return self._costmap.grid.cells

    @property
    def radii(self) -> Radii:
        """Inscribed and circumscribed radius of the footprint, in metres."""
        return radii(self.footprint)

    def robot_pose(self) -> Pose | None:
        """Return the latest pose of the robot in the costmap's frame; None, with a warning, where it is not known."""
        try:
            found = self.tf_buffer.lookup_transform_core(self.global_frame, self.base_frame, Time())
        except TransformException as error:
            self.get_logger().warning(
                f"no transform from '{self.base_frame}' to '{self.global_frame}': {error}",
                throttle_duration_sec=PATIENCE,
            )
            return None
        pose = planar(found.transform)
        return pose if is_finite(pose) else None

    def transformed(self, pose: PoseStamped) -> Pose:
        """Return a pose in the costmap's frame; one without a frame is in it.

        Raises:
            TransformException: if no transform is known; InvalidArgumentException for a pose that is none.
        """
        if mistake := fault(pose.pose):
            raise InvalidArgumentException(mistake)
        return pose_of(in_frame(self.tf_buffer, pose, self.global_frame).pose)

    def is_current(self) -> bool:
        """Return whether the costs may be relied on: there is a map if one is needed, and sensors send what is due."""
        return self._is_updated and all(each.is_current() for each in self._inputs)

    def scan_topics(self) -> list[str]:
        """Return the topics of the laser scans that it marks."""
        topics = [each.topic for _, each in self._sensors if each.data_type == "LaserScan"]
        return list(dict.fromkeys(topics))

    def silence(self) -> float:
        """Return the seconds for which the sensor of those in use that is silent longest has sent nothing of use."""
        now = self.get_clock().now().nanoseconds
        last = (each.last_ns for layer, each in self._sensors if layer.enabled)
        return max((now - each for each in last), default=0) / 1e9

    # Requests of the owner, or of a service

    def clear(self) -> None:
        """Forget what sensors saw, and write the costs anew."""
        self._costmap.clear()
        self._forgive()
        self.renew()

    def clear_square(self, x: float, y: float, side: float, *, inside: bool) -> None:
        """Forget what sensors saw in a square of the costmap, or outside of it, and write the costs anew.

        Args:
            x: Middle of the square in metres.
            y: Middle of the square in metres.
            side: Length of its sides in metres.
            inside: True clears the square, False what is around it.
        """
        if not side >= 0.0:
            self.get_logger().error(f"Cannot clear map: expected a reset_distance of 0 or more metres, got {side:g}")
            return
        square = self._costmap.square(x, y, side)
        self._costmap.clear(~square if inside else square)
        self._forgive()
        self.renew()

    def _forgive(self) -> None:
        """Count from now on how long sensors are silent."""
        for each in self._inputs:
            each.reset()

    def renew(self) -> None:
        """Update at once, since the costs are void: nobody may take an empty costmap for a free one meanwhile."""
        self._is_updated = False
        if self._timer is not None:
            self.update()

    def update(self) -> None:
        """Update the costs from map and sensors, and publish them; without the robot's pose nothing is done."""
        robot = self.robot_pose()
        if robot is None:
            self._note_lost()
            return
        self._lost_ns = None
        for each in self._inputs:
            if isinstance(each, MapInput):
                each.look()
        by_layer: dict[int, list[Any]] = {id(layer): [] for layer, _ in self._sensors}
        for layer, sensor in self._sensors:
            by_layer[id(layer)] += sensor.observations()
        for layer, _ in self._sensors:
            layer.observations = by_layer[id(layer)]
        self._costmap.update(robot)
        self._is_updated = True
        self._look_at_place(robot)
        if self._topics is not None:
            self._topics.publish_footprint(self.footprint, robot)
            self._topics.publish(self.grid)

    def _note_lost(self) -> None:
        now = self.get_clock().now().nanoseconds
        self._lost_ns = now if self._lost_ns is None else self._lost_ns
        if now - self._lost_ns > self.get_parameter("initial_transform_timeout").value * 1e9:
            self.get_logger().error(
                f"no costs of {self.get_name()}: the transform from {self.base_frame} to {self.global_frame} did not "
                "become available before timeout",
                throttle_duration_sec=60.0,
            )

    def _look_at_place(self, robot: Pose) -> None:
        if not self.grid.contains(*self.grid.world_to_cell(robot.x, robot.y)):
            self.get_logger().warning(
                f"Robot is out of bounds of the costmap: it is at ({robot.x:.2f}, {robot.y:.2f})",
                throttle_duration_sec=PATIENCE,
            )

    # Transitions

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Read the parameters, subscribe to map and sensors, and offer topics and services."""
        self.get_logger().info("Configuring")
        try:
            self._configure()
        except (ParameterException, SettingsError) as error:
            self.get_logger().error(f"Failed to configure costmap! {error}")
            self._withdraw()
            return FAILURE
        self._topics = Topics(self)
        self._outputs = [self._topics, Services(self)]
        self._others = [
            self.create_subscription(PolygonMsg, "footprint", self.on_footprint, 1),
        ]
        keep_unknown(self, is_child=self._owner is not self)
        return SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Begin to update."""
        self.get_logger().info("Activating")
        result = super().on_activate(state)
        if frequency := self.get_parameter("update_frequency").value:
            self._timer = self.create_timer(1.0 / frequency, self.update)
        return result

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Update no longer."""
        self.get_logger().info("Deactivating")
        self._stop()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw topics, services and subscriptions."""
        self.get_logger().info("Cleaning up")
        self._withdraw()
        return SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw what is left."""
        self.get_logger().info("Shutting down")
        self._withdraw()
        return SUCCESS

    def end(self) -> None:
        """Become unconfigured from whatever state, as its server does when it is cleaned up or ends."""
        if self._state_machine.current_state[0] == State.PRIMARY_STATE_ACTIVE:
            self.trigger_deactivate()
        if self._state_machine.current_state[0] == State.PRIMARY_STATE_INACTIVE:
            self.trigger_cleanup()

    def _stop(self) -> None:
        if self._timer is not None:
            self.destroy_timer(self._timer)
        self._timer, self._is_updated = None, False

    def _withdraw(self) -> None:
        self._stop()
        for each in [*self._inputs, *self._outputs]:
            each.destroy()
        for each in self._others:
            self.destroy_subscription(each)
        if self._listener is not None:
            self._listener.unregister()
        self._inputs, self._outputs, self._sensors, self._others = [], [], [], []
        self._topics = self._listener = None

    # Parameters

    def _configure(self) -> None:
        parameters = Parameters(self)
        declare_costmap(parameters)
        self.global_frame, self.base_frame = parameters["global_frame"], parameters["robot_base_frame"]
        self.rolls = parameters["rolling_window"]
        kinds = layers_of(self, [each for each in parameters["plugins"] if each])
        if filters := [each for each in parameters["filters"] if each]:
            self.get_logger().warning(f"costmap filters are not here: ignored {', '.join(filters)}")
        self._listener = TransformListener(
            self.tf_buffer, self._owner
        )  # whose launch file may have another name for /tf
        default = UNKNOWN if parameters["track_unknown_space"] else FREE
        self._layers = {name: self._made(name, kind, default) for name, kind in kinds.items()}
        self._read()
        grid = _grid_of(parameters)
        self._costmap = Costmap(grid, list(self._layers.values()), default=default, rolling=self.rolls)

    def _made(self, name: str, kind: str, default: int) -> Layer:
        """Return a layer with its inputs."""
        self.get_logger().info(f'Using plugin "{name}"')
        parameters = Parameters(self, f"{name}.")
        if kind == STATIC:
            declare_static(parameters)
            static = StaticLayer()
            self._inputs.append(MapInput(self, static, parameters, self._take_map))
            return static
        if kind == INFLATION:
            declare_inflation(parameters)
            return InflationLayer()
        declare_obstacles(parameters)
        if kind == VOXEL:
            self.get_logger().info(f"{name}: a VoxelLayer is an ObstacleLayer here: its cells have no heights")
        obstacles = ObstacleLayer(default)
        for source in parameters["observation_sources"].split():
            sensor = SensorInput(self, obstacles, name, source)
            self._inputs.append(sensor)
            self._sensors.append((obstacles, sensor))
        return obstacles

    def _read(self) -> None:
        """Set the layers up as the parameters say."""
        self._read_footprint()
        for name, layer in self._layers.items():
            parameters = Parameters(self, f"{name}.")
            if isinstance(layer, StaticLayer):
                layer.use_maximum = self.get_parameter("use_maximum").value
            elif isinstance(layer, ObstacleLayer):
                layer.combination = parameters["combination_method"]
                layer.footprint = self.footprint if parameters["footprint_clearing_enabled"] else None
            elif isinstance(layer, InflationLayer):
                layer.radius, layer.scaling = parameters["inflation_radius"], parameters["cost_scaling_factor"]
                layer.inflate_unknown = parameters["inflate_unknown"]
                layer.around_unknown = parameters["inflate_around_unknown"]
                layer.inscribed = self.radii.inscribed
                if layer.radius < layer.inscribed:
                    self.get_logger().warning(
                        f"{name}.inflation_radius, {layer.radius:g} m, is smaller than the inscribed radius of the "
                        f"robot, {layer.inscribed:g} m: paths may lead too near to obstacles"
                    )
            layer.enabled = parameters["enabled"]  # type: ignore[attr-defined]

    def _read_footprint(self) -> None:
        radius, text = (self.get_parameter(each).value for each in ("robot_radius", "footprint"))
        padding = self.get_parameter("footprint_padding").value
        self.uses_radius = text in ("", "[]")
        polygon = circle(radius)
        if not self.uses_radius:
            try:
                polygon = parse_footprint(text)
            except FootprintError as error:
                self.uses_radius = True
                self.get_logger().error(f"The footprint parameter is invalid, using robot_radius instead: {error}")
        self.footprint = padded(polygon, padding)

    def _on_set(self, changed: list[Parameter[Any]]) -> None:
        """Take over parameters that are set while it runs."""
        if self._topics is None:
            return
        if any(each.name in ("width", "height", "resolution", "origin_x", "origin_y") for each in changed):
            self._costmap.match(_grid_of(Parameters(self)))
        self._read()
        self._costmap.renew()

    def on_footprint(self, message: PolygonMsg) -> None:
        """Take over a footprint that is published."""
        points = np.array([(each.x, each.y) for each in message.points], np.float64).reshape(-1, 2)
        if len(points) < 3 or not np.isfinite(points).all():
            self.get_logger().error(f"expected a footprint of at least 3 points, got {len(points)}: ignored")
            return
        self.set_parameters([Parameter("footprint", value=str(points.tolist()))])

    # Maps

    def _take_map(self, grid: Grid) -> None:
        """Take over the size and place of a map, unless the costmap rolls."""
        own = self._costmap.grid
        if self.rolls or (own.cells.shape == grid.cells.shape and own[1:] == grid[1:]):
            return
        height, width = grid.cells.shape
        self.get_logger().info(f"StaticLayer: Resizing costmap to {width} X {height} at {grid.resolution:f} m/pix")
        self._costmap.match(grid)

    def in_parent(self, topic: str) -> str:
        """Return a relative topic in the namespace above this node's, where its server is."""
        if topic.startswith("/"):
            return topic
        return f"{self.get_namespace().rpartition('/')[0]}/{topic}"


def _options_of_child(name: str, parent: Node) -> dict[str, Any]:
    """Return the options of a costmap that a server makes: names that command lines for the server do not change."""
    namespace = f"{parent.get_namespace().rstrip('/')}/{name}"
    words = ["--ros-args", "-r", f"__node:={name}", "-r", f"__ns:={namespace}"]
    options: dict[str, Any] = {"context": parent.context, "cli_args": words, "namespace": namespace}
    sim_time = parent.get_parameter("use_sim_time").value
    options["parameter_overrides"] = [Parameter("use_sim_time", value=sim_time)]
    return options


def _spin_with(parent: Node, child: Node) -> None:
    """Add a node to the executor of another one, as soon as that has one."""

    def begin() -> None:
        parent.destroy_timer(timer)
        if parent.executor is not None:
            parent.executor.add_node(child)

    timer = parent.create_timer(0.0, begin)


def _grid_of(parameters: Parameters) -> Grid:
    """Return the geometry that parameters say. Raises SettingsError."""
    resolution = parameters["resolution"]
    height, width = int(parameters["height"] / resolution), int(parameters["width"] / resolution)
    if not 0 < height * width <= MOST_CELLS:
        raise SettingsError(
            f"width {parameters['width']} m, height {parameters['height']} m, resolution {resolution:g} m: expected "
            f"1 to {MOST_CELLS} cells, got {height * width}"
        )
    cells = np.broadcast_to(np.uint8(0), (height, width))
    return Grid(cells, resolution, (parameters["origin_x"], parameters["origin_y"], 0.0))


def main(args: list[str] | None = None) -> None:
    """Keep a costmap until Ctrl-C."""
    spin_program(lambda words: Costmap2DROS(), args)
