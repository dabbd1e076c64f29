"""Launch files in XML and YAML (`launch.frontend`): their substitutions, and the marks of one's own actions."""

from collections.abc import Callable
from typing import TypeVar

from robolink.companions.launch.frontend.parse_substitution import parse_substitution

__all__ = ["expose_action", "expose_substitution", "parse_substitution"]

T = TypeVar("T")


def expose_action(name: str) -> Callable[[T], T]:
    """Return a decorator without effect: one's own actions are for files in Python, not for the tag `name`."""
    return lambda cls: cls


def expose_substitution(name: str) -> Callable[[T], T]:
    """Return a decorator without effect: substitutions of one's own are not for `name` in XML and YAML."""
    return lambda cls: cls
