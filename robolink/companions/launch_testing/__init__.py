"""launch_testing: the names by which ROS 2's launch files are tests, so that `robolink launch` can read these files.

Nothing of it runs a test: `system.launch(FILE)` of `robolink.testing` starts the same file in a pytest.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from robolink.companions.launch_testing import actions, asserts, legacy, markers, util
from robolink.companions.launch_testing.refusal import no_test_runner

__all__ = ["actions", "asserts", "legacy", "markers", "parametrize", "post_shutdown_test", "util"]

T = TypeVar("T", bound=type)


def post_shutdown_test() -> Callable[[T], T]:
    """Return a decorator that leaves a class of tests as it is: nothing runs them here."""
    return lambda cls: cls


def parametrize(*args: Any, **kwargs: Any) -> Callable[..., Any]:
    """Refuse to make several launches of one file: raises LaunchError. `args` and `kwargs` are of no effect."""
    raise no_test_runner("launch_testing.parametrize")
