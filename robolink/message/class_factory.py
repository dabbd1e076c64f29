"""Factory of message, service and action classes whose fields are known at run time only."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, ClassVar, NamedTuple

import msgspec

from robolink.exceptions import MessageError
from robolink.message import annotations as ros
from robolink.message.action import Action
from robolink.message.annotations import AtMost, FieldType, Primitive, Sequence, Size, once_per_type
from robolink.message.base import Message, MessageMeta
from robolink.message.cdr_layout import SIZES
from robolink.message.service import DeferredPart, Service
from robolink.message.spelling import split_type_name

PRIMITIVES: dict[str, Any] = {
    mark.name: annotation
    for annotation in vars(ros).values()
    for mark in getattr(annotation, "__metadata__", ())
    if isinstance(mark, Primitive)
}
"""Annotations of the primitives, by name."""
MOST_LEAVES, DEEPEST, MOST_LOOPS, MOST_BYTES = 4_000, 48, 16, 2**26
"""Limits of a class: primitive fields in all, messages within messages, sequences of messages within each other
(Python nests 20 blocks, and the codec needs some), and bytes that an instance takes when it is made."""
OVERHEAD = 64
"""Approximate size of a Python object in bytes."""


class Weight(NamedTuple):
    """Size of a message class; see MOST_LEAVES."""

    leaves: int = 0
    depth: int = 0
    loops: int = 0
    octets: int = OVERHEAD


@once_per_type
def weight(cls: type[Message]) -> Weight:
    """Return the size of a class: what its codec and its instances take."""
    return _sum(cls.__ros_fields__)


def _sum(fields: dict[str, FieldType]) -> Weight:
    each = [_weight(kind) for kind in fields.values()]
    return Weight(
        leaves=sum(one.leaves for one in each),
        depth=1 + max((one.depth for one in each), default=0),
        loops=max((one.loops for one in each), default=0),
        octets=OVERHEAD + sum(one.octets for one in each),
    )


def _weight(kind: FieldType) -> Weight:
    one = weight(kind.message) if kind.message is not None else Weight(leaves=1)
    if kind.shape == "one":
        return one
    if kind.code is not None:
        return one._replace(octets=OVERHEAD + (kind.size * SIZES[kind.code] if kind.shape == "array" else 0))
    count = kind.size if kind.shape == "array" else 0
    return one._replace(loops=one.loops + 1, octets=OVERHEAD + count * one.octets)


def _refuse_giants(type_name: str, fields: dict[str, FieldType]) -> None:
    """Raise MessageError for a type that would take all memory, or a codec longer than Python compiles."""
    found = _sum(fields)
    if found.leaves > MOST_LEAVES:
        raise MessageError(f"{type_name} has {found.leaves} fields with those of its messages; at most {MOST_LEAVES}")
    if found.depth > DEEPEST or found.loops > MOST_LOOPS:
        raise MessageError(
            f"{type_name} has messages within messages {found.depth} deep, sequences of them {found.loops} deep;"
            f" at most {DEEPEST} and {MOST_LOOPS}"
        )
    if found.octets > MOST_BYTES:
        raise MessageError(f"{type_name} has fixed arrays of {found.octets} bytes in all; at most {MOST_BYTES}")


class MessageParts(msgspec.Struct):
    """Parts of a message class; the messages in `fields` are classes, and all names have been checked."""

    type_name: str
    fields: dict[str, FieldType]
    defaults: dict[str, Any]
    constants: dict[str, tuple[FieldType, Any]]
    doc: str | None = None
    text: str | None = None
    """The .msg text that it came from."""


def message_class(parts: MessageParts) -> type[Message]:
    """Create a message class. Raises MessageError if it would be too large to use."""
    _refuse_giants(parts.type_name, parts.fields)
    annotations = {name: _annotation(kind) for name, kind in parts.fields.items()}
    body = {**_body(parts.type_name, parts.doc, parts.text), "__annotations__": annotations}
    for name, (kind, value) in parts.constants.items():
        annotations[name] = ClassVar[_annotation(kind)]
        body[name] = _held(kind, value)
    body.update({name: _held(parts.fields[name], value) for name, value in parts.defaults.items()})
    made: type[Message] = MessageMeta(body["__qualname__"], (Message,), body, type_name=parts.type_name)
    return made


def service_class(
    type_name: str, request: type[Message], response: type[Message], doc: str | None, text: str | None
) -> type[Service]:
    """Create a service class of its two messages."""
    body = {**_body(type_name, doc, text), "Request": request, "Response": response}
    return type(body["__qualname__"], (Service,), body)


def deferred_service_class(type_name: str, make: Callable[[type[Service]], object]) -> type[Service]:
    """Create a service class that gets its messages from `make`, by `complete_service`, when one is asked for."""
    body = _body(type_name, None, None) | {name: DeferredPart(make, name) for name in DEFERRED}
    return type(body["__qualname__"], (Service,), body, deferred=type_name)


def complete_service(service: Any, made: type[Service]) -> None:
    """Set the attributes of a deferred service class to those of another class of the same type."""
    for name in DEFERRED:
        setattr(service, name, vars(made)[name])
    for part in (made.Request, made.Response):
        part.__module__ = service.__module__


def is_deferred(service: type[Service]) -> bool:
    """True if a service class has no messages yet."""
    return isinstance(vars(service)["Request"], DeferredPart)


DEFERRED = ("__doc__", "__ros_text__", "Request", "Response")
"""Attributes of a service class that are made when one of them is asked for."""


def action_class(type_name: str, parts: dict[str, type[Message]], doc: str | None, text: str | None) -> type[Action]:
    """Create an action class of its parts ``Goal``, ``Result`` and ``Feedback``."""
    body = {**_body(type_name, doc, text), **parts}
    return type(body["__qualname__"], (Action,), body)


def _body(type_name: str, doc: str | None, text: str | None) -> dict[str, Any]:
    package, kind, short = split_type_name(type_name)
    return {"__module__": f"{package}.{kind}", "__qualname__": short, "__doc__": doc, "__ros_text__": text}


def _annotation(kind: FieldType) -> Any:
    element = kind.message if kind.message is not None else PRIMITIVES[kind.base]
    if kind.string_bound:
        element = Annotated[element, AtMost(kind.string_bound)]
    if kind.shape == "one":
        return element
    sequence: Any = Sequence[element]  # type: ignore[valid-type] # made at run time
    if kind.shape == "sequence":
        return sequence
    return Annotated[sequence, (Size if kind.shape == "array" else AtMost)(kind.size)]


def _held(kind: FieldType, value: Any) -> Any:
    """Return a value as messages hold it: a byte is a bytes object of length one."""
    if kind.base != "byte":
        return value
    return bytes((value,)) if kind.shape == "one" else [bytes((each,)) for each in value]
