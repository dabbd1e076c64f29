"""Pump of an AsyncNode: it runs the callbacks that are ready as tasks, on the event loop that asyncio runs.

It has the ready queue of an executor, and stands in an executor's place for the node's entities. An executor waits for
what becomes ready; a pump is roused instead, by `call_soon_threadsafe`, and looks once at all that is ready.
"""

from __future__ import annotations

import asyncio
import inspect
import threading
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink.exceptions import BlockingCallError
from robolink.experimental.loops import call_at
from robolink.logging import get_logger
from robolink.running.entity import NOTHING, Entity
from robolink.running.ready_queue import ReadyQueue, earlier
from robolink.system.waits import A_WHILE
from robolink.task import Future

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.experimental.groups import TaskGroup
    from robolink.node import BaseNode

ASK_NS = int(A_WHILE * 1e9)
"""Longest time, in nanoseconds, until a program's own Waitable is asked again if it is ready."""

STAYS = 1.0
"""Time in seconds after which callbacks are named that go on though the node has ended."""


class Pump:
    """Runs the callbacks of one node on the running event loop, until `close`.

    Args:
        node: Node whose entities are attached.
        group: Entered task group: each callback is one of its tasks, so that what one raises ends it.
    """

    parallel = True
    """Callbacks go on while another one awaits something."""

    def __init__(self, node: BaseNode, group: TaskGroup) -> None:
        self._node, self._group = node, group
        self._context = node.context
        self.loop = asyncio.get_running_loop()
        self.thread = threading.get_ident()
        self._steady = self._context.time.steady
        self.inbox = self._context.make_loop_inbox(self._rouse)
        self._queue_: ReadyQueue[Entity] = ReadyQueue(self.inbox, self._steady)
        """Ready queue: what is ready, and what will be."""
        self._running: dict[asyncio.Task[None], Entity] = {}
        """Callbacks under way, in the order in which they began."""
        self._is_roused = self._is_closed = False
        self._alarm: asyncio.TimerHandle | None = None
        self._attach_node()

    def _attach_node(self) -> None:
        node = self._node
        with self._queue_.lock:
            node._belong_to_(self)
            for entity in node._entity_store_.entities():
                entity.attach(self)
        self._rouse()

    # What entities see, as of an executor

    @property
    def context(self) -> Context:
        """Context of the node."""
        return self._context

    @property
    def spinning(self) -> bool:
        """True until the end."""
        return not self._is_closed

    @property
    def spins_here(self) -> bool:
        """True in the thread of the event loop."""
        return threading.get_ident() == self.thread

    def get_nodes(self) -> list[BaseNode]:
        """Return the node."""
        return [self._node]

    def attach(self, entity: Entity) -> None:
        """Run the callback of `entity` from now on."""
        with self._queue_.lock:
            entity.attach(self)
        self._rouse()

    def remove_node(self, node: BaseNode) -> None:
        """Run no callback any more: the node is destroyed."""
        with self._queue_.lock:
            for entity in node._entity_store_.entities():
                entity.detach()
            node._belong_to_(None)
        self.close()

    def create_task(self, callback: Any, *args: Any, **kwargs: Any) -> _Work:
        """Run a function or coroutine as a task of the node, from any thread; return the future of its result."""
        work = _Work(callback, args, kwargs)
        runner = _WorkRunner(self, work)
        if not self._is_closed:
            self._queue_.post(runner)
        return work

    def serve_until(self, future: Future[Any], deadline: int | None, *, serving: bool = True) -> None:
        """Raise BlockingCallError: the event loop cannot wait in the middle of a callback."""
        raise BlockingCallError

    def waiting_for(self, services: Sequence[Any]) -> AbstractContextManager[bool]:
        """Raise BlockingCallError: the event loop cannot wait in the middle of a callback."""
        raise BlockingCallError

    def is_last_awake(self) -> bool:
        """Return True: the event loop has one thread."""
        return True

    # Running

    def _rouse(self) -> None:
        """Look soon at what is ready; from any thread."""
        if self._is_roused or self._is_closed:
            return
        self._is_roused = True
        if self.spins_here and not self.loop.is_closed():
            self.loop.call_soon(self._look)
        else:
            call_at(self.loop, self._look)

    def _look(self) -> None:
        """Begin the callbacks that are ready and that their groups let run."""
        self._is_roused = False  # first: what becomes ready from here on rouses again
        if self._is_closed:
            return
        queue = self._queue_
        self.inbox.sweep()
        if queue.pollables:
            queue.poll()
        queue.collect_due()
        while not self._is_closed:  # a callback may end it, where tasks are eager
            taken = queue.take()
            if taken is None:
                break
            self._begin(*taken)
        due = queue.collect_due()
        if queue.ready:
            self._rouse()
        self._set_alarm(earlier(due, self._steady() + ASK_NS) if queue.pollables else due)

    def _set_alarm(self, due: int | None) -> None:
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None
        if due is not None:
            self._alarm = self.loop.call_later(max(0, due - self._steady()) / 1e9, self._look)

    def _begin(self, entity: Entity, taken: Any) -> None:
        if entity.quick:
            try:
                entity.execute(taken)
            finally:
                entity.gate.ending_execution(entity)
            return
        task = self._group.create_task(self._run(entity, taken))
        self._running[task] = entity
        task.add_done_callback(self._forget)

    async def _run(self, entity: Entity, taken: Any) -> None:
        try:
            outcome = entity.execute(taken)
            if inspect.iscoroutine(outcome):
                await outcome
        except (asyncio.CancelledError, GeneratorExit):  # the second, if its loop went away without it
            raise
        except BaseException:
            self.close()  # the task group ends: it takes no task any more
            raise

    def _forget(self, task: asyncio.Task[None]) -> None:
        # Not at the end of `_run`: a task that is cancelled before its first step never comes there.
        entity = self._running.pop(task)
        entity.gate.ending_execution(entity)
        if self._queue_.has_blocked():
            self._rouse()

    def cancel(self, entity: Entity) -> None:
        """Cancel the callbacks of `entity` that are under way, from any thread."""
        if self.spins_here and not self.loop.is_closed():
            for task in [task for task, each in self._running.items() if each is entity]:
                task.cancel()
        elif not self._is_closed:
            call_at(self.loop, self.cancel, entity)

    def close(self) -> None:
        """Begin no callback any more, and cancel those under way; from any thread."""
        if not self.spins_here:
            if not self._is_closed:
                call_at(self.loop, self.close)
            return
        if self._is_closed:
            return
        self._is_closed = True
        if self._alarm is not None:
            self._alarm.cancel()
        self.inbox.close()
        if self.loop.is_closed():
            return
        for task in list(self._running):
            task.cancel()
        if self._running:
            self._alarm = self.loop.call_later(STAYS, self._tell_who_stays)

    def _tell_who_stays(self) -> None:
        """Warn of callbacks that go on after they were cancelled: the end of the node waits for them."""
        for task in self._running:
            where = getattr(getattr(task.get_coro(), "cr_await", None), "cr_frame", None)
            if where is not None:
                place = f"{Path(where.f_code.co_filename).name}:{where.f_lineno}"
                name = self._node.get_name()
                what = f"{where.f_code.co_name} ({place}) is still running: it was cancelled, and goes on"
                get_logger(name).warning(f"the end of node {name} waits for a callback: {what}")


