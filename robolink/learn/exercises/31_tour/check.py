"""Check of a program that sends a robot to places: the check is what finds the way, and one place cannot be reached."""

from __future__ import annotations

from robolink.action import ActionServer, CancelResponse
from robolink.action.server import ServerGoalHandle
from robolink.interfaces.nav2_msgs.action import NavigateToPose
from robolink.learn.trial import Trial
from robolink.node import Node
from robolink.task import Future

SECONDS = 3.0
"""Seconds that a way takes."""

CLOSED = 1
"""Number of the goal that cannot be reached."""


class Navigation(Node):
    """Server of navigate_to_pose: each way takes some seconds, and one ends before its goal."""

    def __init__(self) -> None:
        super().__init__("bt_navigator")
        self.goals: list[NavigateToPose.Goal] = []
        self.under_way = self.at_once = 0
        """Ways that are driven now, and most of them at one time."""
        self.server = ActionServer(self, NavigateToPose, "navigate_to_pose", self.on_execute)
        self.server.register_cancel_callback(lambda _: CancelResponse.ACCEPT)

    async def on_execute(self, handle: ServerGoalHandle) -> NavigateToPose.Result:
        """Let the time of a way pass, and end it."""
        number = len(self.goals)
        self.goals.append(handle.request)
        self.under_way += 1
        self.at_once = max(self.at_once, self.under_way)
        await self.passed()
        self.under_way -= 1
        if handle.is_cancel_requested:
            handle.canceled()
        elif number == CLOSED:
            handle.abort()
            return NavigateToPose.Result(error_code=208, error_msg="no way leads there")
        else:
            handle.succeed()
        return NavigateToPose.Result()

    def passed(self) -> Future[None]:
        """Return a future that is done after the time of a way."""
        future: Future[None] = Future()

        def end() -> None:
            timer.destroy()
            future.set_result(None)

        timer = self.create_timer(SECONDS, end)
        return future

    def place(self, number: int) -> tuple[float, float] | None:
        """Return the place of a goal, None if it has not come."""
        if number >= len(self.goals):
            return None
        place = self.goals[number].pose.pose.position
        return round(place.x, 2), round(place.y, 2)


def check(trial: Trial) -> None:
    """Let the program send the robot around."""
    navigation = trial.system.start(Navigation)
    trial.start()
    trial.run(2.0)
    trial.tell("goes", navigation.goals)
    frame = navigation.goals[0].pose.header.frame_id
    trial.tell("frame", frame == "map", frame=frame)
    trial.tell("waits", navigation.at_once == 1)
    trial.run(3.0)
    trial.tell("order", navigation.place(1) == (5.0, 3.0), place=shown(navigation.place(1)))
    trial.run(3.0)
    trial.tell("goes_on", navigation.place(2) == (1.0, 4.0), place=shown(navigation.place(2)))
    trial.run(3.0)
    said = [each.message for each in trial.system.logs if "reached" in each.message]
    trial.tell("counts", any("reached 2 of 3" in each for each in said), said=said[-1] if said else "-")


def shown(place: tuple[float, float] | None) -> str:
    """Return a place as a text; '-' for none."""
    return "-" if place is None else f"({place[0]:.1f}, {place[1]:.1f})"
