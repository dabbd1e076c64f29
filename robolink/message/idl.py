"""Parser of the .idl files that rosidl takes: one message, or the parts of one service or action, with its constants.

It reads the part of OMG IDL 4.2 that rosidl's own grammar has and a .msg file can say, which is what rosidl's adapter
writes of .msg files. Enumerations, unions, `char`, `wchar` and `long double` are refused.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple, NoReturn

import msgspec

from robolink.exceptions import DefinitionError, MessageError
from robolink.message import literals
from robolink.message.annotations import FieldType
from robolink.message.definition import LARGEST, SECTIONS, Constant, Definition, Field, Section
from robolink.message.description import TYPE_IDS
from robolink.message.spelling import split_type_name, wrong_name
from robolink.system.terminal import shown

TOKEN = re.compile(
    r"""(?P<skipped>\s+|//[^\n]*|/\*.*?\*/|\#[^\n]*)"""
    r"""|(?P<token>"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*'|::|[A-Za-z_]\w*|[+-]?(?:0[xX][0-9a-fA-F]+|[0-9.][\w.+-]*)|\S)""",
    re.DOTALL | re.ASCII,
)
PRIMITIVES = {
    "boolean": "bool",
    "octet": "byte",
    "float": "float32",
    "double": "float64",
    "short": "int16",
    "unsigned short": "uint16",
    "long": "int32",
    "unsigned long": "uint32",
    "long long": "int64",
    "unsigned long long": "uint64",
    **{f"{sign}int{bits}": f"{sign}int{bits}" for bits in (8, 16, 32, 64) for sign in ("", "u")},
}
"""Primitives of .msg files by IDL's names."""
DEEPEST = 8
"""Most modules within each other."""


class Token(NamedTuple):
    """A word, a sign or a quoted text, with its place."""

    text: str
    line: int
    column: int


def parse_idl(text: str, type_name: str, origin: str = "<text>") -> Definition:
    """Parse the text of an .idl file that defines the type ``pkg/msg/Name``, ``pkg/srv/Name`` or ``pkg/action/Name``.

    Raises DefinitionError, whose text begins with ``origin:line:column``.
    """
    try:
        _, kind, _ = split_type_name(type_name)
    except MessageError as error:
        raise DefinitionError(f"{origin}: {error}") from None
    return _Parser(text, type_name, origin).definition(SECTIONS[kind])


