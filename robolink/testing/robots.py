"""True state of the robots in a simulated world, which no sensor noise changes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Protocol

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.geometry.plane import Area, pose_of
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.serialization import deserialize_message
from robolink.text.names import the_one

if TYPE_CHECKING:
    from robolink.sim import Pose
    from robolink.sim.readings import Velocity
    from robolink.testing.recorder import Recorder, Topic

TRUTH = "/ground_truth"
"""Suffix of the topics on which a world publishes the true pose of its robots."""
DIAGNOSTICS = "/diagnostics"
"""Topic on which a world publishes its number of contacts, each second."""
_JUMP = 3.0
"""Factor on the distance that its speed allows, above which a robot was put elsewhere and did not drive."""


class NoRobotError(NotFoundError):
    """There is no robot at all, or none that could be meant without a name."""

    def __init__(self, text: str) -> None:
        self.kind, self.name = "robot", ""
        RobolinkError.__init__(self, text)


class SimulatedRobot(Protocol):
    """A robot of the simulated world in its true state: metres, radians, seconds."""

    name: str

    @property
    def pose(self) -> Pose:
        """Pose in the world: `x` and `y` in m, `theta` in rad."""

    @property
    def twist(self) -> Velocity:
        """Velocity along its heading (`v`, m/s), about it (`w`, rad/s) and across it (`sideways`, m/s)."""

    @property
    def driven(self) -> float:
        """Metres driven since the beginning."""

    @property
    def area(self) -> Area:
        """Bounding box in m of where it has been since the beginning."""

    @property
    def contacts(self) -> int:
        """Count of the things it has run into since the beginning."""


def chosen(robots: Iterable[tuple[str, SimulatedRobot]], name: str | None) -> SimulatedRobot:
    """Return the robot of a name, as `robots_of` names it, or the only one. Raises NotFoundError."""
    found = list(robots)
    names = [each for each, _ in found]
    if not found:
        raise NoRobotError("this system has no robot: no simulated world has begun in it")
    if name is not None:
        name = the_one("robot", name, names, f"the world, which has {', '.join(names)}")
    elif len(found) > 1:
        raise NoRobotError(f"which robot? The world has {', '.join(names)}: give a name")
    return next(robot for each, robot in found if name in (None, each))


class RemoteRobot:
    """A robot whose world is another process, by the topics of that world."""

    driven = 0.0
    """Metres driven since its first message; a jump to another place adds nothing."""
    contacts = 0
    """Contacts of all robots of its world, updated each second."""

    def __init__(self, topic: str) -> None:
        self.name = topic.removesuffix(TRUTH).strip("/") or "robot"
        self._last: Odometry | None = None
        self._area: Area | None = None

    @property
    def pose(self) -> Pose:
        """Pose in the world: `x` and `y` in m, `theta` in rad."""
        from robolink.sim import Pose

        return Pose(0.0, 0.0) if self._last is None else Pose(*pose_of(self._last.pose.pose))

    @property
    def area(self) -> Area:
        """Bounding box in m of where it has been since its first message."""
        return Area(0.0, 0.0, 0.0, 0.0) if self._area is None else self._area

    @property
    def twist(self) -> Velocity:
        """Velocity along its heading (`v`, m/s), about it (`w`, rad/s) and across it (`sideways`, m/s)."""
        from robolink.sim.readings import Velocity

        if self._last is None:
            return Velocity(0.0, 0.0)
        twist = self._last.twist.twist
        return Velocity(twist.linear.x, twist.angular.z, twist.linear.y)

    def update(self, payload: bytes) -> None:
        """Update its state from an Odometry."""
        odometry: Odometry = deserialize_message(payload, Odometry)
        if self._last is not None:
            self.driven += _way(self._last, odometry)
        x, y, _ = pose_of(odometry.pose.pose)
        self._last, self._area = odometry, (self._area or Area(x, y, x, y)).grown(x, y)

    def update_contacts(self, payload: bytes) -> None:
        """Update its contacts from a DiagnosticArray."""
        diagnostics: DiagnosticArray = deserialize_message(payload, DiagnosticArray)
        found = [int(value.value) for each in diagnostics.status for value in each.values if value.key == "contacts"]
        self.contacts = found[0] if found else self.contacts


def _way(one: Odometry, other: Odometry) -> float:
    here, there = one.pose.pose.position, other.pose.pose.position
    way = math.hypot(there.x - here.x, there.y - here.y)
    before, now = one.header.stamp, other.header.stamp
    seconds = now.sec - before.sec + (now.nanosec - before.nanosec) / 1e9
    speed = max(math.hypot(each.twist.twist.linear.x, each.twist.twist.linear.y) for each in (one, other))
    return way if way <= _JUMP * (speed * seconds + 0.01) else 0.0


class RemoteRobots:
    """The robots that worlds in other processes publish."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder
        self.robots: list[RemoteRobot] = []
        recorder.follow_topics(self._on_topic)

    def _on_topic(self, topic: Topic) -> None:
        if topic.name.endswith(TRUTH) and topic.type_name == Odometry.__ros_type__:
            self.robots.append(RemoteRobot(topic.name))
            self._recorder.hear(topic, self.robots[-1].update)
        elif topic.name == DIAGNOSTICS and topic.type_name == DiagnosticArray.__ros_type__:
            self._recorder.hear(topic, self._diagnose)

    def _diagnose(self, payload: bytes) -> None:
        for each in self.robots:
            each.update_contacts(payload)
