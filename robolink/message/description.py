"""Type descriptions: a type as data, its RIHS01 hash, and the message that carries it.

The description's form and the hash are REP 2016's: SHA-256 of the description as JSON in rosidl's spelling.
"""

from __future__ import annotations

from typing import Any

import msgspec

from robolink.message.annotations import FieldType, once_per_type
from robolink.message.base import Message

TYPE_IDS = {
    "int8": 2,
    "uint8": 3,
    "char": 3,  # a .msg file's char is an unsigned byte
    "int16": 4,
    "uint16": 5,
    "int32": 6,
    "uint32": 7,
    "int64": 8,
    "uint64": 9,
    "float32": 10,
    "float64": 11,
    "bool": 15,
    "byte": 16,
    "string": 17,
    "wstring": 18,
}
"""Ids of the primitives in type_description_interfaces/msg/FieldType."""
NESTED, BOUNDED_STRING = 1, 4
SHAPES = {"one": 0, "array": 48, "bounded": 96, "sequence": 144}
PLACEHOLDER = "structure_needs_at_least_one_member"
"""Name of the field that rosidl adds to an empty message, since C has no empty structs."""
HASHED = ("type_id", "capacity", "string_capacity", "nested_type_name")
"""Attributes of a field's type in the hash, beside its name and in this order."""


class FieldDescription(msgspec.Struct, frozen=True):
    """One field of a described type; the ids are type_description_interfaces/msg/FieldType's."""

    name: str
    type_id: int
    capacity: int = 0
    string_capacity: int = 0
    nested_type_name: str = ""
    default_value: str = ""
    """Default as rosidl writes it: Python's str of the value. It is not a part of the type and of its hash."""


class TypeDescription(msgspec.Struct, frozen=True):
    """One type and, by name, the types that it is made of."""

    type_name: str
    fields: tuple[FieldDescription, ...]
    referenced: tuple[TypeDescription, ...] = ()
    """All types reached from this one, sorted by name; each without references of its own."""


@once_per_type
def describe(cls: type[Message]) -> TypeDescription:
    """Return the description of the message class `cls`."""
    reached: dict[str, TypeDescription] = {}
    for kind in cls.__ros_fields__.values():
        if kind.message is not None:
            nested = describe(kind.message)
            reached.update({each.type_name: each for each in nested.referenced})
            reached[nested.type_name] = msgspec.structs.replace(nested, referenced=())
    fields = tuple(_field(name, kind, cls.__ros_defaults__) for name, kind in cls.__ros_fields__.items())
    fields = fields or (FieldDescription(PLACEHOLDER, TYPE_IDS["uint8"]),)
    return TypeDescription(cls.__ros_type__, fields, tuple(reached[name] for name in sorted(reached)))


def _field(name: str, kind: FieldType, defaults: dict[str, Any]) -> FieldDescription:
    nested = kind.message.__ros_type__ if kind.message is not None else ""
    type_id = NESTED if nested else TYPE_IDS[kind.base]
    if kind.string_bound:
        type_id += BOUNDED_STRING
    default = ""
    if name in defaults and not nested:
        from robolink.message.literals import as_rosidl_says  # late: few types state any

        default = as_rosidl_says(kind, defaults[name])
    return FieldDescription(name, type_id + SHAPES[kind.shape], kind.size, kind.string_bound, nested, default)


def described(cls: type[Any]) -> TypeDescription:
    """Return the description of a message, service or action class."""
    description: TypeDescription = describe(cls) if hasattr(cls, "__ros_fields__") else cls.describe()
    return description


def combine(type_name: str, parts: dict[str, type[Any]]) -> TypeDescription:
    """Return the description of a service or action: a type whose fields are its messages and services."""
    reached: dict[str, TypeDescription] = {}
    for cls in parts.values():
        part = described(cls)
        reached.update({each.type_name: each for each in part.referenced})
        reached[part.type_name] = msgspec.structs.replace(part, referenced=())
    fields = tuple(FieldDescription(name, NESTED, nested_type_name=cls.__ros_type__) for name, cls in parts.items())
    return TypeDescription(type_name, fields, tuple(reached[name] for name in sorted(reached)))


def hash_of(description: TypeDescription) -> str:
    """Return the RIHS01 hash of a description: ``RIHS01_`` and 64 hex digits."""
    import hashlib
    import json

    data = {
        "type_description": _plain(description),
        "referenced_type_descriptions": [_plain(each) for each in description.referenced],
    }
    text = json.dumps(data, separators=(", ", ": "))
    return "RIHS01_" + hashlib.sha256(text.encode()).hexdigest()


def _plain(description: TypeDescription) -> dict[str, Any]:
    fields = []
    for field in description.fields:
        kind = {name: getattr(field, name) for name in HASHED}
        fields.append({"name": field.name, "type": kind})
    return {"type_name": description.type_name, "fields": fields}


@once_per_type
def has_buffer_fields(cls: type[Any]) -> bool:
    """True if a message, or one inside it, has a field `uint8[]`: Lyrical sends such messages in another way.

    rosidl has the same function; its `rosidl::Buffer` may lie elsewhere than in main memory.
    """
    return any(
        (kind.shape == "sequence" and kind.base in ("uint8", "char"))
        or (kind.message is not None and has_buffer_fields(kind.message))
        for kind in cls.__ros_fields__.values()
    )


@once_per_type
def type_hash(cls: type[Any]) -> str:
    """Return the RIHS01 hash of `cls`, a message, service or action class."""
    from robolink.interfaces.standard import stated  # late: that package needs this one

    known = stated(cls)
    return hash_of(described(cls)) if known is None else known.type_hash


def type_name(cls: type[Any]) -> str:
    """Return the type name of `cls`, such as ``geometry_msgs/msg/Twist``."""
    return str(cls.__ros_type__)


def to_message(description: TypeDescription) -> Any:
    """Convert a description to a type_description_interfaces/msg/TypeDescription."""
    from robolink.interfaces.type_description_interfaces import msg

    return msg.TypeDescription(
        type_description=_individual(description),
        referenced_type_descriptions=[_individual(each) for each in description.referenced],
    )


def _individual(description: TypeDescription) -> Any:
    from robolink.interfaces.type_description_interfaces import msg

    fields = []
    for field in description.fields:
        kind = msg.FieldType(**{name: getattr(field, name) for name in HASHED})
        fields.append(msg.Field(name=field.name, type=kind, default_value=field.default_value))
    return msg.IndividualTypeDescription(type_name=description.type_name, fields=fields)


def from_message(message: Any) -> TypeDescription:
    """Convert a type_description_interfaces/msg/TypeDescription to a description, unchecked."""
    referenced = tuple(_from_individual(each) for each in message.referenced_type_descriptions)
    return msgspec.structs.replace(_from_individual(message.type_description), referenced=referenced)


def _from_individual(message: Any) -> TypeDescription:
    fields = []
    for field in message.fields:
        kind = {name: getattr(field.type, name) for name in HASHED}
        fields.append(FieldDescription(field.name, **kind, default_value=field.default_value))
    return TypeDescription(message.type_name, tuple(fields))
