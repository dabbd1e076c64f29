"""Messages and their types at run time: the API of ROS 2's rosidl_runtime_py."""

from __future__ import annotations

import functools
import tempfile
import warnings
from collections import OrderedDict
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from robolink.companions.ament_index import get_packages_with_prefixes
from robolink.exceptions import EncodeError, MessageError, NotFoundError, nearest
from robolink.interfaces import ACTION_PARTS, KINDS, find, find_announced, names
from robolink.interfaces.standard import INTERFACES
from robolink.message import FieldType, Message, message_type
from robolink.message.convert import UnknownFieldError, converted, explain_value
from robolink.message.show import Style, as_csv, as_yaml, shown_data
from robolink.message.slot_types import (
    IDL_NAMES,
    AbstractGenericString,
    AbstractNestedType,
    AbstractWString,
    Array,
    BoundedSequence,
    NamespacedType,
)
from robolink.message.text import text_of
from robolink.workspace.interfaces import WORKSPACE_TYPES, use_interfaces

__all__ = [
    "get_action_interfaces",
    "get_interface_packages",
    "get_interface_path",
    "get_interfaces",
    "get_message_interfaces",
    "get_message_slot_types",
    "get_service_interfaces",
    "import_message_from_namespaced_type",
    "message_to_csv",
    "message_to_ordereddict",
    "message_to_yaml",
    "set_message_fields",
]


def get_interface(identifier: str) -> Any:
    """Return the message, service or action class of the full name `identifier`, such as ``std_msgs/msg/String``.

    Raises NotFoundError (also an AttributeError or a ModuleNotFoundError), and MessageError (a ValueError).
    """
    return import_message_from_namespaced_type(get_namespaced_type(identifier))


def get_message(identifier: str) -> Any:
    """Return the message class of the name `identifier`: ``std_msgs/msg/String`` or ``std_msgs/String``.

    Raises NotFoundError (also an AttributeError or a ModuleNotFoundError), and MessageError (a ValueError) for what is
    not a message.
    """
    return _checked(get_message_namespaced_type(identifier), identifier, "a message", is_message)


def get_service(identifier: str) -> Any:
    """Return the service class of the name `identifier`; else as `get_message`."""
    return _checked(get_service_namespaced_type(identifier), identifier, "a service", is_service)


def get_action(identifier: str) -> Any:
    """Return the action class of the name `identifier`; else as `get_message`."""
    return _checked(get_action_namespaced_type(identifier), identifier, "an action", is_action)


def get_namespaced_type(identifier: str) -> NamespacedType:
    """Split `identifier`, the full name of a type. Raises MessageError (a ValueError)."""
    return _parted(identifier)


def get_message_namespaced_type(identifier: str) -> NamespacedType:
    """Split `identifier`, the name of a message; ``msg`` may be missing. Raises MessageError (a ValueError)."""
    return _parted(identifier, "msg")


def get_service_namespaced_type(identifier: str) -> NamespacedType:
    """Split `identifier`, the name of a service; ``srv`` may be missing. Raises MessageError (a ValueError)."""
    return _parted(identifier, "srv")


def get_action_namespaced_type(identifier: str) -> NamespacedType:
    """Split `identifier`, the name of an action; ``action`` may be missing. Raises MessageError (a ValueError)."""
    return _parted(identifier, "action")


def is_message(interface: Any) -> bool:
    """True if `interface` is a message class."""
    return hasattr(interface, "__ros_fields__")


def is_service(interface: Any) -> bool:
    """True if `interface` is a service class."""
    return hasattr(interface, "Request") and hasattr(interface, "Response")


def is_action(interface: Any) -> bool:
    """True if `interface` is an action class."""
    return all(hasattr(interface, each) for each in ("Goal", "Result", "Feedback"))


def _parted(identifier: str, kind: str = "") -> NamespacedType:
    *namespaces, name = identifier.split("/")
    if len(namespaces) == 1 and kind:
        namespaces.append(kind)
    if len(namespaces) != 2 or not all((*namespaces, name)):
        raise MessageError(f"Expected the full name of a type, as std_msgs/msg/String, got '{identifier}'")
    return NamespacedType(tuple(namespaces), name)


def _checked(found: NamespacedType, identifier: str, what: str, is_right: Any) -> Any:
    interface = import_message_from_namespaced_type(found)
    if not is_right(interface):
        raise MessageError(f"Expected the full name of {what}, got '{identifier}'")
    return interface


