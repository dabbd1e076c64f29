"""Timers of an AsyncNode."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.experimental.loop_entity import cancel_callbacks, leave
from robolink.running.execution import takes_arguments
from robolink.text.callbacks import named
from robolink.timer import Timer, TimerInfo


class AsyncTimer(Timer):
    """Timer whose callback runs on asyncio's event loop; made by `AsyncNode.create_timer`.

    Its callback is not called again before it has ended. Periods that pass meanwhile are left out, but for one.
    """

    @property
    def callback(self) -> Callable[..., Any] | None:
        """Function, or coroutine function, that is called; with a TimerInfo if it needs an argument.

        Raises TypeError for what cannot be called, RuntimeError if it needs more than one argument.
        """
        return self._callback

    @callback.setter
    def callback(self, callback: Callable[..., Any] | None) -> None:
        if not callable(callback):
            raise TypeError(f"a timer's callback must be callable, got {callback!r:.80}")
        self._callback, self._info_name = callback, None
        self._takes_info = not takes_arguments(callback, 0)
        if self._takes_info and not takes_arguments(callback, 1):
            raise RuntimeError(
                f"a timer's callback takes no argument, or one (TimerInfo); {named(callback)} needs more"
            )

    def execute(self, taken: Any) -> Any:
        """Call the callback."""
        if not self._takes_info:
            return super().execute(taken)
        expected, actual = taken
        kind = self.clock.clock_type
        info = TimerInfo(expected_call_time=expected, actual_call_time=actual, clock_type=kind)
        return self._callback(info) if self._callback is not None else None

    def destroy(self) -> None:
        """End the timer for good, and cancel its callback if that is under way. Safe to call twice."""
        if self._destroyed:
            return
        cancel_callbacks(self)
        super().destroy()
        leave(self, "timers")
