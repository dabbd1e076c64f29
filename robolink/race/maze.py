"""Mazes: one for each seed, with one way between any two cells (a spanning tree, by depth-first search)."""

from __future__ import annotations

import random
from collections import deque
from typing import NamedTuple

Cell = tuple[int, int]

SIZE = 6
"""Cells along each side; a cell is a square of 1 m."""

START: Cell = (0, 0)
GOAL: Cell = (SIZE - 1, SIZE - 1)

_SIDES = ((1, 0), (0, 1), (-1, 0), (0, -1))


class Maze(NamedTuple):
    """A maze: which cells are open to each other."""

    doors: dict[Cell, frozenset[Cell]]

    def walls(self) -> list[tuple[Cell, Cell]]:
        """Return the inner walls, each from one corner of cells to the next, in metres."""
        found = []
        for x in range(SIZE):
            for y in range(SIZE):
                if x + 1 < SIZE and (x + 1, y) not in self.doors[x, y]:
                    found.append(((x + 1, y), (x + 1, y + 1)))
                if y + 1 < SIZE and (x, y + 1) not in self.doors[x, y]:
                    found.append(((x, y + 1), (x + 1, y + 1)))
        return found

    def steps_to_goal(self) -> dict[Cell, int]:
        """Return for each cell how many cells the goal is away."""
        steps, waiting = {GOAL: 0}, deque([GOAL])
        while waiting:
            cell = waiting.popleft()
            for each in self.doors[cell]:
                if each not in steps:
                    steps[each] = steps[cell] + 1
                    waiting.append(each)
        return steps


def make_maze(seed: int) -> Maze:
    """Return the maze of a seed."""
    chance = random.Random(seed)
    doors: dict[Cell, set[Cell]] = {(x, y): set() for x in range(SIZE) for y in range(SIZE)}
    way = [START]
    seen = {START}
    while way:
        x, y = way[-1]
        beside = [(x + dx, y + dy) for dx, dy in _SIDES]
        new = [each for each in beside if each in doors and each not in seen]
        if not new:
            way.pop()
            continue
        chosen = chance.choice(new)
        doors[x, y].add(chosen)
        doors[chosen].add((x, y))
        seen.add(chosen)
        way.append(chosen)
    return Maze({cell: frozenset(open_to) for cell, open_to in doors.items()})