class TypeNotFoundError(NotFoundError, AttributeError):  # type: ignore[misc]
    """A package has no type of this name."""


class PackageOfTypeNotFoundError(NotFoundError, ModuleNotFoundError):  # type: ignore[misc]
    """There is no package of this name with types."""


class Namespaced(Protocol):
    """Protocol of rosidl_parser's NamespacedType, and of that in `message.slot_types`."""

    @property
    def namespaces(self) -> Sequence[str]: ...

    @property
    def name(self) -> str: ...


def import_message_from_namespaced_type(message_type: Namespaced | AbstractNestedType) -> Any:
    """Return the class of `message_type`; also of the parts of an action, ``Fibonacci_FeedbackMessage``.

    An array or a sequence stands for its elements, with a DeprecationWarning.

    Raises TypeNotFoundError (an AttributeError), PackageOfTypeNotFoundError (a ModuleNotFoundError), both
    NotFoundError, or MessageError (a ValueError) if the definition is wrong.
    """
    if isinstance(message_type, AbstractNestedType):
        text = "Passing objects containing a NamespacedType is deprecated, please pass a NamespacedType object directly"
        warnings.warn(text, DeprecationWarning, stacklevel=2)
        return import_message_from_namespaced_type(message_type.value_type)
    full = "/".join((*message_type.namespaces, message_type.name))
    kind = message_type.namespaces[1] if len(message_type.namespaces) > 1 else "msg"
    if kind not in KINDS:
        raise TypeNotFoundError("kind of type", kind, KINDS, full)
    try:
        if kind == "action" and message_type.name.rpartition("_")[2] in ACTION_PARTS:
            return find_announced(full)
        return find(full, kind)
    except NotFoundError as error:
        package = message_type.namespaces[0]
        known = [name.split("/") for each in KINDS for name in names(each)]
        if all(parts[0] != package for parts in known):
            raise PackageOfTypeNotFoundError("interface package", package, {parts[0] for parts in known}) from None
        of_kind = [parts[2] for parts in known if parts[:2] == [package, kind]]
        raise TypeNotFoundError(f"{error.kind}", message_type.name, of_kind, package) from None


