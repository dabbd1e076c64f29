"""TopicEndpointInfo and TypeHash: what rclpy's own hold, print and refuse."""

from __future__ import annotations

from typing import Any

import pytest

from robolink.qos import QoSProfile
from robolink.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from robolink.type_hash import TypeHash

TEXT = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
VALUES: dict[str, Any] = {
    "node_name": "talker",
    "node_namespace": "/left",
    "topic_type": "std_msgs/msg/String",
    "topic_type_hash": TypeHash.from_text(TEXT),
    "endpoint_type": TopicEndpointTypeEnum.SUBSCRIPTION,
    "endpoint_gid": [1, 2, 255],
    "qos_profile": QoSProfile(depth=7),
}


def test_a_hash_is_printed_as_tokens_carry_it() -> None:
    known = TypeHash(version=1, value=bytes.fromhex(TEXT.removeprefix("RIHS01_")))
    assert str(known) == TEXT
    assert TypeHash.from_text(TEXT) == known
    assert hash(TypeHash.from_text(TEXT)) == hash(known)
    assert TypeHash(version=5) != TypeHash()
    assert TypeHash() != TEXT


@pytest.mark.parametrize("text", ["TypeHashNotSupported", "", "RIHS01_xy", "RIHS0a_00", "RIHS"])
def test_what_is_no_hash_is_invalid(text: str) -> None:
    assert TypeHash.from_text(text) == TypeHash()
    assert str(TypeHash.from_text(text)) == "INVALID"
    assert str(TypeHash(1, b"short")) == "INVALID"


@pytest.mark.parametrize(("name", "value"), VALUES.items())
def test_a_field_is_given_or_set(name: str, value: Any) -> None:
    info = TopicEndpointInfo()
    assert info != TopicEndpointInfo(**{name: value})
    setattr(info, name, value)
    assert info == TopicEndpointInfo(**{name: value})
    assert getattr(info, name) == value


def test_parts_may_be_dictionaries_and_numbers() -> None:
    info = TopicEndpointInfo(**{**VALUES, "endpoint_type": 2})
    info.topic_type_hash = {"version": 1, "value": bytes(32)}  # type: ignore[assignment]
    info.qos_profile = QoSProfile(depth=3).to_dict()  # type: ignore[assignment]
    assert info.endpoint_type is TopicEndpointTypeEnum.SUBSCRIPTION
    assert info.topic_type_hash == TypeHash(1)
    assert info.qos_profile == QoSProfile(depth=3)


@pytest.mark.parametrize("name", VALUES)
def test_a_value_of_another_type_is_refused(name: str) -> None:
    with pytest.raises(AssertionError, match=name):
        setattr(TopicEndpointInfo(), name, None)
    with pytest.raises(AttributeError, match="no field 'nod_name'"):
        TopicEndpointInfo().nod_name = "x"


def test_an_empty_one_is_printed_as_in_rclpy() -> None:
    assert str(TopicEndpointInfo()).splitlines() == [
        "Node name: ",
        "Node namespace: ",
        "Topic type: ",
        "Topic type hash: INVALID",
        "Endpoint type: INVALID",
        "GID: ",
        "QoS profile:",
        "  Reliability: UNKNOWN",
        "  History (Depth): UNKNOWN",
        "  Durability: UNKNOWN",
        "  Lifespan: 0 nanoseconds",
        "  Deadline: 0 nanoseconds",
        "  Liveliness: UNKNOWN",
        "  Liveliness lease duration: 0 nanoseconds",
    ]


def test_a_full_one_is_printed() -> None:
    text = str(TopicEndpointInfo(**VALUES))
    assert "GID: 01.02.ff\n" in text
    assert "  History (Depth): KEEP_LAST (7)\n" in text
    assert f"Topic type hash: {TEXT}\nEndpoint type: SUBSCRIPTION\n" in text
