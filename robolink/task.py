"""Futures, and the tasks in which an executor runs what a user gave it, coroutines included."""

from __future__ import annotations

import contextlib
import inspect
import sys
import threading
import warnings
import weakref
from collections.abc import Callable, Generator
from typing import TYPE_CHECKING, Any, Generic, TypeVar

if TYPE_CHECKING:
    import asyncio

    from robolink.executors import Executor

T = TypeVar("T")

_running = threading.local()
"""The task that runs in a thread, and the event loop of asyncio within which it was called, if any."""


class Future(Generic[T]):
    """A result that comes later. Await it in a coroutine of an executor or of asyncio."""

    def __init__(self, *, executor: Executor | None = None) -> None:
        self._done = False
        self._cancelled = False
        self._result: T | None = None
        self._exception: BaseException | None = None
        self._exception_fetched = False
        self._callbacks: list[Callable[[Future[T]], object]] = []
        self._wakers: list[Callable[[], None]] = []
        self._lock = threading.Lock()
        self._executor: Callable[[], Executor | None] = lambda: None
        self.set_executor(executor)

    def __del__(self) -> None:
        if self._exception is not None and not self._exception_fetched:
            warnings.warn(
                f"The following exception was never retrieved: {self._exception}", ResourceWarning, stacklevel=1
            )

    def __await__(self) -> Generator[Any, None, T | None]:
        """Yield until done: to a task of an executor, to asyncio's event loop, or to whoever else drives it."""
        while not self.over():
            task, loop = getattr(_running, "task", None), _asyncio_loop()
            if loop is not None and loop is not getattr(_running, "loop", None):
                yield from _in_asyncio(self, loop)
                continue
            if task is not None:
                task.awaits = self
            yield
        return self.result()

    def cancel(self) -> None:
        """Cancel, unless it is done."""
        with self._lock:
            if self._done:
                return
            self._cancelled = True
        self._schedule_or_invoke_done_callbacks()

    def cancelled(self) -> bool:
        """Whether it was cancelled."""
        return self._cancelled

    def over(self) -> bool:
        """Whether nothing more will come of it: it is done, or was cancelled."""
        return self._done or self._cancelled

    def done(self) -> bool:
        """Whether it has a result or an exception."""
        return self._done

    def result(self) -> T | None:
        """The result, None while there is none. Raises the exception, if it has one."""
        if self._exception is not None:
            raise self._fetched()
        return self._result

    def exception(self) -> BaseException | None:
        """The exception, if it has one."""
        return self._fetched() if self._exception is not None else None

    def _fetched(self) -> BaseException:
        self._exception_fetched = True
        assert self._exception is not None
        return self._exception

    def set_result(self, result: T) -> None:
        """Be done, with a result."""
        with self._lock:
            self._result = result
            self._done, self._cancelled = True, False
        self._schedule_or_invoke_done_callbacks()

    def set_exception(self, exception: BaseException) -> None:
        """Be done, with an exception."""
        with self._lock:
            self._exception, self._exception_fetched = exception, False
            self._done, self._cancelled = True, False
        self._schedule_or_invoke_done_callbacks()

    def add_done_callback(self, callback: Callable[[Future[T]], object]) -> None:
        """Call `callback(future)` when done: in the executor if there is one, else at once where it happens."""
        with self._lock:
            if not self._done:
                self._callbacks.append(callback)
                return
        executor = self._executor()
        if executor is not None:
            executor.create_task(callback, self)
        else:
            callback(self)

    def remove_done_callback(self, callback: Callable[[Future[T]], object]) -> None:
        """Do not call it after all."""
        with self._lock:
            self._callbacks = [each for each in self._callbacks if each != callback]

    def when_done(self, waker: Callable[[], None]) -> None:
        """Call `waker()` at once where it becomes done, in whatever thread; for executors."""
        with self._lock:
            if not (self._done or self._cancelled):
                self._wakers.append(waker)
                return
        waker()

    def forget(self, waker: Callable[[], None]) -> None:
        """Do not call this waker after all."""
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

    def set_executor(self, executor: Executor | None) -> None:
        """Have the done callbacks run in this executor; with None, at once where it becomes done."""
        self._executor = (lambda: None) if executor is None else weakref.ref(executor)


def _asyncio_loop() -> asyncio.AbstractEventLoop | None:
    """Give the event loop that runs in this thread, if there is one."""
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


class Task(Future[T]):
    """A function or coroutine that an executor runs; its result is the future's."""

    def __init__(
        self,
        handler: Any,
        args: tuple[Any, ...] | None = None,
        kwargs: dict[str, Any] | None = None,
        executor: Executor | None = None,
    ) -> None:
        super().__init__(executor=executor)
        self._handler: Any = handler
        self._args, self._kwargs = args or (), kwargs or {}
        if inspect.iscoroutinefunction(handler):
            self._handler = handler(*self._args, **self._kwargs)
            self._args, self._kwargs = (), {}
        self._executing = False
        self._task_lock = threading.Lock()
        self.awaits: Future[Any] | None = None
        """The future that the coroutine stopped at, as far as it is one of ours."""

    def __call__(self) -> None:
        """Run it, or run it on until its next await. Nothing happens when it is done or under way already."""
        if self._done or self._cancelled or self._executing or not self._task_lock.acquire(blocking=False):
            return
        before = getattr(_running, "task", None), getattr(_running, "loop", None)
        try:
            self._executing, self.awaits = True, None
            _running.task, _running.loop = self, _asyncio_loop()
            self._step()
        finally:
            self._executing = False
            _running.task, _running.loop = before
            self._task_lock.release()

    def _step(self) -> None:
        if inspect.iscoroutine(self._handler):
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
        """Whether it runs right now."""
        return self._executing

    def cancel(self) -> None:
        """Cancel; a coroutine is closed."""
        if self._done:
            return
        if inspect.iscoroutine(self._handler) and not self._executing:
            self._handler.close()
        super().cancel()
