"""Counterpart of robot_state_publisher: the transforms of a robot model, from its joints' positions."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from robolink.counterparts.program import spin_program
from robolink.counterparts.urdf import Joint, Mimic, Robot, parse_urdf, placed, read_text
from robolink.documents.foreign import warnings_to
from robolink.exceptions import DocumentError, InvalidParameterValueException, RobolinkError
from robolink.interfaces.geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.parameters.descriptors import described
from robolink.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from robolink.tf2 import StaticTransformBroadcaster, TransformBroadcaster
from robolink.time import Time, sent_time

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
SLOWEST = 1e-6
"""Smallest publish_frequency that makes a difference, in Hz: once in eleven days."""
FASTEST = 1000.0
"""Largest publish_frequency, in Hz."""


class DescriptionError(RobolinkError, ValueError):
    """There is no robot description."""


class RobotStatePublisher(Node):
    """A node that publishes a robot's description, and the transforms between its links.

    Args:
        file: URDF file that serves where the parameter robot_description is empty.
        options: Those of `Node`.

    Raises:
        DescriptionError: if there is no description.
        DocumentError: if the description is not a robot; the text has the line.
    """

    def __init__(self, file: Path | None = None, **options: Any) -> None:
        super().__init__("robot_state_publisher", **options)
        try:
            self._set_up(file)
        except RobolinkError:
            self.destroy_node()
            raise

    def _set_up(self, file: Path | None) -> None:
        self._from_topic = self._declare("use_robot_description_topic", False, "take the description from the topic")
        text = self._declare("robot_description", "", "the robot as URDF")
        if not text and file is not None:
            text = self._read(file)
        self._declare("publish_frequency", 20.0, "most transforms of a joint per second, in Hz")
        self._declare("frame_prefix", "", "text before the name of each frame")
        self._declare("ignore_timestamp", False, "publish whatever the stamps of joint_states are")
        self._declare("use_tf_static", True, "fixed joints once on /tf_static, not again and again on /tf")
        self._robot: Robot | None = None
        self._published: dict[str, int] = {}
        self._called = 0
        self._broadcaster, self._static_broadcaster = TransformBroadcaster(self), StaticTransformBroadcaster(self)
        self.add_on_set_parameters_callback(check)
        self._description = None if self._from_topic else self.create_publisher(String, "robot_description", LATCHED)
        _raise_refused(self.get_parameter("publish_frequency"))
        if self._from_topic:
            self.create_subscription(String, "robot_description", self._on_description, LATCHED)
        elif not text:
            raise DescriptionError(
                "robot_description parameter must not be empty: give a URDF file as an argument, or the URDF's text as"
                " the parameter"
            )
        else:
            self._use(text)
        self.add_post_set_parameters_callback(self._on_parameters)
        self.create_subscription(JointState, "joint_states", self.on_joint_states, qos_profile_sensor_data)
        if not self.get_parameter("use_tf_static").value:
            self.create_timer(1.0 / max(SLOWEST, self.get_parameter("publish_frequency").value), self._publish_fixed)

    def _declare(self, name: str, default: Any, description: str) -> Any:
        return self.declare_parameter(name, default, described(description)).value

    def _read(self, file: Path) -> str:
        """Take the description of a file as the parameter's value. Raises DocumentError."""
        text = read_text(file)
        self.get_logger().warning(
            "No robot_description parameter, but command-line argument available.  Assuming argument is name of URDF"
            " file."
        )
        self.set_parameters([Parameter("robot_description", value=text)])
        return text

    def _use(self, text: str) -> None:
        """Publish a description, and the fixed transforms of its robot. Raises DocumentError."""
        with warnings_to(self.get_logger().warning):
            self._robot = parse_urdf(text)
        if self._description is not None:
            self._description.publish(String(data=text))
        self.get_logger().info("Robot initialized")
        for each in self._robot.notes:
            self.get_logger().warning(f"{each}: it is published only where joint_states has it")
        self._publish_fixed()

    def _publish_fixed(self) -> None:
        if self._robot is None:
            return
        stamp = self.get_clock().now()
        found = [self._transform(each, 0.0, stamp) for each in self._robot.joints.values() if is_fixed(each)]
        if self.get_parameter("use_tf_static").value:
            self._static_broadcaster.sendTransform(found)
        else:
            self._broadcaster.sendTransform(found)

    def on_joint_states(self, state: JointState) -> None:
        """Publish the transforms of the joints of a message, unless they have been published shortly before."""
        if len(state.name) != len(state.position):
            self._tell_of_invalid(state)
            return
        try:
            stamp = sent_time(state.header.stamp)
        except ValueError as error:  # rclcpp's publisher ends here
            self.get_logger().warning(f"Robot state publisher ignored a JointState message: {error}", once=True)
            return
        now = self.get_clock().now().nanoseconds
        if self._called > now:
            self.get_logger().warning("Moved backwards in time, re-publishing joint transforms!")
            self._published.clear()
        self._called = now
        oldest = min((self._published.get(each, 0) for each in state.name), default=now)
        interval = int(1000.0 / max(SLOWEST, self.get_parameter("publish_frequency").value)) * 10**6
        due = stamp.nanoseconds >= min(oldest, now) + interval
        if self._robot is None or not (due or self.get_parameter("ignore_timestamp").value):
            return
        found = positions(self._robot, dict(zip(state.name, state.position, strict=True)))
        if odd := [name for name, position in found.items() if not math.isfinite(position)]:
            self.get_logger().warning(f"Robot state publisher ignored positions that are not finite: {odd}", once=True)
        moving = ((self._robot.joints.get(name), position) for name, position in found.items())
        self._broadcaster.sendTransform(
            [
                self._transform(each, position, stamp)
                for each, position in moving
                if each is not None and each.moves and math.isfinite(position)
            ]
        )
        self._published.update(dict.fromkeys(state.name, stamp.nanoseconds))

    def _tell_of_invalid(self, state: JointState) -> None:
        if state.position:
            self.get_logger().error("Robot state publisher ignored an invalid JointState message")
            return
        about = f'a JointState message about joint(s) "{state.name[0]}"(,...) whose position member was empty'
        self.get_logger().warning(f"Robot state publisher ignored {about}.")

    def _transform(self, joint: Joint, position: float, stamp: Time) -> TransformStamped:
        prefix = self.get_parameter("frame_prefix").value
        x, y, z, *turn = placed(joint, position)
        made = TransformStamped(child_frame_id=prefix + joint.child)
        made.header.frame_id, made.header.stamp = prefix + joint.parent, stamp.to_msg()
        made.transform = Transform(
            translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(**dict(zip("xyzw", turn, strict=True)))
        )
        return made

    def _on_description(self, message: String) -> None:
        try:
            self._use(message.data)
        except DocumentError as error:
            self.get_logger().error(f"Failed to parse robot description from topic: {error}")

    def _on_parameters(self, changed: list[Parameter[Any]]) -> None:
        for each in changed:
            if each.name == "robot_description" and not self._from_topic:
                self._use(each.value)


