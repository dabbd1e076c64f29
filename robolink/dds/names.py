"""Names of ROS 2 on DDS: topics (rt/, rq/, rr/), types of services' messages, and what endpoints say in user data.

The mapping is ROS 2's design article "Topic and Service name mapping to DDS" and rmw_dds_common's user data.
"""

from __future__ import annotations

import re
from enum import Enum
from typing import NamedTuple

from robolink.exceptions import WireError
from robolink.wire import NO_HASH, demangle_type, mangle_type

BARE_NODE = "_CREATED_BY_BARE_DDS_APP_"
"""Name of the node of an endpoint whose participant is not of ROS 2, as rmw has it."""

_HASH = re.compile(rb"(?:^|;)typehash=(RIHS\d\d_[0-9a-f]{64});")
_ENCLAVE = re.compile(rb"(?:^|;)enclave=([^;\0]{1,255});")


class Role(Enum):
    """Content of a DDS topic: messages of a ROS topic, or the requests or the replies of a service."""

    TOPIC = "rt"
    REQUEST = "rq"
    REPLY = "rr"


_TOPIC_SUFFIXES = {Role.TOPIC: "", Role.REQUEST: "Request", Role.REPLY: "Reply"}
_TYPE_SUFFIXES = {Role.TOPIC: "", Role.REQUEST: "_Request", Role.REPLY: "_Response"}


class RosName(NamedTuple):
    """Name and type that a DDS topic stands for in ROS 2."""

    role: Role
    name: str
    """Full name of the topic or service."""
    type_name: str
    """Type as in ROS 2; of a service its own, not that of its requests."""


def dds_topic(role: Role, name: str) -> str:
    """Return the DDS topic of a ROS name.

    >>> dds_topic(Role.REQUEST, "/robot/set_mode")
    'rq/robot/set_modeRequest'
    """
    return f"{role.value}{name}{_TOPIC_SUFFIXES[role]}"


def dds_type(role: Role, type_name: str) -> str:
    """Return the DDS type of a ROS type; raises WireError for an invalid one.

    >>> dds_type(Role.REPLY, "std_srvs/srv/SetBool")
    'std_srvs::srv::dds_::SetBool_Response_'
    """
    return mangle_type(type_name + _TYPE_SUFFIXES[role])


def ros_name(topic: str, type_name: str) -> RosName | None:
    """Return the name that a DDS topic and its type stand for; None for what is not of ROS 2.

    >>> ros_name("rt/chatter", "std_msgs::msg::dds_::String_").name
    '/chatter'
    """
    prefix, slash, rest = topic.partition("/")
    try:
        role = Role(prefix)
        ros_type = demangle_type(type_name)
    except (ValueError, WireError):
        return None
    topic_suffix, type_suffix = _TOPIC_SUFFIXES[role], _TYPE_SUFFIXES[role]
    if not slash or not rest.endswith(topic_suffix) or not ros_type.endswith(type_suffix):
        return None
    name, ros_type = rest.removesuffix(topic_suffix), ros_type.removesuffix(type_suffix)
    return RosName(role, f"/{name}", ros_type) if name else None


def user_data_of(type_hash: str) -> bytes:
    """Return an endpoint's user data, by which others learn the hash of its type; empty without one."""
    return b"" if type_hash == NO_HASH else f"typehash={type_hash};".encode()


def hash_in(user_data: bytes) -> str:
    """Return the hash in an endpoint's user data; NO_HASH if there is none, as from Humble and other DDS programs."""
    match = _HASH.search(user_data)
    return match[1].decode() if match else NO_HASH


def enclave_data(enclave: str) -> bytes:
    """Return the user data of a participant of ROS 2, which tells its enclave; with the NUL that Fast DDS's has."""
    return f"enclave={enclave};\0".encode()


def enclave_in(user_data: bytes) -> str | None:
    """Return the enclave in a participant's user data; None if it is not one of ROS 2."""
    match = _ENCLAVE.search(user_data)
    return match[1].decode(errors="replace") if match else None
