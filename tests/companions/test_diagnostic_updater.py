"""diagnostic_updater: its tasks, alone and on a node in virtual time."""

from __future__ import annotations

from typing import Any

import pytest

from robolink.companions.diagnostic_updater import (
    CompositeDiagnosticTask,
    DiagnosedPublisher,
    DiagnosticStatusWrapper,
    DiagnosticTask,
    FrequencyStatusParam,
    FunctionDiagnosticTask,
    HeaderlessTopicDiagnostic,
    Heartbeat,
    TimeStampStatus,
    TimeStampStatusParam,
    Updater,
)
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.node import Node
from robolink.testing import System

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR


def values(status: DiagnosticStatus) -> dict[str, str]:
    return {each.key: each.value for each in status.values}


@pytest.mark.parametrize(
    ("before", "other", "after"),
    [
        ((OK, "a"), (OK, "b"), (OK, "a; b")),
        ((OK, ""), (OK, "b"), (OK, "b")),
        ((OK, "a"), (WARN, "b"), (WARN, "b")),
        ((WARN, "a"), (OK, "b"), (WARN, "a")),
        ((WARN, "a"), (ERROR, "b"), (ERROR, "a; b")),
        ((ERROR, "a"), (WARN, "b"), (ERROR, "a; b")),
    ],
)
def test_summaries_are_merged(before: tuple[bytes, str], other: tuple[bytes, str], after: tuple[bytes, str]) -> None:
    status = DiagnosticStatusWrapper()
    status.summary(*before)
    status.mergeSummary(*other)
    assert (status.level, status.message) == after
    copied = DiagnosticStatusWrapper()
    copied.summary(*before)
    copied.mergeSummary(DiagnosticStatus(level=other[0], message=other[1]))
    assert (copied.level, copied.message) == after
    copied.clearSummary()
    assert (copied.level, copied.message) == (OK, "")


