"""Report of a check: sentences on what was looked at, the mistake that ended it, and the way of the robots."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from msgspec import Struct
from msgspec.structs import force_setattr

from robolink.grading.mistakes import Mistake, fit_text

if TYPE_CHECKING:
    from robolink.geometry.plane import Pose
    from robolink.host.pace import HostTime
    from robolink.sim import World
    from robolink.sim.description import Shape
    from robolink.world_node import Simulation

PERIOD = 100_000_000
"""Time between two looks, in ns of virtual time."""

MOST_POSES = 6_000
"""Upper bound of the poses of all bodies together: beyond it every second look is dropped."""

MOST_WALLS = 4_000
"""Upper bound of the walls that are kept."""

MOST_CONTACTS = 100
"""Upper bound of the contacts that are kept."""


class _Path:
    """Poses of one body, from the look of number `first` on."""

    def __init__(self, name: str, shape: Shape, first: int, *, is_robot: bool, stands: bool) -> None:
        self.name, self.shape, self.first, self.is_robot, self.stands = name, shape, first, is_robot, stands
        self.poses: list[tuple[float, float, float]] = []
        self.contacts = 0

    def add(self, pose: Pose) -> None:
        """Add a pose; one that is not a number, of a robot that a program has broken, counts as the one before."""
        if self.stands and self.poses:
            return
        is_number = all(map(math.isfinite, pose))
        x, y, theta = pose if is_number else self.poses[-1] if self.poses else (0.0, 0.0, 0.0)
        self.poses.append((round(x, 3), round(y, 3), round(theta, 3)))

    def thin(self) -> None:
        """Drop the poses of odd looks."""
        if not self.stands:
            self.poses = self.poses[self.first % 2 :: 2]
        self.first = (self.first + 1) // 2

    def body(self) -> Body:
        """Return it for a report."""
        corners = [] if self.shape.circle is not None else [(round(x, 3), round(y, 3)) for x, y in self.shape.corners()]
        path = [value for pose in self.poses for value in pose]
        return Body(self.name, self.is_robot, self.shape.circle or 0.0, corners, self.first, path)


class Tracker:
    """Observer of the first simulated world of a system, in virtual time; it changes nothing of the run.

    Args:
        time: Virtual time of the system.
        simulations: Function that returns the simulated worlds that are there.
    """

    def __init__(self, time: HostTime, simulations: Callable[[], Iterable[Simulation]]) -> None:
        self._time, self._simulations = time, simulations
        self._simulation: Simulation | None = None
        self._period, self._looks = PERIOD, 0
        self._paths: dict[str, _Path] = {}
        self._contacts: list[Contact] = []
        self._is_over = False
        self._plan()

    def _plan(self) -> None:
        self._time.at(self._time.now() + self._period, self._look)

    def _look(self) -> None:
        if self._is_over:
            return
        try:
            if self._simulation is None:
                self._simulation = next(iter(self._simulations()), None)
            if self._simulation is not None:
                self._note(self._simulation.world)
        except Exception:  # noqa: BLE001 - a program can reach into the world; a picture must not change its result
            self._is_over = True
            return
        self._plan()

    def _note(self, world: World) -> None:
        for index, (obstacle, pose) in enumerate(zip(world.description.obstacles, world.obstacle_poses(), strict=True)):
            stands = obstacle.path is None and obstacle.mass is None
            self._path(f"obstacle {index}", obstacle, is_robot=False, stands=stands).add(pose)
        for name, robot in world.robots.items():
            path = self._path(name, robot.description.shape, is_robot=True, stands=False)
            path.add(robot.pose.place)
            if robot.contacts > path.contacts and len(self._contacts) < MOST_CONTACTS:
                x, y, _ = path.poses[-1]
                self._contacts.append(Contact(round(self._looks * self._period / 1e9, 3), x, y))
            path.contacts = robot.contacts
        self._looks += 1
        if sum(len(each.poses) for each in self._paths.values()) > MOST_POSES:
            self._thin()

    def _path(self, name: str, shape: Shape, *, is_robot: bool, stands: bool) -> _Path:
        if name not in self._paths:
            self._paths[name] = _Path(name, shape, self._looks, is_robot=is_robot, stands=stands)
        return self._paths[name]

    def _thin(self) -> None:
        for each in self._paths.values():
            each.thin()
        self._period, self._looks = self._period * 2, (self._looks + 1) // 2

    def track(self) -> Track | None:
        """End looking, and return the track; None if there was no robot in a world."""
        self._is_over = True
        if self._simulation is None or not any(each.is_robot for each in self._paths.values()):
            return None
        walls = [
            (round(a, 3), round(b, 3), round(c, 3), round(d, 3))
            for wall in self._simulation.world.description.walls
            for (a, b), (c, d) in wall.segments()
        ]
        bodies = [each.body() for each in self._paths.values()]
        return Track(walls[:MOST_WALLS], bodies, self._period / 1e9, self._contacts)


class Line(Struct, frozen=True):
    """Sentence of a check."""

    good: bool
    text: str

    def __post_init__(self) -> None:
        force_setattr(self, "text", fit_text(self.text))


class Body(Struct, frozen=True):
    """Robot or obstacle of a simulated world, and where it was; lengths in m, angles in rad."""

    name: str
    is_robot: bool
    circle: float = 0.0
    """Radius; 0 for an outline."""
    corners: list[tuple[float, float]] = []
    """Outline about its own origin, counter-clockwise."""
    first: int = 0
    """Number of the first look at it."""
    path: list[float] = []
    """x, y and heading at each look from the first on; of what stands only once."""


class Contact(Struct, frozen=True):
    """Contact of a robot: the time in s, and the place of the robot in m."""

    at: float
    x: float
    y: float


class Track(Struct, frozen=True):
    """Walls (x and y of both ends, in m) and bodies of a simulated world, seen each `period` seconds."""

    walls: list[tuple[float, float, float, float]]
    bodies: list[Body]
    period: float
    contacts: list[Contact] = []


class Report(Struct, frozen=True):
    """Result of a check."""

    lines: list[Line] = []
    mistake: Mistake | None = None
    is_over: bool = False
    """True if the student's program had come to its end by itself."""
    printed: str = ""
    """Output of the program, cut to a length."""
    seconds: float = 0.0
    """Seconds that the check took."""
    track: Track | None = None
    """Path of the robots; None if the check had none."""

    @property
    def passed(self) -> bool:
        """True if all that was looked at is as it should be."""
        return self.mistake is None and bool(self.lines) and all(each.good for each in self.lines)
