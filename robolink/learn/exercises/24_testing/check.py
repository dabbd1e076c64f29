"""Check of a test: it has to pass with a good program, and to fail with each of two bad ones."""

from __future__ import annotations

from robolink import Node
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.learn.mistakes import mistake_of
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
    error = failure(trial, Good)
    trial.tell("good", not error, text=error)
    trial.tell("never_drives", failure(trial, NeverDrives))
    trial.tell("never_stops", failure(trial, NeverStops))


def failure(trial: Trial, program: type[Node]) -> str:
    """Run the test; return the line at which it fails, '' if it passes."""
    with System(seed=SEED) as system:
        try:
            trial.module().test_it_stops_before_what_is_near(system, program)
        except AssertionError as error:
            mistake = mistake_of(error, trial.file)
            return mistake.code.strip() if mistake else str(error)
    return ""
