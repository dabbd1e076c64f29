"""Hostile values for the fields of messages: the extremes of each type, huge arrays, times before 1970, odd texts."""

from __future__ import annotations

import math
import random
import struct
from collections.abc import Callable, Sequence
from typing import Any

import msgspec

from robolink.message import FieldType

FLOATS = (math.nan, math.inf, -math.inf, 0.0, -0.0, 5e-324, -5e-324, 1e308, -1e308, 1.7976931348623157e308, 1e-308)
SINGLES = (math.nan, math.inf, -math.inf, 0.0, -0.0, 1.401298464324817e-45, 3.4028234663852886e38, -3.4e38)
TEXTS = (
    "",
    " ",
    "a b",
    "/",
    "//",
    "~",
    "~/x",
    "/a//b",
    "nan",
    "-1",
    "0",
    "{",
    "%s %d",
    "{0}",
    "a\nb\tc",
    "\x1b[2J",
    "\u00e9\U0001f916",
    "\u202e",
    "x" * 300,
    "y/" * 200,
    "[1, 2",
    "none:",
    "../up",
    "1e999",
)
"""Texts that no program expects."""
FRAMES = ("map", "odom", "base_link", "turtle1", "chatter", "rgb8", "mono8", "bgr8", "32FC1", "bayer_rggb8", "16UC1")
"""Texts that programs know."""
HUGE = 200_000
"""Most elements of a huge array of numbers; one of messages has a hundredth."""
SEVERAL = 4
MOST = 250_000
"""Most elements of all arrays of a message, about; else arrays within arrays would take minutes."""


