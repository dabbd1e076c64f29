"""Clocks of ROS, system and steady time, and callbacks for jumps in time."""

from __future__ import annotations

import threading
from collections.abc import Callable
from enum import IntEnum
from typing import TYPE_CHECKING, Protocol

from robolink.clock_type import ClockType
from robolink.duration import Duration
from robolink.exceptions import NotInitializedException, imported_as
from robolink.running.defaults import get_defaults
from robolink.running.timebase import TimeBase
from robolink.system import waits
from robolink.time import Time

if TYPE_CHECKING:
    from robolink.context import Context

__all__ = ["Clock", "ClockChange", "ClockType", "Duration", "JumpHandle", "JumpThreshold", "ROSClock", "TimeJump"]


class ClockChange(IntEnum):
    """Change of a clock's source in a jump; the numbers are rcl's."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


class JumpThreshold:
    """Threshold of a jump callback: the jumps that it is called for.

    Args:
        min_forward: Smallest jump forward, above zero; None for none.
        min_backward: Smallest jump backward, below zero; None for none.
        on_clock_change: True is also every change of the clock's source, to or from /clock.

    Raises:
        ValueError: if `min_forward` or `min_backward` has the wrong sign, or no jump at all is left.
    """

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
        """True if the callback is called for `jump`."""
        if jump.clock_change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED):
            return self.on_clock_change
        delta = jump.delta.nanoseconds
        forward = self.min_forward is not None and delta >= self.min_forward.nanoseconds
        return forward or (self.min_backward is not None and delta <= self.min_backward.nanoseconds)


class TimeJump:
    """Jump in time: `clock_change`, the change of the clock's source, and `delta`, the time after minus before."""

    def __init__(self, clock_change: ClockChange, delta: Duration) -> None:
        if not isinstance(clock_change, ClockChange):
            raise TypeError(f"clock_change must be a {imported_as()}.clock.ClockChange, got {clock_change!r:.80}")
        self._clock_change, self._delta = clock_change, delta

    @property
    def clock_change(self) -> ClockChange:
        """Change of the clock's source."""
        return self._clock_change

    @property
    def delta(self) -> Duration:
        """Time after the jump minus the time before."""
        return self._delta


class JumpHandle:
    """Registration of jump callbacks, until `unregister` or the end of a `with`; see `Clock.create_jump_callback`.

    Args:
        clock: Clock whose jumps count.
        threshold: Jumps that the callbacks are called for.
        pre_callback: Function without arguments, called before the time changes; or None.
        post_callback: Function of the TimeJump, called after the time has changed; or None.

    Raises:
        ValueError: if there is no callback, or one cannot be called.
    """

    def __init__(
        self,
        *,
        clock: Clock,
        threshold: JumpThreshold,
        pre_callback: Callable[[], None] | None,
        post_callback: Callable[[TimeJump], None] | None,
    ) -> None:
        if not isinstance(threshold, JumpThreshold):
            raise TypeError(f"threshold must be a {imported_as()}.clock.JumpThreshold, got {threshold!r:.80}")
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
        """Call the callbacks no more."""
        clock, self._clock = self._clock, None
        if clock is not None:
            clock._jumps.remove(self)

    def __enter__(self) -> JumpHandle:
        return self

    def __exit__(self, *_: object) -> None:
        self.unregister()


