"""Parser of .msg, .srv and .action files: fields, constants, defaults and the comments beside them.

The rules are those of rosidl's adapter. A message has one section, a service two and an action three, separated by
lines of ``---``; each section is a message type of its own.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterable
from typing import Any, NoReturn

import msgspec

from robolink.exceptions import DefinitionError, MessageError, nearest
from robolink.message import literals
from robolink.message.annotations import FieldType
from robolink.message.description import TYPE_IDS
from robolink.message.spelling import is_part, split_type_name, wrong_name
from robolink.system.patterns import late
from robolink.system.terminal import shown

SECTIONS = {"msg": ("",), "srv": ("_Request", "_Response"), "action": ("_Goal", "_Result", "_Feedback")}
"""Suffixes of the types of a file's sections, behind the name of the file's type."""
LONGEST_LINE, LONGEST_TEXT = 65_536, 4_000_000
LARGEST = 2**32 - 1
"""Upper bound of the size of a string, sequence or array: a length is a uint32 on the wire."""

ELEMENT_LINE = late(r"(?P<type>[^\s#]+)(?P<gap>\s*)(?P<name>[^\s=#]*)\s*(?P<rest>.*)")
TYPE = late(r"(?P<base>[^\[\]<]+)(?:<=(?P<bound>[^\[\]]*))?(?:\[(?P<limit><=)?(?P<size>[^\[\]]*)\])?")
COUNT = late(r"\+?[0-9](?:_?[0-9]){0,9}")
"""Size of an array as Python's int reads it, as rosidl does: ``+3`` and ``1_000`` too."""
VALUE = late(rf"(?P<value>{literals.QUOTED}|\[(?:[^\"'#\]]|{literals.QUOTED})*\])\s*(?:#.*)?")
NO_TEXT = late("[\0\ud800-\udfff]")
MEANT = {
    "boolean": "bool",
    "int": "int32",
    "uint": "uint32",
    "float": "float32",
    "double": "float64",
    "str": "string",
    "octet": "byte",
    "time": "builtin_interfaces/Time",
    "duration": "builtin_interfaces/Duration",
}
"""ROS type names by the names that other systems use."""


class Constant(msgspec.Struct, frozen=True):
    """A named value of a type: ``uint8 LEFT=1``."""

    type: FieldType
    name: str
    value: Any
    """The value: a bool, int (byte and char too), float or str."""
    above: tuple[str, ...] = ()
    """Comment lines above it, without their ``#``."""
    behind: str = ""
    """Comment behind it, and those in indented lines below it."""
    line: int = 0
    """Line in the file's text, from 1."""


class Field(msgspec.Struct, frozen=True):
    """A field: ``float64 speed 0.5``. The type of a nested message is known by its full name only."""

    type: FieldType
    name: str
    default: Any = None
    """Default value as Constant.value, or a list of such; None if the text has none."""
    above: tuple[str, ...] = ()
    behind: str = ""
    line: int = 0
    column: int = 1
    """Column of its type in that line, from 1."""


class Section(msgspec.Struct, frozen=True):
    """One message type of a file: all of a .msg, or a part between the ``---`` of the others."""

    type_name: str
    """Type name, such as ``std_srvs/srv/SetBool_Request``."""
    comment: tuple[str, ...]
    """Comment lines at its head, without their ``#``."""
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...]
    text: str | None
    """Its part of the file's text; None for a part of an .idl file."""


class Definition(msgspec.Struct, frozen=True):
    """Content of a .msg, .srv or .action file."""

    type_name: str
    """Type name: ``pkg/msg/Name``, ``pkg/srv/Name`` or ``pkg/action/Name``."""
    sections: tuple[Section, ...]
    """One section of a message, two of a service (request, response), three of an action (goal, result, feedback)."""
    text: str | None
    """Text of the .msg, .srv or .action file; None for an .idl file, of whose class such a text is made."""
    origin: str
    """Name of the text's source in errors."""


def parse(text: str, type_name: str, origin: str = "<text>") -> Definition:
    """Parse the text of an interface file. `type_name` is ``pkg/msg/Name``, ``pkg/srv/Name`` or ``pkg/action/Name``.

    Raises DefinitionError, whose text begins with ``origin:line:column``.
    """
    try:
        _, kind, short = split_type_name(type_name)
    except MessageError as error:
        raise DefinitionError(f"{origin}: {error}") from None
    reader = _Reader(type_name, origin)
    lines = reader.lines(text)
    suffixes = ("",) if is_part(kind, short) else SECTIONS[kind]
    sections = reader.sections(lines, kind, suffixes)
    return Definition(type_name, sections, text, origin)


