"""Reader of XML launch files: text to elements with their lines."""

from __future__ import annotations

from pathlib import Path
from xml.parsers import expat

from robolink.companions.launch.bases import Place
from robolink.companions.launch_frontend.entity import Entity
from robolink.companions.launch_frontend.ros1 import refuse_ros1
from robolink.exceptions import DocumentError
from robolink.system.files import read_plain

LONGEST, DEEPEST, MOST = 5_000_000, 64, 100_000
"""Largest file in bytes, deepest nesting, and most elements."""


def read_xml(path: Path) -> Entity:
    """Return the `launch` element of an XML file, `path`. Raises DocumentError with its line."""
    file = str(path)
    try:
        text = read_plain(path, LONGEST)
    except OSError as error:
        raise DocumentError(f"cannot be read: {error.strerror}", file) from None
    reader = _Reader(file)
    try:
        reader.parser.Parse(text, True)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        raise DocumentError(f"no XML: {reason}", file, error.lineno, error.offset + 1) from None
    top = reader.top
    if top is None or top.name != "launch":
        raise DocumentError("a launch file begins with <launch>", file, 1)
    refuse_ros1(top)
    if reader.stray is not None:
        raise reader.stray
    return top


class _Reader:
    """Handler of the parser's events."""

    def __init__(self, file: str) -> None:
        self._file, self._open, self._count = file, list[Entity](), 0
        self.top: Entity | None = None
        self.stray: DocumentError | None = None
        """Error about the first text between elements; ROS 1 has some there."""
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._begin
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text
        self.parser.EntityDeclHandler = self._refuse

    def _begin(self, tag: str, attributes: dict[str, str]) -> None:
        line = self.parser.CurrentLineNumber
        entity = Entity(tag, Place(self._file, line), dict(attributes))
        self._count += 1
        if len(self._open) >= DEEPEST or self._count > MOST:
            raise DocumentError(f"nested over {DEEPEST} deep, or more than {MOST:,} elements", self._file, line)
        if self._open:
            self._open[-1].children.append(entity)
        else:
            self.top = entity
        self._open.append(entity)

    def _end(self, _: str) -> None:
        self._open.pop()

    def _text(self, text: str) -> None:
        if text.strip() and self.stray is None:
            self.stray = self._open[-1].error(f"text stands in attributes, got '{text.strip()[:40]}'")

    def _refuse(self, name: str, *_: object) -> None:
        raise DocumentError(
            f"no entities are declared here, such as '{name[:40]}'", self._file, self.parser.CurrentLineNumber
        )
