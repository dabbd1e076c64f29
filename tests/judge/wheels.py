"""Virtual environments with a real ROS 2, of wheels of the package index, kept in the temporary folder.

    python -m tests.judge.wheels [kilted] [jazzy] [cyclone]     # installs those that are not there; all by default

It ends with 0 where they cannot be installed, having said why: tests that need them are skipped then.
"""

from __future__ import annotations

import getpass
import hashlib
import platform
import shutil
import subprocess
import sys
import tempfile
import venv
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from tests.judge.transcript import environment as clean_environment


class Distribution(NamedTuple):
    """What is installed together: its name, packages, and a program that works if they do."""

    name: str
    packages: Sequence[str]
    tried: str = "import rclpy; rclpy.init(); rclpy.create_node('tried'); print('ready')"


KILTED = Distribution(
    "kilted",
    [
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
    ],
)
"""ROS 2 Kilted, with all that the judge's programs import."""

JAZZY = Distribution(
    "jazzy",
    [
        "ros-jazzy-rclpy==7.1.6",
        "ros-jazzy-rmw-fastrtps-cpp==8.4.3",
        "ros-jazzy-rmw-implementation==2.15.6",
        "ros-jazzy-std-msgs==5.3.6",
        "ros-jazzy-geometry-msgs==5.3.6",
        "ros-jazzy-sensor-msgs==5.3.6",
        "ros-jazzy-nav-msgs==5.3.6",
        "ros-jazzy-std-srvs==5.3.6",
        "ros-jazzy-test-msgs==2.0.3",
        "ros-jazzy-lifecycle-msgs==2.0.3",
        "numpy",
    ],
)
"""ROS 2 Jazzy."""

CYCLONE = Distribution("cyclone", ["cyclonedds==11.0.1"], "import cyclonedds.core, cyclonedds.domain")
"""DDS of another vendor; no ROS 2."""

DISTRIBUTIONS = {each.name: each for each in (KILTED, JAZZY, CYCLONE)}


class NoWheelsError(Exception):
    """The real rclpy cannot be run here, with the reason."""


def interpreter(environment: Path | None = None, distribution: Distribution = KILTED) -> list[str]:
    """Return the command of a Python that has a real ROS 2; it is installed if that was not done before.

    Args:
        environment: A virtual environment that has it; by default one of the judge's own.
        distribution: What shall be in it.

    Raises:
        NoWheelsError: If this system has none, they could not be installed, or they do not work.
    """
    if environment is not None:
        return _tried(environment, distribution)
    if sys.platform != "linux" or platform.machine() != "x86_64":
        raise NoWheelsError(f"there are wheels for Linux on x86_64 only, not for {sys.platform} {platform.machine()}")
    environment = _folder(distribution)
    with _alone(environment):
        if not _is_complete(environment):
            _install(environment, distribution)
            (environment / "complete").touch()
    return _tried(environment, distribution)


def installed(distribution: Distribution) -> list[str]:
    """Return the command of a Python that `interpreter` has prepared. Raises NoWheelsError if it has not."""
    environment = _folder(distribution)
    if not _is_complete(environment):
        raise NoWheelsError(f"not installed: python -m tests.judge.wheels {distribution.name}")
    return [str(environment / "bin" / "python")]


def _folder(distribution: Distribution) -> Path:
    """Return a folder of this user, Python and list of packages."""
    key = hashlib.sha256("\n".join([sys.version, *distribution.packages]).encode()).hexdigest()[:12]
    return Path(tempfile.gettempdir()) / f"robolink-judge-{getpass.getuser()}-{key}"


def _is_complete(environment: Path) -> bool:
    return (environment / "complete").exists()


@contextmanager
def _alone(environment: Path) -> Iterator[None]:
    """Keep other processes from installing the same one meanwhile."""
    if sys.platform == "win32":
        raise NoWheelsError("there are wheels for Linux only")
    import fcntl

    with environment.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def _install(environment: Path, distribution: Distribution) -> None:
    shutil.rmtree(environment, ignore_errors=True)
    venv.create(environment, with_pip=True)
    pip = [str(environment / "bin" / "python"), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    _run([*pip, "--prefer-binary", *distribution.packages], 600.0)


def _tried(environment: Path, distribution: Distribution) -> list[str]:
    command = [str(environment / "bin" / "python")]
    _run([*command, "-c", distribution.tried], 60.0)
    return command


def _run(command: Sequence[str], seconds: float) -> None:
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds, env=clean_environment())
    except (OSError, subprocess.TimeoutExpired) as error:
        raise NoWheelsError(str(error)) from error
    if done.returncode:
        last = [line for line in done.stderr.splitlines() if line.strip()][-1:] or [f"exit code {done.returncode}"]
        raise NoWheelsError(f"{Path(command[0]).name} {' '.join(command[1:4])} ...: {last[0]}")


def main(names: Sequence[str]) -> int:
    for name in names or DISTRIBUTIONS:
        try:
            said = " ".join(interpreter(distribution=DISTRIBUTIONS[name]))
        except NoWheelsError as reason:
            said = f"cannot be run here: {reason}"
        sys.stdout.write(f"{name}: {said}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
