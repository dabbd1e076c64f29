"""Error of what needs the test runner of launch_testing."""

from __future__ import annotations

from robolink.companions.launch.bases import LaunchError


def no_test_runner(name: str) -> LaunchError:
    """Return the error that `name` needs a test runner, with what tests systems here."""
    return LaunchError(f"{name} needs ROS 2's test runner: test by system.launch(FILE) of robolink.testing in a pytest")
