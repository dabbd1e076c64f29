"""Kinematics of turtlesim's turtles: a pose, a pen and a command that lasts one second, moved in steps of 16 ms."""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.action import ActionServer, CancelResponse
from robolink.interfaces.turtlesim.action import RotateAbsolute
from robolink.task import Future

if TYPE_CHECKING:
    from robolink.action.server import ServerGoalHandle
    from robolink.node import Node

SIDE = 500
"""Width and height of the window, in pixels."""

METRE = 45.0
"""Pixels of a metre: the height of turtlesim's pictures of turtles."""

SIZE = (SIDE - 1) / METRE
"""Width and height of the window, in metres: 11.088889."""

CENTRE: float = struct.unpack("f", struct.pack("f", SIZE / 2))[0]
"""Coordinates of the first turtle, in metres, as a float32: 5.544445."""

PERIOD = 0.016
"""Seconds of a step: 62.5 Hz."""

COMMAND_LASTS = 1.0
"""Seconds for which a turtle obeys a command."""

TURN_SPEED = 1.0
"""Speed of a turn to a heading, in rad/s."""

TURN_REACHED = 0.02
"""Radians from the heading at which a turn ends."""

MOST = 1e6
"""Largest number that a turtle obeys, in any unit: with larger ones it would compute no poses, and no messages."""

Point = tuple[float, float]
"""Coordinates in metres, from the lower left corner of the window."""


class Pen(NamedTuple):
    """Pen of a turtle: colour from 0 to 255, width in pixels."""

    r: int = 0xB3
    g: int = 0xB8
    b: int = 0xFF
    width: int = 3
    is_off: bool = False


class Line(NamedTuple):
    """A line that a pen draws."""

    start: Point
    end: Point
    pen: Pen


class Turn(NamedTuple):
    """State of a turn to a heading, in radians: what is left, and what was turned, with turtlesim's reversed sign."""

    remaining: float
    delta: float

    @property
    def is_reached(self) -> bool:
        """True once the turtle looks there."""
        return abs(self.remaining) < TURN_REACHED


class Step(NamedTuple):
    """Outcome of one step."""

    jumps: list[Line]
    """Lines of the jumps, which come first."""
    line: Line | None
    """Line of the movement, which is drawn once the colour below the turtle was read."""
    hit: Point | None
    """Place outside of the window that the turtle was kept from."""
    turn: Turn | None
    """State of the turn, if there is one; it has ended if `is_reached`."""


@dataclass
class Turtle:
    """A turtle: pose in metres and radians, speeds in m/s and rad/s, times in seconds of any steady clock.

    Numbers that are not finite count as 0, larger ones than a million as a million.
    """

    x: float = CENTRE
    y: float = CENTRE
    theta: float = 0.0
    pen: Pen = field(default_factory=Pen)
    linear: float = 0.0
    sideways: float = 0.0
    angular: float = 0.0
    commanded_at: float = -math.inf
    heading: float | None = None
    """Heading that it turns to."""
    turned_from: float = 0.0
    jumps: list[tuple[float, float, float, bool]] = field(default_factory=list)
    """Jumps that the next step begins with: (x, y, theta, False), or (linear, 0, angular, True)."""

    def __post_init__(self) -> None:
        self.x, self.y, self.theta = _sane(self.x), _sane(self.y), _sane(self.theta)

    def drive(self, linear: float, angular: float, now: float, sideways: float = 0.0) -> None:
        """Obey a command for a second; a turn to a heading ends."""
        self.linear, self.angular, self.sideways = _sane(linear), _sane(angular), _sane(sideways)
        self.commanded_at, self.heading = now, None

    def turn_to(self, heading: float) -> None:
        """Begin to turn to a heading, in radians, by the shorter way."""
        self.heading, self.turned_from = normalized(_sane(heading)), self.theta

    def stop(self) -> None:
        """Stand still at once."""
        self.linear = self.sideways = self.angular = 0.0
        self.heading = None

    def jump_to(self, x: float, y: float, theta: float) -> None:
        """Jump to another place, from the next step on."""
        self.jumps.append((_sane(x), _sane(y), _sane(theta), False))

    def jump_ahead(self, linear: float, angular: float) -> None:
        """Turn by `angular` and then jump `linear` metres ahead, from the next step on."""
        self.jumps.append((_sane(linear), 0.0, _sane(angular), True))

    def step(self, now: float) -> Step:
        """Move for the time of one step."""
        jumps = [line for each in self.jumps if (line := self._jump(*each))]
        self.jumps.clear()
        turn = self._turn(now)
        if now - self.commanded_at > COMMAND_LASTS:
            self.linear = self.sideways = self.angular = 0.0
        before = (self.x, self.y)
        self.theta = normalized(self.theta + self.angular * PERIOD)
        cos, sin = math.cos(self.theta) * PERIOD, math.sin(self.theta) * PERIOD
        self.x += cos * self.linear - sin * self.sideways
        self.y += sin * self.linear + cos * self.sideways
        hit = self._stay_inside()
        return Step(jumps, self._line(before) if (self.x, self.y) != before else None, hit, turn)

    def _jump(self, x: float, y: float, theta: float, is_relative: bool) -> Line | None:
        before = (self.x, self.y)
        if is_relative:
            self.theta += theta
            self.x += math.cos(self.theta) * x
            self.y += math.sin(self.theta) * x
        else:
            self.x, self.y, self.theta = x, min(SIZE, y), theta
        return self._line(before)

    def _turn(self, now: float) -> Turn | None:
        """Turn on, at the speed of turns; stand once the heading is reached."""
        if self.heading is None:
            return None
        turn = Turn(normalized(self.heading - self.theta), normalized(self.turned_from - self.theta))
        heading = self.heading
        self.stop()
        if not turn.is_reached:
            self.heading, self.commanded_at = heading, now
            self.angular = math.copysign(TURN_SPEED, turn.remaining)
        return turn

    def _stay_inside(self) -> Point | None:
        free = (self.x, self.y)
        self.x, self.y = min(max(self.x, 0.0), SIZE), min(max(self.y, 0.0), SIZE)
        return free if free != (self.x, self.y) else None

    def _line(self, before: Point) -> Line | None:
        return None if self.pen.is_off else Line(before, (self.x, self.y), self.pen)


