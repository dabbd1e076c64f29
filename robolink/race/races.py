"""The races: line, maze and follow, each with its world for a seed, its length and its judge."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any, NamedTuple

from robolink.documents.yamlfile import parse, spell
from robolink.race.closed_line import ClosedLine
from robolink.race.judges import Judge, LapJudge, MazeJudge, WallJudge
from robolink.race.maze import SIZE, make_maze
from robolink.workspace import built_in_workspace

World = dict[str, Any]


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
