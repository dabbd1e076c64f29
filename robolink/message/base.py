"""The base class of every message: a msgspec Struct whose fields all have ROS's defaults.

A subclass states its fields and nothing else::

    class Twist(Message):
        linear: Vector3
        angular: Vector3

`Twist().linear.x = 0.3` then works, as in rclpy. Sequences of numbers are array.array and fixed arrays of numbers are
numpy arrays; whatever sequence is assigned to them is converted, a copy, once.
"""

from __future__ import annotations

import functools
import re
import sys
from array import array
from collections.abc import Callable, Iterator
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

import msgspec

from robolink.exceptions import EncodeError, MessageError, nearest
from robolink.message import annotations as ros
from robolink.message.annotations import FieldType
from robolink.message.slot_types import SlotTypes, idl_name
from robolink.message.spelling import wrong_name

ZEROS: dict[str, Any] = {"bool": False, "byte": b"\x00", "string": "", "wstring": ""}
DTYPES = {
    "b": "int8",
    "B": "uint8",
    "h": "int16",
    "H": "uint16",
    "i": "int32",
    "I": "uint32",
    "q": "int64",
    "Q": "uint64",
    "f": "float32",
    "d": "float64",
}
"""`array` type code to numpy's name of the same type."""


class MessageMeta(msgspec.StructMeta):
    """Makes a Struct of a class body: reads its annotations, gives every field ROS's default."""

    def __new__(
        mcls, name: str, bases: tuple[type, ...], namespace: dict[str, Any], type_name: str | None = None
    ) -> Any:
        """`type_name` is ``package/msg/Name``; without it the module and class say what the type is called.

        The Struct also takes its fields by position, for the codec alone: a metaclass's class calls slowly by name.
        """
        full_name = type_name or _type_name(namespace["__module__"], namespace["__qualname__"])
        for base in bases:
            if getattr(base, "__ros_fields__", None):
                return _Extended.__new__(_Extended, name, bases, namespace, full_name)
        annotations = ros.evaluate(_annotations(namespace), namespace["__module__"], sys._getframe(1))
        fields, constants = _read(annotations, namespace, full_name)
        defaults = {field: namespace[field] for field in fields if field in namespace}
        _check_defaults(full_name, fields, defaults)
        for field, kind in fields.items():
            namespace[field] = _default(kind, namespace.get(field, msgspec.NODEFAULT))
        for constant in constants:
            annotations.pop(constant)
        namespace.update(
            __annotations__=annotations,
            __ros_type__=full_name,
            __ros_fields__=fields,
            __ros_constants__=constants,
            __ros_defaults__=defaults,
        )
        converted = {field: kind for field, kind in fields.items() if kind.shape != "one" and kind.code}
        # Numbers and text make no reference cycles: without the collector's header a message is made faster.
        cycles = any(kind.shape != "one" and not kind.code for kind in fields.values())
        cls = super().__new__(
            mcls, name, bases, namespace, eq=False, forbid_unknown_fields=True, gc=cycles or not fields
        )
        # rosidl's slots: programs walk them for the names of the fields
        cls.__slots__ = tuple(f"_{field}" for field in fields)  # type: ignore[attr-defined]
        for field, kind in converted.items():
            setattr(cls, field, (_FixedNumbers if kind.shape == "array" else _Numbers)(cls, field, kind))
        return cls


class _Extended(MessageMeta):
    """Makes the class of a message that adds methods and attributes, but no fields, to another message."""

    def __new__(mcls, name: str, bases: tuple[type, ...], namespace: dict[str, Any], type_name: str = "") -> Any:
        if _annotations(namespace):
            raise MessageError(
                f"{type_name or name}: a message cannot extend another ({bases[-1].__name__}): make it a field"
            )
        init = namespace.pop("__init__", None)  # msgspec takes none
        namespace.setdefault("__reduce__", _parts)
        cls = msgspec.StructMeta.__new__(mcls, name, bases, namespace, eq=False, gc=True, dict=True)
        if init is not None:
            type.__setattr__(cls, "__init__", init)
        return cls

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        made = _bare(self)
        type(made).__init__(made, *args, **kwargs)
        return made


