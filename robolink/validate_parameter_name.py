"""The check of a parameter's name."""

from __future__ import annotations

from typing import Literal

from robolink.exceptions import InvalidParameterException


def validate_parameter_name(name: str) -> Literal[True]:
    """Give True for a name that is not empty, ROS 2's only rule; raises `InvalidParameterException`."""
    if not name:
        raise InvalidParameterException(name)
    return True
