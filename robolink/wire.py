"""How rmw_zenoh names things on the wire: keys of topics and services, tokens of the graph, attachments."""

from __future__ import annotations

import functools
import itertools
import re
import struct
from collections.abc import Callable
from enum import Enum, IntEnum
from typing import Any, NamedTuple, TypeVar

import xxhash

from robolink.constants import S_TO_NS
from robolink.duration import Duration, Infinite
from robolink.exceptions import WireError
from robolink.names import join
from robolink.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_system_default,
    resolved,
)

_PolicyT = TypeVar("_PolicyT", bound=IntEnum)

LONGEST = 4096
"""Keys and tokens with more characters are refused unread; ROS 2's own names end at 255."""

NO_HASH = "TypeHashNotSupported"
"""What Humble says in place of a type hash."""

_remembered = functools.lru_cache(maxsize=1024)
"""For parts of tokens: each endpoint of a node repeats the node's name, and each node the same types."""

_ATTACHMENT = struct.Struct("<qqB16s")
ATTACHMENT_BYTES = _ATTACHMENT.size
GID_BYTES = 16
_GRAPH = "@ros2_lv"
_CHUNK = r"[A-Za-z0-9_.~-]+"
_NAME = re.compile(rf"/?{_CHUNK}(?:/{_CHUNK})*|/")
_TOPIC = re.compile(rf"(?:/{_CHUNK})+")
_TYPE = re.compile(r"[A-Za-z]\w*(?:/[A-Za-z]\w*)+", re.ASCII)
_DDS_TYPE = re.compile(r"((?:[A-Za-z]\w*::)+)dds_::([A-Za-z]\w*)_", re.ASCII)
_HASH = re.compile(rf"RIHS\d\d_[0-9a-f]{{64}}|{NO_HASH}", re.ASCII)
_SESSION = re.compile(r"[0-9a-f]{1,32}")
_NUMBER = re.compile(r"0|[1-9][0-9]{0,18}")


class Attachment(NamedTuple):
    """What travels beside every payload: who sent it, when, and as which of its own."""

    sequence: int
    timestamp: int
    """Nanoseconds since the epoch."""
    gid: bytes
    """The 16 bytes of `gid_of` the sender's token."""


class DataKey(NamedTuple):
    """Where samples of a topic, or calls of a service, are sent."""

    domain: int
    name: str
    """Fully qualified, with its leading slash."""
    type_name: str
    """As in ROS 2: `std_msgs/msg/String`; a service's own type, not its request's."""
    type_hash: str


class EndpointKind(Enum):
    """What a node may own, spelled as in tokens."""

    PUBLISHER = "MP"
    SUBSCRIPTION = "MS"
    SERVICE = "SS"
    CLIENT = "SC"


OTHER_END = {
    EndpointKind.PUBLISHER: EndpointKind.SUBSCRIPTION,
    EndpointKind.SUBSCRIPTION: EndpointKind.PUBLISHER,
    EndpointKind.SERVICE: EndpointKind.CLIENT,
    EndpointKind.CLIENT: EndpointKind.SERVICE,
}
"""Whom each kind talks to."""


class NodeToken(NamedTuple):
    """What a node announces about itself."""

    domain: int
    session: str
    node_id: int
    enclave: str
    namespace: str
    node_name: str

    @property
    def full_node_name(self) -> str:
        """Namespace and name."""
        return join(self.namespace, self.node_name)


class EndpointToken(NamedTuple):
    """What a node announces about a publisher, subscription, service or client that it owns."""

    domain: int
    session: str
    node_id: int
    endpoint_id: int
    kind: EndpointKind
    enclave: str
    namespace: str
    node_name: str
    name: str
    """Fully qualified name of the topic or service."""
    type_name: str
    type_hash: str
    qos: QoSProfile

    @property
    def full_node_name(self) -> str:
        """Namespace and name of the node that owns it."""
        return join(self.namespace, self.node_name)

    def understands(self, other: EndpointToken) -> bool:
        """Whether both mean the same type: by name and hash, or by name where one is a Humble peer's."""
        same_hash = self.type_hash == other.type_hash or NO_HASH in (self.type_hash, other.type_hash)
        return same_hash and self.type_name == other.type_name


def pack_attachment(sequence: int, timestamp: int, gid: bytes) -> bytes:
    """Give the 33 bytes of an attachment; `timestamp` in nanoseconds since the epoch, `gid` of 16 bytes."""
    return _ATTACHMENT.pack(sequence, timestamp, GID_BYTES, gid)


def attachments(gid: bytes, now: Callable[[], int]) -> Callable[[], bytes]:
    """Give the function that makes a sender's next attachment, numbered from 1 and stamped with `now()`.

    It runs for every message, hence a closure: all that it needs is at hand.
    """
    pack, number = _ATTACHMENT.pack, itertools.count(1).__next__
    return lambda: pack(number(), now(), GID_BYTES, gid)


