"""LaunchService: runs launch descriptions from a program, on an asyncio loop (`launch.LaunchService`)."""

from __future__ import annotations

import threading
from collections.abc import Awaitable, Coroutine, Generator, Iterable
from typing import TYPE_CHECKING, Any

from robolink.launch.ros.launch.bases import Event, LaunchContext, LaunchError
from robolink.launch.ros.launch.events import IncludeLaunchDescription, Shutdown

if TYPE_CHECKING:
    import asyncio

    from robolink.launch.ros.launch.sources import LaunchDescription
    from robolink.launch.ros.service import Runner


class LaunchService:
    """Launcher within a program: it visits launch descriptions, runs their processes, and ends when these have ended.

    In the main thread it handles SIGINT and SIGTERM while it runs; in any other thread it leaves them alone.

    Args:
        argv: Arguments, which actions find as `context.argv`.
        noninteractive: True where no terminal is there. Else the event `Shutdown(due_to_sigint=True)` of a program
            means that its processes have been interrupted already, as Ctrl-C in a terminal does.
        debug: True lets the log have all, and asyncio check more.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False, debug: bool = False) -> None:
        self.__context = LaunchContext(argv=argv, noninteractive=noninteractive)
        self._debug = debug
        self._runner: Runner | None = None
        self._task: asyncio.Task[Any] | None = None
        self._lock = threading.RLock()
        self._thread = 0
        """Identifier of the thread of its loop."""

    @property
    def context(self) -> LaunchContext:
        """The context of the launch."""
        return self.__context

    @property
    def event_loop(self) -> asyncio.AbstractEventLoop | None:
        """The loop that it runs on; None while it does not."""
        return self.__context.asyncio_loop

    @property
    def task(self) -> asyncio.Task[Any] | None:
        """The task of asyncio in which it runs, or ran last."""
        return self._task

    def include_launch_description(self, launch_description: LaunchDescription) -> None:
        """Visit `launch_description`: as soon as it runs, or at once if it does. From any thread."""
        self.emit_event(IncludeLaunchDescription(launch_description))

    def emit_event(self, event: Event) -> None:
        """Emit `event`: it is handled as soon as it runs, or at once if it does. From any thread."""
        self.__context.emit_event_sync(event)

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Run until all has ended.

        Args:
            shutdown_when_idle: False goes on when nothing is left to do, until somebody ends it.

        Returns:
            0, or 1 after an error of the launch or at SIGTERM. What the processes return counts nothing.

        Raises:
            LaunchError: (a RuntimeError) if a loop of asyncio runs in this thread: `await run_async()` there.
        """
        import asyncio

        if _is_in_loop():
            raise LaunchError("a loop of asyncio runs in this thread already: `await run_async()` there")
        loop = asyncio.new_event_loop()
        try:
            task = loop.create_task(self.run_async(shutdown_when_idle=shutdown_when_idle))
            while True:
                try:
                    return loop.run_until_complete(task)
                except KeyboardInterrupt:  # one that comes before or after its own handlers are there
                    continue
        finally:
            _close(loop)

    async def run_async(self, *, shutdown_when_idle: bool = True) -> int:
        """Run until all has ended, on the loop that runs; `shutdown_when_idle` and the result are those of `run`.

        Raises LaunchError if it runs already.
        """
        import asyncio

        from robolink.launch.ros.service import Runner

        with self._lock:
            if self._runner is not None:
                raise LaunchError("this LaunchService runs already: it cannot run twice at one time")
            self._runner = Runner(self.__context, debug=self._debug)
        self._task, self._thread = asyncio.current_task(), threading.get_ident()
        try:
            return await self._runner.run(shutdown_when_idle=shutdown_when_idle)
        finally:
            self._runner = None

    def shutdown(self, force_sync: bool = False) -> Awaitable[None] | None:
        """End the launch in order; of no effect while it does not run. From any thread.

        Args:
            force_sync: True returns None in any case.

        Returns:
            In the loop's own thread something that can be awaited, or not; elsewhere None.
        """
        loop = self.event_loop
        if loop is None or self.__context.is_shutdown:
            return None
        self.__context.emit_event_sync(Shutdown(reason="LaunchService.shutdown() called"))
        return _Done() if not force_sync and self._thread == threading.get_ident() else None


class _Done(Coroutine[Any, Any, None]):
    """Coroutine that is done; unlike one of a function it may be thrown away."""

    def __await__(self) -> Generator[Any, None, None]:
        yield from ()

    def send(self, value: Any) -> None:
        """End: raises StopIteration; `value` is ignored."""
        raise StopIteration

    def throw(self, *error: Any) -> None:
        """Raise the first of `error`."""
        raise error[0]

    def close(self) -> None:
        """Do nothing."""


def _is_in_loop() -> bool:
    """Return whether a loop of asyncio runs in this thread."""
    import asyncio

    try:
        asyncio.get_running_loop()
    except RuntimeError:
        return False
    return True


def _close(loop: asyncio.AbstractEventLoop) -> None:
    """Close a loop, after the end of all tasks that are left there."""
    import asyncio

    left = asyncio.all_tasks(loop)
    for each in left:
        each.cancel()
    if left:
        loop.run_until_complete(asyncio.gather(*left, return_exceptions=True))
    loop.run_until_complete(loop.shutdown_asyncgens())
    loop.run_until_complete(loop.shutdown_default_executor())
    loop.close()
