"""Test runner of older launch files that are programs (`launch_testing.legacy`), which is not here."""

from __future__ import annotations

from typing import Any

from robolink.companions.launch.bases import LaunchError

__all__ = ["LaunchTestService"]


class LaunchTestService:
    """Test runner within a program, which robolink has not: LaunchError is raised.

    Args:
        *args: Those of ROS 2, of no effect.
        **kwargs: Those of ROS 2, of no effect.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        raise LaunchError(
            "there is no LaunchTestService here: 'pytest FILE' runs files with generate_test_description()"
        )
