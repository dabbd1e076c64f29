"""Controllers of the server: Nav2's plugins by name, each with robolink's algorithm and its parameters."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from robolink.counterparts.nav2_util.options import PluginError, names_of, plugin_of, read_options
from robolink.exceptions import nearest
from robolink.geometry.plane import Pose, Speeds
from robolink.navigation import critics, pursuit, rollouts
from robolink.navigation.critics import Critic, Surroundings
from robolink.navigation.local_path import LocalPath
from robolink.navigation.rollouts import Command
from robolink.node import Node
from robolink.parameters.descriptors import described

WORDS = {
    "batch_size": "rollouts that are tried in a step",
    "time_steps": "steps of a rollout",
    "model_dt": "seconds of a step of a rollout",
    "iteration_count": "rounds of improvement in a step",
    "temperature": "how much more a cheap rollout counts; less trusts the cheapest only",
    "gamma": "weight of the distance from the commands found last",
    "vx_max": "greatest speed ahead in m/s",
    "vx_min": "greatest speed backwards in m/s, negative",
    "wz_max": "greatest turning speed in rad/s",
    "ax_max": "greatest acceleration ahead in m/s²",
    "ax_min": "greatest braking in m/s², negative",
    "az_max": "greatest acceleration of turning in rad/s²",
    "vx_std": "standard deviation of the speed ahead of rollouts in m/s",
    "wz_std": "standard deviation of the turning speed of rollouts in rad/s",
    "regenerate_noises": "draw new noise in each step",
    "min_turning_r": "radius in metres of the tightest bend of a robot that steers; 0 turns on the spot",
    "enabled": "let this critic judge",
    "cost_power": "power to which its costs are raised",
    "cost_weight": "weight of its costs",
    "critical_cost": "cost of a place that is nearly in an obstacle",
    "near_collision_cost": "cost of a costmap from which a place counts as nearly in an obstacle",
    "collision_cost": "cost of a rollout that collides",
    "near_goal_distance": "metres to the goal within which nearness to obstacles costs nothing",
    "trajectory_point_step": "every which point of a rollout is looked at",
    "consider_footprint": "look at the footprint instead of its centre",
    "threshold_to_consider": "metres to the goal, or of path, from which on it judges",
    "max_path_occupancy_ratio": "share of the path that may be obstructed",
    "offset_from_furthest": "points of the path beyond the one that is reached",
    "use_path_orientations": "compare headings, too",
    "max_angle_to_furthest": "turn towards the path in radians from which on it judges",
    "margin": "distance from a moving obstacle in metres that costs nothing",
    "spread": "metres by which that grows in a second of looking ahead",
    "desired_linear_vel": "speed ahead in m/s",
    "lookahead_dist": "distance in metres of the point of the path that is pursued",
    "min_lookahead_dist": "least such distance in metres, if it depends on the speed",
    "max_lookahead_dist": "greatest such distance in metres, if it depends on the speed",
    "lookahead_time": "seconds of driving to that point, if its distance depends on the speed",
    "use_velocity_scaled_lookahead_dist": "let the distance depend on the speed",
    "rotate_to_heading_angular_vel": "speed of turning on the spot in rad/s",
    "max_angular_accel": "greatest acceleration of turning in rad/s²",
    "use_rotate_to_heading": "turn on the spot to the path and to the goal's heading",
    "rotate_to_heading_min_angle": "turn to the path in radians from which on it turns on the spot",
    "min_approach_linear_velocity": "least speed at the goal in m/s",
    "approach_velocity_scaling_dist": "metres before the goal from which on it slows down",
    "use_collision_detection": "look for collisions ahead",
    "max_allowed_time_to_collision_up_to_carrot": "seconds ahead in which nothing may stand",
    "use_regulated_linear_velocity_scaling": "slow down in bends",
    "regulated_linear_scaling_min_radius": "radius in metres of a bend from which on it slows down",
    "regulated_linear_scaling_min_speed": "speed in m/s below which bends and obstacles do not slow it down",
    "use_cost_regulated_linear_velocity_scaling": "slow down near obstacles",
    "cost_scaling_dist": "distance to an obstacle in metres from which on it slows down",
    "cost_scaling_gain": "factor on the speed near obstacles",
    "inflation_cost_scaling_factor": "cost_scaling_factor of the local costmap's inflation layer",
    "predict_movers": "slow down, stand or back away where moving obstacles will be",
    "stateful": "a goal that was reached once stays reached, while the robot turns",
}
"""Descriptions of parameters."""

CRITICS: dict[str, type[Critic]] = {
    "CostCritic": critics.CostCritic,
    "ObstaclesCritic": critics.CostCritic,
    "GoalCritic": critics.GoalCritic,
    "GoalAngleCritic": critics.GoalAngleCritic,
    "PathAlignCritic": critics.PathAlignCritic,
    "PathFollowCritic": critics.PathFollowCritic,
    "PathAngleCritic": critics.PathAngleCritic,
    "PreferForwardCritic": critics.PreferForwardCritic,
    "TwirlingCritic": critics.TwirlingCritic,
    "MoversCritic": critics.MoversCritic,
}
"""Critics by Nav2's names; MoversCritic is robolink's own."""
NEEDLESS = ("ConstraintCritic", "PathAlignLegacyCritic", "VelocityDeadbandCritic")
"""Nav2's critics that have nothing to say here: rollouts keep to the limits by themselves, for one."""
DEFAULT_CRITICS = [
    name for name, kind in CRITICS.items() if name != "ObstaclesCritic" and kind in map(type, critics.USUAL)
]