class _Reader:
    """Parser of one text, with its name for errors."""

    def __init__(self, type_name: str, origin: str) -> None:
        self.type_name, self.origin = type_name, origin
        self.package = type_name.partition("/")[0]

    def fail(self, line: int, column: int, text: str) -> NoReturn:
        raise DefinitionError(f"{self.origin}:{line}:{column}: {text}")

    def lines(self, text: str) -> list[str]:
        """Split a text as editors do, after refusing what no editor shows."""
        if len(text) > LONGEST_TEXT:
            self.fail(1, 1, f"{len(text)} characters are too many for an interface file (at most {LONGEST_TEXT})")
        lines = re.split(r"\r\n|\n|\r", text.removeprefix("\ufeff"))
        for number, line in enumerate(lines, 1):
            if len(line) > LONGEST_LINE:
                self.fail(number, 1, f"a line of {len(line)} characters (at most {LONGEST_LINE})")
            stray = None if line.isascii() and "\0" not in line else NO_TEXT.search(line)
            if stray is not None:
                what = "a NUL character" if stray[0] == "\0" else f"half a character ({stray[0]!r})"
                self.fail(number, stray.start() + 1, f"{what}: this is not a text file")
        return lines

    def sections(self, lines: list[str], kind: str, suffixes: tuple[str, ...]) -> tuple[Section, ...]:
        """Split the lines at ``---`` and parse each section."""
        parted: list[list[str]] = [[]]
        starts = [1]
        for number, line in enumerate(lines, 1):
            if line.rstrip() != "---":
                parted[-1].append(line)
                continue
            parted.append([])
            starts.append(number + 1)
            if len(parted) > len(suffixes):
                self.fail(number, 1, f"one '---' too many: a .{kind} file has {len(suffixes) - 1}")
        if len(parted) < len(suffixes):
            section = suffixes[len(parted)].removeprefix("_").lower()
            self.fail(len(lines), 1, f"the file ends without a line '---' before the {section}")
        return tuple(
            _SectionReader(self, part, start).read(self.type_name + suffix)
            for part, start, suffix in zip(parted, starts, suffixes, strict=True)
        )


class _SectionReader:
    """Parser of the lines of one message type, one after the other."""

    def __init__(self, reader: _Reader, lines: list[str], start: int) -> None:
        self.reader, self.lines, self.start = reader, lines, start
        self.elements: list[Field | Constant] = []
        self.places: dict[str, int] = {}
        self.pending: list[str] = []
        """Comment lines whose field or constant has not come yet."""

    def read(self, type_name: str) -> Section:
        head = self._head()
        for number in range(head, len(self.lines)):
            self._line(self.lines[number], self.start + number)
        return Section(
            type_name,
            dedented(self._comment(each) for each in self.lines[:head]),
            tuple(each for each in self.elements if isinstance(each, Field)),
            tuple(each for each in self.elements if isinstance(each, Constant)),
            "\n".join(self.lines),
        )

    def _head(self) -> int:
        """Return the number of lines at the head: comments from the very first line on, as rosidl has it."""
        count = 0
        while count < len(self.lines) and self.lines[count].startswith("#"):
            count += 1
        return count

    @staticmethod
    def _comment(line: str) -> str:
        return line.strip().lstrip("#").rstrip()

    def _line(self, line: str, number: int) -> None:
        stripped = line.strip()
        if not stripped:
            return
        if not stripped.startswith("#"):
            self._element(line, number)
        elif line[0].isspace() and self.elements and not self.pending:
            last = self.elements[-1]
            behind = f"{last.behind}\n{self._comment(line).strip()}".strip()
            self.elements[-1] = msgspec.structs.replace(last, behind=behind)
        else:
            self.pending.append(self._comment(line))

    def _element(self, line: str, number: int) -> None:
        indent = len(line) - len(line.lstrip())
        found = ELEMENT_LINE.match(line, indent)
        assert found is not None  # any text matches that neither begins with a space nor with #
        type_text, name, rest = found["type"], found["name"], found["rest"]
        if not name:
            self.reader.fail(number, indent + 1, f"'{shown(type_text)}' alone is not a field: write a type and a name")
        column = found.start("rest") + 1
        value, behind = _split_comment(rest)
        kind = self._type(type_text, number, indent + 1, constant=value.startswith("="))
        self._new_name(name, number, found.start("name") + 1, constant=value.startswith("="))
        above, self.pending = dedented(self.pending), []
        if value.startswith("="):
            after = value[1:].lstrip()
            constant = self._value(kind, after, number, column + len(value) - len(after))
            self.elements.append(Constant(kind, name, constant, above, behind, number))
        else:
            default = self._value(kind, value, number, column) if value else None
            self.elements.append(Field(kind, name, default, above, behind, number, indent + 1))

    def _new_name(self, name: str, number: int, column: int, constant: bool) -> None:
        wrong = wrong_name("constant" if constant else "field", name)
        if wrong:
            self.reader.fail(number, column, wrong)
        if name in self.places:
            self.reader.fail(number, column, f"a second '{name}': the first stands in line {self.places[name]}")
        self.places[name] = number

    def _value(self, kind: FieldType, text: str, number: int, column: int) -> Any:
        try:
            return literals.read(kind, text)
        except ValueError as error:
            self.reader.fail(number, column, str(error))

    def _type(self, text: str, number: int, column: int, constant: bool) -> FieldType:
        try:
            kind = field_type(text, self.reader.package)
        except MessageError as error:
            self.reader.fail(number, column, str(error))
        if constant and (kind.base not in TYPE_IDS or kind.shape != "one" or kind.string_bound):
            self.reader.fail(number, column, f"a constant of type {shown(text)}: only primitive types have any")
        if kind.base == self.reader.type_name:
            self.reader.fail(number, column, f"{self.reader.type_name} cannot contain itself")
        return kind


