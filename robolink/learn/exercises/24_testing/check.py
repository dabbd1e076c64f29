"""Check of a test: it has to pass with a good program, and to fail with each of two bad ones."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

from robolink import Node
from robolink.grading.mistakes import mistake_of
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.learn.trial import SEED, Trial
from robolink.testing import System


class Good(Node):
    """A program that drives, and stops before what is near."""

    def __init__(self) -> None:
        super().__init__("careful")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        """Answer a scan."""
        twist = Twist()
        twist.linear.x = self.speed(min(scan.ranges))
        self.publisher.publish(twist)

    def speed(self, nearest: float) -> float:
        """Return the speed in m/s."""
        return 0.3 if nearest >= 0.5 else 0.0


class NeverDrives(Good):
    """A program that always stands."""

    def speed(self, nearest: float) -> float:
        """Return the speed in m/s."""
        return 0.0


class NeverStops(Good):
    """A program that always drives."""

    def speed(self, nearest: float) -> float:
        """Return the speed in m/s."""
        return 0.3


def check(trial: Trial) -> None:
    """Run the test with each program."""
    trial.tell("there", tests_of(trial.module()))
    error = failure(trial, Good)
    trial.tell("good", not error, text=error)
    trial.tell("never_drives", failure(trial, NeverDrives))
    trial.tell("never_stops", failure(trial, NeverStops))


def failure(trial: Trial, program: type[Node]) -> str:
    """Run the tests, as pytest would; return the line at which one fails, '' if they pass."""
    for test in tests_of(trial.module()):
        with System(seed=SEED) as system:
            try:
                test(system, program)
            except AssertionError as error:
                mistake = mistake_of(error, trial.file)
                line = mistake.code.strip() if mistake else ""
                return f"{line} {' '.join(str(error).splitlines()[:1])}".strip()
    return ""


def tests_of(module: ModuleType) -> list[Callable[[System, type[Node]], object]]:
    """Return the functions that pytest would take for tests."""
    return [each for name, each in vars(module).items() if name.startswith("test_") and callable(each)]
