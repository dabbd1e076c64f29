"""Commands to a simulated robot: obeyed if plausible, else refused, counted, and warned about once."""

from __future__ import annotations

from typing import Any

from robolink.exceptions import nearest
from robolink.interfaces.geometry_msgs.msg import Twist, TwistStamped
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.node import Node
from robolink.sim import Robot
from robolink.subscription import Subscription
from robolink.system.terminal import shown

ABSURD = 1000.0
"""Largest plausible speed of a command, in m/s or rad/s."""

ABSURD_WHEEL = 100_000.0
"""Largest plausible speed of a wheel, in rad/s."""


class RobotCommands:
    """The subscriptions of one robot: cmd_vel, and joint_command if it has wheels; `refused` counts refused commands.

    A refused command changes nothing: the robot goes on with the last good one until its timeout. The world's motors
    know none, so that wheels are stopped from here: a controller that has died must not drive on. While somebody
    publishes joint_command, cmd_vel is for them to obey: both at once would be two drivers.
    """

    def __init__(self, node: Node, robot: Robot, prefix: str) -> None:
        self.refused = 0
        self.motors = [each.motor for each in robot.description.wheels]
        self._node = node
        self._warned: set[str] = set()
        self._timeout = max(1, round(robot.description.drive.timeout / robot.dt))
        self.follow(robot)
        self._cmd_vel: Subscription[Any]
        if robot.description.drive.stamped:
            self._cmd_vel = node.create_subscription(TwistStamped, f"{prefix}cmd_vel", self._on_stamped, 10)
        else:
            self._cmd_vel = node.create_subscription(Twist, f"{prefix}cmd_vel", self._on_cmd_vel, 10)
        self._joint_command: Subscription[JointState] | None = None
        if self.motors:
            topic = f"{prefix}joint_command"
            self._joint_command = node.create_subscription(JointState, topic, self._on_joint_command, 10)

    def follow(self, robot: Robot) -> None:
        """Command this robot from now on; it has had no command yet."""
        self.robot, self._steps_left = robot, 0

    def step(self) -> None:
        """Stop wheels whose last command is too old; call it before each step of the world."""
        if self._steps_left:
            self._steps_left -= 1
            if not self._steps_left:
                self.robot.turn_wheels(dict.fromkeys(self.motors, 0.0))

    def close(self) -> None:
        """Destroy the subscriptions."""
        self._node.destroy_subscription(self._cmd_vel)
        if self._joint_command is not None:
            self._node.destroy_subscription(self._joint_command)

    def _on_stamped(self, command: TwistStamped) -> None:
        self._on_cmd_vel(command.twist)

    def _on_cmd_vel(self, twist: Twist) -> None:
        if not sane(twist):
            self._refuse("cmd_vel", f"ignored a cmd_vel that is not finite or absurd: {twist}")
        elif self._joint_command is None or not self._joint_command.get_publisher_count():
            self._steps_left = 0
            self.robot.command(twist.linear.x, twist.angular.z, twist.linear.y)

    def _on_joint_command(self, command: JointState) -> None:
        if reason := joint_refusal(command):
            self._refuse("joint_command", f"ignored a joint_command{reason}")
            return
        wanted = dict(zip(command.name, command.velocity, strict=True))
        if unknown := [name for name in wanted if name not in self.motors]:
            asked = f"'{shown(unknown[0])}', which the robot has not{nearest(unknown[0], self.motors)}"
            known = ", ".join(self.motors)
            self._refuse("motor", f"ignored a joint_command's motor {asked}; there is: {known}")
        if known_ones := {name: speed for name, speed in wanted.items() if name in self.motors}:
            self.robot.turn_wheels(known_ones)
            self._steps_left = self._timeout + 1  # `step` is called once before the command's own first step

    def _refuse(self, what: str, text: str) -> None:
        self.refused += 1
        if what not in self._warned:
            self._warned.add(what)
            self._node.get_logger().warning(f"{self.robot.name}: {text} (the next ones are only counted)")


def sane(twist: Twist) -> bool:
    """True if a command is plausible: every number finite and at most `ABSURD`."""
    linear, angular = twist.linear, twist.angular
    return all(abs(each) <= ABSURD for part in (linear, angular) for each in (part.x, part.y, part.z))


def joint_refusal(command: JointState) -> str:
    """Return the reason to refuse a command to wheels; '' if there is none."""
    names, speeds = len(command.name), len(command.velocity)
    if names != speeds:
        return f" that names {names} motors and {speeds} velocities"
    if not names:
        return " that names no motor"
    bad = [name for name, speed in zip(command.name, command.velocity, strict=True) if not abs(speed) <= ABSURD_WHEEL]
    return f" whose velocity of '{shown(bad[0])}' is not finite or absurd" if bad else ""
