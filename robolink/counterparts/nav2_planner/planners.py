"""Planners by Nav2's plugin names: the parameters of each, and how it plans by them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from robolink.exceptions import RobolinkError, nearest
from robolink.navigation.planning import PlanOptions
from robolink.node import Node
from robolink.parameters.descriptors import described

NAVFN, SMAC_2D = "nav2_navfn_planner::NavfnPlanner", "nav2_smac_planner::SmacPlanner2D"
DEFAULTS = {"GridBased": NAVFN}
"""Plugins of planners that need no parameter for them."""


class PlannerError(RobolinkError, ValueError):
    """A planner that is not here."""


class Kind(NamedTuple):
    """A kind of planner: default tolerance in metres, and the parameters that only it has."""

    tolerance: float
    declare: Callable[[Node, str], None]
    slope: Callable[[Node, str], float]


def _declare_navfn(node: Node, prefix: str) -> None:
    words = "ignored: the search is always A*"
    node.declare_parameter(f"{prefix}.use_astar", False, described(words))


def _declare_smac(node: Node, prefix: str) -> None:
    words = "how much dearer a cell of the greatest cost is than a free one, as a multiple of that"
    node.declare_parameter(f"{prefix}.cost_travel_multiplier", 1.0, described(words, 0.0, 1000.0))


def _navfn_slope(node: Node, prefix: str) -> float:
    return PlanOptions().slope


def _smac_slope(node: Node, prefix: str) -> float:
    return float(node.get_parameter(f"{prefix}.cost_travel_multiplier").value)


KINDS = {NAVFN: Kind(0.5, _declare_navfn, _navfn_slope), SMAC_2D: Kind(0.125, _declare_smac, _smac_slope)}


class Planner:
    """A planner of a server.

    Args:
        node: The server.
        name: Name of the planner, which its parameters begin with.

    Raises:
        PlannerError: if its plugin is not here.
    """

    def __init__(self, node: Node, name: str) -> None:
        self._node, self.name = node, name
        self._declare("plugin", DEFAULTS.get(name, ""), "kind of the planner")
        plugin = node.get_parameter(f"{name}.plugin").value
        self.plugin = plugin.replace("/", "::")
        if self.plugin not in KINDS:
            raise PlannerError(
                f"{name}.plugin: expected {' or '.join(KINDS)}, got '{plugin}'{nearest(self.plugin, list(KINDS))}"
            )
        self._kind = KINDS[self.plugin]
        words = "metres from the goal within which a path may end, if the goal is out of reach"
        self._declare("tolerance", self._kind.tolerance, words, 0.0, 1e6)
        self._declare("allow_unknown", True, "lead through unknown cells, too")
        self._declare("use_final_approach_orientation", False, "end with the heading of the path, not with the goal's")
        if not node.has_parameter(f"{name}.use_astar") and not node.has_parameter(f"{name}.cost_travel_multiplier"):
            self._kind.declare(node, name)

    def _declare(self, name: str, default: Any, words: str, *bounds: float) -> None:
        full = f"{self.name}.{name}"
        if not self._node.has_parameter(full):
            self._node.declare_parameter(full, default, described(words, *bounds))

    def options(self) -> PlanOptions:
        """Return how it plans by the parameters of now."""
        value = {
            each: self._node.get_parameter(f"{self.name}.{each}").value
            for each in ("tolerance", "allow_unknown", "use_final_approach_orientation")
        }
        slope = self._kind.slope(self._node, self.name)
        return PlanOptions(value["tolerance"], value["allow_unknown"], slope, value["use_final_approach_orientation"])
