"""Futures, and tasks: functions and coroutines that an executor runs, whose result is a future."""

from __future__ import annotations

import contextlib
import sys
import threading
import warnings
import weakref
from collections.abc import Callable, Generator
from types import CoroutineType
from typing import TYPE_CHECKING, Any, Generic, Protocol, TypeVar

from robolink.system.terminal import fit

if TYPE_CHECKING:
    import asyncio

T = TypeVar("T")

_running = threading.local()
"""The task that runs in a thread, and the event loop of asyncio within which it was called, if any."""


class TaskExecutor(Protocol):
    """Executor as seen by a future: where its done callbacks run."""

    def create_task(self, callback: Any, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run the function or coroutine `callback` there, with `args` and `kwargs`."""


class Future(Generic[T]):
    """Result that comes later. Await it in a coroutine of an executor or of asyncio.

    Args:
        executor: Executor that runs the done callbacks; None runs them at once where the future becomes done.
    """

    def __init__(self, *, executor: TaskExecutor | None = None) -> None:
        self._done = False
        self._cancelled = False
        self._result: T | None = None
        self._exception: BaseException | None = None
        self._exception_fetched = False
        self._callbacks: list[Callable[[Future[T]], object]] = []
        self._wakers: list[Callable[[], None]] = []
        self._lock = threading.Lock()
        self._executor: Callable[[], TaskExecutor | None] = lambda: None
        self.set_executor(executor)

    def __del__(self) -> None:
        if self._exception is not None and not self._exception_fetched and sys.stderr is not None:
            text = fit(str(self._exception))
            print(f"The following exception was never retrieved: {text}", file=sys.stderr)  # noqa: T201 - as rclpy does

    def __await__(self) -> Generator[Any, None, T | None]:
        """Yield until done: to a task of an executor, to asyncio's event loop, or to whoever else drives it."""
        while not self.over():
            task, loop = getattr(_running, "task", None), asyncio_loop()
            if loop is not None and loop is not getattr(_running, "loop", None):
                yield from _in_asyncio(self, loop)
                continue
            if task is not None:
                task.awaits = self
            yield
        return self.result()

    def cancel(self) -> None:
        """Cancel the future, unless it is done."""
        with self._lock:
            if self._done:
                return
            self._cancelled = True
        self._schedule_or_invoke_done_callbacks()

    def cancelled(self) -> bool:
        """True if the future was cancelled."""
        return self._cancelled

    def over(self) -> bool:
        """True if the future is done, or was cancelled."""
        return self._done or self._cancelled

    def done(self) -> bool:
        """True if the future has a result or an exception."""
        return self._done

    def result(self) -> T | None:
        """Return the result, None while there is none. Raises the exception, if it has one."""
        if self._exception is not None:
            raise self._fetched()
        return self._result

    def exception(self) -> BaseException | None:
        """Return the exception, None if there is none."""
        return self._fetched() if self._exception is not None else None

    def _fetched(self) -> BaseException:
        self._exception_fetched = True
        assert self._exception is not None
        return self._exception

    def set_result(self, result: T) -> None:
        """Complete the future with `result`."""
        with self._lock:
            self._result = result
            self._done, self._cancelled = True, False
        self._schedule_or_invoke_done_callbacks()

    def set_exception(self, exception: BaseException) -> None:
        """Complete the future with `exception`, which `result` then raises."""
        with self._lock:
            self._exception, self._exception_fetched = exception, False
            self._done, self._cancelled = True, False
        self._schedule_or_invoke_done_callbacks()

    def add_done_callback(self, callback: Callable[[Future[T]], object]) -> None:
        """Call `callback(future)` when the future is done: in its executor, without one at once where that happens."""
        with self._lock:
            if not self._done:
                self._callbacks.append(callback)
                return
        executor = self._executor()
        if executor is not None:
            executor.create_task(callback, self)
        else:
            callback(self)

    def remove_done_callback(self, callback: Callable[[Future[T]], object]) -> bool:
        """Remove a done `callback`, and return True; False if it was not added."""
        with self._lock:
            before, self._callbacks = self._callbacks, [each for each in self._callbacks if each != callback]
            return len(self._callbacks) < len(before)

    def when_done(self, waker: Callable[[], None]) -> None:
        """Call `waker()` at once where the future becomes done, in whatever thread; for executors."""
        with self._lock:
            if not (self._done or self._cancelled):
                self._wakers.append(waker)
                return
        waker()

    def forget(self, waker: Callable[[], None]) -> None:
        """Remove a `waker`; one that was not added is ignored."""
        with self._lock:
            self._wakers = [each for each in self._wakers if each is not waker]

    def _schedule_or_invoke_done_callbacks(self) -> None:
        with self._lock:
            callbacks, self._callbacks = self._callbacks, []
            wakers, self._wakers = self._wakers, []
        for wake in wakers:
            wake()
        executor = self._executor()
        for callback in callbacks:
            if executor is not None:
                executor.create_task(callback, self)
                continue
            try:
                callback(self)
            except Exception as error:  # noqa: BLE001 - somebody else's callback must not break whoever set the result
                warnings.warn(f"Unhandled exception in done callback: {error}", stacklevel=2)

    def set_executor(self, executor: TaskExecutor | None) -> None:
        """Run the done callbacks in `executor` from now on; with None, at once where the future becomes done."""
        self._executor = (lambda: None) if executor is None else weakref.ref(executor)


def watch(future: Any, waker: Callable[[], None]) -> Callable[[], bool]:
    """Return the function that tells whether a future is over, and call `waker()` when it is.

    Args:
        future: Future of any kind: asyncio's and those of concurrent.futures, too.
        waker: Function that is called in whatever thread that happens.
    """
    if isinstance(future, Future):
        future.when_done(waker)
        return future.over
    future.add_done_callback(lambda _: waker())
    is_over: Callable[[], bool] = future.done
    return is_over


def asyncio_loop() -> asyncio.AbstractEventLoop | None:
    """Return the event loop that runs in this thread, if there is one."""
    running = getattr(sys.modules.get("asyncio"), "_get_running_loop", None)  # where it was not imported, no loop runs
    return None if running is None else running()


def _in_asyncio(future: Future[Any], loop: asyncio.AbstractEventLoop) -> Generator[Any, None, None]:
    """Let asyncio sleep until the future is over, in whatever thread that happens."""
    woken = loop.create_future()

    def wake() -> None:
        with contextlib.suppress(RuntimeError):  # the loop is closed: nobody waits there any more
            loop.call_soon_threadsafe(_complete, woken)

    future.when_done(wake)
    try:
        yield from woken
    finally:
        future.forget(wake)


def _complete(woken: asyncio.Future[None]) -> None:
    if not woken.done():  # cancelled
        woken.set_result(None)


def _makes_coroutines(handler: Any) -> bool:
    import inspect  # late: it takes a node's start 5 ms, and a callback that is a coroutine is known without

    return inspect.iscoroutinefunction(handler)


class Task(Future[T]):
    """Function or coroutine that an executor runs; its result is that of the future.

    Args:
        handler: Function, coroutine function or coroutine.
        args: Positional arguments of a function; None is none.
        kwargs: Keyword arguments of a function; None is none.
        executor: Executor that runs the done callbacks; None runs them at once where the task becomes done.
    """

    def __init__(
        self,
        handler: Any,
        args: tuple[Any, ...] | None = None,
        kwargs: dict[str, Any] | None = None,
        executor: TaskExecutor | None = None,
    ) -> None:
        super().__init__(executor=executor)
        self._handler: Any = handler
        self._args, self._kwargs = args or (), kwargs or {}
        if not isinstance(handler, CoroutineType) and _makes_coroutines(handler):
            self._handler = handler(*self._args, **self._kwargs)
            self._args, self._kwargs = (), {}
        self._executing = False
        self._task_lock = threading.Lock()
        self.awaits: Future[Any] | None = None
        """Future that the coroutine awaits, if it is one of this kind."""

    def __call__(self) -> None:
        """Run the function, or the coroutine up to its next await; nothing if the task is done or runs already."""
        if self._done or self._cancelled or self._executing or not self._task_lock.acquire(blocking=False):
            return
        before = getattr(_running, "task", None), getattr(_running, "loop", None)
        try:
            self._executing, self.awaits = True, None
            _running.task, _running.loop = self, asyncio_loop()
            self._step()
        finally:
            self._executing = False
            _running.task, _running.loop = before
            self._task_lock.release()

    def _step(self) -> None:
        if isinstance(self._handler, CoroutineType):
            try:
                self._handler.send(None)
            except StopIteration as end:
                self._finish(result=end.value)
            except Exception as error:  # noqa: BLE001 - it is the task's result
                self._finish(error=error)
            return
        try:
            result = self._handler(*self._args, **self._kwargs)
        except Exception as error:  # noqa: BLE001 - it is the task's result
            self._finish(error=error)
        else:
            self._finish(result=result)

    def _finish(self, result: Any = None, error: BaseException | None = None) -> None:
        if error is not None:
            self.set_exception(error)
        else:
            self.set_result(result)
        self._handler, self._args, self._kwargs = None, (), {}

    def executing(self) -> bool:
        """True while the task runs."""
        return self._executing

    def cancel(self) -> None:
        """Cancel the task, unless it is done; a coroutine is closed."""
        if self._done:
            return
        if isinstance(self._handler, CoroutineType) and not self._executing:
            self._handler.close()
        super().cancel()