def _bare(cls: Any) -> Any:
    """Make such a message without its own constructor."""
    return msgspec.StructMeta.__call__(cls)


def _parts(message: Any) -> Any:
    """Say of what a copy is made, as `copy` and `pickle` ask it."""
    return _bare, (type(message),), (vars(message), {name: getattr(message, name) for name in message.__ros_fields__})


def _annotations(namespace: dict[str, Any]) -> dict[str, Any]:
    if "__annotate_func__" in namespace:  # Python 3.14 evaluates annotations late
        return dict(namespace.pop("__annotate_func__")(1))
    return dict(namespace.get("__annotations__", {}))


def _type_name(module: str, qualname: str) -> str:
    """``robolink.interfaces.std_srvs.srv`` and ``SetBool.Request`` make ``std_srvs/srv/SetBool_Request``."""
    name = "_".join(part for part in qualname.rpartition("<locals>.")[2].split("."))
    *_, package, kind, part = ["", "", *module.split(".")]
    if not part.startswith("_"):  # a private part of a package is skipped: sensor_msgs.msg._camera
        package, kind = kind, part
    if kind in ("msg", "srv", "action") and package:
        return f"{package}/{kind}/{name}"
    if module == "__main__":
        module = getattr(sys.modules.get("__main__"), "__file__", None) or "main"
    stem = PurePath(module).stem if ("/" in module or "\\" in module) else module.rpartition(".")[2]
    package = re.sub("[^a-z0-9]+", "_", stem.lower()).strip("_")  # rosidl's rule for the names of packages
    return f"{package if package[:1].isalpha() else f'node_{package}'.rstrip('_')}/msg/{name}"


def _read(
    annotations: dict[str, Any], namespace: dict[str, Any], type_name: str
) -> tuple[dict[str, FieldType], dict[str, tuple[FieldType, Any]]]:
    fields: dict[str, FieldType] = {}
    constants: dict[str, tuple[FieldType, Any]] = {}
    for name, annotation in annotations.items():
        constant = ros.constant_type(annotation)
        wrong = wrong_name("field" if constant is None else "constant", name)
        if wrong:
            raise MessageError(f"{type_name}: {wrong}")
        if constant is None:
            fields[name] = ros.field_type(annotation, f"{type_name}.{name}")
        elif name not in namespace:
            raise MessageError(f"{type_name}: the constant {name} has no value: write {name}: ClassVar[...] = ...")
        else:
            constants[name] = (ros.field_type(constant, f"{type_name}.{name}"), namespace[name])
    return fields, constants


def _check_defaults(type_name: str, fields: dict[str, FieldType], defaults: dict[str, Any]) -> None:
    for name, value in defaults.items():
        from robolink.message.check import explain_value  # late: it needs this module, and few types state any

        kind, where = fields[name], f"{type_name}.{name}"
        if kind.message is not None:
            raise MessageError(f"{where}: {kind} can have no default: only primitive types and arrays of them can")
        wrong = explain_value(kind, value, where)
        if wrong:
            raise MessageError(f"a default that does not fit: {wrong}")


def _default(kind: FieldType, given: Any) -> Any:
    """Give what msgspec takes as a field's default: a value, or a factory for what can change."""
    if kind.shape == "one":
        if kind.message is not None:
            return msgspec.field(default_factory=kind.message) if given is msgspec.NODEFAULT else given
        zero = ZEROS.get(kind.base, 0.0 if kind.code in ("f", "d") else 0)
        return zero if given is msgspec.NODEFAULT else given
    if given is not msgspec.NODEFAULT:
        return msgspec.field(default_factory=lambda: list(given))
    return msgspec.field(default_factory=_empty(kind))


