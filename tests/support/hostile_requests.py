"""Hostile requests to a node in memory. `python -m tests.support.hostile_requests` shows their cost.

It is run as a process of its own, since the most memory that a process ever had is known of a whole process only.
"""

from __future__ import annotations

import json
import struct
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from robolink import Context, Node
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.rcl_interfaces import msg, srv
from robolink.interfaces.type_description_interfaces.srv import GetTypeDescription
from robolink.message import encode, type_hash
from robolink.node_parts.request_limit import LARGEST, MOST_NAMES
from robolink.wire import DataKey, format_key, pack_attachment

HUGE = 34_000_000
HEADER = b"\0\1\0\0"
STRING_ARRAY = 9


class Hostile(NamedTuple):
    """A request, for a node that takes any parameter or for one that does not."""

    name: str
    service: str
    payload: bytes
    strict: bool = True


def texts(count: int, text: bytes = b"x") -> bytes:
    """A request whose only field are these names, as they are on the wire."""
    one = struct.pack("<I", len(text) + 1) + text + b"\0"
    return HEADER + struct.pack("<I", count) + (one + b"\0" * (-len(one) % 4)) * count


def set_one(size: int) -> bytes:
    """A parameter that is an array of empty texts: of all that fits into so many bytes, what is most once decoded."""
    whole = encode(srv.SetParameters.Request(parameters=[msg.Parameter(name="x", value=_of(["y"] * 3))]))
    mark = struct.pack("<I", 3) + b"\2\0\0\0y\0\0\0"
    at = whole.index(mark)
    return whole[:at] + struct.pack("<I", size // 4) + b"\0\0\0\0" * (size // 4)


def _of(values: list[str]) -> msg.ParameterValue:
    return msg.ParameterValue(type=STRING_ARRAY, string_array_value=values)


def numbered(count: int) -> bytes:
    """A request that sets this many new parameters."""
    value = msg.ParameterValue(type=2, integer_value=1)
    many = [msg.Parameter(name=f"deep.below.a.prefix.{number}", value=value) for number in range(count)]
    return encode(srv.SetParameters.Request(parameters=many))


def requests() -> Iterator[Hostile]:
    """What is sent, one after the other."""
    for service in ("get_parameters", "describe_parameters", "get_parameter_types", "list_parameters"):
        for strict in (True, False):
            yield Hostile("33 MB of names", service, texts(HUGE // 8), strict)
            yield Hostile("3 MB of names", service, texts(LARGEST // 8 - 2), strict)
            yield Hostile("as many names as there may be", service, texts(MOST_NAMES, b"a.b." * 75), strict)
            yield Hostile("one long name", service, texts(1, b"a." * (LARGEST // 2 - 9)), strict)
            yield Hostile("4 billion names that do not come", service, HEADER + b"\xff" * 12, strict)
    for service in ("set_parameters", "set_parameters_atomically"):
        yield Hostile("33 MB of a value", service, set_one(HUGE))
        for strict in (True, False):
            yield Hostile("3 MB of a value", service, set_one(LARGEST - 200), strict)
            yield Hostile("as many new ones as there may be", service, numbered(MOST_NAMES), strict)
    for service in ("get_logger_levels", "set_logger_levels"):
        yield Hostile("33 MB of names", service, texts(HUGE // 8))
    yield Hostile("as many names as there may be", "get_logger_levels", texts(MOST_NAMES, b"x" * 290))
    levels = [msg.LoggerLevel(name=f"{number}.{'x.' * 100}", level=10) for number in range(MOST_NAMES)]
    yield Hostile("as many as there may be", "set_logger_levels", encode(srv.SetLoggerLevels.Request(levels=levels)))
    yield Hostile("33 MB of a type's name", "get_type_description", HEADER + texts(1, b"x" * HUGE)[8:] + b"\0" * 12)


def services() -> dict[str, type[Any]]:
    """The services of a node, by the last part of their names."""
    of_parameters = [srv.GetParameters, srv.DescribeParameters, srv.GetParameterTypes, srv.ListParameters]
    more = [srv.SetParameters, srv.SetParametersAtomically, srv.GetLoggerLevels, srv.SetLoggerLevels]
    return {_snake(each.__name__): each for each in (*of_parameters, *more, GetTypeDescription)}


def _snake(name: str) -> str:
    return "".join(f"_{each.lower()}" if each.isupper() else each for each in name).lstrip("_")


def peak() -> float:
    """The most memory that this process ever had, in MB."""
    if sys.platform == "win32":
        import psutil

        return float(psutil.Process().memory_info().peak_wset) / 1e6
    if Path("/proc/self/status").exists():  # Linux, where getrusage may tell the peak of who started this process
        status = Path("/proc/self/status").read_text(encoding="ascii", errors="replace")
        return float(status.partition("VmHWM:")[2].split()[0]) / 1e3
    import resource

    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6


def answered(context: Context, executor: SingleThreadedExecutor, each: Hostile) -> tuple[float, float]:
    """Send a request and wait for its end, answered or not; the seconds that it took, and those of the processor."""
    srv_type = services()[each.service]
    name = f"/{'strict' if each.strict else 'lax'}/{each.service}"
    key = format_key(DataKey(context.get_domain_id(), name, srv_type.__ros_type__, type_hash(srv_type)))
    came: list[object] = []
    begin, worked = time.perf_counter(), time.process_time()
    call = context.transport.call(key, each.payload, pack_attachment(1, 0, b"x" * 16), came.append)
    while None not in came:
        executor.spin_once(timeout_sec=10)
    call.close()
    return time.perf_counter() - begin, time.process_time() - worked


def main() -> None:
    """Print a line of JSON for each request: seconds by clock and by processor, and the peak so far in MB."""
    with Context(transport="memory") as context, SingleThreadedExecutor(context=context) as executor:
        executor.add_node(Node("strict", context=context, enable_logger_service=True))
        executor.add_node(Node("lax", context=context, allow_undeclared_parameters=True))
        for each in requests():
            seconds, cpu = answered(context, executor, each)
            told = {"name": each.name, "service": each.service, "strict": each.strict, "bytes": len(each.payload)}
            figures = {"seconds": round(seconds, 3), "cpu": round(cpu, 3), "peak": round(peak(), 1)}
            line = json.dumps({**told, **figures})
            print(line, flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