class Controller(Protocol):
    """A controller: a command for each step."""

    prune_distance: float
    """Metres of the path that it looks at."""
    follows_movers: bool
    """True if it wants to know what moves."""

    def step(
        self, pose: Pose, speed: Speeds, path: LocalPath, goal: Pose, around: Surroundings, tolerance: float
    ) -> Command:
        """Return the command of now; all in the frame of the costmap."""

    def limit(self, limit: float, *, percentage: bool) -> None:
        """Lower the speed, to m/s or to percent; 0.0 for no limit."""

    def reset(self) -> None:
        """Forget what was driven."""


class RolloutsController:
    """MPPI. `period` is in seconds, `seed` that of the noise."""

    def __init__(self, node: Node, name: str, period: float, seed: int) -> None:
        self._options = read_options(node, name, rollouts.Options, WORDS)
        chosen = self._critics(node, name)
        self.follows_movers = any(isinstance(each, critics.MoversCritic) and each.enabled for each in chosen)
        random = np.random.default_rng(seed)
        self._rollouts = rollouts.Rollouts(self._options, chosen, random=random, period=period)
        words = "metres of the path ahead that are looked at"
        self.prune_distance = _declared(node, f"{name}.prune_distance", 1.7, words)
        self._check(name, period)

    def _check(self, name: str, period: float) -> None:
        options = self._options
        for field, is_right, expected in (
            ("model_dt", options.model_dt >= period - 1e-6, f"at least the period of control, {period:g}"),
            ("batch_size", 1 <= options.batch_size <= 100_000, "1 to 100000"),
            ("time_steps", 2 <= options.time_steps <= 1000, "2 to 1000"),
            ("temperature", options.temperature > 0.0, "more than 0"),
            ("vx_max", options.vx_max > 0.0, "more than 0"),
        ):
            if not is_right:
                raise PluginError(f"{name}.{field}: expected {expected}, got {getattr(options, field):g}")

    def _critics(self, node: Node, name: str) -> tuple[Critic, ...]:
        found = []
        words = "names of the critics that judge rollouts"
        for critic in names_of(node, f"{name}.critics", DEFAULT_CRITICS, words):
            if critic in NEEDLESS:
                continue
            if critic not in CRITICS:
                raise PluginError(
                    f"{name}.critics: expected some of {', '.join(CRITICS)}, got '{critic}'{nearest(critic, CRITICS)}"
                )
            found.append(read_options(node, f"{name}.{critic}", CRITICS[critic], WORDS))
        if _declared(node, f"{name}.predict_movers", True, "look ahead to where moving obstacles will be") and not any(
            isinstance(each, critics.MoversCritic) for each in found
        ):
            found.append(read_options(node, f"{name}.MoversCritic", critics.MoversCritic, WORDS))
        return tuple(found)

    def step(
        self, pose: Pose, speed: Speeds, path: LocalPath, goal: Pose, around: Surroundings, tolerance: float
    ) -> Command:
        """Return the command of now."""
        return self._rollouts.step(pose, speed, path, goal, around)

    def limit(self, limit: float, *, percentage: bool) -> None:
        """Lower the speed."""
        self._rollouts.options = self._options.limited(limit, percentage=percentage)

    def reset(self) -> None:
        """Forget the commands found last."""
        self._rollouts.reset()


