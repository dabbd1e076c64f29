"""Element of a launch file in XML or YAML: a tag with attributes and elements inside, and its place."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from typing import TypeAlias

from robolink.companions.launch.bases import LaunchError, Place, Substitution
from robolink.companions.launch.frontend.parse_substitution import parse_substitution
from robolink.exceptions import DocumentError, nearest
from robolink.system.terminal import shown


@dataclass(frozen=True)
class Text:
    """Value of an attribute as it is written.

    Args:
        text: The text.
        is_plain: True if it has no quotes, so that it may be a number.
    """

    text: str
    is_plain: bool = True


Value: TypeAlias = "Text | list[Value]"


@dataclass
class Entity:
    """Element of a launch file.

    Args:
        tag: Tag as it is written.
        place: Place in the file.
        attributes: Values by name.
        children: Elements inside.
    """

    tag: str
    place: Place
    attributes: dict[str, Value] = field(default_factory=dict)
    children: list[Entity] = field(default_factory=list)

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
            if name not in (*attributes, "if", "unless"):
                raise self.error(f"no attribute is called '{shown(name)}'{nearest(name, attributes)}")
        for each in self.children:
            if each.name not in children:
                hint = nearest(each.name, children) or (": it holds none" if not children else "")
                raise each.error(f"'{self.tag}' holds no '{shown(each.tag)}'{hint}")

    def texts(self, name: str) -> str | None:
        """Return the text of an attribute, `name`; None if it is not there. Raises DocumentError for a list."""
        value = self.attributes.get(name)
        if isinstance(value, list):
            raise self.error(f"'{name}' is one value, not a list")
        return None if value is None else value.text

    def optional(self, name: str) -> list[Substitution] | None:
        """Return the substitutions in an attribute, `name`; None if it is not there. Raises DocumentError."""
        text = self.texts(name)
        return None if text is None else self.parsed(text)

    def needed(self, name: str) -> list[Substitution]:
        """Return the substitutions in an attribute, `name`. Raises DocumentError if it is not there."""
        found = self.optional(name)
        if found is None:
            raise self.error(f"'{name}' is missing")
        return found

    def plain(self, name: str) -> str:
        """Return the text of an attribute, `name`, which has no substitutions. Raises DocumentError."""
        text = self.texts(name)
        if text is None:
            raise self.error(f"'{name}' is missing")
        return text

    def parsed(self, text: str) -> list[Substitution]:
        """Return a `text` of this element as substitutions. Raises DocumentError."""
        try:
            return parse_substitution(text)
        except LaunchError as error:
            raise self.error(str(error)) from None

    def words(self, name: str) -> list[list[Substitution]]:
        """Return the words of a command line in an attribute, `name`; none if it is not there."""
        text = self.texts(name)
        return [] if text is None else [self.parsed(each) for each in split(text)]

    def inside(self, tag: str) -> Iterator[Entity]:
        """Yield the children with this `tag`."""
        return (each for each in self.children if each.name == tag)


def split(text: str) -> list[str]:
    """Return the words of a command line, `text`: blanks within quotes and within `$(...)` do not part it.

    >>> split("-d '$(var a) b'  $(eval 1 + 2)")
    ['-d', '$(var a) b', '$(eval 1 + 2)']
    """
    words, word, quote, depth, has_word = [], "", "", 0, False
    for index, each in enumerate(text):
        if depth == 0 and each == quote:
            quote = ""
        elif depth == 0 and not quote and each in "'\"":
            quote, has_word = each, True
        elif depth == 0 and not quote and each.isspace():
            words += [word] if has_word else []
            word, has_word = "", False
        else:
            depth += (each == "(" and (depth > 0 or text[index - 1 : index] == "$")) - (each == ")" and depth > 0)
            word, has_word = word + each, True
    return [*words, word] if has_word else words
