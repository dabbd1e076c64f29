"""Check of a service that starts and stops a robot."""

from __future__ import annotations

import contextlib
from typing import Any

from robolink.learn.trial import Reported, Trial
from robolink.testing.expectations import ExpectationError, NodeFailure

SET_BOOL = "std_srvs/srv/SetBool"


def check(trial: Trial) -> None:
    """Call it with True, and with False."""
    trial.start()
    first = trial.heard("cmd_vel", within=1.0)
    trial.tell("publishes", first is not None)
    trial.tell("begins", first.linear.x == 0.0, speed=first.linear.x)
    services = trial.system.services
    trial.tell("serves", "/power" in services, services=", ".join(each.strip("/") for each in services) or "-")
    trial.tell("type", services["/power"] == SET_BOOL, type=services["/power"])
    for on, name, asked in ((True, "starts", 0.2), (False, "stops", 0.0)):
        answer = called(trial, on=on)
        trial.tell("answers", answer is not None, data=on)
        trial.tell("success", answer.success, data=on)
        pace = speed(trial)
        trial.tell(name, abs(pace - asked) < 1e-6, speed=pace)


def called(trial: Trial, *, on: bool) -> Any:
    """Call the service; return its answer, None if there is none."""
    from robolink.interfaces.std_srvs.srv import SetBool

    try:
        return trial.system.call(SetBool, "power", SetBool.Request(data=on), within=2.0)
    except NodeFailure as error:
        if "must return" in str(error.__cause__):
            with contextlib.suppress(Reported):
                trial.tell("answers", False, data=on)
        raise
    except ExpectationError:
        return None


def speed(trial: Trial) -> float:
    """Return the speed that is asked for next, in m/s."""
    trial.run(0.2)
    heard = trial.heard("cmd_vel", within=1.0)
    return -1.0 if heard is None else float(heard.linear.x)
