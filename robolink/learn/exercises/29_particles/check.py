"""Check of a particle filter's three functions: each by itself, then along a corridor with doors."""

from __future__ import annotations

import random
from statistics import fmean, pstdev
from types import ModuleType

from robolink.learn.trial import Trial

DOORS = (1.0, 2.5, 6.0)
NEAR = 0.3
"""Metres from a door at which the robot sees it."""

BEGIN, STEP, STEPS = 1.5, 0.25, 24
"""Metres where the robot begins, metres of a step, and how many it drives."""

WRONG = (5, 15)
"""Steps after which it sees wrongly."""


def check(trial: Trial) -> None:
    """Try each function by itself, then let the particles find a robot."""
    module = trial.module()
    random.seed(33)
    moved = module.move([2.0] * 1000, 0.5)
    trial.tell("moves", abs(fmean(moved) - 2.5) < 0.02, mean=fmean(moved))
    trial.tell("spreads", 0.02 < pstdev(moved) < 0.1, spread=pstdev(moved))
    weights = {sees: module.weigh([2.5, 4.0], sees) for sees in (True, False)}
    trial.tell("each", all(len(each) == 2 for each in weights.values()), count=len(weights[True]))
    for name, sees in (("door", True), ("wall", False)):
        beside, away = weights[sees]
        trial.tell(name, beside > away if sees else away > beside, beside=beside, away=away)
    least = min(min(each) for each in weights.values())
    trial.tell("never", least > 0.0, least=least)
    drawn = module.resample([1.0, 7.0] * 500, [1.0, 3.0] * 500)
    trial.tell("count", len(drawn) == 1000, count=len(drawn))
    share = 100.0 * fmean(each == 7.0 for each in drawn)
    trial.tell("draws", 70.0 < share < 80.0, share=share)
    mean = fmean(found(module))
    trial.tell("finds", abs(mean - BEGIN - STEP * STEPS) < NEAR, mean=mean, error=abs(mean - BEGIN - STEP * STEPS))


def found(module: ModuleType) -> list[float]:
    """Return the particles after a robot has driven through the corridor, which are everywhere at first."""
    particles = [random.uniform(0.0, 10.0) for _ in range(1000)]
    for step in range(1, STEPS + 1):
        place = BEGIN + step * STEP
        sees = any(abs(place - door) < NEAR for door in DOORS) != (step in WRONG)
        particles = module.move(particles, STEP)
        particles = module.resample(particles, module.weigh(particles, sees))
    return list(particles)
