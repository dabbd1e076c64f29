"""Counterpart of teleop_twist_keyboard: velocity commands by the keys of a terminal."""

from __future__ import annotations

import contextlib
import sys
from typing import Any

from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.control.keyboard import Keyboard, open_keyboard
from robolink.counterparts.program import spin_program
from robolink.exceptions import InvalidParameterValueException, RobolinkError
from robolink.interfaces.geometry_msgs.msg import Twist, TwistStamped, Vector3
from robolink.node import Node
from robolink.parameters.descriptors import described

HELP = """Each key is a velocity command on cmd_vel, which holds until the next key.
---------------------------
Drive and turn:
   u    i    o
   j    k    l
   m    ,    .

Sideways, for robots that can (with shift):
   U    I    O
   J    K    L
   M    <    >

t : up (+z)
b : down (-z)

any other key : stop

q/z : both speeds 10% up/down
w/x : speed ahead 10% up/down
e/c : turning speed 10% up/down

CTRL-C ends
"""

MOVES = {
    "i": (1, 0, 0, 0),
    "o": (1, 0, 0, -1),
    "j": (0, 0, 0, 1),
    "l": (0, 0, 0, -1),
    "u": (1, 0, 0, 1),
    ",": (-1, 0, 0, 0),
    ".": (-1, 0, 0, 1),
    "m": (-1, 0, 0, -1),
    "O": (1, -1, 0, 0),
    "I": (1, 0, 0, 0),
    "J": (0, 1, 0, 0),
    "L": (0, -1, 0, 0),
    "U": (1, 1, 0, 0),
    "<": (-1, 0, 0, 0),
    ">": (-1, -1, 0, 0),
    "M": (-1, 1, 0, 0),
    "t": (0, 0, 1, 0),
    "b": (0, 0, -1, 0),
}
"""Signs of a key's command: ahead, to the left, up, and turning to the left."""

SPEED_STEPS = {
    "q": (1.1, 1.1),
    "z": (0.9, 0.9),
    "w": (1.1, 1.0),
    "x": (0.9, 1.0),
    "e": (1.0, 1.1),
    "c": (1.0, 0.9),
}
"""Factors of the speed and of the turning speed, for the keys that change them."""

SHOWN_AGAIN = 15
"""Number of changes of speed after which the help is shown again."""
LOOK = 0.02
"""Time between two looks at the keyboard, in seconds."""


class TeleopTwistKeyboard(Node):
    """A node that publishes a velocity command for each key.

    Args:
        keyboard: Source of keys; None opens the terminal.
        options: Those of `Node`.

    Raises:
        NoTerminalError: if there is no terminal.
    """

    def __init__(self, keyboard: Keyboard | None = None, **options: Any) -> None:
        super().__init__("teleop_twist_keyboard", **options)
        try:
            self._declare()
            self.keyboard = keyboard or open_keyboard("teleop_twist_keyboard")
        except RobolinkError:
            super().destroy_node()
            raise
        self._moves: tuple[int, ...] = ()
        self._changes = self._held = 0
        show(HELP)
        show(self.speeds())
        self._steady = Clock(clock_type=ClockType.STEADY_TIME, time_base=self.context.time)
        self.create_timer(LOOK, self.on_timer, clock=self._steady)
        if self._repeat_rate > 0:
            self.create_timer(1.0 / self._repeat_rate, self._repeat, clock=self._steady)

    def _declare(self) -> None:
        fixed = described("publish TwistStamped, not Twist", read_only=True)
        stamped = self.declare_parameter("stamped", False, fixed).value
        words = described("frame of the commands, where they are stamped", read_only=True)
        self._frame = self.declare_parameter("frame_id", "", words).value
        self._speed = self.declare_parameter("speed", 0.5, described("m/s at the beginning", 0.0, 100.0)).value
        self._turn = self.declare_parameter("turn", 1.0, described("rad/s at the beginning", 0.0, 100.0)).value
        words = described("Hz at which the last command is repeated; 0 for never", 0.0, 1000.0)
        self._repeat_rate = self.declare_parameter("repeat_rate", 0.0, words).value
        words = described("seconds after the last key until the robot is stopped; 0 for never", 0.0, 1e6)
        self._timeout = self.declare_parameter("key_timeout", 0.0, words).value
        if self._frame and not stamped:
            raise InvalidParameterValueException("frame_id", self._frame, "it can only be set when 'stamped' is True")
        self._kind = TwistStamped if stamped else Twist
        self._commands: Any = self.create_publisher(self._kind, "cmd_vel", 10)

    def speeds(self) -> str:
        """Return the line with both speeds."""
        return f"currently:\tspeed {self._speed}\tturn {self._turn} "

    def on_timer(self) -> None:
        """Obey the keys typed since the last look, and stop if the last one is too long ago."""
        for key in self.keyboard.read():
            self.obey(key)
        now = self._steady.now().nanoseconds
        if self._timeout > 0 and self._moves and now - self._held > self._timeout * 1e9:
            self._moves = ()
            self._publish()

    def obey(self, key: str) -> None:
        """Change the speeds, or the command; any key publishes."""
        self._held = self._steady.now().nanoseconds
        if key in SPEED_STEPS:
            speed, turn = SPEED_STEPS[key]
            self._speed, self._turn = self._speed * speed, self._turn * turn
            self._changes += 1
            show(self.speeds())
            if self._changes % SHOWN_AGAIN == 0:
                show(HELP)
        else:
            self._moves = MOVES.get(key, ())
        self._publish()

    def _repeat(self) -> None:
        if self._moves:
            self._publish()

    def _publish(self) -> None:
        ahead, left, up, turn = self._moves or (0, 0, 0, 0)
        linear = Vector3(x=ahead * self._speed, y=left * self._speed, z=up * self._speed)
        twist = Twist(linear=linear, angular=Vector3(z=turn * self._turn))
        if self._kind is Twist:
            self._commands.publish(twist)
            return
        stamped = TwistStamped(twist=twist)
        stamped.header.stamp, stamped.header.frame_id = self.get_clock().now().to_msg(), self._frame
        self._commands.publish(stamped)

    def destroy_node(self) -> None:
        """Stop the robot, and restore the terminal."""
        self._moves = ()
        with contextlib.suppress(RobolinkError):  # the session may have ended
            self._publish()
        self.keyboard.close()
        super().destroy_node()


def show(text: str) -> None:
    """Print a text for whoever holds the keyboard."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def main(args: list[str] | None = None) -> None:
    """Drive until Ctrl-C, then stop the robot and restore the terminal."""
    spin_program(lambda words: TeleopTwistKeyboard(), args)
