"""Check of a publisher: its messages, their rate, and how far a robot drives by them."""

from __future__ import annotations

from collections.abc import Sequence

from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Look at cmd_vel, then at the robot."""
    robot = trial.world("empty_room")
    trial.start()
    twist = trial.heard("cmd_vel", within=3.0)
    trial.tell("says", "cmd_vel" in trial.published.split(", "), topics=trial.published)
    trial.tell("sends", twist is not None)
    trial.tell("speed", abs(twist.linear.x - 0.3) < 1e-6, speed=twist.linear.x)
    sent = trial.system.messages("cmd_vel")
    most = max(in_a_tenth(trial, sent) for _ in range(20))
    trial.tell("often", 19 <= len(sent) <= 21, count=len(sent))
    trial.tell("apart", most <= 2, count=most)
    before = robot.driven
    trial.run(5.9)
    driven = robot.driven - before + 0.6
    trial.tell("drives", 2.1 < driven < 2.7, metres=driven)


def in_a_tenth(trial: Trial, sent: Sequence[object]) -> int:
    """Let a tenth of a second pass; return how many messages came in it."""
    before = len(sent)
    trial.run(0.1)
    return len(sent) - before
