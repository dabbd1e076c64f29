"""Clocks: what time it is for a node, and who is told when it jumps."""

from __future__ import annotations

import threading
from collections.abc import Callable
from enum import IntEnum
from typing import TYPE_CHECKING, Protocol

from robolink.clock_type import ClockType
from robolink.defaults import get_defaults
from robolink.duration import Duration
from robolink.exceptions import NotInitializedException, imported_as
from robolink.time import Time
from robolink.timebase import TimeBase

if TYPE_CHECKING:
    from robolink.context import Context

__all__ = ["Clock", "ClockChange", "ClockType", "Duration", "JumpHandle", "JumpThreshold", "ROSClock", "TimeJump"]


class ClockChange(IntEnum):
    """How a clock's source changed in a jump; the numbers are rcl's."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


class JumpThreshold:
    """Which jumps a callback is called for. Raises ValueError when it would never be called."""

    def __init__(
        self, *, min_forward: Duration | None, min_backward: Duration | None, on_clock_change: bool = True
    ) -> None:
        if min_forward is not None and min_forward.nanoseconds <= 0:
            raise ValueError("min_forward must be a positive non-zero duration")
        if min_backward is not None and min_backward.nanoseconds >= 0:
            raise ValueError("min_backward must be a negative non-zero duration")
        if min_forward is None and min_backward is None and not on_clock_change:
            raise ValueError("At least one jump threshold must be enabled")
        self.min_forward, self.min_backward, self.on_clock_change = min_forward, min_backward, on_clock_change

    def met_by(self, jump: TimeJump) -> bool:
        """Whether this jump is to be told."""
        if jump.clock_change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED):
            return self.on_clock_change
        delta = jump.delta.nanoseconds
        forward = self.min_forward is not None and delta >= self.min_forward.nanoseconds
        return forward or (self.min_backward is not None and delta <= self.min_backward.nanoseconds)


class TimeJump:
    """One jump: what changed and by how much."""

    def __init__(self, clock_change: ClockChange, delta: Duration) -> None:
        if not isinstance(clock_change, ClockChange):
            raise TypeError(f"clock_change must be a {imported_as()}.clock.ClockChange, got {clock_change!r:.80}")
        self._clock_change, self._delta = clock_change, delta

    @property
    def clock_change(self) -> ClockChange:
        """How the source changed."""
        return self._clock_change

    @property
    def delta(self) -> Duration:
        """The time after the jump minus the time before."""
        return self._delta


class JumpHandle:
    """A registration of jump callbacks; also a context manager. Callbacks are called until `unregister`."""

    def __init__(
        self,
        *,
        clock: Clock,
        threshold: JumpThreshold,
        pre_callback: Callable[[], None] | None,
        post_callback: Callable[[TimeJump], None] | None,
    ) -> None:
        if pre_callback is None and post_callback is None:
            raise ValueError("One of pre_callback or post_callback must be callable")
        if pre_callback is not None and not callable(pre_callback):
            raise ValueError("pre_callback must be callable if given")
        if post_callback is not None and not callable(post_callback):
            raise ValueError("post_callback must be callable if given")
        self._clock: Clock | None = clock
        self.threshold, self.pre_callback, self.post_callback = threshold, pre_callback, post_callback
        clock._jumps.append(self)

    def unregister(self) -> None:
        """Call no more."""
        clock, self._clock = self._clock, None
        if clock is not None:
            clock._jumps.remove(self)

    def __enter__(self) -> JumpHandle:
        return self

    def __exit__(self, *_: object) -> None:
        self.unregister()


class Clock:
    """A clock. ``Clock(clock_type=ClockType.ROS_TIME)`` gives a ROSClock."""

    def __new__(cls, *, clock_type: ClockType = ClockType.SYSTEM_TIME, time_base: TimeBase | None = None) -> Clock:
        """Raises TypeError for what is no ClockType."""
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        return super().__new__(ROSClock if clock_type is ClockType.ROS_TIME and cls is Clock else cls)

    def __init__(self, *, clock_type: ClockType = ClockType.SYSTEM_TIME, time_base: TimeBase | None = None) -> None:
        self._clock_type = clock_type
        self._base: TimeBase = time_base or get_defaults().time
        self._read = self._base.steady if clock_type is ClockType.STEADY_TIME else self._base.now
        self._jumps: list[JumpHandle] = []

    @property
    def clock_type(self) -> ClockType:
        """Which kind of clock this is."""
        return self._clock_type

    @property
    def time_base(self) -> TimeBase:
        """Where the time comes from while no /clock gives it."""
        return self._base

    def __repr__(self) -> str:
        return f"Clock(clock_type={self.clock_type.name})"

    def now(self) -> Time:
        """The time, of this clock's type."""
        return Time(nanoseconds=self.now_ns(), clock_type=self._clock_type)

    def now_ns(self) -> int:
        """The time in nanoseconds, for those who count."""
        return self._read()

    def wait_ns(self, until: int) -> int | None:
        """How many nanoseconds of steady time it takes until `until`; None when only /clock knows."""
        return until - self.now_ns()

    def create_jump_callback(
        self,
        threshold: JumpThreshold,
        *,
        pre_callback: Callable[[], None] | None = None,
        post_callback: Callable[[TimeJump], None] | None = None,
    ) -> JumpHandle:
        """Have callbacks called before and after jumps that meet the threshold. The handle ends it."""
        return JumpHandle(clock=self, threshold=threshold, pre_callback=pre_callback, post_callback=post_callback)

    def sleep_until(self, until: Time, context: Context | None = None) -> bool:
        """Sleep until `until` on this clock; whether it was reached (not: a shutdown, a change of time source).

        Raises ValueError for a time of another clock type, NotInitializedException when the context is not ok.
        """
        context = self._context(context)
        if until.clock_type != self._clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        event = threading.Event()
        context.on_shutdown(event.set)
        return self.sleep_until_ns(until.nanoseconds, event, lambda: not context.ok())

    def sleep_until_ns(self, until: int, event: threading.Event, ended: Callable[[], bool]) -> bool:
        """Sleep as `sleep_until` does, but end when `ended()`, which is asked again whenever `event` is set."""
        changed = False

        def on_jump(jump: TimeJump) -> None:
            nonlocal changed
            changed |= jump.clock_change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED)
            event.set()

        smallest = JumpThreshold(min_forward=Duration(nanoseconds=1), min_backward=Duration(nanoseconds=-1))
        with self.create_jump_callback(smallest, post_callback=on_jump):
            while self.now_ns() < until and not ended() and not changed:
                self._sleep(event, until)
                event.clear()
        return self.now_ns() >= until and not changed

    def _sleep(self, event: threading.Event, until: int) -> None:
        left = self.wait_ns(until)
        if self._base.hosted or (left is not None and self._base.virtual):
            self._base.wait_until(event.is_set, None if left is None else self._base.steady() + left)
        else:
            event.wait(None if left is None else left / 1e9)

    def sleep_for(self, rel_time: Duration, context: Context | None = None) -> bool:
        """Sleep so long on this clock; whether it was reached. See `sleep_until`."""
        return self.sleep_until(self.now() + rel_time, self._context(context))

    @staticmethod
    def _context(context: Context | None) -> Context:
        if context is None:
            from robolink.utilities import get_default_context

            context = get_default_context()
        if not context.ok():
            raise NotInitializedException(ended_by=context.ended_by)
        return context


