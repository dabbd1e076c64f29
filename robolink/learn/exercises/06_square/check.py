"""Check of a robot that drives a square by time."""

from __future__ import annotations

import math

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Let it drive for twenty seconds, and look at the box in which it was."""
    robot = trial.world("empty_room")
    begin = robot.pose
    trial.start()
    trial.run(20.0)
    area = robot.area
    trial.tell("drives", robot.driven > 0.5, metres=robot.driven)
    trial.tell("free", robot.contacts == 0)
    good = 0.85 < area.width < 1.2 and 0.85 < area.height < 1.2
    trial.tell("sides", good, width=area.width, height=area.height)
    still = abs(robot.twist.v) < 0.01 and abs(robot.twist.w) < 0.01
    trial.tell("stands", still, speed=robot.twist.v, turn=robot.twist.w)
    away = math.dist((robot.pose.x, robot.pose.y), (begin.x, begin.y))
    trial.tell("back", away < 0.25, metres=away)
