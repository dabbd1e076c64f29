"""Element of a launch file as XML and YAML share it: what was read of it, and what is wrong with the rest."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from robolink.exceptions import DocumentError, nearest
from robolink.launch.ros.launch.bases import Place
from robolink.launch.ros.launch.frontend.entity import Entity
from robolink.system.terminal import shown

CONDITIONS = ("if", "unless")
"""Attributes of every action, and of nothing else."""
RENAMED = {
    "ns": "namespace",
    "required": 'on_exit="shutdown"',
    "node-name": "name",
    "launch_prefix": "launch-prefix",
}
"""Words of other versions for attributes, with what ROS 2 reads."""


class MissingError(DocumentError, AttributeError):
    """An element lacks an attribute, or an element in it."""


class WrongTypeError(DocumentError, TypeError):
    """An attribute's value is of another type than the one that it has."""


class Element(Entity):
    """Element with its place in the file.

    Args:
        tag: Name as it is written.
        place: Place in the file.
        parent: Element around it.
    """

    def __init__(self, tag: str, place: Place, parent: Element | None) -> None:
        self._tag, self.place, self._parent = tag, place, parent
        self._requested: dict[str, None] = {}
        """Names of attributes that were asked for, whether they are there or not."""

    @property
    def type_name(self) -> str:
        """Name as it is written."""
        return self._tag

    @property
    def parent(self) -> Element | None:
        """Element around it; None for the outermost one."""
        return self._parent

    def _names(self) -> Collection[str]:
        """Return the names of its attributes, as they are written."""
        raise NotImplementedError

    def unread(self) -> list[str]:
        """Return the names of its attributes that nothing has asked for."""
        return [each for each in self._names() if each not in self._requested]

    def assert_entity_completely_parsed(self) -> None:
        """Raise DocumentError, with the nearest name, if there is an attribute that nothing has asked for."""
        for name in self.unread():
            raise self.error(unknown(name, self._requested, self._tag))

    def missing(self, name: str) -> DocumentError:
        """Return an error (to raise) that an attribute, `name`, is not there, or that it is misspelt."""
        for each in self.unread():
            if nearest(each, [name]):
                return MissingError(*self._placed(unknown(each, [name], self._tag)))
        return MissingError(*self._placed(f"'{name}' is missing"))

    def wrong_type(self, message: str) -> DocumentError:
        """Return an error (to raise) that a value is of another type, with this `message`."""
        return WrongTypeError(*self._placed(message))

    def _placed(self, message: str) -> tuple[str, str, int]:
        return f"{self._tag}: {message}", self.place.file, self.place.line


def unknown(name: str, known: Iterable[str], tag: str) -> str:
    """Return the sentence that an element has no such attribute.

    Args:
        name: Name that is written.
        known: Names that it has.
        tag: Name of the element.
    """
    known = list(known)
    if name in CONDITIONS:
        return f"'{name}' stands in actions such as node, group and include, and not in {tag}"
    other = RENAMED.get(name, "")
    advice = f": {other} is" if other.partition("=")[0] in known else nearest(name, known)
    return f"no attribute is called '{shown(name)}'{advice}"


def spelled_alike(name: str) -> str:
    """Return a `name` of an element in the one spelling that counts: `-` and `_` are the same in it."""
    return name.replace("-", "_")