class Clock:
    """Source of time of one kind; `Clock(clock_type=ClockType.ROS_TIME)` is a ROSClock.

    Args:
        clock_type: SYSTEM_TIME (since 1970, may be set), STEADY_TIME (since some moment, never set) or ROS_TIME
            (that of /clock while a node of this clock has `use_sim_time`, else the system's).
        time_base: Source of system and steady time; None is the program's own, which may be virtual.

    Raises:
        TypeError: if `clock_type` is not a ClockType.
    """

    def __new__(cls, *, clock_type: ClockType = ClockType.SYSTEM_TIME, time_base: TimeBase | None = None) -> Clock:
        """Make a clock, for ROS_TIME a ROSClock."""
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        return super().__new__(ROSClock if clock_type is ClockType.ROS_TIME and cls is Clock else cls)

    def __init__(self, *, clock_type: ClockType = ClockType.SYSTEM_TIME, time_base: TimeBase | None = None) -> None:
        self._clock_type = clock_type
        self._base: TimeBase = time_base or get_defaults().time
        self._read = self._base.steady if clock_type is ClockType.STEADY_TIME else self._base.now
        self._jumps: list[JumpHandle] = []
        self._active = False
        """True while the time comes from /clock, and not from `_read`."""

    @property
    def clock_type(self) -> ClockType:
        """Kind of the clock: system, steady or ROS time."""
        return self._clock_type

    @property
    def time_base(self) -> TimeBase:
        """Source of the time while it does not come from /clock."""
        return self._base

    def __repr__(self) -> str:
        return f"Clock(clock_type={self.clock_type.name})"

    def now(self) -> Time:
        """Return the current time, as a Time of this clock's type."""
        return Time(nanoseconds=self.now_ns(), clock_type=self._clock_type)

    def now_ns(self) -> int:
        """The time in nanoseconds, for those who count."""
        return self._read()

    def wait_ns(self, until: int, now: int | None = None) -> int | None:
        """Return the nanoseconds of steady time until the time `until`; None if only /clock decides.

        `now` is the time that was read just before; None reads it.
        """
        return until - (self.now_ns() if now is None else now)

    def create_jump_callback(
        self,
        threshold: JumpThreshold,
        *,
        pre_callback: Callable[[], None] | None = None,
        post_callback: Callable[[TimeJump], None] | None = None,
    ) -> JumpHandle:
        """Register callbacks for jumps in time, until `unregister` of the handle that is returned.

        Args:
            threshold: Jumps that the callbacks are called for.
            pre_callback: Function without arguments, called before the time changes.
            post_callback: Function of the TimeJump, called after the time has changed.

        Raises:
            ValueError: if there is no callback, or one cannot be called.
        """
        return JumpHandle(clock=self, threshold=threshold, pre_callback=pre_callback, post_callback=post_callback)

    def sleep_until(self, until: Time, context: Context | None = None) -> bool:
        """Sleep until a time of this clock.

        Args:
            until: Time to wake at, of this clock's type; in the past it does not sleep.
            context: Context whose end ends the sleep; None is the default one.

        Returns:
            True if the time was reached, False if a shutdown or a change of the time source came first.

        Raises:
            ValueError: if `until` is of another clock type.
            NotInitializedException: (a RuntimeError) if the context is not initialized, or has ended.
        """
        context = self._context(context)
        if until.clock_type != self._clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        event = threading.Event()
        context.on_shutdown(event.set)
        return self.sleep_until_ns(until.nanoseconds, event, lambda: not context.ok())

    def sleep_until_ns(self, until: int, event: threading.Event, ended: Callable[[], bool]) -> bool:
        """Sleep until the time `until`, in nanoseconds; end when `ended()`, asked again whenever `event` is set."""
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
        end = None if left is None else self._base.steady() + left
        self._base.wait_notified(event.is_set, end, lambda seconds: waits.wait(event, seconds))

    def sleep_for(self, rel_time: Duration, context: Context | None = None) -> bool:
        """Sleep for a duration on this clock, and return True if it has passed; see `sleep_until`.

        Args:
            rel_time: Duration of the sleep; zero or less does not sleep.
            context: Context whose end ends the sleep; None is the default one.

        Raises:
            NotInitializedException: (a RuntimeError) if the context is not initialized, or has ended.
        """
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
    """Observer of a clock that may jump: a timer."""

    def reschedule(self) -> None:
        """Compute anew when to be called."""
        ...


class ROSClock(Clock):
    """Clock of ROS time: that of /clock while it is active (`use_sim_time`), else the system's.

    Args:
        clock_type: ROS_TIME, always; for the sake of Clock.
        time_base: Source of the system's time; None is the program's own, which may be virtual.
    """

    def __new__(cls, *, clock_type: ClockType = ClockType.ROS_TIME, time_base: TimeBase | None = None) -> ROSClock:
        """Make a clock of ROS time, for any type that is asked for."""
        return object.__new__(cls)

    def __init__(self, *, clock_type: ClockType = ClockType.ROS_TIME, time_base: TimeBase | None = None) -> None:
        super().__init__(clock_type=ClockType.ROS_TIME, time_base=time_base)
        self._override = 0
        self._watchers: dict[ClockWatcher, None] = {}  # a set that keeps its order, so that runs repeat

    @property
    def ros_time_is_active(self) -> bool:
        """True while the time comes from /clock."""
        return self._active

    def now_ns(self) -> int:
        """The time in nanoseconds, for those who count."""
        if self._active:
            return self._override
        read = self._read  # for Python 3.11 a function in an attribute, no method
        return read()

    def wait_ns(self, until: int, now: int | None = None) -> int | None:
        """Return the nanoseconds of steady time until the time `until`; None if only /clock decides."""
        if not self._active:  # one reading of the time for both, whatever overrides it
            return until - (self.now_ns() if now is None else now)
        left = until - self._override
        return None if left > 0 else left

    def watch(self, watcher: ClockWatcher) -> None:
        """Call `reschedule()` of the `watcher` whenever /clock moved this clock, until `unwatch`."""
        self._watchers[watcher] = None

    def unwatch(self, watcher: ClockWatcher) -> None:
        """Call this `watcher` no more."""
        self._watchers.pop(watcher, None)

    def _set_ros_time_is_active(self, enabled: bool) -> None:
        if enabled == self._active:
            return
        change = ClockChange.ROS_TIME_ACTIVATED if enabled else ClockChange.ROS_TIME_DEACTIVATED

        def switch() -> None:
            self._active = enabled

        self._jump(change, switch, self._override if enabled else self._base.now())

    def set_ros_time_override(self, time: Time) -> None:
        """Set the ROS time to `time`, which holds while /clock is active. Raises TypeError for what is not a Time."""
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
        reported = [handle for handle in self._jumps if handle.threshold.met_by(jump)]
        for handle in reported:
            if handle.pre_callback is not None:
                handle.pre_callback()
        act()
        for handle in reported:
            if handle.post_callback is not None:
                handle.post_callback(jump)
        for watcher in list(self._watchers):
            watcher.reschedule()
