"""Executors: event loops that wait, and run what is ready, in rounds in which each entity has one turn."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable, Coroutine, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from types import CoroutineType
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.exceptions import ExternalShutdownException as ExternalShutdownException
from robolink.exceptions import InterruptedByUser, NotInitializedException
from robolink.running.defaults import get_defaults
from robolink.running.entity import Entity
from robolink.running.execution import ConditionReachedException as ConditionReachedException
from robolink.running.execution import ShutdownException as ShutdownException
from robolink.running.execution import (
    TaskRunner,
)
from robolink.running.execution import TimeoutException as TimeoutException
from robolink.running.execution import TimeoutObject as TimeoutObject
from robolink.running.execution import await_or_execute as await_or_execute
from robolink.running.ready_queue import ReadyQueue
from robolink.running.spun_nodes import SpunNodes
from robolink.running.waiting import DeadlockWarning, Spinners, Waiting, limit
from robolink.system import waits
from robolink.task import Future, watch
from robolink.task import Task as Task
from robolink.utilities import get_default_context as get_default_context

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.running.defaults import Driver
    from robolink.running.ports import NodeLike, SpunNode

ExecutorT = TypeVar("ExecutorT", bound="Executor")

RUNS_ITSELF = (
    "node {} is an AsyncNode, which asyncio runs and no executor: write `async with node:` or `await node.run()` in a"
    " coroutine, and start that by asyncio.run(...)"
)
"""Text of the error for whoever spins an AsyncNode."""

CUSTOM_SLICE = 0.1
"""Longest `spin_once`, in seconds, of an executor of the user's own that spins until a future is done."""


