"""Drive a robot by the keyboard; it stops when no key has come for half a second."""

import contextlib
from typing import Any, NamedTuple

import robolink
from robolink import Node, Parameter
from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.control.keyboard import Keyboard, NoKeyboard, NoTerminalError, open_keyboard
from robolink.exceptions import ExternalShutdownException, RobolinkError
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.parameters.descriptors import described
from robolink.text.keys import split_keys

HELP = (
    "drive with w a s d, the arrows or u i o j k l m , . - with shift an omnidirectional robot goes sideways - "
    "q and z change the speed, r and f that ahead, e and c that of turning - space stops, Ctrl-C ends"
)
RATE = 20.0
"""Rate of messages, in Hz."""


class Shares(NamedTuple):
    """The command of a key, as shares of the speeds: ahead, to the left, and turning to the left."""

    ahead: float = 0.0
    left: float = 0.0
    turn: float = 0.0


DIRECTIONS = {
    **dict.fromkeys(("w", "i", "up"), Shares(ahead=1.0)),
    **dict.fromkeys(("s", ",", "<", "down"), Shares(ahead=-1.0)),
    **dict.fromkeys(("a", "j", "left"), Shares(turn=1.0)),
    **dict.fromkeys(("d", "l", "right"), Shares(turn=-1.0)),
    **dict.fromkeys((" ", "k"), Shares()),
    "u": Shares(ahead=1.0, turn=1.0),
    "o": Shares(ahead=1.0, turn=-1.0),
    "m": Shares(ahead=-1.0, turn=-1.0),
    ".": Shares(ahead=-1.0, turn=1.0),
    **dict.fromkeys(("A", "J"), Shares(left=1.0)),
    **dict.fromkeys(("D", "L"), Shares(left=-1.0)),
    "U": Shares(ahead=1.0, left=1.0),
    "O": Shares(ahead=1.0, left=-1.0),
    "M": Shares(ahead=-1.0, left=1.0),
    ">": Shares(ahead=-1.0, left=-1.0),
}
"""Keys of movement: those of teleop_twist_keyboard, and w a s d; with shift it goes sideways in place of turning."""

FASTER = 1.1

SPEED_STEPS = {
    "q": (FASTER, FASTER),
    "z": (1 / FASTER, 1 / FASTER),
    "r": (FASTER, 1.0),
    "f": (1 / FASTER, 1.0),
    "e": (1.0, FASTER),
    "c": (1.0, 1 / FASTER),
}
"""Factors of the speed ahead and of the turning speed, for the keys that change speeds."""


class Speeds(NamedTuple):
    """The speeds that a key asks for, in m/s and rad/s."""

    v: float = 0.3
    w: float = 1.0


class Teleop(Node):
    """A node that publishes the velocity of the held key; a terminal reports no release, so it relies on key repeat.

    Once the robot has been stopped it is silent, and another publisher may drive. With `require_terminal` false it
    lives on where there is no terminal, so that a system can be launched from a script and driven by others.
    """

    def __init__(self, keyboard: Keyboard | None = None, **options: Any) -> None:
        self.keyboard: Keyboard = NoKeyboard()
        self.twist, self.ticks_left = Twist(), 0
        super().__init__("teleop", **options)
        words = "end at once where no terminal is, in place of living on without keys"
        required = self.declare_parameter("require_terminal", True, described(words, read_only=True)).value
        try:
            self.keyboard = keyboard or open_keyboard("teleop")
        except NoTerminalError as error:
            if required:
                self.destroy_node()
                raise
            example = "robolink pub /cmd_vel Twist '{linear: {x: 0.3}}' -r 10"
            self.get_logger().warning(f"{error}; drive with: {example}")
        defaults = Speeds()
        self.declare_parameter("speed", defaults.v, described("m/s; keys change it too", 0.0, 10.0))
        self.declare_parameter("turn_speed", defaults.w, described("rad/s; keys change it too", 0.0, 20.0))
        self.declare_parameter("timeout", 0.5, described("seconds after the last key until the robot stops", 0.1, 5.0))
        rate = self.declare_parameter("rate", RATE, described("messages a second while a key is held", 5.0, 100.0))
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        steady = Clock(clock_type=ClockType.STEADY_TIME, time_base=self.context.time)
        self.timer = self.create_timer(1.0 / rate.value, self.on_timer, clock=steady)
        self.add_post_set_parameters_callback(self.on_parameters)
        if not isinstance(self.keyboard, NoKeyboard):
            self.get_logger().info(HELP)

    def on_timer(self) -> None:
        """Read the keys, and publish the command of the last one until it is too old; then stop once."""
        for key in keys(self.keyboard.read()):
            speeds = Speeds(self.get_parameter("speed").value, self.get_parameter("turn_speed").value)
            if key in SPEED_STEPS:
                self.set_speeds(changed(speeds, key))
            elif (twist := twist_of(key, speeds)) is not None:
                lasts = self.get_parameter("timeout").value * self.get_parameter("rate").value
                self.twist, self.ticks_left = twist, max(2, round(lasts))
        if self.ticks_left > 0:
            self.ticks_left -= 1
            self.cmd_vel.publish(self.twist if self.ticks_left else Twist())

    def on_parameters(self, changed: list[Parameter[Any]]) -> None:
        """Change the rate of messages; the timeout of a held key stays the same."""
        for each in changed:
            if each.name == "rate":
                if self.ticks_left > 0:
                    self.ticks_left = max(1, round(self.ticks_left * each.value * self.timer.timer_period_ns / 1e9))
                self.timer.timer_period_ns = round(1e9 / each.value)
                self.timer.reset()

    def set_speeds(self, speeds: Speeds) -> None:
        """Set the speeds, which are this node's parameters, from the next key on."""
        given = [Parameter("speed", value=speeds.v), Parameter("turn_speed", value=speeds.w)]
        if (result := self.set_parameters_atomically(given)).successful:
            self.get_logger().info(f"speed {speeds.v:.2f} m/s, {speeds.w:.2f} rad/s")
        else:
            self.get_logger().warning(result.reason)

    def destroy_node(self) -> None:
        """Stop the robot if it is being driven, and restore the terminal."""
        if self.ticks_left > 0:
            self.ticks_left = 0
            with contextlib.suppress(RobolinkError):  # the session may have ended
                self.cmd_vel.publish(Twist())
        self.keyboard.close()
        super().destroy_node()


def twist_of(key: str, speeds: Speeds) -> Twist | None:
    """Return the velocity of a key; None for a key without meaning."""
    if key not in DIRECTIONS:
        return None
    ahead, left, turn = DIRECTIONS[key]
    return Twist(linear=Vector3(x=ahead * speeds.v, y=left * speeds.v), angular=Vector3(z=turn * speeds.w))


def changed(speeds: Speeds, key: str) -> Speeds:
    """Return the speeds after a key of `SPEED_STEPS`."""
    v, w = SPEED_STEPS[key]
    return Speeds(speeds.v * v, speeds.w * w)


def keys(text: str) -> list[str]:
    """Split what a terminal sent into keys: letters, `up`, `down`, `left`, `right`, and words for others.

    A letter is small, unless shift makes a difference.
    """
    return [key if key in DIRECTIONS else key.lower() for key in split_keys(text)]


def main(args: list[str] | None = None) -> None:
    """Drive until Ctrl-C, then stop the robot and restore the terminal."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = Teleop()
        try:
            robolink.spin(node)
        finally:
            node.destroy_node()


if __name__ == "__main__":
    main()