def message_to_yaml(
    msg: Any,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """Return a message as YAML, with a line break at its end.

    Args:
        msg: The message.
        truncate_length: Longest text or sequence that is not cut; a longer one ends in '...'. None cuts nothing.
        no_arr: True only describes sequences.
        no_str: True only describes texts.
        flow_style: True writes {a: [1, 2]} instead of blocks.

    Raises:
        MessageError: if `msg` is not a message.
    """
    return as_yaml(_message(msg), Style(truncate_length, not no_arr, not no_str, flow_style)) + "\n"


def message_to_csv(msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False) -> str:
    """Return the values of all fields, nested ones too, separated by commas.

    Args:
        msg: The message.
        truncate_length: Longest text or sequence that is not cut; a longer one ends in '...'. None cuts nothing.
        no_arr: True only describes sequences.
        no_str: True only describes texts.

    Raises:
        MessageError: if `msg` is not a message.
    """
    return as_csv(_message(msg), Style(truncate_length, not no_arr, not no_str))


def message_to_ordereddict(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Return a message as dictionaries, lists and scalars, its fields in their order.

    Args:
        msg: The message.
        truncate_length: Longest text or sequence that is not cut; a longer one ends in '...'. None cuts nothing.
        no_arr: True only describes sequences.
        no_str: True only describes texts.

    Raises:
        MessageError: if `msg` is not a message.
    """
    style = Style(truncate_length, not no_arr, not no_str)
    ordered: OrderedDict[str, Any] = _ordered(shown_data(_message(msg), style))
    return ordered


def get_message_slot_types(msg: Any) -> OrderedDict[str, Any]:
    """Return the type of each field of `msg`, a message or its class, by name, as rosidl_parser.definition has it."""
    return OrderedDict(zip(msg.get_fields_and_field_types(), msg.SLOT_TYPES, strict=True))


def _message(msg: Any) -> Any:
    message_type(type(msg))
    return msg


def _fields_of(msg: Any) -> Mapping[str, FieldType]:
    """Return the fields of a message, also of a class of others that only describes itself as rosidl's do."""
    if not hasattr(msg, "__ros_fields__") and hasattr(msg, "SLOT_TYPES"):
        return {name: _kind_of(slot) for name, slot in get_message_slot_types(msg).items()}
    return message_type(type(msg)).__ros_fields__


def _kind_of(slot: Any) -> FieldType:
    """Return the field type that `robolink.message.slot_types.slot_type` makes a slot type of."""
    if isinstance(slot, AbstractNestedType):
        element = _kind_of(slot.value_type)
        shape = "array" if isinstance(slot, Array) else "bounded" if isinstance(slot, BoundedSequence) else "sequence"
        size = getattr(slot, "size", getattr(slot, "maximum_size", 0))
        return FieldType(element.base, element.message, element.string_bound, shape, size)
    if isinstance(slot, NamespacedType):
        cls = import_message_from_namespaced_type(slot)
        return FieldType(cls.__ros_type__, cls)
    if isinstance(slot, AbstractGenericString):
        base = "wstring" if isinstance(slot, AbstractWString) else "string"
        return FieldType(base, string_bound=getattr(slot, "maximum_size", 0))
    names = {idl: name for name, idl in IDL_NAMES.items() if name != "char"}  # a uint8, too
    return FieldType(names.get(slot.typename, slot.typename))


def _ordered(data: Any) -> Any:
    if isinstance(data, dict):
        return OrderedDict((name, _ordered(each)) for name, each in data.items())
    if isinstance(data, list):
        return [_ordered(each) for each in data]
    return data.decode("latin-1") if isinstance(data, bytes) else data


def get_interface_packages() -> dict[str, str]:
    """Return the packages that have types, each with its prefix."""
    prefixes = get_packages_with_prefixes()
    return {package: prefixes.get(package, "") for package in sorted(_known())}


def get_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the types of the packages `package_names`, of all by default: ``{"std_msgs": ["msg/String", ...]}``.

    A package without types is left out. Raises NotFoundError (a LookupError) for a package that does not exist.
    """
    return _interfaces(package_names, tuple(KINDS))


def get_message_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the messages of the packages `package_names`, as `get_interfaces` does."""
    return _interfaces(package_names, ("msg",))


def get_service_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the services of the packages `package_names`, as `get_interfaces` does."""
    return _interfaces(package_names, ("srv",))


def get_action_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the actions of the packages `package_names`, as `get_interfaces` does."""
    return _interfaces(package_names, ("action",))


def get_interface_path(interface_name: str) -> str:
    """Return the path of the file that defines a type.

    A workspace's file is the user's own; that of a standard type is written for this process, and removed after it.
    A type that only an .idl file defines is written as text, too; the .idl file itself is what the name with ``.idl``
    at its end means, where the package has one.

    Args:
        interface_name: Name such as ``std_msgs/msg/String``, with or without ``.msg`` at its end.

    Raises:
        MessageError: (a ValueError) if it is not a type's name.
        NotFoundError: (a LookupError) if there is no such type.
    """
    parts = interface_name.split("/")
    if len(parts) != 3 or not all(parts) or parts[1] not in KINDS:
        raise MessageError(f"Invalid name '{interface_name}'. Expected a name as std_msgs/msg/String")
    package, kind, last = parts
    short, dot, suffix = last.partition(".")
    use_interfaces()
    added = INTERFACES.get(package)
    folders = [*WORKSPACE_TYPES.folders(package, kind), *([Path(added, kind)] if added is not None else ())]
    own = (place / f"{short}.{suffix or kind}" for place in folders)
    path = next((each for each in own if each.is_file()), None) if suffix in ("", kind, "idl") else None
    if path is None and dot and suffix != kind:
        raise NotFoundError("interface file", interface_name, [f"{package}/{kind}/{short}.{kind}"])
    return str(path if path is not None else _written(f"{package}/{kind}/{short}", kind))


def _interfaces(package_names: Iterable[str], kinds: tuple[str, ...]) -> dict[str, list[str]]:
    known, requested = _known(), list(package_names)
    for each in requested:
        if each not in known and each not in get_packages_with_prefixes():
            raise NotFoundError("package", each, known)
    found = {
        package: [name for name in known.get(package, ()) if name.partition("/")[0] in kinds]
        for package in requested or sorted(known)
    }
    return {package: types for package, types in found.items() if types}


def _known() -> dict[str, list[str]]:
    use_interfaces()
    known: dict[str, list[str]] = {}
    for kind in KINDS:
        for name in names(kind):
            package, _, rest = name.partition("/")
            known.setdefault(package, []).append(rest)
    return known


def _written(name: str, kind: str) -> Path:
    path = _folder() / f"{name}.{kind}"
    if not path.is_file():
        text = text_of(find(name, kind))
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return path


@functools.cache
def _temporary() -> tempfile.TemporaryDirectory[str]:
    import atexit

    folder = tempfile.TemporaryDirectory(prefix="robolink_interfaces_", ignore_cleanup_errors=True)
    atexit.register(folder.cleanup)
    return folder


def _folder() -> Path:
    return Path(_temporary().name)


HEADER, TIME = "std_msgs/msg/Header", "builtin_interfaces/msg/Time"

Setter = Callable[[Any], None]
"""Function that sets a builtin_interfaces Time in the message."""


def set_message_fields(
    msg: Any, values: Mapping[str, Any], expand_header_auto: bool = False, expand_time_now: bool = False
) -> list[Setter]:
    """Set fields of a message from a mapping; those that it leaves out stay as they are.

    Args:
        msg: The message, which stays as it was if an error is raised.
        values: Values by field name, nested messages as mappings.
        expand_header_auto: True takes 'auto' for a Header, whose stamp is set later.
        expand_time_now: True takes 'now' for a Time, which is set later.

    Returns:
        The functions that set these times; each takes a builtin_interfaces Time.

    Raises:
        UnknownFieldError: (an AttributeError) if there is no such field.
        EncodeError: (a TypeError and a ValueError) if a value does not fit, with the field's name.
    """
    filling = _Filling(expand_header_auto, expand_time_now)
    changes = filling.changes(msg, values, type(msg).__name__)
    for name, value in changes.items():
        setattr(msg, name, value)
    return [functools.partial(_put, msg, path) for path in filling.paths]


class _Filling:
    """Conversion of data into values of fields, with notes of the times that are to be set."""

    def __init__(self, auto: bool, now: bool) -> None:
        self.auto, self.now = auto, now
        self.paths: list[tuple[str | int, ...]] = []

    def changes(self, msg: Any, values: Any, where: str, path: tuple[str | int, ...] = ()) -> dict[str, Any]:
        """Return the new value of each field that is named."""
        fields = _fields_of(msg)
        if not isinstance(values, Mapping):
            kind = type(values).__name__
            raise EncodeError(f"Value '{values}' is expected to be a dictionary but is a {kind} ({where})")
        made = {}
        for name, value in values.items():
            if name not in fields:
                listed = ", ".join(fields) or "none"
                raise UnknownFieldError(f"{where}: no field '{name}'{nearest(str(name), fields)}; it has {listed}")
            made[name] = self.value(fields[name], getattr(msg, name), value, f"{where}.{name}", (*path, name))
        return made

    def value(self, kind: FieldType, old: Any, value: Any, where: str, path: tuple[str | int, ...]) -> Any:
        """Return the new value of a field."""
        if kind.message is None:
            made = converted(kind, value, where)
        elif kind.shape == "one":
            made = self.nested(kind.message, old, value, where, path)
        elif isinstance(value, (list, tuple)):
            made = [
                self.nested(kind.message, None, each, f"{where}[{at}]", (*path, at)) for at, each in enumerate(value)
            ]
        else:
            raise EncodeError(f"{where}: expected {kind}, got {value!r:.60}")
        wrong = explain_value(kind, made, where)
        if wrong:
            raise EncodeError(wrong)
        return made

    def nested(self, cls: type[Message], old: Any, value: Any, where: str, path: tuple[str | int, ...]) -> Any:
        """Return a nested message: the one given, or one made of a mapping."""
        if isinstance(value, cls):
            return value
        made = cls()
        if value == "auto" and cls.__ros_type__ == HEADER and self.auto:
            self.paths.append((*path, "stamp"))
            return old if old is not None else made
        if value == "now" and cls.__ros_type__ == TIME and self.now:
            self.paths.append(path)
            return made
        for name, each in self.changes(made, value, where, path).items():
            setattr(made, name, each)
        return made


def _put(msg: Any, path: tuple[str | int, ...], stamp: Any) -> None:
    for step in path[:-1]:
        msg = msg[step] if isinstance(step, int) else getattr(msg, step)
    if isinstance(path[-1], int):
        msg[path[-1]] = stamp
    else:
        setattr(msg, path[-1], stamp)
