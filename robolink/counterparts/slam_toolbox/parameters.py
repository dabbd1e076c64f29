"""Parameters of slam_toolbox: its names and defaults; values that make no sense are replaced, with a warning."""

from __future__ import annotations

from typing import Any, NamedTuple

from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor
from robolink.navigation.mapper import Options
from robolink.node import Node
from robolink.parameters.descriptors import described


class Number(NamedTuple):
    """A parameter with a number: its default, its meaning, and the least and the greatest value that make sense."""

    default: float
    words: str
    low: float
    high: float


NUMBERS = {
    "coarse_angle_resolution": Number(0.0349, "radians; a match tries headings in steps of a quarter of it", 1e-3, 0.5),
    "coarse_search_angle_offset": Number(0.349, "radians that a match's heading may be off odometry's", 1e-3, 3.15),
    "correlation_search_space_dimension": Number(0.5, "metres; side of the square that a match looks in", 1e-2, 20.0),
    "correlation_search_space_resolution": Number(0.01, "metres; cells of a match: 0.03 at least are used", 1e-4, 1.0),
    "correlation_search_space_smear_deviation": Number(0.1, "metres around a point that others fit to", 5e-3, 1.0),
    "link_match_minimum_response_fine": Number(0.1, "least response of a match that is used", 0.0, 1.0),
    "loop_match_maximum_variance_coarse": Number(3.0, "m²; greatest variance of a loop's match", 0.0, 1e6),
    "loop_match_minimum_chain_size": Number(10, "keyframes in a row that a loop is matched onto at least", 1, 10_000),
    "loop_match_minimum_response_coarse": Number(0.35, "least response of a loop's first match", 0.0, 1.0),
    "loop_match_minimum_response_fine": Number(0.45, "least response of a loop's second match", 0.0, 1.0),
    "loop_search_maximum_distance": Number(3.0, "metres within which a loop is looked for", 0.0, 1e3),
    "loop_search_space_dimension": Number(8.0, "metres; side of the square that a loop's match looks in", 0.1, 100.0),
    "loop_search_space_resolution": Number(0.05, "metres; cells of a loop's match", 1e-3, 1.0),
    "loop_search_space_smear_deviation": Number(0.03, "metres around a point that others fit to, for loops", 5e-3, 1.0),
    "map_update_interval": Number(10.0, "seconds between two maps", 1e-3, 1e6),
    "max_laser_range": Number(25.0, "metres; beams that are longer only say what is free; 0 for the lidar's", 0.0, 1e6),
    "min_pass_through": Number(2, "beams through a cell that are too few to say that it is free", 0, 1_000_000),
    "minimum_time_interval": Number(0.5, "seconds between two keyframes, at least", 0.0, 1e6),
    "minimum_travel_distance": Number(0.5, "metres to drive before the next keyframe", 1e-3, 1e3),
    "minimum_travel_heading": Number(0.5, "radians to turn before the next keyframe", 1e-3, 1e3),
    "occupancy_threshold": Number(0.1, "share of a cell's beams that ended in it, if it is occupied", 0.0, 1.0),
    "position_covariance_scale": Number(1.0, "factor of the covariance of x and y on the topic pose", 0.0, 1e9),
    "resolution": Number(0.05, "metres; side of a cell of the map", 5e-3, 10.0),
    "scan_buffer_maximum_scan_distance": Number(10.0, "metres within which keyframes are matched onto", 0.1, 1e6),
    "scan_buffer_size": Number(10, "last keyframes that a scan is matched onto", 1, 200),
    "scan_queue_size": Number(1, "scans that wait for odometry's transform, at most", 1, 10_000),
    "tf_buffer_duration": Number(30.0, "seconds of transforms that are remembered", 0.1, 1e6),
    "throttle_scans": Number(1, "one of so many scans is used", 1, 1_000_000),
    "transform_publish_period": Number(0.05, "seconds between two transforms from map to odom; 0 for none", 0.0, 1e6),
    "transform_timeout": Number(0.5, "seconds by which these are stamped into the future", 0.0, 1e3),
    "yaw_covariance_scale": Number(1.0, "factor of the covariance of the heading on the topic pose", 0.0, 1e9),
}

OTHERS: dict[str, tuple[bool | str, str]] = {
    "base_frame": ("base_footprint", "frame of the robot"),
    "do_loop_closing": (True, "look for places where the robot was before"),
    "map_file_name": ("", "pose graph to begin with, without its ending"),
    "map_frame": ("map", "frame of the map"),
    "map_name": ("/map", "topic of the map"),
    "map_start_at_dock": (False, "with map_file_name: the robot is where that map began"),
    "odom_frame": ("odom", "frame of odometry"),
    "paused_new_measurements": (False, "True while scans are not used; see the service pause_new_measurements"),
    "scan_topic": ("/scan", "topic of the scans"),
    "use_map_saver": (True, "offer the service save_map"),
    "use_response_expansion": (True, "look three times as far where nothing fits well"),
    "use_scan_matching": (True, "match scans onto each other; without, odometry is believed"),
}

OPTIONS = tuple(name for name in Options._fields if name in NUMBERS or name in OTHERS)


def declare(node: Node) -> None:
    """Declare the parameters of a node."""
    for name, number in NUMBERS.items():
        node.declare_parameter(name, number.default, described(number.words))
    for name, (default, words) in OTHERS.items():
        node.declare_parameter(name, default, described(words))
    words = "with map_file_name: x, y (metres) and heading (radians) of the robot in that map"
    any_list = ParameterDescriptor(description=words, dynamic_typing=True)  # an empty list has no type
    node.declare_parameter("map_start_pose", list[float](), any_list)


def fault(name: str, value: Any) -> str:
    """Return the mistake of a parameter's value; '' if it makes sense."""
    number = NUMBERS.get(name)
    if number is not None and not number.low <= value <= number.high:  # NaN lies in no range
        return f"{name}: expected {number.low:g} to {number.high:g}, got {value:g}"
    return ""


class Parameters:
    """Values of a node's parameters, with defaults in place of those that make no sense."""

    def __init__(self, node: Node) -> None:
        self._node = node

    def __getitem__(self, name: str) -> Any:
        """Return a value; warn and return the default if it makes no sense."""
        value = self._node.get_parameter(name).value
        if reason := fault(name, value):
            default = NUMBERS[name].default
            self._node.get_logger().warning(f"{reason}: using {default:g}")
            return default
        return value

    def frame(self, name: str) -> str:
        """Return the name of a frame, without the slash that ROS 1 had before it."""
        return str(self[name]).removeprefix("/")

    def options(self) -> Options:
        """Return the options of the mapper."""
        return Options(**{name: self[name] for name in OPTIONS})
