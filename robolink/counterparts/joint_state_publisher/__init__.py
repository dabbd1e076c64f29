"""Counterparts of joint_state_publisher and its window: positions for all joints of a robot model."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from robolink.counterparts.program import UsageError, spin_program
from robolink.counterparts.urdf import Joint, Mimic, Robot, parse_urdf, read_text
from robolink.documents.foreign import warnings_to
from robolink.exceptions import DocumentError, RobolinkError, nearest
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.parameters.descriptors import described
from robolink.qos import DurabilityPolicy, QoSProfile

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
    choices = zip(QUANTITIES, (settings.positions, settings.velocities, settings.efforts), strict=True)
    values = {name: 0.0 for name, is_published in choices if is_published}
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


FASTEST = 1000.0
"""Largest rate, in Hz."""
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class JointStatePublisher(Node):
    """A node that publishes the states of all joints that can move.

    The parameters ``zeros.JOINT`` set free joints, also while it runs: each is declared once the robot is known.

    Args:
        description: URDF text; '' waits for it on the topic robot_description.
        options: Those of `Node`.

    Raises:
        DependentJointError: if parameters below dependent_joints say nothing that can be.
        DocumentError: if the description is not a robot; the text has the line.
    """

    def __init__(self, description: str = "", **options: Any) -> None:
        options.setdefault("automatically_declare_parameters_from_overrides", True)
        super().__init__("joint_state_publisher", allow_undeclared_parameters=True, **options)
        self._joints: Joints | None = None
        try:
            self._set_up(description)
        except RobolinkError:
            self.destroy_node()
            raise

    def _set_up(self, description: str) -> None:
        rate = self._declare("rate", 10, "messages a second, in Hz")
        sources = self._declare_sources()
        self._declare("publish_default_positions", True, "publish positions, where no source says any")
        self._declare("publish_default_velocities", False, "publish velocities of 0, where no source says any")
        self._declare("publish_default_efforts", False, "publish efforts of 0, where no source says any")
        self._declare("use_mimic_tags", True, "joints that mimic another follow it")
        self._declare("use_smallest_joint_limits", True, "the limits of safety controllers count as well")
        self._declare("delta", 0.0, "rad or m by which joints move at each message; 0 for none")
        self._settings = self._read_settings()
        if description:
            self._use(description)
        else:
            self.get_logger().info("Waiting for robot_description to be published on the robot_description topic...")
            self.create_subscription(String, "robot_description", self._on_description, LATCHED)
        for each in [sources] if isinstance(sources, str) else sources:
            self.create_subscription(JointState, each, self.on_source, 10)
        self._states = self.create_publisher(JointState, "joint_states", 10)
        if not isinstance(rate, (int, float)) or not 0 < rate <= FASTEST:
            raise UsageError(f"rate: expected a number of Hz from above 0 to {FASTEST:g}, got {rate!r}")
        self.create_timer(1.0 / rate, self.on_timer)
        self.add_post_set_parameters_callback(self._on_parameters)

    def _declare_sources(self) -> Any:
        """Declare the one parameter whose default has no type of its own: an empty list of texts."""
        name, kind = "source_list", Parameter.Type.STRING_ARRAY
        if not self.has_parameter(name):
            self.declare_parameter(name, kind, described("topics of JointState whose values are taken over"))
            self.set_parameters([Parameter(name, kind, [])])
        return self.get_parameter(name).value

    def _declare(self, name: str, default: Any, description: str) -> Any:
        if not self.has_parameter(name):
            self.declare_parameter(name, default, described(description))
        value = self.get_parameter(name).value
        return default if value is None else value

    def _read_settings(self) -> Settings:
        dependent = self.get_parameters_by_prefix("dependent_joints")
        zeros = self.get_parameters_by_prefix("zeros")
        return Settings(
            positions=self.get_parameter("publish_default_positions").value,
            velocities=self.get_parameter("publish_default_velocities").value,
            efforts=self.get_parameter("publish_default_efforts").value,
            use_mimic=self.get_parameter("use_mimic_tags").value,
            use_smallest=self.get_parameter("use_smallest_joint_limits").value,
            zeros={name: each.value for name, each in zeros.items() if isinstance(each.value, (int, float))},
            dependent=dependent_of({name: each.value for name, each in dependent.items()}),
        )

    def _use(self, description: str) -> None:
        """Publish the joints of this robot from now on. Raises DocumentError, DependentJointError."""
        with warnings_to(self.get_logger().warning):
            joints = Joints(parse_urdf(description, anywhere=True), self._settings)
        joints.state()
        self._joints = joints
        for name, joint in joints.free.items():
            self._offer(f"zeros.{name}", joint)

    def _offer(self, parameter: str, joint: FreeJoint) -> None:
        """Declare a joint's parameter with its range, which is a slider on the page of `robolink view`."""
        if not self._settings.positions or self.has_parameter(parameter):
            return
        words = f"position in rad or m, from {joint.low:g} to {joint.high:g}"
        ranges = described(words, joint.low, joint.high) if joint.low < joint.high else described(words)
        self.declare_parameter(parameter, joint.values["position"], ranges)

    def _on_description(self, message: String) -> None:
        try:
            self._use(message.data)
        except (DocumentError, DependentJointError) as error:
            self.get_logger().warning(f"Invalid robot_description given, ignoring: {error}")

    def _on_parameters(self, changed: list[Parameter[Any]]) -> None:
        """Move the joints whose ``zeros.JOINT`` has been set."""
        for each in changed:
            joint = each.name.removeprefix("zeros.")
            is_number = isinstance(each.value, (int, float)) and not isinstance(each.value, bool)
            if joint != each.name and is_number and self._joints is not None and joint in self._joints.free:
                self._joints.free[joint].values["position"] = float(each.value)

    def on_source(self, state: JointState) -> None:
        """Take over the values of free joints."""
        if self._joints is None:
            return
        for index, name in enumerate(state.name):
            if name in self._joints.free:
                for quantity in QUANTITIES:
                    given = getattr(state, quantity)
                    if index < len(given):
                        self._joints.free[name].values[quantity] = float(given[index])

    def on_timer(self) -> None:
        """Publish the states of all joints; without a robot, none."""
        state = JointState()
        state.header.stamp = self.get_clock().now().to_msg()
        if self._joints is None:
            return
        delta = self.get_parameter("delta").value
        if delta > 0:
            for each in self._joints.free.values():
                each.move(delta)
        state.name = list(self._joints.names)
        for quantity, values in self._joints.state().items():
            setattr(state, quantity, values)
        if state.name:
            self._states.publish(state)


def _made(words: list[str]) -> Node:
    """Make the node from its own arguments: none, or the path of a URDF file."""
    return JointStatePublisher(read_text(Path(words[0]), anywhere=True) if words else "")


def run(args: list[str] | None = None) -> None:
    """Publish the joints of the robot on the topic robot_description, or in the file that is the first argument."""
    spin_program(_made, args)


SLIDERS = (
    "the sliders are on the page of 'robolink view', among the parameters of {node}; in a terminal: 'robolink param set"
    " {node} zeros.JOINT 0.5'"
)


def _made_gui(words: list[str]) -> Node:
    """Make the node, whose name is joint_state_publisher in ROS too, and say what serves as sliders."""
    node = _made(words)
    node.get_logger().info(SLIDERS.format(node=node.get_name()))
    return node


def run_gui(args: list[str] | None = None) -> None:
    """Publish the joints of the robot on the topic robot_description, or in the file that is the first argument."""
    spin_program(_made_gui, args)