class ClockWatcher(Protocol):
    """What wants to know that a clock moved: a timer."""

    def reschedule(self) -> None:
        """Look again when to be called."""
        ...


class ROSClock(Clock):
    """The time that /clock gives while it is active, else the system's."""

    def __new__(cls, *, clock_type: ClockType = ClockType.ROS_TIME, time_base: TimeBase | None = None) -> ROSClock:
        """Whatever the type asked for, this is a clock of ROS time."""
        return object.__new__(cls)

    def __init__(self, *, clock_type: ClockType = ClockType.ROS_TIME, time_base: TimeBase | None = None) -> None:
        super().__init__(clock_type=ClockType.ROS_TIME, time_base=time_base)
        self._active = False
        self._override = 0
        self._watchers: dict[ClockWatcher, None] = {}  # a set that keeps its order, so that runs repeat

    @property
    def ros_time_is_active(self) -> bool:
        """Whether the time comes from /clock."""
        return self._active

    def now_ns(self) -> int:
        """The time in nanoseconds, for those who count."""
        return self._override if self._active else self._read()

    def wait_ns(self, until: int) -> int | None:
        """How many nanoseconds of steady time it takes until `until`; None when only /clock knows."""
        left = until - self.now_ns()
        return None if self._active and left > 0 else left

    def watch(self, watcher: ClockWatcher) -> None:
        """Call ``watcher.reschedule()`` whenever /clock moved this clock, until `unwatch`."""
        self._watchers[watcher] = None

    def unwatch(self, watcher: ClockWatcher) -> None:
        """Call it no more, if it was called."""
        self._watchers.pop(watcher, None)

    def _set_ros_time_is_active(self, enabled: bool) -> None:
        if enabled == self._active:
            return
        change = ClockChange.ROS_TIME_ACTIVATED if enabled else ClockChange.ROS_TIME_DEACTIVATED

        def switch() -> None:
            self._active = enabled

        self._jump(change, switch, self._override if enabled else self._base.now())

    def set_ros_time_override(self, time: Time) -> None:
        """Say what time it is while /clock is active. Raises TypeError for what is no Time."""
        if not isinstance(time, Time):
            raise TypeError(f"the time must be a {imported_as()}.time.Time, got {time!r:.80}")

        def move() -> None:
            self._override = time.nanoseconds

        if self._active:
            self._jump(ClockChange.ROS_TIME_NO_CHANGE, move, time.nanoseconds)
        else:
            move()

    def _jump(self, change: ClockChange, act: Callable[[], None], after: int) -> None:
        jump = TimeJump(change, Duration(nanoseconds=after - self.now_ns()))
        told = [handle for handle in self._jumps if handle.threshold.met_by(jump)]
        for handle in told:
            if handle.pre_callback is not None:
                handle.pre_callback()
        act()
        for handle in told:
            if handle.post_callback is not None:
                handle.post_callback(jump)
        for watcher in list(self._watchers):
            watcher.reschedule()
