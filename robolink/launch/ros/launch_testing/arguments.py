"""Launch arguments of the command line, and their help (`parse_arguments` and `print_arguments` in launch_testing)."""

from __future__ import annotations

from collections.abc import Iterable

from robolink.launch.ros.launch.bases import LaunchArgumentError
from robolink.launch.ros.launch.sources import LaunchDescription

__all__ = ["parse_launch_arguments", "print_arguments_of_launch_description"]


def parse_launch_arguments(launch_arguments: Iterable[str]) -> list[tuple[str, str]]:
    """Return names and values, each name once: the last value counts.

    Args:
        launch_arguments: Texts such as `speed:=2`.

    Raises:
        LaunchArgumentError: for any other text.
    """
    found: dict[str, str] = {}
    for each in launch_arguments:
        name, separator, value = each.partition(":=")
        if not name or not separator or not value:
            raise LaunchArgumentError(f"malformed launch argument '{each}': expected NAME:=VALUE")
        found[name] = value
    return list(found.items())


def print_arguments_of_launch_description(*, launch_description: LaunchDescription) -> None:
    """Print the launch arguments of a description.

    Args:
        launch_description: The description.
    """
    lines = ["Arguments (pass arguments as '<name>:=<value>'):"]
    arguments = launch_description.get_launch_arguments()
    for each in arguments:
        lines += ["", f"    '{each.name}':", f"        {each.description}"]
        if each.default_value is not None:
            lines.append(f"        (default: {' + '.join(part.describe() for part in each.default_value)})")
    if not arguments:
        lines += ["", "  No arguments."]
    print("\n".join(lines))
