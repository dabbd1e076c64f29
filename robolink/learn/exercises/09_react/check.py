"""Check of reactive control: a minute in the classroom."""

from __future__ import annotations

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Let it drive, and look for contacts."""
    robot = trial.world("classroom")
    trial.start()
    trial.run(4.0)
    trial.tell("drives", robot.driven > 0.8, metres=robot.driven)
    trial.run(56.0)
    trial.tell("free", robot.contacts == 0, metres=robot.driven)
    trial.tell("roams", robot.driven > 6.0, metres=robot.driven)
