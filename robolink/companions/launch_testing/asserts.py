"""Assertions about processes that launch_testing has run (`launch_testing.asserts`); they need its test runner."""

from __future__ import annotations

from typing import Any

from robolink.companions.launch_testing.refusal import no_test_runner

__all__ = ["EXIT_OK", "assertExitCodes", "assertInStderr", "assertInStdout", "assertSequentialStdout"]

EXIT_OK = 0
"""Exit code of a program that ended well."""


def assertExitCodes(*args: Any, **kwargs: Any) -> None:  # noqa: N802 - ROS 2's name
    """Refuse: raises LaunchError. `args` and `kwargs` are of no effect."""
    raise no_test_runner("assertExitCodes")


def assertInStdout(*args: Any, **kwargs: Any) -> None:  # noqa: N802 - ROS 2's name
    """Refuse: raises LaunchError. `args` and `kwargs` are of no effect."""
    raise no_test_runner("assertInStdout")


def assertInStderr(*args: Any, **kwargs: Any) -> None:  # noqa: N802 - ROS 2's name
    """Refuse: raises LaunchError. `args` and `kwargs` are of no effect."""
    raise no_test_runner("assertInStderr")


def assertSequentialStdout(*args: Any, **kwargs: Any) -> None:  # noqa: N802 - ROS 2's name
    """Refuse: raises LaunchError. `args` and `kwargs` are of no effect."""
    raise no_test_runner("assertSequentialStdout")
