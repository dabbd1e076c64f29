"""Base class of every message: a msgspec Struct whose fields all have ROS's defaults.

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
from typing import TYPE_CHECKING, Any

import msgspec

from robolink.exceptions import MessageError, closest, nearest
from robolink.message import annotations as ros
from robolink.message.annotations import FieldType
from robolink.message.numbers import DTYPES, FixedNumbers, Numbers
from robolink.message.slot_types import FieldTypes, SlotTypes
from robolink.message.spelling import wrong_name

ZEROS: dict[str, Any] = {"bool": False, "byte": b"\x00", "string": "", "wstring": ""}
"""Default values of the primitives that are not numbers."""


class MessageMeta(msgspec.StructMeta):
    """Metaclass of messages: reads the annotations of a class body and sets ROS's defaults."""

    def __new__(
        mcls, name: str, bases: tuple[type, ...], namespace: dict[str, Any], type_name: str | None = None
    ) -> Any:
        """Create a message class. `type_name` is ``package/msg/Name``; by default of the module's and class's names.

        The Struct also takes its fields by position, for the codec alone (`maker`): that is twice as fast as by name.
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
        if any(kind.shape != "array" for kind in converted.values()):
            namespace.setdefault("__copy__", _copied)
        namespace.setdefault("__reduce__", _reduced)
        # Numbers and text make no reference cycles: without the collector's header a message is made faster.
        cycles = any(kind.shape != "one" and not kind.code for kind in fields.values())
        cls = super().__new__(
            mcls, name, bases, namespace, eq=False, forbid_unknown_fields=True, gc=cycles or not fields
        )
        for field, kind in converted.items():
            setattr(cls, field, (FixedNumbers if kind.shape == "array" else Numbers)(cls, field, kind))
        # rosidl's slots: programs walk them, and get the fields by these names. Attributes of their own, since with a
        # `__getattr__` each field would be read four times more slowly on Python 3.10 and 3.11.
        cls.__slots__ = tuple(f"_{field}" for field in fields)  # type: ignore[attr-defined]
        for field in fields:
            if f"_{field}" not in namespace:
                setattr(cls, f"_{field}", cls.__dict__[field])
        for field in defaults:
            setattr(cls, f"{field.upper()}__DEFAULT", _DefaultOf(field))
        return cls

    def __call__(self: Any, /, *values: Any, **fields: Any) -> Any:
        """Make a message of its fields by name, as in ROS 2. Raises TypeError for one that it does not have."""
        if values:
            first = next(iter(self.__ros_fields__), None)
            how = f"{self.__name__}({first}=...)" if first else "it has none"
            raise TypeError(f"{self.__ros_type__} takes its fields by name: {how}")
        try:
            return _make(self, **fields)
        except TypeError:
            unknown = next((name for name in fields if name not in self.__ros_fields__), None)
            if unknown is None:
                raise
            close = closest(unknown, self.__ros_fields__)
            hint = f". Did you mean: '{close}'?" if close else f" (only {', '.join(self.__ros_fields__)})"
            raise TypeError(f"Unexpected keyword argument '{unknown}'{hint}") from None  # in CPython's words


_make = msgspec.StructMeta.__call__


def maker(cls: type[Message]) -> Callable[..., Any]:
    """Return the function that makes a message of its fields by position, which is how the codec makes it."""
    made: Callable[..., Any] = _make.__get__(cls)
    return made


class _DefaultOf:
    """Descriptor ``X__DEFAULT`` of a message class: the default that its type states for the field ``x``, anew."""

    def __init__(self, field: str) -> None:
        self.field = field

    def __get__(self, message: Any, owner: Any) -> Any:
        return getattr(owner(), self.field)


class _Extended(MessageMeta):
    """Metaclass of a message that adds methods and attributes, but no fields, to another message."""

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
    return _make(cls)


def _parts(message: Any) -> Any:
    """Return the class and the state of a copy, for `copy` and `pickle`."""
    return _bare, (type(message),), (vars(message), {name: getattr(message, name) for name in message.__ros_fields__})


def _settled(message: Any) -> Any:
    """Return the message with views of bytes received turned into arrays, which msgspec would copy as they are."""
    for name in message.__ros_fields__:
        getattr(message, name)
    return message


def _copied(message: Any) -> Any:
    return msgspec.Struct.__copy__(_settled(message))  # type: ignore[attr-defined]


def _reduced(message: Any) -> Any:
    return _make, (type(message), *(getattr(message, name) for name in message.__ros_fields__))


def _annotations(namespace: dict[str, Any]) -> dict[str, Any]:
    if "__annotate_func__" in namespace:  # Python 3.14 evaluates annotations late
        return dict(namespace.pop("__annotate_func__")(1))
    return dict(namespace.get("__annotations__", {}))


def _type_name(module: str, qualname: str) -> str:
    """Return the type name of a class: ``std_srvs/srv/SetBool_Request`` of `std_srvs.srv.SetBool.Request`."""
    name = "_".join(part for part in qualname.rpartition("<locals>.")[2].split("."))
    *_, package, kind, part = ["", "", *module.split(".")]
    if not part.startswith("_"):  # a private part of a package is skipped: sensor_msgs.msg._camera
        package, kind = kind, part
    if kind in ("msg", "srv", "action") and package:
        return f"{package}/{kind}/{name}"
    if module == "__main__":
        module = getattr(sys.modules.get("__main__"), "__file__", None) or "main"
    from pathlib import PurePath  # late: types of files come with their names

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
        from robolink.message.convert import explain_value  # late: it needs this module, and few types state any

        kind, where = fields[name], f"{type_name}.{name}"
        if kind.message is not None:
            raise MessageError(f"{where}: {kind} can have no default: only primitive types and arrays of them can")
        wrong = explain_value(kind, value, where)
        if wrong:
            raise MessageError(f"a default that does not fit: {wrong}")


def _default(kind: FieldType, given: Any) -> Any:
    """Return a field's default for msgspec: a value, or a factory for what can change."""
    if kind.shape == "one":
        if kind.message is not None:
            return msgspec.field(default_factory=_factory(kind.message)) if given is msgspec.NODEFAULT else given
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
        make = _factory(kind.message)
        return lambda: [make() for _ in range(kind.size)]
    return lambda: [ZEROS[kind.base]] * kind.size


