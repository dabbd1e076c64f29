"""Check of a parameter's name."""

from __future__ import annotations

from typing import Literal

from robolink.exceptions import InvalidParameterException


def validate_parameter_name(name: str) -> Literal[True]:
    """Return True if `name` is not empty, which is ROS 2's only rule. Raises InvalidParameterException if it is."""
    if not name:
        raise InvalidParameterException(name)
    return True
