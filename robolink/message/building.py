"""Building of classes from the text of a type (.msg, .srv, .action) or from the description that a node sent."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec

from robolink.exceptions import DefinitionError, MessageError, NotFoundError
from robolink.message import literals
from robolink.message.annotations import FieldType
from robolink.message.base import Message
from robolink.message.class_factory import DEEPEST, MessageParts, action_class, message_class, service_class
from robolink.message.definition import LARGEST, Definition, Field, Section
from robolink.message.description import (
    BOUNDED_STRING,
    NESTED,
    PLACEHOLDER,
    SHAPES,
    TYPE_IDS,
    FieldDescription,
    TypeDescription,
    described,
    hash_of,
    type_hash,
)
from robolink.message.spelling import is_part, split_type_name, wrong_name
from robolink.system.terminal import shown

Resolve = Callable[[str], type[Message]]
"""Function from a full type name to its message class; raises NotFoundError or MessageError if there is none."""


def build(definition: Definition, resolve: Resolve) -> type[Any]:
    """Return the message, service or action class of a definition.

    `resolve` returns the classes of nested messages by their full names. Raises DefinitionError, with the place in the
    text, for one that it does not know.
    """
    if len(definition.sections) == 1:
        return _section_class(definition, definition.sections[0], definition.text, resolve)
    classes = [_section_class(definition, section, section.text, resolve) for section in definition.sections]
    type_name, doc = definition.type_name, _doc(definition.sections[0])
    if len(classes) == 2:
        return service_class(type_name, classes[0], classes[1], doc, definition.text)
    parts = dict(zip(("Goal", "Result", "Feedback"), classes, strict=True))
    return action_class(type_name, parts, doc, definition.text)


def _section_class(definition: Definition, section: Section, text: str | None, resolve: Resolve) -> type[Message]:
    fields = {each.name: _resolved(definition, each, resolve) for each in section.fields}
    defaults = {each.name: each.default for each in section.fields if each.default is not None}
    constants = {each.name: (each.type, each.value) for each in section.constants}
    try:
        return message_class(MessageParts(section.type_name, fields, defaults, constants, _doc(section), text))
    except MessageError as error:
        raise DefinitionError(f"{definition.origin}: {error}") from None


def _doc(section: Section) -> str | None:
    return "\n".join(section.comment) or None


def _resolved(definition: Definition, field: Field, resolve: Resolve) -> FieldType:
    if field.type.base in TYPE_IDS:
        return field.type
    try:
        found = _look_up(field.type.base, resolve)
    except DefinitionError:
        raise
    except (NotFoundError, MessageError) as error:
        raise DefinitionError(f"{definition.origin}:{field.line}:{field.column}: {error}") from None
    return msgspec.structs.replace(field.type, message=found)


def _look_up(name: str, resolve: Resolve) -> type[Message]:
    """Return a nested message's class: a bare ``Header`` is the package's own, as for rosidl, else std_msgs'."""
    # Files from ROS 1 mean std_msgs' by it.
    try:
        return resolve(name)
    except NotFoundError:
        if not name.endswith("/msg/Header"):
            raise
    return resolve("std_msgs/msg/Header")


SERVICE_FIELDS = {"request_message": "_Request", "response_message": "_Response", "event_message": "_Event"}
ACTION_FIELDS = {
    "goal": "_Goal",
    "result": "_Result",
    "feedback": "_Feedback",
    "send_goal_service": "_SendGoal",
    "get_result_service": "_GetResult",
    "feedback_message": "_FeedbackMessage",
}
UNSUPPORTED = {
    12: "long double",
    13: "IDL char",
    14: "wchar",
    19: "fixed string",
    20: "fixed wstring",
}
"""Names of the type ids that type_description_interfaces has and no .msg file can have."""
MOST_TYPES, MOST_FIELDS = 1_000, 20_000
"""Of one description: types that it refers to, and fields of them all."""


