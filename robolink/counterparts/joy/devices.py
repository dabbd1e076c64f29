"""Gamepads by Linux's joystick interface, /dev/input/js*: events, names, and the codes of axes and buttons."""

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
    """Return what a device answers to a request; zeros for one that is not a gamepad."""
    answer = array.array(kind, bytes(array.array(kind).itemsize * count))
    if sys.platform == "linux":
        import fcntl

        with contextlib.suppress(OSError):
            fcntl.ioctl(file, request, answer)
    return answer
