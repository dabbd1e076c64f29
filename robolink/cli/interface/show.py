"""Look-up and output of types for `robolink interface`: as text, as a prototype in YAML, as data."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from robolink.cli.shared.messages import Style, as_yaml, plain
from robolink.exceptions import MessageError, NotFoundError, TransportError
from robolink.interfaces import KINDS, find, find_announced, is_named, names
from robolink.message import Message, to_builtins, type_hash
from robolink.message.definition import ELEMENT_LINE, SECTIONS, VALUE, parse
from robolink.message.text import text_of

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.message.annotations import FieldType
    from robolink.wire import EndpointToken

LONGEST = 255
"""Upper bound of a type's name, in characters: ROS 2's limit for all names."""


def type_named(name: str) -> type[Any]:
    """Return the class of a message, service or action type; one that is not installed is asked of nodes that use it.

    ``Twist``, ``geometry_msgs/Twist`` and ``geometry_msgs/msg/Twist`` mean the same. Raises NotFoundError with the
    nearest name, and MessageError for what is not a type name or means several types.
    """
    if len(name) > LONGEST:
        raise MessageError(f"'{name[:77]}...' is not a type name: it has {len(name)} characters")
    try:
        return _installed(name.replace(".", "/"))
    except NotFoundError as error:
        found = _from_graph(name.replace(".", "/"))
        if found is None:
            raise error from None
        return found


def _installed(name: str) -> type[Any]:
    if name.count("/") >= 2:
        return find_announced(name)
    found = []
    for kind in KINDS:
        try:
            found.append(find(name, kind))
        except NotFoundError:
            continue
    if len(found) > 1:
        candidates = " or ".join(each.__ros_type__ for each in found)
        raise MessageError(f"several types are named '{name}': say {candidates}")
    if not found:
        raise _unknown(name)
    return found[0]


def _unknown(name: str) -> NotFoundError:
    known = [each for kind in KINDS for each in names(kind)]
    package, slash, short = name.rpartition("/")
    packages = {each.partition("/")[0] for each in known}
    if slash and package not in packages:
        return NotFoundError("interface package", package, packages)
    return NotFoundError("type", short, _shorts(known, package), where=package)


def _shorts(known: list[str], package: str) -> set[str]:
    return {each.rpartition("/")[2] for each in known if not package or each.startswith(f"{package}/")}


def _from_graph(name: str) -> type[Any] | None:
    """Return a type's class from a running node that uses it; None if none does, or no network can be joined."""
    from robolink.cli.shared.session import opened
    from robolink.type_lookup import type_of
    from robolink.wire import EndpointKind

    try:
        with opened() as context:
            ends = context.graph.endpoints(*EndpointKind)
            for each in ends:
                if is_named(each.type_name, name):
                    return type_of(context, each)
            return _action_from_graph(context, name, ends)
    except TransportError:
        return None


def _action_from_graph(context: Context, name: str, ends: list[EndpointToken]) -> type[Any] | None:
    """Return an action's class, made of the types of its services and topic."""
    from robolink.message.class_factory import action_class
    from robolink.type_lookup import type_of

    parts, type_name = {}, ""
    for suffix, path in _ACTION.items():
        using = [
            each for each in ends if is_named(each.type_name.removesuffix(suffix), name) and suffix in each.type_name
        ]
        if not using:
            return None
        found = type_of(context, using[0])
        message, field = path
        holder = getattr(found, message) if message else found
        parts[field.capitalize()] = holder.__ros_fields__[field].message
        type_name = using[0].type_name.removesuffix(suffix)
    return action_class(type_name, parts, doc=None, text=None)


_ACTION = {
    "_SendGoal": ("Request", "goal"),
    "_GetResult": ("Response", "result"),
    "_FeedbackMessage": ("", "feedback"),
}
"""Parts of an action: the suffix of the service or topic that has it, the message there, and the field."""


def parts_of(cls: type[Any]) -> dict[str, type[Message]]:
    """Return the messages that a type's text describes, by name; of a message type only itself, under an empty name."""
    if hasattr(cls, "__ros_fields__"):
        return {"": cls}
    kind = "action" if hasattr(cls, "Goal") else "srv"
    short = [suffix.removeprefix("_") for suffix in SECTIONS[kind]]
    return {name.lower(): getattr(cls, name) for name in short}


