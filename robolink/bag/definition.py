"""Message definitions as bags and views carry them: a type's text with that of every type it is made of (ros2msg)."""

from __future__ import annotations

from robolink.message import Message
from robolink.message.text import text_of

SEPARATOR = "=" * 80
"""Line before each type after the first."""


def message_definition(cls: type[Message]) -> str:
    """Return the text of a message class, and behind it that of each type in it, as the schema encoding ros2msg has it.

    A part of a service or action (``SetBool.Request``, ``SetBool.Event``) is a message class too; a service itself is
    none. The types come in the order in which they are first used, each once, behind a line ``MSG: pkg/Name``.
    """
    types: dict[str, type[Message]] = {cls.__ros_type__: cls}
    waiting = [cls]
    for each in waiting:
        for kind in each.__ros_fields__.values():
            if kind.message is not None and kind.message.__ros_type__ not in types:
                types[kind.message.__ros_type__] = kind.message
                waiting.append(kind.message)
    first, *others = (_ended(text_of(each)) for each in types.values())
    names = [name.replace("/msg/", "/") for name in types][1:]
    return first + "".join(f"{SEPARATOR}\nMSG: {name}\n{text}" for name, text in zip(names, others, strict=True))


def _ended(text: str) -> str:
    return text if not text or text.endswith("\n") else text + "\n"
