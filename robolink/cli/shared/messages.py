"""Messages on the command line: the class of a topic, messages in YAML that somebody typed, and output."""

from __future__ import annotations

import contextlib
import math
import re
import sys
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.cli.shared.output import tell
from robolink.exceptions import EncodeError, MessageError, NotFoundError, RobolinkError, nearest
from robolink.interfaces import find, is_named
from robolink.message import type_hash
from robolink.message.show import LONGEST, USUAL, Style, as_csv, as_yaml, plain
from robolink.type_lookup import type_of
from robolink.wire import NO_HASH, EndpointKind, EndpointToken

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.message import Action, FieldType, Message


class SeveralTypesError(RobolinkError, ValueError):
    """A topic, service or action has several types, and none was named."""


def message_type(context: Context, topic: str, given: str = "") -> type[Any]:
    """Return the message class of a topic, named in full: the type `given`, else the one that it has now.

    A type that is not installed, or is another one here than on the topic, is asked of the nodes that use it.
    Raises NotFoundError if there is no such type or topic, SeveralTypesError, and what `type_of` raises.
    """
    ends = context.graph.endpoints(EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
    return _chosen(context, ends, "msg", topic, given)


def service_type(context: Context, service: str, given: str = "") -> type[Any]:
    """Return the service class of a service, as `message_type` does for a topic."""
    return _chosen(context, context.graph.endpoints(EndpointKind.SERVICE), "srv", service, given)


def action_type(context: Context, action: str, given: str = "") -> type[Action]:
    """Return the action class of an action that is served, as `message_type` does for a topic."""
    from robolink.graph.action_names import GOAL_TYPE, SEND_GOAL, part_name

    ends = context.graph.endpoints(EndpointKind.SERVICE, name=part_name(action, SEND_GOAL))
    served = {each.type_name.removesuffix(GOAL_TYPE) for each in ends}
    types = sorted(each for each in served if not given or is_named(each, given))
    if len(types) > 1:
        raise SeveralTypesError(f"{action} has several types: say which, {' or '.join(types)}")
    found: type[Action] = _action_of(context, action, types[0]) if types else find(given, "action")
    return found


def _action_of(context: Context, action: str, type_: str) -> type[Action]:
    """Return an action's class, which the graph knows by its parts only: the installed one if it has these parts."""
    from robolink.graph.action_names import FEEDBACK, GET_RESULT, SEND_GOAL
    from robolink.message.class_factory import action_class

    goal = type_of(context, _part(context, action, SEND_GOAL, EndpointKind.SERVICE))
    result = type_of(context, _part(context, action, GET_RESULT, EndpointKind.SERVICE))
    feedback = type_of(context, _part(context, action, FEEDBACK, EndpointKind.PUBLISHER))
    with contextlib.suppress(NotFoundError):
        installed: type[Action] = find(type_, "action")
        if _parts_of(installed) == (goal, result, feedback):
            return installed
    fields = {"Goal": (goal.Request, "goal"), "Result": (result.Response, "result"), "Feedback": (feedback, "feedback")}
    try:
        parts = {part: cls.__ros_fields__[name].message for part, (cls, name) in fields.items()}
    except KeyError as error:
        raise MessageError(f"{action} is not an action: a part of it has no field {error}") from None
    made = action_class(type_, parts, doc=None, text=None)
    if [*map(type_hash, _parts_of(made))] != [*map(type_hash, (goal, result, feedback))]:
        raise MessageError(f"{action} is not of type {type_}: its parts do not belong together")
    return made


def _parts_of(action: type[Action]) -> tuple[type[Any], ...]:
    return action.Impl.SendGoalService, action.Impl.GetResultService, action.Impl.FeedbackMessage


def _part(context: Context, action: str, part: str, kind: EndpointKind) -> EndpointToken:
    from robolink.graph.action_names import part_name

    name = part_name(action, part)
    found = context.graph.endpoints(kind, name=name)
    if not found:
        raise NotFoundError("part of an action", name, where=f"domain {context.get_domain_id()}")
    return found[0]


def _chosen(context: Context, ends: list[EndpointToken], kind: str, name: str, given: str) -> type[Any]:
    here = [each for each in ends if each.name == name]
    if given:
        return _given(context, here, kind, given)
    types = sorted({each.type_name for each in here})
    if not types:
        noun = "topic" if kind == "msg" else "service"
        raise NotFoundError(noun, name, {each.name for each in ends}, f"domain {context.get_domain_id()}")
    if len(types) > 1:
        raise SeveralTypesError(f"{name} has several types: say which, {' or '.join(types)}")
    return type_of(context, _first(here))


def _given(context: Context, here: list[EndpointToken], kind: str, given: str) -> type[Any]:
    """Return the class of a named type; if the topic has a version of it that is not installed, that one."""
    try:
        installed = find(given, kind)
    except NotFoundError:
        same = [each for each in here if is_named(each.type_name, given)]
        if not same:
            raise
        return type_of(context, _first(same))
    same = [each for each in here if each.type_name == installed.__ros_type__]
    if not same or {each.type_hash for each in same} & {NO_HASH, type_hash(installed)}:
        return installed
    return type_of(context, _first(same))


def _first(ends: Iterable[EndpointToken]) -> EndpointToken:
    """Return the endpoint whose type is looked up: a publisher rather than a subscription."""
    return min(ends, key=lambda each: each.kind is EndpointKind.SUBSCRIPTION)


_TYPE = re.compile(r"[A-Za-z]\w*(?:[/.][A-Za-z]\w*){0,2}", re.ASCII)


class InputError(RobolinkError, ValueError):
    """Standard input is closed, or is not text."""


class GivenRequest(NamedTuple):
    """Request to a service, or goal for an action, as it was given on the command line."""

    name: str
    """Full name of the service or action, with its leading slash."""
    type_: str
    """Type as it was given; empty to take the one that the graph shows."""
    values: str
    """Request or goal in YAML."""


def is_type(text: str) -> bool:
    """True if a text can name a type: then it is not YAML of a message."""
    return _TYPE.fullmatch(text) is not None


def read_stdin(what: str) -> str:
    """Return standard input, which is a `what`: "request" or "goal". Raises InputError if it is not text."""
    if sys.stdin is None:
        raise InputError("--stdin: there is no standard input")
    if sys.stdin.isatty():
        tell(f"the {what} in YAML, and Ctrl-D at its end:" if sys.platform != "win32" else f"the {what}, then Ctrl-Z:")
    try:
        return sys.stdin.read()
    except UnicodeDecodeError as error:
        raise InputError(f"--stdin: expected text in UTF-8: {error.reason} at byte {error.start}") from None


def message_of(msg_type: type[Any], values: str) -> Any:
    """Return a message with the values in YAML. Raises DocumentError or EncodeError with the place of a mistake."""
    from robolink.documents.yamlfile import parse
    from robolink.message import encode, from_builtins

    given = parse(values, name="<values>")
    message = from_builtins(msg_type, {} if given is None else given)
    encode(message)
    return message


__all__ = ["LONGEST", "USUAL", "Style", "as_csv", "as_json", "as_yaml", "check_path", "field_of", "plain"]

_STEP = re.compile(r"(?P<name>[A-Za-z]\w*)|\[(?P<index>-?\d{1,18})\]", re.ASCII)


def as_json(value: Any) -> str:
    """Return a value as one line of JSON. Infinity is written 1e999, which readers take as infinite, and NaN null."""
    import msgspec

    return msgspec.json.encode(_finite(plain(value))).decode()


def field_of(message: Any, path: str) -> Any:
    """Return the field ``linear.x`` or ``ranges[0]`` of a message. Raises EncodeError that names what there is."""
    check_path(type(message), path)
    value = message
    for step in _steps(path):
        try:
            value = getattr(value, step) if isinstance(step, str) else value[step]
        except IndexError:
            raise EncodeError(f"--field {path}: there are {len(value)} elements, no [{step}]") from None
    return value


def check_path(msg_type: type[Message], path: str) -> FieldType:
    """Return the type of a field ``linear.x`` or ``ranges[0]``. Raises EncodeError if the message has no such field."""
    from robolink.message import FieldType

    kind = FieldType(base=msg_type.__ros_type__, message=msg_type)
    for step in _steps(path):
        is_sequence = kind.shape != "one"
        if isinstance(step, int):
            if not is_sequence:
                raise EncodeError(f"--field {path}: what stands before [{step}] is not a sequence")
            kind = FieldType(base=kind.base, message=kind.message, string_bound=kind.string_bound)
            continue
        fields = {} if kind.message is None or is_sequence else kind.message.__ros_fields__
        if step not in fields:
            there = "it is a sequence: say which, as in [0]" if is_sequence else f"there is {_listed(fields)}"
            raise EncodeError(f"--field {path}: no field '{step}'{nearest(step, fields)}; {there}")
        kind = fields[step]
    return kind


def _steps(path: str) -> list[str | int]:
    steps: list[str | int] = []
    at = 0
    for match in _STEP.finditer(path):
        if path[at : match.start()] != ("." if match["name"] and at else ""):
            break
        steps.append(match["name"] or int(match["index"]))
        at = match.end()
    if at != len(path) or not path:
        raise EncodeError(f"--field: expected a path such as linear.x or ranges[0], got '{path}'")
    return steps


def _listed(fields: Iterable[str]) -> str:
    return ", ".join(fields) or "nothing in it"


def _finite(data: Any) -> Any:
    import msgspec

    if isinstance(data, float) and not math.isfinite(data):
        return None if math.isnan(data) else msgspec.Raw(b"1e999" if data > 0 else b"-1e999")
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    if isinstance(data, list):
        return [_finite(each) for each in data]
    return data
