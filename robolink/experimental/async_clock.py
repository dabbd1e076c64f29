"""Clock of an AsyncNode, by which coroutines sleep."""

from __future__ import annotations

import asyncio

from robolink.clock import ClockChange, JumpThreshold, ROSClock, TimeJump
from robolink.clock_type import ClockType
from robolink.duration import Duration
from robolink.exceptions import TimeSourceChangedError
from robolink.experimental.loops import call_at
from robolink.running.timebase import TimeBase

SMALLEST_JUMP = JumpThreshold(min_forward=Duration(nanoseconds=1), min_backward=None, on_clock_change=True)


class AsyncClock(ROSClock):
    """Clock with an asynchronous `sleep`, which follows /clock while the clock does.

    Args:
        clock_type: SYSTEM_TIME, STEADY_TIME or ROS_TIME, as for `Clock`.
        time_base: Source of system and steady time; None is the program's own, which may be virtual.
    """

    def __new__(cls, *, clock_type: ClockType = ClockType.SYSTEM_TIME, time_base: TimeBase | None = None) -> AsyncClock:
        """Make a clock of any type."""
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        return object.__new__(cls)

    def __init__(self, *, clock_type: ClockType = ClockType.SYSTEM_TIME, time_base: TimeBase | None = None) -> None:
        super().__init__(time_base=time_base)
        self._clock_type = clock_type
        if clock_type is ClockType.STEADY_TIME:
            self._read = self._base.steady
        self._sleepers: dict[asyncio.Future[None], int | None] = {}
        """Sleeps under way, each with its end by /clock; None for one by the system's time."""
        self._is_destroyed = False
        self._jump_handle = self.create_jump_callback(SMALLEST_JUMP, post_callback=self._on_jump)

    async def sleep(self, duration_sec: float) -> None:
        """Sleep for a time of this clock; zero or less only lets others go on.

        Args:
            duration_sec: Time to sleep, in seconds.

        Raises:
            TimeSourceChangedError: if the clock begins or ceases to follow /clock meanwhile.
            CancelledError: of asyncio, if the clock's node is destroyed meanwhile.
            RuntimeError: if it was destroyed before.
        """
        if self._is_destroyed:
            raise RuntimeError("Cannot sleep on a destroyed clock")
        duration = Duration(seconds=duration_sec).nanoseconds
        if duration <= 0:
            await asyncio.sleep(0)
            return
        sleeper: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        alarm: _Alarm | None = None
        if self.ros_time_is_active:
            self._sleepers[sleeper] = self.now_ns() + duration
        else:
            self._sleepers[sleeper] = None
            alarm = _Alarm(self._base, self._base.steady() + duration, sleeper)
        try:
            await sleeper
        finally:
            self._sleepers.pop(sleeper, None)
            if alarm is not None:
                alarm.handle.cancel()

    def _on_jump(self, jump: TimeJump) -> None:
        changed = jump.clock_change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED)
        now = self.now_ns()
        for sleeper, until in list(self._sleepers.items()):
            error = TimeSourceChangedError("the clock's source changed during a sleep") if changed else None
            if error is not None or (until is not None and now >= until):
                call_at(sleeper.get_loop(), _end, sleeper, error)

    def destroy(self) -> None:
        """Cancel all sleeps, and allow no more; the node does so at its end. Safe to call twice."""
        if self._is_destroyed:
            return
        self._is_destroyed = True
        self._jump_handle.unregister()
        for sleeper in list(self._sleepers):
            call_at(sleeper.get_loop(), sleeper.cancel)


class _Alarm:
    """Ends a sleep at a moment of steady time, and not a nanosecond before: the loop's own time is rounded."""

    def __init__(self, base: TimeBase, due: int, sleeper: asyncio.Future[None]) -> None:
        self._base, self._due, self._sleeper = base, due, sleeper
        self._set()

    def _set(self) -> None:
        left = max(0, self._due - self._base.steady())
        self.handle = self._sleeper.get_loop().call_later(left / 1e9, self._ring)

    def _ring(self) -> None:
        if self._base.steady() < self._due:
            self._set()
        else:
            _end(self._sleeper, None)


def _end(sleeper: asyncio.Future[None], error: Exception | None) -> None:
    if sleeper.done():
        return
    if error is None:
        sleeper.set_result(None)
    else:
        sleeper.set_exception(error)