def lines(cls: type[Any], *, comments: bool, nested_comments: bool, depth: int = 0) -> Iterator[str]:
    """Yield a type's text as ros2 shows it: below each field of a message type, indented, the fields of that."""
    text = text_of(cls).removesuffix("\n")
    nested: dict[int, type[Message] | None] = {}
    for section, message in zip(parse(text, cls.__ros_type__).sections, parts_of(cls).values(), strict=True):
        nested.update({each.line: message.__ros_fields__[each.name].message for each in section.fields})
    for number, line in enumerate(re.split(r"\r\n|\n|\r", text), 1):
        shown = line.rstrip() if comments else _without_comment(line)
        if shown or comments:
            yield f"{depth * chr(9)}{shown}" if shown else ""
        message_type = nested.get(number)
        if message_type is not None:
            yield from lines(message_type, comments=nested_comments, nested_comments=nested_comments, depth=depth + 1)


def _without_comment(line: str) -> str:
    """Return a line without its comment; a ``#`` within a quoted value begins none."""
    stripped = line.strip()
    found = ELEMENT_LINE.match(stripped)
    if stripped.startswith("#") or found is None:
        return ""
    start = found.start("rest") + len(re.match(r"=?\s*", found["rest"])[0])  # type: ignore[index]
    quoted = VALUE.fullmatch(stripped, start)
    end = quoted.end("value") if quoted else stripped.find("#", start)
    return stripped[: end if end >= 0 else None].rstrip()


def prototype(cls: type[Any]) -> str:
    """Return the YAML of a message, request or goal with its defaults."""
    first = next(iter(parts_of(cls).values()))
    return as_yaml(first(), Style(longest=None))


def as_data(cls: type[Any]) -> dict[str, Any]:
    """Return all properties of a type, as data for JSON."""
    nested = {each.__ros_type__: each for part in _all_parts(cls).values() for each in _reached(part)}
    return {
        **_described(cls),
        "nested": {name: _message(nested[name]) for name in sorted(nested)},
        "text": text_of(cls),
    }


def _described(cls: type[Any]) -> dict[str, Any]:
    if hasattr(cls, "__ros_fields__"):
        return _message(cls)
    data = {**_head(cls), "parts": {name: _message(each) for name, each in _all_parts(cls).items()}}
    if hasattr(cls, "Goal"):
        services = {"send_goal": cls.Impl.SendGoalService, "get_result": cls.Impl.GetResultService}
        data["services"] = {name: _described(each) for name, each in services.items()}
    return data


def _all_parts(cls: type[Any]) -> dict[str, type[Message]]:
    """Return the messages of a type by name, also those that its text does not describe."""
    more: dict[str, type[Message]] = {}
    if hasattr(cls, "Goal"):
        more = {"feedback_message": cls.Impl.FeedbackMessage}
    elif hasattr(cls, "Request"):
        more = {"event": cls.Event}
    return parts_of(cls) | more


def _head(cls: type[Any]) -> dict[str, Any]:
    return {"name": cls.__ros_type__, "kind": cls.__ros_type__.split("/")[1], "hash": type_hash(cls)}


def _message(cls: type[Message]) -> dict[str, Any]:
    defaults = to_builtins(cls())
    return {
        **_head(cls),
        "fields": [
            {"name": name, **_type(kind), **({} if kind.message else {"default": defaults[name]})}
            for name, kind in cls.__ros_fields__.items()
        ],
        "constants": [
            {"name": name, **_type(kind), "value": plain(value)}
            for name, (kind, value) in cls.__ros_constants__.items()
        ],
    }


def _type(kind: FieldType) -> dict[str, Any]:
    """Return a field's type as a .msg file writes it, and its parts: an array's size, bounds of sequence and string."""
    data: dict[str, Any] = {"type": str(kind), "base": kind.base, "shape": kind.shape}
    if kind.size:
        data["size"] = kind.size
    if kind.string_bound:
        data["string_bound"] = kind.string_bound
    return data


def _reached(cls: type[Message]) -> Iterator[type[Message]]:
    """Yield the message types that a message is made of, recursively."""
    for kind in cls.__ros_fields__.values():
        if kind.message is not None:
            yield kind.message
            yield from _reached(kind.message)
