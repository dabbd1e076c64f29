"""Timers, which call a function periodically, and rates, which sleep until the next tick of a timer."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar

from robolink.callback_groups import CallbackGroup
from robolink.clock import Clock, ROSClock
from robolink.clock_type import ClockType
from robolink.exceptions import ExternalShutdownException, InterruptedByUser, InvalidHandle, ROSInterruptException
from robolink.running.entity import NOTHING, TIMER, Entity
from robolink.running.execution import logger_of
from robolink.system import waits
from robolink.task import Future
from robolink.text.callbacks import Place, call_instead_of_function
from robolink.time import Time

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.running.ports import Loop


class TimerInfo:
    """Expected and actual time of a call of a timer's callback.

    Args:
        expected_call_time: Time at which the call was due, in nanoseconds, not negative.
        actual_call_time: Time of the call itself, in nanoseconds, not negative.
        clock_type: Kind of the timer's clock.
    """

    def __init__(
        self,
        *,
        expected_call_time: int = 0,
        actual_call_time: int = 0,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
    ) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        if expected_call_time < 0 or actual_call_time < 0:
            raise ValueError("call time values must not be negative")
        self.expected_call_time = Time(nanoseconds=expected_call_time, clock_type=clock_type)
        self.actual_call_time = Time(nanoseconds=actual_call_time, clock_type=clock_type)


class Timer(Entity):
    """Calls a function periodically, on absolute deadlines, so that it does not drift; see `Node.create_timer`.

    Args:
        callback: Function, or coroutine function, without arguments, or with one that is annotated as TimerInfo.
        callback_group: Group of the callback; None is none, so that it may run at any time.
        timer_period_ns: Period in nanoseconds, 0 or more; 0 calls as often as possible.
        clock: Clock that the period is measured by.
        context: Context of the timer, as in rclpy; that of its executor counts.
        autostart: False makes the timer cancelled; `reset` starts it.

    Raises:
        ValueError: if the period is negative.
        TypeError: if the callback cannot be called.
    """

    rank = TIMER
    CALLBACK_TAKES: ClassVar[tuple[str, ...]] = ()
    """Names of the arguments of a callback, for errors about it."""

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
        self.callback = callback
        super().__init__(callback_group)
        self.made_at = _users_line() if callback is None else None
        """Place in the program at which it was made without a callback."""
        self.clock = clock
        self.version = 0
        """Number that changes whenever an older deadline no longer holds."""
        self._period = _checked_period(timer_period_ns)
        self._last = clock.now_ns()
        self.next_call_ns = self._last + self._period
        self._canceled = not autostart
        self._destroyed = False  # in the instance, where Python 3.11 finds it in a tenth of the time

    @property
    def callback(self) -> Callable[..., Any] | None:
        """Function that is called; with a TimerInfo if it has a parameter that is annotated so.

        None, as in rclpy, must have been replaced before the timer is due. Raises TypeError for what cannot be called.
        """
        return self._callback

    @callback.setter
    def callback(self, callback: Callable[..., Any] | None) -> None:
        if callback is not None and not callable(callback):
            raise TypeError(_not_callable(callback))
        self._callback = callback
        self._info_name = None if callback is None else _info_parameter(callback)

    def attach(self, executor: Loop, has_turn: bool = False) -> None:
        """Belong to this executor, which calls the timer when it is due."""
        super().attach(executor, has_turn)
        if isinstance(self.clock, ROSClock):
            self.clock.watch(self)
        if not has_turn:
            self.reschedule()

    def detach(self) -> None:
        """Belong to no executor; nothing calls the timer then."""
        super().detach()
        self.version += 1
        if isinstance(self.clock, ROSClock):
            self.clock.unwatch(self)

    def reschedule(self) -> None:
        """Replace the deadline that the executor knows by the one that holds now."""
        self.version += 1
        queue = self._queue_
        if queue is None or self._canceled:
            return
        now = self.clock.now_ns()
        if now < self._last:  # the clock was set back, or follows another source: as in rcl, a period starts now
            self._last, self.next_call_ns = now, now + self._period
        left = self.clock.wait_ns(self.next_call_ns)
        if left is not None:  # else /clock will say when
            queue.schedule(self, left)
            queue.wake()

    def take(self) -> Any:
        """Return the expected and the actual time of the call that is due, and set the next deadline; or NOTHING.

        The next deadline is a whole number of periods after the last one.
        """
        clock = self.clock
        read = clock.now_ns if clock._active else clock._read  # usually a call less
        now = read()
        if self._canceled or self._destroyed:
            return NOTHING
        if now < self.next_call_ns:  # the executor waits by another clock, which may be a little ahead
            self.reschedule()
            return NOTHING
        self._last, expected, period = now, self.next_call_ns, self._period
        if now - expected < period:  # as usual, and half as long as a division
            self.next_call_ns = expected + period
        else:
            self.next_call_ns = expected + period * (1 + (now - expected) // period) if period else now
        queue = self._queue_
        if queue is not None:
            self.version += 1
            left = clock.wait_ns(self.next_call_ns, now) if clock._active else self.next_call_ns - now
            if left is not None:
                schedule = queue.schedule  # for Python 3.11 a function in an attribute, no method
                schedule(self, left)
        return expected, now

    def execute(self, taken: Any) -> Any:
        """Call the callback."""
        callback = self._callback  # for Python 3.11 a function in an attribute, no method
        if callback is None:
            raise TypeError(self._without_callback())
        if self._info_name is None:
            return callback()
        expected, actual = taken
        info = TimerInfo(expected_call_time=expected, actual_call_time=actual, clock_type=self.clock.clock_type)
        return callback(**{self._info_name: info})

    def _without_callback(self) -> str:
        called = call_instead_of_function(self.made_at) if self.made_at is not None else ""
        called = called or "self.on_timer()"
        where = f" that was made at {self.made_at.file}:{self.made_at.line}" if self.made_at is not None else ""
        return (
            f"the timer of {self._period / 1e9:g} s{where} has None for a callback; "
            f"give it the function itself, without (): {called[:-2]}, not {called}"
        )

    @property
    def timer_period_ns(self) -> int:
        """Period in nanoseconds; a new one holds from the next call on."""
        self._check()
        return self._period

    @timer_period_ns.setter
    def timer_period_ns(self, value: int) -> None:
        self._check()
        self._period = _checked_period(value)

    def is_ready(self) -> bool:
        """True if a call is due."""
        self._check()
        return not self._canceled and self.clock.now_ns() >= self.next_call_ns

    def is_canceled(self) -> bool:
        """True if the timer was cancelled and not reset."""
        self._check()
        return self._canceled

    def cancel(self) -> None:
        """Stop the timer, until `reset`."""
        self._check()
        self._canceled = True
        self.version += 1

    def reset(self) -> None:
        """Start the timer, or start it anew: the next call comes in one period from now."""
        self._check()
        self._canceled = False
        self.next_call_ns = self.clock.now_ns() + self._period
        self.reschedule()

    def time_since_last_call(self) -> int:
        """Return the nanoseconds since the last call, or since the timer was made."""
        self._check()
        return self.clock.now_ns() - self._last

    def time_until_next_call(self) -> int | None:
        """Return the nanoseconds until the next call, negative if it is late; None if the timer is cancelled."""
        self._check()
        return None if self._canceled else self.next_call_ns - self.clock.now_ns()

    def destroy(self) -> None:
        """End the timer for good. Safe to call twice."""
        self._destroyed = True
        self._canceled = True
        self.detach()

    def _check(self) -> None:
        if self._destroyed:
            raise self._gone_("the timer")

    def __enter__(self) -> Timer:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


def period_ns(seconds: float) -> int:
    """Return a timer's period of `seconds` in nanoseconds. Raises ValueError if it is negative, infinite or NaN."""
    if float(seconds) < 0:
        raise ValueError(f"a timer's period cannot be negative, got {seconds} s")
    if not float(seconds) * 1e9 < float("inf"):
        raise ValueError(f"a timer's period must be a number of seconds, got {seconds}")
    return int(float(seconds) * 1e9)