def unpack_attachment(raw: bytes) -> Attachment:
    """Read an attachment; raises WireError for anything but its 33 bytes."""
    if len(raw) != _ATTACHMENT.size:
        raise WireError(f"an attachment has {_ATTACHMENT.size} bytes, got {len(raw)}")
    sequence, timestamp, gid_length, gid = _ATTACHMENT.unpack(raw)
    if gid_length != GID_BYTES:
        raise WireError(f"an attachment's gid has {GID_BYTES} bytes, got {gid_length}")
    return Attachment(sequence, timestamp, gid)


def gid_of(token: str) -> bytes:
    """Give the 16 bytes that stand for an endpoint: XXH3-128 of its token, the low half first."""
    raw = token.encode(errors="surrogatepass")
    return xxhash.xxh3_128_intdigest(raw).to_bytes(GID_BYTES, "little")


@_remembered
def mangle_type(type_name: str) -> str:
    """Spell a ROS type as DDS does; raises WireError for what is no type name.

    >>> mangle_type("std_msgs/msg/String")
    'std_msgs::msg::dds_::String_'
    """
    *packages, name = _matched(_TYPE, type_name, "a type name").split("/")
    return f"{'::'.join(packages)}::dds_::{name}_"


@_remembered
def demangle_type(dds_name: str) -> str:
    """Undo `mangle_type`; raises WireError for what it cannot have made."""
    match = _DDS_TYPE.fullmatch(dds_name) if len(dds_name) <= LONGEST else None
    if match is None:
        raise WireError(f"expected a type such as std_msgs::msg::dds_::String_, got {_shown(dds_name)}")
    return match[1].replace("::", "/") + match[2]


def format_key(key: DataKey) -> str:
    """Give the key expression of a topic or service; raises WireError for a part that it cannot carry."""
    name = _checked_topic(key.name)
    text = f"{_number(key.domain)}{name}/{mangle_type(key.type_name)}/{_checked_hash(key.type_hash)}"
    return _not_too_long(text, "a key")


def parse_key(text: str) -> DataKey:
    """Read a key expression; raises WireError for what `format_key` cannot have made."""
    fields = _not_too_long(text, "a key").split("/")
    if len(fields) < 4:
        raise WireError(f"a key is DOMAIN/NAME/TYPE/HASH, got {_shown(text)}")
    domain, *name, dds_type, type_hash = fields
    return DataKey(
        _parsed_number(domain),
        _checked_topic("/" + "/".join(name)),
        demangle_type(dds_type),
        _checked_hash(type_hash),
    )


def graph_pattern(domain: int | None = None) -> str:
    """Give the key expression that all tokens of a domain match; without one, those of all domains."""
    return f"{_GRAPH}/**" if domain is None else f"{_GRAPH}/{_number(domain)}/**"


def own_tokens(domain: int, session: str) -> str:
    """Give how all tokens of a session on a domain begin."""
    return f"{_GRAPH}/{_number(domain)}/{session}/"


def format_token(token: NodeToken | EndpointToken) -> str:
    """Give the token as it is announced; raises WireError for a part that it cannot carry."""
    endpoint = token if isinstance(token, EndpointToken) else None
    fields = [
        _GRAPH,
        _number(token.domain),
        _matched(_SESSION, token.session, "a session id"),
        _number(token.node_id),
        _number(endpoint.endpoint_id if endpoint else token.node_id),
        endpoint.kind.value if endpoint else "NN",
        *map(_mangled, (token.enclave or "/", token.namespace or "/", token.node_name)),
    ]
    if endpoint:
        fields += [_mangled(_checked_topic(endpoint.name)), mangle_type(endpoint.type_name)]
        fields += [_checked_hash(endpoint.type_hash), format_qos(endpoint.qos)]
    return _not_too_long("/".join(fields), "a token")


def parse_token(text: str) -> NodeToken | EndpointToken:
    """Read a token; raises WireError for what no peer of rmw_zenoh announces.

    Tokens share their profiles: copy one before you change it.
    """
    fields = _not_too_long(text, "a token").split("/")
    if len(fields) not in (9, 13) or fields[0] != _GRAPH:
        raise WireError(f"a token has 9 or 13 fields after {_GRAPH}, got {_shown(text)}")
    domain, node_id, own_id = map(_parsed_number, (fields[1], fields[3], fields[4]))
    session = _matched(_SESSION, fields[2], "a session id")
    enclave, namespace, node_name = map(_demangled, fields[6:9])
    if len(fields) == 9:
        if fields[5] != "NN":
            raise WireError(f"a token of 9 fields is a node's, got {_shown(text)}")
        return NodeToken(domain, session, node_id, enclave, namespace, node_name)
    return EndpointToken(
        domain,
        session,
        node_id,
        own_id,
        _parsed_kind(fields[5]),
        enclave,
        namespace,
        node_name,
        _checked_topic(_demangled(fields[9])),
        demangle_type(fields[10]),
        _checked_hash(fields[11]),
        _shared_qos(fields[12]),
    )


