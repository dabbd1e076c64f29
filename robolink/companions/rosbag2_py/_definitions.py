"""Definitions of message types as rosbag2 stores them in a bag: a type's file, and behind it those that it uses."""

from __future__ import annotations

import re
from collections.abc import Iterator

from robolink.bag.topic import message_definition
from robolink.companions.rosbag2_py._storage import MessageDefinition
from robolink.companions.rosidl_runtime import get_message
from robolink.exceptions import RobolinkError
from robolink.interfaces import find
from robolink.message import type_hash
from robolink.message.text import text_of
from robolink.system.files import decoded, read_plain
from robolink.workspace.interfaces import IDL, WORKSPACE_TYPES, use_interfaces

MSG, SRV = ".msg", ".srv"
LINE = "=" * 80 + "\n"
"""Line before each section; the schema encoding ros2msg of MCAP has it, too."""
ENCODINGS = {MSG: "ros2msg", IDL: "ros2idl"}
LARGEST = 1 << 20
"""Upper bound of a definition's file, in bytes."""
_NAME = re.compile(r"([a-zA-Z0-9_]+)/(?:(msg|srv)/)?([a-zA-Z0-9_]+)")
_INCLUDE = re.compile(r'^#include\s+["<]([a-zA-Z0-9_/]+)\.idl[">]', re.MULTILINE)
_FIELD = re.compile(r"^\s*([a-zA-Z0-9_/]+)(?:<=\d+)?(?:\[[^\]]*\])?\s+[a-zA-Z]", re.MULTILINE)
_PRIMITIVES = re.compile(r"bool|byte|char|float(?:32|64)|u?int(?:8|16|32|64)|w?string")
Section = tuple[str, str, str]
"""Suffix, name and text of a type."""


class LocalMessageDefinitionSource:
    """Source of the definitions of types that are installed here or are in the workspace."""

    def get_full_text(self, root_topic_type: str) -> MessageDefinition:
        """Return the definition of a type with all that it uses: empty, encoding unknown, for an unknown type."""
        use_interfaces()
        try:
            suffix, sections = _service(root_topic_type) if "/srv/" in root_topic_type else _message(root_topic_type)
        except LookupError:
            return _of_class(root_topic_type)
        first = sections[0][2] if sections[0][0] == MSG else _shown(sections[0])
        text = "\n".join([first, *map(_shown, sections[1:])])
        return MessageDefinition(root_topic_type, ENCODINGS[suffix], text, _hash(root_topic_type))


def _message(name: str) -> tuple[str, list[Section]]:
    """Return the sections of a message: of .msg files where all that it uses has one, else of .idl files."""
    try:
        return MSG, list(_with_uses(name, MSG, set()))
    except LookupError:
        return IDL, list(_with_uses(name, IDL, set()))


def _service(name: str) -> tuple[str, list[Section]]:
    """Return the sections of a service, in which each message may be of a .msg or of an .idl file.

    Before that of an .idl file there is one of its name as a .msg, without text: so rosbag2 writes it.
    """
    text = _text(name, SRV)
    if text is None:
        raise LookupError(f"{name} has no {SRV} file")
    suffix, sections, seen = MSG, [(SRV, name, text)], set[str]()
    for each in _uses(text, name, SRV):
        if each in seen:
            continue
        try:
            sections += list(_with_uses(each, MSG, seen))
            suffix = MSG
        except LookupError:
            sections += [(MSG, each, ""), *_with_uses(each, IDL, seen)]
            suffix = IDL
    return suffix, sections


def _with_uses(name: str, suffix: str, seen: set[str]) -> Iterator[Section]:
    """Yield a type and what it uses, each once. Raises LookupError for one that has no such file."""
    text = _text(name, suffix)
    if text is None:
        raise LookupError(f"{name} has no {suffix} file")
    yield suffix, name, text
    seen.add(name)
    for each in _uses(text, name, suffix):
        if each not in seen:
            yield from _with_uses(each, suffix, seen)


def _uses(text: str, name: str, suffix: str) -> list[str]:
    """Return the types that a definition names, sorted."""
    if suffix == IDL:
        return sorted(set(_INCLUDE.findall(text)))
    package = name.partition("/")[0]
    code = re.sub("#.*", "", text)
    found = {each for each in _FIELD.findall(code) if not _PRIMITIVES.fullmatch(each)}
    return sorted({_full(each, package) for each in found})


def _full(name: str, package: str) -> str:
    return name if "/" in name else "std_msgs/Header" if name == "Header" else f"{package}/{name}"


def _text(name: str, suffix: str) -> str | None:
    """Return the text of a type's file with this suffix; None where it has none, or is unknown."""
    match = _NAME.fullmatch(name)
    if match is None:
        return None
    package, kind, short = match[1], "srv" if suffix == SRV else "msg", match[3]
    places = [folder / f"{short}{suffix}" for folder in WORKSPACE_TYPES.folders(package, kind)]
    own = next((each for each in places if each.is_file()), None)
    try:
        if own is not None:
            return decoded(read_plain(own, LARGEST))
        is_of_idl = any(each.with_suffix(IDL).is_file() for each in places)
        return None if suffix == IDL or is_of_idl else _ended(text_of(find(f"{package}/{kind}/{short}", kind)))
    except (RobolinkError, OSError, ValueError):
        return None


def _ended(text: str) -> str:
    return text if not text or text.endswith("\n") else text + "\n"


def _shown(section: Section) -> str:
    suffix, name, text = section
    return f"{LINE}{suffix[1:].upper()}: {name}\n{text}"


def _of_class(name: str) -> MessageDefinition:
    """Return the definition in .msg's language of a message some of which is in .idl files; else an empty one."""
    try:
        cls = get_message(name)
    except (RobolinkError, ImportError, AttributeError, ValueError):  # what get_message raises for an unknown type
        return MessageDefinition(name, "unknown", "", "")
    return MessageDefinition(name, ENCODINGS[MSG], message_definition(cls), type_hash(cls))


def _hash(name: str) -> str:
    try:
        return type_hash(get_message(name))
    except (RobolinkError, ImportError, AttributeError, ValueError):  # what get_message raises, for services too
        return ""
