"""Waiting for a transform: in a callback, outside of any, and with a future."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple, Protocol

from robolink.exceptions import ExternalShutdownException, InterruptedByUser
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.logging import get_logger
from robolink.running.defaults import get_defaults
from robolink.running.timebase import SystemTime
from robolink.system.waits import A_WHILE
from robolink.task import Future
from robolink.tf2.core import LOGGER

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.node import BaseNode


class Source(Protocol):
    """Protocol of a listener that fills a buffer while its node is spun."""

    @property
    def node(self) -> BaseNode:
        """The node whose subscriptions fill the buffer."""


class PendingLookup(NamedTuple):
    """A look-up that may be waited for: can it succeed, is it impossible by now, and its result."""

    can: Callable[[], tuple[bool, str]]
    is_gone: Callable[[], bool]
    look: Callable[[], TransformStamped]

    def settled(self) -> bool:
        """True if a longer wait changes nothing."""
        return self.can()[0] or self.is_gone()


class Waits:
    """Condition variable of a buffer: its waits, and the listeners that end them."""

    def __init__(self) -> None:
        self.sources: weakref.WeakSet[Source] = weakref.WeakSet()
        """Listeners that feed the buffer; each has a `node`."""
        self._came = threading.Condition()
        self._requested: list[tuple[PendingLookup, Future[TransformStamped]]] = []
        self._hinted = False

    def notify(self) -> None:
        """Notify all waits that a transform has come."""
        with self._came:
            self._came.notify_all()
        for requested in list(self._requested):
            if requested[0].settled():
                self._answer(*requested)

    # In a callback, or outside of any

    def wait(self, lookup: PendingLookup, span: int) -> None:
        """Wait until the lookup is settled or `span` ns have passed.

        In a callback of the executor that has the listener's node, the listener goes on meanwhile; nothing else
        does but services and clients. Raises ExternalShutdownException when the context ends.
        """
        nodes = [each.node for each in self.sources]
        for node in nodes:
            executor = node._loop_
            if executor is not None and executor.spins_here:
                future = self.future(lookup)
                executor.serve_until(future, node.context.time.steady() + span)
                future.cancel()
                future.exception()  # the lookup that follows raises it
                return
        self._wait_for_others(lookup, span, [node.context for node in nodes])
        if nodes and not lookup.settled():
            self._warn_of_idle_node(nodes, span)

    def _wait_for_others(self, lookup: PendingLookup, span: int, contexts: list[Context]) -> None:
        time = contexts[0].time if contexts else SystemTime()
        deadline = time.steady() + span

        def block(_: float | None) -> None:
            with self._came:
                while not lookup.settled() and time.steady() < deadline:
                    check(contexts)
                    self._came.wait(min((deadline - time.steady()) / 1e9, A_WHILE))

        time.wait_notified(lookup.settled, deadline, block)

    def _warn_of_idle_node(self, nodes: list[BaseNode], span: int) -> None:
        """Warn once that nobody spins the listener."""
        if self._hinted or any(node._loop_ is not None and node._loop_.spinning for node in nodes):
            return
        self._hinted = True
        get_logger(LOGGER).warning(
            f"waited {span / 1e9:g} s for a transform, but nobody spins {nodes[0].get_fully_qualified_name()}, whose"
            " TransformListener brings them: spin it in another thread, or give the listener spin_thread=True"
        )

    # With a future

    def future(self, lookup: PendingLookup) -> Future[TransformStamped]:
        """Return a future that gets the transform, or the exception once it cannot come any more."""
        future: Future[TransformStamped] = Future()
        requested = (lookup, future)
        self._requested.append(requested)
        future.add_done_callback(lambda _: self._forget(requested))
        if lookup.settled():
            self._answer(*requested)
        return future

    def _answer(self, lookup: PendingLookup, future: Future[TransformStamped]) -> None:
        if not self._forget((lookup, future)):
            return  # another thread was faster, or it was cancelled
        try:
            found = lookup.look()
        except Exception as error:  # noqa: BLE001 - it is the future's
            future.set_exception(error)
        else:
            future.set_result(found)

    def _forget(self, requested: tuple[PendingLookup, Future[TransformStamped]]) -> bool:
        with self._came:
            for at, each in enumerate(self._requested):
                if each[1] is requested[1]:
                    del self._requested[at]
                    return True
        return False


def check(contexts: list[Context]) -> None:
    """Raise InterruptedByUser (in the main thread) or ExternalShutdownException if a context has ended."""
    for context in contexts:
        if context.interrupted and not context.terminated and get_defaults().in_main_thread():
            raise InterruptedByUser
        if not context.ok():
            raise ExternalShutdownException("the context ended before the transform came")
