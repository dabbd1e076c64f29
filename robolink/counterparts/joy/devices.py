"""Gamepads of Linux, and the numbers of their axes and buttons in messages."""

from __future__ import annotations

import array
import contextlib
import os
import struct
import sys
from pathlib import Path
from typing import NamedTuple, Protocol

EVENT = struct.Struct("<IhBB")
"""Event of the kernel: time in ms, value, kind, number of the axis or button."""
BUTTON, AXIS, INITIAL = 0x01, 0x02, 0x80
NAME, AXES, BUTTONS, AXIS_CODES, BUTTON_CODES = 0x80806A13, 0x80016A11, 0x80016A12, 0x80406A32, 0x84006A34
"""Requests (ioctl) for the name, the numbers of axes and buttons, and their codes in the kernel's input events."""
FOLDER = Path("/dev/input")


class Event(NamedTuple):
    """A change of an axis, from -32767 (left, ahead) to 32767, or of a button, 0 or 1."""

    is_axis: bool
    number: int
    value: int


class Gamepad(Protocol):
    """A gamepad that is open; `axes` and `buttons` are the kernel's codes, by number."""

    name: str
    axes: list[int]
    buttons: list[int]

    def read(self) -> list[Event]:
        """Return the events since the last call, without waiting. Raises OSError if the gamepad is gone."""

    def close(self) -> None:
        """Close it."""


class LinuxGamepad:
    """A gamepad of Linux. Raises OSError if it cannot be opened."""

    def __init__(self, path: Path) -> None:
        self._file = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
        self._rest = b""
        self.name = name_of(self._file) or str(path)
        self.axes = list(_answer(self._file, AXIS_CODES, "B", 64)[: self._count(AXES)])
        self.buttons = list(_answer(self._file, BUTTON_CODES, "H", 512)[: self._count(BUTTONS)])

    def _count(self, request: int) -> int:
        return int(_answer(self._file, request, "B", 1)[0])

    def read(self) -> list[Event]:
        """Return the events since the last call."""
        with contextlib.suppress(BlockingIOError):
            while part := os.read(self._file, 64 * EVENT.size):
                self._rest += part
        found, self._rest = events(self._rest)
        return found

    def close(self) -> None:
        """Close the device."""
        with contextlib.suppress(OSError):
            os.close(self._file)


def events(raw: bytes) -> tuple[list[Event], bytes]:
    """Return the events in what the kernel sent, and the bytes of one that is not whole; other kinds are left out."""
    whole = len(raw) - len(raw) % EVENT.size
    found = []
    for _, value, kind, number in EVENT.iter_unpack(raw[:whole]):
        if kind & ~INITIAL in (BUTTON, AXIS):
            found.append(Event(kind & ~INITIAL == AXIS, number, value))
    return found, raw[whole:]


def is_supported() -> bool:
    """Return whether gamepads can be read on this system."""
    return sys.platform == "linux"


def found_gamepads(folder: Path = FOLDER) -> dict[int, Path]:
    """Return the gamepads of this machine, by their numbers."""
    paths = {each.name[2:]: each for each in folder.glob("js*")} if folder.is_dir() else {}
    return {int(number): paths[number] for number in sorted(paths, key=len) if number.isdigit()}


def named(path: Path) -> str:
    """Return the name of a gamepad; its path if it cannot be opened."""
    try:
        file = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0))
    except OSError:
        return str(path)
    try:
        return name_of(file) or str(path)
    finally:
        os.close(file)


def name_of(file: int) -> str:
    """Return the name of an open gamepad, '' if it tells none."""
    raw = bytes(_answer(file, NAME, "B", 128))
    return raw.split(b"\0")[0].decode(errors="replace")


def _answer(file: int, request: int, kind: str, count: int) -> array.array[int]:
    """Return the answer of a device to a request; zeros for one that is not a gamepad."""
    answer = array.array(kind, bytes(array.array(kind).itemsize * count))
    if sys.platform == "linux":
        import fcntl

        with contextlib.suppress(OSError):
            fcntl.ioctl(file, request, answer)
    return answer


