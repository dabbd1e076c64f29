"""Check of a publisher: its messages, their rate, and how far a robot drives by them."""

from __future__ import annotations

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Look at cmd_vel, then at the robot."""
    robot = trial.world("empty_room")
    trial.start()
    twist = trial.heard("cmd_vel", within=3.0)
    trial.tell("says", twist is not None, topics=trial.published)
    trial.tell("speed", abs(twist.linear.x - 0.3) < 1e-6, speed=twist.linear.x)
    sent = trial.system.messages("cmd_vel")
    trial.run(2.0)
    trial.tell("often", 19 <= len(sent) <= 21, count=len(sent))
    before = robot.driven
    trial.run(5.9)
    driven = robot.driven - before + 0.6
    trial.tell("drives", 2.1 < driven < 2.7, metres=driven)
