"""Executors: event loops that wait, and run what is ready, in rounds in which each entity has one turn."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from robolink.exceptions import ExternalShutdownException as ExternalShutdownException
from robolink.exceptions import InterruptedByUser
from robolink.executors.executor import Executor as Executor
from robolink.running.entity import Entity
from robolink.running.execution import ConditionReachedException as ConditionReachedException
from robolink.running.execution import ShutdownException as ShutdownException
from robolink.running.execution import TimeoutException as TimeoutException
from robolink.running.execution import TimeoutObject as TimeoutObject
from robolink.running.execution import await_or_execute as await_or_execute
from robolink.running.waiting import limit
from robolink.system import waits
from robolink.task import Future
from robolink.task import Task as Task
from robolink.utilities import get_default_context as get_default_context

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.running.ports import SpunNode


class SingleThreadedExecutor(Executor):
    """Executor that runs one callback after the other, in the thread that called `spin`.

    It gives turns as rclpy's does: to tasks, and then in rounds to waitables, and node by node to the timers that are
    due, to one message of each subscription, to guard conditions, clients and services. In an overload nobody starves.

    Args:
        context: Context whose end ends the spinning; None is the default one.
    """

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        self._parks = type(self) is SingleThreadedExecutor
        """False for a class of the user's own, which may override what is not called for a parked node."""
        # In a host one thread runs the callbacks of all programs, those of a class of the user's own excepted: it may
        # override what the host would not call.
        self._driver = self._context.make_driver(self) if self._parks else None
        if self._driver is not None:
            self._runs_here = self._driver.runs_here
            self._spin = self._spin_by_driver  # type: ignore[method-assign] # where there is none, it costs no call

    def _park_(self, node: SpunNode) -> None:
        if not self._parks or not self._nodes_.park(node):
            super()._park_(node)
            return
        # Looked at last: whoever has begun to spin meanwhile may have seen no parked node.
        if self._spinners.threads or (self._driver is not None and self._driver.is_lent):
            self._nodes_.evict()
            self.wake()

    @property
    def spinning(self) -> bool:
        """True while any thread spins."""
        return (self._driver is not None and self._driver.is_lent) or super().spinning

    def _spin_by_driver(
        self, deadline: int | None = None, stop: Callable[[], bool] | None = None, *, once: bool = False
    ) -> None:
        self._nodes_.evict()
        if once or self._driver is None or not self._driver.spin(deadline, stop):
            super()._spin(deadline, stop, once=once)


class MultiThreadedExecutor(Executor):
    """Executor with a thread pool: callbacks run in parallel, as far as their callback groups allow.

    The thread that spins hands them out. What a callback raises is raised by the next spin. When the context ends,
    spinning returns, as in rclpy; after Ctrl-C it raises InterruptedByUser in the main thread.

    Args:
        num_threads: Number of threads; None is the number of cores that this process may use. One thread is slower
            than a SingleThreadedExecutor, and warned of.
        context: Context whose end ends the spinning; None is the default one.
    """

    parallel = True

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        from robolink.running.threads import CallbackThreads, count_cores  # late: it takes some milliseconds

        super().__init__(context=context)
        count = count_cores() if num_threads is None else num_threads
        if count == 1:
            warnings.warn(
                "a MultiThreadedExecutor with one thread is slower than a SingleThreadedExecutor: use that",
                stacklevel=2,
            )
        self._threads = CallbackThreads(count, self)
        self._executor = self._threads.pool
        self._waiting.take, self._waiting.take_at_once = self._threads.take, self._threads.take_at_once
        self._waiting.pause = self._threads.pause
        self._runs_here = self._threads.runs_here

    def _check_interrupt(self) -> None:
        if not self._context.terminated:  # as in rclpy, SIGTERM only lets the spinning of this one return
            super()._check_interrupt()

    def _is_held_here(self, entity: Entity) -> bool:
        return super()._is_held_here(entity) and self._threads.holds(entity.gate)

    def _spin(self, deadline: int | None = None, stop: Callable[[], bool] | None = None, *, once: bool = False) -> None:
        try:
            super()._spin(deadline, stop, once=once)
        except InterruptedByUser:
            raise
        except ExternalShutdownException:  # as in rclpy, only the single-threaded one raises it
            pass

    def spin_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """Run callbacks until a future is done, as every executor does; raise what they have raised, the future's too.

        Args:
            future: Future to wait for; `future.done()` says whether it came.
            timeout_sec: Longest wait in seconds; None or less waits for ever, 0 does not wait.

        Raises:
            Exception: what a callback raises, also the task that is waited for.
        """
        super().spin_until_future_complete(future, timeout_sec)
        if isinstance(future, Task) and future.done():
            self._threads.settle(future)
        if self._threads.failures:
            raise self._threads.failures.popleft()

    def check_end(self) -> None:
        """Raise what a callback raised, or the exception for the end of the context or of this executor."""
        if self._threads.failures:
            raise self._threads.failures.popleft()
        super().check_end()

    def _dispatch(self, entity: Entity, taken: Any) -> None:
        if entity.quick:
            self.run(entity, taken)
            return
        try:
            self._threads.submit(entity, taken)
        except RuntimeError:
            if self._is_shutdown:  # meanwhile
                entity.gate.ending_execution(entity)
                raise ShutdownException from None
            self.run(entity, taken)  # Python ends the pool when the main thread ends, but not whoever spins

    def serve_until(self, future: Future[Any], deadline: int | None, *, serving: bool = True) -> None:
        """Wait in a callback until `future` is over, while other callbacks go on.

        Args:
            future: Future that the callback waits for.
            deadline: End of the wait, in nanoseconds of steady time; None is never.
            serving: True runs services in this thread when no other thread is free.
        """
        if self._threads.runs_here():
            self._threads.wait(future, deadline, serving)
        else:  # in whoever spins, who runs callbacks once Python has ended the pool
            super().serve_until(future, deadline, serving=serving)

    def is_last_awake(self) -> bool:
        """Return True in a callback if all other threads of this executor sleep until a timer wakes them."""
        return self._threads.is_last_awake()

    @contextmanager
    def waiting_for(self, services: Sequence[Entity]) -> Iterator[bool]:
        """Enter a wait for an answer of one of `services`, in a callback; the value is True if it would be a deadlock.

        It would be if the waiting callback itself keeps the group of each of them busy, or if callbacks do that wait
        for this one.
        """
        with self._threads.waiting_for(each.callback_group for each in services) as hopeless:
            yield hopeless and not any(map(self.can_execute, services))

    def shutdown(self, timeout_sec: float | None = None, *, wait_for_threads: bool = True) -> bool:
        """Begin no more callbacks, remove all nodes, and wait for the callbacks under way, and for the threads.

        Args:
            timeout_sec: Longest wait for callbacks, in seconds; None or less waits for ever, 0 does not wait.
            wait_for_threads: True waits for the threads to end, too, once no callback runs.

        Returns:
            True if no callback runs any more.
        """
        super().shutdown(0)
        self._threads.close(wait=False)
        ended = waits.wait_for(self._threads.ended, self._threads.have_ended, limit(timeout_sec))
        self._threads.close(wait=wait_for_threads and ended)
        return ended
