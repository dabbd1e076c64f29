"""Interface types by package, and their definitions as files."""

from __future__ import annotations

import functools
import tempfile
from collections.abc import Iterable
from pathlib import Path

from robolink.companions.ament_index.packages import get_packages_with_prefixes
from robolink.exceptions import MessageError, NotFoundError
from robolink.interfaces import KINDS, find, names
from robolink.interfaces.standard import INTERFACES
from robolink.message.text import text_of
from robolink.workspace.interfaces import WORKSPACE_TYPES, use_interfaces


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
    A type that only an .idl file defines is written as text, too.

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
    if dot and suffix != kind:
        raise NotFoundError("interface file", interface_name, [f"{package}/{kind}/{short}.{kind}"])
    use_interfaces()
    added = INTERFACES.get(package)
    folders = [*WORKSPACE_TYPES.folders(package, kind), *([added / kind] if added is not None else ())]
    own = (place / f"{short}.{kind}" for place in folders)
    path = next((each for each in own if each.is_file()), None)
    return str(path if path is not None else _written(f"{package}/{kind}/{short}", kind))


def _interfaces(package_names: Iterable[str], kinds: tuple[str, ...]) -> dict[str, list[str]]:
    known, wanted = _known(), list(package_names)
    for each in wanted:
        if each not in known and each not in get_packages_with_prefixes():
            raise NotFoundError("package", each, known)
    found = {
        package: [name for name in known.get(package, ()) if name.partition("/")[0] in kinds]
        for package in wanted or sorted(known)
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
