"""XML of strangers: elements with their lines, and nothing that XML can do to its reader (entities, DTDs, depth)."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple
from xml.parsers import expat

from robolink.exceptions import DocumentError
from robolink.system.files import read_plain, size

LARGEST = 5_000_000
"""Largest file that is read, in bytes."""

DEEPEST, MOST = 32, 100_000
"""Most elements within each other, and most elements at all."""


class Element(NamedTuple):
    """An element of an XML file."""

    tag: str
    """Name, after `{namespace}` if it has one."""
    attributes: dict[str, str]
    children: list[Element]
    words: list[str]
    file: str
    line: int

    @property
    def text(self) -> str:
        """Text between its tags, without the spaces around it."""
        return "".join(self.words).strip()

    @property
    def size(self) -> int:
        """Number of elements within it, itself included."""
        return 1 + sum(child.size for child in self.children)

    def all(self, *path: str) -> Iterator[Element]:
        """Yield the elements below it that are reached by these tags."""
        for child in self.children:
            if child.tag == path[0]:
                yield from [child] if len(path) == 1 else child.all(*path[1:])

    def mistake(self, message: str) -> DocumentError:
        """Return an error that begins with the place of this element."""
        return DocumentError(message, self.file, self.line)


def read(path: Path) -> Element:
    """Read an XML file; raises DocumentError with its place for whatever is wrong in it."""
    try:
        return parse(read_plain(path, LARGEST), str(path))
    except (OSError, ValueError) as error:
        if isinstance(error, DocumentError):
            raise
        raise DocumentError(getattr(error, "strerror", None) or str(error), str(path)) from None


def parse(content: bytes, name: str) -> Element:
    """Return the root element of an XML text; raises DocumentError with its place."""
    if len(content) > LARGEST:
        raise DocumentError(f"it is longer than {size(LARGEST)}", name)
    parser = expat.ParserCreate(namespace_separator=" ")
    parser.buffer_text = True
    found: list[Element] = []
    stack: list[Element] = []
    count = 0

    def refuse(*_: object) -> None:
        raise DocumentError("a DOCTYPE or entities, which are not read here", name, parser.CurrentLineNumber)

    def begin(tag: str, attributes: dict[str, str]) -> None:
        nonlocal count
        count += 1
        if len(stack) >= DEEPEST or count > MOST:
            limit = f"deeper than {DEEPEST} elements" if len(stack) >= DEEPEST else f"more than {MOST} elements"
            raise DocumentError(limit, name, parser.CurrentLineNumber)
        named = {_braced(key): value for key, value in attributes.items()}
        element = Element(_braced(tag), named, [], [], name, parser.CurrentLineNumber)
        (stack[-1].children if stack else found).append(element)
        stack.append(element)

    def write(text: str) -> None:
        stack[-1].words.append(text)

    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = refuse
    parser.StartElementHandler = begin
    parser.EndElementHandler = lambda tag: stack.pop()
    parser.CharacterDataHandler = write
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        raise DocumentError(f"no XML: {expat.ErrorString(error.code)}", name, error.lineno, error.offset + 1) from None
    except (ValueError, LookupError) as error:  # an encoding that is none
        if isinstance(error, DocumentError):
            raise
        raise DocumentError(f"no XML: {error}", name) from None
    return found[0]


def spell(element: Element, indent: str = "") -> str:
    """Return the text of an element, with its children on lines of their own."""
    from xml.sax.saxutils import escape, quoteattr  # late: it imports urllib and http, 50 ms of a session's start

    head = element.tag + "".join(f" {key}={quoteattr(value)}" for key, value in element.attributes.items())
    if element.children:
        inner = "".join(spell(child, indent + "  ") for child in element.children)
        return f"{indent}<{head}>\n{inner}{indent}</{element.tag}>\n"
    return f"{indent}<{head}>{escape(element.text)}</{element.tag}>\n" if element.text else f"{indent}<{head}/>\n"


def make(tag: str, attributes: dict[str, str] | None = None, *children: Element, text: str = "") -> Element:
    """Make an element that is to be spelled."""
    return Element(tag, attributes or {}, list(children), [text], "", 0)


def _braced(name: str) -> str:
    space, _, local = name.rpartition(" ")
    return f"{{{space}}}{local}" if space else local
