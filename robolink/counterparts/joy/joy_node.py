"""Nodes that publish a gamepad's state, in each of ROS's orders, and the list of gamepads."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from robolink.counterparts.joy.devices import (
    ControllerState,
    Gamepad,
    LinuxGamepad,
    State,
    found_gamepads,
    is_supported,
    named,
)
from robolink.counterparts.program import spin_program
from robolink.interfaces.sensor_msgs.msg import Joy
from robolink.node import Node
from robolink.parameters.descriptors import described
from robolink.system.terminal import shown

LOOK = 0.005
"""Time between two looks at the gamepad, in seconds."""
RETRY = 1.0
"""Time between two tries to open it, in seconds."""

Opener = Callable[[Path], Gamepad]


class JoyNode(Node):
    """A node that publishes the state of a gamepad: at each change, and again and again.

    Without a gamepad it waits for one.

    Args:
        name: Name of the node.
        opener: Opens a gamepad; the one of this system by default.
        options: Those of `Node`.
    """

    made_state: type[State] = State
    """Class of the state, which says the order of axes and buttons."""
    repeat = 20.0
    """Default of the parameter autorepeat_rate, in Hz."""

    def __init__(self, name: str = "joy_node", opener: Opener | None = None, **options: Any) -> None:
        super().__init__(name, **options)
        self._opener = opener or LinuxGamepad
        self._can_open = opener is not None or is_supported()
        self.gamepad: Gamepad | None = None
        self.state: State | None = None
        self.declare_device()
        self._deadzone = self._declare("deadzone", 0.05, "share of an axis's way that counts as its centre", 0.0, 0.999)
        words = "Hz at which the same state is published again; 0 for never"
        self._rate = self._declare("autorepeat_rate", self.repeat, words, 0.0, 1000.0)
        self._sticky = self._declare("sticky_buttons", False, "a press toggles a button, a release does nothing")
        self._joy = self.create_publisher(Joy, "joy", 10)
        self._reported, self._published = "", 0
        self._looks = self.create_timer(LOOK, self.on_timer, autostart=False)
        self.create_timer(RETRY, self.find)
        self.find()

    def _declare(self, name: str, default: Any, words: str, low: float | None = None, high: float | None = None) -> Any:
        return self.declare_parameter(name, default, described(words, low, high)).value

    def declare_device(self) -> None:
        """Declare the parameters that say which gamepad it is."""
        self._id = self._declare("device_id", 0, "number of the gamepad")
        self._name = self._declare("device_name", "", "name of the gamepad, which goes before its number")
        self._declare("coalesce_interval_ms", 1, "of no effect: changes within 5 ms are one message")
        self._declare("autocenter", 0, "of no effect: there is no force feedback")

    def path(self) -> Path | None:
        """Return the device of the gamepad; None if there is none."""
        found = found_gamepads()
        if self._name:
            return next((each for each in found.values() if named(each) == self._name), None)
        return found.get(self._id)

    def find(self) -> None:
        """Open the gamepad, if it is not open."""
        if self.gamepad is not None:
            return
        if not self._can_open:
            self._tell(f"gamepads are read by Linux's joystick interface, and this is {sys.platform}: nothing on /joy")
            return
        path = self.path()
        if path is None:
            which = f"named '{self._name}'" if self._name else f"number {self._id}"
            self._tell(f"there is no gamepad {which} (/dev/input/js*): waiting for it")
            return
        try:
            self.gamepad = self._opener(path)
        except OSError as error:
            self._tell(f"{path} cannot be opened: {error.strerror or error}; may this user read it?")
            return
        self.state = self.made_state(self.gamepad, self._deadzone, self._sticky)
        self._reported = ""
        self._looks.reset()
        self.get_logger().info(f"Opened joystick: {self.gamepad.name}.  deadzone: {self._deadzone:f}")

    def on_timer(self) -> None:
        """Publish the state if it has changed, or not for a while."""
        if self.gamepad is None or self.state is None:
            return
        try:
            changes = [self.state.take(each) for each in self.gamepad.read()]
        except OSError:
            self._lose()
            return
        now = self.context.time.now()
        is_late = self._rate > 0 and now - self._published >= 1e9 / self._rate
        if any(changes) or is_late:
            self._published = now
            message = Joy(axes=self.state.axes, buttons=self.state.buttons)
            message.header.stamp, message.header.frame_id = self.get_clock().now().to_msg(), "joy"
            self._joy.publish(message)

    def _lose(self) -> None:
        if self.gamepad is not None:
            self._tell(f"{self.gamepad.name} is gone: waiting for it")
            self.gamepad.close()
        self.gamepad = self.state = None
        self._looks.cancel()

    def _tell(self, text: str) -> None:
        """Warn of something, once."""
        if text != self._reported:
            self.get_logger().warning(text)
        self._reported = text

    def destroy_node(self) -> None:
        """Close the gamepad, too."""
        if self.gamepad is not None:
            self.gamepad.close()
            self.gamepad = None
        super().destroy_node()


def run_joy(args: list[str] | None = None) -> None:
    """Publish the state of a gamepad until Ctrl-C."""
    spin_program(lambda words: JoyNode(), args)


class GameControllerNode(JoyNode):
    """A node that publishes six axes and 21 buttons. `options` are those of `JoyNode`."""

    made_state = ControllerState

    def __init__(self, **options: Any) -> None:
        super().__init__("game_controller_node", **options)


def run_game_controller(args: list[str] | None = None) -> None:
    """Publish the state of a gamepad until Ctrl-C."""
    spin_program(lambda words: GameControllerNode(), args)


class JoyLinuxNode(JoyNode):
    """A node that publishes the state of the gamepad `dev`. `options` are those of `JoyNode`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("joy_node", **options)

    def declare_device(self) -> None:
        """Declare the parameters that say which gamepad it is."""
        self._device = self._declare("dev", "/dev/input/js0", "device of the gamepad")
        self._id = -1
        self._name = self._declare("dev_name", "", "name of the gamepad, which goes before its device")
        self._declare("coalesce_interval", 0.001, "of no effect: changes within 5 ms are one message")
        self._declare("default_trig_val", False, "of no effect: the kernel tells where the triggers are")

    def path(self) -> Path | None:
        """Return the device, if it is there."""
        if self._name:
            return next((each for each in found_gamepads().values() if named(each) == self._name), None)
        path = Path(self._device)
        return path if path.exists() else None


def run_joy_linux(args: list[str] | None = None) -> None:
    """Publish the state of a gamepad until Ctrl-C."""
    spin_program(lambda words: JoyLinuxNode(), args)


def list_devices() -> None:
    """Print a line for each gamepad."""
    rows = [f"{number:>18} : {shown(named(path))}" for number, path in found_gamepads().items()]
    lines = ["Joystick Device ID : Joystick Device Name", "-" * 41, *rows]
    sys.stdout.write("\n".join(lines) + "\n")
