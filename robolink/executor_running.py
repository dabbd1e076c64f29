"""How an executor runs what was taken: callbacks, the rest of those that are coroutines, and tasks."""

from __future__ import annotations

import inspect
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import TYPE_CHECKING, Any, cast

from robolink.entity import Entity
from robolink.exceptions import ExternalShutdownException, InvalidHandle, RobolinkError
from robolink.executor_queue import ExecutorQueue
from robolink.impl.rcutils_logger import RcutilsLogger
from robolink.logging import get_logger
from robolink.task import Future, Task
from robolink.task_runner import TaskRunner
from robolink.tracebacks import formatted

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.executors import Executor


_HELD = (
    "a callback spins and waits without a timeout_sec: {} is ready, but cannot run before that callback has returned, "
    "since their callback group runs one at a time. Return instead of spinning, give the spin a timeout_sec, or give "
    "one of the two a callback group of its own"
)


class TimeoutException(RobolinkError):  # noqa: N818 - rclpy's name
    """Nothing became ready in time."""


class ShutdownException(RobolinkError):  # noqa: N818 - rclpy's name
    """Nothing more will become ready here: the executor has ended."""


class ConditionReachedException(RobolinkError):  # noqa: N818 - rclpy's name
    """What was waited for has come."""


class TimeoutObject:
    """A number of seconds that may change while somebody waits."""

    def __init__(self, timeout: float) -> None:
        self.timeout = timeout


async def await_or_execute(callback: Callable[..., Any], *args: Any) -> Any:
    """Call a function, or call and await a coroutine function."""
    return await callback(*args) if inspect.iscoroutinefunction(callback) else callback(*args)


class ExecutorRunning(ExecutorQueue):
    """The part of an executor that runs what was taken."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self._spinners: list[int] = []
        self._has_told_of_held = False

    @property
    def spinning(self) -> bool:
        """Whether any thread spins."""
        return bool(self._spinners)

    @property
    def spins_here(self) -> bool:
        """Whether the calling thread is the one, or one of those, that spin: it is inside a callback then."""
        return threading.get_ident() in self._spinners

    @contextmanager
    def _beside_(self, other: Executor | None) -> Iterator[None]:
        """Be spun by a thread that may be in a callback of another executor, which counts as a callback here too."""
        thread = threading.get_ident()
        inside = other is not None and other is not self and other.spins_here
        if inside:
            self._spinners.append(thread)
        try:
            yield
        finally:
            if inside:
                self._spinners.remove(thread)

    def create_task(self, callback: Any, *args: Any, **kwargs: Any) -> Task[Any]:
        """Run a function or coroutine in this executor; its result comes through the task."""
        executor = cast("Executor", self)
        task: Task[Any] = Task(callback, args, kwargs, executor=executor)
        self.post(TaskRunner(task, executor))
        return task

    def create_future(self) -> Future[Any]:
        """Make a future whose done callbacks run in this executor."""
        return Future(executor=cast("Executor", self))

    def _run_and_look(self, entity: Entity, taken: Any) -> None:
        """Run it in any thread; whoever spins looks whether something waited for its group."""
        try:
            self.run(entity, taken)
        finally:
            if self.has_blocked():
                self.wake()

    def has_blocked(self) -> bool:
        """Whether something ready waits for its callback group."""
        with self._lock:
            return bool(self._blocked)

    def _telling_of_held(self, stop: Callable[[], bool] | None) -> Callable[[], bool]:
        """Return `stop`, or never, for a callback that spins without an end: it warns of what waits for that callback.

        Who spins until a future is done is told only of a service that is asked from here: that future may hang on it.
        """

        def tell() -> bool:
            with self._lock:
                waiting = [] if self._has_told_of_held else [each for each in self._blocked if self._is_held_here(each)]
            held = next((each for each in waiting if stop is None or self._is_asked_here(each.origin)), None)
            if held is not None:
                self._has_told_of_held = True
                _logger_of(held).warning(_HELD.format(_named(held.origin)))
            return False

        return tell if stop is None else lambda: stop() or tell()

    def _is_asked_here(self, entity: Entity) -> bool:
        """Whether it is a service whose answer a client of this executor waits for."""
        name = getattr(entity, "srv_name", None)
        return any(each.srv_name == name and each.is_waiting for node in self._nodes for each in node.clients)

    def _is_held_here(self, entity: Entity) -> bool:
        """Return whether a callback under way in this thread keeps the group of an entity busy."""
        return not entity.gate.can_execute(entity)

    def run(self, entity: Entity, taken: Any) -> None:
        """Run what was taken. Raises what the user's callback raises."""
        coroutine = None
        try:
            outcome = entity.execute(taken)
            if outcome is not None and inspect.iscoroutine(outcome):
                coroutine = outcome
                self._run_on(entity, coroutine)
        except (ExternalShutdownException, ShutdownException):  # Ctrl-C in a callback is no fault of it
            raise
        except Exception as error:
            self._log(entity, error)
            raise
        finally:
            if coroutine is None:
                entity.gate.ending_execution(entity)

    def _log(self, entity: Entity, error: Exception) -> None:
        """Log a callback's exception, with its traceback, in the name of its node; once, however often it passes."""
        if getattr(error, "__robolink_logged__", False):
            return
        if isinstance(error, InvalidHandle) and not self._context.ok():
            return  # another thread has ended the context meanwhile
        error.__robolink_logged__ = True  # type: ignore[attr-defined]
        text = formatted(error, _of_the_user(error.__traceback__))
        _logger_of(entity).error(f"an exception in a callback ends the spinning:\n{text}")

    def _run_on(self, entity: Entity, coroutine: Any) -> None:
        """Run a callback that is a coroutine; its group is busy until it ends."""
        executor = cast("Executor", self)
        task: Task[Any] = Task(coroutine, executor=executor)
        TaskRunner(task, executor, entity).execute(task)


def _logger_of(entity: Entity) -> RcutilsLogger:
    owner = entity.origin.node
    return get_logger("robolink") if owner is None else owner.get_logger()


def _named(entity: Entity) -> str:
    kind = type(entity).__name__.lower()
    name = getattr(entity, "topic_name", None) or getattr(entity, "srv_name", None)
    return f"the {kind} of {name}" if name else f"a {kind}"


def _of_the_user(trace: TracebackType | None) -> TracebackType | None:
    """Leave out robolink's own frames at the top of a traceback."""
    first = trace
    while first is not None and first.tb_frame.f_globals.get("__name__", "").startswith("robolink."):
        first = first.tb_next
    return first or trace
