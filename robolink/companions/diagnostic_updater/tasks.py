"""Diagnostic tasks: each fills out the state of one part of the robot."""

from __future__ import annotations

from collections.abc import Callable

from robolink.companions.diagnostic_updater.status import DiagnosticStatusWrapper
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticStatus


class DiagnosticTask:
    """Base class of tasks; subclasses override `run`.

    Args:
        name: Name of the part.
    """

    def __init__(self, name: str) -> None:
        self.name = name

    def getName(self) -> str:  # noqa: N802 - ROS 2's name
        """Return the name of the part."""
        return self.name

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill out `stat` and return it."""
        return stat


class FunctionDiagnosticTask(DiagnosticTask):
    """Task of a function.

    Args:
        name: Name of the part.
        fn: Function that fills out a status and returns it.
    """

    def __init__(self, name: str, fn: Callable[[DiagnosticStatusWrapper], DiagnosticStatusWrapper]) -> None:
        super().__init__(name)
        self.fn = fn

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Return what the function makes of `stat`."""
        return self.fn(stat)


class CompositeDiagnosticTask(DiagnosticTask):
    """Several tasks with one status: their values one behind the other, their summaries merged.

    Args:
        name: Name of the part.
    """

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.tasks: list[DiagnosticTask] = []

    def addTask(self, t: DiagnosticTask) -> None:  # noqa: N802 - ROS 2's name
        """Add a task, `t`."""
        self.tasks.append(t)

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Let each task fill out `stat`, and return it with what they say together."""
        before, together = DiagnosticStatusWrapper(), DiagnosticStatusWrapper()
        before.summary(stat)
        for each in self.tasks:
            stat.summary(before)
            stat = each.run(stat)
            together.mergeSummary(stat)
        stat.summary(together)
        return stat


class Heartbeat(DiagnosticTask):
    """Task that says that the node is alive."""

    def __init__(self) -> None:
        super().__init__("Heartbeat")

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill out `stat` and return it."""
        stat.summary(DiagnosticStatus.OK, "Alive")
        return stat
