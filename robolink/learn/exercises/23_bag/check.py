"""Check of a function that reads a bag, with two bags of a simulated robot."""

from __future__ import annotations

import tempfile
from pathlib import Path

from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Record a robot that drives ahead, then one that drives in a circle."""
    robot = trial.world("empty_room")
    with tempfile.TemporaryDirectory(prefix="robolink-learn-", ignore_cleanup_errors=True) as folder:
        for name, turn, steps in (("way", 0.0, 25), ("circle", 1.0, 15)):
            before = robot.driven
            bag = Path(folder, name)
            with trial.system.record(bag, ["/odom"]):
                for _ in range(steps):
                    twist = Twist()
                    twist.linear.x, twist.angular.z = 0.4, turn
                    trial.system.publish("cmd_vel", twist)
                    trial.run(0.2)
            value = trial.module().driven(str(bag))
            trial.tell("number", isinstance(value, (int, float)), value=value) if name == "way" else None
            metres = robot.driven - before
            trial.tell(name, abs(value - metres) < 0.1, metres=metres, value=value)
