"""How rmw_zenoh names things on the wire: keys of topics and services, tokens of the graph, attachments."""

from robolink.wire.attachment import (
    ATTACHMENT_BYTES,
    GID_BYTES,
    Attachment,
    attachments,
    gid_of,
    pack_attachment,
    unpack_attachment,
)
from robolink.wire.keys import NO_HASH, DataKey, buffer_key, demangle_type, format_key, mangle_type, parse_key
from robolink.wire.profiles import format_qos, parse_qos
from robolink.wire.text import LONGEST
from robolink.wire.tokens import (
    CPU_BACKEND,
    OTHER_END,
    EndpointKind,
    EndpointToken,
    NodeToken,
    format_token,
    graph_pattern,
    own_tokens,
    parse_token,
)

__all__ = [
    "ATTACHMENT_BYTES",
    "CPU_BACKEND",
    "GID_BYTES",
    "LONGEST",
    "NO_HASH",
    "OTHER_END",
    "Attachment",
    "DataKey",
    "EndpointKind",
    "EndpointToken",
    "NodeToken",
    "attachments",
    "buffer_key",
    "demangle_type",
    "format_key",
    "format_qos",
    "format_token",
    "gid_of",
    "graph_pattern",
    "mangle_type",
    "own_tokens",
    "pack_attachment",
    "parse_key",
    "parse_qos",
    "parse_token",
    "unpack_attachment",
]
