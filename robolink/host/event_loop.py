"""Event loop of asyncio in a hosted program: its waits are waits of the host's scheduler, so its time is virtual.

Sockets and pipes in such a loop are real. They are polled, and while one of them is connected, time goes no faster than
the computer's (`host/real_waits.py`), since whoever is at its other end has real time.
"""

from __future__ import annotations

import asyncio
import contextlib
import inspect
import itertools
import os
import selectors
import socket
import sys
from collections.abc import Callable, Iterator
from contextvars import Context
from typing import Any

from robolink.exceptions import InterruptedByUser
from robolink.host.call_sites import note_use
from robolink.host.participants import HostedInbox, Killed, ProgramLike, runner_of

SOCKETS = "asyncio socket"
"""Entry in the record of real time for a socket or a pipe in an event loop."""

FREE_TURNS = 1000
"""Turns of a loop without a wait, after which each takes the time of a poll: `while True: await asyncio.sleep(0)`."""


_RUNNERS = f"asyncio{os.sep}runners.py"
"""End of the path of the file with `asyncio.run`."""


class HostedTask(asyncio.Task[Any]):
    """Task with a number of its loop: its name and its hash, so that sets of tasks have the same order each time."""

    def __init__(self, coroutine: Any, number: int, *, loop: Any, name: str | None = None, **options: Any) -> None:
        self._number = number  # first: the task is put into a set while it is made
        super().__init__(coroutine, loop=loop, name=name or f"Task-{number}", **options)

    def __hash__(self) -> int:
        return self._number

    def set_name(self, value: object) -> None:
        """Rename it."""
        if value is not None:  # as Python 3.13.0 would have it, for a task of a factory
            super().set_name(value)


class HostedLoop(asyncio.SelectorEventLoop):
    """Event loop of a program, in virtual time."""

    def __init__(self, program: ProgramLike) -> None:
        self._program, self._life = program, program.defaults
        self.inbox = HostedInbox(program.host.scheduler.due, is_executors=False)
        selector = HostedSelector(program, self.inbox)
        super().__init__(selector)
        selector.keep_to_itself()
        self.abandon = selector.abandon
        """Function that ends its connections, as the end of a process does."""
        program.loops.add(self)
        numbers = itertools.count(1)
        self.set_task_factory(lambda loop, each, **options: HostedTask(each, next(numbers), loop=loop, **options))
        self._clock_resolution = 1e-9  # Windows' 16 ms would let callbacks come so much too early

    def time(self) -> float:
        """Return the program's steady time in seconds."""
        return self._program.time.steady() / 1e9

    def call_soon_threadsafe(  # type: ignore[override] # the types of `args` go by those of `callback`
        self, callback: Callable[..., object], *args: Any, context: Context | None = None
    ) -> asyncio.Handle:
        """Call `callback(*args)` in the next turn of the loop, from any thread."""
        if self.get_debug():  # `call_soon` would not have it from another thread
            handle = super().call_soon_threadsafe(callback, *args, context=context)
        else:
            handle = self.call_soon(callback, *args, context=context)
        if not self.inbox.queued:
            self.inbox.wake()
        return handle

    def run_until_complete(self, future: Any) -> Any:
        """Run until a future or a coroutine is done; return its result.

        When the program is interrupted, `asyncio.run` has the main task cancelled first, as it does since Python 3.11.
        """
        if not sys._getframe(1).f_code.co_filename.endswith(_RUNNERS):
            return super().run_until_complete(future)
        main = asyncio.ensure_future(future, loop=self)
        try:
            return super().run_until_complete(main)
        except InterruptedByUser as interrupt:
            if not main.cancel():
                raise
            try:
                return super().run_until_complete(main)
            except asyncio.CancelledError:
                raise interrupt from None

    def add_signal_handler(  # type: ignore[override] # the same
        self, sig: int, callback: Callable[..., object], *args: Any
    ) -> None:
        """Call `callback(*args)` in the loop when the program gets this signal; SIGINT is the only one that comes."""
        if inspect.iscoroutine(callback) or inspect.iscoroutinefunction(callback):
            raise TypeError("coroutines cannot be used with add_signal_handler()")
        self._program.handlers[sig] = lambda number, frame: self.call_soon_threadsafe(callback, *args)

    def remove_signal_handler(self, sig: int) -> bool:
        """Restore the default effect of a signal. Return True if it had a handler."""
        return self._program.handlers.pop(sig, None) is not None

    def run_forever(self) -> None:
        """Run until `stop`, or the end of the program: of one that is killed no task has a turn any more."""
        try:
            super().run_forever()
        except Killed:
            for each in sorted(asyncio.all_tasks(self), key=hash):
                with contextlib.suppress(BaseException):  # of whatever its `finally` clauses do
                    each.get_coro().close()
            raise

    def call_exception_handler(self, context: dict[str, Any]) -> None:
        """Handle an error that nobody else does; what an ended program leaves behind is none."""
        if not self._is_dead():
            super().call_exception_handler(context)

    def _is_dead(self) -> bool:
        return self._program.is_over or self._program.defaults is not self._life

    def __del__(self) -> None:
        if not self.is_closed() and self._is_dead():
            self.close()  # else it would warn that nobody closed it
        super().__del__()


