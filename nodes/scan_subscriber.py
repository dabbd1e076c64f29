"""Listen to a laser scanner, and warn of what is near."""

import contextlib
import math
from typing import Any, NamedTuple

import robolink
from robolink import Node
from robolink.control.laser import returns
from robolink.exceptions import ExternalShutdownException
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.parameters.descriptors import described


class Nearest(NamedTuple):
    """The nearest thing that a scan has met: metres (inf where it met nothing), and radians, 0 ahead and left > 0."""

    distance: float = math.inf
    bearing: float = 0.0


class ScanSubscriber(Node):
    """A node that logs the distance and direction of the nearest thing in each scan, as a warning if it is too near."""

    def __init__(self, **options: Any) -> None:
        super().__init__("scan_subscriber", **options)
        self.declare_parameter("warn_distance", 0.5, described("metres within which it warns", 0.0, 100.0))
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def on_scan(self, scan: LaserScan) -> None:
        """Log one scan. The lines are throttled: ten a second are more than one can read."""
        found = nearest(scan)
        if found.distance < self.get_parameter("warn_distance").value:
            self.get_logger().warning(f"obstacle near: {said(found)}", throttle_duration_sec=1.0)
        else:
            self.get_logger().info(f"the way is free: {said(found)}", throttle_duration_sec=1.0)


def nearest(scan: LaserScan) -> Nearest:
    """Find the nearest thing in a scan. Beams without a return (inf, NaN) do not count; there may be no others."""
    angles, ranges = returns(scan)
    if len(ranges) == 0:
        return Nearest()
    at = ranges.argmin()
    return Nearest(float(ranges[at]), float(angles[at]))


def said(found: Nearest) -> str:
    """Return a direction in words."""
    if math.isinf(found.distance):
        return "nothing in reach"
    degrees = round(math.degrees(found.bearing))
    side = "ahead" if degrees == 0 else f"{abs(degrees)} degrees to the {'left' if degrees > 0 else 'right'}"
    return f"{found.distance:.2f} m, {side}"


def main(args: list[str] | None = None) -> None:
    """Run the node until Ctrl-C."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        robolink.spin(ScanSubscriber())


if __name__ == "__main__":
    main()