def field_type(text: str, package: str) -> FieldType:
    """Parse a type of a field in a message of `package`, such as ``string<=5[<=3]``. Raises MessageError."""
    found = TYPE.fullmatch(text)
    if found is None:
        raise MessageError(f"'{shown(text)}' is not a type: write float64, float64[], float64[3], float64[<=3] ...")
    base = found["base"] if found["base"] in TYPE_IDS else _nested(found["base"], package)
    bound = 0
    if found["bound"] is not None:
        if base not in ("string", "wstring"):
            raise MessageError(f"'{shown(text)}': only string and wstring can be bounded so")
        bound = _count(found["bound"], text)
    if found["size"] is None:
        return FieldType(base=base, string_bound=bound)
    if not found["size"] and not found["limit"]:
        return FieldType(base=base, string_bound=bound, shape="sequence")
    shape = "bounded" if found["limit"] else "array"
    return FieldType(base=base, string_bound=bound, shape=shape, size=_count(found["size"], text))


def _count(digits: str, text: str) -> int:
    if COUNT.fullmatch(digits) and 0 < int(digits) <= LARGEST:
        return int(digits)
    raise MessageError(f"'{shown(text)}': a size or bound is a whole number from 1 to {LARGEST}")


def _nested(text: str, package: str) -> str:
    """Return the full name of a message type: ``Point``, ``pkg/Point`` and ``pkg/msg/Point`` are possible."""
    if text.startswith("@"):
        raise MessageError(f"'{shown(text)}': annotations belong to .idl files")
    parts = text.split("/")
    if len(parts) == 1:
        if text[:1].islower():
            meant = f" (did you mean '{MEANT[text]}'?)" if text in MEANT else nearest(text[:80], TYPE_IDS)
            raise MessageError(f"'{shown(text)}' is not a type{meant}")
        full_name = f"{package}/msg/{text}"
    else:
        full_name = f"{parts[0]}/msg/{parts[1]}" if len(parts) == 2 else text
    _, kind, short = split_type_name(full_name)
    if kind != "msg" and not is_part(kind, short):
        raise MessageError(f"'{full_name}' is not a message type: only messages can be fields")
    return full_name


def _split_comment(text: str) -> tuple[str, str]:
    """Split a value from the comment behind it; a ``#`` within quotes is the value's."""
    sign, gap, rest = re.match(r"(=?)(\s*)(.*)", text, re.DOTALL).groups()  # type: ignore[union-attr]
    quoted = VALUE.fullmatch(rest)
    if quoted is not None:
        value, comment = quoted["value"], rest[quoted.end("value") :]
    else:
        value, _, comment = rest.partition("#")
    return f"{sign}{gap}{value.rstrip()}", comment.strip().lstrip("#").strip()


def dedented(comments: Iterable[str]) -> tuple[str, ...]:
    """Return comment lines without the space that all begin with, and without empty ones at either end."""
    lines = [each if each.strip(" \t") else "" for each in comments]  # as textwrap.dedent, which takes 1 ms to import
    margin = len(posixpath.commonprefix([each[: len(each) - len(each.lstrip(" \t"))] for each in lines if each]))
    text = "\n".join(each[margin:] for each in lines).strip("\n")
    return tuple(text.split("\n")) if text else ()