class Hostile:
    """Maker of messages with hostile values: as `share` says some of the fields, the others plain.

    Args:
        dice: Source of all chance.
        texts: Further texts to choose from, such as names that the program knows.
    """

    def __init__(self, dice: random.Random, texts: Sequence[str] = ()) -> None:
        self.dice, self.left, self.texts = dice, MOST, [*TEXTS, *FRAMES, *FRAMES, *texts, *texts]

    def message(self, cls: Any, share: float | None = None) -> Any:
        """Return a message of a class whose fields are hostile with the chance `share`, itself drawn if None."""
        self.left = MOST
        return self._message(cls, self.dice.choice((0.0, 0.03, 0.2, 1.0)) if share is None else share)

    def _message(self, cls: Any, share: float) -> Any:
        made = cls(**{name: self._value(kind, share) for name, kind in cls.__ros_fields__.items()})
        settle = _SETTLED.get(cls.__ros_type__)
        if settle is not None and self.dice.random() < 0.7:
            settle(made, self.dice)
        return made

    def payload(self, encoded: bytes) -> bytes:
        """Return serialized bytes damaged at one place: cut, longer, or with another byte or length."""
        damaged = bytearray(encoded)
        at = self.dice.randrange(len(damaged) + 1)
        match self.dice.randrange(4):
            case 0:
                del damaged[at:]
            case 1:
                damaged += self.dice.randbytes(self.dice.randrange(1, 200))
            case 2 if at < len(damaged):
                damaged[at] = self.dice.randrange(256)
            case _:
                damaged[at : at + 4] = struct.pack("<I", self.dice.choice((0, 1, 2**31, 2**32 - 1, 2**24)))
        return bytes(damaged)

    def _value(self, kind: FieldType, share: float) -> Any:
        hostile = self.dice.random() < share
        if kind.shape == "one":
            return self._one(kind, share, hostile)
        one = msgspec.structs.replace(kind, shape="one", size=0)
        count = kind.size if kind.shape == "array" else self._count(kind, hostile)
        if count > SEVERAL and kind.shape != "array":  # many times a few values: making each would take seconds
            left, self.left = self.left, self.left * SEVERAL // count
            few = [self._one(one, share, self.dice.random() < share) for _ in range(SEVERAL)]
            self.left = left
            found: Any = (few * (count // SEVERAL + 1))[:count]
        else:
            found = [self._one(one, share, self.dice.random() < share) for _ in range(count)]
        return found

    def _count(self, kind: FieldType, hostile: bool) -> int:
        most = kind.size or (HUGE if kind.message is None and kind.base != "string" else HUGE // 100)
        counts = (
            (0, 0, 1, 2, SEVERAL, 100, 1000, most if self.dice.random() < 0.1 else 1) if hostile else range(SEVERAL)
        )
        count = min(most, self.dice.choice(counts), max(1, self.left))
        self.left -= count * (20 if kind.message else 1)
        return count

    def _one(self, kind: FieldType, share: float, hostile: bool) -> Any:
        if kind.message is not None:
            if kind.base in TIMES:
                return self._time(kind.message, hostile)
            return self._message(kind.message, share)
        if kind.base in ("string", "wstring"):
            return self._text(kind, hostile)
        if kind.base == "bool":
            return self.dice.random() < 0.5
        if kind.base == "byte":
            return bytes([self.dice.choice((0, 1, 255))])
        return self._number(str(kind.code), hostile)

    def _text(self, kind: FieldType, hostile: bool) -> str:
        text = self.dice.choice(self.texts) if hostile or self.dice.random() < 0.3 else self.dice.choice(FRAMES)
        return text.encode()[: kind.string_bound].decode(errors="ignore") if kind.string_bound else text

    def _number(self, code: str, hostile: bool) -> Any:
        if code in ("f", "d"):
            if hostile:
                return self.dice.choice(FLOATS if code == "d" else SINGLES)
            return struct.unpack(code, struct.pack(code, self.dice.choice((0.0, 1.0, self.dice.uniform(-3, 3)))))[0]
        bits = 8 * struct.calcsize(f"={code}")
        low, high = (0, 2**bits) if code.isupper() else (-(2 ** (bits - 1)), 2 ** (bits - 1))
        if hostile:
            return self.dice.choice((low, high - 1, low + 1, 0, self.dice.randrange(low, high)))
        return self.dice.randrange(SEVERAL)

    def _time(self, cls: Any, hostile: bool) -> Any:
        if not hostile:
            return cls(sec=self.dice.randrange(SEVERAL), nanosec=self.dice.randrange(10**9))
        seconds = (-1, -(2**31), 2**31 - 1, 0, -1_000_000)
        return cls(sec=self.dice.choice(seconds), nanosec=self.dice.choice((0, 10**9 - 1, 10**9, 2**32 - 1)))


TIMES = ("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration")


def _settle_image(image: Any, dice: random.Random) -> None:
    """Set sizes of an image that belong together, or nearly."""
    encodings = {
        "rgb8": 3,
        "bgr8": 3,
        "mono8": 1,
        "bgra8": 4,
        "32FC1": 4,
        "16UC1": 2,
        "bayer_rggb8": 1,
        "yuv422_yuy2": 2,
    }
    image.encoding = dice.choice(list(encodings))
    image.width, image.height = dice.choice((0, 1, 7, 64, 64)), dice.choice((0, 1, 5, 48, 48))
    image.step = image.width * encodings[image.encoding] + dice.choice((0, 0, 0, 1, 8))
    image.data = dice.randbytes(max(0, image.step * image.height + dice.choice((0, 0, 0, 0, -1, 1))))


def _settle_grid(grid: Any, dice: random.Random) -> None:
    """Set as many cells of a map as it has place for, or nearly."""
    grid.info.width, grid.info.height = dice.choice((0, 1, 20, 50)), dice.choice((0, 1, 20, 50))
    count = max(0, grid.info.width * grid.info.height + dice.choice((0, 0, 0, 0, -1, 1)))
    grid.data = [dice.choice((-1, 0, 100, 50))] * count


def _settle_scan(scan: Any, dice: random.Random) -> None:
    """Set beams of a scan of a usual kind, some of them odd."""
    count = dice.choice((0, 1, 2, 90, 360))
    scan.angle_min, scan.angle_max = -math.pi, math.pi
    scan.angle_increment = math.tau / max(1, count)
    scan.ranges = [dice.choice((*SINGLES, 0.1, 1.0, 2.0)) for _ in range(count)]


def _settle_joints(state: Any, dice: random.Random) -> None:
    """Return joints that a robot has."""
    state.name = ["shoulder", "extend", "left", "left"][: dice.randrange(5)]
    state.position = [dice.choice((*FLOATS, 0.1, 1.0)) for _ in state.name]


def _settle_id(uuid: Any, dice: random.Random) -> None:
    """Return one of a few ids, so that requests meet goals that there are."""
    uuid.uuid = bytes([dice.randrange(6)]) * 16


_SETTLED: dict[str, Callable[[Any, random.Random], None]] = {
    "sensor_msgs/msg/Image": _settle_image,
    "unique_identifier_msgs/msg/UUID": _settle_id,
    "nav_msgs/msg/OccupancyGrid": _settle_grid,
    "sensor_msgs/msg/LaserScan": _settle_scan,
    "sensor_msgs/msg/JointState": _settle_joints,
}
"""Functions that bring fields into a consistent form, so that a program goes on to use them."""
