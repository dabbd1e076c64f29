"""Description of one publisher or subscription of a topic, as the graph shows it."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

from robolink.qos import HistoryPolicy, QoSPresetProfiles, QoSProfile
from robolink.type_hash import TypeHash


class TopicEndpointTypeEnum(IntEnum):
    """Kinds of endpoints, numbered as in rmw."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


_FIELDS: dict[str, type] = {
    "node_name": str,
    "node_namespace": str,
    "topic_type": str,
    "topic_type_hash": TypeHash,
    "endpoint_type": TopicEndpointTypeEnum,
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
    endpoint_type: TopicEndpointTypeEnum
    endpoint_gid: list[int]
    qos_profile: QoSProfile

    def __init__(
        self,
        node_name: str = "",
        node_namespace: str = "",
        topic_type: str = "",
        topic_type_hash: TypeHash | None = None,
        endpoint_type: TopicEndpointTypeEnum = TopicEndpointTypeEnum.INVALID,
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
        kind = _FIELDS.get(name)
        if kind is None:
            raise AttributeError(f"a TopicEndpointInfo has no field {name!r}")
        if isinstance(value, dict):
            value = kind(**value)
        elif kind is TopicEndpointTypeEnum and isinstance(value, int):
            value = kind(value)
        assert isinstance(value, kind), f"{name} must be of type {kind.__name__}, got {value!r}"
        object.__setattr__(self, name, value)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, TopicEndpointInfo) and all(getattr(self, n) == getattr(other, n) for n in _FIELDS)

    __hash__ = None  # type: ignore[assignment]  # mutable and compared by value, like a list

    def __str__(self) -> str:
        return "\n".join(
            [
                f"Node name: {self.node_name}",
                f"Node namespace: {self.node_namespace}",
                f"Topic type: {self.topic_type}",
                f"Topic type hash: {self.topic_type_hash}",
                f"Endpoint type: {self.endpoint_type.name}",
                f"GID: {'.'.join(f'{byte:02x}' for byte in self.endpoint_gid)}",
                *qos_lines(self.qos_profile),
            ]
        )


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