CENTRE, LARGEST = 0, 32767
ABS_HAT0X, ABS_HAT0Y = 0x10, 0x11
STICKS = {0x00: 0, 0x01: 1, 0x03: 2, 0x04: 3}
"""Axes of sticks in the order of game_controller_node, by the kernel's codes."""
TRIGGERS = {0x02: 4, 0x05: 5, 0x0A: 4, 0x09: 5}
ORDER = {
    0x130: 0,  # A, cross
    0x131: 1,  # B, circle
    0x134: 2,  # X, square: to the left
    0x133: 3,  # Y, triangle: above
    0x13A: 4,  # back
    0x13C: 5,  # guide
    0x13B: 6,  # start
    0x13D: 7,  # left stick
    0x13E: 8,  # right stick
    0x136: 9,  # left shoulder
    0x137: 10,  # right shoulder
    0x220: 11,  # the cross of directions: up, down, left, right
    0x221: 12,
    0x222: 13,
    0x223: 14,
    0xA7: 15,
}
"""Buttons in the order of game_controller_node, by the kernel's codes."""
SWAPPED = {0x133: 2, 0x134: 3}
"""Codes of X and Y of Xbox's gamepads, whose driver names them by their letters."""
UP, DOWN, LEFT, RIGHT = 11, 12, 13, 14


class State:
    """Axes from -1 to 1, left and ahead positive, and buttons 0 or 1, of the events so far.

    Args:
        gamepad: The gamepad.
        deadzone: Share of an axis's way that counts as its centre, from 0 to below 1.
        sticky: True toggles a button when it is pressed.
    """

    def __init__(self, gamepad: Gamepad, deadzone: float, sticky: bool) -> None:
        self.gamepad, self.deadzone, self.sticky = gamepad, deadzone, sticky
        self.axes, self.buttons = [0.0] * len(gamepad.axes), [0] * len(gamepad.buttons)

    def take(self, event: Event) -> bool:
        """Apply an event; return True if anything changed."""
        before = (list(self.axes), list(self.buttons))
        if event.is_axis:
            self.move(event.number, event.value)
        else:
            self.press(event.number, event.value != 0)
        return before != (self.axes, self.buttons)

    def move(self, number: int, value: int) -> None:
        """Move an axis."""
        self.axes += [0.0] * (number + 1 - len(self.axes))
        self.axes[number] = scaled(value, self.deadzone)

    def press(self, number: int, down: bool) -> None:
        """Press or release a button."""
        self.buttons += [0] * (number + 1 - len(self.buttons))
        if self.sticky:
            self.buttons[number] ^= int(down)
        else:
            self.buttons[number] = int(down)


class ControllerState(State):
    """The same in an order that is one for all gamepads: six axes and 21 buttons."""

    def __init__(self, gamepad: Gamepad, deadzone: float, sticky: bool) -> None:
        super().__init__(gamepad, deadzone, sticky)
        self.axes, self.buttons = [0.0] * 6, [0] * 21
        is_xbox = any(each in gamepad.name.lower() for each in ("xbox", "x-box"))
        self._order = {**ORDER, **SWAPPED} if is_xbox else ORDER

    def move(self, number: int, value: int) -> None:
        """Move a stick or a trigger, or press the cross of directions."""
        code = _code(self.gamepad.axes, number)
        if code in STICKS:
            self.axes[STICKS[code]] = scaled(value, self.deadzone)
        elif code in TRIGGERS:  # it rests at one end of its way: from 0 to 1 of SDL
            self.axes[TRIGGERS[code]] = scaled((value + LARGEST) // 2, self.deadzone)
        elif code in (ABS_HAT0X, ABS_HAT0Y):
            first, second = (LEFT, RIGHT) if code == ABS_HAT0X else (UP, DOWN)
            for button, down in ((first, value < 0), (second, value > 0)):
                if not self.sticky or down:
                    super().press(button, down)

    def press(self, number: int, down: bool) -> None:
        """Press or release a button that has a place in the order."""
        place = self._order.get(_code(self.gamepad.buttons, number))
        if place is not None:
            super().press(place, down)


def _code(codes: list[int], number: int) -> int:
    return codes[number] if number < len(codes) else -1


def scaled(value: int, deadzone: float) -> float:
    """Return an axis's position from -1 to 1, left and ahead positive, 0 within the dead zone.

    >>> scaled(-32767, 0.05), scaled(1000, 0.05), scaled(-16384, 0.0)
    (1.0, 0.0, 0.5000152592547379)
    """
    dead = LARGEST * deadzone
    beyond = max(min(abs(value), LARGEST) - dead, 0.0) / (LARGEST - dead)
    return beyond if value < CENTRE else -beyond if beyond else 0.0
