"""Liveliness tokens of the ROS graph, by which nodes and endpoints announce themselves with their QoS profiles."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from enum import Enum, IntEnum
from typing import Any, NamedTuple, TypeVar

from robolink.constants import S_TO_NS
from robolink.duration import Duration, Infinite
from robolink.exceptions import WireError
from robolink.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_system_default,
    resolved,
)
from robolink.system.patterns import late
from robolink.text.names import join
from robolink.wire.keys import (
    CHUNK,
    LONGEST,
    NO_HASH,
    checked_hash,
    checked_topic,
    demangle_type,
    format_number,
    mangle_type,
    matched,
    not_too_long,
    parse_number,
    quoted,
    remembered,
)

_GRAPH = "@ros2_lv"
_NAME = late(rf"/?{CHUNK}(?:/{CHUNK})*|/")
_SESSION = late(r"[0-9a-f]{1,32}")
_FIELD = r"[^/*$?#]+"
_ID = late(_FIELD)
_MORE = late(rf"{_FIELD}(?:/{_FIELD})*")
_NODE, _NODE_FIELDS, _ENDPOINT_FIELDS = "NN", 9, 13
_ENDPOINT = late(
    rf"{_GRAPH}/(0|[1-9][0-9]{{0,18}})/([0-9a-f]{{1,32}})/({_FIELD})/({_FIELD})/(M[PS]|S[SC])"
    rf"/({_FIELD})/({_FIELD})/({_FIELD})/((?:%{CHUNK})+)/({_FIELD})/({_FIELD})/({_FIELD})"
)
"""Whole token of an endpoint without further fields: most tokens of a graph, read by one match."""

_BACKENDS = "backends:"
CPU_BACKEND = f"{_BACKENDS}cpu:"
"""Field that Lyrical adds to the token of an endpoint with a `uint8[]`: its memory backend, here main memory."""


class EndpointKind(Enum):
    """Kinds of endpoints of a node, with their spelling in tokens."""

    PUBLISHER = "MP"
    SUBSCRIPTION = "MS"
    SERVICE = "SS"
    CLIENT = "SC"

    __hash__ = object.__hash__  # Enum's own is Python, and each token of a graph is looked up by its kind


_KINDS = {kind.value: kind for kind in EndpointKind}

OTHER_END = {
    EndpointKind.PUBLISHER: EndpointKind.SUBSCRIPTION,
    EndpointKind.SUBSCRIPTION: EndpointKind.PUBLISHER,
    EndpointKind.SERVICE: EndpointKind.CLIENT,
    EndpointKind.CLIENT: EndpointKind.SERVICE,
}
"""Kind of the remote endpoint of each kind."""


class NodeToken(NamedTuple):
    """A node's announcement of itself."""

    domain: int
    session: str
    node_id: str
    """Id that is unique in its session: a number for rmw_zenoh, for others any text."""
    enclave: str
    namespace: str
    node_name: str
    more: str = ""
    """Further fields, of newer peers; "" if there are none."""

    @property
    def full_node_name(self) -> str:
        """Full name: namespace and name."""
        return join(self.namespace, self.node_name)


class EndpointToken(NamedTuple):
    """A node's announcement of a publisher, subscription, service or client that it owns."""

    domain: int
    session: str
    node_id: str
    endpoint_id: str
    """Id that is unique in its session, as the node's."""
    kind: EndpointKind
    enclave: str
    namespace: str
    node_name: str
    name: str
    """Fully qualified name of the topic or service."""
    type_name: str
    type_hash: str
    qos: QoSProfile
    more: str = ""
    """Further fields, such as CPU_BACKEND; "" if there are none."""

    @property
    def full_node_name(self) -> str:
        """Full name of the node that owns it: namespace and name."""
        return join(self.namespace, self.node_name)

    @property
    def names_backends(self) -> bool:
        """True if it names memory backends for its `uint8[]`, as Lyrical's endpoints of such types do."""
        return self.more.startswith(_BACKENDS)

    def understands(self, other: EndpointToken) -> bool:
        """True if both have the same type: by name and hash, or by name alone where one is a Humble peer's."""
        same_hash = self.type_hash == other.type_hash or NO_HASH in (self.type_hash, other.type_hash)
        return same_hash and self.type_name == other.type_name


_make_endpoint: Callable[[tuple[Any, ...]], EndpointToken] = functools.partial(tuple.__new__, EndpointToken)
"""Fast constructor of EndpointToken, whose own `__new__` is Python."""


def graph_pattern(domain: int | None = None) -> str:
    """Return the key expression that all tokens of a domain match; without one, those of all domains."""
    return f"{_GRAPH}/**" if domain is None else f"{_GRAPH}/{format_number(domain)}/**"


def own_tokens(domain: int, session: str) -> str:
    """Return the prefix of all tokens of a session on a domain."""
    return f"{_GRAPH}/{format_number(domain)}/{session}/"


def format_token(token: NodeToken | EndpointToken) -> str:
    """Return the text of a token; raises WireError for an invalid field."""
    endpoint = token if isinstance(token, EndpointToken) else None
    fields = [
        _GRAPH,
        format_number(token.domain),
        matched(_SESSION, token.session, "a session id"),
        matched(_ID, token.node_id, "a node's id"),
        matched(_ID, endpoint.endpoint_id if endpoint else token.node_id, "an endpoint's id"),
        endpoint.kind.value if endpoint else _NODE,
        *map(_mangled, (token.enclave or "/", token.namespace or "/", token.node_name)),
    ]
    if endpoint:
        fields += [_mangled(checked_topic(endpoint.name)), mangle_type(endpoint.type_name)]
        fields += [checked_hash(endpoint.type_hash), format_qos(endpoint.qos)]
    if token.more:
        fields.append(matched(_MORE, token.more, "further fields"))
    return not_too_long("/".join(fields), "a token")


