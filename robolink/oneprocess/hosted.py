"""The contexts of the programs of a host: each has a session of its own, and the host's time."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any

from robolink import rosout
from robolink.context import Context
from robolink.defaults import get_defaults
from robolink.inbox import Inbox
from robolink.logging import get_logger_level, set_logger_level
from robolink.oneprocess.executor import HostedExecutor
from robolink.oneprocess.parts import HostedInbox, ParkedInbox
from robolink.oneprocess.threads import HostedPool

if TYPE_CHECKING:
    from robolink.oneprocess.program import Program


class HostedContext(Context):
    """A context of the program whose code makes it: a session of its own, the host's time."""

    def __init__(self, **_: Any) -> None:
        self.program: Program = get_defaults().program
        super().__init__(time=self.program.time)
        self.program.contexts.append(self)

    def init(
        self, args: list[str] | None = None, *, initialize_logging: bool = True, domain_id: int | None = None
    ) -> None:
        """Make it ok, with the program's command line where none is given. See `Context.init`."""
        super().init(
            self.program.argv if args is None else args, initialize_logging=initialize_logging, domain_id=domain_id
        )
        self._wanted = self.program.host.connect(self.program.name)

    def _configure_logging(self) -> None:
        """Set the levels of loggers by name; the root's is that of this program's nodes, as they come."""
        for name, level in self.arguments.log_levels:
            if name:
                set_logger_level(name, level)

    def track_node(self, node: Any) -> None:
        """Remember a node, to destroy it when the context ends."""
        super().track_node(node)
        node._wished_parameters_ = self.program.wishes
        logger = node.get_logger().name
        for name, level in self.arguments.log_levels:
            if not name and not get_logger_level(logger):
                set_logger_level(logger, level)

    def wait_until(self, is_there: Callable[[], bool], timeout_sec: float | None) -> bool:
        """See `Context.wait_until`; who waits has read what there was to read at the start."""
        self.program.on_read()
        if timeout_sec is None or timeout_sec > 0:
            return super().wait_until(is_there, timeout_sec)
        if not is_there():
            self.time.pass_on()
        return is_there()

    def make_inbox(self, *, parked: bool = False) -> Inbox:
        """Make what an executor of this context waits at; an executor comes when a script's nodes are made."""
        if not parked and self.program.is_script:
            self.program.on_read()
        return super().make_inbox(parked=parked)

    def abandon(self) -> None:
        """Be gone at once, as what a process that is killed has had: nobody is told, nothing is sent."""
        self._ok, self._closed, self._callbacks = False, True, []
        for node in list(self._nodes.values()):
            rosout.keep_to_itself(node.get_logger().name)
        transport, self._transport = self._transport, None
        self._sweeper.close()
        if transport is not None:
            transport.close()


class VirtualContext(HostedContext):
    """A context of a program in virtual time: its executors and their threads take turns with all others."""

    executor_type = HostedExecutor

    def __init__(self, **_: Any) -> None:
        super().__init__()
        self._sweeper.close()  # what arrives is delivered at once

    def make_inbox(self, *, parked: bool = False) -> Inbox:
        """Make what an executor of this context waits at, or what keeps arrivals while no executor does."""
        due = self.program.host.the_turns.due
        return ParkedInbox(due) if parked else HostedInbox(due)

    def make_pool(self, size: int) -> Executor:
        """Make the threads in which callbacks of a multi-threaded executor run."""
        return HostedPool(self.program, size)

    def interrupt(self) -> None:
        """End the spinning, as Ctrl-C does in a process; whoever is told of it is told in this turn."""
        if self._ok:
            self.interrupted, self._ok = True, False
            self._tell()
            self._told.put(None)