def _empty(kind: FieldType) -> Callable[[], Any]:
    if kind.shape != "array":
        return functools.partial(array, kind.code) if kind.code else list
    if kind.code:
        return lambda: _numpy_zeros(kind)
    if kind.message is not None:
        message = kind.message
        return lambda: [message() for _ in range(kind.size)]
    return lambda: [ZEROS[kind.base]] * kind.size


def _numpy_zeros(kind: FieldType) -> Any:
    import numpy as np  # late: most commands make no message with a fixed array

    return np.zeros(kind.size, DTYPES[kind.code or "d"])


class _Numbers:
    """A field that is a sequence of numbers, kept as an array.array.

    An assignment converts at once. The constructor, which stores without asking, is made good at the first look.
    """

    def __init__(self, cls: Any, name: str, kind: FieldType) -> None:
        member = cls.__dict__[name]
        self.stored: Callable[[Any], Any] = member.__get__
        self.store: Callable[[Any, Any], None] = member.__set__
        self.kind, self.code = kind, kind.code or "d"
        self.shape = (kind.size,)
        self.where = f"{cls.__name__}.{name}"

    def __get__(self, message: Any, owner: type | None = None) -> Any:
        if message is None:
            return self
        value = self.stored(message)
        if type(value) is not array or value.typecode != self.code:
            value = self.convert(value)
            self.store(message, value)
        return value

    def __set__(self, message: Any, value: Any) -> None:
        self.store(message, self.convert(value))

    def convert(self, value: Any) -> Any:
        """Give `value` as it is kept. Raises EncodeError that names the field."""
        if type(value) is array and value.typecode == self.code:
            return value
        if type(value) is memoryview and value.format == self.code and value.contiguous:
            return value  # a large uint8[] arrives as a view of the bytes received
        try:
            if hasattr(value, "__array_interface__"):
                return array(self.code, _as_numpy(value, self.code).tobytes())
            return array(self.code, value)
        except (TypeError, ValueError, OverflowError) as error:
            raise EncodeError(f"{self.where}: expected {self.kind}, got {_shown(value)} ({error})") from None


class _FixedNumbers(_Numbers):
    """A field that is a fixed number of numbers, kept as a numpy array."""

    dtype: Any = "not known before numpy is imported"

    def __get__(self, message: Any, owner: type | None = None) -> Any:
        if message is None:
            return self
        value = self.stored(message)
        if getattr(value, "dtype", None) is not self.dtype or value.shape != self.shape or not value.flags.c_contiguous:
            value = self.convert(value)
            self.store(message, value)
        return value

    def convert(self, value: Any) -> Any:
        """Give `value` as it is kept. Raises EncodeError that names the field."""
        try:
            found = _as_numpy(value, self.code)
        except (TypeError, ValueError, OverflowError) as error:
            raise EncodeError(f"{self.where}: expected {self.kind}, got {_shown(value)} ({error})") from None
        if found.shape != self.shape:
            raise EncodeError(f"{self.where}: expected {self.kind}, got {found.size} elements")
        self.dtype = found.dtype
        return found


def _as_numpy(value: Any, code: str) -> Any:
    import numpy as np

    dtype = np.dtype(DTYPES[code])
    given = np.asarray(memoryview(value) if code == "B" and isinstance(value, (bytes, bytearray)) else value)
    if given.dtype.kind == "f" and code == "Q" and isinstance(value, (list, tuple)) and _are_uint64(value):
        given = np.array(value, dtype)  # numpy makes floats of ints that lie on both sides of 2**63
    if given.dtype == dtype:
        return np.ascontiguousarray(given)
    # Python ints are int64 to numpy: they may go into narrower types when the values fit.
    narrowed = given.dtype.kind in "iub" and dtype.kind in "iu"
    if given.size and not narrowed and not np.can_cast(given.dtype, dtype, "same_kind"):
        raise TypeError(f"{given.dtype} is not {dtype}")
    if dtype.kind in "iu" and given.size:
        low, high = np.iinfo(dtype).min, np.iinfo(dtype).max
        if given.min() < low or given.max() > high:
            raise OverflowError(f"out of {low} to {high}")
    return np.ascontiguousarray(given.astype(dtype))


