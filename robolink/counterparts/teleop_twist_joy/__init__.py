"""Counterpart of teleop_twist_joy: velocity commands from a gamepad."""

from __future__ import annotations

import math
from typing import Any

from robolink.counterparts.program import spin_program
from robolink.interfaces.geometry_msgs.msg import Twist, TwistStamped, Vector3
from robolink.interfaces.sensor_msgs.msg import Joy
from robolink.logging import get_logger
from robolink.node import Node
from robolink.parameters.descriptors import described

LINEAR, ANGULAR = ("x", "y", "z"), ("yaw", "pitch", "roll")
AXES = {"linear": {"x": 5}, "angular": {"yaw": 2}}
"""Axes by default; -1 for the others."""
SCALES = {"": 0.5, "_turbo": 1.0}
"""Scales by default of the axes above; 0 for the others."""


class TeleopTwistJoy(Node):
    """A node that makes velocity commands of /joy. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("teleop_twist_joy_node", **options)
        self._declare("require_enable_button", True, "drive only while the enable button is held")
        self._declare("enable_button", 5, "button that has to be held")
        self._declare("enable_turbo_button", -1, "button that has to be held for the turbo scales; -1 for none")
        self._declare("inverted_reverse", False, "turn the other way while driving backwards")
        stamped = self._declare("publish_stamped_twist", False, "publish TwistStamped, not Twist")
        self._declare("frame", "teleop_twist_joy", "frame of the commands, where they are stamped")
        for group, names in (("linear", LINEAR), ("angular", ANGULAR)):
            for name in names:
                default = AXES[group].get(name, -1)
                self._declare(f"axis_{group}.{name}", default, "number of the axis; -1 for none")
                for suffix, scale in SCALES.items():
                    value = 0.0 if default < 0 else scale
                    self._declare(f"scale_{group}{suffix}.{name}", value, "m/s or rad/s at the end of the axis")
        self._kind = TwistStamped if stamped else Twist
        self._commands: Any = self.create_publisher(self._kind, "cmd_vel", 10)
        self._has_stopped = False
        self._tell()
        self.create_subscription(Joy, "joy", self.on_joy, 10)

    def _declare(self, name: str, default: Any, words: str) -> Any:
        return self.declare_parameter(name, default, described(words)).value

    def _value(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _tell(self) -> None:
        """Log which buttons and axes it obeys."""
        logger = get_logger("TeleopTwistJoy")
        turbo = self._value("enable_turbo_button")
        logger.info(f"Teleop enable button {self._value('enable_button')}.")
        if turbo >= 0:
            logger.info(f"Turbo on button {turbo}.")
        for group, names in (("linear", LINEAR), ("angular", ANGULAR)):
            for name in names:
                axis = self._value(f"axis_{group}.{name}")
                if axis >= 0:
                    scale = self._value(f"scale_{group}.{name}")
                    logger.info(f"{group.capitalize()} axis {name} on {axis} at scale {scale:f}.")
                if axis >= 0 and turbo >= 0:
                    scale = self._value(f"scale_{group}_turbo.{name}")
                    logger.info(f"Turbo for {group} axis {name} is scale {scale:f}.")

    def on_joy(self, joy: Joy) -> None:
        """Publish a command, or stop once when the button has been released."""
        if self._is_held(joy, "enable_turbo_button"):
            self._drive(joy, "_turbo")
        elif not self._value("require_enable_button") or self._is_held(joy, "enable_button"):
            self._drive(joy, "")
        elif not self._has_stopped:
            self._has_stopped = True
            self._publish(Twist())

    def _is_held(self, joy: Joy, name: str) -> bool:
        number = self._value(name)
        return 0 <= number < len(joy.buttons) and bool(joy.buttons[number])

    def _drive(self, joy: Joy, suffix: str) -> None:
        self._has_stopped = False
        x, y, z = (self._speed(joy, "linear", name, suffix) for name in LINEAR)
        yaw, pitch, roll = (self._speed(joy, "angular", name, suffix) for name in ANGULAR)
        if self._value("inverted_reverse") and x < 0:
            yaw = -yaw
        self._publish(Twist(linear=Vector3(x=x, y=y, z=z), angular=Vector3(x=roll, y=pitch, z=yaw)))

    def _speed(self, joy: Joy, group: str, name: str, suffix: str) -> float:
        axis = self._value(f"axis_{group}.{name}")
        if not 0 <= axis < len(joy.axes):
            return 0.0
        speed = float(joy.axes[axis] * self._value(f"scale_{group}{suffix}.{name}"))
        return speed if math.isfinite(speed) else 0.0  # a robot must not be told to drive with NaN

    def _publish(self, twist: Twist) -> None:
        if self._kind is Twist:
            self._commands.publish(twist)
            return
        stamped = TwistStamped(twist=twist)
        stamped.header.stamp, stamped.header.frame_id = self.get_clock().now().to_msg(), self._value("frame")
        self._commands.publish(stamped)


def main(args: list[str] | None = None) -> None:
    """Publish commands until Ctrl-C."""
    spin_program(lambda words: TeleopTwistJoy(), args)
