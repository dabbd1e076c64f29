"""Environment variables: changes of an environment, in which None takes a variable out, and those that ROS 2 sets."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TypeAlias

Variables: TypeAlias = "Mapping[str, str | None]"
"""Variables that are set in an environment, or with None taken out of it."""
ROS_DISTRO = "jazzy"
"""Distribution of ROS 2 that programs see, and that a bag says it comes from, where ROS_DISTRO is not set."""


def set_ros_version() -> None:
    """Set what a sourced ROS 2 sets, where it is not set: launch files and nodes choose types and files by it."""
    for name, value in {"ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3", "ROS_DISTRO": ROS_DISTRO}.items():
        os.environ.setdefault(name, value)


def environment_with(changes: Variables, environ: Mapping[str, str] | None = None) -> dict[str, str]:
    """Return an environment with some changes.

    Args:
        changes: The changes.
        environ: The environment; None is that of this process.
    """
    whole = {**(os.environ if environ is None else environ), **changes}
    return {name: value for name, value in whole.items() if value is not None}


def set_environment(changes: Variables) -> None:
    """Make some `changes` in the environment of this process."""
    for name, value in changes.items():
        if value is None:
            os.environ.pop(name, None)
        else:
            os.environ[name] = value
