"""diagnostic_updater: tasks that tell the state of a robot's parts, which an updater publishes on /diagnostics."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, MutableMapping
from typing import Any

from robolink.clock import ROSClock
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from robolink.node import Node
from robolink.publisher import Publisher
from robolink.time import Time

__all__ = [
    "CompositeDiagnosticTask",
    "DiagnosedPublisher",
    "DiagnosticStatusWrapper",
    "DiagnosticTask",
    "DiagnosticTaskVector",
    "FrequencyStatus",
    "FrequencyStatusParam",
    "FunctionDiagnosticTask",
    "HeaderlessTopicDiagnostic",
    "Heartbeat",
    "TimeStampStatus",
    "TimeStampStatusParam",
    "TopicDiagnostic",
    "Updater",
]


class DiagnosticStatusWrapper(DiagnosticStatus):
    """DiagnosticStatus that is filled out step by step."""

    def summary(self, *args: Any) -> None:
        """Set level and message.

        Args:
            *args: A status, whose level and message are taken, or a level and a message.
        """
        level, message = _parts(args)
        self.level, self.message = level, str(message)

    def clearSummary(self) -> None:  # noqa: N802 - ROS 2's name
        """Set the level to OK and the message to nothing."""
        self.summary(DiagnosticStatus.OK, "")

    def mergeSummary(self, *args: Any) -> None:  # noqa: N802 - ROS 2's name
        """Join another level and message: the higher level counts.

        Of an OK and another level only the other's message stays; two of a kind are joined by a semicolon.

        Args:
            *args: A status, or a level and a message.
        """
        level, message = _parts(args)
        if (level > DiagnosticStatus.OK) == (self.level > DiagnosticStatus.OK):
            self.message = f"{self.message}; {message}" if self.message else str(message)
        elif level > self.level:
            self.message = str(message)
        self.level = max(self.level, level)

    def add(self, key: str, val: str) -> None:
        """Add a text `val` by its name, `key`."""
        self.values = [*self.values, KeyValue(key=key, value=val)]


def _parts(args: tuple[Any, ...]) -> tuple[Any, Any]:
    if len(args) == 1:
        return args[0].level, args[0].message
    level, message = args
    return level, message


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
        """Return the status that the function makes of `stat`."""
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


class FrequencyStatusParam:
    """Bounds of a frequency.

    Args:
        freq_bound: Lowest and highest frequency in Hz, `{"min": 9.0, "max": 11.0}`, which may change later; "max" can
            be left out.
        tolerance: Part of a bound by which it may be missed.
        window_size: Number of updates over which the frequency is measured.
    """

    def __init__(self, freq_bound: MutableMapping[str, float], tolerance: float = 0.1, window_size: int = 5) -> None:
        self.freq_bound, self.tolerance, self.window_size = freq_bound, tolerance, window_size

    @property
    def lowest(self) -> float:
        """Lowest frequency that is accepted, in Hz."""
        return self.freq_bound["min"] * (1 - self.tolerance)

    @property
    def highest(self) -> float | None:
        """Highest frequency that is accepted, in Hz; None if there is no bound."""
        return self.freq_bound["max"] * (1 + self.tolerance) if "max" in self.freq_bound else None


class FrequencyStatus(DiagnosticTask):
    """Task that watches how often `tick` is called: WARN out of bounds, ERROR if it is not called at all.

    Args:
        params: The bounds.
        name: Name of the part.
    """

    def __init__(self, params: FrequencyStatusParam, name: str = "FrequencyStatus") -> None:
        super().__init__(name)
        self.params = params
        self.lock = threading.Lock()
        self._clock = ROSClock()
        self.clear()

    def clear(self) -> None:
        """Forget what was counted."""
        with self.lock:
            self.count = 0
            begin = (self._clock.now().nanoseconds, 0)
            self._window = deque([begin] * self.params.window_size, self.params.window_size)
            """Time in ns and count at the last updates."""

    def tick(self) -> None:
        """Count an event."""
        with self.lock:
            self.count += 1

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill out `stat` and return it."""
        with self.lock:
            now, count = self._clock.now().nanoseconds, self.count
            begin, before = self._window[0]
            self._window.append((now, count))
        events, window = count - before, (now - begin) / 1e9
        frequency = events / window if window > 0 else 0.0
        self._tell(stat, events, frequency)
        stat.add("Events in window", f"{events}")
        stat.add("Events since startup", f"{count}")
        stat.add("Duration of window (s)", f"{window:f}")
        stat.add("Actual frequency (Hz)", f"{frequency:f}")
        bound, highest = self.params.freq_bound, self.params.highest
        if bound["min"] == bound.get("max"):
            stat.add("Target frequency (Hz)", f"{bound['min']:f}")
        if bound["min"] > 0:
            stat.add("Minimum acceptable frequency (Hz)", f"{self.params.lowest:f}")
        if highest is not None:
            stat.add("Maximum acceptable frequency (Hz)", f"{highest:f}")
        return stat

    def _tell(self, stat: DiagnosticStatusWrapper, events: int, frequency: float) -> None:
        highest = self.params.highest
        if events == 0:
            stat.summary(DiagnosticStatus.ERROR, "No events recorded.")
        elif frequency < self.params.lowest:
            stat.summary(DiagnosticStatus.WARN, "Frequency too low.")
        elif highest is not None and frequency > highest:
            stat.summary(DiagnosticStatus.WARN, "Frequency too high.")
        else:
            stat.summary(DiagnosticStatus.OK, "Desired frequency met")


