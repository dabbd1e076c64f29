"""Types of the topics of a bag: the installed ones, or built from the definitions that the bag carries."""

from __future__ import annotations

from typing import Any

from robolink.bag.definition import SEPARATOR
from robolink.bag.topic import BagTopic
from robolink.exceptions import DefinitionError, NotFoundError, RobolinkError
from robolink.interfaces import find_announced
from robolink.message import Message, type_hash
from robolink.message.building import build
from robolink.message.definition import parse

PART = "MSG: "
DEEPEST = 32
"""Most types that may be nested in one another."""


def class_of(topic: BagTopic) -> type[Any] | None:
    """Return the message class by which a topic's messages are published; None where only its bytes are known.

    That is the installed one, unless the bag's messages are of another type of this name.
    """
    installed = _installed(topic.type_name)
    if installed is not None and topic.type_hash in ("", type_hash(installed)):
        return installed
    recorded = _recorded(topic)
    if recorded is None:
        return None if topic.type_hash else installed
    return installed if installed is not None and type_hash(installed) == type_hash(recorded) else recorded


def class_of_definition(text: str, type_name: str) -> type[Any]:
    """Return the message class of a definition with the types in it, as schemas of ros2msg have it.

    Raises DefinitionError (a ValueError) for a text that is wrong or lacks a type.
    """
    first, *others = text.replace("\r\n", "\n").split(SEPARATOR + "\n")
    texts = {}
    for each in others:
        head, _, body = each.partition("\n")
        if head.startswith(PART):
            texts[_full(head.removeprefix(PART).strip())] = body
    return _Classes(texts).made(type_name, first, 0)


class _Classes:
    """Classes of the parts of a definition, each built once."""

    def __init__(self, texts: dict[str, str]) -> None:
        self._texts = texts
        self._made: dict[str, type[Message]] = {}

    def made(self, name: str, text: str, depth: int) -> type[Any]:
        if depth > DEEPEST:
            raise DefinitionError(f"{name}: types are nested deeper than {DEEPEST}, or in themselves")
        return build(parse(text, name, name), lambda nested: self._resolve(nested, depth + 1))

    def _resolve(self, name: str, depth: int) -> type[Message]:
        if name not in self._made:
            if name not in self._texts:
                raise NotFoundError("message type", name, self._texts)
            self._made[name] = self.made(name, self._texts[name], depth)
        return self._made[name]


def _full(name: str) -> str:
    package, _, short = name.partition("/")
    return f"{package}/msg/{short}" if short and "/" not in short else name


def _installed(type_name: str) -> type[Any] | None:
    try:
        found: type[Any] = find_announced(type_name)
    except RobolinkError:  # there is none, or a file of the workspace is wrong
        return None
    return found if hasattr(found, "__ros_fields__") else None


def _recorded(topic: BagTopic) -> type[Any] | None:
    if topic.definition_encoding != "ros2msg" or not topic.message_definition:
        return None
    try:
        return class_of_definition(topic.message_definition, topic.type_name)
    except RobolinkError:
        return None
