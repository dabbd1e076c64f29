"""A context: the transport, the clock, the domain and the arguments that its nodes share."""

from __future__ import annotations

import _thread
import contextlib
import itertools
import os
import queue
import sys
import threading
import time
import weakref
from collections.abc import Callable
from types import MethodType
from typing import TYPE_CHECKING, Any

from robolink import humble, signals
from robolink.arguments import Arguments, parse_arguments
from robolink.defaults import get_defaults
from robolink.exceptions import NotInitializedException, RobolinkError, imported_as
from robolink.given_parameters import GivenParameters
from robolink.inbox import Inbox, Sweeper
from robolink.timebase import SystemTime, TimeBase

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from robolink.executors import SingleThreadedExecutor
    from robolink.graph import Graph
    from robolink.transport.base import Transport

LAST_DOMAIN = 232
"""ROS 2's domain ids end here."""

TOLD_WITHIN = 2.0
"""Seconds in which whoever is told of the end must have done with it, before the network is left."""


class ContextError(RobolinkError, RuntimeError):
    """A context was initialized twice, shut down too early, or given an impossible domain."""


class Context:
    """What belongs together: the nodes of one context share a session on the network and a clock.

    `transport` is ``zenoh`` (the default; also set by ROBOLINK_TRANSPORT), ``memory`` or a transport that exists
    already; `time` is the system's time by default, or a VirtualTime.
    """

    executor_type: type[SingleThreadedExecutor] | None = None
    """What a `SingleThreadedExecutor` of this context is, if that is another class."""

    def __new__(cls, *_: object, **__: object) -> Context:
        """Make one of the kind that the program has whose code this is: see `robolink.oneprocess`."""
        own = get_defaults().context_type if cls is Context else None
        return super().__new__(own or cls)

    def __init__(self, *, transport: str | Transport | None = None, time: TimeBase | None = None) -> None:
        self.time: TimeBase = time or SystemTime()
        self.arguments = Arguments()
        self.given_parameters = GivenParameters()
        self.interrupted = False
        """Whether a signal ended this context."""
        self.speaks_humble = False
        """Whether everything of this context is on the wire as Humble says it."""
        self.inbox = self.make_inbox(parked=True)
        """Where arrivals wait for entities that no executor has."""
        self._wanted = transport
        self._transport: Transport | None = None
        self._graph: Graph | None = None
        self._sweeper = Sweeper()
        self._ids = itertools.count()
        self._lock = threading.RLock()
        self._initialized = self._ok = self._closed = False
        self._domain_id = 0
        self._callbacks: list[Callable[[], Any]] = []
        self._teller = 0
        self._told: queue.SimpleQueue[None] = queue.SimpleQueue()
        self._nodes: weakref.WeakValueDictionary[int, Any] = weakref.WeakValueDictionary()  # in the order of making

    def init(
        self, args: list[str] | None = None, *, initialize_logging: bool = True, domain_id: int | None = None
    ) -> None:
        """Make it ok. `args` are a command line, sys.argv by default; the domain comes from ROS_DOMAIN_ID.

        Raises ContextError (a RuntimeError) the second time or for a domain id that cannot be, DistroError (a
        ValueError) for an unknown ROBOLINK_ROS_DISTRO, and what `parse_arguments` raises.
        """
        with self._lock:
            if self._initialized:
                raise ContextError("Context.init() must only be called once")
            self._domain_id = _domain_id(domain_id)
            self.speaks_humble = humble.is_asked_for(os.environ)
            self.arguments = parse_arguments(sys.argv if args is None else args)
            if initialize_logging:
                self._configure_logging()
            self._initialized = self._ok = True
        signals.watch(self)

    def _configure_logging(self) -> None:
        from robolink import logging
        from robolink.impl.log_output import Console

        logging.initialize()
        if self.time.virtual and not self.time.hosted:
            logging.set_time_source(self.time.now)
        for name, level in self.arguments.log_levels:
            logging.set_logger_level(name, level)
        if self.arguments.stdout_logs is not None:
            logging.set_console_handler(Console() if self.arguments.stdout_logs else None)

    # What nodes share

    @property
    def transport(self) -> Transport:
        """The session on the network, opened when it is first needed. Raises TransportError when that fails."""
        with self._lock:
            if self._closed or not self._initialized:
                raise NotInitializedException(ended_by=self.ended_by)
            if self._transport is None:
                from robolink.transport import connect

                wanted = self._wanted or os.environ.get("ROBOLINK_TRANSPORT") or "zenoh"
                self._transport = connect(wanted, self._domain_id)
                self._sweeper.add(self.inbox)
            return self._transport

    @property
    def graph(self) -> Graph:
        """What everybody on this domain announces."""
        with self._lock:
            if self._graph is None:
                from robolink.graph import Graph

                self._graph = Graph(self.transport, self._domain_id)
                self.on_shutdown(self._graph.wake)
            if self._closed and not self._graph.settled:  # what was there before can be asked no more
                raise NotInitializedException(ended_by=self.ended_by)
            return self._graph

    def wait_until(self, is_there: Callable[[], bool], timeout_sec: float | None) -> bool:
        """Wait until `is_there()` is true of the graph, or the context ends; whether it is true then.

        In virtual time nobody comes while this thread waits, the seconds are over at once; unless a host runs others.
        """
        if self.time.hosted or (self.time.virtual and timeout_sec is not None):
            until = None if timeout_sec is None else self.time.steady() + int(timeout_sec * 1e9)
            self.time.wait_until(lambda: is_there() or not self.ok(), until)
        else:
            self.graph.wait_for(lambda: is_there() or not self.ok(), timeout_sec)
        return is_there()

    def make_inbox(self, *, parked: bool = False) -> Inbox:
        """Make what an executor of this context waits at; `parked` for what waits while no executor has it."""
        return Inbox()

    def make_pool(self, size: int) -> Executor:
        """Make the threads in which callbacks of a multi-threaded executor run."""
        from concurrent.futures import ThreadPoolExecutor  # late: it takes some milliseconds

        return ThreadPoolExecutor(size, thread_name_prefix="robolink callbacks")

    def next_id(self) -> str:
        """An id for a node or endpoint: the next number of one counter, as text, since the wire knows no numbers."""
        return str(next(self._ids))

    def look_after(self, inbox: Inbox) -> None:
        """See to it that nothing piles up in an inbox while its owner is busy."""
        if self.transport.threaded:
            self._sweeper.add(inbox)

    def let_go(self, inbox: Inbox) -> None:
        """Look after it no longer."""
        self._sweeper.remove(inbox)

    def get_domain_id(self) -> int:
        """Give the domain: 0 to 232."""
        if not self._initialized:
            raise NotInitializedException()
        return self._domain_id

    def track_node(self, node: Any) -> None:
        """Remember a node, to destroy it when the context ends."""
        self._nodes[id(node)] = node

    def untrack_node(self, node: Any) -> None:
        """Forget it."""
        self._nodes.pop(id(node), None)

    # The end

    def ok(self) -> bool:
        """Whether it is initialized and has not ended."""
        return self._ok

    @property
    def closed(self) -> bool:
        """Whether `shutdown` has been called, which destroys the nodes and leaves the network."""
        return self._closed

    @property
    def ended_by(self) -> str:
        """What has ended it, in words; '' when it has not begun or not ended."""
        if self.interrupted:
            return "a signal (Ctrl-C or SIGTERM)"
        return f"{imported_as()}.shutdown()" if self._closed else ""

    def interrupt(self) -> None:
        """End the spinning, as Ctrl-C does, but stay connected: a program may still send its last words.

        A signal's handler may call this at any moment, within anything that the main thread does: whoever wants to
        know of the end is told on a thread of its own, since the main thread may hold the very lock that it needs.
        """
        if not self._ok:
            return
        self.interrupted = True
        self._ok = False
        _thread.start_new_thread(self._tell_now, ())  # threading's own start has locks, too

    def _tell_now(self) -> None:
        self._teller = _thread.get_ident()
        try:
            self._tell()
        finally:
            self._told.put(None)

    def shutdown(self) -> None:
        """End it: spinning stops and the network is left. Raises ContextError (RuntimeError) when it is not there."""
        with self._lock:
            if not self._initialized or self._closed:
                raise ContextError("Context must be initialized before it can be shutdown")
            was_ok, self._ok, self._closed = self._ok, False, True
        if was_ok:
            self._tell()
        elif self.interrupted and self._teller != _thread.get_ident():
            with contextlib.suppress(queue.Empty):
                self._told.get(timeout=TOLD_WITHIN)
        self._close()

    def try_shutdown(self) -> None:
        """End it, if it has not ended yet."""
        if self._initialized and not self._closed:
            self.shutdown()

    def destroy(self) -> None:
        """Leave the network, whatever the state."""
        self.try_shutdown()

    def _tell(self) -> None:
        with self._lock:
            callbacks, self._callbacks = self._callbacks, []
        for callback in callbacks:
            method = callback() if isinstance(callback, weakref.WeakMethod) else callback
            if method is not None:
                method()

    def _close(self) -> None:
        try:
            for node in list(self._nodes.values()):
                node.destroy_node()
            self.given_parameters.warn_of_rest()
        finally:  # a node's own destroy_node is anybody's code
            with self._lock:
                transport, self._transport = self._transport, None
            self._sweeper.close()
            if self.time.virtual and not self.time.hosted:
                from robolink import logging

                logging.set_time_source(time.time_ns)
            if transport is not None:
                transport.close()

    def on_shutdown(self, callback: Callable[[], Any]) -> None:
        """Call `callback()` when the context ends, at once if it has ended; a bound method is held weakly.

        Raises TypeError for what cannot be called.
        """
        if not callable(callback):
            raise TypeError(f"callback should be a callable, got {type(callback)}")
        if self._initialized and not self._ok:
            callback()
            return
        with self._lock:
            held = weakref.WeakMethod(callback) if isinstance(callback, MethodType) else callback
            self._callbacks = [*filter(_lives, self._callbacks), held]

    def __enter__(self) -> Context:
        if not self._initialized:
            self.init()
        return self

    def __exit__(self, *_: object) -> None:
        self.try_shutdown()


def _lives(callback: Callable[[], Any]) -> bool:
    return not isinstance(callback, weakref.WeakMethod) or callback() is not None


def _domain_id(given: int | None) -> int:
    if given is not None and given < 0:
        raise ContextError(f"Domain id ({given}) should not be lower than zero.")
    text = os.environ.get("ROS_DOMAIN_ID", "0") if given is None else str(given)
    try:
        domain_id = int(text or "0")
    except ValueError:
        raise ContextError(f"ROS_DOMAIN_ID: expected a number from 0 to {LAST_DOMAIN}, got '{text}'") from None
    if not 0 <= domain_id <= LAST_DOMAIN:
        raise ContextError(f"domain id: expected a number from 0 to {LAST_DOMAIN}, got {domain_id}")
    return domain_id
