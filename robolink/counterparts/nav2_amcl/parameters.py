"""Parameters of AMCL: names and defaults are Nav2's; values that make no sense are replaced with a warning."""

from __future__ import annotations

from typing import Any, NamedTuple

from robolink.navigation.likelihood_field import SensorModel
from robolink.navigation.localization import BeamSkip, LocalizationOptions
from robolink.navigation.motion_models import Alphas, MotionModel, move_differential, move_omni
from robolink.navigation.particle_filter import FilterOptions
from robolink.node import Node
from robolink.parameters.descriptors import described


class Number(NamedTuple):
    """A parameter with a number: its default, its meaning, and the least and the greatest value that make sense."""

    default: float
    words: str
    low: float
    high: float


NUMBERS = {
    "alpha1": Number(0.2, "errors of turning by turning, rad² per rad²", 0.0, 1e3),
    "alpha2": Number(0.2, "errors of turning by driving, rad² per m²", 0.0, 1e3),
    "alpha3": Number(0.2, "errors of driving by driving, m² per m²", 0.0, 1e3),
    "alpha4": Number(0.2, "errors of driving by turning, m² per rad²", 0.0, 1e3),
    "alpha5": Number(0.2, "errors of driving sideways by driving, m² per m²; omnidirectional robots only", 0.0, 1e3),
    "beam_skip_distance": Number(0.5, "metres from a wall within which a beam agrees with a particle", 0.0, 1e3),
    "beam_skip_error_threshold": Number(0.9, "share of beams from which on none is left out", 0.0, 1.0),
    "beam_skip_threshold": Number(0.3, "share of particles that a beam must agree with to be used", 0.0, 1.0),
    "initial_pose.x": Number(0.0, "metres, with set_initial_pose", -1e6, 1e6),
    "initial_pose.y": Number(0.0, "metres, with set_initial_pose", -1e6, 1e6),
    "initial_pose.z": Number(0.0, "metres; without effect", -1e6, 1e6),
    "initial_pose.yaw": Number(0.0, "radians, with set_initial_pose", -1e3, 1e3),
    "lambda_short": Number(0.1, "of the beam model, which is not there: without effect", 0.0, 1e6),
    "laser_likelihood_max_dist": Number(2.0, "metres from which on walls count as infinitely far", 0.0, 1e3),
    "laser_max_range": Number(100.0, "metres from which on a beam is not used; -1: the scanner's own", -1.0, 1e6),
    "laser_min_range": Number(-1.0, "metres up to which a beam is not used; -1: the scanner's own", -1.0, 1e6),
    "max_beams": Number(60, "most beams of a scan that are used", 1, 100_000),
    "max_particles": Number(2000, "most particles", 1, 100_000),
    "min_particles": Number(500, "least particles", 1, 100_000),
    "pf_err": Number(0.05, "greatest error of the particles' distribution", 1e-6, 1e3),
    "pf_z": Number(0.99, "normal quantile of the probability that pf_err is kept", 0.0, 1e3),
    "random_seed": Number(-1, "seed of all that is drawn; -1: another one each time", -1, 2**63 - 1),
    "recovery_alpha_fast": Number(0.0, "rate of the fast average of the scans' fit; 0.1 helps a lost robot", 0.0, 1.0),
    "recovery_alpha_slow": Number(0.0, "rate of the slow average of the scans' fit; 0.001 helps", 0.0, 1.0),
    "resample_interval": Number(1, "scans that are used between two resamplings", 1, 1_000_000),
    "save_pose_rate": Number(0.5, "Hz; without effect, as in Nav2", -1e6, 1e6),
    "sigma_hit": Number(0.2, "metres; standard deviation of beams that hit a wall of the map", 1e-6, 1e3),
    "transform_tolerance": Number(1.0, "seconds for which a transform from map to odom holds", 0.0, 1e3),
    "update_min_a": Number(0.2, "radians to turn before a scan is used", 0.0, 1e3),
    "update_min_d": Number(0.25, "metres to drive before a scan is used", 0.0, 1e3),
    "z_hit": Number(0.5, "share of beams that hit a wall of the map", 0.0, 1e3),
    "z_max": Number(0.05, "of the beam model, which is not there: without effect", 0.0, 1e3),
    "z_rand": Number(0.5, "share of beams that end anywhere", 0.0, 1e3),
    "z_short": Number(0.05, "of the beam model, which is not there: without effect", 0.0, 1e3),
}

