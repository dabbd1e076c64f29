"""TopicEndpointInfo, ServiceEndpointInfo and TypeHash: what rclpy's own hold, print and refuse."""

from __future__ import annotations

from typing import Any

import pytest

from robolink.endpoint_info import EndpointTypeEnum, ServiceEndpointInfo, TopicEndpointInfo
from robolink.qos import QoSProfile
from robolink.topic_endpoint_info import TopicEndpointTypeEnum
from robolink.type_hash import TypeHash

TEXT = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
VALUES: dict[str, Any] = {
    "node_name": "talker",
    "node_namespace": "/left",
    "topic_type": "std_msgs/msg/String",
    "topic_type_hash": TypeHash.from_text(TEXT),
    "endpoint_type": EndpointTypeEnum.SUBSCRIPTION,
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
    assert info.endpoint_type is EndpointTypeEnum.SUBSCRIPTION
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


SERVICE: dict[str, Any] = {
    "node_name": "arm",
    "node_namespace": "/left",
    "service_type": "std_srvs/srv/Trigger",
    "service_type_hash": TypeHash.from_text(TEXT),
    "qos_profiles": [QoSProfile(depth=7)],
    "endpoint_gids": [[1, 2, 255]],
    "endpoint_type": EndpointTypeEnum.SERVER,
    "endpoint_count": 1,
}


@pytest.mark.parametrize(("name", "value"), SERVICE.items())
def test_a_field_of_a_service_is_given_or_set(name: str, value: Any) -> None:
    info = ServiceEndpointInfo()
    assert info != ServiceEndpointInfo(**{name: value})
    setattr(info, name, value)
    assert info == ServiceEndpointInfo(**{name: value})
    assert getattr(info, name) == value
    with pytest.raises(AssertionError, match=name):
        setattr(info, name, None)


@pytest.mark.parametrize(("name", "value"), [("qos_profiles", [3]), ("endpoint_gids", [3]), ("endpoint_gids", [["a"]])])
def test_lists_of_a_service_hold_what_they_should(name: str, value: Any) -> None:
    with pytest.raises(AssertionError, match=name):
        ServiceEndpointInfo(**{name: value})


def test_a_server_with_one_endpoint_is_printed() -> None:
    info = ServiceEndpointInfo(**{**SERVICE, "endpoint_type": 4, "qos_profiles": [QoSProfile(depth=7).to_dict()]})
    assert info == ServiceEndpointInfo(**SERVICE)
    assert str(info).splitlines()[:9] == [
        "Node name: arm",
        "Node namespace: /left",
        "Service type: std_srvs/srv/Trigger",
        f"Service type hash: {TEXT}",
        "Endpoint type: SERVER",
        "Endpoint count: 1",
        "GID: 01.02.ff",
        "QoS profile:",
        "  Reliability: RELIABLE",
    ]


@pytest.mark.parametrize(
    ("kind", "first", "second", "gids"),
    [
        (EndpointTypeEnum.SERVER, "Request Reader", "Response Writer", ["01", "02"]),
        (EndpointTypeEnum.CLIENT, "Request Writer", "Response Reader", ["02", "01"]),
    ],
)
def test_a_reader_and_a_writer_are_printed(kind: EndpointTypeEnum, first: str, second: str, gids: list[str]) -> None:
    profiles = [QoSProfile(depth=1), QoSProfile(depth=2)]
    info = ServiceEndpointInfo(qos_profiles=profiles, endpoint_gids=[[1], [2]], endpoint_type=kind, endpoint_count=2)
    lines = str(info).splitlines()[6:]
    assert lines[:5] == [
        "GIDs:",
        f" - {first} : {gids[0]}",
        f" - {second} : {gids[1]}",
        "QoS profiles:",
        f" - {first} :",
    ]
    assert lines[6] == f"      History (Depth): KEEP_LAST ({int(gids[0])})"
    assert lines[12] == f" - {second} :"


def test_the_kinds_have_the_name_of_before_lyrical_too() -> None:
    assert TopicEndpointTypeEnum is EndpointTypeEnum