class PursuitController:
    """Regulated pure pursuit."""

    def __init__(self, node: Node, name: str, period: float, inscribed: float, reach: float) -> None:
        self._options = read_options(node, name, pursuit.Options, WORDS)
        self.follows_movers = self._options.predict_movers
        self._pursuit = pursuit.Pursuit(self._options, inscribed=inscribed, period=period)
        words = "metres of the path ahead that are looked at"
        self.prune_distance = _declared(node, f"{name}.max_robot_pose_search_dist", reach, words)

    def step(
        self, pose: Pose, speed: Speeds, path: LocalPath, goal: Pose, around: Surroundings, tolerance: float
    ) -> Command:
        """Return the command of now."""
        return self._pursuit.step(pose, speed, path, around, tolerance)

    def limit(self, limit: float, *, percentage: bool) -> None:
        """Lower the speed."""
        self._pursuit.options = self._options.limited(limit, percentage=percentage)

    def reset(self) -> None:
        """Forget that the goal was reached."""
        self._pursuit.reset()


MPPI, PURSUIT = (
    "nav2_mppi_controller::MPPIController",
    "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController",
)
PLUGINS = {
    MPPI: MPPI,
    PURSUIT: PURSUIT,
    "dwb_core::DWBLocalPlanner": MPPI,
    "nav2_graceful_controller::GracefulController": PURSUIT,
    "nav2_rotation_shim_controller::RotationShimController": PURSUIT,
}
"""Plugins of Nav2, each with the one that stands for it here."""


def controller(node: Node, name: str, *, period: float, inscribed: float, reach: float) -> Controller:
    """Return the controller that a node's parameters describe.

    Args:
        node: The node.
        name: Name of the controller.
        period: Seconds of a step of control.
        inscribed: Radius in metres of the largest circle in the footprint.
        reach: Distance in metres from the robot to the edge of the local costmap.

    Raises:
        PluginError: for a plugin that is not here, or parameters with which it cannot work.
    """
    plugin = plugin_of(node, name, MPPI, PLUGINS)
    actual = PLUGINS[plugin]
    if plugin.startswith("nav2_rotation_shim"):
        words = "controller that drives once the robot looks along the path"
        primary = _declared(node, f"{name}.primary_controller", PURSUIT, words).replace("/", "::")
        actual = PLUGINS.get(primary, PURSUIT)
    if actual != plugin:
        node.get_logger().warning(f"{name}: {plugin} is not here: {actual} takes its place, with its own parameters")
    if actual == PURSUIT:
        return PursuitController(node, name, period, inscribed, reach)
    seed = _declared(node, f"{name}.seed", 0, "seed of the noise of rollouts")
    return RolloutsController(node, name, period, seed)


def _declared(node: Node, parameter: str, default: Any, words: str) -> Any:
    if not node.has_parameter(parameter):
        node.declare_parameter(parameter, default, described(words))
    return node.get_parameter(parameter).value
