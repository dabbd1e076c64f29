"""Check of a parameter that is changed while a node runs."""

from __future__ import annotations

import warnings

from robolink import Node
from robolink.exceptions import InvalidParameterValueException
from robolink.learn.trial import Trial
from robolink.parameters.rules import INVALID_RESULT


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
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of a result of another type: the report tells it
        try:
            trial.system.set_parameter(node, "speed", 0.5)
        except InvalidParameterValueException as error:
            trial.tell("returns", INVALID_RESULT not in str(error))
            raise
    trial.run(0.3)
    trial.tell("obeys", abs(sent[-1].linear.x - 0.5) < 1e-6, speed=sent[-1].linear.x)
