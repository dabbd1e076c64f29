"""Check of a parameter that is changed while a node runs."""

from __future__ import annotations

from robolink import Node
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Set the parameter, and compare the speeds."""
    node = trial.start()
    trial.run(1.0)
    trial.tell("there", isinstance(node, Node) and node.has_parameter("speed"))
    trial.tell("first", abs(speed(trial) - 0.3) < 1e-6, speed=speed(trial))
    trial.system.set_parameter(node, "speed", 0.5)
    trial.run(0.3)
    trial.tell("obeys", abs(speed(trial) - 0.5) < 1e-6, speed=speed(trial))


def speed(trial: Trial) -> float:
    """Return the speed that is asked for next, in m/s; -1 for none."""
    heard = trial.heard("cmd_vel", within=1.0)
    return -1.0 if heard is None else float(heard.linear.x)