def _checked_period(period: int) -> int:
    if period < 0:
        raise ValueError(f"a timer's period cannot be negative, got {period} ns")
    return int(period)


def _not_callable(callback: object) -> str:
    comma = " (a decimal number has a point: 1.0)" if type(callback) is int else ""
    return f"a timer's callback must be callable, got {callback!r:.80}{comma}"


def _users_line() -> Place:
    """Return the place in the user's code of the call that has led here."""
    frame = sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("robolink."):
        frame = frame.f_back
    return Place(frame.f_code.co_filename, frame.f_lineno)


def _info_parameter(callback: Callable[..., Any]) -> str | None:
    """Return the name of a callback's parameter that is annotated as TimerInfo."""
    import inspect

    try:
        parameters = inspect.signature(callback).parameters.values()
    except (TypeError, ValueError):  # a built-in function that does not tell
        return None
    kinds = {each.name: each.annotation for each in parameters}
    found = (name for name, kind in kinds.items() if kind is TimerInfo or str(kind).rpartition(".")[2] == "TimerInfo")
    return next(found, None)


_NEVER_THERE = (
    "rate.sleep() returns here, but never does with ROS 2: {}, and no other can call the rate's timer. Spin in a thread"
    " of its own, threading.Thread(target=rclpy.spin, args=(node,), daemon=True), or use a timer instead of a rate"
)


