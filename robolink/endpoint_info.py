"""Descriptions of an endpoint of a topic or service, as the graph shows it: its node, type and profile."""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntEnum
from typing import Any

from robolink.qos import HistoryPolicy, QoSPresetProfiles, QoSProfile
from robolink.type_hash import TypeHash


class EndpointTypeEnum(IntEnum):
    """Kinds of endpoints, numbered as in rmw."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2
    CLIENT = 3
    SERVER = 4


_FIELDS: dict[str, type] = {
    "node_name": str,
    "node_namespace": str,
    "topic_type": str,
    "topic_type_hash": TypeHash,
    "endpoint_type": EndpointTypeEnum,
    "endpoint_gid": list,
    "qos_profile": QoSProfile,
}


class TopicEndpointInfo:
    """Publisher or subscription of a topic, with its node, type and profile.

    Args:
        node_name: Name of its node, without namespace.
        node_namespace: Namespace of its node.
        topic_type: Name of the message type, such as `std_msgs/msg/String`.
        topic_type_hash: Hash of the message type, or the dictionary of its parts; None is not a hash.
        endpoint_type: Kind of the endpoint, or its number.
        endpoint_gid: Global id, 16 numbers from 0 to 255; None is empty.
        qos_profile: Quality of service, or the dictionary of its policies.

    Raises:
        AssertionError: for a value of another type, as in rclpy.
    """

    __slots__ = tuple(_FIELDS)

    node_name: str
    node_namespace: str
    topic_type: str
    topic_type_hash: TypeHash
    endpoint_type: EndpointTypeEnum
    endpoint_gid: list[int]
    qos_profile: QoSProfile

    def __init__(
        self,
        node_name: str = "",
        node_namespace: str = "",
        topic_type: str = "",
        topic_type_hash: TypeHash | None = None,
        endpoint_type: EndpointTypeEnum = EndpointTypeEnum.INVALID,
        endpoint_gid: list[int] | None = None,
        qos_profile: QoSProfile = QoSPresetProfiles.UNKNOWN.value,
    ) -> None:
        self.node_name = node_name
        self.node_namespace = node_namespace
        self.topic_type = topic_type
        self.topic_type_hash = TypeHash() if topic_type_hash is None else topic_type_hash
        self.endpoint_type = endpoint_type
        self.endpoint_gid = [] if endpoint_gid is None else endpoint_gid
        self.qos_profile = qos_profile

    def __setattr__(self, name: str, value: Any) -> None:
        object.__setattr__(self, name, _checked(self, _FIELDS, name, value))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TopicEndpointInfo) and _same(self, other, _FIELDS)

    __hash__ = None  # type: ignore[assignment]  # mutable and compared by value, like a list

    def __str__(self) -> str:
        return "\n".join(
            [
                f"Node name: {self.node_name}",
                f"Node namespace: {self.node_namespace}",
                f"Topic type: {self.topic_type}",
                f"Topic type hash: {self.topic_type_hash}",
                f"Endpoint type: {self.endpoint_type.name}",
                f"GID: {dotted(self.endpoint_gid)}",
                *qos_lines(self.qos_profile),
            ]
        )


_SERVICE_FIELDS: dict[str, type] = {
    "node_name": str,
    "node_namespace": str,
    "service_type": str,
    "service_type_hash": TypeHash,
    "qos_profiles": list,
    "endpoint_gids": list,
    "endpoint_type": EndpointTypeEnum,
    "endpoint_count": int,
}


class ServiceEndpointInfo:
    """Server or client of a service, with its node, type and profiles.

    Over Zenoh each is one endpoint with one gid and profile; a DDS has two for each, the reader and the writer, of
    which robolink's graph knows one as well.

    Args:
        node_name: Name of its node, without namespace.
        node_namespace: Namespace of its node.
        service_type: Name of the service type, such as `std_srvs/srv/Trigger`.
        service_type_hash: Hash of the service type, or the dictionary of its parts; None is not a hash.
        qos_profiles: Quality of service of each endpoint, or the dictionaries of the policies; None is empty.
        endpoint_gids: Global id of each endpoint, 16 numbers from 0 to 255; None is empty.
        endpoint_type: Kind of the endpoint, or its number.
        endpoint_count: Number of endpoints: 1, or 2 for a reader and a writer.

    Raises:
        AssertionError: for a value of another type, as in rclpy.
    """

    __slots__ = tuple(_SERVICE_FIELDS)

    node_name: str
    node_namespace: str
    service_type: str
    service_type_hash: TypeHash
    qos_profiles: list[QoSProfile]
    endpoint_gids: list[list[int]]
    endpoint_type: EndpointTypeEnum
    endpoint_count: int

    def __init__(
        self,
        node_name: str = "",
        node_namespace: str = "",
        service_type: str = "",
        service_type_hash: TypeHash | None = None,
        qos_profiles: list[QoSProfile] | None = None,
        endpoint_gids: list[list[int]] | None = None,
        endpoint_type: EndpointTypeEnum = EndpointTypeEnum.INVALID,
        endpoint_count: int = 0,
    ) -> None:
        self.node_name = node_name
        self.node_namespace = node_namespace
        self.service_type = service_type
        self.service_type_hash = TypeHash() if service_type_hash is None else service_type_hash
        self.qos_profiles = [] if qos_profiles is None else qos_profiles
        self.endpoint_gids = [] if endpoint_gids is None else endpoint_gids
        self.endpoint_type = endpoint_type
        self.endpoint_count = endpoint_count

    def __setattr__(self, name: str, value: Any) -> None:
        value = _checked(self, _SERVICE_FIELDS, name, value)
        if name == "qos_profiles":
            value = [QoSProfile(**each) if isinstance(each, dict) else each for each in value]
            assert all(isinstance(each, QoSProfile) for each in value), f"{name} must be profiles, got {value!r}"
        elif name == "endpoint_gids":
            are_gids = all(isinstance(gid, list) and all(isinstance(byte, int) for byte in gid) for gid in value)
            assert are_gids, f"{name} must be lists of numbers, got {value!r}"
        object.__setattr__(self, name, value)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ServiceEndpointInfo) and _same(self, other, _SERVICE_FIELDS)

    __hash__ = None  # type: ignore[assignment]  # mutable and compared by value, like a list

    def __str__(self) -> str:
        return "\n".join(
            [
                f"Node name: {self.node_name}",
                f"Node namespace: {self.node_namespace}",
                f"Service type: {self.service_type}",
                f"Service type hash: {self.service_type_hash}",
                f"Endpoint type: {self.endpoint_type.name}",
                f"Endpoint count: {self.endpoint_count}",
                *self._endpoint_lines(),
            ]
        )

    def _endpoint_lines(self) -> list[str]:
        gids, profiles = [dotted(each) for each in self.endpoint_gids], self.qos_profiles
        if len(gids) == len(profiles) == 1:
            return [f"GID: {gids[0]}", *qos_lines(profiles[0])]
        # The reader comes first, but a client is printed by what it sends first.
        roles = ["Request Reader", "Response Writer"]
        if self.endpoint_type is EndpointTypeEnum.CLIENT:
            roles, gids, profiles = ["Request Writer", "Response Reader"], gids[::-1], profiles[::-1]
        lines = ["GIDs:", *(f" - {role} : {gid}" for role, gid in zip(roles, gids, strict=False)), "QoS profiles:"]
        for role, profile in zip(roles, profiles, strict=False):
            lines += [f" - {role} :", *(f"    {line}" for line in qos_lines(profile)[1:])]
        return lines


def _checked(info: object, fields: dict[str, type], name: str, value: Any) -> Any:
    """Return the value of a field, made of a dictionary or number if need be; raise if it is of another type."""
    kind = fields.get(name)
    if kind is None:
        raise AttributeError(f"a {type(info).__name__} has no field {name!r}")
    if isinstance(value, dict):
        value = kind(**value)
    elif kind is EndpointTypeEnum and isinstance(value, int):
        value = kind(value)
    assert isinstance(value, kind), f"{name} must be of type {kind.__name__}, got {value!r}"
    return value


def _same(one: object, other: object, fields: dict[str, type]) -> bool:
    return all(getattr(one, name) == getattr(other, name) for name in fields)


def dotted(gid: Iterable[int]) -> str:
    """Return a global id as text.

    Args:
        gid: Its bytes.

    >>> dotted(bytes([1, 15, 255]))
    '01.0f.ff'
    """
    return ".".join(f"{byte:02x}" for byte in gid)


def qos_lines(profile: QoSProfile) -> list[str]:
    """Return the lines by which `ros2 topic info -v` shows `profile`."""
    depth = f" ({profile.depth})" if profile.history is HistoryPolicy.KEEP_LAST else ""
    return [
        "QoS profile:",
        f"  Reliability: {profile.reliability.name}",
        f"  History (Depth): {profile.history.name}{depth}",
        f"  Durability: {profile.durability.name}",
        f"  Lifespan: {profile.lifespan}",
        f"  Deadline: {profile.deadline}",
        f"  Liveliness: {profile.liveliness.name}",
        f"  Liveliness lease duration: {profile.liveliness_lease_duration}",
    ]
