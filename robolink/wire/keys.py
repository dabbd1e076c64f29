"""Keys of topics and services: domain, name, type and hash, and how types are spelled in them."""

from __future__ import annotations

import functools
import re
from typing import NamedTuple

from robolink.exceptions import WireError
from robolink.system.patterns import late

LONGEST = 4096
"""Longest key or token, in characters; longer ones are refused unread. ROS 2's own names end at 255."""

remembered = functools.lru_cache(maxsize=1024)
"""LRU cache for parts of tokens: each endpoint of a node repeats the node's name, and each node the same types."""

_NUMBER = late(r"0|[1-9][0-9]{0,18}")

NO_HASH = "TypeHashNotSupported"
"""Placeholder that Humble sends in place of a type hash."""

_BUFFERS = "/_buf_cpu"
"""Suffix of the key on which Lyrical sends types with a `uint8[]`, and only to who announces a backend."""

CHUNK = r"[A-Za-z0-9_.~-]+"
"""Regular expression of the part of a name between two slashes."""

_TOPIC = late(rf"(?:/{CHUNK})+")
_TYPE = late(r"[A-Za-z]\w*(?:/[A-Za-z]\w*)+", re.ASCII)
_DDS_TYPE = late(r"((?:[A-Za-z]\w*::)+)dds_::([A-Za-z]\w*)_", re.ASCII)
_HASH = late(rf"RIHS\d\d_[0-9a-f]{{64}}|{NO_HASH}", re.ASCII)


class DataKey(NamedTuple):
    """Fields of the key expression to which samples of a topic, or calls of a service, are sent."""

    domain: int
    name: str
    """Fully qualified name, with its leading slash."""
    type_name: str
    """Type as in ROS 2: `std_msgs/msg/String`; a service's own type, not its request's."""
    type_hash: str


@remembered
def mangle_type(type_name: str) -> str:
    """Return the DDS spelling of a ROS type; raises WireError for an invalid type name.

    >>> mangle_type("std_msgs/msg/String")
    'std_msgs::msg::dds_::String_'
    """
    *packages, name = matched(_TYPE, type_name, "a type name").split("/")
    return f"{'::'.join(packages)}::dds_::{name}_"


@remembered
def demangle_type(dds_name: str) -> str:
    """Return the ROS type of a DDS spelling (`mangle_type`); raises WireError for anything else."""
    match = _DDS_TYPE.fullmatch(dds_name) if len(dds_name) <= LONGEST else None
    if match is None:
        raise WireError(f"expected a type such as std_msgs::msg::dds_::String_, got {quoted(dds_name)}")
    return match[1].replace("::", "/") + match[2]


def format_key(key: DataKey) -> str:
    """Return the key expression of a topic or service; raises WireError for an invalid field."""
    name = checked_topic(key.name)
    text = f"{format_number(key.domain)}{name}/{mangle_type(key.type_name)}/{checked_hash(key.type_hash)}"
    return not_too_long(text, "a key")


def buffer_key(key: str) -> str:
    """Return the key of Lyrical's publishers for types with a `uint8[]`, if all subscriptions announce CPU_BACKEND."""
    return key + _BUFFERS


def parse_key(text: str) -> DataKey:
    """Parse a key of `format_key` or `buffer_key`; raises WireError for any other text."""
    fields = not_too_long(text, "a key").removesuffix(_BUFFERS).split("/")
    if len(fields) < 4:
        raise WireError(f"a key is DOMAIN/NAME/TYPE/HASH, got {quoted(text)}")
    domain, *name, dds_type, type_hash = fields
    return DataKey(
        parse_number(domain),
        checked_topic("/" + "/".join(name)),
        demangle_type(dds_type),
        checked_hash(type_hash),
    )


def checked_topic(name: str) -> str:
    """Return `name` if it is the full name of a topic or service; raises WireError if not."""
    return matched(_TOPIC, name, "a full topic or service name")


@remembered
def checked_hash(text: str) -> str:
    """Return `text` if it is a type hash or NO_HASH; raises WireError if not."""
    return matched(_HASH, text, "a type hash")


def format_number(value: int) -> str:
    """Format a domain or entity number; raises WireError for a negative or giant one."""
    return matched(_NUMBER, str(value), "a domain or entity number")


def parse_number(text: str) -> int:
    """Parse a number; raises WireError for anything else."""
    return int(matched(_NUMBER, text, "a number"))


def matched(pattern: re.Pattern[str], text: str, what: str) -> str:
    """Return the text if all of it matches; raises WireError with `what` was expected if not."""
    if pattern.fullmatch(not_too_long(text, what)) is None:
        raise WireError(f"expected {what}, got {quoted(text)}")
    return text


def not_too_long(text: str, what: str) -> str:
    """Return the text if it has at most LONGEST characters; raises WireError if not."""
    if len(text) > LONGEST:
        raise WireError(f"{what} has at most {LONGEST} characters, got {len(text)}: {quoted(text)}")
    return text


def quoted(text: str) -> str:
    """Quote a text for an error, cut where it is long."""
    return repr(text if len(text) <= 120 else text[:120] + "…")
