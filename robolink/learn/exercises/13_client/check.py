"""Check of a client, with a service of the check's own."""

from __future__ import annotations

from typing import Any

from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.learn.trial import Trial


def check(trial: Trial) -> None:
    """Serve additions, and look for the sum in the log."""
    asked: list[Any] = []
    early: list[str] = []

    def add(request: Any, response: Any) -> Any:
        asked.append(request)
        early.extend(each.message for each in trial.system.logs if "sum is 5" in each.message)
        response.sum = request.a + request.b
        return response

    trial.system.node.create_service(AddTwoInts, "add_two_ints", add)
    trial.start()
    trial.run(3.0)
    trial.tell("asks", asked)
    a, b = asked[0].a, asked[0].b
    trial.tell("numbers", {a, b} == {2, 3}, a=a, b=b)
    trial.tell("waits", not early)
    trial.tell("says", any("sum is 5" in each.message for each in trial.system.logs))