def test_tasks_are_joined() -> None:
    def low(stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        stat.summary(WARN, "low")
        stat.add("a", "1")
        return stat

    both = CompositeDiagnosticTask("bounds")
    both.addTask(FunctionDiagnosticTask("low", low))
    both.addTask(Heartbeat())
    status = both.run(DiagnosticStatusWrapper())
    assert (both.getName(), status.level, status.message, values(status)) == ("bounds", WARN, "low", {"a": "1"})


class Robot(Node):
    """Node with an updater, which publishes on /ticks and /scan."""

    def __init__(self) -> None:
        super().__init__("robot")
        self.updater = Updater(self)
        self.updater.add("motor", self.fill)
        bounds = {"min": 9.0, "max": 11.0}
        self.ticks = HeaderlessTopicDiagnostic("ticks", self.updater, FrequencyStatusParam(bounds, 0.1, 3))
        publisher = self.create_publisher(LaserScan, "scan", 10)
        self.scan = DiagnosedPublisher(
            publisher, self.updater, FrequencyStatusParam({"min": 5.0}), TimeStampStatusParam(-0.5, 0.5)
        )
        self.age = 0.0
        self.ticking = self.create_timer(0.1, self.tick)

    def fill(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        stat.summary(OK, "turns")
        stat.add("speed", "3.0")
        return stat

    def tick(self) -> None:
        self.ticks.tick()
        scan = LaserScan()
        scan.header.stamp.sec, scan.header.stamp.nanosec = divmod(
            self.get_clock().now().nanoseconds - int(self.age * 1e9), 10**9
        )
        self.scan.publish(scan)


def parts(array: DiagnosticArray) -> dict[str, tuple[bytes, str]]:
    return {each.name: (each.level, each.message) for each in array.status}


def whole(array: DiagnosticArray) -> bool:
    return len(array.status) == 3


def test_a_node_publishes_its_diagnostics(system: System) -> None:
    heard: list[DiagnosticArray] = []
    system.node.create_subscription(DiagnosticArray, "/diagnostics", heard.append, 10)
    robot = system.start(Robot)
    assert isinstance(robot, Robot)
    system.run(4.5)
    assert [parts(each) for each in heard[:3]] == [
        {f"robot: {name}": (OK, "Node starting up")} for name in ("motor", "ticks topic status", "/scan topic status")
    ]
    last = heard[-1]
    met = "Desired frequency met"
    assert parts(last) == {
        "robot: motor": (OK, "turns"),
        "robot: ticks topic status": (OK, met),
        "robot: /scan topic status": (OK, f"{met}; Timestamps are reasonable."),
    }
    assert values(last.status[0]) == {"speed": "3.0"}
    assert values(last.status[1]) == {
        "Events in window": "30", "Events since startup": "39", "Duration of window (s)": "3.000000",
        "Actual frequency (Hz)": "10.000000", "Minimum acceptable frequency (Hz)": "8.100000",
        "Maximum acceptable frequency (Hz)": "12.100000",
    }  # fmt: skip
    assert [each for each in system.logs if "hardware id" in each.message]


def test_what_goes_wrong_is_told(system: System) -> None:
    robot = system.start(Robot)
    assert isinstance(robot, Robot)
    robot.updater.setHardwareID("none")
    system.run(3.0)
    robot.age = 2.0
    told = system.expect("/diagnostics", lambda array: whole(array) and array.status[2].level == ERROR, within=3.0)
    assert told.status[2].message == "Timestamps too far in past seen."
    assert (values(told.status[2])["Late diagnostic update count:"], told.status[2].hardware_id) == ("1", "none")
    robot.age = -2.0
    future = "Timestamps too far in future seen."
    system.expect("/diagnostics", lambda array: whole(array) and array.status[2].message == future, within=3.0)
    robot.ticking.timer_period_ns = 10**9
    low = "Frequency too low."
    system.expect("/diagnostics", lambda array: whole(array) and array.status[1].message == low, within=9.0)
    robot.ticking.cancel()
    none = (ERROR, "No events recorded.")
    system.expect("/diagnostics", lambda array: parts(array).get("robot: ticks topic status") == none, within=9.0)
    robot.ticks.clear_window()
    for _ in range(99):
        robot.ticks.tick()
    high = "Frequency too high."
    system.expect("/diagnostics", lambda array: whole(array) and array.status[1].message == high, within=3.0)
    assert robot.updater.removeByName("motor")
    assert not robot.updater.removeByName("motor")
    robot.updater.broadcast(WARN, "stops")
    system.expect("/diagnostics", lambda array: [each.message for each in array.status] == ["stops"] * 2)


def test_the_period_is_a_parameter(system: System) -> None:
    robot = system.start(Robot, parameters={"diagnostic_updater.period": 0.25, "diagnostic_updater.use_fqn": True})
    assert isinstance(robot, Robot)
    heard: list[Any] = []
    system.node.create_subscription(DiagnosticArray, "/diagnostics", heard.append, 10)
    system.run(1.1)
    assert (robot.updater.period, len(heard)) == (0.25, 4)
    assert heard[0].status[0].name == "//robot: motor"  # as in ROS 2
    robot.updater.period = 0.5
    system.run(1.1)
    assert len(heard) == 6


def test_a_task_must_return_the_status(system: System) -> None:
    class Silent(DiagnosticTask):
        def run(self, stat: DiagnosticStatusWrapper) -> Any:
            return None

    updater = Updater(system.node)
    updater.add(Silent("silent"))
    with pytest.raises(TypeError, match="the diagnostic task 'silent' returned NoneType: it must return the status"):
        updater.force_update()


def test_stamps_that_are_zero_or_missing() -> None:
    watched = TimeStampStatus()
    status = watched.run(DiagnosticStatusWrapper())
    assert (status.level, status.message) == (WARN, "No data since last update.")
    watched.tick(0.0)
    watched.tick(watched._clock.now())
    status = watched.run(DiagnosticStatusWrapper())
    assert (status.level, status.message) == (ERROR, "Zero timestamp seen.")
    assert values(status)["Zero seen diagnostic update count:"] == "1"
