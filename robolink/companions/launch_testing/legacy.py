"""Test runner of older launch files that are programs (`launch_testing.legacy`), which is not here."""

from __future__ import annotations

from typing import Any

from robolink.companions.launch_testing.refusal import no_test_runner

__all__ = ["LaunchTestService"]


class LaunchTestService:
    """Test runner, which robolink has not.

    Args:
        *args, **kwargs: Those of ROS 2, of no effect: LaunchError is raised.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        raise no_test_runner("LaunchTestService")
