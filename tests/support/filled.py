"""Random messages with a value in every field, by a seed."""

from __future__ import annotations

import random
import struct
from typing import Any

import msgspec

from robolink.message import FieldType

TEXT = "words \u00fc\u20ac\U0001f916"
SEVERAL = 3


def filled(cls: Any, dice: random.Random) -> Any:
    """A message with something in every field, also what is at the limits of its type."""
    return cls(**{name: something(kind, dice) for name, kind in cls.__ros_fields__.items()})


def something(kind: FieldType, dice: random.Random) -> Any:
    """What fits a field."""
    if kind.shape != "one":
        count = kind.size if kind.shape == "array" else dice.randint(0, min(SEVERAL, kind.size or SEVERAL))
        one = msgspec.structs.replace(kind, shape="one", size=0)
        return [something(one, dice) for _ in range(count)]
    if kind.message is not None:
        return filled(kind.message, dice)
    if kind.base in ("string", "wstring"):
        most = kind.string_bound // 4 if kind.string_bound else 6  # a character takes four bytes at most
        return "".join(dice.choices(TEXT, k=dice.randint(0, min(most, 6))))
    if kind.base == "bool":
        return dice.random() < 0.5
    if kind.base == "byte":
        return dice.randbytes(1)
    return number(kind, dice)


def number(kind: FieldType, dice: random.Random) -> Any:
    """A number of any size, or a limit."""
    if kind.code in ("f", "d"):
        value = dice.choice([0.0, -0.0, float("inf"), dice.uniform(-1e30, 1e30), dice.random(), 5e-324])
        return struct.unpack(kind.code, struct.pack(kind.code, value))[0]
    bits = 8 * struct.calcsize(f"={kind.code}")
    low, high = (0, 2**bits) if str(kind.code).isupper() else (-(2 ** (bits - 1)), 2 ** (bits - 1))
    return dice.choice([low, high - 1, dice.randrange(low, high), dice.randrange(100)])
