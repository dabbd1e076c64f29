"""The robots of the simulated world of a system under test, as they truly are: not what their sensors tell."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Protocol

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.names import the_one
from robolink.plane import Area, pose_of
from robolink.serialization import deserialize_message

if TYPE_CHECKING:
    from robolink.sim import Pose
    from robolink.sim.readings import Velocity
    from robolink.testing.recorder import Recorder, Topic

TRUTH = "/ground_truth"
"""How the topics end on which a world tells where a robot truly is."""
DIAGNOSTICS = "/diagnostics"
"""Where a world tells, each second, how many things were run into."""
_JUMP = 3.0
"""How many times farther away than its speed allows a robot must be to have been put there."""


class NoRobotError(NotFoundError):
    """There is no robot at all, or none that could be meant without a name."""

    def __init__(self, text: str) -> None:
        self.kind, self.name = "robot", ""
        RobolinkError.__init__(self, text)


class SimulatedRobot(Protocol):
    """A robot of the world, as it truly is: metres, radians, seconds."""

    name: str

    @property
    def pose(self) -> Pose:
        """Where it is."""

    @property
    def twist(self) -> Velocity:
        """How fast it goes: along (`v`), about (`w`) and across (`sideways`) its heading."""

    @property
    def driven(self) -> float:
        """Metres that it has driven since the beginning."""

    @property
    def area(self) -> Area:
        """The box in which it has been since the beginning."""

    @property
    def contacts(self) -> int:
        """How many things it has run into since the beginning."""


def chosen(robots: Iterable[tuple[str, SimulatedRobot]], name: str | None) -> SimulatedRobot:
    """Give the robot of a name, as `robots_of` gives it, or the only one. Raises NotFoundError."""
    found = list(robots)
    names = [each for each, _ in found]
    if not found:
        raise NoRobotError("this system has no robot: no simulated world has begun in it")
    if name is not None:
        name = the_one("robot", name, names, f"the world, which has {', '.join(names)}")
    elif len(found) > 1:
        raise NoRobotError(f"which robot? The world has {', '.join(names)}: give a name")
    return next(robot for each, robot in found if name in (None, each))


class RobotElsewhere:
    """A robot whose world is another process: it tells of it by topics."""

    driven = 0.0
    """Metres that it has driven since the first word of it; where it was put elsewhere, nothing is added."""
    contacts = 0
    """How many things all robots of its world have run into: what is told each second."""

    def __init__(self, topic: str) -> None:
        self.name = topic.removesuffix(TRUTH).strip("/") or "robot"
        self._last: Odometry | None = None
        self._area: Area | None = None

    @property
    def pose(self) -> Pose:
        """Where it truly is: metres, and the heading in radians."""
        from robolink.sim import Pose

        return Pose(0.0, 0.0) if self._last is None else Pose(*pose_of(self._last.pose.pose))

    @property
    def area(self) -> Area:
        """The box in metres in which it has been since the first word of it."""
        return Area(0.0, 0.0, 0.0, 0.0) if self._area is None else self._area

    @property
    def twist(self) -> Velocity:
        """How fast it goes: along, about and across its heading."""
        from robolink.sim.readings import Velocity

        if self._last is None:
            return Velocity(0.0, 0.0)
        told = self._last.twist.twist
        return Velocity(told.linear.x, told.angular.z, told.linear.y)

    def tell(self, payload: bytes) -> None:
        """Take in where it is."""
        told: Odometry = deserialize_message(payload, Odometry)
        if self._last is not None:
            self.driven += _way(self._last, told)
        x, y, _ = pose_of(told.pose.pose)
        self._last, self._area = told, (self._area or Area(x, y, x, y)).grown(x, y)

    def diagnose(self, payload: bytes) -> None:
        """Take in what the world tells of itself."""
        told: DiagnosticArray = deserialize_message(payload, DiagnosticArray)
        found = [int(value.value) for each in told.status for value in each.values if value.key == "contacts"]
        self.contacts = found[0] if found else self.contacts


def _way(one: Odometry, other: Odometry) -> float:
    here, there = one.pose.pose.position, other.pose.pose.position
    way = math.hypot(there.x - here.x, there.y - here.y)
    before, now = one.header.stamp, other.header.stamp
    seconds = now.sec - before.sec + (now.nanosec - before.nanosec) / 1e9
    speed = max(math.hypot(each.twist.twist.linear.x, each.twist.twist.linear.y) for each in (one, other))
    return way if way <= _JUMP * (speed * seconds + 0.01) else 0.0


class RobotsElsewhere:
    """The robots of which somebody tells on the network."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder
        self.robots: list[RobotElsewhere] = []
        recorder.tell_of_topics(self._on_topic)

    def _on_topic(self, topic: Topic) -> None:
        if topic.name.endswith(TRUTH) and topic.type_name == Odometry.__ros_type__:
            self.robots.append(RobotElsewhere(topic.name))
            self._recorder.hear(topic, self.robots[-1].tell)
        elif topic.name == DIAGNOSTICS and topic.type_name == DiagnosticArray.__ros_type__:
            self._recorder.hear(topic, self._diagnose)

    def _diagnose(self, payload: bytes) -> None:
        for each in self.robots:
            each.diagnose(payload)