def is_fixed(joint: Joint) -> bool:
    """True for a joint that is published as fixed: a planar one, too, as KDL takes it; a floating one is left out."""
    return not joint.moves and joint.kind != "floating"


def positions(robot: Robot, given: dict[str, float]) -> dict[str, float]:
    """Return the positions of joints: those given, and of joints that mimic one of them, or another one that does.

    ROS follows a chain only as far as its joints' names happen to be in order; here it is followed to its end.
    """
    found, seen = dict(given), set(given)
    for name in robot.joints:
        way: list[tuple[str, Mimic]] = []
        while name not in seen and name in robot.joints:
            seen.add(name)
            rule = robot.joints[name].mimic
            if rule is None:
                break
            way.append((name, rule))
            name = rule.joint  # noqa: PLW2901 - up the chain
        for each, rule in reversed(way):
            if rule.joint in found:
                found[each] = found[rule.joint] * rule.multiplier + rule.offset
    return found


def check(changed: list[Parameter[Any]]) -> SetParametersResult:
    """Refuse a description that is not a robot, and a frequency out of its range."""
    for each in changed:
        if reason := refusal(each.name, each.value):
            return SetParametersResult(successful=False, reason=reason)
    return SetParametersResult(successful=True)


def refusal(name: str, value: Any) -> str:
    """Return the reason why a parameter cannot have a value; '' if it can."""
    if name == "publish_frequency" and not 0.0 < value <= FASTEST:
        return "publish_frequency must be between 0.0 (exclusive) and 1000.0"
    if name != "robot_description":
        return ""
    if not value:
        return "Empty URDF is not allowed"
    try:
        with warnings_to(lambda _: None):  # they are told when the description is used
            parse_urdf(value)
    except DocumentError as error:
        return str(error)
    return ""


def _raise_refused(parameter: Parameter[Any]) -> None:
    if reason := refusal(parameter.name, parameter.value):
        raise InvalidParameterValueException(parameter.name, parameter.value, reason)


def make(words: list[str]) -> Node:
    """Make the node from its own arguments: none, or the path of a URDF file."""
    return RobotStatePublisher(Path(words[0]) if words else None)


def main(args: list[str] | None = None) -> None:
    """Publish the robot of the parameter robot_description, or of the file that is the first argument."""
    spin_program(make, args)