def _are_uint64(values: Any) -> bool:
    return all(isinstance(each, int) and 0 <= each < 1 << 64 for each in values)


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


if TYPE_CHECKING:

    class Message:
        """A ROS message. Fields are keyword arguments; each has ROS's default."""

        __ros_type__: str
        __ros_fields__: dict[str, FieldType]
        __ros_constants__: dict[str, tuple[FieldType, Any]]
        __ros_defaults__: dict[str, Any]
        """The defaults that the class states; all other fields begin with ROS's zero."""

        def __init__(self, **fields: Any) -> None: ...

        def __init_subclass__(cls, *, type_name: str | None = None) -> None: ...

        SLOT_TYPES: tuple[Any, ...]
        """An object for each field that says what it holds, as rosidl_parser.definition has them."""

        @classmethod
        def get_fields_and_field_types(cls) -> dict[str, str]:
            """Each field's name and its type, as rosidl says it: ``double``, ``sequence<float>``."""

else:

    class Message(msgspec.Struct, metaclass=MessageMeta, type_name="robolink/msg/Message"):
        """A ROS message. Fields are keyword arguments; each has ROS's default."""

        SLOT_TYPES = SlotTypes()

        @classmethod
        def get_fields_and_field_types(cls) -> dict[str, str]:
            """Each field's name and its type, as rosidl says it: ``double``, ``sequence<float>``."""
            return {name: idl_name(kind) for name, kind in cls.__ros_fields__.items()}

        def __getattr__(self, name: str) -> Any:
            if name[1:] in self.__ros_fields__ and name[0] == "_":  # what `__slots__` calls a field
                return getattr(self, name[1:])
            raise AttributeError(_no_field(self.__class__, name))

        def __eq__(self, other: object) -> bool:
            if other.__class__ is not self.__class__:
                return NotImplemented
            return all(_same(getattr(self, name), getattr(other, name)) for name in self.__ros_fields__)

        __hash__ = None

        def __repr__(self) -> str:
            package, kind, name = self.__ros_type__.split("/")
            return f"{package}.{kind}.{name}({', '.join(_shown_fields(self))})"


@functools.lru_cache(maxsize=256)  # programs ask `hasattr(message, "header")` of each message
def _no_field(cls: Any, name: str) -> str:
    known = cls.__ros_fields__
    near = "" if name.startswith("__") else nearest(name, known)
    return f"{cls.__ros_type__} has no field {name!r}{near}, only {', '.join(known)}"


def _set_fields(message: Any, **fields: Any) -> None:
    for name, value in fields.items():
        if name not in message.__ros_fields__:
            raise TypeError(_no_field(message.__class__, name))
        setattr(message, name, value)


if not TYPE_CHECKING:
    Message.__init__ = _set_fields  # for those that extend a message: see `_Extended`


def _same(left: Any, right: Any) -> bool:
    if hasattr(left, "__array_interface__") or hasattr(right, "__array_interface__"):
        import numpy as np

        return bool(np.array_equal(left, right))
    return bool(left == right)


def _shown_fields(message: Any) -> Iterator[str]:
    for name in message.__ros_fields__:
        value = getattr(message, name)
        yield f"{name}={value.tolist() if isinstance(value, (array, memoryview)) else value!r}"


def message_type(cls: Any) -> type[Message]:
    """Give `cls` back if it is a message class, or the one that it extends. Raises MessageError otherwise."""
    if isinstance(cls, type) and hasattr(cls, "__ros_fields__"):
        return next(each for each in cls.__mro__ if "__ros_fields__" in vars(each))
    raise MessageError(f"{cls!r} is no message class")
