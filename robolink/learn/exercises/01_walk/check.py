"""Check of a class and a function: single steps, then a square."""

from __future__ import annotations

import math

from robolink.learn.trial import Trial

NEAR = 0.005
"""Metres: 3.14 for pi is good enough."""


def check(trial: Trial) -> None:
    """Take steps, and compare positions."""
    module = trial.module()
    for direction, name, end in ((0, "ahead", (0.3, 0.0)), (90, "left", (0.0, 0.3))):
        walk = module.Walk()
        walk.step(direction)
        trial.tell(name, math.dist((walk.x, walk.y), end) < NEAR, x=walk.x, y=walk.y)
    walk = module.Walk()
    module.square(walk)
    trial.tell("steps", len(walk.history) == 21, count=len(walk.history) - 1)
    xs, ys = zip(*walk.history, strict=True)
    width, height = max(xs) - min(xs), max(ys) - min(ys)
    trial.tell("sides", abs(width - 1.5) < NEAR and abs(height - 1.5) < NEAR, width=width, height=height)
    away = math.hypot(walk.x, walk.y)
    trial.tell("back", away < NEAR, metres=away)
