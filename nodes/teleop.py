"""Drive a robot by the keyboard; it stops when no key has come for half a second."""

import atexit
import os
import re
import sys
from typing import Any, NamedTuple, Protocol

from robolink import Node
from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.exceptions import RobolinkError
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3

HELP = "drive with w a s d, the arrows or u i o j k l m , . - q and z change the speed, space stops, Ctrl-C ends"
RATE = 20.0

DIRECTIONS = {
    **dict.fromkeys(("w", "i", "up"), (1.0, 0.0)),
    **dict.fromkeys(("s", ",", "down"), (-1.0, 0.0)),
    **dict.fromkeys(("a", "j", "left"), (0.0, 1.0)),
    **dict.fromkeys(("d", "l", "right"), (0.0, -1.0)),
    **dict.fromkeys((" ", "k"), (0.0, 0.0)),
    "u": (1.0, 1.0),
    "o": (1.0, -1.0),
    "m": (-1.0, -1.0),
    ".": (-1.0, 1.0),
}
"""Shares of the speeds ahead and to the left; the letters are those of teleop_twist_keyboard, and w a s d."""

SPEED_STEPS = {"q": 1.1, "z": 1 / 1.1}
"""Factors of the keys that make it faster and slower."""

ARROWS = dict(zip("ABCDHPMK", ("up", "down", "right", "left") * 2, strict=True))
"""The letter that ends what a terminal sends for an arrow key (A to D), or what Windows' console sends."""

KEY = re.compile(r"\x1b(?:\[[0-9;]*|O)(?P<escape>[A-Za-z~])|[\x00\xe0](?P<windows>.)|(?P<plain>.)", re.DOTALL)


class NoTerminalError(RobolinkError, OSError):
    """There is no terminal to read keys from."""


class Keyboard(Protocol):
    """Where keys come from."""

    def read(self) -> str:
        """Give what has been typed since the last call; never waits."""

    def close(self) -> None:
        """Leave the terminal as it was found."""


class Speeds(NamedTuple):
    """The speeds that a key asks for, in m/s and rad/s."""

    v: float = 0.3
    w: float = 1.0


class Teleop(Node):
    """Publishes the velocity of the key that is held; a terminal tells of no release, so it counts on repeats.

    Once the robot has been stopped it is silent, and another publisher may drive. With `require_terminal` false it
    lives on where there is no terminal, so that a system can be launched from a script and driven by others.
    """

    def __init__(self, keyboard: Keyboard | None = None, **options: Any) -> None:
        self.keyboard: Keyboard = NoKeyboard()
        super().__init__("teleop", **options)
        required = self.declare_parameter("require_terminal", True).value
        try:
            self.keyboard = keyboard or open_keyboard()
        except NoTerminalError as error:
            if required:
                self.destroy_node()
                raise
            example = "robolink pub /cmd_vel Twist '{linear: {x: 0.3}}' -r 10"
            self.get_logger().warning(f"{error}; drive with: {example}")
        defaults = Speeds()
        v, w = self.declare_parameter("speed", defaults.v).value, self.declare_parameter("turn_speed", defaults.w).value
        self.speeds, self.twist, self.ticks_left = Speeds(v, w), Twist(), 0
        self.timeout_ticks = max(1, round(self.declare_parameter("timeout", 0.5).value * RATE))
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        steady = Clock(clock_type=ClockType.STEADY_TIME, time_base=self.context.time)
        self.create_timer(1.0 / RATE, self.on_timer, clock=steady)
        if not isinstance(self.keyboard, NoKeyboard):
            self.get_logger().info(HELP)

    def on_timer(self) -> None:
        """Take the keys, and publish what the last one asks for until it is too old; then stop once."""
        for key in keys(self.keyboard.read()):
            if key in SPEED_STEPS:
                self.speeds = changed(self.speeds, key)
                self.get_logger().info(f"speed {self.speeds.v:.2f} m/s, {self.speeds.w:.2f} rad/s")
            if (twist := wanted(key, self.speeds)) is not None:
                self.twist, self.ticks_left = twist, self.timeout_ticks
        if self.ticks_left > 0:
            self.ticks_left -= 1
            self.cmd_vel.publish(self.twist if self.ticks_left else Twist())

    def destroy_node(self) -> None:
        """Give the terminal back."""
        self.keyboard.close()
        super().destroy_node()


def wanted(key: str, speeds: Speeds) -> Twist | None:
    """Give the velocity that a key asks for; None for a key without meaning."""
    if key not in DIRECTIONS:
        return None
    ahead, left = DIRECTIONS[key]
    return Twist(linear=Vector3(x=ahead * speeds.v), angular=Vector3(z=left * speeds.w))


def changed(speeds: Speeds, key: str) -> Speeds:
    """Give the speeds after a key of `SPEED_STEPS`."""
    return Speeds(speeds.v * SPEED_STEPS[key], speeds.w * SPEED_STEPS[key])


def keys(text: str) -> list[str]:
    """Split what a terminal sent into keys: small letters, `up`, `down`, `left`, `right`, and nothing for others."""
    found = []
    for match in KEY.finditer(text):
        special = match["escape"] or match["windows"]
        found.append(ARROWS.get(special, "") if special else match["plain"].lower())
    return found


def open_keyboard() -> Keyboard:
    """Give the terminal's keyboard, each key at once and without echo. Raises NoTerminalError."""
    if not sys.stdin or not sys.stdin.isatty():
        raise NoTerminalError("teleop reads keys from a terminal, and its standard input is none")
    keyboard: Keyboard = WindowsKeyboard() if sys.platform == "win32" else PosixKeyboard(sys.stdin.fileno())
    atexit.register(keyboard.close)
    return keyboard


class NoKeyboard:
    """What there is where there is no terminal."""

    def read(self) -> str:
        """Give nothing."""
        return ""

    def close(self) -> None:
        """Nothing was opened."""


class PosixKeyboard:
    """A terminal as Linux and macOS have it."""

    def __init__(self, terminal: int) -> None:
        import termios
        import tty

        if in_background(terminal):
            raise NoTerminalError("teleop reads keys from its terminal, and it runs there in the background")
        self._terminal = terminal
        self._found = termios.tcgetattr(terminal)
        tty.setcbreak(terminal)

    def read(self) -> str:
        """Give what has been typed since the last call."""
        import select

        if not select.select([self._terminal], [], [], 0.0)[0]:
            return ""
        return os.read(self._terminal, 1024).decode(errors="replace")

    def close(self) -> None:
        """Leave the terminal as it was found."""
        import termios

        try:
            termios.tcsetattr(self._terminal, termios.TCSADRAIN, self._found)
        except termios.error:
            return  # the terminal is gone


def in_background(terminal: int) -> bool:
    """Say whether the shell has put this process into the background, where it may not touch the terminal."""
    try:
        return os.tcgetpgrp(terminal) != os.getpgrp()
    except OSError:
        return False  # it is not the terminal that controls this process


class WindowsKeyboard:
    """The console of Windows."""

    def read(self) -> str:
        """Give what has been typed since the last call."""
        text = ""
        if sys.platform == "win32":
            import msvcrt

            while msvcrt.kbhit():
                text += msvcrt.getwch()
        return text

    def close(self) -> None:
        """Nothing was changed."""
