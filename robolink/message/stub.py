"""Type stubs of message, service and action classes: their constants and fields, as PEP 484 has them in a .pyi file."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from robolink.message.annotations import FieldType

PARTS = {"msg": (), "srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}
"""Messages that a type of each kind is made of."""
BASES = {"msg": "Message", "srv": "Service", "action": "Action"}
PYTHON = {"bool": "bool", "byte": "bytes", "string": "str", "wstring": "str", "float32": "float", "float64": "float"}
"""Python's types of ROS's primitives; the others are int."""


def stub_of(types: Collection[type[Any]], kind: str, root: str = "") -> str:
    """Return the stub of a module of types.

    Args:
        types: Classes of one package and one kind.
        kind: msg, srv or action.
        root: Prefix of the modules of nested messages: `robolink.interfaces.`, or empty for ROS 2's own names.
    """
    messages = [part for each in types for part in (each, *(getattr(each, name) for name in PARTS[kind]))]
    fields = [field for each in messages for field in getattr(each, "__ros_fields__", {}).values()]
    modules = {root + field.base.replace("/", ".").rpartition(".")[0] for field in fields if field.message}
    heads = ["builtins", "collections.abc", "typing", "robolink.message", *sorted(modules)]
    imports = "".join(f"import {each}\n" for each in heads)
    names = ", ".join(f'"{each.__name__}"' for each in types)
    return f"{imports}\n__all__ = [{names}]\n\n{''.join(_type(each, kind, root) for each in types)}"


def _type(cls: type[Any], kind: str, root: str) -> str:
    if kind == "msg":
        return _message(cls, cls.__name__, "", root)
    parts = "".join(_message(getattr(cls, each), each, "    ", root, cls.__doc__) for each in PARTS[kind])
    return f"class {cls.__name__}(robolink.message.{BASES[kind]}):\n{_doc(cls, '    ')}{parts}"


def _message(cls: type[Any], name: str, indent: str, root: str, said: str | None = None) -> str:
    """Return a class with its constants and fields; all fields are keyword arguments that one may leave out.

    A docstring that was `said` already, by the service that it is a part of, is left out.
    """
    fields: dict[str, FieldType] = cls.__ros_fields__
    constants: dict[str, tuple[FieldType, Any]] = cls.__ros_constants__
    arguments = "".join(f", {each}: {_argument(kind, root)} = ..." for each, kind in fields.items())
    lines = [
        *(f"{each}: typing.ClassVar[{_python(kind, root)}]" for each, (kind, _) in constants.items()),
        *(f"{each}: {_python(kind, root)}" for each, kind in fields.items()),
        f"def __init__(self{', *' if fields else ''}{arguments}) -> None: ...",
    ]
    body = "".join(f"{indent}    {each}\n" for each in lines)
    doc = "" if cls.__doc__ == said else _doc(cls, f"{indent}    ")
    return f"{indent}class {name}(robolink.message.Message):\n{doc}{body}"


def _doc(cls: type[Any], indent: str) -> str:
    """Return a class's docstring as lines of its stub; '' if it has none."""
    text = (cls.__doc__ or "").replace("\\", "\\\\").replace('"""', "'''").strip()
    if not text:
        return ""
    first, *others = text.splitlines()
    lines = [first, *(f"{indent}{each}".rstrip() for each in others)]
    end = "\n" + indent if others or text.endswith('"') else ""
    return f'{indent}"""' + "\n".join(lines) + end + '"""\n'


def _python(kind: FieldType, root: str) -> str:
    """Return the annotation of a field."""
    return _annotation("collections.abc.MutableSequence", kind, root)


def _argument(kind: FieldType, root: str) -> str:
    """Return the annotation of the argument for a field: a sequence is made of whatever has elements."""
    return _annotation("collections.abc.Iterable", kind, root)


def _annotation(sequence: str, kind: FieldType, root: str) -> str:
    one = root + kind.base.replace("/", ".") if kind.message else f"builtins.{PYTHON.get(kind.base, 'int')}"
    return one if kind.shape == "one" else f"{sequence}[{one}]"
