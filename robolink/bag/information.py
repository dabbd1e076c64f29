"""Description of a bag as text, in the words and lines of `ros2 bag info`, and as data for JSON."""

from __future__ import annotations

import struct
import time
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple, TypeVar

from robolink.bag.metadata import BagMetadata
from robolink.bag.reader import Bag
from robolink.bag.selection import SERVICE_EVENT
from robolink.bag.topic import BagError, BagTopic
from robolink.exceptions import nearest

SORTS = ("name", "type", "count")
"""Orders of topics and services."""

_INDENT = " " * 19
_UNITS = ("B", "KiB", "MiB", "GiB", "TiB")
_EVENT = {True: struct.Struct("<B11x16s4xq"), False: struct.Struct(">B11x16s4xq")}
"""Layout of a service_msgs/ServiceEventInfo: kind of event, (stamp), the client's gid, number of the call."""
_RESPONSES = (2, 3)

Row = TypeVar("Row")


class Service(NamedTuple):
    """Service whose events a bag has; `requests` and `responses` are None where nobody has counted them."""

    name: str
    type_name: str
    serialization_format: str
    events: int
    requests: int | None = None
    responses: int | None = None

    @property
    def sorted_by(self) -> int:
        """Number by which services are sorted: that of their calls, or that of their events."""
        if self.requests is None or self.responses is None:
            return self.events
        return self.requests + self.responses


class Details(NamedTuple):
    """Result of reading all messages: bytes by topic, and the services with their numbers of calls."""

    sizes: dict[str, int]
    services: list[Service]


def details_of(bag: Bag) -> Details:
    """Read a bag to its end for the sizes of its topics, and for the calls that its service events tell."""
    sizes = dict.fromkeys((each.name for each in bag.topics), 0)
    events = {each.name for each in bag.topics if each.is_service_event}
    calls: dict[str, tuple[set[tuple[bytes, int]], set[tuple[bytes, int]]]] = {each: (set(), set()) for each in events}
    for message in bag.messages():
        sizes[message.topic] += len(message.data)
        if message.topic in events and len(message.data) >= 44:
            kind, client, number = _EVENT[bool(message.data[1] & 1)].unpack_from(message.data, 4)
            calls[message.topic][kind in _RESPONSES].add((client, number))
    services = [
        each._replace(requests=len(sent), responses=len(answered))
        for each in services_of(bag.metadata)
        for sent, answered in [calls[each.name + SERVICE_EVENT]]
    ]
    return Details(sizes, services)


def services_of(metadata: BagMetadata) -> list[Service]:
    """Return the services whose events a bag has."""
    return [
        Service(
            topic.name.removesuffix(SERVICE_EVENT),
            topic.type_name.removesuffix("_Event"),
            topic.serialization_format,
            count,
        )
        for topic, count in metadata.topics_with_message_count
        if topic.is_service_event
    ]


def info_text(metadata: BagMetadata, sort: str = "name", details: Details | None = None) -> str:
    """Return the text that `ros2 bag info` prints; with `details`, that of -v. It ends with an empty line.

    Raises BagError for an unknown `sort`.
    """
    services = details.services if details else services_of(metadata)
    lines = [
        "",
        f"Files:             {_below(metadata.relative_file_paths, _INDENT)}",
        f"Bag size:          {size_text(metadata.bag_size)}",
        f"Storage id:        {metadata.storage_identifier}",
        f"ROS Distro:        {metadata.ros_distro or 'unknown'}",
        f"Duration:          {_seconds(metadata.duration)}s",
        f"Start:             {time_text(metadata.starting_time)}",
        f"End:               {time_text(metadata.end_time)}",
        f"Messages:          {metadata.message_count - sum(each.events for each in services)}",
        f"Topic information: {_below(_topic_lines(metadata, sort, details), _INDENT)}",
        f"Service:           {len(services)}",
        f"Service information: {_below(_service_lines(services, sort, details), _INDENT + '  ')}",
    ]
    return "\n".join([*lines, ""] if services else lines)


def topic_names(metadata: BagMetadata, sort: str = "name") -> list[str]:
    """Return the names that `ros2 bag info -t` prints. Raises BagError for an unknown `sort`."""
    return [topic.name for topic, _ in _topics(metadata, sort)]


def info_data(bag: Bag, sort: str = "name", details: Details | None = None) -> dict[str, Any]:
    """Return the description as data for JSON: sizes in bytes, times in nanoseconds. Raises like `info_text`."""
    metadata = bag.metadata
    return {
        "path": str(bag.path),
        "files": [_file_data(each) for each in metadata.files],
        "size": metadata.bag_size,
        "storage": metadata.storage_identifier,
        "compression": bag.compression,
        "compression_mode": metadata.compression_mode,
        "ros_distro": metadata.ros_distro,
        "version": metadata.version,
        "duration": metadata.duration,
        "start": metadata.starting_time,
        "end": metadata.end_time,
        "messages": metadata.message_count,
        "topics": [_topic_data(*each, details) for each in _topics(metadata, sort)],
        "services": [
            _service_data(each)
            for each in _sorted(details.services if details else services_of(metadata), sort, _SERVICE_KEYS)
        ],
        "custom_data": metadata.custom_data,
        "is_whole": bag.is_whole,
        "problems": bag.problems,
    }


