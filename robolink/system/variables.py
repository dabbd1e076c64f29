"""Environment variables: changes of an environment, in which None takes a variable out, and those that ROS 2 sets."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TypeAlias

Variables: TypeAlias = "Mapping[str, str | None]"
"""Variables that are set in an environment, or with None taken out of it."""


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