OTHERS: dict[str, tuple[bool | str, str]] = {
    "always_reset_initial_pose": (False, "forget the pose when the node is cleaned up"),
    "base_frame_id": ("base_footprint", "frame of the robot"),
    "do_beamskip": (False, "leave beams out that the map does not explain; with likelihood_field_prob only"),
    "first_map_only": (False, "take no map after the first one"),
    "global_frame_id": ("map", "frame of the map"),
    "laser_model_type": ("likelihood_field", "likelihood_field or likelihood_field_prob"),
    "map_topic": ("map", "topic of the map"),
    "odom_frame_id": ("odom", "frame of odometry"),
    "robot_model_type": ("nav2_amcl::DifferentialMotionModel", "or nav2_amcl::OmniMotionModel"),
    "scan_topic": ("scan", "topic of the scans"),
    "set_initial_pose": (False, "begin at initial_pose"),
    "tf_broadcast": (True, "publish the transform from map to odom"),
}

MOTION_MODELS: dict[str, MotionModel] = {
    "nav2_amcl::DifferentialMotionModel": move_differential,
    "nav2_amcl::OmniMotionModel": move_omni,
    "differential": move_differential,
    "omnidirectional": move_omni,
}
"""Motion models by the names that files of Nav2 have for them."""
SENSOR_MODELS = ("likelihood_field", "likelihood_field_prob")


def declare(node: Node) -> None:
    """Declare the parameters of a node."""
    for name, number in NUMBERS.items():
        node.declare_parameter(name, number.default, described(number.words))
    for name, (default, words) in OTHERS.items():
        node.declare_parameter(name, default, described(words))


def fault(name: str, value: Any) -> str:
    """Return the mistake of a parameter's value; '' if it makes sense."""
    number = NUMBERS.get(name)
    if number is not None and not number.low <= value <= number.high:  # NaN lies in no range
        return f"{name}: expected {number.low:g} to {number.high:g}, got {value:g}"
    if name == "robot_model_type" and value not in MOTION_MODELS:
        return f"robot_model_type: unknown model '{value}', known are {', '.join(MOTION_MODELS)}"
    return ""


class Parameters:
    """Values of a node's parameters, with defaults in place of those that make no sense."""

    def __init__(self, node: Node) -> None:
        self._node = node

    def __getitem__(self, name: str) -> Any:
        """Return a value; warn and return the default if it makes no sense."""
        value = self._node.get_parameter(name).value
        if reason := fault(name, value):
            default = NUMBERS[name].default if name in NUMBERS else OTHERS[name][0]
            self._node.get_logger().warning(f"{reason}: using {default}")
            return default
        return value

    def frame(self, name: str) -> str:
        """Return the name of a frame, without the slash that ROS 1 had before it."""
        return str(self[name]).removeprefix("/")

    def options(self) -> LocalizationOptions:
        """Return the options of localization."""
        model = self["laser_model_type"]
        if model not in SENSOR_MODELS:
            known = " and ".join(SENSOR_MODELS)
            self._node.get_logger().warning(
                f"laser_model_type: '{model}' is not there, known are {known}: using likelihood_field"
            )
        skips = self["do_beamskip"] and model == "likelihood_field_prob"
        skip = ("beam_skip_distance", "beam_skip_threshold", "beam_skip_error_threshold")
        sensor = ("z_hit", "z_rand", "sigma_hit", "laser_likelihood_max_dist")
        return LocalizationOptions(
            particles=self._particles(),
            sensor=SensorModel(*(self[each] for each in sensor)),
            alphas=Alphas(*(self[each] for each in Alphas._fields)),
            motion=MOTION_MODELS[self["robot_model_type"]],
            skip=BeamSkip(*(self[each] for each in skip)) if skips else None,
            update_min_d=self["update_min_d"],
            update_min_a=self["update_min_a"],
            resample_interval=self["resample_interval"],
            recovery_alpha_slow=self["recovery_alpha_slow"],
            recovery_alpha_fast=self["recovery_alpha_fast"],
        )

    def _particles(self) -> FilterOptions:
        found = FilterOptions(*(self[each] for each in FilterOptions._fields))
        if found.min_particles > found.max_particles:
            self._node.get_logger().warning(
                f"min_particles: {found.min_particles} is more than max_particles,"
                f" {found.max_particles}: using {found.min_particles} for both"
            )
            return found._replace(max_particles=found.min_particles)
        return found