def parse_token(text: str) -> NodeToken | EndpointToken:
    """Parse a token; raises WireError for any text that no peer of rmw_zenoh announces.

    Fields behind the known ones are kept, unread. Tokens share their profiles: copy one before you change it.
    """
    found = _ENDPOINT.fullmatch(text) if len(text) <= LONGEST else None
    return parsed_by_field(text) if found is None else _parsed_endpoint(*found.groups())


def _parsed_endpoint(
    domain: str,
    session: str,
    node_id: str,
    own_id: str,
    kind: str,
    enclave: str,
    namespace: str,
    node_name: str,
    name: str,
    dds_type: str,
    type_hash: str,
    qos: str,
) -> EndpointToken:
    """Return the token of fields whose letters are known to be right."""
    return _make_endpoint(
        (
            int(domain),
            sys.intern(session),
            node_id,
            own_id,
            _KINDS[kind],
            _demangled(enclave),
            _demangled(namespace),
            _demangled(node_name),
            name.replace("%", "/"),
            demangle_type(dds_type),
            checked_hash(type_hash),
            shared_qos(qos),
            "",
        )
    )


def parsed_by_field(text: str) -> NodeToken | EndpointToken:
    """Parse any token, or raise WireError that tells which field is wrong."""
    fields = not_too_long(text, "a token").split("/")
    is_node = fields[5:6] == [_NODE]
    known = _NODE_FIELDS if is_node else _ENDPOINT_FIELDS
    if len(fields) < known or fields[0] != _GRAPH:
        least = f"at least {_NODE_FIELDS} fields, or {_ENDPOINT_FIELDS} for an endpoint"
        raise WireError(f"a token has {least}, the first of them {_GRAPH}: got {quoted(text)}")
    domain, session = parse_number(fields[1]), sys.intern(matched(_SESSION, fields[2], "a session id"))
    node_id, own_id = matched(_ID, fields[3], "a node's id"), matched(_ID, fields[4], "an endpoint's id")
    enclave, namespace, node_name = map(_demangled, fields[6:9])
    more = matched(_MORE, "/".join(fields[known:]), "further fields") if len(fields) > known else ""
    if is_node:
        return NodeToken(domain, session, node_id, enclave, namespace, node_name, more)
    return EndpointToken(
        domain,
        session,
        node_id,
        own_id,
        _parsed_kind(fields[5]),
        enclave,
        namespace,
        node_name,
        checked_topic(_demangled(fields[9])),
        demangle_type(fields[10]),
        checked_hash(fields[11]),
        shared_qos(fields[12]),
        more,
    )


def _parsed_kind(text: str) -> EndpointKind:
    try:
        return EndpointKind(text)
    except ValueError:
        raise WireError(f"a token is of kind NN, MP, MS, SS or SC, got {quoted(text)}") from None


@remembered
def _mangled(name: str) -> str:
    return _checked_name(name).replace("/", "%")


@remembered
def _demangled(field: str) -> str:
    return _checked_name(field.replace("%", "/"))


def _checked_name(name: str) -> str:
    return matched(_NAME, name, "a name")


_PolicyT = TypeVar("_PolicyT", bound=IntEnum)


def format_qos(qos: QoSProfile) -> str:
    """Encode a profile for a token; values that equal rmw_zenoh's defaults are left empty.

    >>> format_qos(QoSProfile(depth=10))
    '::,10:,:,:,,'
    """
    values = tuple(_key(getattr(qos, name)) for name in QoSProfile.__slots__)
    text = _QOS_TEXTS.get(values)
    if text is None:
        text = _formatted_qos(qos)
        if len(_QOS_TEXTS) < MOST_PROFILES:
            _QOS_TEXTS[values] = text
    return text


def _key(value: Any) -> Any:
    """Return a hashable form of a policy's value, for a key of a dictionary: a Duration is not hashable."""
    return value.nanoseconds if isinstance(value, Duration) else value


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
    """Parse the QoS field of an endpoint's token; raises WireError for anything else."""
    fields = [field.split(",") for field in text.split(":")] if len(text) <= LONGEST else []
    if [len(field) for field in fields] != [1, 1, 2, 2, 2, 3]:
        raise WireError(f"a QoS field looks like ::,10:,:,:,,, got {quoted(text)}")
    (reliability,), (durability,), (history, depth), deadline, lifespan, (liveliness, *lease) = fields
    return QoSProfile(
        history=_parsed_policy(history, HistoryPolicy, _DEFAULTS.history),
        depth=(parse_number(depth) if depth else 0) or _DEFAULTS.depth,
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
shared_qos = functools.lru_cache(maxsize=MOST_PROFILES)(parse_qos)
"""`parse_qos` with an LRU cache: the same text gives the same, shared profile."""

_QOS_TEXTS: dict[tuple[Any, ...], str] = {}
"""Cache of encoded profiles, by their values: encoding one takes longer than the rest of a token."""


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
        seconds = parse_number(fields[0])
    if fields[1]:
        nanoseconds = parse_number(fields[1])
    return Duration(nanoseconds=min(seconds * S_TO_NS + nanoseconds, Infinite.nanoseconds))


def _parsed_policy(text: str, kind: type[_PolicyT], usual: _PolicyT) -> _PolicyT:
    try:
        return kind(parse_number(text)) if text else usual
    except ValueError:
        raise WireError(f"{text} is no {kind.__name__}") from None
