"""Mazes: each seed has one, in which every cell is reached in exactly one way."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.race.courses import GOAL, SIZE, START, Maze, make_maze
from robolink.race.races import PENALTY, LapJudge, MazeJudge, WallJudge
from tests.race.test_closed_line import SQUARE


@given(st.integers(0, 2**32 - 1))
def test_every_maze_is_a_tree(seed: int) -> None:
    maze = make_maze(seed)
    assert len(maze.steps_to_goal()) == SIZE * SIZE
    assert sum(map(len, maze.doors.values())) == 2 * (SIZE * SIZE - 1)
    assert len(maze.walls()) == 2 * SIZE * (SIZE - 1) - (SIZE * SIZE - 1)
    assert all(cell in maze.doors[other] for cell, open_to in maze.doors.items() for other in open_to)


def test_a_seed_has_one_maze_and_another_seed_another() -> None:
    assert make_maze(7) == make_maze(7)
    assert make_maze(7) != make_maze(8)


def drive_to_goal(judge: MazeJudge, maze: Maze) -> None:
    """Let a judge see a robot at the border of the last cell, after all those on the way."""
    steps, (x, y) = maze.steps_to_goal(), START
    while steps[x, y]:
        judge.see(2.9, x + 0.5, y + 0.5, 0)
        x, y = min(maze.doors[x, y], key=lambda cell: steps[cell])
    judge.see(2.9, x + 0.01, y + 0.01, 0)


def test_a_maze_s_judge() -> None:
    maze = make_maze(3)
    judge = MazeJudge(maze, 0.35)
    assert judge.progress == 0.0
    judge.see(1.0, START[0] + 0.5, START[1] + 0.5, 0)
    assert (judge.progress, judge.score(), judge.is_over) == (0.0, None, False)
    (door, *_) = maze.doors[START]
    judge.see(2.0, door[0] + 0.5, door[1] + 0.5, 0)
    assert judge.progress > 0.0
    judge.see(2.5, GOAL[0] + 0.5, GOAL[1] + 0.5, 0)
    assert judge.progress < 1.0, "it was teleported"
    drive_to_goal(judge, maze)
    judge.see(3.0, GOAL[0] + 0.5, GOAL[1] + 0.3, 2)
    assert (judge.progress, judge.score(), judge.is_over) == (1.0, 3.0 + 2 * PENALTY, True)
    judge.see(4.0, GOAL[0] + 0.5, GOAL[1] + 0.5, 2)
    assert judge.score() == 3.0 + 2 * PENALTY


def test_a_robot_outside_of_the_maze_gains_nothing() -> None:
    judge = MazeJudge(make_maze(3), 0.35)
    judge.see(1.0, -5.0, 1e9, 0)
    assert judge.progress == 0.0


def test_a_lap_s_judge_knows_when_the_line_was_crossed() -> None:
    judge = LapJudge(SQUARE, 0.5)
    for time in range(17):
        x, y = _on_square(float(time))
        assert judge.score() is None
        judge.see(float(time), x, y, 1)
    assert judge.score() == pytest.approx(16.0 + PENALTY)
    assert judge.progress == 1.0


def test_a_lap_that_ends_between_two_looks() -> None:
    judge = LapJudge(SQUARE, 0.5)
    for step in range(161):
        judge.see(0.1 * step, *_on_square(0.1 * step * 0.95), 0)
    assert judge.score() is None
    for step in range(161, 180):
        judge.see(0.1 * step, *_on_square(0.1 * step * 0.95), 0)
    assert judge.score() == pytest.approx(16.0 / 0.95, abs=1e-6)


def test_a_wall_s_judge() -> None:
    judge = WallJudge(SQUARE, 0.3, 0.8)
    for step in range(21):
        judge.see(0.1 * step, 1.0 + 0.1 * step, 0.5, 0)
    assert judge.score() == pytest.approx(2.0)
    judge.see(3.0, 3.0, 0.5, 1)
    assert judge.score() == pytest.approx(2.0 - PENALTY)


def _on_square(metres: float) -> tuple[float, float]:
    side, along = divmod(metres % 16.0, 4.0)
    return [(along, 0.0), (4.0, along), (4.0 - along, 4.0), (0.0, 4.0 - along)][int(side)]
