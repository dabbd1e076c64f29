"""Parameters of costmaps: declared under Nav2's names with its defaults, and read together."""

from __future__ import annotations

from typing import Any

from robolink.exceptions import RobolinkError, nearest
from robolink.node import Node
from robolink.parameters.descriptors import described

STATIC, OBSTACLE, INFLATION = "StaticLayer", "ObstacleLayer", "InflationLayer"
VOXEL = "VoxelLayer"
LAYERS = (STATIC, OBSTACLE, VOXEL, INFLATION)
"""Kinds of layers that are here, as they are named after `nav2_costmap_2d::`."""
DEFAULT_LAYERS = {"static_layer": STATIC, "obstacle_layer": OBSTACLE, "inflation_layer": INFLATION}
"""Kinds of layers by the names that need none in a parameter."""

FARTHEST = 1e6
"""Largest distance in metres of a parameter."""


class SettingsError(RobolinkError, ValueError):
    """Parameters with which no costmap can be made."""


class Parameters:
    """Declares parameters of a node with a prefix, and reads them.

    Args:
        node: The node.
        prefix: Name of a layer with a dot, or nothing.
    """

    def __init__(self, node: Node, prefix: str = "") -> None:
        self._node, self._prefix = node, prefix

    def declare(self, name: str, default: Any, words: str, low: float | None = None, high: float | None = None) -> None:
        """Declare a parameter, unless it is declared; `words` describe it, `low` and `high` bound it."""
        if not self._node.has_parameter(self._prefix + name):
            self._node.declare_parameter(self._prefix + name, default, described(words, low, high))

    def __getitem__(self, name: str) -> Any:
        return self._node.get_parameter(self._prefix + name).value


def declare_costmap(parameters: Parameters) -> None:
    """Declare the parameters that do not belong to a layer."""
    declare = parameters.declare
    declare("plugins", list(DEFAULT_LAYERS), "names of the layers, in the order in which they write")
    declare("filters", [""], "names of costmap filters, which are not here")
    declare("global_frame", "map", "frame of the costmap")
    declare("robot_base_frame", "base_link", "frame of the robot")
    declare("update_frequency", 5.0, "updates each second", 0.0, 1000.0)
    declare("publish_frequency", 1.0, "most publications each second; 0 for none", 0.0, 1000.0)
    declare("rolling_window", False, "move with the robot instead of standing still")
    declare("width", 5, "width in metres, unless a map has one", 1, 10_000)
    declare("height", 5, "height in metres, unless a map has one", 1, 10_000)
    declare("resolution", 0.1, "side of a cell in metres, unless a map has one", 0.001, 100.0)
    declare("origin_x", 0.0, "left edge in metres, unless a map has one", -FARTHEST, FARTHEST)
    declare("origin_y", 0.0, "lower edge in metres, unless a map has one", -FARTHEST, FARTHEST)
    declare("robot_radius", 0.1, "radius of the robot in metres", 0.0, 100.0)
    declare("footprint", "[]", "outline of the robot in metres, [[x, y], ...]; [] for a circle")
    declare("footprint_padding", 0.01, "metres by which the footprint is larger", 0.0, 100.0)
    declare("track_unknown_space", False, "keep unknown cells instead of taking them for free")
    declare("transform_tolerance", 0.3, "seconds to wait for a transform", 0.0, 3600.0)
    declare("initial_transform_timeout", 60.0, "seconds without a robot's pose until it is an error", 0.0, 1e6)
    declare("lethal_cost_threshold", 100, "occupancy of a map from which a cell is an obstacle", 0, 100)
    declare("unknown_cost_value", 255, "occupancy of a map that means unknown, as an unsigned byte", 0, 255)
    declare("inscribed_obstacle_cost_value", 99, "occupancy of a map that means the cost 253", 0, 255)
    declare("trinary_costmap", True, "take cells of a map for free, occupied or unknown, nothing between")
    declare("use_maximum", False, "a map lowers no cost of the layers before it")
    declare("always_send_full_costmap", True, "ignored: costmaps are always sent as a whole")


