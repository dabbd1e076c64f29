"""Alignment of primitives in CDR: runs of fixed-size fields, and their `struct` formats in each of the eight phases."""

from __future__ import annotations

import struct
from collections.abc import Sequence

from robolink.message.annotations import NUMERIC

CODES = {**NUMERIC, "bool": "?", "byte": "c"}
"""Type codes of all primitives of fixed size."""
SIZES = {code: struct.calcsize("<" + code) for code in "bBhHiIqQfd?c"}
"""Sizes in bytes by type code."""


def padded(codes: Sequence[str], phase: int, order: str) -> struct.Struct:
    """Return the Struct of these primitives, one after the other, when the first free byte is at `phase` (mod 8)."""
    text, at = order, phase
    for code in codes:
        size = SIZES[code]
        pad = -at % size
        text += "x" * pad + code
        at += pad + size
    return struct.Struct(text)


def phases(codes: Sequence[str], order: str, shift: int = 0) -> tuple[struct.Struct, ...]:
    """Return the Structs for all eight phases. Index with ``(offset + shift) & 7`` for the phase of the body."""
    return tuple(padded(codes, (at - shift) % 8, order) for at in range(8))


class Lines:
    """Source text under construction."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.depth = 2  # inside def and try
        self.serial = 0
        self.constants: dict[str, object] = {}
        self.names: dict[int, str] = {}
        """Names of the constants, by identity; `constants` keeps them alive, so that no two have the same."""

    def add(self, line: str) -> None:
        """Append a line at the current depth."""
        self.lines.append("    " * self.depth + line)

    def fresh(self, prefix: str) -> str:
        """Return a name that was not used before."""
        self.serial += 1
        return f"{prefix}{self.serial}"

    def constant(self, prefix: str, value: object) -> str:
        """Bind a value to a fresh global name of the generated function."""
        name = self.names.get(id(value))
        if name is None:
            name = self.names[id(value)] = self.fresh(prefix)
            self.constants[name] = value
        return name
