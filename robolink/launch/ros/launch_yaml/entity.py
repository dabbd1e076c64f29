"""Element of a launch file in YAML."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any

from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError
from robolink.launch.ros.launch.bases import LaunchError, Place
from robolink.launch.ros.launch.frontend.type_utils import check_is_list_entity
from robolink.launch.ros.launch.typed_values import extract_type, is_instance_of
from robolink.launch.ros.launch.utilities import checked
from robolink.launch.ros.launch_frontend.elements import Element, spelled_alike
from robolink.system.terminal import shown

__all__ = [
    "Entity",
]


class PlacedList(list[Any]):
    """List of YAML with the lines of its items."""

    def __init__(self, items: list[Any], file: str, lines: list[int]) -> None:
        super().__init__(items)
        self.places = [Place(file, line) for line in lines]


class Entity(Element):
    """Element of a launch file in YAML; its values have the types that they are written in.

    Args:
        element: Its attributes by name, or the list of the elements in it.
        type_name: Its name.
        parent: Element around it.
    """

    def __init__(self, element: Any, type_name: str = "", *, parent: Entity | None = None) -> None:
        super().__init__(type_name, Place() if parent is None else parent.place, parent)
        self._element = element
        self._elements: dict[str, list[Entity]] = {}

    @property
    def children(self) -> list[Entity]:
        """Elements in it: those of its list, or of the list `children` of its attributes. Raises MissingError."""
        if self._element is None:
            return []
        self._requested["children"] = None
        if isinstance(self._element, dict) and "children" not in self._element:
            raise self.missing("children")
        if "children" not in self._elements:
            found = self._element["children"] if isinstance(self._element, dict) else self._element
            if not isinstance(found, list):
                raise self.wrong_type("a list of actions is expected")
            self._elements["children"] = [self._child(*each) for each in _items(found, self.place)]
        return list(self._elements["children"])

    def _child(self, item: Any, place: Place) -> Entity:
        if not isinstance(item, dict) or len(item) != 1:
            text = "each action is a mapping with one key, such as `- node: {...}`"
            raise DocumentError(text, place.file, place.line)
        ((name, value),) = item.items()
        child = Entity(value, str(name), parent=self)
        child.place = place
        return child

    def _names(self) -> Collection[str]:
        return list(self._element) if isinstance(self._element, dict) else []

    def assert_entity_completely_parsed(self) -> None:
        """Raise DocumentError if there is an attribute or an element in it that nothing has asked for."""
        if isinstance(self._element, list) and "children" not in self._requested:
            raise self._not_a_mapping()
        super().assert_entity_completely_parsed()

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return the value of an attribute.

        Args:
            name: Name of the attribute.
            data_type: Type of its value; `List[Entity]` for the elements in its list.
            optional: True returns None where it is not there.
            can_be_str: True takes a text for any type, since it may hold substitutions.

        Raises:
            MissingError: if it is not there.
            WrongTypeError: for a value of another type.
        """
        if self._element is not None and not isinstance(self._element, (dict, list)):
            raise self._not_a_mapping()
        is_list = check_is_list_entity(data_type)
        key = self._written(name) if is_list else name
        self._requested[key] = None
        if not isinstance(self._element, dict) or key not in self._element:
            if optional:
                return None
            raise self._not_a_mapping() if isinstance(self._element, list) else self.missing(name)
        value = self._element[key]
        if is_list:
            return self._inside(key, value)
        self._check(name, value, data_type, can_be_str)
        return value

    def _written(self, name: str) -> str:
        """Return a key as it is written: `-` and `_` are the same in the name of an element."""
        return next((each for each in self._names() if spelled_alike(each) == spelled_alike(name)), name)

    def _inside(self, key: str, value: Any) -> list[Entity]:
        if not isinstance(value, list):
            raise self.wrong_type(f"'{key}' is a list of mappings, such as [{{name: ...}}]")
        if key not in self._elements:
            self._elements[key] = []
            for item, place in _items(value, self.place):
                child = Entity(item, key, parent=self)
                child.place = place
                self._elements[key].append(child)
        return list(self._elements[key])

    def _not_a_mapping(self) -> DocumentError:
        return self.wrong_type("a mapping of its attributes is expected")

    def _check(self, name: str, value: Any, data_type: Any, can_be_str: bool) -> None:
        """Raise WrongTypeError unless a value is of a type."""
        if isinstance(value, list) and (data_type is None or extract_type(data_type)[1]):
            self._check_list(name, value, data_type, can_be_str)
            return
        if isinstance(value, (list, dict)):
            kind = "list" if isinstance(value, list) else "mapping"
            raise self.wrong_type(f"'{name}' is one value, not a {kind}")
        if isinstance(value, str) and (can_be_str or data_type in (str, None)):
            return
        if data_type is None:
            self._checked(value, value)
        elif data_type is float and type(value) is int:
            raise self.wrong_type(f"'{name}' is a number with a point in ROS 2's YAML: write {name}: {value}.0")
        elif not is_instance_of(value, data_type):
            written = "" if value is None else spell(value)
            text = f"'{name}' is a text in ROS 2's YAML: write {name}: \"{shown(written, 60)}\""
            raise self.wrong_type(text if can_be_str else f"'{name}': expected {data_type}, got {value!r:.40}")

    def _check_list(self, name: str, value: list[Any], data_type: Any, can_be_str: bool) -> None:
        kind = None if data_type is None else extract_type(data_type)[0]
        plain = [each for each in value if not (can_be_str and isinstance(each, str))]
        self._checked(plain or [""], value)
        if kind is not None and not all(isinstance(each, kind) for each in plain):
            raise self.wrong_type(f"'{name}' is a list of {kind.__name__}, got {value!r:.40}")

    def _checked(self, value: Any, said: object) -> None:
        try:
            checked(value, said)
        except LaunchError as error:
            raise self.wrong_type(str(error)) from None


def _items(found: list[Any], around: Place) -> Iterator[tuple[Any, Place]]:
    """Yield the items of a list, each with its place; that of the element around if it is unknown."""
    return zip(found, getattr(found, "places", [around] * len(found)), strict=True)
