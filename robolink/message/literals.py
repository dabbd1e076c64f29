r"""Parser and writer of constants and defaults in .msg files: ``0x1F``, ``true``, ``"two\nlines"``, ``[1, 2]``.

rosidl's reading is followed, with one leniency: a ``#`` or ``=`` within quotes belongs to the string.
"""

from __future__ import annotations

import math
import re
import struct
from typing import Any

import msgspec

from robolink.message.annotations import NUMERIC, FieldType
from robolink.system.patterns import late
from robolink.system.terminal import quoted, shown, with_article

INTEGER = late(r"[+-]?(?:[0-9](?:_?[0-9])*|0[xX](?:_?[0-9a-fA-F])+|0[oO](?:_?[0-7])+|0[bB](?:_?[01])+)")
DIGITS = "[0-9](?:_?[0-9])*"
FLOAT = late(rf"[+-]?(?:(?:{DIGITS}\.?(?:{DIGITS})?|\.{DIGITS})(?:e[+-]?{DIGITS})?|inf|infinity|nan)", re.IGNORECASE)
QUOTED = r"\"(?:[^\"\\]|\\.)*\"|'(?:[^'\\]|\\.)*'"
ELEMENT = late(rf"\s*((?:{QUOTED})\s*|[^,\"'\s][^,]*)(?:,|\Z)", re.DOTALL)
ESCAPE = late(r"""\\(?:([ntvbrfa\\?'"])|([0-7]{1,3})|x([0-9a-fA-F]{1,2})|u([0-9a-fA-F]{4})|U([0-9a-fA-F]{8}))""")
ESCAPED = {"n": "\n", "t": "\t", "v": "\v", "b": "\b", "r": "\r", "f": "\f", "a": "\a"}
LONGEST_NUMBER = 400
BOOLS = {"true": True, "1": True, "false": False, "0": False}


def read(kind: FieldType, text: str) -> Any:
    """Parse a value of a primitive type or an array of one. Raises ValueError with what was found.

    Numbers come as int and float (byte and char as 0 to 255), arrays as lists.
    """
    if kind.message is not None or "/" in kind.base:
        raise ValueError(f"{kind} can have no default: only primitive types and arrays of them can")
    if kind.shape == "one":
        return _one(kind, text)
    if not (text.startswith("[") and text.endswith("]") and len(text) > 1):
        raise ValueError(f"'{shown(text)}' is not an array: write [1, 2]")
    return elements(kind, text[1:-1])


def elements(kind: FieldType, text: str) -> list[Any]:
    """Parse the elements between an array's brackets. Raises ValueError with what was found."""
    one = msgspec.structs.replace(kind, shape="one", size=0)
    values: list[Any] = []
    text, at = text.strip(), 0
    while at < len(text):
        found = ELEMENT.match(text, at)
        if found is None:
            raise ValueError(f"element {len(values)}: '{shown(text[at:].strip())}' is not {with_article(str(one))}")
        try:
            values.append(_one(one, found[1].rstrip()))
        except ValueError as error:
            raise ValueError(f"element {len(values)}: {error}") from None
        at = found.end()
    if kind.shape == "array" and len(values) != kind.size:
        raise ValueError(f"{len(values)} elements, not the {kind.size} of {kind}")
    if kind.shape == "bounded" and len(values) > kind.size:
        raise ValueError(f"{len(values)} elements, more than {kind} takes")
    return values


def _one(kind: FieldType, text: str) -> Any:
    if kind.base in ("string", "wstring"):
        return checked(kind, _string(text))
    if kind.base == "bool":
        if text.lower() not in BOOLS:
            raise ValueError(f"'{shown(text)}' is not a bool: write true or false")
        return BOOLS[text.lower()]
    if NUMERIC.get(kind.base) in ("f", "d"):
        if not FLOAT.fullmatch(text):
            raise ValueError(f"'{shown(text)}' is not {with_article(kind.base)}: write a number such as 0.5 or 1e-3")
        if math.isinf(float(text)) and any(each.isdigit() for each in text):
            raise ValueError(f"{shown(text)} is too large for {kind.base}")
        return checked(kind, float(text))
    return checked(kind, _integer(kind.base, text))


