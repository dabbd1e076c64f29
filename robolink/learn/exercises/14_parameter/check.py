"""Check of a parameter that is changed while a node runs."""

from __future__ import annotations

from robolink import Node
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Set the parameter, and compare the speeds."""
    node = trial.start()
    trial.run(1.0)
    trial.tell("there", isinstance(node, Node) and node.has_parameter("speed"))
    sent = trial.system.messages("cmd_vel")
    trial.run(1.0)
    trial.tell("publishes", sent)
    trial.tell("pace", 8 <= len(sent) <= 12, count=len(sent))
    trial.tell("first", abs(sent[-1].linear.x - 0.3) < 1e-6, speed=sent[-1].linear.x)
    try:
        trial.system.set_parameter(node, "speed", 0.5)
    except TypeError as error:  # what robolink says if a callback returns something else
        trial.tell("returns", "must return" not in str(error))
        raise
    trial.run(0.3)
    trial.tell("obeys", abs(sent[-1].linear.x - 0.5) < 1e-6, speed=sent[-1].linear.x)
