"""Check of a robot that stops before a wall, four metres ahead of it; walls beside it are nearer than it may come."""

from __future__ import annotations

from robolink.learn.trial import Trial

WALL = 5.0


def check(trial: Trial) -> None:
    """Let it drive for twenty seconds."""
    robot = trial.world("corridor.yaml")
    trial.start()
    trial.run(3.0)
    trial.tell("drives", robot.driven > 0.6, metres=robot.driven)
    trial.run(17.0)
    trial.tell("stops", robot.contacts == 0, metres=robot.driven)
    left = WALL - robot.pose.x
    trial.tell("near", 0.5 < left < 0.75, metres=left)
