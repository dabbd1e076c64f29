"""Reads VRML as Webots writes its worlds: a text becomes nodes with fields; what they mean is said elsewhere.

Source: ISO/IEC 14772-1 (VRML97), clause 5 and annex A, and Webots' reference manual on what its files have of it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from typing import NoReturn, TypeAlias

from robolink.exceptions import DocumentError, nearest, shown
from robolink.plainfile import size

Value: TypeAlias = "float | str | bool | Node | None"

DEEPEST = 60
"""So many nodes may be inside of each other, those that USE brings in too."""

MOST = 100_000
"""So many nodes a world may have, each counted as often as it is used."""

LONGEST = 6_000_000
"""Characters that a world may have, and bytes."""

MOST_WORDS = 500_000
"""Words, brackets and strings of a world; lists of nothing but numbers, as meshes are, count as one."""

LARGEST = 1e12
"""No number that means anything in a world is larger."""

FIRST_YEAR = 2022
"""Webots' first year with z upwards; what older releases wrote means other directions."""

_TOKEN = re.compile(
    r"""[\s,]+|\#[^\n]*
    |(?P<string>"[^"\\]*(?:\\.[^"\\]*)*")
    |(?P<mark>[\[\]{}])
    |(?P<word>[^\s,"\#\[\]{}]+)
    |(?P<wrong>.)""",
    re.VERBOSE | re.DOTALL,
)
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_NUMBERS = re.compile(r"[-+0-9.eE\s,]*(?=\])")
_HEXADECIMAL = re.compile(r"0[xX][0-9a-fA-F]{1,16}")
_NAME = re.compile(r"[^\d+\-'.][^']*")
_HEADER = re.compile(r"#VRML_SIM\s+R(\d{4})\S*\s+utf8\b")


class Source:
    """The text of a world and its name; knows which line something stands in."""

    def __init__(self, text: str, name: str) -> None:
        self.text, self.name = text.removeprefix("\ufeff"), name

    def error(self, offset: int, message: str) -> DocumentError:
        """Make an error (to raise) about what stands at `offset`."""
        line = self.text.count("\n", 0, offset) + 1
        column = offset - self.text.rfind("\n", 0, offset)
        return DocumentError(shown(message, 300), self.name, line, column)


class Field:
    """What a field of a node holds: one value or a list of them; a vector is so many numbers."""

    __slots__ = ("offset", "values")

    def __init__(self, values: Sequence[Value], offset: int) -> None:
        self.values, self.offset = values, offset