class _Parser:
    """Parser of one file: it goes through the tokens once, and keeps what they define."""

    def __init__(self, text: str, type_name: str, origin: str) -> None:
        self.type_name, self.origin = type_name, origin
        self.package, _, self.short = type_name.split("/")
        self.tokens = list(self._tokens(text))
        self.at = 0
        self.modules: list[str] = []
        self.structs: dict[str, tuple[Field, ...]] = {}
        self.constants: dict[str, list[Constant]] = {}
        self.typedefs: dict[str, FieldType] = {}
        self.places: dict[str, Token] = {}

    def _tokens(self, text: str) -> Iterator[Token]:
        line, start = 1, 0
        for found in TOKEN.finditer(text):
            if found["token"] is not None:
                yield Token(found["token"], line, found.start() - start + 1)
            if "\n" in found[0]:
                line += found[0].count("\n")
                start = found.start() + found[0].rindex("\n") + 1
        yield Token("", line, len(text) - start + 1)

    def fail(self, token: Token, text: str) -> NoReturn:
        raise DefinitionError(f"{self.origin}:{token.line}:{token.column}: {text}")

    @property
    def next(self) -> Token:
        """The token to come; an empty one at the end."""
        return self.tokens[self.at]

    def take(self, expected: str = "") -> Token:
        """Take the next token, which must be `expected` if that is given."""
        token = self.next
        if not token.text or (expected and token.text != expected):
            found = f"'{shown(token.text)}'" if token.text else "the end of the file"
            self.fail(token, f"expected {repr(expected) if expected else 'more'}, got {found}")
        self.at += 1
        return token

    def takes(self, expected: str) -> bool:
        """Take the next token if it is `expected`."""
        if self.next.text != expected:
            return False
        self.at += 1
        return True

    def name(self, what: str) -> Token:
        """Take a name, which rosidl's rules allow for a `what`."""
        token = self.take()
        if wrong := wrong_name(what, token.text):
            self.fail(token, wrong)
        return token

    # ---- what a file defines ---------------------------------------------------------------------------------------

    def definition(self, suffixes: tuple[str, ...]) -> Definition:
        """Return the file's definition of the type."""
        while self.next.text:
            self._statement()
        expected = [self.short + suffix for suffix in suffixes]
        for name in expected:
            if name not in self.structs:
                there = ", ".join(self.structs) or "none"
                self.fail(
                    self.tokens[0], f"no struct {name} in the modules {self.package} and its kind; there is {there}"
                )
        sections = tuple(
            Section(self.type_name + suffix, (), self.structs[name], tuple(self.constants.get(name, ())), None)
            for suffix, name in zip(suffixes, expected, strict=True)
        )
        return Definition(self.type_name, sections, None, self.origin)

    def _statement(self) -> None:
        self._annotations()
        token = self.take()
        known: dict[str, Callable[[], None]] = {
            "module": self._module,
            "struct": self._struct,
            "const": self._constant,
            "typedef": self._typedef,
        }
        if token.text not in known:
            self.fail(token, f"'{shown(token.text)}' is not read here: a struct, const, typedef or module is")
        known[token.text]()
        self.takes(";")

    def _module(self) -> None:
        token = self.take()
        if len(self.modules) == DEEPEST:
            self.fail(token, f"modules more than {DEEPEST} deep")
        self.modules.append(token.text)
        self.take("{")
        while self.next.text != "}":
            self._statement()
        self.take("}")
        self.modules.pop()

    def _struct(self) -> None:
        name = self.take()
        self.take("{")
        fields: list[Field] = []
        while self.next.text != "}":
            fields.extend(self._members({each.name for each in fields}))
        self.take("}")
        self.structs[name.text] = tuple(fields)

    def _members(self, taken: set[str]) -> Iterator[Field]:
        default = self._annotations()
        begin = self.next
        kind = self._type()
        while True:
            name = self.name("field")
            if name.text in taken:
                self.fail(name, f"a second '{name.text}'")
            taken.add(name.text)
            whole = self._dimensions(kind)
            value = None if default is None else self._default(whole, default)
            if name.text != "structure_needs_at_least_one_member":
                yield Field(whole, name.text, value, line=begin.line, column=begin.column)
            if not self.takes(","):
                break
        self.take(";")

    def _constant(self) -> None:
        begin = self.next
        kind = self._type()
        if kind.base not in TYPE_IDS or kind.shape != "one":
            self.fail(begin, "only primitive types have constants")
        name = self.name("constant")
        self.take("=")
        value = self._value(kind, self._literal())
        self.take(";")
        owner = self.modules[-1].removesuffix("_Constants") if self.modules else ""
        self.constants.setdefault(owner, []).append(Constant(kind, name.text, value, line=name.line))

    def _typedef(self) -> None:
        kind = self._type()
        name = self.take()
        self.typedefs[name.text] = self._dimensions(kind)
        self.take(";")

    # ---- parts of these --------------------------------------------------------------------------------------------

    def _annotations(self) -> Token | None:
        """Skip annotations; return the value of `@default`."""
        default = None
        while self.takes("@"):
            name = self.take()
            if not self.takes("("):
                continue
            depth = 1
            while depth:
                token = self.take()
                depth += (token.text == "(") - (token.text == ")")
                if name.text == "default" and token.text == "=":
                    default = self.next
        return default

    def _type(self) -> FieldType:
        token = self.take()
        if token.text == "sequence":
            return self._sequence(token)
        if token.text in ("string", "wstring"):
            return FieldType(base=token.text, string_bound=self._bound() if self.takes("<") else 0)
        words = token.text
        while token.text in ("unsigned", "long") and self.next.text in ("long", "short", "double"):
            words += f" {self.take().text}"
        if words in PRIMITIVES:
            return FieldType(base=PRIMITIVES[words])
        parts = [token.text]
        while self.takes("::"):
            parts.append(self.take().text)
        if parts[-1] in self.typedefs:
            return self.typedefs[parts[-1]]
        return FieldType(base=self._message(parts, token, words))

    def _message(self, parts: list[str], token: Token, words: str) -> str:
        if len(parts) == 1:
            parts = [self.package, "msg", *parts]
        name = "/".join(parts)
        try:
            split_type_name(name)
        except MessageError:
            self.fail(
                token, f"'{shown(words)}' is not a type of rosidl: write double, string, sequence<T>, pkg::msg::Type"
            )
        if name == self.type_name:
            self.fail(token, f"{name} cannot contain itself")
        return name

    def _sequence(self, token: Token) -> FieldType:
        self.take("<")
        element = self._type()
        if element.shape != "one":
            self.fail(token, "ROS has no sequences of sequences")
        if self.takes(","):
            return msgspec.structs.replace(element, shape="bounded", size=self._bound())
        self.take(">")
        return msgspec.structs.replace(element, shape="sequence")

    def _bound(self) -> int:
        size = self._count()
        self.take(">")
        return size

    def _dimensions(self, kind: FieldType) -> FieldType:
        if not self.takes("["):
            return kind
        token = self.next
        if kind.shape != "one":
            self.fail(token, "ROS has no arrays of sequences")
        size = self._count()
        self.take("]")
        if self.next.text == "[":
            self.fail(self.next, "ROS has no arrays of arrays")
        return msgspec.structs.replace(kind, shape="array", size=size)

    def _count(self) -> int:
        token = self.take()
        named = next((each.value for all_ in self.constants.values() for each in all_ if each.name == token.text), None)
        size = named if isinstance(named, int) else int(token.text) if token.text.isdecimal() else 0
        if not 0 < size <= LARGEST:
            self.fail(token, f"'{shown(token.text)}': a size or bound is a whole number from 1 to {LARGEST}")
        return size

    def _literal(self) -> Token:
        """Take a value; quoted texts that stand behind each other are one."""
        token = self.take()
        while token.text.startswith('"') and self.next.text.startswith('"'):
            token = token._replace(text=token.text[:-1] + self.take().text[1:])
        return token

    def _default(self, kind: FieldType, token: Token) -> Any:
        if kind.base not in TYPE_IDS:
            self.fail(token, "only primitive types and arrays of them have defaults")
        return self._value(kind, token)

    def _value(self, kind: FieldType, token: Token) -> Any:
        text = {"TRUE": "true", "FALSE": "false"}.get(token.text, token.text)
        try:
            if kind.shape != "one":
                return literals.as_rosidl_said(kind, str(ast.literal_eval(text)))
            return literals.read(kind, text)
        except (ValueError, SyntaxError) as error:
            self.fail(token, str(error))
