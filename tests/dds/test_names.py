"""Names of topics, services and types on DDS, and what endpoints and participants say in user data."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.dds.names import (
    Role,
    RosName,
    dds_topic,
    dds_type,
    enclave_data,
    enclave_in,
    hash_in,
    ros_name,
    user_data_of,
)
from robolink.interfaces.std_msgs.msg import String
from robolink.message import type_hash
from robolink.wire import NO_HASH

# As seen on the wire, between nodes of Kilted over Fast DDS.
SEEN = [
    ("rt/chatter", "std_msgs::msg::dds_::String_", RosName(Role.TOPIC, "/chatter", "std_msgs/msg/String")),
    (
        "rq/real/set_parametersRequest",
        "rcl_interfaces::srv::dds_::SetParameters_Request_",
        RosName(Role.REQUEST, "/real/set_parameters", "rcl_interfaces/srv/SetParameters"),
    ),
    (
        "rr/fib/_action/send_goalReply",
        "test_msgs::action::dds_::Fibonacci_SendGoal_Response_",
        RosName(Role.REPLY, "/fib/_action/send_goal", "test_msgs/action/Fibonacci_SendGoal"),
    ),
]


@pytest.mark.parametrize(("topic", "type_name", "expected"), SEEN)
def test_names_are_read_and_written(topic: str, type_name: str, expected: RosName) -> None:
    assert ros_name(topic, type_name) == expected
    assert dds_topic(expected.role, expected.name) == topic
    assert dds_type(expected.role, expected.type_name) == type_name


@pytest.mark.parametrize(
    ("topic", "type_name"),
    [
        ("ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"),
        ("chatter", "std_msgs::msg::dds_::String_"),
        ("rt", "std_msgs::msg::dds_::String_"),
        ("rt/", "std_msgs::msg::dds_::String_"),
        ("rt/square", "ShapeType"),
        ("rq/xReply", "a::srv::dds_::B_Request_"),
        ("rq/Request", "a::srv::dds_::B_Request_"),
        ("rq/xRequest", "a::srv::dds_::B_Response_"),
        ("rt/chatter", "x" * 10_000),
        ("", ""),
    ],
)
def test_what_is_not_of_ros_has_no_name(topic: str, type_name: str) -> None:
    assert ros_name(topic, type_name) is None


@given(st.text(), st.text())
def test_any_text_is_a_name_or_none(topic: str, type_name: str) -> None:
    found = ros_name(topic, type_name)
    assert found is None or dds_topic(found.role, found.name) == topic


def test_a_hash_crosses_in_user_data() -> None:
    expected = type_hash(String)
    assert user_data_of(expected) == f"typehash={expected};".encode()
    assert hash_in(user_data_of(expected)) == expected
    assert hash_in(b"a=b;" + user_data_of(expected)) == expected
    assert user_data_of(NO_HASH) == b""


@pytest.mark.parametrize(
    "user_data", [b"", b"typehash=", b"typehash=RIHS01_12;", b"nottypehash=RIHS01_" + b"0" * 64 + b";", b"\xff" * 100]
)
def test_user_data_without_a_hash(user_data: bytes) -> None:
    assert hash_in(user_data) == NO_HASH


def test_participants_of_ros_tell_their_enclave() -> None:
    assert enclave_data("/") == b"enclave=/;\0"
    assert enclave_in(enclave_data("/robot/arm")) == "/robot/arm"
    assert enclave_in(b"robolink_bridge=ab;enclave=/;") == "/"
    assert enclave_in(b"") is None
    assert enclave_in(b"enclave=") is None
