"""Parser of VRML as Webots writes its worlds and PROTOs: from text to nodes with fields, without their meaning.

Source: ISO/IEC 14772-1 (VRML97), clause 5 and annex A, and Webots' reference manual on what its files have of it.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import NoReturn

from robolink.documents.foreign import unknown_key
from robolink.exceptions import DocumentError, nearest
from robolink.sim.webots.protos import Definition, Protos, Scope
from robolink.sim.webots.vrml_node import DEEPEST, KNOWN_FIELDS, LONGEST, MOST, Field, Node, Source, Value
from robolink.system.files import size
from robolink.system.terminal import shown

MOST_WORDS = 500_000
"""Most words, brackets and strings of a world; a list of only numbers, as of a mesh, counts as one."""

FIRST_YEAR = 2022
"""First year of Webots with z upwards; older releases mean other directions."""

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


def parse(text: str, name: str, protos: Protos | None = None) -> list[Node]:
    """Parse the text of a world into its nodes.

    Args:
        text: The world.
        name: Name of its file, for errors, and for files beside it.
        protos: Finder of PROTOs; None to leave nodes of such types as they are.

    Raises:
        DocumentError: with `file:line:column`.
    """
    source = Source(text, name, protos.notes if protos else None)
    if len(source.text) > LONGEST:
        raise DocumentError(f"longer than {size(LONGEST)}", name)
    _check_header(source)
    return _Parser(source, Scope(Path(name).parent, {}), protos).nodes()


def parse_proto(source: Source, scope: Scope, protos: Protos) -> Definition:
    """Parse the interface of a PROTO's file. Raises DocumentError with `file:line:column`."""
    return _Parser(source, scope, protos).definition()


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

    def __init__(self, source: Source, scope: Scope, protos: Protos | None) -> None:
        self._source, self._scope, self._protos, self._end = source, scope, protos, 0
        self._defined: dict[str, Node] = {}
        self._bound: dict[str, Field] | None = None
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

    def definition(self) -> Definition:
        """Read `PROTO Name [ fields ]`, up to the body."""
        while self._text in ("EXTERNPROTO", "IMPORTABLE"):
            self._external()
        if self._text != "PROTO":
            self._expected("PROTO")
        self._next()
        name = self._word("the name of the PROTO")
        self._mark("[")
        fields = dict(iter(self._interface_field, None))
        self._mark("]")
        return Definition(name, fields, self._source, self._offset, self._scope)

    def instance(self, definition: Definition, node: Node, depth: int) -> Node:
        """Read the body of a PROTO with the fields of a node that is one."""
        self._end, self._depth = definition.body, depth
        self._bound = {**definition.fields, **{k: v for k, v in node.fields.items() if k in definition.fields}}
        self._next()
        self._mark("{")
        found: list[Node] = []
        while self._text != "}" or self._kind != "mark":
            if made := self._node():
                found.append(made)
        assert self._protos is not None
        self._protos.spend(self._words, node)
        if not found:
            self._fail(f"the PROTO {definition.name} has no node in it")
        return found[0]  # as VRML has it: the first is what the PROTO stands for

    def _interface_field(self) -> tuple[str, Field] | None:
        """Read `field SFVec3f translation 0 0 0`, and choices such as `SFString{"1", "2"}`; None at the end."""
        if self._text == "]" and self._kind == "mark":
            return None
        self._word("a field of the PROTO or ']'")
        self._word("the type of a field")
        if self._text == "{" and self._kind == "mark":
            while self._kind and self._text != "}":
                self._next()
            self._next()
        return self._word("the name of a field"), self._field()

    def _mark(self, mark: str) -> None:
        if self._text != mark or self._kind != "mark":
            self._expected(f"'{mark}'")
        self._next()

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
        """Read `EXTERNPROTO "address"`, which may lie beside this file; nothing is fetched."""
        if self._text == "IMPORTABLE":
            self._next()
            if self._text != "EXTERNPROTO":
                self._expected("EXTERNPROTO")
        self._next()
        if self._kind != "string":
            self._expected("the address of a PROTO in quotes")
        self._scope.declare(self._text[1:-1])
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
            place, is_state = self._offset, self._text == "hidden"
            name = self._field_name()
            fields[name] = self._field()
            if kind in KNOWN_FIELDS and name not in KNOWN_FIELDS[kind] and not is_state:
                self._note(kind, name, place, KNOWN_FIELDS[kind])
        self._next()
        node = self._expanded(Node(kind, fields, self._source, offset))
        self._depth -= 1
        return node

    def _expanded(self, node: Node) -> Node:
        """Return the node that one of a PROTO's type stands for; any other as it is."""
        definition = self._protos.find(node, self._scope) if self._protos else None
        if definition is None:
            return node
        for name, field in node.fields.items():
            if name not in definition.fields:
                self._note(node.type, name, field.offset, definition.fields)
        parser = _Parser(definition.source, definition.scope, self._protos)
        made = parser.instance(definition, node, self._depth)
        made.source, made.offset = node.source, node.offset  # where the world has it, as for any other node
        return made

    def _note(self, kind: str, name: str, offset: int, known: Collection[str]) -> None:
        text = f"{kind}.{name}: {unknown_key(name, known)}"
        self._source.notes.add(self._source.error(offset, text), kind, name)

    def _field_name(self) -> str:
        name = self._word("a field or '}'")
        return self._word("a field") if name == "hidden" else name  # so Webots saves the state of joints

    def _field(self) -> Field:
        """Read the values of a field, or `IS name`: those of a field of the PROTO."""
        place = self._offset
        if self._kind != "word" or self._text != "IS":
            return Field(self._values(), place, self._source)
        self._next()
        place, name = self._offset, self._word("the name of a field of the PROTO")
        if self._bound is None:
            raise self._source.error(place, "IS is for the body of a PROTO")
        if name not in self._bound:
            raise self._source.error(place, f"the PROTO has no field '{name}'{nearest(name, self._bound)}")
        return self._bound[name]

    def _values(self) -> list[Value]:
        """Read the values of a field: a list, a run of numbers, or one value."""
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
