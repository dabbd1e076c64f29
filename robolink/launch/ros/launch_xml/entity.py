"""Element of a launch file in XML."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any
from xml.etree import ElementTree

from robolink.exceptions import nearest
from robolink.launch.ros.launch.bases import LaunchError, Place
from robolink.launch.ros.launch.frontend.type_utils import check_is_list_entity
from robolink.launch.ros.launch.typed_values import get_typed_value
from robolink.launch.ros.launch_frontend.elements import Element, spelled_alike
from robolink.system.terminal import shown

__all__ = [
    "Entity",
]


class Placed(ElementTree.Element):
    """Element of XML with its place in the file."""

    place = Place()


class Entity(Element):
    """Element of a launch file in XML; its attributes are texts, which become values of the types asked for.

    Args:
        xml_element: The element of XML.
        parent: Element around it.
    """

    def __init__(self, xml_element: ElementTree.Element, *, parent: Entity | None = None) -> None:
        super().__init__(xml_element.tag, getattr(xml_element, "place", Place()), parent)
        self._written = xml_element.attrib
        self._elements = [Entity(each, parent=self) for each in xml_element]
        self._requested_tags: dict[str, None] = {}

    @property
    def children(self) -> list[Entity]:
        """Elements in it."""
        self._requested_tags.update(dict.fromkeys(spelled_alike(each.type_name) for each in self._elements))
        return list(self._elements)

    def _names(self) -> Collection[str]:
        return self._written

    def assert_entity_completely_parsed(self) -> None:
        """Raise DocumentError if there is an attribute or an element in it that nothing has asked for."""
        super().assert_entity_completely_parsed()
        for each in self._elements:
            if spelled_alike(each.type_name) not in self._requested_tags:
                hint = nearest(each.type_name, self._requested_tags) or (
                    "" if self._requested_tags else ": it holds none"
                )
                raise each.error(f"'{self._tag}' holds no '{shown(each.type_name)}'{hint}")

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return the value of an attribute, which its text spells.

        With `NAME-sep` beside it, the text is parted by the text in that one, and a list.

        Args:
            name: Name of the attribute.
            data_type: Type of its value; `List[Entity]` for the elements of this name.
            optional: True returns None where it is not there.
            can_be_str: True takes a text that spells no value of the type, since it may hold substitutions.

        Raises:
            MissingError: if it is not there.
            WrongTypeError: for a text that spells no value of this type.
        """
        if check_is_list_entity(data_type):
            return self._inside(name, optional)
        self._requested[name] = None
        if name not in self._written:
            if optional:
                return None
            raise self.missing(name)
        value: str | list[str] = self._written[name]
        separator = f"{name}-sep"
        if separator in self._written:
            self._requested[separator] = None
            value = value.split(self._written[separator]) if self._written[separator] else value  # type: ignore[union-attr]
        try:
            return get_typed_value(value, data_type, can_be_str=can_be_str)
        except LaunchError as error:
            raise self.wrong_type(f"'{name}': {error}") from None

    def _inside(self, tag: str, optional: bool) -> list[Entity] | None:
        self._requested_tags[spelled_alike(tag)] = None
        found = [each for each in self._elements if spelled_alike(each.type_name) == spelled_alike(tag)]
        if not found and not optional:
            raise self.missing(tag)
        return found or None
