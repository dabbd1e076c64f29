"""ROS's field types as Python annotations, and their layout on the wire.

x: float64                                      float64 x
ranges: Sequence[float32]                       float32[] ranges
covariance: Annotated[Sequence[float64], Size(36)]    float64[36] covariance
names: Annotated[Sequence[string], AtMost(4)]   string[<=4] names
key: Annotated[string, AtMost(8)]               string<=8 key
LEFT: ClassVar[uint8] = 1                       uint8 LEFT=1
"""

from __future__ import annotations

import collections.abc
import functools
import types
import typing
from collections.abc import Callable
from typing import Annotated, Any, ClassVar, TypeVar

import msgspec

from robolink.exceptions import MessageError

Sequence = collections.abc.MutableSequence


MadeT = TypeVar("MadeT")


def once_per_type(make: Callable[[type[Any]], MadeT]) -> Callable[[type[Any]], MadeT]:
    """Cache the result of `make` for each class: functools.cache, whose own signature refuses classes."""
    known: dict[type[Any], MadeT] = {}

    @functools.wraps(make)
    def look_up(cls: type[Any]) -> MadeT:
        if cls not in known:
            known[cls] = make(cls)
        return known[cls]

    return look_up


class Primitive(msgspec.Struct, frozen=True):
    """Mark of an annotation of one of ROS's primitive types."""

    name: str


class Size(msgspec.Struct, frozen=True):
    """Mark of a sequence of exactly `length` elements."""

    length: int


class AtMost(msgspec.Struct, frozen=True):
    """Mark of a sequence of at most `length` elements, or of a string of at most so many characters."""

    length: int


int8 = Annotated[int, Primitive("int8")]
uint8 = Annotated[int, Primitive("uint8")]
int16 = Annotated[int, Primitive("int16")]
uint16 = Annotated[int, Primitive("uint16")]
int32 = Annotated[int, Primitive("int32")]
uint32 = Annotated[int, Primitive("uint32")]
int64 = Annotated[int, Primitive("int64")]
uint64 = Annotated[int, Primitive("uint64")]
float32 = Annotated[float, Primitive("float32")]
float64 = Annotated[float, Primitive("float64")]
boolean = Annotated[bool, Primitive("bool")]
byte = Annotated[bytes, Primitive("byte")]
char = Annotated[int, Primitive("char")]
string = Annotated[str, Primitive("string")]
wstring = Annotated[str, Primitive("wstring")]

PLAIN = {bool: "bool", int: "int64", float: "float64", str: "string", bytes: "byte"}
"""ROS types of Python's own types, where they are used as they are."""

NUMERIC = {
    "int8": "b",
    "uint8": "B",
    "char": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
    "float32": "f",
    "float64": "d",
}
"""Type codes, shared by `struct` and `array`, of the numeric primitives; their sequences are array.array."""


class FieldType(msgspec.Struct, frozen=True):
    """Type of one field on the wire."""

    base: str
    """A primitive's name, or the type name of a message such as ``geometry_msgs/msg/Point``."""
    message: type[Any] | None = None
    """Class of a nested message; any class here, since `base.Message` is made of field types."""
    string_bound: int = 0
    """Largest length of a bounded string or wstring in characters, as rclpy counts; 0 is unbounded."""
    shape: str = "one"
    """Shape: ``one``, ``array`` (fixed size), ``bounded`` or ``sequence``."""
    size: int = 0
    """Number of elements of an array, or the upper bound of a bounded sequence."""

    @property
    def code(self) -> str | None:
        """Type code of `array` if the elements are numbers, else None."""
        return NUMERIC.get(self.base)

    def __str__(self) -> str:
        """Return the type as a .msg file has it."""
        text = f"{self.base}<={self.string_bound}" if self.string_bound else self.base.replace("/msg/", "/")
        brackets = {"one": "", "array": f"[{self.size}]", "bounded": f"[<={self.size}]", "sequence": "[]"}
        return text + brackets[self.shape]


def field_type(annotation: Any, where: str) -> FieldType:
    """Return the field type of an annotation. Raises MessageError that names `where` if it is not a ROS type."""
    marks, plain = _split(annotation)
    if typing.get_origin(plain) in (collections.abc.MutableSequence, collections.abc.Sequence, list):
        (element,) = typing.get_args(plain)
        inner = field_type(element, where)
        if inner.shape != "one":
            raise MessageError(f"{where}: ROS has no sequences of sequences")
        return _with_shape(inner, marks)
    base = next((mark.name for mark in marks if isinstance(mark, Primitive)), None)
    bound = next((mark.length for mark in marks if isinstance(mark, AtMost)), 0)
    if base is None and hasattr(plain, "__ros_fields__"):
        return FieldType(base=plain.__ros_type__, message=plain)
    base = base or PLAIN.get(plain)
    if base is None:
        raise MessageError(f"{where}: {annotation!r} is not a ROS type (use float64, string, Sequence[...] ...)")
    return FieldType(base=base, string_bound=bound)


def _split(annotation: Any) -> tuple[tuple[Any, ...], Any]:
    if typing.get_origin(annotation) is Annotated:
        plain, *marks = typing.get_args(annotation)
        return tuple(marks), plain
    return (), annotation


def _with_shape(element: FieldType, marks: tuple[Any, ...]) -> FieldType:
    for mark in marks:
        if isinstance(mark, (Size, AtMost)):
            shape = "array" if isinstance(mark, Size) else "bounded"
            return msgspec.structs.replace(element, shape=shape, size=mark.length)
    return msgspec.structs.replace(element, shape="sequence")


def constant_type(annotation: Any) -> Any | None:
    """Return the type inside ClassVar[...], or None if the annotation is a field's."""
    if annotation is ClassVar:
        return Any
    if typing.get_origin(annotation) is ClassVar:
        return typing.get_args(annotation)[0]
    return None


def evaluate(annotations: dict[str, Any], module: str, frame: types.FrameType | None) -> dict[str, Any]:
    """Evaluate annotations that ``from __future__ import annotations`` left as text.

    Names are looked up where the class stands: its function's locals, then its module.
    """
    import sys

    if not any(isinstance(each, str) for each in annotations.values()):
        return annotations
    scope: dict[str, Any] = dict(vars(sys.modules[module])) if module in sys.modules else {}
    local = dict(frame.f_locals) if frame is not None else {}
    return {
        name: eval(each, scope, local) if isinstance(each, str) else each  # noqa: S307 - as typing does
        for name, each in annotations.items()
    }
