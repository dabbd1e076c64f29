"""rosidl's descriptions of a message's fields: the names and objects that programs written for it read.

The names are those of ROS 2's IDL mapping (https://design.ros2.org/articles/legacy_interface_definition.html): a .msg
`float64` is a `double`, `bool` a `boolean`, `byte` an `octet`, and `float32[]` a `sequence<float>`.
"""

from __future__ import annotations

from typing import Any

import msgspec

from robolink.message.annotations import FieldType
from robolink.system.patterns import late

IDL_NAMES = {"bool": "boolean", "byte": "octet", "char": "uint8", "float32": "float", "float64": "double"}
"""rosidl's names of the primitives where they differ from the .msg file's."""


KIND = late("/(msg|srv|action)/")
"""Middle part of a type name, which rosidl leaves out."""


class AbstractType(msgspec.Struct, frozen=True):
    """Base class of all types."""

    def has_maximum_size(self) -> bool:
        """True if the number of elements or characters has an upper bound."""
        return False


class AbstractNestableType(AbstractType, frozen=True):
    """Base class of types of one value, which can be the elements of a sequence."""


class AbstractGenericString(AbstractNestableType, frozen=True):
    """Base class of all texts."""


class AbstractString(AbstractGenericString, frozen=True):
    """Base class of strings."""


class AbstractWString(AbstractGenericString, frozen=True):
    """Base class of wstrings."""


class AbstractNestedType(AbstractType, frozen=True):
    """Base class of arrays and sequences of `value_type`."""

    value_type: Any


class AbstractSequence(AbstractNestedType, frozen=True):
    """Base class of sequences."""


class BasicType(AbstractNestableType, frozen=True):
    """Type of a number, a boolean or an octet."""

    typename: str


class NamespacedType(AbstractNestableType, frozen=True):
    """Type of a nested message: ``NamespacedType(("geometry_msgs", "msg"), "Point")``."""

    namespaces: tuple[str, ...]
    name: str

    def namespaced_name(self) -> tuple[str, ...]:
        """Return all parts of the name."""
        return (*self.namespaces, self.name)


class UnboundedString(AbstractString, frozen=True):
    """Type of a string."""


class BoundedString(AbstractString, frozen=True):
    """Type of a string of at most `maximum_size` characters."""

    maximum_size: int

    def has_maximum_size(self) -> bool:
        """True."""
        return True


class UnboundedWString(AbstractWString, frozen=True):
    """Type of a wstring."""


class BoundedWString(AbstractWString, frozen=True):
    """Type of a wstring of at most `maximum_size` characters."""

    maximum_size: int

    def has_maximum_size(self) -> bool:
        """True."""
        return True


class Array(AbstractNestedType, frozen=True):
    """Type of exactly `size` elements."""

    size: int

    def has_maximum_size(self) -> bool:
        """True."""
        return True


class BoundedSequence(AbstractSequence, frozen=True):
    """Type of at most `maximum_size` elements."""

    maximum_size: int

    def has_maximum_size(self) -> bool:
        """True."""
        return True


class UnboundedSequence(AbstractSequence, frozen=True):
    """Type of any number of elements."""


class SlotTypes:
    """Descriptor `SLOT_TYPES` of a message class: an object for each field, made when it is asked for."""

    def __get__(self, message: Any, owner: Any) -> tuple[Any, ...]:
        return tuple(slot_type(kind) for kind in owner.__ros_fields__.values())


class FieldTypes:
    """Descriptor `_fields_and_field_types` of a message class, the types by name, made when it is asked for.

    The name is private in ROS 2 too, but makers of schemas read it.
    """

    def __get__(self, message: Any, owner: Any) -> dict[str, str]:
        return {name: idl_name(kind) for name, kind in owner.__ros_fields__.items()}


def slot_type(kind: FieldType) -> Any:
    """Return the object that describes a field."""
    element = _element(kind)
    if kind.shape == "one":
        return element
    if kind.shape == "array":
        return Array(element, kind.size)
    return BoundedSequence(element, kind.size) if kind.shape == "bounded" else UnboundedSequence(element)


def _element(kind: FieldType) -> Any:
    if kind.base == "string":
        return BoundedString(kind.string_bound) if kind.string_bound else UnboundedString()
    if kind.base == "wstring":
        return BoundedWString(kind.string_bound) if kind.string_bound else UnboundedWString()
    if kind.message is not None:
        *namespaces, name = kind.base.split("/")
        return NamespacedType(tuple(namespaces), name)
    return BasicType(IDL_NAMES.get(kind.base, kind.base))


def idl_name(kind: FieldType) -> str:
    """Return a field's type as a text: ``sequence<float>``, ``double[36]``, ``string<10>``, ``geometry_msgs/Point``."""
    element = IDL_NAMES.get(kind.base, KIND.sub("/", kind.base))
    if kind.string_bound:
        element += f"<{kind.string_bound}>"
    if kind.shape == "one":
        return element
    if kind.shape == "array":
        return f"{element}[{kind.size}]"
    return f"sequence<{element}, {kind.size}>" if kind.shape == "bounded" else f"sequence<{element}>"
