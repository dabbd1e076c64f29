"""Messages of every type of the ros-* wheels, by turns through a real ROS 2 and robolink.

    python -m tests.support.real_messages [--real PYTHON] [--count 20] [--record]

PYTHON is that of a virtual environment with the wheels; by default the judge's own is used, and where there is none,
nothing is compared. It serializes `count` messages of each type; robolink must read
what was put in, field by field, and write what the real one then reads as the same. Ends with 1 if any differs.
`--record` also keeps the bytes of the first messages in tests/data/real_messages.xz, which `make test` reads.

The values come from the type and a number alone, so that both sides make them for themselves. This file runs on both:
the functions above `main` use nothing of robolink.
"""

from __future__ import annotations

import argparse
import importlib
import json
import lzma
import math
import pkgutil
import random
import re
import struct
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

RECORDED = Path(__file__).parents[1] / "data" / "real_messages.xz"
KEPT = 4
"""Number of messages of each type in the recording: the default, the lowest values, the highest, and random ones."""
PACKAGES = (
    "action_msgs",
    "builtin_interfaces",
    "diagnostic_msgs",
    "geometry_msgs",
    "lifecycle_msgs",
    "nav_msgs",
    "rcl_interfaces",
    "rosgraph_msgs",
    "sensor_msgs",
    "service_msgs",
    "std_msgs",
    "std_srvs",
    "test_msgs",
    "trajectory_msgs",
    "type_description_interfaces",
    "unique_identifier_msgs",
    "visualization_msgs",
)
PARTS = {"msg": [""], "srv": ["_Request", "_Response", "_Event"], "action": ["_Goal", "_Result", "_Feedback"]}
TEXTS = ["", "a", "base_link", "süß €", "\U0001f916 robot", "two\nlines"]
INTEGERS = {f"{sign}int{bits}": (bits, not sign) for bits in (8, 16, 32, 64) for sign in ("", "u")}
INTEGERS["octet"] = (8, False)
FLOATS = {
    "float": ("f", [-3.4028234663852886e38, 3.4028234663852886e38, 1.401298464324817e-45]),
    "double": ("d", [-1.7976931348623157e308, 1.7976931348623157e308, 5e-324]),
}
SEVERAL = 3

Find = Callable[[str], Any]
"""Function that returns the class of a type as rosidl names a field's: ``geometry_msgs/Point``."""


def made(cls: Any, at: int, find: Find) -> Any:
    """Return the message number `at` of a class: 0 is the default, 1 the lowest values, 2 the highest, then random."""
    return _filled(cls, at, random.Random(f"{cls.__name__} {at}"), find)


def _filled(cls: Any, at: int, dice: random.Random, find: Find) -> Any:
    message = cls()
    for name, kind in cls.get_fields_and_field_types().items() if at else ():
        setattr(message, name, _value(kind, at, dice, find))
    return message


def _value(kind: str, at: int, dice: random.Random, find: Find) -> Any:
    sequence = re.fullmatch(r"sequence<(.*?)(?:, (\d+))?>", kind)
    array = re.fullmatch(r"(.*)\[(\d+)\]", kind)
    if array:
        return [_value(array[1], at, dice, find) for _ in range(int(array[2]))]
    if sequence:
        most = min(int(sequence[2] or SEVERAL), SEVERAL)
        count = {1: 0, 2: int(sequence[2] or most)}.get(at, dice.getrandbits(8) % (most + 1))
        return [_value(sequence[1], at, dice, find) for _ in range(count)]
    text = re.fullmatch(r"w?string(?:<(\d+)>)?", kind)
    if text:
        return _text(int(text[1] or 0), at, dice)
    if kind == "boolean":
        return at == 2 if at < 3 else bool(dice.getrandbits(1))
    if kind in FLOATS:
        return _float(*FLOATS[kind], at, dice)
    if kind in INTEGERS:
        number = _integer(*INTEGERS[kind], at, dice)
        return bytes((number,)) if kind == "octet" else number
    return _filled(find(kind), at, dice, find)


def _text(bound: int, at: int, dice: random.Random) -> str:
    if at < 3:
        return "" if at == 1 else "\U0001f916" * (bound or 3)
    text = TEXTS[dice.getrandbits(8) % len(TEXTS)]
    return text[:bound] if bound else text


def _integer(bits: int, signed: bool, at: int, dice: random.Random) -> int:
    low: int = -(2 ** (bits - 1)) if signed else 0
    high: int = 2 ** (bits - 1) - 1 if signed else 2**bits - 1
    pool = [low, high, 0, 1, low + dice.getrandbits(bits)]
    return pool[at - 1 if at < 3 else dice.getrandbits(8) % len(pool)]


def _float(code: str, extremes: list[float], at: int, dice: random.Random) -> float:
    pool = [*extremes, 0.0, -0.0, math.inf, -math.inf, math.nan, dice.getrandbits(24) / 256 - 1000]
    return float(struct.unpack(code, struct.pack(code, pool[at - 1 if at < 3 else dice.getrandbits(8) % len(pool)]))[0])


