"""Old names of the arguments of nodes, `node_name` and the like, which ROS 2 has refused since Galactic."""

from __future__ import annotations

from typing import Any

from robolink.companions.launch.utilities import LaunchArgumentError

OLD_NAMES = {
    "node_executable": "executable",
    "node_name": "name",
    "node_namespace": "namespace",
    "node_plugin": "plugin",
}
"""New names by the old ones."""


def take_old_names(kind: str, values: dict[str, Any], given: dict[str, Any]) -> tuple[str, ...]:
    """Move arguments with old names into `values`, and return these names.

    Args:
        kind: Name of the class, for the error.
        values: Arguments by their new names; None is one that was not given.
        given: Further arguments, as they were given; those with old names are removed.

    Raises:
        LaunchArgumentError: for an argument that was given by both of its names.
    """
    found = tuple(old for old, new in OLD_NAMES.items() if old in given and new in values)
    for old in found:
        new = OLD_NAMES[old]
        if values[new] is not None:
            raise LaunchArgumentError(f"{kind} has {new} and {old}, which is its old name: {new} is enough")
        values[new] = given.pop(old)
    return found


def old_names_note(names: tuple[str, ...]) -> str:
    """Return the line about arguments with old `names`."""
    new = [OLD_NAMES[each] for each in names]
    return f"old names, which ROS 2 refuses since Galactic: {', '.join(names)}; write {', '.join(new)}"