class _Work(Future[Any]):
    """Future of a function or coroutine that runs as a task of a node."""

    def __init__(self, callback: Any, args: tuple[Any, ...], kwargs: dict[str, Any]) -> None:
        super().__init__()
        self._callback, self._args, self._kwargs = callback, args, kwargs
        self.abandon: Callable[[], None] | None = None
        """Function that cancels the task, while it runs."""

    async def run(self) -> None:
        """Run it to its end, and complete the future; raise what it raises."""
        try:
            outcome = self._callback
            if callable(outcome):
                outcome = outcome(*self._args, **self._kwargs)
            result = await outcome if inspect.iscoroutine(outcome) else outcome
        except asyncio.CancelledError:
            super().cancel()
            raise
        except BaseException as error:
            self.set_exception(error)
            self._exception_fetched = True  # it is raised by the task group
            raise
        self.set_result(result)

    def cancel(self) -> None:
        """Cancel it, unless it is done; a coroutine that runs is cancelled where it awaits."""
        if self._done:
            return
        if self.abandon is not None:
            self.abandon()
        elif inspect.iscoroutine(self._callback):
            self._callback.close()
        super().cancel()


class _WorkRunner(Entity):
    """Runs one piece of work, once."""

    def __init__(self, pump: Pump, work: _Work) -> None:
        super().__init__()
        self._pump, self._work = pump, work

    def take(self) -> Any:
        """Return the work."""
        if self._work.over():
            return NOTHING
        self._work.abandon = lambda: self._pump.cancel(self)
        return self._work

    def execute(self, taken: _Work) -> Any:
        """Run it."""
        return taken.run()