def plain(value: Any) -> Any:
    """Return a message as what JSON and `==` compare: each number with all its bits, each NaN equal to the others."""
    if hasattr(value, "get_fields_and_field_types"):
        return {name: plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    if isinstance(value, bytes):
        return value.hex()
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    return value.hex() if isinstance(value, float) else value


# ---- in the real ROS 2 ---------------------------------------------------------------------------------------------


def real_types() -> Iterator[str]:
    """Yield the full names of all types of the wheels: messages, and the parts of services and actions."""
    for package in PACKAGES:
        for kind, parts in PARTS.items():
            try:
                module = importlib.import_module(f"{package}.{kind}")
            except ModuleNotFoundError:
                continue
            files = [name for _, name, _ in pkgutil.iter_modules(module.__path__) if not name.endswith("_s")]
            shorts = sorted(name for name in dir(module) if _snake(name) in files)
            yield from (f"{package}/{kind}/{short}{part}" for short in shorts for part in parts)


def _snake(name: str) -> str:
    return "_" + re.sub("([a-z0-9])([A-Z])", r"\1_\2", re.sub("(.)([A-Z][a-z]+)", r"\1_\2", name)).lower()


def real_class(name: str) -> Any:
    """Return the real class of ``std_srvs/srv/SetBool_Request``, or of ``std_srvs/SetBool_Request`` as of a field."""
    package, *_, short = name.split("/")
    whole, _, part = short.partition("_")
    for kind in PARTS:
        try:
            found = getattr(importlib.import_module(f"{package}.{kind}"), whole)
        except (ModuleNotFoundError, AttributeError):
            continue
        if not part or hasattr(found, part):
            return getattr(found, part) if part else found
    raise LookupError(name)


def write_real(count: int) -> None:
    """Print the bytes of `count` messages of each type, one type a line."""
    serialize_message = importlib.import_module("rclpy.serialization").serialize_message
    for name in real_types():
        cls = real_class(name)
        data = [bytes(serialize_message(made(cls, at, real_class))).hex() for at in range(count)]
        sys.stdout.write(json.dumps([name, data]) + "\n")


def read_real() -> None:
    """Read such lines, and print for each message that is not what it should be its type and number."""
    deserialize_message = importlib.import_module("rclpy.serialization").deserialize_message
    for line in sys.stdin:
        name, data = json.loads(line)
        cls = real_class(name)
        for at, text in enumerate(data):
            if plain(deserialize_message(bytes.fromhex(text), cls)) != plain(made(cls, at, real_class)):
                sys.stdout.write(f"{name} {at}\n")


# ---- in robolink ---------------------------------------------------------------------------------------------------


def our_class(name: str) -> Any:
    """Return robolink's class of such a name."""
    from robolink.exceptions import NotFoundError
    from robolink.interfaces import find
    from tests.support import ros_test_types

    package, *_, short = name.split("/")
    whole, _, part = short.partition("_")
    for kind in PARTS:
        try:
            if package == "test_msgs":
                found = getattr(getattr(ros_test_types, kind), whole)
            else:
                found = find(f"{package}/{kind}/{whole}", kind)
        except (NotFoundError, AttributeError):
            continue
        if not part or hasattr(found, part):
            return getattr(found, part) if part else found
    raise LookupError(name)


def recorded() -> dict[str, list[bytes]]:
    """Return the recorded bytes by type."""
    lines = lzma.decompress(RECORDED.read_bytes()).decode().splitlines()
    return {name: [bytes.fromhex(each) for each in data] for name, data in map(json.loads, lines)}


def misread(name: str, data: list[bytes]) -> list[int]:
    """Return the numbers of the messages that robolink does not read as what was put in."""
    from robolink.message import decode

    cls = our_class(name)
    return [at for at, each in enumerate(data) if plain(decode(cls, each)) != plain(made(cls, at, our_class))]


def ours(name: str, count: int) -> list[str]:
    """Return the bytes that robolink makes of the same messages, as hex digits."""
    from robolink.message import encode

    cls = our_class(name)
    return [encode(made(cls, at, our_class)).hex() for at in range(count)]


def main() -> int:
    """Run one side, or both."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--real", help="Python with the wheels")
    parser.add_argument("--count", type=int, default=20, help="messages of each type")
    parser.add_argument("--record", action="store_true", help="keep the first ones")
    parser.add_argument("side", nargs="?", choices=("write", "read"), help="for the real one's process")
    options = parser.parse_args()
    if options.side:
        write_real(options.count) if options.side == "write" else read_real()
        return 0
    from tests.judge.wheels import NoWheelsError, interpreter

    try:
        real = [options.real] if options.real else interpreter()
    except NoWheelsError as reason:
        sys.stdout.write(f"skipped: the real rclpy cannot be run here: {reason}\n")
        return 0
    words = [*real, __file__, "--count", str(options.count)]
    text = subprocess.run([*words, "write"], check=True, capture_output=True, text=True, timeout=600).stdout
    lines = [json.loads(line) for line in text.splitlines()]
    if options.record:
        kept = "".join(json.dumps([name, data[:KEPT]]) + "\n" for name, data in lines)
        RECORDED.write_bytes(lzma.compress(kept.encode(), preset=9 | lzma.PRESET_EXTREME))
    wrong = [f"{name} {at}" for name, data in lines for at in misread(name, [bytes.fromhex(each) for each in data])]
    written = "".join(json.dumps([name, ours(name, len(data))]) + "\n" for name, data in lines)
    read = subprocess.run([*words, "read"], check=True, capture_output=True, text=True, input=written, timeout=600)
    answer = read.stdout
    sys.stdout.write(f"{len(lines)} types, {sum(len(data) for _, data in lines)} messages\n")
    sys.stdout.write(f"misread here: {wrong or 'none'}; by the real one: {answer.splitlines() or 'none'}\n")
    return bool(wrong or answer)


if __name__ == "__main__":
    sys.exit(main())
