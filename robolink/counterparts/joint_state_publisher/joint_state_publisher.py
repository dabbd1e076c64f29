"""Publish a state for each joint of a robot: zero, or what other topics say of it.

robolink run joint_state_publisher joint_state_publisher robot.urdf
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from robolink.counterparts.joint_state_publisher.joints import (
    QUANTITIES,
    DependentJointError,
    FreeJoint,
    Joints,
    Settings,
    dependent_of,
)
from robolink.counterparts.program import UsageError, spin_program
from robolink.counterparts.urdf import parse_urdf
from robolink.counterparts.urdf.parser import read_text
from robolink.documents.foreign import warnings_to
from robolink.exceptions import DocumentError, RobolinkError
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.parameters.descriptors import described
from robolink.qos import DurabilityPolicy, QoSProfile

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


def make(words: list[str]) -> Node:
    """Make the node from its own arguments: none, or the path of a URDF file."""
    return JointStatePublisher(read_text(Path(words[0]), anywhere=True) if words else "")


def main(args: list[str] | None = None) -> None:
    """Publish the joints of the robot on the topic robot_description, or in the file that is the first argument."""
    spin_program(make, args)


if __name__ == "__main__":
    main()
