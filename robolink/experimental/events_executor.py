"""EventsExecutor: callbacks in one thread, in the order in which their events came, whatever their callback groups."""

from __future__ import annotations

import inspect
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.exceptions import ExternalShutdownException, RobolinkError
from robolink.executors import SingleThreadedExecutor
from robolink.running.arrival_queue import ArrivalQueue
from robolink.running.entity import GUARD_CONDITION
from robolink.running.execution import TaskRunner
from robolink.task import Future, Task

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.running.entity import Entity
    from robolink.running.ports import SpunNode


LINKS = 4
"""Longest chain of callbacks, each made ready by the one before, after the end of a spin: a message, the timer whose
time it brings, the future that this one completes, the coroutine that awaits it."""


class AlreadySpinningError(RobolinkError, RuntimeError):
    """An EventsExecutor was to be spun by two at a time."""


class EventsExecutor(SingleThreadedExecutor):
    """Executor that runs callbacks one after the other, in the order in which their events came.

    It differs from a SingleThreadedExecutor as rclpy's does:

    - There are no rounds: of ten messages of one topic that came before one of another, all ten go first.
    - Callback groups have no effect. While a callback that is a coroutine awaits something, all others go on, and so
      does the next call of the same one.
    - `spin_until_future_complete` runs what is ready before it looks at its timeout: with a timeout of 0, all of it.
      What never ends, such as a timer slower than its period, ends with the timeout too, which in rclpy it does not.
    - A spin in a callback, or in a second thread, is refused with an AlreadySpinningError (a RuntimeError).
    - Whatever spins raises ExternalShutdownException when the context has ended, also if a callback has ended it.

    Guard conditions work here; rclpy's refuses to spin a node that has one, which a warning says.

    Args:
        context: Context whose end ends the spinning; None is the default one.
    """

    _queue_type_ = ArrivalQueue

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        self._spun = threading.Lock()
        self._has_warned = False

    def add_node(self, node: SpunNode) -> bool:
        """Run the callbacks of `node` from now on, and remove it from another executor; False if it is here already."""
        added = super().add_node(node)
        entities = node._entity_store_.entities() if added and not self._has_warned else ()
        if any(each.rank == GUARD_CONDITION for each in entities):
            self._has_warned = True
            node.get_logger().warning(
                "this node has a guard condition: rclpy's EventsExecutor does not support"
                " them, and raises RuntimeError when it spins; a SingleThreadedExecutor does"
            )
        return added

    def run(self, entity: Entity, taken: Any) -> None:
        """Run `entity` with what was `taken`; a coroutine keeps no group busy. Raises what the callback raises."""
        outcome = None
        try:
            outcome = entity.execute(taken)
        finally:
            entity.gate.ending_execution(entity)
        if outcome is not None and inspect.iscoroutine(outcome):
            task: Task[Any] = Task(outcome, executor=self)
            TaskRunner(task, self, entity, holds_group=False).execute(task)

    _dispatch = run

    def spin(self) -> None:
        """Run callbacks until this executor is shut down, or its context.

        Raises:
            ExternalShutdownException: once the context has ended. After Ctrl-C it is, in the main thread, an
                InterruptedByUser, which is a KeyboardInterrupt too.
            AlreadySpinningError: (a RuntimeError) in a callback, or if another thread spins.
            Exception: what a callback raises.
        """
        super().spin()
        self._raise_end()

    def spin_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """Run callbacks until a future is done, the timeout has passed, or this executor has ended.

        Args:
            future: Future to wait for; `future.done()` says whether it came.
            timeout_sec: Longest wait in seconds; None or less waits for ever, 0 does not wait. What is ready then is
                run still, however long it takes.

        Raises:
            ExternalShutdownException: once the context has ended, as `spin` does.
            AlreadySpinningError: (a RuntimeError) in a callback, or if another thread spins.
            Exception: what a callback raises.
        """
        super().spin_until_future_complete(future, timeout_sec)
        self._raise_end()

    def _raise_end(self) -> None:
        if not self._context.ok() and not self._is_shutdown:
            raise ExternalShutdownException

    def _spin(self, deadline: int | None = None, stop: Callable[[], bool] | None = None, *, once: bool = False) -> None:
        if not self._spun.acquire(blocking=False):
            raise AlreadySpinningError(
                "Attempt to spin an already-spinning Executor: an EventsExecutor is spun by one thread, and not"
                " within its own callbacks; await the future there, or use a MultiThreadedExecutor"
            )
        try:
            super()._spin(deadline, stop, once=once)
            if deadline is not None and not once:
                self._run_ready(deadline, stop)
        finally:
            self._spun.release()

    def _run_ready(self, deadline: int, stop: Callable[[], bool] | None) -> None:
        """Run what is ready after the deadline, and what that makes ready."""
        for _ in range(LINKS):
            self.inbox.sweep()
            self._queue_.collect_due()
            for _ in range(len(self._queue_.turns) + len(self._queue_.ready)):
                if self._is_shutdown or not self._context.ok() or (stop is not None and stop()):
                    return
                super()._spin(deadline, stop, once=True)


__all__ = ["EventsExecutor"]