def _integer(base: str, text: str) -> int:
    is_plain = text.isascii() and text.isdecimal()  # most are: no pattern is compiled for them
    if len(text) > LONGEST_NUMBER or not (is_plain or INTEGER.fullmatch(text)):
        raise ValueError(f"'{shown(text)}' is not {with_article(base)}: write a whole number such as 10, -3 or 0x1F")
    try:
        return int(text)  # leading zeros do not make it octal
    except ValueError:
        return int(text, 0)


def checked(kind: FieldType, value: Any) -> Any:
    """Return a single value if it fits its type. Raises ValueError."""
    if kind.base in ("string", "wstring"):
        if kind.string_bound and len(value) > kind.string_bound:
            raise ValueError(f"'{shown(value)}' has {len(value)} characters; {kind} takes {kind.string_bound}")
        return value
    code = NUMERIC.get(kind.base, "B")
    try:
        struct.pack("<" + code, value)
    except (struct.error, OverflowError):
        size = struct.calcsize("<" + code) * 8
        low, high = (-(2 ** (size - 1)), 2 ** (size - 1) - 1) if code.islower() else (0, 2**size - 1)
        limits = f"it takes {low} to {high}" if code not in "fd" else "its largest number is 3.4028235e38"
        raise ValueError(f"{shown(str(value))} does not fit {kind.base}: {limits}") from None
    return value


def _string(text: str) -> str:
    for quote in "\"'":
        if len(text) > 1 and text.startswith(quote) and text.endswith(quote):
            if not re.fullmatch(QUOTED, text, re.DOTALL):
                raise ValueError(f"{shown(text)} has a {quote} within: write \\{quote}")
            text = text[1:-1]
            break
    text = ESCAPE.sub(_escaped, text)
    try:
        text.encode()
    except UnicodeEncodeError:
        raise ValueError(f"'{shown(text)}' is not valid Unicode") from None
    return text


def _escaped(found: re.Match[str]) -> str:
    letter, octal, *hexadecimal = found.groups()
    if letter:
        return ESCAPED.get(letter, letter)
    code = int(octal, 8) if octal else int(next(filter(None, hexadecimal)), 16)
    return chr(code) if code <= 0x10FFFF else found[0]


def write(kind: FieldType, value: Any) -> str:
    """Format a value, as messages hold it, so that `read` returns it."""
    if kind.shape != "one":
        one = msgspec.structs.replace(kind, shape="one", size=0)
        return f"[{', '.join(write(one, each) for each in value)}]"
    if kind.base in ("string", "wstring"):
        return quoted(str(value), also="#=")  # which rosidl takes for itself even in quotes
    if kind.base == "bool":
        return "true" if value else "false"
    if NUMERIC.get(kind.base) in ("f", "d"):
        return repr(float(value))
    return str(value[0] if isinstance(value, bytes) else int(value))


def as_rosidl_says(kind: FieldType, value: Any) -> str:
    """Format a default as rosidl does in FieldDescription.default_value: Python's str, of arrays as tuples."""
    if kind.shape != "one":
        one = msgspec.structs.replace(kind, shape="one", size=0)
        return repr(tuple(_plain(one, each) for each in value))
    return str(_plain(kind, value))


def as_rosidl_said(kind: FieldType, text: str) -> Any:
    """Parse what `as_rosidl_says` formatted. Raises ValueError."""
    if kind.shape != "one":
        if not (text.startswith("(") and text.endswith(")")):
            raise ValueError(f"'{shown(text)}' is not a default of {kind}")
        return elements(kind, text[1:-1])
    return checked(kind, text) if kind.base in ("string", "wstring") else _one(kind, text)


def _plain(kind: FieldType, value: Any) -> Any:
    if kind.base in ("string", "wstring"):
        return str(value)
    if kind.base == "bool":
        return bool(value)
    if NUMERIC.get(kind.base) in ("f", "d"):
        return float(value)
    return value[0] if isinstance(value, bytes) else int(value)