def checked_class(description: TypeDescription, expected_hash: str, resolve: Resolve | None = None) -> type[Any]:
    """Return the class of a description whose hash is the expected one (``RIHS01_...``).

    Raises MessageError that names both hashes if it is not, and for what class_of_description refuses.
    """
    found = hash_of(description)
    if found != expected_hash:
        name = shown(description.type_name)
        raise MessageError(f"the description of {name} has the hash {found}, not {expected_hash[:100]}")
    return class_of_description(description, resolve)


def class_of_description(description: TypeDescription, resolve: Resolve | None = None) -> type[Any]:
    """Return the message, service or action class of a description.

    Where `resolve` returns a class that is the same as a referenced one (by hash), that class is used. Raises
    MessageError for a description that is contradictory, cyclic, too large, or uses names or types that no .msg file
    can have. Nothing in it is taken on trust.
    """
    maker = _Maker(description, resolve)
    made = maker.top()
    difference = _difference(description, described(made))
    if difference:
        raise MessageError(f"the description of {description.type_name} contradicts itself: {difference}")
    return made


class _Maker:
    """Builder of the classes of one description, each referenced type once."""

    def __init__(self, description: TypeDescription, resolve: Resolve | None) -> None:
        self.description, self.resolve = description, resolve
        split_type_name(description.type_name)
        self.types = {description.type_name: description}
        self.made: dict[str, type[Message]] = {}
        self.under_way: list[str] = []
        fields = len(description.fields)
        if len(description.referenced) > MOST_TYPES:
            raise MessageError(f"a description that refers to {len(description.referenced)} types, over {MOST_TYPES}")
        for each in description.referenced:
            split_type_name(each.type_name)
            if each.type_name in self.types:
                raise MessageError(f"{each.type_name} is described twice")
            self.types[each.type_name] = each
            fields += len(each.fields)
        if fields > MOST_FIELDS:
            raise MessageError(f"a description of {fields} fields, over {MOST_FIELDS}")

    def top(self) -> type[Any]:
        """Return the class that is asked for."""
        name = self.description.type_name
        if self._consists_of(SERVICE_FIELDS):
            request, response = (self.message(f"{name}_{part}") for part in ("Request", "Response"))
            return service_class(name, request, response, doc=None, text=None)
        if self._consists_of(ACTION_FIELDS):
            parts = {part: self.message(f"{name}_{part}") for part in ("Goal", "Result", "Feedback")}
            return action_class(name, parts, doc=None, text=None)
        return self.message(name)

    def _consists_of(self, parts: dict[str, str]) -> bool:
        """True if the fields are those of a service or an action, and their types its own parts."""
        name = self.description.type_name
        expected = [(field, name + suffix) for field, suffix in parts.items()]
        return [(field.name, field.nested_type_name) for field in self.description.fields] == expected

    def message(self, name: str) -> type[Message]:
        """Return the class of a described message, after those of its fields."""
        if name in self.made:
            return self.made[name]
        if name not in self.types:
            raise MessageError(f"{self._user()} refers to {shown(name)}, which is not described")
        _, kind, short = split_type_name(name)
        if kind != "msg" and not is_part(kind, short):
            raise MessageError(f"{name} is described as a message, which no {kind} type is")
        if name in self.under_way:
            circle = " -> ".join([*self.under_way[self.under_way.index(name) :], name])
            raise MessageError(f"a message cannot contain itself: {circle}")
        if len(self.under_way) > DEEPEST:
            raise MessageError(f"{self.description.type_name} has messages within messages over {DEEPEST} deep")
        self.under_way.append(name)
        self.made[name] = self._known(self._message_class(self.types[name]))
        self.under_way.pop()
        return self.made[name]

    def _user(self) -> str:
        return self.under_way[-1] if self.under_way else self.description.type_name

    def _known(self, made: type[Message]) -> type[Message]:
        """Return the class that this process already has of the same type, or else the one just made."""
        if self.resolve is None or made.__ros_type__ == self.description.type_name:
            return made
        try:
            known = self.resolve(made.__ros_type__)
        except (NotFoundError, MessageError):
            return made
        return known if hasattr(known, "__ros_fields__") and type_hash(known) == type_hash(made) else made

    def _message_class(self, description: TypeDescription) -> type[Message]:
        fields: dict[str, FieldType] = {}
        defaults: dict[str, Any] = {}
        placeholder = (FieldDescription(PLACEHOLDER, TYPE_IDS["uint8"]),)
        for field in description.fields if description.fields != placeholder else ():
            where = f"{description.type_name}.{shown(field.name)}"
            wrong = wrong_name("field", field.name)
            if wrong:
                raise MessageError(f"{description.type_name}: {wrong}")
            if field.name in fields:
                raise MessageError(f"{where} is described twice")
            fields[field.name] = kind = self._field_type(field, where)
            if field.default_value and kind.message is None:
                defaults.update(_default(field, kind))
        return message_class(MessageParts(description.type_name, fields, defaults, {}))

    def _field_type(self, field: FieldDescription, where: str) -> FieldType:
        base, shape, bounded = _kind(field.type_id, where)
        if (base == "") != bool(field.nested_type_name):
            nested = shown(field.nested_type_name)
            raise MessageError(f"{where}: type id {field.type_id} with the nested type '{nested}'")
        sizes = {"size": field.capacity, "string_bound": field.string_capacity}
        for what, expected in (("size", shape in ("array", "bounded")), ("string_bound", bounded)):
            if not (0 < sizes[what] <= LARGEST if expected else sizes[what] == 0):
                raise MessageError(f"{where}: type id {field.type_id} with a {what.replace('_', ' ')} of {sizes[what]}")
        message = None if base else self.message(field.nested_type_name)
        return FieldType(base=base or field.nested_type_name, message=message, shape=shape, **sizes)