def layers_of(node: Node, names: list[str]) -> dict[str, str]:
    """Return the kinds of layers by their names; declare their parameters `plugin`.

    Raises:
        SettingsError: for a layer that is not here.
    """
    found = {}
    for name in names:
        parameters = Parameters(node, f"{name}.")
        default = DEFAULT_LAYERS.get(name)
        parameters.declare("plugin", f"nav2_costmap_2d::{default}" if default else "", "kind of the layer")
        plugin = parameters["plugin"]
        kind = plugin.replace("/", "::").removeprefix("nav2_costmap_2d::")
        if kind not in LAYERS:
            known = [f"nav2_costmap_2d::{each}" for each in LAYERS]
            raise SettingsError(
                f"{name}.plugin: expected {', '.join(known)}, got '{plugin}'{nearest(plugin, known)}; "
                f"change it, or take '{name}' out of `plugins`"
            )
        found[name] = kind
    return found


def declare_static(parameters: Parameters) -> None:
    """Declare the parameters of a layer of a map."""
    parameters.declare("enabled", True, "write into the costmap")
    parameters.declare("map_topic", "map", "topic of the map, relative to the server's namespace")
    parameters.declare("map_subscribe_transient_local", True, "take a map that was published before, too")


def declare_inflation(parameters: Parameters) -> None:
    """Declare the parameters of a layer that inflates."""
    parameters.declare("enabled", True, "write into the costmap")
    parameters.declare("inflation_radius", 0.55, "metres from an obstacle up to which cells have a cost", 0.0, 1000.0)
    parameters.declare("cost_scaling_factor", 10.0, "how fast the cost falls, in 1/m", 0.0, 1e6)
    parameters.declare("inflate_unknown", False, "give unknown cells a cost, too")
    parameters.declare("inflate_around_unknown", False, "take unknown cells for obstacles")


def declare_obstacles(parameters: Parameters) -> None:
    """Declare the parameters of a layer of what sensors see."""
    parameters.declare("enabled", True, "write into the costmap")
    parameters.declare("footprint_clearing_enabled", True, "cells under the robot are free")
    parameters.declare("min_obstacle_height", 0.0, "lowest points that are looked at, in metres", -FARTHEST, FARTHEST)
    parameters.declare("max_obstacle_height", 2.0, "highest points that are looked at, in metres", -FARTHEST, FARTHEST)
    parameters.declare(
        "combination_method", 1, "0 hides the layers below, 1 keeps larger costs, 2 of known cells", 0, 2
    )
    parameters.declare("observation_sources", "", "names of the sensors, with spaces between them")


def declare_source(parameters: Parameters, name: str) -> None:
    """Declare the parameters of a sensor."""
    declare = parameters.declare
    declare("topic", name, "topic, relative to the server's namespace")
    declare("sensor_frame", "", "frame of the sensor; empty for that of its messages")
    declare("observation_persistence", 0.0, "seconds for which messages count; 0 for the latest only", 0.0, 1e6)
    declare("expected_update_rate", 0.0, "most seconds between messages; 0 expects none", 0.0, 1e6)
    declare("data_type", "LaserScan", "LaserScan or PointCloud2")
    declare("min_obstacle_height", 0.0, "lowest points of this sensor in metres", -FARTHEST, FARTHEST)
    declare("max_obstacle_height", 0.0, "highest points of this sensor in metres", -FARTHEST, FARTHEST)
    declare("inf_is_valid", False, "a beam that meets nothing frees the way, too")
    declare("marking", True, "its points are obstacles")
    declare("clearing", False, "the way to its points is free")
    declare("obstacle_max_range", 2.5, "farthest points that are obstacles, in metres", 0.0, FARTHEST)
    declare("obstacle_min_range", 0.0, "nearest points that are obstacles, in metres", 0.0, FARTHEST)
    declare("raytrace_max_range", 3.0, "metres up to which the way to a point is freed", 0.0, FARTHEST)
    declare("raytrace_min_range", 0.0, "metres from which the way to a point is freed", 0.0, FARTHEST)
