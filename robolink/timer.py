"""Timers, and rates that are made of them."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.callback_groups import CallbackGroup
from robolink.clock import Clock, ROSClock
from robolink.clock_type import ClockType
from robolink.entity import NOTHING, Entity
from robolink.exceptions import InvalidHandle, ROSInterruptException
from robolink.time import Time

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.executors import Executor


class TimerInfo:
    """When a timer's callback should have been called and when it was."""

    def __init__(
        self,
        *,
        expected_call_time: int = 0,
        actual_call_time: int = 0,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
    ) -> None:
        self.expected_call_time = Time(nanoseconds=expected_call_time, clock_type=clock_type)
        self.actual_call_time = Time(nanoseconds=actual_call_time, clock_type=clock_type)


class Timer(Entity):
    """Calls a function every so often, on absolute deadlines, so that it does not drift."""

    def __init__(
        self,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup | None,
        timer_period_ns: int,
        clock: Clock,
        *,
        context: Context | None = None,
        autostart: bool = True,
    ) -> None:
        super().__init__(callback_group)
        self.callback = callback
        self.clock = clock
        self.version = 0
        """Changes whenever an older deadline no longer holds."""
        self._period = _checked_period(timer_period_ns)
        self._last = clock.now_ns()
        self.next_call_ns = self._last + self._period
        self._canceled = not autostart
        self._destroyed = False
        self._with_info = callback is not None and _wants_info(callback)

    def attach(self, executor: Executor, queued: int = 0) -> None:
        """Be called by this executor when due."""
        super().attach(executor, queued)
        if isinstance(self.clock, ROSClock):
            self.clock.watch(executor)
        if not queued:
            self.reschedule()

    def detach(self) -> None:
        """Be called by none."""
        super().detach()
        self.version += 1

    def reschedule(self) -> None:
        """Have the executor forget the deadline it knows and take the one that holds now."""
        self.version += 1
        executor = self.executor
        if executor is None or self._canceled:
            return
        now = self.clock.now_ns()
        if now < self._last:  # the clock was set back, or follows another source: as in rcl, a period starts now
            self._last, self.next_call_ns = now, now + self._period
        if self.clock.wait_ns(self.next_call_ns) is None:
            return  # /clock will say when
        executor.schedule(self)
        executor.wake()

    def take(self) -> Any:
        """Be called now: the next deadline is a whole number of periods after the last one."""
        now = self.clock.now_ns()
        if self._canceled or self._destroyed:
            return NOTHING
        if now < self.next_call_ns:  # the executor waits by another clock, which may be a little ahead
            self.reschedule()
            return NOTHING
        expected = self.next_call_ns
        self._advance(now)
        if self.executor is not None:
            self.version += 1
            self.executor.schedule(self)
        return expected, now

    def _advance(self, now: int) -> None:
        self._last = now
        if self._period == 0:
            self.next_call_ns = now
            return
        self.next_call_ns += self._period * max(1, 1 + (now - self.next_call_ns) // self._period)

    def execute(self, taken: Any) -> Any:
        """Call the callback."""
        if self.callback is None:
            return None
        if not self._with_info:
            return self.callback()
        expected, actual = taken
        info = TimerInfo(expected_call_time=expected, actual_call_time=actual, clock_type=self.clock.clock_type)
        return self.callback(info)

    @property
    def timer_period_ns(self) -> int:
        """Nanoseconds from call to call."""
        self._check()
        return self._period

    @timer_period_ns.setter
    def timer_period_ns(self, value: int) -> None:
        self._check()
        self._period = _checked_period(value)

    def is_ready(self) -> bool:
        """Whether it is due."""
        self._check()
        return not self._canceled and self.clock.now_ns() >= self.next_call_ns

    def is_canceled(self) -> bool:
        """Whether it was cancelled and not reset."""
        return self._canceled

    def cancel(self) -> None:
        """Call no more, until `reset`."""
        self._check()
        self._canceled = True
        self.version += 1

    def reset(self) -> None:
        """Start anew: the next call comes in one period from now."""
        self._check()
        self._canceled = False
        self.next_call_ns = self.clock.now_ns() + self._period
        self.reschedule()

    def time_since_last_call(self) -> int:
        """Nanoseconds since the last call, or since it was made."""
        self._check()
        return self.clock.now_ns() - self._last

    def time_until_next_call(self) -> int | None:
        """Nanoseconds until the next call, negative when it is late; None when cancelled."""
        self._check()
        return None if self._canceled else self.next_call_ns - self.clock.now_ns()

    def destroy(self) -> None:
        """Call no more. Safe to call twice."""
        self._destroyed = True
        self._canceled = True
        self.detach()

    def _check(self) -> None:
        if self._destroyed:
            raise InvalidHandle("the timer has been destroyed")

    def __enter__(self) -> Timer:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


def _checked_period(period: int) -> int:
    if period < 0:
        raise ValueError(f"a timer's period cannot be negative, got {period} ns")
    return int(period)


def _wants_info(callback: Callable[..., Any]) -> bool:
    """Whether a callback has a parameter that is annotated as TimerInfo."""
    import inspect

    try:
        parameters = inspect.signature(callback).parameters.values()
    except (TypeError, ValueError):  # a built-in function that does not tell
        return False
    kinds = [each.annotation for each in parameters]
    return any(each is TimerInfo or str(each).rpartition(".")[2] == "TimerInfo" for each in kinds)


class Rate:
    """Sleeps for the rest of each period. Something else has to spin, or time to be virtual."""

    def __init__(self, timer: Timer, *, context: Context) -> None:
        self._timer, self._context = timer, context
        self._condition, self._woken = threading.Condition(), threading.Event()
        self._ticks = 0
        self._ended = False
        timer.callback = self._tick
        context.on_shutdown(self._end)

    def _tick(self) -> None:
        with self._condition:
            self._ticks += 1
            self._condition.notify_all()

    def _end(self) -> None:
        with self._condition:
            self._ended = True
            self._condition.notify_all()
        self._woken.set()

    def destroy(self) -> None:
        """Wake whoever sleeps, for good. Safe to call twice."""
        self._end()
        self._timer.destroy()

    def sleep(self) -> None:
        """Sleep until the next tick. Raises ROSInterruptException when the context ends or the rate is destroyed.

        In the thread that spins, or where nobody does, it sleeps by the clock instead of waiting for a callback.
        """
        if not self._context.ok() or self._ended:
            raise ROSInterruptException()
        if self._sleeps_alone():
            self._sleep_by_clock()
        else:
            with self._condition:
                before = self._ticks
                self._condition.wait_for(lambda: self._ticks != before or self._ended)
        if self._ended or not self._context.ok():
            raise ROSInterruptException()

    def _sleeps_alone(self) -> bool:
        executor = self._timer.executor
        return executor is None or not executor.spinning or executor.spins_here

    def _sleep_by_clock(self) -> None:
        timer = self._timer
        timer.clock.sleep_until_ns(timer.next_call_ns, self._woken, lambda: self._ended)
        if timer.take() is NOTHING and not self._ended:
            timer.reset()
