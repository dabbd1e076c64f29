"""Check of a callback that refuses values of a parameter."""

from __future__ import annotations

import warnings

from robolink import Node
from robolink.learn.trial import Trial
from robolink.parameter import Parameter
from robolink.parameters.rules import INVALID_RESULT


def check(trial: Trial) -> None:
    """Set good and bad values."""
    node = trial.start()
    trial.run(0.5)
    trial.tell("there", isinstance(node, Node) and node.has_parameter("speed"))

    def reason(value: float) -> str | None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a result of another type: the report tells it
            result = node.set_parameters([Parameter("speed", value=value)])[0]
        if result.reason == INVALID_RESULT:
            trial.tell("returns", False)
        return None if result.successful else str(result.reason)

    for value, name in ((1.0, "most"), (0.0, "least"), (0.5, "accepts")):
        refused = reason(value)
        trial.tell("returns", True) if name == "most" else None
        trial.tell(name, refused is None, reason=f": {refused}" if refused else "")
    fast = reason(3.0)
    trial.tell("fast", fast is not None)
    trial.tell("back", reason(-0.2) is not None)
    trial.tell("reason", fast, reason=fast)
    speed = node.get_parameter("speed").value
    trial.tell("keeps", speed == 0.5, speed=speed)
