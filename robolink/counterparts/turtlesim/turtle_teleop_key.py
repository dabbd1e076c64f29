"""turtle_teleop_key: drives turtle1 by the arrow keys, and turns it to a heading by the letters around F."""

from __future__ import annotations

import contextlib
import sys
from typing import Any

import robolink
from robolink import Node
from robolink.action import ActionClient
from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.control.keyboard import Keyboard, open_keyboard
from robolink.counterparts.turtlesim.turtlesim_node import DEPTH
from robolink.exceptions import ExternalShutdownException
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.turtlesim.action import RotateAbsolute
from robolink.task import Future
from robolink.text.keys import split_keys

HELP = """\
Reading from keyboard
---------------------------
Use arrow keys to move the turtle.
Use G|B|V|C|D|E|R|T keys to rotate to absolute orientations. 'F' to cancel a rotation.
'Q' to quit.
"""
"""Text of turtlesim's own program, which tutorials quote."""
LOOK = 0.02
"""Seconds between two looks at the keyboard."""

DRIVES = {"up": (1.0, 0.0), "down": (-1.0, 0.0), "left": (0.0, 1.0), "right": (0.0, -1.0)}
"""Shares of the speed ahead and of the turning speed, by arrow key."""
HEADINGS = {
    "g": 0.0,
    "t": 0.7854,
    "r": 1.5708,
    "e": 2.3562,
    "d": 3.1416,
    "c": -2.3562,
    "v": -1.5708,
    "b": -0.7854,
}
"""Headings in radians, by the place of a letter around F."""


class TurtleTeleop(Node):
    """A node that commands what keys say. `done` is resolved by Q.

    Args:
        keyboard: Source of keys; None opens the terminal.
        options: More for the node.
    """

    def __init__(self, keyboard: Keyboard | None = None, **options: Any) -> None:
        super().__init__("teleop_turtle", **options)
        self.declare_parameter("scale_angular", 2.0)
        self.declare_parameter("scale_linear", 2.0)
        self.cmd_vel = self.create_publisher(Twist, "turtle1/cmd_vel", DEPTH)
        self.rotation = ActionClient(self, RotateAbsolute, "turtle1/rotate_absolute")
        self.goal: Future[Any] | None = None
        self.done: Future[None] = Future()
        self.keyboard = keyboard or open_keyboard("turtle_teleop_key")
        steady = Clock(clock_type=ClockType.STEADY_TIME, time_base=self.context.time)
        self.create_timer(LOOK, self.on_timer, clock=steady)

    def on_timer(self) -> None:
        """Obey the keys typed since the last look."""
        for key in map(str.lower, split_keys(self.keyboard.read())):
            if key in DRIVES:
                self.drive(*DRIVES[key])
            elif key in HEADINGS:
                self.turn(HEADINGS[key])
            elif key == "f" and self.goal is not None:
                self.goal.add_done_callback(_cancel)
            elif key == "q" and not self.done.done():
                self.done.set_result(None)

    def drive(self, ahead: float, turn: float) -> None:
        """Command shares of the two speeds; the turtle obeys for a second."""
        twist = Twist()
        twist.linear.x = float(self.get_parameter("scale_linear").value) * ahead
        twist.angular.z = float(self.get_parameter("scale_angular").value) * turn
        self.cmd_vel.publish(twist)

    def turn(self, heading: float) -> None:
        """Send a goal, if somebody serves the action."""
        if self.rotation.server_is_ready():
            self.goal = self.rotation.send_goal_async(RotateAbsolute.Goal(theta=heading))

    def destroy_node(self) -> None:
        """Restore the terminal, too."""
        if hasattr(self, "keyboard"):
            self.keyboard.close()
        super().destroy_node()


def _cancel(sent: Future[Any]) -> None:
    """Cancel a goal, now that its server has accepted it."""
    handle = sent.result()
    if handle is not None and handle.accepted:
        handle.cancel_goal_async()


def main(args: list[str] | None = None) -> None:
    """Drive until Q or Ctrl-C, and restore the terminal."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = TurtleTeleop()
        try:
            sys.stdout.write(HELP)
            sys.stdout.flush()
            robolink.spin_until_future_complete(node, node.done)
        finally:
            node.destroy_node()


if __name__ == "__main__":
    main()
