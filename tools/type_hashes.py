"""Computes RIHS01 type hashes of interface files, by rosbags and rosidl's rules: robolink's own code is not asked.

python tools/type_hashes.py FOLDER...

A folder has its package's name and holds the folders msg, srv and action, as packages of ROS 2 do. Packages that these
need are folders too; those that rosbags knows (std_msgs, geometry_msgs ...) are not. Prints a JSON object with the
hashes of each package's types and of the parts of actions that endpoints announce, and with the constants, of which no
hash tells. Where NAME.json of rosidl's generator lies beside a file, its hash must be the same. Types with wide text
are refused, for rosbags has none.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from rosbags.interfaces import Nodetype
from rosbags.interfaces.typing import Basename, Constdefs, ConstValue, Fielddefs, FieldDesc, Typesdict
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from rosbags.typesys.store import Typestore

Definition = tuple[Constdefs, Fielddefs]
"""Constants and fields of a message, as rosbags keeps them."""
SECTIONS = {".msg": ("",), ".srv": ("_Request", "_Response"), ".action": ("_Goal", "_Result", "_Feedback")}
"""Suffixes of the messages in a file, by its kind; lines of ``---`` divide them."""
ANNOUNCED = {".msg": ("",), ".srv": ("",), ".action": ("", "_SendGoal", "_GetResult", "_FeedbackMessage")}
"""Suffixes of the types whose hashes are printed, by the kind of their file."""
COMMENT = re.compile(r"(?m)#.*$")
CHAR = re.compile(r"^char\b", re.MULTILINE)
DEFAULT = re.compile(r"^([\w/\[\]<=]+[ \t]+\w+)[ \t]+[^=\s].*", re.MULTILINE)
"""A field with a default value, which is not a part of the hash and which rosbags does not read."""


def fields_of(text: str, package: str, name: str) -> Typesdict:
    """Read the text of one message; rosidl makes a char of a .msg file a uint8."""
    plain = DEFAULT.sub(r"\1", CHAR.sub("uint8", COMMENT.sub("", text.replace("\r", ""))))
    (found,) = get_types_from_msg(plain, f"{package}/msg/Any").values()
    return {name: found}


def message(name: str) -> FieldDesc:
    """Describe a field that is a message."""
    return (Nodetype.NAME, name)


def at_most_one(name: str) -> FieldDesc:
    """Describe a field that is a sequence of at most one message."""
    return (Nodetype.SEQUENCE, ((Nodetype.NAME, name), 1))


def number(kind: Basename) -> FieldDesc:
    """Describe a field that is a number or a bool."""
    return (Nodetype.BASE, (kind, 0))


def service(name: str) -> Iterator[tuple[str, Definition]]:
    """Yield the types that rosidl adds to a service's request and response."""
    parts = f"{name}_Request", f"{name}_Response"
    info = ("info", message("service_msgs/msg/ServiceEventInfo"))
    yield f"{name}_Event", ([], [info, ("request", at_most_one(parts[0])), ("response", at_most_one(parts[1]))])
    fields = zip(("request", "response", "event"), (*parts, f"{name}_Event"), strict=True)
    yield name, ([], [(f"{field}_message", message(part)) for field, part in fields])


def action(name: str) -> Iterator[tuple[str, Definition]]:
    """Yield the types that rosidl adds to an action's goal, result and feedback."""
    goal_id = ("goal_id", message("unique_identifier_msgs/msg/UUID"))
    stamp = ("stamp", message("builtin_interfaces/msg/Time"))
    yield f"{name}_SendGoal_Request", ([], [goal_id, ("goal", message(f"{name}_Goal"))])
    yield f"{name}_SendGoal_Response", ([], [("accepted", number("bool")), stamp])
    yield from service(f"{name}_SendGoal")
    yield f"{name}_GetResult_Request", ([], [goal_id])
    yield f"{name}_GetResult_Response", ([], [("status", number("int8")), ("result", message(f"{name}_Result"))])
    yield from service(f"{name}_GetResult")
    yield f"{name}_FeedbackMessage", ([], [goal_id, ("feedback", message(f"{name}_Feedback"))])
    parts = ("Goal", "Result", "Feedback", "SendGoal", "GetResult", "FeedbackMessage")
    fields = ("goal", "result", "feedback", "send_goal_service", "get_result_service", "feedback_message")
    yield name, ([], [(field, message(f"{name}_{part}")) for field, part in zip(fields, parts, strict=True)])


def read(file: Path, package: str) -> Typesdict:
    """Read one interface file: the messages in it, and what rosidl adds."""
    name = f"{package}/{file.suffix[1:]}/{file.stem}"
    texts = re.split(r"^---\s*$", file.read_text("utf-8"), flags=re.MULTILINE)
    found = dict[str, Definition]()
    for suffix, text in zip(SECTIONS[file.suffix], texts, strict=True):
        found.update(fields_of(text, package, name + suffix))
    if file.suffix != ".msg":
        found.update(service(name) if file.suffix == ".srv" else action(name))
    return found


def store() -> Typestore:
    """Return Jazzy's types as rosbags knows them, with the event info of services as rosidl makes it."""
    made = get_typestore(Stores.ROS2_JAZZY)
    text = "uint8 event_type\nbuiltin_interfaces/Time stamp\nuint8[16] client_gid\nint64 sequence_number"
    made.fielddefs.update(fields_of(text, "service_msgs", "service_msgs/msg/ServiceEventInfo"))
    return made


def published(file: Path, name: str) -> str | None:
    """Return the hash in the file that rosidl generated from a definition, None where it is not there."""
    generated = file.with_suffix(".json")
    if not generated.exists():
        return None
    hashes = json.loads(generated.read_text("utf-8"))["type_hashes"]
    return {str(each["type_name"]): str(each["hash_string"]) for each in hashes}[name]


def hashes_of(file: Path, name: str, known: Typestore) -> dict[str, str]:
    """Return the hashes of a file's type and of what endpoints of an action announce."""
    computed = {name + each: known.hash_rihs01(name + each) for each in ANNOUNCED[file.suffix]}
    if (right := published(file, name)) not in (None, computed[name]):
        sys.exit(f"{file}: {computed[name]} is computed, {right} is published")
    return computed


def constants_of(file: Path, name: str, known: Typestore) -> dict[str, dict[str, ConstValue]]:
    """Return the constants of a file's messages."""
    parts = {name + suffix: known.fielddefs[name + suffix][0] for suffix in SECTIONS[file.suffix]}
    return {part: {key: value for key, _, value in constants} for part, constants in parts.items() if constants}


def main(folders: list[Path]) -> None:
    """Print hashes and constants of the interface files in `folders`, by package."""
    known = store()
    files = {folder: [file for kind in SECTIONS for file in sorted(folder.glob(f"*/*{kind}"))] for folder in folders}
    for folder in folders:
        for file in files[folder]:
            known.fielddefs.update(read(file, folder.name))
    found = dict[str, Any]()
    for folder in folders:
        hashes, constants = dict[str, str](), dict[str, Any]()
        for file in files[folder]:
            name = f"{folder.name}/{file.suffix[1:]}/{file.stem}"
            hashes.update(hashes_of(file, name, known))
            constants.update(constants_of(file, name, known))
        found[folder.name] = {"hashes": hashes, "constants": constants}
    sys.stdout.write(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main([Path(each).resolve() for each in sys.argv[1:]])