class Node:
    """A node: its type, its fields, and the name that DEF gave it.

    The readers of fields give `default` where the field is absent, and raise `DocumentError` at the field's place
    where it holds something else than was asked for.
    """

    __slots__ = ("defined", "depth", "fields", "offset", "size", "source", "type")

    def __init__(self, kind: str, fields: dict[str, Field], source: Source, offset: int) -> None:
        self.type, self.fields, self.source, self.offset = kind, fields, source, offset
        self.defined = ""
        inner = [value for field in fields.values() for value in field.values if isinstance(value, Node)]
        self.depth: int = 1 + max((each.depth for each in inner), default=0)
        self.size: int = 1 + sum(each.size for each in inner)
        if self.depth > DEEPEST:
            raise self.error(f"more than {DEEPEST} nodes are inside of each other")
        if self.size > MOST:
            raise self.error(f"this has more than {MOST} nodes")

    @property
    def called(self) -> str:
        """The node as a reader knows it: its type and name."""
        field = self.fields.get("name")
        name = field.values[0] if field and field.values else self.defined
        return f"{self.type} '{name}'" if isinstance(name, str) and name else self.type

    def error(self, message: str, field: str = "") -> DocumentError:
        """Make an error (to raise) about this node, or about one of its fields."""
        at = self.fields.get(field)
        prefix = f"{self.type}.{field}: " if field else ""
        return self.source.error(at.offset if at else self.offset, prefix + message)

    def numbers(self, field: str, *default: float) -> tuple[float, ...]:
        """Give as many numbers as the default has."""
        found = self.all_numbers(field) if field in self.fields else list(default)
        if len(found) != len(default):
            raise self.error(f"expected {_counted(len(default), 'number')}, got {len(found)}", field)
        return tuple(found)

    def number(self, field: str, default: float) -> float:
        """Give a number."""
        return self.numbers(field, default)[0]

    def lengths(self, field: str, *default: float) -> tuple[float, ...]:
        """Give as many numbers as the default has, each more than 0."""
        found = self.numbers(field, *default)
        if min(found) <= 0.0:
            raise self.error(f"expected more than 0, got {min(found):g}", field)
        return found

    def length(self, field: str, default: float) -> float:
        """Give a number that is more than 0."""
        return self.lengths(field, default)[0]

    def all_numbers(self, field: str) -> list[float]:
        """Give all the numbers of a field."""
        values = self.fields[field].values if field in self.fields else ()
        for value in values:
            if not isinstance(value, float):
                raise self.error(f"expected numbers, got {_worded(value)}", field)
            if abs(value) > LARGEST:
                raise self.error(f"expected at most {LARGEST:g}, got {value:g}", field)
        return [value for value in values if isinstance(value, float)]

    def text(self, field: str, default: str = "") -> str:
        """Give a string; of several the first."""
        return next(iter(self.texts(field)), default)

    def texts(self, field: str) -> list[str]:
        """Give all the strings of a field."""
        values = self.fields[field].values if field in self.fields else ()
        for value in values:
            if not isinstance(value, str):
                raise self.error(f"expected a string, got {_worded(value)}", field)
        return [value for value in values if isinstance(value, str)]

    def nodes(self, field: str) -> list[Node]:
        """Give the nodes of a field; NULL is none."""
        values = self.fields[field].values if field in self.fields else ()
        for value in values:
            if not isinstance(value, Node) and value is not None:
                raise self.error(f"expected a node, got {_worded(value)}", field)
        return [value for value in values if isinstance(value, Node)]

    def node(self, field: str) -> Node | None:
        """Give the only node of a field, or None."""
        return next(iter(self.nodes(field)), None)


def parse(text: str, name: str) -> list[Node]:
    """Read the text of a world into its nodes; `name` is the file's, as errors spell it.

    Raises `DocumentError` with `file:line:column`.
    """
    source = Source(text, name)
    if len(source.text) > LONGEST:
        raise DocumentError(f"longer than {size(LONGEST)}", name)
    _check_header(source)
    return _Parser(source).nodes()


def _check_header(source: Source) -> None:
    first = source.text.partition("\n")[0]
    match = _HEADER.match(first)
    if match is None:
        raise source.error(0, f"a world of Webots begins with '#VRML_SIM R2023b utf8', this with '{shown(first, 40)}'")
    if int(match[1]) < FIRST_YEAR:
        message = f"written by Webots R{match[1]}; R{FIRST_YEAR} or later is read: open and save it in a newer Webots"
        raise source.error(0, message)