class TimeStampStatusParam:
    """Bounds of the age of a stamp.

    Args:
        min_acceptable: Least age in seconds; a negative one is in the future.
        max_acceptable: Greatest age in seconds.
    """

    def __init__(self, min_acceptable: float = -1, max_acceptable: float = 5) -> None:
        self.max_acceptable, self.min_acceptable = max_acceptable, min_acceptable


class TimeStampStatus(DiagnosticTask):
    """Task that watches how old stamps are: ERROR out of bounds, WARN if there were none.

    Args:
        params: The bounds; None has the default ones.
        name: Name of the part.
    """

    def __init__(self, params: TimeStampStatusParam | None = None, name: str = "Timestamp Status") -> None:
        super().__init__(name)
        self.params = TimeStampStatusParam() if params is None else params
        self.lock = threading.Lock()
        self.early_count = self.late_count = self.zero_count = 0
        self._clock = ROSClock()
        self._ages: list[float] = []
        self._saw_zero = False

    def tick(self, stamp: float | Time) -> None:
        """Note an event with a `stamp`: a Time, or seconds."""
        seconds = float(stamp) if isinstance(stamp, (int, float)) else stamp.nanoseconds / 1e9
        with self.lock:
            if seconds == 0:
                self._saw_zero = True
                return
            age = self._clock.now().nanoseconds / 1e9 - seconds
            self._ages = [min([*self._ages, age]), max([*self._ages, age])]

    def run(self, stat: DiagnosticStatusWrapper) -> DiagnosticStatusWrapper:
        """Fill out `stat` and return it."""
        with self.lock:
            (least, greatest), has_data = self._ages or (0.0, 0.0), bool(self._ages)
            saw_zero, self._saw_zero, self._ages = self._saw_zero, False, []
        stat.summary(DiagnosticStatus.OK, "Timestamps are reasonable.")
        if not has_data:
            stat.summary(DiagnosticStatus.WARN, "No data since last update.")
        else:
            self._tell(stat, least, greatest, saw_zero)
        figures: dict[str, Any] = {
            "Earliest timestamp delay:": f"{least:f}",
            "Latest timestamp delay:": f"{greatest:f}",
            "Earliest acceptable timestamp delay:": f"{self.params.min_acceptable:f}",
            "Latest acceptable timestamp delay:": f"{self.params.max_acceptable:f}",
            "Late diagnostic update count:": f"{self.late_count}",
            "Early diagnostic update count:": f"{self.early_count}",
            "Zero seen diagnostic update count:": f"{self.zero_count}",
        }
        for key, value in figures.items():
            stat.add(key, value)
        return stat

    def _tell(self, stat: DiagnosticStatusWrapper, least: float, greatest: float, saw_zero: bool) -> None:
        if least < self.params.min_acceptable:
            stat.summary(DiagnosticStatus.ERROR, "Timestamps too far in future seen.")
            self.early_count += 1
        if greatest > self.params.max_acceptable:
            stat.summary(DiagnosticStatus.ERROR, "Timestamps too far in past seen.")
            self.late_count += 1
        if saw_zero:
            stat.summary(DiagnosticStatus.ERROR, "Zero timestamp seen.")
            self.zero_count += 1


class HeaderlessTopicDiagnostic(CompositeDiagnosticTask):
    """Task for a topic whose messages have no header; it adds itself to an updater.

    Args:
        name: Name of the topic.
        diag: The updater.
        freq: Bounds of its frequency.
    """

    def __init__(self, name: str, diag: Updater, freq: FrequencyStatusParam) -> None:
        super().__init__(f"{name} topic status")
        self.diag, self.freq = diag, FrequencyStatus(freq)
        self.addTask(self.freq)
        diag.add(self)

    def tick(self) -> None:
        """Note that a message was published."""
        self.freq.tick()

    def clear_window(self) -> None:
        """Forget what was counted."""
        self.freq.clear()


class TopicDiagnostic(HeaderlessTopicDiagnostic):
    """Task for a topic whose messages have a header.

    Args:
        name: Name of the topic.
        diag: The updater.
        freq: Bounds of its frequency.
        stamp: Bounds of the age of its stamps.
    """

    def __init__(self, name: str, diag: Updater, freq: FrequencyStatusParam, stamp: TimeStampStatusParam) -> None:
        super().__init__(name, diag, freq)
        self.stamp = TimeStampStatus(stamp)
        self.addTask(self.stamp)

    def tick(self, stamp: float | Time) -> None:  # type: ignore[override]
        """Note that a message with a `stamp` was published: a Time, or seconds."""
        self.stamp.tick(stamp)
        super().tick()


class DiagnosedPublisher(TopicDiagnostic):
    """Publisher whose topic has diagnostics.

    Args:
        pub: The publisher; its messages have a header.
        diag: The updater.
        freq: Bounds of its frequency.
        stamp: Bounds of the age of its stamps.
    """

    def __init__(
        self, pub: Publisher[Any], diag: Updater, freq: FrequencyStatusParam, stamp: TimeStampStatusParam
    ) -> None:
        super().__init__(pub.topic_name, diag, freq, stamp)
        self.publisher = pub

    def publish(self, message: Any) -> None:
        """Publish a `message`, and note its stamp."""
        stamp = message.header.stamp
        self.tick(Time.from_msg(stamp) if stamp.sec >= 0 else stamp.sec + stamp.nanosec / 1e9)  # no Time is before 1970
        self.publisher.publish(message)


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
