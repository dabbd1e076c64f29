"""Context: the network session, the clock, the domain and the arguments that nodes share."""

from __future__ import annotations

import _thread
import contextlib
import itertools
import os
import queue
import threading
import weakref
from collections.abc import Callable
from types import MethodType
from typing import TYPE_CHECKING, Any

from robolink import signals
from robolink.arguments.command_line import Arguments, parse_arguments
from robolink.arguments.undeclared import GivenParameters
from robolink.constants import LAST_DOMAIN
from robolink.exceptions import SIGNAL, NotInitializedException, RobolinkError, imported_as
from robolink.graph import humble
from robolink.running.defaults import get_defaults
from robolink.running.inbox import Inbox, Sweepable
from robolink.running.timebase import TimeBase
from robolink.system import waits

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from robolink.graph.graph import Graph
    from robolink.running.defaults import Driver
    from robolink.running.ports import Loop
    from robolink.transport.base import Transport

REPORTED_WITHIN = 2.0
"""Longest wait for the shutdown callbacks after a signal, in seconds, before the network is left."""


class ContextError(RobolinkError, RuntimeError):
    """A context was initialized twice, shut down too early, or given an impossible domain."""


class Context:
    """Life cycle and surroundings of nodes: those of one context share a network session, a clock and arguments.

    `rclpy.init` initializes the default one. One of its own is begun by `init`, or by a `with` block, which also ends
    it; until then nodes cannot be created in it.

    Args:
        transport: Network: "zenoh", "memory" (nodes of this process only), or a Transport that is open already. None
            is the environment variable ROBOLINK_TRANSPORT, or "zenoh".
        time: Time base of its clocks and timers, such as a VirtualTime; None is the system's time.
    """

    def __init__(self, *, transport: str | Transport | None = None, time: TimeBase | None = None) -> None:
        # A program that calls Context() is in a process, or in a host with other programs and virtual time. It must
        # not see the difference, nor may a class of its own that derives from this one: hence a part, no other class.
        self._platform = get_defaults().platform
        self.time: TimeBase = self._platform.time_base(time)
        self.arguments = Arguments()
        self.given_parameters = GivenParameters()
        self.interrupted = False
        self.terminated = False
        """True if it was SIGTERM that interrupted it, and not Ctrl-C."""
        """True if a signal ended this context."""
        self.speaks_humble = False
        """True if everything of this context is on the wire as Humble spells it."""
        self.inbox = self.make_inbox(parked=True)
        """Inbox of the entities that no executor has."""
        self._requested = transport
        self._transport: Transport | None = None
        self._graph: Graph | None = None
        self._sweeper = self._platform.make_sweeper()
        self._ids = itertools.count()
        self._lock = threading.RLock()
        self._initialized = self._ok = self._closed = False
        self._domain_id = 0
        self._callbacks: list[Callable[[], Any]] = []
        self._teller = 0
        self._reported: queue.SimpleQueue[None] = queue.SimpleQueue()
        self._nodes: weakref.WeakValueDictionary[int, Any] = weakref.WeakValueDictionary()  # in the order of making
        self._platform.join(self)

    def init(
        self, args: list[str] | None = None, *, initialize_logging: bool = True, domain_id: int | None = None
    ) -> None:
        """Initialize the context: read the command line and make nodes possible. The network is joined later.

        Args:
            args: Command line, of which what stands between `--ros-args` and `--` counts; None is `sys.argv`.
            initialize_logging: True sets up logging as the command line says (`--log-level` ...).
            domain_id: ROS domain, 0 to 232: only nodes of one domain see each other. None is the environment
                variable ROS_DOMAIN_ID, or 0.

        Raises:
            ContextError: (a RuntimeError) the second time, or for an impossible domain id.
            DistroError: (a ValueError) if ROBOLINK_ROS_DISTRO names no known distribution.
            InvalidROSArgsError: (a ValueError) if `args` cannot be read; UnknownROSArgsError for flags that do not
                exist.
        """
        with self._lock:
            if self._initialized:
                raise ContextError("Context.init() must only be called once")
            self._domain_id = _domain_id(domain_id)
            self.speaks_humble = humble.is_requested(os.environ)
            self.arguments = parse_arguments(self._platform.argv() if args is None else args)
            if initialize_logging:
                self._platform.begin_logging(self.arguments, self.time)
            self._requested = self._platform.transport(self._requested)
            self._initialized = self._ok = True
        signals.watch(self)

    # What nodes share

    @property
    def transport(self) -> Transport:
        """Session on the network, opened when it is first needed. Raises TransportError if that fails."""
        with self._lock:
            if self._closed or not self._initialized:
                raise NotInitializedException(ended_by=self.ended_by)
            if self._transport is None:
                from robolink.transport import connect

                expected = self._requested or os.environ.get("ROBOLINK_TRANSPORT") or "zenoh"
                self._transport = connect(expected, self._domain_id, enclave=self.arguments.enclave)
                self._sweeper.add(self.inbox)
            return self._transport

    @property
    def graph(self) -> Graph:
        """Graph of the nodes, topics and services that are announced on this domain."""
        with self._lock:
            if self._graph is None:
                from robolink.graph.graph import Graph

                self._graph = Graph(self.transport, self._domain_id)
                self.on_shutdown(self._graph.wake)
            if self._closed and not self._graph.settled:  # what was there before can be asked no more
                raise NotInitializedException(ended_by=self.ended_by)
            return self._graph

    def wait_until(self, is_there: Callable[[], bool], timeout_sec: float | None) -> bool:
        """Wait until `is_there()` is true of the graph, or the context ends; return whether it is true then.

        The longest wait is `timeout_sec` seconds; None waits for ever, 0 or less does not wait.

        In virtual time nobody comes while this thread waits, the seconds are over at once; unless a host runs others.
        """
        if timeout_sec is not None and timeout_sec <= 0:
            if not is_there():
                self.time.pass_on()
            return is_there()

        def holds() -> bool:
            return is_there() or not self.ok()

        until = None if timeout_sec is None else self.time.steady() + int(timeout_sec * 1e9)
        self.time.wait_notified(holds, until, lambda seconds: self.graph.wait_for(holds, seconds))
        return is_there()

    def make_inbox(self, *, parked: bool = False) -> Inbox:
        """Make the inbox of an executor of this context; `parked` for entities that no executor has."""
        return self._platform.make_inbox(parked=parked)

    def make_loop_inbox(self, rouse: Callable[[], object]) -> Inbox:
        """Make the inbox of a node on an event loop, which `rouse` lets look into it; see `LoopInbox`."""
        return self._platform.make_loop_inbox(rouse, threaded=self.transport.threaded)

    def make_pool(self, size: int) -> Executor:
        """Make the pool of `size` threads in which callbacks of a multi-threaded executor run."""
        return self._platform.make_pool(size)

    def make_driver(self, executor: Loop) -> Driver | None:
        """Make the driver that runs the callbacks of `executor`; None if it runs them itself."""
        return self._platform.make_driver(executor)

    def next_id(self) -> str:
        """Return an id for a node or endpoint: the next number of one counter, as text."""
        return str(next(self._ids))

    def look_after(self, inbox: Inbox, between_spins: Sweepable) -> None:
        """Sweep an executor's `inbox` from another thread while its owner is busy, so that nothing piles up in it.

        Over a transport without threads nobody else sends meanwhile. There `between_spins` is swept, which empties the
        inbox only while a node is parked.
        """
        self._sweeper.add(inbox if self.transport.threaded else between_spins)

    def let_go(self, inbox: Inbox, between_spins: Sweepable) -> None:
        """Sweep `inbox` no longer, nor `between_spins`."""
        self._sweeper.remove(inbox)
        self._sweeper.remove(between_spins)

    def get_domain_id(self) -> int:
        """Return the domain, 0 to 232. Raises NotInitializedException before `init`."""
        if not self._initialized:
            raise NotInitializedException()
        return self._domain_id

    def track_node(self, node: Any) -> None:
        """Note `node`, to destroy it when the context ends."""
        self._nodes[id(node)] = node
        self._platform.adopt(node, self.arguments)

    def untrack_node(self, node: Any) -> None:
        """Forget `node`, which is destroyed."""
        self._nodes.pop(id(node), None)

    @property
    def nodes(self) -> list[Any]:
        """Nodes that were made in this context and are not destroyed, in the order of making."""
        return list(self._nodes.values())

    # The end

    def ok(self) -> bool:
        """Return True from `init` until the end, by `shutdown` or a signal."""
        return self._ok

    @property
    def closed(self) -> bool:
        """True once `shutdown` has been called, which destroys the nodes and leaves the network."""
        return self._closed

    @property
    def ended_by(self) -> str:
        """Cause of the context's end, in words; '' if it has not begun or not ended."""
        if self.interrupted:
            return SIGNAL
        return f"{imported_as()}.shutdown()" if self._closed else ""

    def interrupt(self, *, by_sigterm: bool = False) -> None:
        """End the spinning, as Ctrl-C does, but stay connected: a program may still send its last words.

        `by_sigterm`: it is SIGTERM that does so, which is a KeyboardInterrupt for nobody who spins.

        A signal's handler may call this at any moment, within anything that the main thread does: whoever wants to
        know of the end is told on a thread of its own, since the main thread may hold the very lock that it needs.
        """
        if not self._ok:
            return
        self.interrupted, self.terminated = True, by_sigterm
        self._ok = False
        self._platform.run_aside(self._tell_now)

    def _tell_now(self) -> None:
        self._teller = _thread.get_ident()
        try:
            self._tell()
        finally:
            self._reported.put(None)

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
                waits.get(self._reported, REPORTED_WITHIN)
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
            for node in self.nodes:
                node.destroy_node()
            self.given_parameters.warn_of_rest()
        finally:  # a node's own destroy_node is anybody's code
            with self._lock:
                transport, self._transport = self._transport, None
            self._sweeper.close()
            self._platform.end_logging(self.time)
            if transport is not None:
                transport.close()

    def on_shutdown(self, callback: Callable[[], Any]) -> None:
        """Call `callback()` when the context ends, at once if it has ended; a bound method is held weakly.

        Raises TypeError for what cannot be called.
        """
        if not callable(callback):
            raise TypeError(f"callback should be a callable, got {type(callback)}")
        if self._initialized and not self._ok:
            callback()  # as rclpy does: it would never be called any more
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
