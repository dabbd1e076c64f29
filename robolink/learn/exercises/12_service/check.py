"""Check of a service that starts and stops a robot."""

from __future__ import annotations

from typing import Any

from robolink.learn.trial import Trial
from robolink.testing.expectations import ExpectationError, NodeFailure


def check(trial: Trial) -> None:
    """Call it with True, and with False."""
    trial.start()
    first = trial.heard("cmd_vel", within=1.0)
    trial.tell("begins", first is not None and first.linear.x == 0.0, speed=first.linear.x if first else 0.0)
    answer = called(trial, on=True)
    trial.tell("answers", answer is not None)
    trial.tell("success", answer.success)
    trial.tell("starts", abs(speed(trial) - 0.2) < 1e-6, speed=speed(trial))
    called(trial, on=False)
    trial.tell("stops", speed(trial) == 0.0, speed=speed(trial))


def called(trial: Trial, *, on: bool) -> Any:
    """Call the service; return its answer, None if there is none."""
    from robolink.interfaces.std_srvs.srv import SetBool

    try:
        return trial.system.call(SetBool, "power", SetBool.Request(data=on), within=2.0)
    except NodeFailure as error:
        if isinstance(error.__cause__, TypeError) and "must return" in str(error.__cause__):
            return None
        raise
    except ExpectationError:
        return None


def speed(trial: Trial) -> float:
    """Return the speed that is asked for next, in m/s."""
    trial.run(0.2)
    heard = trial.heard("cmd_vel", within=1.0)
    return -1.0 if heard is None else float(heard.linear.x)
