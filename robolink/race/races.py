"""The races: line, maze and follow, each with its world for a seed, its length and its judge."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

from robolink.documents.yamlfile import parse, spell
from robolink.race.courses import GOAL, SIZE, START, ClosedLine, Maze, Progress, make_maze
from robolink.workspace import built_in_workspace

PENALTY = 5.0
"""Seconds, or metres, that each contact costs."""

World = dict[str, Any]


class Judge(Protocol):
    """Judge of one run."""

    @property
    def is_over(self) -> bool:
        """True once the race is finished."""

    @property
    def progress(self) -> float:
        """Share of the way that the robot has come, from 0 to 1; for races that have an end."""

    def see(self, time: float, x: float, y: float, contacts: int) -> None:
        """Note that the robot is at (x, y) in metres at this time in seconds, with so many contacts since the start."""

    def score(self) -> float | None:
        """Return the score, None for a race that was not finished."""


class LapJudge:
    """Judge of a lap: the score is its time in seconds, and some more for each contact; less is better.

    Args:
        line: The line to drive along; the robot has to stay within `reach` metres of it.
        reach: Metres.
    """

    def __init__(self, line: ClosedLine, reach: float) -> None:
        self._length = line.length
        self._progress = Progress(line, 0.0, reach)
        self._time = self._contacts = 0.0
        self._finish: float | None = None

    @property
    def is_over(self) -> bool:
        """True once the lap is complete."""
        return self._finish is not None

    @property
    def progress(self) -> float:
        """Share of the lap."""
        return max(0.0, min(1.0, self._progress.metres / self._length))

    def see(self, time: float, x: float, y: float, contacts: int) -> None:
        """Note where the robot is."""
        before, then = self._progress.metres, self._time
        self._progress.see(x, y)
        self._time, self._contacts = time, contacts
        now = self._progress.metres
        if self._finish is None and now >= self._length:
            self._finish = then + (time - then) * (self._length - before) / (now - before)

    def score(self) -> float | None:
        """Return the time of the lap."""
        return None if self._finish is None else self._finish + PENALTY * self._contacts


class MazeJudge:
    """Judge of a maze: the score is the time in seconds to its goal, and some more for each contact; less is better.

    The robot has to come from cell to open cell; one that is somewhere else at once counts as where it was.

    Args:
        maze: The maze.
        reach: Distance in metres from the middle of the last cell at which it is reached.
    """

    def __init__(self, maze: Maze, reach: float) -> None:
        self._doors, self._steps, self._reach = maze.doors, maze.steps_to_goal(), reach
        self._cell = START
        self._longest = self._least = self._steps[START]
        self._contacts = 0
        self._finish: float | None = None

    @property
    def is_over(self) -> bool:
        """True once the goal is reached."""
        return self._finish is not None

    @property
    def progress(self) -> float:
        """Share of the cells on the way to the goal."""
        return 1.0 - self._least / self._longest

    def see(self, time: float, x: float, y: float, contacts: int) -> None:
        """Note where the robot is."""
        cell = (math.floor(x), math.floor(y))
        if cell in self._doors[self._cell]:
            self._cell = cell
        self._least = min(self._least, self._steps[self._cell])
        self._contacts = contacts
        is_there = cell == self._cell == GOAL and math.dist((x, y), (GOAL[0] + 0.5, GOAL[1] + 0.5)) <= self._reach
        if self._finish is None and is_there:
            self._finish = time

    def score(self) -> float | None:
        """Return the time to the goal."""
        return None if self._finish is None else self._finish + PENALTY * self._contacts


class WallJudge:
    """Judge of following a wall: the score is metres of it, less some for each contact; more is better.

    Args:
        wall: The wall.
        nearest: Least distance from the wall at which a way counts, in metres.
        farthest: Largest distance from the wall at which a way counts, in metres.
    """

    is_over = False
    progress = 1.0

    def __init__(self, wall: ClosedLine, nearest: float, farthest: float) -> None:
        self._progress = Progress(wall, nearest, farthest)
        self._contacts = 0

    def see(self, time: float, x: float, y: float, contacts: int) -> None:
        """Note where the robot is."""
        self._progress.see(x, y)
        self._contacts = contacts

    def score(self) -> float | None:
        """Return the metres of wall."""
        return self._progress.metres - PENALTY * self._contacts


class Race(NamedTuple):
    """A race."""

    name: str
    unit: str
    """Unit of the score."""
    less_is_better: bool
    seconds: float
    """Longest time, in virtual seconds."""
    make_world: Callable[[int], World]
    """Returns the world of a seed, as the data of a world file."""
    judge: Callable[[int], Judge]
    """Returns the judge for a seed."""

    def world(self, seed: int) -> str:
        """Return the text of the world file of a seed."""
        return spell(self.make_world(seed))


def _built_in(name: str) -> World:
    path = built_in_workspace() / "configs" / "worlds" / f"{name}.yaml"
    found = parse(path.read_text(encoding="utf-8"), name=str(path))
    assert isinstance(found, dict)
    return found


def _jittered(world: World, seed: int) -> World:
    """Move the robot's start a little, by the seed."""
    chance = random.Random(seed)
    robot = world["robots"][0]
    x, y, theta = robot["pose"]
    robot["pose"] = [x + chance.uniform(-0.1, 0.1), y + chance.uniform(-0.03, 0.03), theta + chance.uniform(-0.1, 0.1)]
    return world


def _points(line: Any) -> ClosedLine:
    return ClosedLine([(float(x), float(y)) for x, y in line])


def _track(seed: int) -> World:
    return _jittered(_built_in("track"), seed)


def _judge_track(seed: int) -> Judge:
    return LapJudge(_points(_built_in("track")["paint"][0]["line"]), reach=0.5)


def _classroom(seed: int) -> World:
    world = _jittered(_built_in("classroom"), seed)
    world["robots"][0]["sensors"][0]["noise"] = 0.01
    return world


def _judge_classroom(seed: int) -> Judge:
    return WallJudge(_points(_built_in("classroom")["walls"][0]["polyline"]), nearest=0.3, farthest=0.8)


def _maze(seed: int) -> World:
    maze = make_maze(seed)
    corners = [[0, 0], [SIZE, 0], [SIZE, SIZE], [0, SIZE]]
    inner = [{"polyline": [list(begin), list(end)]} for begin, end in maze.walls()]
    heading = 0.0 if (1, 0) in maze.doors[0, 0] else 1.5708
    lidar = {"lidar": "scan", "noise": 0.01}
    return {
        "world": {"name": "maze", "size": [SIZE, SIZE]},
        "walls": [{"polyline": corners, "closed": True}, *inner],
        "robots": [{"name": "robot", "pose": [0.5, 0.5, heading], "shape": {"circle": 0.15}, "sensors": [lidar]}],
    }


def _judge_maze(seed: int) -> Judge:
    return MazeJudge(make_maze(seed), reach=0.35)


RACES = {
    race.name: race
    for race in (
        Race(
            "line",
            "s",
            True,
            180.0,
            _track,
            _judge_track,
        ),
        Race(
            "maze",
            "s",
            True,
            300.0,
            _maze,
            _judge_maze,
        ),
        Race(
            "follow",
            "m",
            False,
            120.0,
            _classroom,
            _judge_classroom,
        ),
    )
}