class Executor:
    """Base class of executors; an own one overrides `spin_once` and gets its work from `wait_for_ready_callbacks`.

    Args:
        context: Context whose end ends the spinning; None is the default one.

    Raises:
        NotInitializedException: (a RuntimeError) before `init`, or after the end of the context.
    """

    parallel = False
    """True if other callbacks go on while one of them waits."""

    _queue_type_: Callable[..., ReadyQueue[Entity]] = ReadyQueue
    """Class of its ready queue, which decides whose turn is next."""

    _driver: Driver | None = None
    """Driver by which a host runs the callbacks, where it does."""

    def __init__(self, *, context: Context | None = None) -> None:
        self._context = context if context is not None else get_default_context()
        if not self._context.ok():
            raise NotInitializedException("cannot make an executor", ended_by=self._context.ended_by)
        self._queue_ = self._queue_type_(self._context.make_inbox(), self._context.time.steady)
        """Ready queue: what is ready, and what will be."""
        self.inbox = self._queue_.inbox
        self._waiting = Waiting(self._queue_, self._context)
        self._nodes_ = SpunNodes(self._queue_, self._context)
        self._spinners = Spinners(self._queue_.lock)
        self._deadlock_warning = DeadlockWarning(self._queue_, self._nodes_.added)
        self._runs_here: Callable[[], bool] | None = None
        """Returns True in a callback that a thread other than a spinning one runs, where there may be one."""
        self._is_shutdown = False
        self._context.on_shutdown(self.wake)

    @property
    def context(self) -> Context:
        """Context whose end ends the spinning."""
        return self._context

    def can_execute(self, entity: Entity) -> bool:
        """True if the callback group of `entity` would let it run now."""
        return entity.gate.can_execute(entity)

    def _is_held_here(self, entity: Entity) -> bool:
        """Return whether a callback under way in this thread keeps the group of an entity busy."""
        return not entity.gate.can_execute(entity)

    # Nodes

    def add_node(self, node: SpunNode) -> bool:
        """Run the callbacks of `node` from now on, and remove it from another executor; False if it is here already.

        Raises TypeError for an AsyncNode, which runs on asyncio's event loop.
        """
        if node._runs_itself_:
            raise TypeError(RUNS_ITSELF.format(node.get_fully_qualified_name()))
        before = node._attached_to_
        if before is not None and before is not self:
            before.remove_node(node)
        added = self._nodes_.add(node, self)
        if added:
            self.wake()
        return added

    def remove_node(self, node: SpunNode) -> None:
        """Run the callbacks of `node` no more. What is ready keeps its turn until the node is added again."""
        if self._nodes_.remove(node):
            self.wake()

    def _park_(self, node: SpunNode) -> None:
        """Remove `node`, which is likely to be added again soon."""
        self.remove_node(node)

    def get_nodes(self) -> list[SpunNode]:
        """Return all nodes that were added."""
        return list(self._nodes_.added)

    def attach(self, entity: Entity) -> None:
        """Run the callback of `entity` from now on."""
        self._nodes_.attach(entity, self)
        self.wake()

    def wake(self) -> None:
        """Wake the thread that waits for work, from any thread: it looks again at what is ready."""
        self.inbox.wake()

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Begin no more callbacks, remove all nodes, and wait for the callbacks that other threads run.

        Args:
            timeout_sec: Longest wait in seconds; None or less waits for ever, 0 does not wait.

        Returns:
            True if no callback runs any more.
        """
        with self._queue_.lock:
            first, self._is_shutdown = not self._is_shutdown, True
        if first:
            for node in self.get_nodes():
                self.remove_node(node)
            self._nodes_.evict()
            self._context.let_go(self.inbox, self._nodes_)
        self.wake()
        return self._spinners.wait_for_others(timeout_sec)

    # Waiting

    def check_end(self) -> None:
        """Raise ExternalShutdownException after the context's end, ShutdownException after `shutdown`."""
        if not self._context.ok():
            self._check_interrupt()
            if not self._is_shutdown:
                raise ExternalShutdownException
        if self._is_shutdown:
            raise ShutdownException

    def _check_interrupt(self) -> None:
        """Raise after a signal; KeyboardInterrupt is for Ctrl-C in the main thread, as in every Python program."""
        if self._context.interrupted:
            is_ctrl_c = get_defaults().in_main_thread() and not self._context.terminated
            raise InterruptedByUser if is_ctrl_c else ExternalShutdownException

    def wait_for_ready_callbacks(
        self,
        timeout_sec: float | TimeoutObject | None = None,
        nodes: Iterable[NodeLike] | None = None,
        condition: Callable[[], bool] = lambda: False,
    ) -> tuple[Task[Any], Entity, NodeLike | None]:
        """Wait for a callback that is ready, and take it; for executors of one's own.

        Args:
            timeout_sec: Longest wait in seconds; None or less waits for ever, 0 does not wait.
            nodes: Nodes whose callbacks to take; None takes those of all nodes.
            condition: Function that ends the wait by returning True; it is asked whenever something happens.

        Returns:
            A task to be called, in any thread, its entity and its node. The task keeps what the callback raises as
            its exception.

        Raises:
            TimeoutException: if nothing was ready in time.
            ShutdownException: if this executor was shut down; ExternalShutdownException for its context.
            ConditionReachedException: if the condition was true.
        """
        self._nodes_.evict()
        chosen = None if nodes is None else list(nodes)
        expected = None if chosen is None else lambda entity: entity.node in (None, *chosen)
        entity, taken = self._waiting.wait(self, self._waiting.deadline(timeout_sec), condition, expected)
        return Task(self._run_and_look, (entity, taken)), entity, entity.node

    def _wait_for_ready_callbacks(
        self, *args: Any, **kwargs: Any
    ) -> Iterable[tuple[Task[Any], Entity, NodeLike | None]]:
        """Yield the results of `wait_for_ready_callbacks`, for ever."""
        while True:
            yield self.wait_for_ready_callbacks(*args, **kwargs)

    # Running

    def create_task(self, callback: Any, *args: Any, **kwargs: Any) -> Task[Any]:
        """Run a function or coroutine in this executor.

        Args:
            callback: Function, coroutine function or coroutine.
            args: Positional arguments of the function.
            kwargs: Keyword arguments of the function.

        Returns:
            Task that is done with the result of `callback`, or with the exception that it raised.
        """
        task: Task[Any] = Task(callback, args, kwargs, executor=self)
        self._queue_.post(TaskRunner(task, self))
        return task

    def create_future(self) -> Future[Any]:
        """Return a new future whose done callbacks run in this executor."""
        return Future(executor=self)

    def run(self, entity: Entity, taken: Any) -> None:
        """Run `entity` with what was `taken`. Raises what the user's callback raises."""
        coroutine = None
        try:
            outcome = entity.execute(taken)
            if outcome is not None and isinstance(outcome, CoroutineType):
                coroutine = outcome
                self.run_coroutine(entity, coroutine)
        finally:
            if coroutine is None:
                group = entity.gate
                if group._release_:
                    group._release_()
                else:
                    group.ending_execution(entity)

    def run_coroutine(self, entity: Entity, coroutine: Coroutine[Any, Any, Any]) -> None:
        """Begin with the `coroutine` that the callback of `entity` has returned; its group is busy until it ends."""
        task: Task[Any] = Task(coroutine, executor=self)
        TaskRunner(task, self, entity).execute(task)

    _dispatch = run
    """Run what was taken: here and now, unless there are threads for it."""

    def _run_and_look(self, entity: Entity, taken: Any) -> None:
        """Run it in any thread; whoever spins looks whether something waited for its group."""
        try:
            self.run(entity, taken)
        finally:
            if self._queue_.has_blocked():
                self.wake()

    # Spinning

    @property
    def spinning(self) -> bool:
        """True while any thread spins."""
        return bool(self._spinners.threads)

    @property
    def is_spinning(self) -> bool:
        """True while any thread spins: rclpy's name of `spinning`."""
        return self.spinning

    @property
    def spins_here(self) -> bool:
        """True if the calling thread spins or runs a callback."""
        if threading.get_ident() in self._spinners.threads:
            return True
        return self._runs_here is not None and self._runs_here()

    def _beside_(self, other: Executor) -> AbstractContextManager[None]:
        """Enter a spin by a thread that may be in a callback of another executor, which counts as one here too."""
        return self._spinners.counting_this(other is not self and other.spins_here)

    def spin(self) -> None:
        """Run callbacks until the context or this executor is shut down.

        Raises:
            ExternalShutdownException: if the context ends while this waits. After Ctrl-C it is, in the
                main thread, an InterruptedByUser, which is a KeyboardInterrupt too.
            Exception: what a callback raises.
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
        """Run one callback; wait until one is ready.

        Args:
            timeout_sec: Longest wait in seconds, after which none is run; None or less waits for ever, 0 does not
                wait.

        Raises:
            ExternalShutdownException: if the context has ended. After Ctrl-C, in the main thread, it is
                an InterruptedByUser, which is a KeyboardInterrupt too.
            Exception: what the callback raises.
        """
        self._spin(None if timeout_sec is None else self._waiting.deadline(timeout_sec), once=True)

    def spin_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """Run callbacks until a future is done, the timeout has passed, or the context or this executor has ended.

        Args:
            future: Future to wait for; `future.done()` says whether it came.
            timeout_sec: Longest wait in seconds; None or less waits for ever, 0 does not wait.

        Raises:
            ExternalShutdownException: if the context ends while this waits. After Ctrl-C it is, in the
                main thread, an InterruptedByUser, which is a KeyboardInterrupt too.
            Exception: what a callback raises.
        """
        is_over = watch(future, self.wake)
        if not is_over() and self._context.ok() and not self._is_shutdown:
            spin = self._spin_by_slices if self._is_users_own() else self._spin
            spin(self._waiting.deadline(timeout_sec), is_over)
        if not is_over():
            self._check_interrupt()

    def spin_once_until_future_complete(
        self, future: Future[Any], timeout_sec: float | TimeoutObject | None = None
    ) -> None:
        """Run one callback, or none if a future is done first.

        Args:
            future: Future to wait for.
            timeout_sec: Longest wait in seconds; None or less waits for ever, 0 does not wait.
        """
        self._spin(self._waiting.deadline(timeout_sec), watch(future, self.wake), once=True)

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

    def _spin(self, deadline: int | None = None, stop: Callable[[], bool] | None = None, *, once: bool = False) -> None:
        """Run callbacks until `stop()`, the deadline, or the end of the context or of this executor."""
        # Not a method of SingleThreadedExecutor that calls this one: that call is 4 % of each `spin_once`.
        if self._driver is not None and self._is_spun_by_host(deadline, stop, once=once):
            return
        context, thread = self._context, threading.get_ident()
        threads = self._spinners.threads
        if deadline is None and (threads or self._runs_here is not None) and self.spins_here:
            stop = self._deadlock_warning.watching(stop, self._is_held_here)
        threads.append(thread)
        if self._nodes_.parked is not None:
            self._nodes_.evict()
        wait, dispatch = self._waiting.wait, self._dispatch
        try:
            while True:
                entity, taken = wait(self, deadline, stop)
                dispatch(entity, taken)
                ends = once or self._is_shutdown or not context._ok or (stop is not None and stop())
                if ends or (deadline is not None and context.time.steady() >= deadline):
                    return
        except (TimeoutException, ShutdownException, ConditionReachedException):
            pass
        except KeyboardInterrupt:
            if self._context.terminated:  # a signal's handler broke into the wait, or into a callback
                raise ExternalShutdownException from None
            raise
        finally:
            threads.remove(thread)
            if self._is_shutdown:
                self._spinners.tell()

    def _is_spun_by_host(self, deadline: int | None, stop: Callable[[], bool] | None, *, once: bool) -> bool:
        self._nodes_.evict()
        return not once and self._driver is not None and self._driver.spin(deadline, stop)

    # Waiting within a callback

    def serve_until(self, future: Future[Any], deadline: int | None, *, serving: bool = True) -> None:
        """Wait in a callback for an answer, and run services meanwhile, so that the answer can come: no deadlock.

        Services whose callback group is busy (the waiting callback's own, say) are left alone.

        Args:
            future: Future that the callback waits for.
            deadline: End of the wait, in nanoseconds of steady time; None is never.
            serving: True runs services in this thread; this executor, which has no other, always does.
        """
        while not future.over():
            self.inbox.sweep()
            taken = self._waiting.take(_serves)
            if taken is not None:
                self.run(*taken)
            elif deadline is not None and self._context.time.steady() >= deadline:
                return
            else:
                self.check_end()
                arrival = None if future.over() else self._context.time.wait(self.inbox, deadline)
                if arrival is not None:
                    self.inbox.deliver(arrival)

    def is_last_awake(self) -> bool:
        """Return True in a callback if no other thread of this executor could run one that wakes it."""
        return True

    @contextmanager
    def waiting_for(self, services: Sequence[Entity]) -> Iterator[bool]:
        """Enter a wait for an answer of one of `services`, in a callback; the value is True if it would be a deadlock.

        It would be if the waiting callback itself keeps the group of each of them busy.
        """
        yield bool(services) and not any(map(self.can_execute, services))

    def __enter__(self: ExecutorT) -> ExecutorT:
        return self

    def __exit__(self, *_: object) -> None:
        self.shutdown()


def _serves(entity: Entity) -> bool:
    return entity.serves


class SingleThreadedExecutor(Executor):
    """Executor that runs one callback after the other, in the thread that called `spin`.

    It gives turns as rclpy's does: to tasks, and then in rounds to waitables, and node by node to the timers that are
    due, to one message of each subscription, to guard conditions, clients and services. In an overload nobody starves.

    Args:
        context: Context whose end ends the spinning; None is the default one.
    """

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        self._parks = type(self).__module__.startswith("robolink.")
        """False for a class of the user's own, which may override what is not called for a parked node."""
        # In a host one thread runs the callbacks of all programs, those of a class of the user's own excepted: it may
        # override what the host would not call.
        self._driver = self._context.make_driver(self) if self._parks else None
        if self._driver is not None:
            self._runs_here = self._driver.runs_here

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
        self._waiting.pause, self._waiting.failures = self._threads.pause, self._threads.failures
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
