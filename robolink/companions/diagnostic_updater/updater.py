"""Updater of diagnostics: it runs its tasks by a timer and publishes what they say."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from robolink.companions.diagnostic_updater.status import DiagnosticStatusWrapper
from robolink.companions.diagnostic_updater.tasks import DiagnosticTask, FunctionDiagnosticTask
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from robolink.node import Node

Fill = Callable[[DiagnosticStatusWrapper], DiagnosticStatusWrapper]
PERIOD, FULL_NAME = "diagnostic_updater.period", "diagnostic_updater.use_fqn"
"""Parameters of the node: the period in s, and whether its full name stands before that of a part."""


class DiagnosticTaskVector:
    """Several tasks."""

    def __init__(self) -> None:
        self.tasks: list[DiagnosticTask] = []
        self.lock = threading.Lock()

    def addedTaskCallback(self, task: DiagnosticTask) -> None:  # noqa: N802 - ROS 2's name
        """Do nothing: subclasses may act when a `task` was added."""

    def add(self, *args: Any) -> None:
        """Add a task.

        Args:
            *args: The task, or the name of a part and a function that fills out its status.
        """
        task = args[0] if len(args) == 1 else FunctionDiagnosticTask(*args)
        with self.lock:
            self.tasks.append(task)
            self.addedTaskCallback(task)

    def removeByName(self, name: str) -> bool:  # noqa: N802 - ROS 2's name
        """Remove the first task for the part `name`; return whether there was one."""
        with self.lock:
            found = next((each for each in self.tasks if each.getName() == name), None)
            if found is not None:
                self.tasks.remove(found)
        return found is not None


class Updater(DiagnosticTaskVector):
    """Tasks of a node, which are run once in a period, and their results published on `/diagnostics`.

    Args:
        node: The node, which must be spun.
        period: Period in seconds, unless the node's parameter `diagnostic_updater.period` is set.
    """

    def __init__(self, node: Node, period: float = 1.0) -> None:
        super().__init__()
        self.node, self.verbose, self.hwid = node, False, ""
        self.publisher = node.create_publisher(DiagnosticArray, "/diagnostics", 1)
        self._period = float(_parameter(node, PERIOD, period))
        self.timer = node.create_timer(self._period, self.update)
        self.node_name = node.get_name()
        if _parameter(node, FULL_NAME, False):
            self.node_name = f"{node.get_namespace()}/{node.get_name()}"
        self._has_warned = False

    @property
    def period(self) -> float:
        """Period in seconds; it can be set."""
        return self._period

    @period.setter
    def period(self, period: float) -> None:
        self._period = period
        self.node.destroy_timer(self.timer)
        self.timer = self.node.create_timer(period, self.update)

    def setHardwareID(self, hwid: str) -> None:  # noqa: N802 - ROS 2's name
        """Set the hardware id of all statuses, `hwid`; "none" where there is none."""
        self.hwid = hwid

    def update(self) -> None:
        """Run all tasks and publish what they say."""
        with self.lock:
            found = [self._run(each) for each in self.tasks]
        if not self.hwid and not self._has_warned and all(each.level == DiagnosticStatus.OK for each in found):
            self._has_warned = True
            self.node.get_logger().warning('no hardware id is set: setHardwareID("none") says that there is none')
        self.publish(found)

    def force_update(self) -> None:
        """Run all tasks now, whatever the period."""
        self.update()

    def broadcast(self, lvl: bytes, msg: str) -> None:
        """Publish one level, `lvl`, and message, `msg`, for all tasks."""
        found = []
        for each in self.tasks:
            status = DiagnosticStatusWrapper(name=each.getName())
            status.summary(lvl, msg)
            found.append(status)
        self.publish(found)

    def publish(self, msg: DiagnosticStatus | list[Any]) -> None:
        """Publish a status or several, `msg`, with the node's name before theirs."""
        found: list[DiagnosticStatus] = msg if isinstance(msg, list) else [msg]
        array = DiagnosticArray()
        array.header.stamp = self.node.get_clock().now().to_msg()
        for each in found:
            each.name = f"{self.node_name}: {each.name}"
        fields = ("level", "name", "message", "hardware_id", "values")
        array.status = [DiagnosticStatus(**{name: getattr(each, name) for name in fields}) for each in found]
        self.publisher.publish(array)

    def addedTaskCallback(self, task: DiagnosticTask) -> None:  # noqa: N802 - ROS 2's name
        """Publish that the part of a new `task` starts up."""
        self.publish(DiagnosticStatusWrapper(name=task.getName(), message="Node starting up"))

    def _run(self, task: DiagnosticTask) -> DiagnosticStatus:
        empty = DiagnosticStatusWrapper(
            level=DiagnosticStatus.ERROR, name=task.getName(), message="No message was set", hardware_id=self.hwid
        )
        status: Any = task.run(empty)
        if not isinstance(status, DiagnosticStatus):
            kind = type(status).__name__
            raise TypeError(f"the diagnostic task '{task.getName()}' returned {kind}: it must return the status")
        if self.verbose and status.level != DiagnosticStatus.OK:
            level = int.from_bytes(status.level, "little")
            self.node.get_logger().warning(
                f"Non-zero diagnostic status. Name: {status.name}, status {level}: {status.message}"
            )
        return status


def _parameter(node: Node, name: str, default: float | bool) -> Any:
    """Return a parameter of the node, which is declared if it is not yet."""
    return node.get_parameter(name).value if node.has_parameter(name) else node.declare_parameter(name, default).value
