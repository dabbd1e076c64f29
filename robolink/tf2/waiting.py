"""Waiting until a transform is there: in a callback, outside of any, and with a future."""

from __future__ import annotations

import threading
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.defaults import get_defaults
from robolink.exceptions import ExternalShutdownException, InterruptedByUser
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.logging import get_logger
from robolink.queues import A_WHILE
from robolink.task import Future
from robolink.tf2.core import LOGGER
from robolink.timebase import SystemTime

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.node import Node


class Question(NamedTuple):
    """What is waited for: whether it is there, whether it can still come, and how to get it."""

    can: Callable[[], tuple[bool, str]]
    is_gone: Callable[[], bool]
    look: Callable[[], TransformStamped]

    def settled(self) -> bool:
        """Whether waiting longer changes nothing."""
        return self.can()[0] or self.is_gone()


class News:
    """Who waits for new transforms of a buffer, and who brings them."""

    def __init__(self) -> None:
        self.sources: weakref.WeakSet[Any] = weakref.WeakSet()
        """The listeners that feed the buffer; each has a `node`."""
        self._came = threading.Condition()
        self._asked: list[tuple[Question, Future[TransformStamped]]] = []
        self._hinted = False

    def tell(self) -> None:
        """Let whoever waits look again: a transform has come."""
        with self._came:
            self._came.notify_all()
        for asked in list(self._asked):
            if asked[0].settled():
                self._answer(*asked)

    # In a callback, or outside of any

    def wait(self, question: Question, span: int) -> None:
        """Wait until it is settled, or so many nanoseconds have passed.

        In a callback of the executor that has the listener's node, the listener goes on meanwhile; nothing else
        does but services and clients. Raises ExternalShutdownException when the context ends.
        """
        nodes = [each.node for each in self.sources]
        for node in nodes:
            executor = node.executor
            if executor is not None and executor.spins_here:
                future = self.future(question)
                executor.serve_until(future, node.context.time.steady() + span)
                future.cancel()
                future.exception()  # the lookup that follows raises it
                return
        self._wait_for_others(question, span, [node.context for node in nodes])
        if nodes and not question.settled():
            self._hint(nodes, span)

    def _wait_for_others(self, question: Question, span: int, contexts: list[Context]) -> None:
        time = contexts[0].time if contexts else SystemTime()
        if time.virtual:
            time.wait_until(question.settled, time.steady() + span)
            return
        deadline = time.steady() + span
        with self._came:
            while not question.settled() and time.steady() < deadline:
                check(contexts)
                self._came.wait(min((deadline - time.steady()) / 1e9, A_WHILE))

    def _hint(self, nodes: list[Node], span: int) -> None:
        """Say once why nothing can come."""
        if self._hinted or any(node.executor is not None and node.executor.spinning for node in nodes):
            return
        self._hinted = True
        get_logger(LOGGER).warning(
            f"waited {span / 1e9:g} s for a transform, but nobody spins {nodes[0].get_fully_qualified_name()}, whose"
            " TransformListener brings them: spin it in another thread, or give the listener spin_thread=True"
        )

    # With a future

    def future(self, question: Question) -> Future[TransformStamped]:
        """Give a future that gets the transform, or the exception when it cannot come any more."""
        future: Future[TransformStamped] = Future()
        asked = (question, future)
        self._asked.append(asked)
        future.add_done_callback(lambda _: self._forget(asked))
        if question.settled():
            self._answer(*asked)
        return future

    def _answer(self, question: Question, future: Future[TransformStamped]) -> None:
        if not self._forget((question, future)):
            return  # another thread was faster, or it was cancelled
        try:
            found = question.look()
        except Exception as error:  # noqa: BLE001 - it is the future's
            future.set_exception(error)
        else:
            future.set_result(found)

    def _forget(self, asked: tuple[Question, Future[TransformStamped]]) -> bool:
        with self._came:
            for at, each in enumerate(self._asked):
                if each[1] is asked[1]:
                    del self._asked[at]
                    return True
        return False


def check(contexts: list[Context]) -> None:
    """Raise InterruptedByUser (in the main thread) or ExternalShutdownException when one of them has ended."""
    for context in contexts:
        if context.interrupted and get_defaults().in_main_thread():
            raise InterruptedByUser
        if not context.ok():
            raise ExternalShutdownException("the context ended before the transform came")