class HostedSelector(selectors.DefaultSelector):
    """Selector of a program's loop, which waits in virtual time, and polls what is real."""

    def __init__(self, program: ProgramLike, inbox: HostedInbox) -> None:
        super().__init__()
        self._program, self._inbox = program, inbox
        self._own: set[int] = set()
        """The loop's own sockets, by which it would be woken in real time."""
        self._real: set[int] = set()
        self._connected: set[int] = set()
        """Those of the real ones at which no server waits for connections."""
        self._turns = 0

    def keep_to_itself(self) -> None:
        """Take what is registered now as the loop's own."""
        self._own, self._real, self._connected = self._real, set(), set()

    def register(self, fileobj: Any, events: int, data: Any = None) -> selectors.SelectorKey:
        """Register a socket or a pipe, and note it as a use of real time."""
        key = super().register(fileobj, events, data)
        if key.fd not in self._own:
            self._real.add(key.fd)
            if not _is_listening(key.fd):
                self._connected.add(key.fd)
            if self._own:
                note_use(self._program, SOCKETS, sys._getframe(1))
        return key

    def unregister(self, fileobj: Any) -> selectors.SelectorKey:
        """Unregister it."""
        key = super().unregister(fileobj)
        self._real.discard(key.fd)
        self._connected.discard(key.fd)
        return key

    def abandon(self) -> None:
        """End all connections and serve no more; whoever has the sockets closes them, sooner or later."""
        for fd in sorted(self._real):
            with contextlib.suppress(OSError), _socket_of(fd) as each:
                each.shutdown(socket.SHUT_RDWR)

    @property
    def holds_time(self) -> bool:
        """True while something is connected: time then goes no faster than the computer's."""
        return bool(self._connected)

    def is_ready(self) -> bool:
        """Return True, and wake the loop, if something is ready."""
        is_ready = bool(super().select(0))
        if is_ready:
            self._inbox.wake()
        return is_ready

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        """Let the others go on until the loop is woken, for so many virtual seconds at most."""
        runner = runner_of(self._program)
        if runner is None:  # a thread that the host does not know
            return super().select(timeout)
        if runner.killed:
            raise Killed
        if self._real and (ready := super().select(0)):
            return ready
        if timeout is not None and timeout <= 0:
            self._take_turn()
            return []
        self._turns = 0
        scheduler, time = self._program.host.scheduler, self._program.time
        until = None if timeout is None else time.on_base(time.steady() + round(timeout * 1e9))
        if not self._real:
            scheduler.wait(inbox=self._inbox, until=until)
            return []
        with scheduler.real_waits.including(self):
            scheduler.wait(inbox=self._inbox, until=until)
        return super().select(0)

    def _take_turn(self) -> None:
        """Let the others go on if the loop has something to do again and again."""
        self._turns += 1
        if self._turns > FREE_TURNS:
            self._program.time.pass_on()


@contextlib.contextmanager
def _socket_of(fd: int) -> Iterator[socket.socket]:
    """Yield an object for the socket of a descriptor, which it does not close. Raises OSError for a pipe, say."""
    made = socket.socket(fileno=fd)
    try:
        yield made
    finally:
        made.detach()


def _is_listening(fd: int) -> bool:
    """Return True for a socket at which a server waits for connections."""
    with contextlib.suppress(OSError), _socket_of(fd) as found:
        return bool(found.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN))
    return False
