"""Names of new things: what is valid as the name of a project, a node or a world, and what is taken."""

from __future__ import annotations

import keyword
import re
from collections.abc import Collection

from robolink.exceptions import RobolinkError

LONGEST = 60
"""Most letters of a name."""

_PATTERN = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")


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
            f"'{name[:LONGEST]}' is no name for a {kind}: a letter, then letters, digits, '_' or '-',"
            f" {LONGEST} at most; such as my_{kind}"
        )
    if keyword.iskeyword(name.lower()) or keyword.issoftkeyword(name.lower()):
        raise ScaffoldError(f"'{name}' is a word of Python: take another name, such as my_{name.lower()}")
    if name.replace("-", "_") in {each.replace("-", "_") for each in taken}:
        raise ScaffoldError(
            f"a {kind} '{name}' comes with robolink, and a new one would hide it: take another name, such as my_{name}"
        )
    return name


def class_name(name: str) -> str:
    """Return the name of a class for a node: `wall_watcher` is WallWatcher.

    >>> class_name("wall_watcher"), class_name("Talker2")
    ('WallWatcher', 'Talker2')
    """
    return "".join(part[:1].upper() + part[1:] for part in re.split("[_-]+", name))
