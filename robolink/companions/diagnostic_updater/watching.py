"""Diagnostic tasks that watch how often something happens, and how old its stamps are."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import MutableMapping
from typing import Any

from robolink.clock import ROSClock
from robolink.companions.diagnostic_updater.status import DiagnosticStatusWrapper
from robolink.companions.diagnostic_updater.tasks import DiagnosticTask
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from robolink.time import Time


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
