"""Check of a robot that drives two metres by its odometry."""

from __future__ import annotations

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Let it drive for some seconds."""
    robot = trial.world("empty_room")
    trial.start()
    trial.run(3.0)
    trial.tell("drives", robot.driven > 0.5, metres=robot.driven)
    trial.run(3.5)
    trial.tell("stops", abs(robot.twist.v) < 0.01, metres=robot.driven, speed=robot.twist.v)
    trial.tell("exact", abs(robot.driven - 2.0) < 0.08, metres=robot.driven)