def _factory(cls: type[Message]) -> Callable[[], Any]:
    """Return the function that makes a message of defaults: that of an extended class calls its own constructor."""
    return cls if type(cls) is _Extended else maker(cls)


def _numpy_zeros(kind: FieldType) -> Any:
    import numpy as np  # late: most commands make no message with a fixed array

    return np.zeros(kind.size, DTYPES[kind.code or "d"])


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
        _fields_and_field_types = FieldTypes()

        @classmethod
        def get_fields_and_field_types(cls) -> dict[str, str]:
            """Each field's name and its type, as rosidl says it: ``double``, ``sequence<float>``."""
            return cls._fields_and_field_types

        def __eq__(self, other: object) -> bool:
            if other.__class__ is not self.__class__:
                return NotImplemented
            return all(_same(getattr(self, name), getattr(other, name)) for name in self.__ros_fields__)

        __hash__ = None

        def __repr__(self) -> str:
            package, kind, name = self.__ros_type__.split("/")
            return f"{package}.{kind}.{name}({', '.join(_shown_fields(self))})"


def _set_fields(message: Any, /, **fields: Any) -> None:
    known = message.__ros_fields__
    for name, value in fields.items():
        if name not in known:
            only = f"{nearest(name, known)}, only {', '.join(known)}"
            raise TypeError(f"{message.__ros_type__} has no field {name!r}{only}")
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
        yield f"{name}={value.tolist() if isinstance(value, array) else value!r}"


def message_type(cls: Any) -> type[Message]:
    """Return `cls` if it is a message class, or the one that it extends. Raises MessageError otherwise."""
    if isinstance(cls, type) and hasattr(cls, "__ros_fields__"):
        return next(each for each in cls.__mro__ if "__ros_fields__" in vars(each))
    raise MessageError(f"{cls!r} is not a message class")
