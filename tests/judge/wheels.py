"""A virtual environment with the real rclpy, of the ros-* wheels of the package index, kept in the temporary folder."""

from __future__ import annotations

import getpass
import hashlib
import platform
import shutil
import subprocess
import sys
import tempfile
import venv
from collections.abc import Sequence
from pathlib import Path

from tests.judge.transcript import environment as clean_environment

PACKAGES = [
    "ros-rclpy==9.1.2",
    "ros-rmw-fastrtps-cpp==9.3.3",
    "ros-rmw-implementation==3.0.4",
    "ros-std-msgs==5.5.1",
    "ros-geometry-msgs==5.5.1",
    "ros-sensor-msgs==5.5.1",
    "ros-nav-msgs==5.5.1",
    "ros-diagnostic-msgs==5.5.1",
    "ros-trajectory-msgs==5.5.1",
    "ros-visualization-msgs==5.5.1",
    "ros-std-srvs==5.5.1",
    "ros-test-msgs==2.3.0",
    "ros-lifecycle-msgs==2.3.0",
    "ros-rosgraph-msgs==2.3.0",
    "numpy",
]
"""Packages of ROS 2 Kilted that the programs import."""

_TRIED = "import rclpy; rclpy.init(); rclpy.create_node('tried'); print('ready')"


class NoWheelsError(Exception):
    """The real rclpy cannot be run here, with the reason."""


def interpreter(environment: Path | None = None) -> list[str]:
    """Return the command of a Python that has the real rclpy; it is installed if that was not done before.

    Args:
        environment: A virtual environment that has it; by default one of the judge's own.

    Raises:
        NoWheelsError: If this system has none, they could not be installed, or they do not work.
    """
    if environment is None:
        if sys.platform != "linux" or platform.machine() != "x86_64":
            raise NoWheelsError(
                f"there are wheels for Linux on x86_64 only, not for {sys.platform} {platform.machine()}"
            )
        environment = _folder()
        if not (environment / "complete").exists():
            _install(environment)
    command = [str(environment / "bin" / "python")]
    _run([*command, "-c", _TRIED], 60.0)
    return command


def _folder() -> Path:
    """Return a folder of this user, Python and list of packages."""
    key = hashlib.sha256("\n".join([sys.version, *PACKAGES]).encode()).hexdigest()[:12]
    return Path(tempfile.gettempdir()) / f"robolink-judge-{getpass.getuser()}-{key}"


def _install(environment: Path) -> None:
    shutil.rmtree(environment, ignore_errors=True)
    venv.create(environment, with_pip=True)
    pip = [str(environment / "bin" / "python"), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    _run([*pip, "--prefer-binary", *PACKAGES], 600.0)
    (environment / "complete").touch()


def _run(command: Sequence[str], seconds: float) -> None:
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds, env=clean_environment())
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NoWheelsError(str(error)) from error
    if done.returncode:
        last = [line for line in done.stderr.splitlines() if line.strip()][-1:] or [f"exit code {done.returncode}"]
        raise NoWheelsError(f"{Path(command[0]).name} {' '.join(command[1:4])} ...: {last[0]}")
