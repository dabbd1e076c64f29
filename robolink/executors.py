"""Executors: they wait, take what is ready in the order in which it became ready, and run the callbacks."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.defaults import get_defaults
from robolink.entity import Entity
from robolink.exceptions import ExternalShutdownException as ExternalShutdownException
from robolink.exceptions import InterruptedByUser
from robolink.executor_queue import Taken, earlier
from robolink.executor_running import ConditionReachedException as ConditionReachedException
from robolink.executor_running import ExecutorRunning
from robolink.executor_running import ShutdownException as ShutdownException
from robolink.executor_running import TimeoutException as TimeoutException
from robolink.executor_running import TimeoutObject as TimeoutObject
from robolink.executor_running import await_or_execute as await_or_execute
from robolink.queues import A_WHILE
from robolink.task import Future, Task
from robolink.utilities import get_default_context

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.node import Node

ExecutorT = TypeVar("ExecutorT", bound="Executor")

POLL_NS = 1_000_000
"""How often a coroutine is asked that awaits something of nobody's: neither our futures nor a plain function."""

CUSTOM_SLICE = 0.1
"""Seconds after which an executor of the user's own that waits for a future is asked whether it has come."""


class Executor(ExecutorRunning):
    """The base of executors; an own one overrides `spin_once` and gets its work from `wait_for_ready_callbacks`."""

    parallel = False
    """Whether other callbacks go on while one of them waits."""

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__(context if context is not None else get_default_context())
        self._is_shutdown = False
        self._left = threading.Condition(self._lock)
        self._pause = self._context.time.wait
        self._context.on_shutdown(self.wake)

    @property
    def context(self) -> Context:
        """The context whose end ends the spinning."""
        return self._context

    def can_execute(self, entity: Entity) -> bool:
        """Whether its callback group would let an entity run now."""
        return entity.gate.can_execute(entity)

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Begin no more callbacks, let go of all nodes, and wait for the callbacks that other threads run.

        False when some still run after `timeout_sec` seconds; None or less waits for ever, 0 does not wait.
        """
        with self._lock:
            first, self._is_shutdown = not self._is_shutdown, True
        if first:
            for node in self.get_nodes():
                self.remove_node(node)
            self._context.let_go(self.inbox)
        self.wake()
        return self._wait_for(self._left, lambda: {*self._spinners} <= {threading.get_ident()}, timeout_sec)

    @staticmethod
    def _wait_for(changed: threading.Condition, ended: Callable[[], bool], seconds: float | None) -> bool:
        left = float("inf") if seconds is None or seconds < 0 else seconds
        with changed:
            while not changed.wait_for(ended, min(left, A_WHILE)) and left > 0:
                left -= A_WHILE
            return ended()

    # Waiting

    def _wait(
        self,
        deadline: int | None,
        stop: Callable[[], bool] | None = None,
        wanted: Callable[[Entity], bool] | None = None,
    ) -> Taken:
        """Wait until something is ready and take it.

        Raises TimeoutException, ShutdownException, ExternalShutdownException or ConditionReachedException.
        """
        inbox = self.inbox
        while True:
            if not inbox.empty():
                inbox.sweep()
            if self.asked:
                self._ask_waitables()
            next_timer = self._collect_due() if self._timers else None
            if self.ready or self._blocked:
                taken = self._take(wanted)
                if taken is not None:
                    return taken
            arrival = self._wait_for_arrival(deadline, next_timer, stop)
            if arrival is not None:
                taken = self._take_at_once(arrival, wanted)
                if taken is not None:
                    return taken
            if self._polled:
                self._ask_again()

    def _wait_for_arrival(self, deadline: int | None, next_timer: int | None, stop: Callable[[], bool] | None) -> Any:
        """Wait, unless there is a reason not to, until something arrives, a timer is due or there is news."""
        if stop is not None and stop():
            raise ConditionReachedException
        self.check_end()
        steady, polled = self._context.time.steady, self._polled
        if deadline is not None and steady() >= deadline:
            if not polled:
                raise TimeoutException
            return None  # also whoever spins without waiting gets them done
        wake_at = earlier(deadline, next_timer)
        return self._pause(self.inbox, earlier(wake_at, steady() + POLL_NS) if polled else wake_at)

    def check_end(self) -> None:
        """Raise ExternalShutdownException after the context's end, ShutdownException after `shutdown`."""
        if not self._context.ok():
            self._check_interrupt()
            if not self._is_shutdown:
                raise ExternalShutdownException
        if self._is_shutdown:
            raise ShutdownException

    def _check_interrupt(self) -> None:
        """Raise after a signal; KeyboardInterrupt is for the main thread alone, as in every Python program."""
        if self._context.interrupted:
            raise InterruptedByUser if get_defaults().in_main_thread() else ExternalShutdownException

    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | TimeoutObject | None = None,
        nodes: Iterable[Node] | None = None,
        condition: Callable[[], bool] = lambda: False,
    ) -> tuple[Task[Any], Entity, Node | None]:
        """Wait for something to do; give what does it when called, in whatever thread, its entity and its node.

        `nodes` are all by default. Calling the task keeps what the callback raises as the task's exception. Raises
        TimeoutException, ShutdownException, ExternalShutdownException, or ConditionReachedException once `condition()`.
        """
        chosen = None if nodes is None else list(nodes)
        wanted = None if chosen is None else lambda entity: entity.node in (None, *chosen)
        entity, taken = self._wait(self._deadline(timeout_sec), condition, wanted)
        return Task(self._run_and_look, (entity, taken)), entity, entity.node

    def _wait_for_ready_callbacks(self, *args: Any, **kwargs: Any) -> Iterable[tuple[Task[Any], Entity, Node | None]]:
        """Yield what `wait_for_ready_callbacks` gives, for ever."""
        while True:
            yield self.wait_for_ready_callbacks(*args, **kwargs)

    # Spinning

    _dispatch = ExecutorRunning.run
    """See to it that what was taken is run: here and now, unless there are threads for it."""

    def spin(self) -> None:
        """Run callbacks until the context is shut down, or this executor.

        After a signal, raises InterruptedByUser in the main thread, ExternalShutdownException in another.
        """
        self._context.given_parameters.warn_of_typos(self.get_nodes())
        try:
            while self._context.ok() and not self._is_shutdown:
                if self._is_users_own():
                    self.spin_once()
                else:
                    self._spin()
        except KeyboardInterrupt:
            self._check_interrupt()
            raise
        self._check_interrupt()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Run one callback; wait for it at most `timeout_sec` seconds, for ever when None or negative."""
        self._spin(self._deadline(timeout_sec), once=True)

    def spin_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """Run callbacks until the future is done, or `timeout_sec` seconds have passed."""
        future.when_done(self.wake)
        if not future.over() and self._context.ok() and not self._is_shutdown:
            spin = self._spin_by_slices if self._is_users_own() else self._spin
            spin(self._deadline(timeout_sec), future.over)
        if not future.over():
            self._check_interrupt()

    def spin_once_until_future_complete(
        self, future: Future[Any], timeout_sec: float | TimeoutObject | None = None
    ) -> None:
        """Run one callback, or none when the future is done first."""
        future.when_done(self.wake)
        self._spin(self._deadline(timeout_sec), future.over, once=True)

    def _is_users_own(self) -> bool:
        return type(self).spin_once is not Executor.spin_once

    def _spin_by_slices(self, deadline: int | None, stop: Callable[[], bool]) -> None:
        steady, slice_ns = self._context.time.steady, int(CUSTOM_SLICE * 1e9)
        while not stop() and self._context.ok() and not self._is_shutdown:
            left = slice_ns if deadline is None else min(slice_ns, deadline - steady())
            if left < 0:
                return
            try:
                self.spin_once(timeout_sec=left / 1e9)
            except TimeoutException:
                continue

    def _deadline(self, timeout_sec: float | TimeoutObject | None) -> int | None:
        seconds = timeout_sec.timeout if isinstance(timeout_sec, TimeoutObject) else timeout_sec
        if seconds is None or seconds < 0:
            return None
        if seconds == 0:
            self._context.time.pass_on()
        return self._context.time.steady() + int(seconds * 1e9)

    def _spin(self, deadline: int | None = None, stop: Callable[[], bool] | None = None, *, once: bool = False) -> None:
        """Run callbacks until `stop()`, the deadline, or the end of the context or of this executor."""
        time, thread, ok = self._context.time, threading.get_ident(), self._context.ok
        if deadline is None and self.spins_here:
            stop = self._telling_of_held(stop)
        self._spinners.append(thread)
        try:
            while True:
                self._dispatch(*self._wait(deadline, stop))
                if once or self._is_shutdown or not ok() or (stop is not None and stop()):
                    return
                if deadline is not None and time.steady() >= deadline:
                    return
        except (TimeoutException, ShutdownException, ConditionReachedException):
            pass
        finally:
            self._spinners.remove(thread)
            if self._is_shutdown:
                with self._left:
                    self._left.notify_all()

    # Waiting within a callback

    def serve_until(self, future: Future[Any], deadline: int | None, *, serving: bool = True) -> None:
        """In a callback that waits for an answer: run only what serves, so that the answer can come.

        Services whose callback group is busy (the waiting callback's own, say) are left alone.
        """
        while not future.over():
            self.inbox.sweep()
            taken = self._take(_serves)
            if taken is not None:
                self.run(*taken)
            elif deadline is not None and self._context.time.steady() >= deadline:
                return
            else:
                self.check_end()
                arrival = None if future.over() else self._context.time.wait(self.inbox, deadline)
                if arrival is not None:
                    self.inbox.deliver(arrival)

    @contextmanager
    def waiting_for(self, services: Sequence[Entity]) -> Iterator[bool]:
        """In a callback that is about to wait for one of these: whether none can answer, since it keeps them busy."""
        yield bool(services) and not any(map(self.can_execute, services))

    def __enter__(self: ExecutorT) -> ExecutorT:
        return self

    def __exit__(self, *_: object) -> None:
        self.shutdown()


class SingleThreadedExecutor(Executor):
    """Runs one callback after the other, where `spin` was called, in the order in which they became ready."""

    def __new__(cls, *, context: Context | None = None) -> SingleThreadedExecutor:
        """Make one of the kind that the context has, if it has another one."""
        own = (context or get_default_context()).executor_type if cls is SingleThreadedExecutor else None
        return super().__new__(own or cls)


class MultiThreadedExecutor(Executor):
    """Has callbacks run side by side in threads of its own, as far as their groups allow; whoever spins hands them out.

    `num_threads` is the number of this process's cores by default. What a callback raises is raised by the next spin.
    """

    parallel = True

    def __init__(self, num_threads: int | None = None, *, context: Context | None = None) -> None:
        from robolink.callback_threads import CallbackThreads, count_cores  # late: it takes some milliseconds

        super().__init__(context=context)
        count = count_cores() if num_threads is None else num_threads
        if count == 1:
            warnings.warn(
                "a MultiThreadedExecutor with one thread is slower than a SingleThreadedExecutor: use that",
                stacklevel=2,
            )
        self._threads = CallbackThreads(count, self)
        self._executor = self._threads.pool
        self._pause = self._threads.pause

    @property
    def spins_here(self) -> bool:
        """Whether the calling thread spins or runs a callback."""
        return self._threads.runs_here() or super().spins_here

    def _is_held_here(self, entity: Entity) -> bool:
        return super()._is_held_here(entity) and self._threads.holds(entity.gate)

    def poll(self, entity: Entity) -> None:
        """Make an entity ready again in a moment."""
        super().poll(entity)
        self.wake()

    def _take(self, wanted: Callable[[Entity], bool] | None = None) -> Taken | None:
        threads = self._threads
        if threads.failures:
            raise threads.failures.popleft()  # before more is begun
        if threads.free > 0:
            return super()._take(wanted)
        serves = threads.can_serve()

        def may(entity: Entity) -> bool:
            return (entity.quick or (serves and entity.serves)) and (wanted is None or wanted(entity))

        return super()._take(may)

    def _take_at_once(self, arrival: Any, wanted: Callable[[Entity], bool] | None = None) -> Taken | None:
        if self._threads.free > 0:
            return super()._take_at_once(arrival, wanted)
        self.inbox.deliver(arrival)
        return None

    def _spin(self, deadline: int | None = None, stop: Callable[[], bool] | None = None, *, once: bool = False) -> None:
        try:
            super()._spin(deadline, stop, once=once)
        except InterruptedByUser:
            raise
        except ExternalShutdownException:  # as in rclpy, only the single-threaded one raises it
            pass

    def check_end(self) -> None:
        """Raise what a callback raised, or what says that the context or this executor has ended."""
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
        """In a callback that waits: go on with others; if `serving`, in this thread too when no other is free."""
        if self._threads.runs_here():
            self._threads.wait(future, deadline, serving)
        else:  # in whoever spins, who runs callbacks once Python has ended the pool
            super().serve_until(future, deadline, serving=serving)

    @contextmanager
    def waiting_for(self, services: Sequence[Entity]) -> Iterator[bool]:
        """In a callback that is about to wait for one of these: whether none can answer, since it keeps them busy.

        Or since other callbacks do that wait for this one.
        """
        with self._threads.waiting_for(each.callback_group for each in services) as hopeless:
            yield hopeless and not any(map(self.can_execute, services))

    def shutdown(self, timeout_sec: float | None = None, *, wait_for_threads: bool = True) -> bool:
        """Begin no more callbacks, let go of all nodes, and wait for the callbacks under way, and for the threads.

        False when some still run after `timeout_sec` seconds; None or less waits for ever, 0 does not wait.
        """
        super().shutdown(0)
        self._threads.close(wait=False)
        ended = self._wait_for(self._threads.ended, self._threads.have_ended, timeout_sec)
        self._threads.close(wait=wait_for_threads and ended)
        return ended


def _serves(entity: Entity) -> bool:
    return entity.serves