def size_text(size: int) -> str:
    """Format a number of bytes as `ros2 bag info` does.

    >>> size_text(87), size_text(1536)
    ('87 B', '1.5 KiB')
    """
    value, unit = float(size), 0
    while value >= 1024 and unit < len(_UNITS) - 1:
        value, unit = value / 1024, unit + 1
    return f"{value:.1f} {_UNITS[unit]}" if unit else f"{size} B"


def time_text(stamp: int) -> str:
    """Format a time, in nanoseconds since 1970, as `ros2 bag info` does: in local time, and in seconds."""
    seconds, nanoseconds = divmod(stamp, 10**9)
    try:
        local = time.localtime(seconds)
    except (OverflowError, ValueError, OSError):  # beyond what this machine's calendar has
        return f"({_seconds(stamp)})"
    day = f"{_MONTHS[local.tm_mon - 1]} {local.tm_mday:2} {local.tm_year}"
    return f"{day} {local.tm_hour:02}:{local.tm_min:02}:{local.tm_sec:02}.{nanoseconds:09} ({_seconds(stamp)})"


_MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")
"""Names that do not depend on the language of the machine."""

_TOPIC_KEYS: dict[str, Callable[[tuple[BagTopic, int]], Any]] = {
    "name": lambda each: each[0].name,
    "type": lambda each: each[0].type_name,
    "count": lambda each: each[1],
}
_SERVICE_KEYS: dict[str, Callable[[Service], Any]] = {
    "name": lambda each: each.name,
    "type": lambda each: each.type_name,
    "count": lambda each: each.sorted_by,
}


def _seconds(span: int) -> str:
    seconds, nanoseconds = divmod(span, 10**9)
    return f"{seconds}.{nanoseconds:09}"


def _below(lines: Sequence[str], indent: str) -> str:
    return f"\n{indent}".join(lines)


def _topics(metadata: BagMetadata, sort: str) -> list[tuple[BagTopic, int]]:
    found = [each for each in metadata.topics_with_message_count if not each[0].is_service_event]
    return _sorted(found, sort, _TOPIC_KEYS)


def _sorted(rows: Iterable[Row], sort: str, keys: dict[str, Callable[[Row], Any]]) -> list[Row]:
    if sort.lower() not in keys:
        raise BagError(f"no order named '{sort}'{nearest(sort, SORTS)}: there are {', '.join(SORTS)}")
    return sorted(rows, key=keys[sort.lower()])


def _topic_lines(metadata: BagMetadata, sort: str, details: Details | None) -> list[str]:
    return [
        f"Topic: {topic.name} | Type: {topic.type_name} | Count: {count} | {_contribution(topic.name, details)}"
        f"Serialization Format: {topic.serialization_format}"
        for topic, count in _topics(metadata, sort)
    ]


def _service_lines(services: Iterable[Service], sort: str, details: Details | None) -> list[str]:
    return [
        f"Service: {each.name} | Type: {each.type_name} | {_calls(each)}"
        f"{_contribution(each.name + SERVICE_EVENT, details)}Serialization Format: {each.serialization_format}"
        for each in _sorted(services, sort, _SERVICE_KEYS)
    ]


def _calls(service: Service) -> str:
    if service.requests is None:
        return f"Event Count: {service.events} | "
    return f"Request Count: {service.requests} | Response Count: {service.responses} | "


def _contribution(topic: str, details: Details | None) -> str:
    return f"Size Contribution: {size_text(details.sizes.get(topic, 0))} | " if details else ""


def _file_data(file: Any) -> dict[str, Any]:
    return {
        "path": file.path,
        "start": file.starting_time,
        "duration": file.duration,
        "messages": file.message_count,
    }


def _topic_data(topic: BagTopic, count: int, details: Details | None) -> dict[str, Any]:
    data: dict[str, Any] = {
        "name": topic.name,
        "type": topic.type_name,
        "messages": count,
        "serialization_format": topic.serialization_format,
        "type_hash": topic.type_hash,
        "offered_qos_profiles": [_qos_data(each) for each in topic.offered_qos],
    }
    return data | ({"size": details.sizes.get(topic.name, 0)} if details else {})


def _qos_data(qos: Any) -> dict[str, Any]:
    policies = ("history", "reliability", "durability", "liveliness")
    spans = ("deadline", "lifespan", "liveliness_lease_duration")
    return (
        {name: getattr(qos, name).short_key for name in policies}
        | {"depth": qos.depth}
        | {name: getattr(qos, name).nanoseconds for name in spans}
    )


def _service_data(service: Service) -> dict[str, Any]:
    data: dict[str, Any] = {"name": service.name, "type": service.type_name, "events": service.events}
    return data | (
        {"requests": service.requests, "responses": service.responses} if service.requests is not None else {}
    )
