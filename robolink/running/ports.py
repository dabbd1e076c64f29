"""Protocols by which entities, executors, nodes and contexts know each other, so that none imports another's module.

Each says what its users below need, and no more: `Executor` is a Loop, `Node` a NodeLike, `Context` a ContextLike.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from robolink.arguments.undeclared import OverriddenNode

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from concurrent.futures import Executor as Pool
    from contextlib import AbstractContextManager

    from robolink.impl.rcutils_logger import RcutilsLogger
    from robolink.running.inbox import Inbox, Sweepable
    from robolink.running.ready_queue import ReadyQueue
    from robolink.running.timebase import TimeBase
    from robolink.task import Future
    from robolink.transport.base import Transport


class ContextLike(Protocol):
    """Context as seen from below: its time, its network, its end, and the threads of an executor."""

    _ok: bool
    """True from `init` to the end: `ok` without a call."""

    @property
    def time(self) -> TimeBase:
        """The time base of all its nodes."""

    @property
    def inbox(self) -> Inbox:
        """Where arrivals wait for entities that no executor has."""

    @property
    def transport(self) -> Transport:
        """The session on the network."""

    @property
    def speaks_humble(self) -> bool:
        """True if everything of this context is on the wire as Humble spells it."""

    @property
    def closed(self) -> bool:
        """True once it has been shut down."""

    def ok(self) -> bool:
        """True from `init` to the end."""

    def on_shutdown(self, callback: Callable[[], Any]) -> None:
        """Call `callback()` when the context ends; a bound method is held weakly."""

    def make_pool(self, size: int) -> Pool:
        """Make the threads of an executor."""

    def get_domain_id(self) -> int:
        """Return the ROS domain, 0 to 232."""

    def look_after(self, inbox: Inbox, between_spins: Sweepable) -> None:
        """Sweep an executor's `inbox` from another thread: always, or by `between_spins` while a node is parked."""

    def next_id(self) -> str:
        """Return an id for a node or endpoint that no other one of this context has."""

    def wait_until(self, is_there: Callable[[], bool], timeout_sec: float | None) -> bool:
        """Wait until `is_there()` is true of the graph, or the context ends."""


class NodeLike(Protocol):
    """Node as seen by the entities it owns."""

    _runs_itself_: bool
    """True for a node on asyncio's event loop, which no executor may run."""

    _number_: int
    """Number in the order in which nodes were made: of several in an executor, the older has its turns first."""

    @property
    def context(self) -> ContextLike:
        """The context that it lives in."""

    def get_logger(self) -> RcutilsLogger:
        """Return the logger that carries the node's name."""


class SpunNode(NodeLike, OverriddenNode, Protocol):
    """Node as seen by the executor that runs its callbacks."""

    _turns_: list[Any]
    """Entities whose turn was still to come when the last executor removed the node, in order."""

    _is_parked_: bool
    """True while its entities are attached to an executor, but it belongs to none."""

    @property
    def executor(self) -> Any:
        """The executor that it was added to."""

    @property
    def _attached_to_(self) -> Any:
        """The executor that its entities are attached to: also while it is parked there."""

    @property
    def clients(self) -> Iterable[Any]:
        """Its clients of services."""

    @property
    def _entity_store_(self) -> Any:
        """Store of its entities: `entities()` returns all that an executor runs."""

    def _belong_to_(self, executor: Any) -> None:
        """Note which executor has it from now on."""


class Loop(Protocol):
    """Event loop as seen by the entities that it runs: an executor."""

    parallel: bool
    """True if other callbacks go on while one of them waits."""

    _queue_: ReadyQueue[Any]
    """Ready queue: entities put themselves in."""

    @property
    def context(self) -> ContextLike:
        """The context whose end ends the spinning."""

    @property
    def spinning(self) -> bool:
        """True while any thread spins."""

    @property
    def spins_here(self) -> bool:
        """True if the calling thread is inside a callback of this loop."""

    def create_task(self, callback: Any, *args: Any, **kwargs: Any) -> Future[Any]:
        """Run a function or coroutine in this loop."""

    def serve_until(self, future: Future[Any], deadline: int | None, *, serving: bool = True) -> None:
        """Run what serves until the future is over, in a callback that waits for it."""

    def is_last_awake(self) -> bool:
        """Return True in a callback if no other thread of this loop could run one that wakes it."""

    def waiting_for(self, services: Sequence[Any]) -> AbstractContextManager[bool]:
        """Enter a wait for one of these services; the value is True if that would be a deadlock."""

    def get_nodes(self) -> Iterable[Any]:
        """Return the nodes that were added."""


class ThreadedLoop(Loop, Protocol):
    """Executor as seen by the threads that run its callbacks."""

    def run(self, entity: Any, taken: Any) -> None:
        """Run what was taken. Raises what the callback raises."""

    def check_end(self) -> None:
        """Raise if the executor or its context has ended."""
