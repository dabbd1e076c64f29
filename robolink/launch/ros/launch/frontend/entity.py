"""Element of a launch file, whatever language the file is in."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from robolink.exceptions import DocumentError
from robolink.launch.ros.launch.bases import LaunchError, Place

__all__ = [
    "Entity",
]


class Entity:
    """Element of a launch file; each language has a subclass of its own.

    An element knows what was read of it, so that what nothing has read can be refused.
    """

    place = Place()
    """Place in the file."""

    @property
    def type_name(self) -> str:
        """Name of the element, which says what it stands for."""
        raise NotImplementedError(f"{type(self).__name__} has no type_name")

    @property
    def parent(self) -> Entity | None:
        """Element around it; None for the outermost one."""
        raise NotImplementedError(f"{type(self).__name__} has no parent")

    @property
    def children(self) -> list[Any]:
        """Elements in it."""
        raise NotImplementedError(f"{type(self).__name__} has no children")

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return the value of an attribute.

        Args:
            name: Name of the attribute.
            data_type: Type of its value: str, int, float, bool, a list type of these, None for what YAML reads, or
                `List[Entity]` for the elements of this name.
            optional: True returns None where it is not there.
            can_be_str: True takes a text for any type, since it may hold substitutions.

        Raises:
            AttributeError: if it is not there.
            TypeError: for a value of another type.
        """
        raise NotImplementedError(f"{type(self).__name__} has no get_attr()")

    def assert_entity_completely_parsed(self) -> None:
        """Raise ValueError if there is an attribute or an element in it that nothing has read."""
        raise NotImplementedError(f"{type(self).__name__} has no assert_entity_completely_parsed()")

    def error(self, message: str) -> DocumentError:
        """Return an error (to raise) with this `message` at the place of the element."""
        return DocumentError(f"{self.type_name}: {message}", self.place.file, self.place.line)


@contextmanager
def placing(entity: Entity) -> Iterator[None]:
    """Turn a LaunchError of the block into a DocumentError at the place of `entity`."""
    try:
        yield
    except LaunchError as error:
        raise entity.error(str(error)) from None
