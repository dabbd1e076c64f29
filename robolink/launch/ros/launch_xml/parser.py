"""Parser of launch files in XML."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from xml.etree import ElementTree
from xml.parsers import expat

from robolink.exceptions import DocumentError
from robolink.launch.ros.launch.bases import Place
from robolink.launch.ros.launch.frontend.parser import Parser as BaseParser
from robolink.launch.ros.launch.frontend.parser import SomeFile
from robolink.launch.ros.launch_xml.entity import Entity, Placed
from robolink.system.files import read_plain

__all__ = [
    "Parser",
]

LONGEST, DEEPEST, MOST = 5_000_000, 64, 100_000
"""Largest file in bytes, deepest nesting, and most elements."""


class Parser(BaseParser):
    """Parser of launch files in XML."""

    @classmethod
    def load(cls, file: SomeFile) -> tuple[Entity, Parser]:
        """Return the outermost element of a `file`, and a parser of it. Raises DocumentError with its line."""
        if not isinstance(file, (str, bytes, os.PathLike)):
            return Entity(_read(file.read(), str(getattr(file, "name", "<text>")))), cls()
        path = os.fsdecode(file)
        try:
            text = read_plain(Path(path), LONGEST)
        except OSError as error:
            raise DocumentError(f"cannot be read: {error.strerror}", path) from None
        return Entity(_read(text, path)), cls()

    @classmethod
    def get_file_extensions(cls) -> set[str]:
        """Return the ends of names of files in XML."""
        return {"launch.xml", "xml", "launch"}


def _read(text: str | bytes, file: str) -> ElementTree.Element:
    reader = _Reader(file)
    try:
        reader.parser.Parse(text, True)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        raise DocumentError(f"no XML: {reason}", file, error.lineno, error.offset + 1) from None
    top = reader.top
    if top is None:
        raise DocumentError("a launch file begins with <launch>", file, 1)
    _refuse_ros1(top)
    if reader.stray is not None:
        raise reader.stray
    return top


class _Reader:
    """Handler of the parser's events, which makes elements with their places."""

    def __init__(self, file: str) -> None:
        self._file, self._open, self._count = file, list[Placed](), 0
        self.top: Placed | None = None
        self.stray: DocumentError | None = None
        """Error about the first text between elements; ROS 1 has some there."""
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._begin
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._text
        self.parser.EntityDeclHandler = self._refuse

    def _begin(self, tag: str, attributes: dict[str, str]) -> None:
        line = self.parser.CurrentLineNumber
        element = Placed(tag, attributes)
        element.place = Place(self._file, line)
        self._count += 1
        if len(self._open) >= DEEPEST or self._count > MOST:
            raise DocumentError(f"nested over {DEEPEST} deep, or more than {MOST:,} elements", self._file, line)
        if self._open:
            self._open[-1].append(element)
        else:
            self.top = element
        self._open.append(element)

    def _end(self, _: str) -> None:
        self._open.pop()

    def _text(self, text: str) -> None:
        if text.strip() and self.stray is None:
            around = Entity(self._open[-1])
            self.stray = around.error(f"text stands in attributes, got '{text.strip()[:40]}'")

    def _refuse(self, name: str, *_: object) -> None:
        raise DocumentError(
            f"no entities are declared here, such as '{name[:40]}'", self._file, self.parser.CurrentLineNumber
        )


_TAGS = {"rosparam": "<rosparam> is <param from=...> in a node"}
_ATTRIBUTES = {
    ("node", "type"): "type= is exec=",
    ("node", "required"): 'required="true" is on_exit="shutdown"',
    ("node", "clear_params"): "clear_params= has no successor",
    ("include", "ns"): "<include ns=...> is <push_ros_namespace> in a <group>",
    ("include", "clear_params"): "clear_params= has no successor",
    ("include", "pass_all_args"): "pass_all_args= has no successor",
    ("group", "ns"): "<group ns=...> is <push_ros_namespace> in it",
}
_TEXTS = {
    "$(find ": "$(find x) is $(find-pkg-share x)",
    "$(arg ": "$(arg x) is $(var x)",
    "$(optenv ": "$(optenv x y) is $(env x y)",
}


def _refuse_ros1(top: Placed) -> None:
    """Raise DocumentError, with the words that have changed, if the elements below `top` are a launch file of ROS 1."""
    mark = next((each for each in top.iter() if _is_ros1(each)), None)
    if mark is not None:
        words = "; ".join(dict.fromkeys(filter(None, _changed(top))))
        place = getattr(mark, "place", Place())
        raise DocumentError(f"a launch file of ROS 1; in ROS 2 {words}", place.file, place.line)


def _is_ros1(element: ElementTree.Element) -> bool:
    """True if an element is one that only ROS 1 has."""
    is_node = element.tag == "node" and "type" in element.attrib and "exec" not in element.attrib
    return is_node or element.tag == "rosparam"


def _changed(top: ElementTree.Element) -> Iterable[str]:
    """Yield ROS 2's spelling of each word of ROS 1 in a file."""
    for each in top.iter():
        yield _TAGS.get(each.tag, "")
        yield from (_ATTRIBUTES.get((each.tag, name), "") for name in each.attrib)
        for value in each.attrib.values():
            yield from _words_in(value)
    if any(each.tag == "param" for each in top):
        yield "<param> stands in its <node>"


def _words_in(text: str) -> Iterator[str]:
    return (words for begin, words in _TEXTS.items() if begin in text)