def normalized(angle: float) -> float:
    """Return an angle as one from -pi to below pi."""
    return angle - math.tau * math.floor((angle + math.pi) / math.tau)


def _sane(value: float) -> float:
    return min(max(value, -MOST), MOST) if math.isfinite(value) else 0.0


class Rotation:
    """Server of the action of one turtle.

    Args:
        node: Node of the server.
        name: Name of the turtle.
        turtle: The turtle that is turned.
    """

    def __init__(self, node: Node, name: str, turtle: Turtle) -> None:
        self._turtle, self._logger = turtle, node.get_logger()
        self._goal: ServerGoalHandle | None = None
        self._ended: Future[Any] = Future()
        self._result = RotateAbsolute.Result()
        self._server = ActionServer(
            node,
            RotateAbsolute,
            f"{name}/rotate_absolute",
            self._execute,
            handle_accepted_callback=self._accept,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
        )

    def destroy(self) -> None:
        """End the server, and the goal with it."""
        self.abort()
        self._server.destroy()

    def abort(self, why: str = "") -> None:
        """Abort the goal, if there is one, and warn of it."""
        if self._goal is None:
            return
        if why:
            self._logger.warning(why)
        self._goal.abort()
        self._end()

    def cancel_if_requested(self) -> None:
        """Cancel the goal, and let the turtle stand, if a client has requested it."""
        if self._goal is not None and self._goal.is_cancel_requested:
            self._logger.info("Rotation goal canceled")
            self._goal.canceled()
            self._turtle.stop()
            self._end()

    def report(self, turn: Turn) -> None:
        """Send the state of the turn as feedback, and the result once the heading is reached."""
        if self._goal is None:
            return
        self._result.delta = turn.delta
        self._goal.publish_feedback(RotateAbsolute.Feedback(remaining=turn.remaining))
        if turn.is_reached:
            self._logger.info("Rotation goal completed successfully")
            self._goal.succeed()
            self._end()

    def _accept(self, goal: ServerGoalHandle) -> None:
        self.abort("Rotation goal received before a previous goal finished. Aborting previous goal")
        self._goal, self._ended, self._result = goal, Future(), RotateAbsolute.Result()
        self._turtle.turn_to(goal.request.theta)
        ended = self._ended
        goal.execute(lambda goal: _awaited(ended))

    async def _execute(self, goal: ServerGoalHandle) -> Any:
        raise NotImplementedError("each goal is executed by a function of its own")

    def _end(self) -> None:
        self._goal = None
        self._ended.set_result(self._result)


async def _awaited(ended: Future[Any]) -> Any:
    return await ended
