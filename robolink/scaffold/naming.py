"""Names of new things: what is valid as the name of a project, a node or a world, and what is taken."""

from __future__ import annotations

import keyword
import re
import sys
from collections.abc import Collection

from robolink.exceptions import RobolinkError

LONGEST = 60
"""Most letters of a name."""

_PATTERN = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
_DEVICE = re.compile(r"(con|prn|aux|nul|(com|lpt)[0-9])", re.IGNORECASE)
"""Names that no file can have on Windows, with any suffix."""
_IMPORTED = ("Node", "String", "ExternalShutdownException")
"""Classes that the program of a new node imports."""


class ScaffoldError(RobolinkError, ValueError):
    """Nothing can be made under this name, or there is something already; the text says what to do."""


def checked(kind: str, name: str, taken: Collection[str] = ()) -> str:
    """Return a name that is fit for files, launch files and Python; raise ScaffoldError for any other.

    Args:
        kind: Word for what gets the name: ``project``, ``node`` or ``world``.
        name: The name as somebody typed it.
        taken: Names of what comes with robolink, which a new thing would hide.
    """
    if not _PATTERN.fullmatch(name) or len(name) > LONGEST:
        raise ScaffoldError(
            f"'{name[:LONGEST]}' is not a name for a {kind}: a letter, then letters, digits, '_' or '-',"
            f" {LONGEST} at most; such as my_{kind}"
        )
    if any(keyword.iskeyword(each) or keyword.issoftkeyword(each) for each in (name.lower(), name.capitalize())):
        raise ScaffoldError(f"'{name}' is a word of Python: take another name, such as my_{name.lower()}")
    if _DEVICE.fullmatch(name):
        raise ScaffoldError(f"'{name}' is a device of Windows: take another name, such as my_{name.lower()}")
    if _as_file(name) in map(_as_file, taken):
        raise ScaffoldError(
            f"a {kind} '{name}' comes with robolink, and a new one would hide it: take another name, such as my_{name}"
        )
    return name


def checked_module(kind: str, name: str, taken: Collection[str] = ()) -> str:
    """Return a name that is fit for a file or folder that Python imports and that hides no other.

    Args:
        kind: Word for what gets the name: ``package`` or ``node``.
        name: The name as somebody typed it.
        taken: More names that a new thing would hide.

    Raises:
        ScaffoldError: (a ValueError) if it is not valid, or a module of Python or of robolink has it.
    """
    from robolink.compat.maker import TOPS  # late: few commands need it
    from robolink.workspace import program_names

    module = checked(kind, name, {"robolink", *TOPS, *program_names(), *taken}).replace("-", "_")
    if module.casefold() in map(str.casefold, sys.stdlib_module_names):
        raise ScaffoldError(f"'{name}' is a module of Python: take another name, such as my_{module}")
    return name


def _as_file(name: str) -> str:
    """Return a name as file systems compare it that know no capitals, with `-` as `_`."""
    return name.replace("-", "_").casefold()


def class_name(name: str) -> str:
    """Return the name of a class for a node: `wall_watcher` is WallWatcher.

    >>> class_name("wall_watcher"), class_name("Talker2"), class_name("node")
    ('WallWatcher', 'Talker2', 'NodeNode')
    """
    joined = "".join(part[:1].upper() + part[1:] for part in re.split("[_-]+", name))
    return f"{joined}Node" if joined in _IMPORTED else joined
