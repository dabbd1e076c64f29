"""Joints whose states are published: the free ones with their values, and those that depend on others."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from robolink.counterparts.urdf import Joint, Mimic, Robot
from robolink.exceptions import RobolinkError, nearest

QUANTITIES = ("position", "velocity", "effort")
PARTS = ("parent", "factor", "offset")


class DependentJointError(RobolinkError, ValueError):
    """A parameter below `dependent_joints` says nothing that can be."""


class Settings(NamedTuple):
    """Parameters of the publisher that say what is published."""

    positions: bool = True
    velocities: bool = False
    efforts: bool = False
    use_mimic: bool = True
    use_smallest: bool = True
    zeros: Mapping[str, float] = {}
    dependent: Mapping[str, Mimic] = {}


class FreeJoint:
    """A joint with a state of its own: `values` by quantity, and the range within which `move` keeps it.

    A joint that `turns` begins again at the lower end of its range, another goes to and fro.
    """

    def __init__(self, low: float, high: float, values: dict[str, float], turns: bool = False) -> None:
        self.low, self.high, self.values, self.turns = low, high, values, turns
        self._forward = True

    def move(self, delta: float) -> None:
        """Move it by `delta`, in rad or m."""
        position = self.values.get("position", 0.0) + (delta if self._forward else -delta)
        if position > self.high and self.turns:
            position = self.low
        elif not self.low <= position <= self.high:
            position = self.high if self._forward else self.low
            self._forward = not self._forward
        self.values["position"] = position


class Joints:
    """All joints of a robot in the model's order; free ones have values, dependent ones a rule."""

    def __init__(self, robot: Robot, settings: Settings) -> None:
        self.names: list[str] = []
        self.free: dict[str, FreeJoint] = {}
        self.rules: dict[str, Mimic] = dict(settings.dependent)
        for each in robot.joints.values():
            if not each.moves:
                continue
            self.names.append(each.name)
            if settings.use_mimic and each.mimic is not None:
                self.rules[each.name] = each.mimic
            elif each.name not in self.rules:
                self.free[each.name] = _free(each, settings)

    def state(self) -> dict[str, list[float]]:
        """Return each quantity that any joint has, with a value for each of `names`; 0 where it has none."""
        rows = [self._values(name) for name in self.names]
        has = {each for row in rows for each in row}
        return {each: [row.get(each, 0.0) for row in rows] for each in QUANTITIES if each in has}

    def _values(self, name: str) -> dict[str, float]:
        factor, offset, seen = 1.0, 0.0, {name}
        while name in self.rules:
            rule = self.rules[name]
            offset, factor, name = offset + factor * rule.offset, factor * rule.multiplier, rule.joint
            if name in seen:
                raise DependentJointError(f"joints depend on each other in a circle: {' and '.join(sorted(seen))}")
            seen.add(name)
        if name not in self.free:
            return {}
        found = dict(self.free[name].values)
        for key in ("position", "velocity"):
            if key in found:
                found[key] = found[key] * factor + (offset if key == "position" else 0.0)
        return found


def _free(joint: Joint, settings: Settings) -> FreeJoint:
    low, high = limits(joint, settings.use_smallest)
    wanted = zip(QUANTITIES, (settings.positions, settings.velocities, settings.efforts), strict=True)
    values = {name: 0.0 for name, is_wanted in wanted if is_wanted}
    if "position" in values:
        middle = (low + high) / 2 if low > 0 or high < 0 else 0.0
        values["position"] = float(settings.zeros.get(joint.name, middle))
    return FreeJoint(low, high, values, joint.kind == "continuous")


def limits(joint: Joint, use_smallest: bool) -> tuple[float, float]:
    """Return the range of a joint's position, in rad or m; `use_smallest` has those of its safety controller count."""
    if joint.kind == "continuous" or joint.lower is None or joint.upper is None:
        low, high = -math.pi, math.pi
    else:
        low, high = joint.lower, joint.upper
    if use_smallest:
        soft_low, soft_high = joint.soft
        low = low if soft_low is None else max(low, soft_low)
        high = high if soft_high is None else min(high, soft_high)
    return low, high


def dependent_of(given: Mapping[str, Any]) -> dict[str, Mimic]:
    """Return the rules of the parameters below `dependent_joints`, such as ``{"right.parent": "left"}``.

    Raises DependentJointError.
    """
    found: dict[str, dict[str, Any]] = {}
    for name, value in given.items():
        joint, _, part = name.rpartition(".")
        if not joint or part not in PARTS:
            raise DependentJointError(
                f"dependent_joints.{name}: expected JOINT.parent, JOINT.factor or JOINT.offset{nearest(part, PARTS)}"
            )
        found.setdefault(joint, {})[part] = value
    return {joint: _rule(joint, parts) for joint, parts in found.items()}


def _rule(joint: str, parts: dict[str, Any]) -> Mimic:
    parent = parts.get("parent")
    if not isinstance(parent, str):
        raise DependentJointError(f"dependent_joints.{joint}.parent: the name of a joint is needed")
    try:
        return Mimic(parent, float(parts.get("factor", 1.0)), float(parts.get("offset", 0.0)))
    except (TypeError, ValueError):
        raise DependentJointError(f"dependent_joints.{joint}: factor and offset are numbers") from None