class _Parser:
    """Reads tokens, one ahead, by recursive descent; no deeper than `DEEPEST`."""

    def __init__(self, source: Source) -> None:
        self._source, self._end = source, 0
        self._defined: dict[str, Node] = {}
        self._depth = 0
        self._words = 0
        self._kind, self._text, self._offset = "", "", 0
        self._next()

    def nodes(self) -> list[Node]:
        """Read all nodes of the file."""
        found: list[Node] = []
        total = 0
        while self._kind:
            if self._text in ("EXTERNPROTO", "IMPORTABLE"):
                self._external()
            elif node := self._node():
                found.append(node)
                total += node.size
            if total > MOST:
                self._fail(f"the nodes before this are more than {MOST}")
        return found

    def _next(self) -> None:
        while match := _TOKEN.match(self._source.text, self._end):
            self._end = match.end()
            if match.lastgroup is not None:
                self._kind, self._text, self._offset = match.lastgroup, match[0], match.start()
                self._words += 1
                if self._words > MOST_WORDS:
                    self._fail(f"this world has more than {MOST_WORDS:,} words")
                if self._kind == "wrong":
                    self._fail("this string has no end")
                return
        self._kind, self._text, self._offset = "", "", len(self._source.text)

    def _fail(self, message: str) -> NoReturn:
        raise self._source.error(self._offset, message)

    def _expected(self, what: str) -> NoReturn:
        found = f"'{shown(self._text, 40)}'" if self._kind else "the end of the file"
        self._fail(f"expected {what}, got {found}")

    def _external(self) -> None:
        """Read past `EXTERNPROTO "address"`: nothing is fetched, what is known of it is known by its name."""
        if self._text == "IMPORTABLE":
            self._next()
            if self._text != "EXTERNPROTO":
                self._expected("EXTERNPROTO")
        self._next()
        if self._kind != "string":
            self._expected("the address of a PROTO in quotes")
        self._next()

    def _word(self, what: str) -> str:
        if self._kind != "word" or not _NAME.fullmatch(self._text):
            self._expected(what)
        word = self._text
        self._next()
        return word

    def _node(self) -> Node | None:
        """Read `Type { ... }`, `DEF NAME Type { ... }`, `USE NAME` or `NULL`."""
        word, offset = self._text, self._offset
        if word == "NULL" and self._kind == "word":
            self._next()
            return None
        if word == "USE" and self._kind == "word":
            self._next()
            return self._used()
        if word == "DEF" and self._kind == "word":
            self._next()
            name = self._word("a name after DEF")
            node = self._body(self._word("the type of a node"), offset)
            node.defined = name
            self._defined[name] = node
            return node
        return self._body(self._word("the type of a node"), offset)

    def _used(self) -> Node:
        offset = self._offset
        name = self._word("a name after USE")
        if name not in self._defined:
            raise self._source.error(offset, f"no node before this is called '{name}'{nearest(name, self._defined)}")
        return self._defined[name]

    def _body(self, kind: str, offset: int) -> Node:
        if self._text != "{":
            self._expected(f"'{{' after {shown(kind, 40)}")
        self._depth += 1
        if self._depth > DEEPEST:
            self._fail(f"more than {DEEPEST} nodes are inside of each other")
        self._next()
        fields: dict[str, Field] = {}
        while self._text != "}" or self._kind != "mark":
            name, place = self._field_name(), self._offset
            fields[name] = Field(self._values(), place)
        self._next()
        self._depth -= 1
        return Node(kind, fields, self._source, offset)

    def _field_name(self) -> str:
        name = self._word("a field or '}'")
        return self._word("a field") if name == "hidden" else name  # so Webots saves the state of joints

    def _values(self) -> list[Value]:
        """Read what a field holds: a list, a run of numbers, or one value."""
        if self._text == "[" and self._kind == "mark":
            found: list[Value] = [*self._plain_numbers()]
            self._next()
            while self._text != "]" or self._kind != "mark":
                found.append(self._value())
            self._next()
            return found
        first = self._value()
        return [first, *self._numbers()] if isinstance(first, float) else [first]

    def _plain_numbers(self) -> list[float]:
        """Read past a list of nothing but numbers, at once, as meshes have it by the thousand; or read nothing."""
        match = _NUMBERS.match(self._source.text, self._end)
        try:
            found = [float(each) for each in match[0].replace(",", " ").split()] if match else []
        except ValueError:
            return []
        if match and all(map(math.isfinite, found)):
            self._end = match.end()
            return found
        return []

    def _numbers(self) -> Iterator[float]:
        while self._kind == "word" and (number := self._number()) is not None:
            yield number

    def _value(self) -> Value:
        if self._kind == "string":
            text = re.sub(r"\\(.)", r"\1", self._text[1:-1], flags=re.DOTALL)
            self._next()
            return text
        if self._kind != "word":
            self._expected("a value")
        if self._text in ("TRUE", "FALSE"):
            truth = self._text == "TRUE"
            self._next()
            return truth
        number = self._number()
        return self._node() if number is None else number

    def _number(self) -> float | None:
        text = self._text
        if _HEXADECIMAL.fullmatch(text):
            value = float(int(text, 16))
        elif _NUMBER.fullmatch(text):
            value = float(text)
        else:
            return None
        if not math.isfinite(value):
            self._fail(f"'{shown(text, 40)}' is too large a number")
        self._next()
        return value


def _worded(value: Value) -> str:
    if isinstance(value, Node):
        return f"a {value.type}"
    if isinstance(value, bool):
        return str(value).upper()
    return "NULL" if value is None else f"'{shown(value, 40)}'" if isinstance(value, str) else f"{value:g}"


def _counted(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"
