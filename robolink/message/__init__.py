"""Messages: the base class, ROS's field types as annotations, and the CDR codec."""

from robolink.message.action import Action, action_type
from robolink.message.annotations import (
    AtMost,
    FieldType,
    Sequence,
    Size,
    boolean,
    byte,
    char,
    float32,
    float64,
    int8,
    int16,
    int32,
    int64,
    string,
    uint8,
    uint16,
    uint32,
    uint64,
    wstring,
)
from robolink.message.base import Message, message_type
from robolink.message.cdr import buffers_encoder, decode, decoder, encode, encoder
from robolink.message.convert import from_builtins, to_builtins
from robolink.message.description import describe, type_hash, type_name
from robolink.message.numbers import import_numpy_for
from robolink.message.service import Service, service_type

__all__ = [
    "Action",
    "AtMost",
    "FieldType",
    "Message",
    "Sequence",
    "Service",
    "Size",
    "action_type",
    "boolean",
    "buffers_encoder",
    "byte",
    "char",
    "decode",
    "decoder",
    "describe",
    "encode",
    "encoder",
    "float32",
    "float64",
    "from_builtins",
    "import_numpy_for",
    "int8",
    "int16",
    "int32",
    "int64",
    "message_type",
    "service_type",
    "string",
    "to_builtins",
    "type_hash",
    "type_name",
    "uint8",
    "uint16",
    "uint32",
    "uint64",
    "wstring",
]