class Rate:
    """Sleeps for the rest of each period. Something else has to spin, or time to be virtual.

    A tick that comes while nobody sleeps lets the next `sleep` return at once; of several, one is kept. So work that
    took longer than a period is not followed by a wait for the next whole one.

    Args:
        timer: Timer whose ticks count; its callback is replaced. `Node.create_rate` makes both.
        context: Context whose end ends every sleep.
    """

    def __init__(self, timer: Timer, *, context: Context) -> None:
        self._timer, self._context = timer, context
        self._sleepers: list[Future[None]] = []
        self._has_ticked = self._has_warned = False
        self._lock = threading.Lock()
        self._is_shutdown = self._is_destroyed = False
        timer.callback = self._tick
        timer.quick = True
        context.on_shutdown(self._shut_down)

    def _tick(self) -> None:
        with self._lock:
            sleepers, self._sleepers = self._sleepers, []
            self._has_ticked = not sleepers
        for each in sleepers:
            each.set_result(None)

    def _shut_down(self) -> None:
        self._is_shutdown = True
        self.destroy()

    def destroy(self) -> None:
        """End the rate, and every sleep. Safe to call twice."""
        self._is_destroyed = True
        self._tick()
        self._timer.destroy()

    def sleep(self) -> None:
        """Sleep until the next tick, or until the rate is destroyed; not at all if there was one since the last sleep.

        In the thread that spins, or where nobody does, it sleeps by the clock instead of waiting for a callback; rclpy
        would never return, and a warning says so. Raises
        ROSInterruptException when the context ends, InterruptedByUser (a KeyboardInterrupt) in the main thread when
        that is by a signal, RuntimeError when the rate or its timer was destroyed before.
        """
        if self._is_shutdown or not self._context.ok():
            raise ROSInterruptException()
        if self._is_destroyed:
            raise RuntimeError("Rate cannot sleep because it has been destroyed")
        try:
            with self._timer.handle:
                self._sleep()
        except (ExternalShutdownException, InvalidHandle) as error:
            if isinstance(error, InterruptedByUser) or self._context.ok():
                raise
        if self._is_shutdown or not self._context.ok():
            raise ROSInterruptException()

    def _sleep(self) -> None:
        tick = self._next_tick()
        try:
            self._wait_for(tick)
        finally:
            with self._lock:  # a sleep that was broken off leaves the tick to the next one
                self._sleepers = [each for each in self._sleepers if each is not tick]

    def _next_tick(self) -> Future[None]:
        """Return the future of the next tick, which is done if there was one since the last sleep."""
        tick: Future[None] = Future()
        with self._lock:
            ticked, self._has_ticked = self._has_ticked or self._is_destroyed, False
            if not ticked:
                self._sleepers.append(tick)
        if ticked:
            tick.set_result(None)
        return tick

    def _wait_for(self, tick: Future[None]) -> None:
        executor = self._timer.executor
        if executor is None or not executor.spinning:
            self._tick_by_clock(tick, "nothing spins its node")
        elif executor.spins_here and not executor.parallel:
            self._tick_by_clock(tick, "the thread that sleeps is the one that spins")
        elif executor.spins_here:
            if executor.is_last_awake():
                self._warn("all threads of its executor sleep")
            executor.serve_until(tick, None, serving=False)
        else:
            woken = threading.Event()
            tick.when_done(woken.set)
            waits.wait(woken)

    def _warn(self, reason: str) -> None:
        """Warn, once, that ROS 2 leaves the sleeper asleep: a program that runs here must not hang on a robot."""
        if not self._has_warned:
            self._has_warned = True
            logger_of(self._timer).warning(_NEVER_THERE.format(reason))

    def _tick_by_clock(self, tick: Future[None], reason: str) -> None:
        """Take the timer's ticks here, until an executor that begins to spin has taken one, or the rate ends."""
        timer, woken = self._timer, threading.Event()
        tick.when_done(woken.set)
        while not tick.over():
            reached = timer.clock.sleep_until_ns(timer.next_call_ns, woken, tick.over)
            if tick.over():
                return
            if timer.take() is not NOTHING:
                self._tick()
                self._warn(reason)  # so late: a thread that spins may only just begin
            elif timer.is_canceled() or not reached:  # not: an executor took it just now, and will tell
                timer.reset()
