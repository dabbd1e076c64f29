"""Element of a launch file in XML or YAML: a tag with attributes and elements inside, and its place."""

from __future__ import annotations

import shlex
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from robolink.companions.launch.bases import Condition, LaunchError, Place, Substitution
from robolink.companions.launch.conditions import IfCondition, UnlessCondition
from robolink.companions.launch.frontend.parse_substitution import parse_substitution, unescaped
from robolink.companions.launch.utilities import TextSubstitution
from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError, nearest
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
_MISSING = object()


@dataclass
class Entity:
    """Element of a launch file.

    Args:
        tag: Tag as it is written.
        place: Place in the file.
        attributes: Values by name: texts in XML, what YAML reads in YAML.
        children: Elements inside.
        is_typed: True in YAML, whose values have a type.
    """

    tag: str
    place: Place
    attributes: dict[str, Any] = field(default_factory=dict)
    children: list[Entity] = field(default_factory=list)
    is_typed: bool = False

    @property
    def name(self) -> str:
        """Name of the tag; `-` and `_` are the same in it."""
        return self.tag.replace("-", "_")

    def error(self, message: str) -> DocumentError:
        """Return an error (to raise) with this `message` at the place of the element."""
        return DocumentError(f"{self.tag}: {message}", self.place.file, self.place.line)

    def check(self, attributes: Collection[str], children: Collection[str] = ()) -> None:
        """Raise DocumentError, with the nearest name, unless there are only these `attributes` and `children`."""
        for name in self.attributes:
            if name not in attributes:
                raise self.error(self._unknown(name, attributes))
        for each in self.children:
            if each.name not in children:
                hint = nearest(each.name, children) or (": it holds none" if not children else "")
                raise each.error(f"'{self.tag}' holds no '{shown(each.tag)}'{hint}")

    def _unknown(self, name: str, attributes: Collection[str]) -> str:
        if name in CONDITIONS:
            return f"'{name}' stands in actions such as node, group and include, and not in {self.tag}"
        hint = nearest(name, attributes)
        other = RENAMED.get(name, "")
        advice = f": {other} is" if other.partition("=")[0] in attributes else hint
        return f"no attribute is called '{shown(name)}'{advice}"

    def condition(self) -> Condition | None:
        """Take the condition of an action, `if` or `unless`, from the attributes; None if it has none."""
        wanted, unwanted = (self.optional(each) for each in CONDITIONS)
        for each in CONDITIONS:
            self.attributes.pop(each, None)
        if wanted is not None and unwanted is not None:
            raise self.error("it has 'if' and 'unless': one of them is enough")
        if wanted is not None:
            return IfCondition(wanted)
        return None if unwanted is None else UnlessCondition(unwanted)

    def texts(self, name: str, *kinds: type) -> str | None:
        """Return the text of an attribute, `name`; None if it is not there.

        Raises DocumentError for a list, and in YAML for a value that is neither a text nor of one of these `kinds`.
        """
        value = self.attributes.get(name, _MISSING)
        if value is _MISSING:
            return None
        if isinstance(value, str):
            return value
        if type(value) in kinds:
            return str(value).lower() if isinstance(value, bool) else str(value)
        if isinstance(value, (list, dict)):
            raise self.error(f"'{name}' is one value, not a {'list' if isinstance(value, list) else 'mapping'}")
        if float in kinds and type(value) is int:
            raise self.error(f"'{name}' is a number with a point in ROS 2's YAML: write {name}: {value}.0")
        written = "" if value is None else spell(value)
        raise self.error(f"'{name}' is a text in ROS 2's YAML: write {name}: \"{shown(written, 60)}\"")

    def optional(self, name: str, *kinds: type) -> list[Substitution] | None:
        """Return the substitutions in an attribute, `name`; None if it is not there. Raises DocumentError.

        Args:
            name: Name of the attribute.
            *kinds: Types that it may have in YAML besides that of a text.
        """
        text = self.texts(name, *kinds)
        return None if text is None else self.parsed(text)

    def needed(self, name: str, *kinds: type) -> list[Substitution]:
        """Return the substitutions in `name`, of these `kinds`, as `optional` does. Raises DocumentError if none is."""
        found = self.optional(name, *kinds)
        if found is None:
            raise self.error(f"'{name}' is missing")
        return found

    def plain(self, name: str) -> str:
        """Return the text of an attribute, `name`, which has no substitutions. Raises DocumentError."""
        text = self.texts(name)
        if text is None:
            raise self.error(f"'{name}' is missing")
        return unescaped(text)

    def parsed(self, text: str) -> list[Substitution]:
        """Return a `text` of this element as substitutions. Raises DocumentError."""
        try:
            return parse_substitution(text)
        except LaunchError as error:
            raise self.error(str(error)) from None

    def words(self, name: str) -> list[list[Substitution]]:
        """Return the words of a command line in an attribute, `name`; none if it is not there. Raises DocumentError."""
        text = self.texts(name)
        try:
            return [] if text is None else words_of(self.parsed(text))
        except ValueError as error:
            reason = f"{error}: ROS 2 splits the text at each substitution, so that quotes around one do not close"
            raise self.error(f"'{name}': {reason}") from None

    def inside(self, tag: str) -> Iterator[Entity]:
        """Yield the children with this `tag`."""
        return (each for each in self.children if each.name == tag)


def words_of(parts: Iterable[Substitution]) -> list[list[Substitution]]:
    """Return the words of a command line: texts are split as a shell does, and a substitution is in one word.

    Args:
        parts: The command line, its texts and substitutions.

    Raises:
        ValueError: for a quote that is not closed within its text.
    """
    words: list[list[Substitution]] = [[]]
    for part in parts:
        if not isinstance(part, TextSubstitution):
            words[-1].append(part)
            continue
        pieces = shlex.split(part.text)
        if part.text[:1].isspace():
            words.append([])
        for number, piece in enumerate(pieces):
            words += [[]] if number else []
            words[-1].append(TextSubstitution(text=piece))
        if part.text[-1:].isspace():
            words.append([])
    return [each for each in words if each]