def format_qos(qos: QoSProfile) -> str:
    """Give a profile as tokens carry it, what equals rmw_zenoh's defaults left empty.

    >>> format_qos(QoSProfile(depth=10))
    '::,10:,:,:,,'
    """
    values = tuple(getattr(qos, name) for name in QoSProfile.__slots__)
    text = _QOS_TEXTS.get(values)
    if text is None:
        text = _formatted_qos(qos)
        if len(_QOS_TEXTS) < MOST_PROFILES:
            _QOS_TEXTS[values] = text
    return text


def _formatted_qos(qos: QoSProfile) -> str:
    full, usual = resolved(qos), _DEFAULTS
    depth = "" if full.depth == usual.depth else str(full.depth)
    return (
        f"{_unless(full.reliability, usual.reliability)}:{_unless(full.durability, usual.durability)}"
        f":{_unless(full.history, usual.history)},{depth}"
        f":{_format_span(full.deadline)}:{_format_span(full.lifespan)}"
        f":{_unless(full.liveliness, usual.liveliness)},{_format_span(full.liveliness_lease_duration)}"
    )


def parse_qos(text: str) -> QoSProfile:
    """Read the last field of an endpoint's token; raises WireError for anything else."""
    fields = [field.split(",") for field in text.split(":")] if len(text) <= LONGEST else []
    if [len(field) for field in fields] != [1, 1, 2, 2, 2, 3]:
        raise WireError(f"a QoS field looks like ::,10:,:,:,,, got {_shown(text)}")
    (reliability,), (durability,), (history, depth), deadline, lifespan, (liveliness, *lease) = fields
    return QoSProfile(
        history=_parsed_policy(history, HistoryPolicy, _DEFAULTS.history),
        depth=(_parsed_number(depth) if depth else 0) or _DEFAULTS.depth,
        reliability=_parsed_policy(reliability, ReliabilityPolicy, _DEFAULTS.reliability),
        durability=_parsed_policy(durability, DurabilityPolicy, _DEFAULTS.durability),
        lifespan=_parsed_span(lifespan),
        deadline=_parsed_span(deadline),
        liveliness=_parsed_policy(liveliness, LivelinessPolicy, _DEFAULTS.liveliness),
        liveliness_lease_duration=_parsed_span(lease),
    )


_DEFAULTS = resolved(qos_profile_system_default)

# A system has thousands of tokens and a handful of profiles, and reading those takes two thirds of the time.
MOST_PROFILES = 256
_shared_qos = functools.lru_cache(maxsize=MOST_PROFILES)(parse_qos)
_QOS_TEXTS: dict[tuple[Any, ...], str] = {}
"""Profiles, by their values, as tokens carry them: formatting one takes longer than all else of a token."""


def _unless(value: int, usual: int) -> str:
    return "" if value == usual else str(int(value))


def _format_span(span: Duration) -> str:
    if span == Infinite:
        return ","
    seconds, nanoseconds = divmod(span.nanoseconds, S_TO_NS)
    return f"{seconds},{nanoseconds}"


def _parsed_span(fields: list[str]) -> Duration:
    seconds, nanoseconds = divmod(Infinite.nanoseconds, S_TO_NS)
    if fields[0]:
        seconds = _parsed_number(fields[0])
    if fields[1]:
        nanoseconds = _parsed_number(fields[1])
    return Duration(nanoseconds=min(seconds * S_TO_NS + nanoseconds, Infinite.nanoseconds))


def _parsed_policy(text: str, kind: type[_PolicyT], usual: _PolicyT) -> _PolicyT:
    try:
        return kind(_parsed_number(text)) if text else usual
    except ValueError:
        raise WireError(f"{text} is no {kind.__name__}") from None


def _parsed_kind(text: str) -> EndpointKind:
    try:
        return EndpointKind(text)
    except ValueError:
        raise WireError(f"a token is of kind NN, MP, MS, SS or SC, got {_shown(text)}") from None


def _number(value: int) -> str:
    return _matched(_NUMBER, str(value), "a domain or entity number")


def _parsed_number(text: str) -> int:
    return int(_matched(_NUMBER, text, "a number"))


@_remembered
def _mangled(name: str) -> str:
    return _checked_name(name).replace("/", "%")


@_remembered
def _demangled(field: str) -> str:
    return _checked_name(field.replace("%", "/"))


def _checked_name(name: str) -> str:
    return _matched(_NAME, name, "a name")


def _checked_topic(name: str) -> str:
    return _matched(_TOPIC, name, "a full topic or service name")


@_remembered
def _checked_hash(text: str) -> str:
    return _matched(_HASH, text, "a type hash")


def _matched(pattern: re.Pattern[str], text: str, what: str) -> str:
    if pattern.fullmatch(_not_too_long(text, what)) is None:
        raise WireError(f"expected {what}, got {_shown(text)}")
    return text


def _not_too_long(text: str, what: str) -> str:
    if len(text) > LONGEST:
        raise WireError(f"{what} has at most {LONGEST} characters, got {len(text)}: {_shown(text)}")
    return text


def _shown(text: str) -> str:
    return repr(text if len(text) <= 120 else text[:120] + "…")
