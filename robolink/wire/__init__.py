"""rmw_zenoh's wire format: keys of topics and services, tokens of the graph, attachments."""

from robolink.wire.attachment import (
    GID_BYTES,
    Attachment,
    attachments,
    check_attachment,
    fields_of,
    gid_in,
    gid_of,
    is_attachment,
    pack_attachment,
    pair_opener,
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
    "GID_BYTES",
    "CPU_BACKEND",
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
    "check_attachment",
    "fields_of",
    "demangle_type",
    "format_key",
    "format_qos",
    "format_token",
    "gid_in",
    "gid_of",
    "graph_pattern",
    "is_attachment",
    "mangle_type",
    "own_tokens",
    "pack_attachment",
    "pair_opener",
    "parse_key",
    "parse_qos",
    "parse_token",
    "unpack_attachment",
]