def _kind(type_id: int, where: str) -> tuple[str, str, bool]:
    """Return the primitive's name (empty for a message), the shape, and True for a bounded string."""
    if not 0 < type_id < 192:
        raise MessageError(f"{where}: there is no type id {type_id}")
    offset = type_id // 48 * 48
    shape = next(name for name, value in SHAPES.items() if value == offset)
    code = type_id - offset
    if code == NESTED:
        return "", shape, False
    for name in ("string", "wstring"):
        if code == TYPE_IDS[name] + BOUNDED_STRING:
            return name, shape, True
    found = [name for name, value in TYPE_IDS.items() if value == code]
    if not found:
        what = UNSUPPORTED.get(code)
        raise MessageError(f"{where}: {what} is not supported" if what else f"{where}: there is no type id {type_id}")
    return found[0], shape, False


def _default(field: FieldDescription, kind: FieldType) -> dict[str, Any]:
    """Return a field's default. It is not a part of the type and its hash: one that does not fit is left out."""
    try:
        return {field.name: literals.as_rosidl_said(kind, field.default_value)}
    except ValueError:
        return {}


def _difference(given: TypeDescription, right: TypeDescription) -> str:
    """Return where a description differs from that of its class; '' if it does not."""
    if hash_of(given) == hash_of(right):
        return ""
    names, right_names = ([each.type_name for each in one.referenced] for one in (given, right))
    if names != right_names:
        odd = sorted(set(names) ^ set(right_names))
        return f"{odd[0]} is {'missing' if odd[0] in right_names else 'not used'}" if odd else "types are not sorted"
    pairs = zip((given, *given.referenced), (right, *right.referenced), strict=True)
    bare = ((one, msgspec.structs.replace(one, referenced=()), other) for one, other in pairs)
    for one, lone, other in bare:
        if hash_of(lone) != hash_of(msgspec.structs.replace(other, referenced=())):
            return f"{one.type_name} is not what it is elsewhere"
    return "its types do not add up"
