"""Platform of a hosted program: its contexts get its command line, a session of their own, and the host's time."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any

from robolink.host.driver import HostDriver
from robolink.host.participants import HostedInbox, HostedLoopInbox, ParkedInbox, ProgramLike
from robolink.host.threads import HostedPool
from robolink.logging import get_logger_level, set_logger_level
from robolink.node_parts import rosout
from robolink.running.defaults import Platform
from robolink.running.inbox import Inbox, Sweeper
from robolink.running.timebase import TimeBase

if TYPE_CHECKING:
    from robolink.arguments.command_line import Arguments
    from robolink.context import Context
    from robolink.executors import SingleThreadedExecutor


class HostedPlatform(Platform):
    """Platform of one program, whose contexts and executors take turns with those of all others."""

    def __init__(self, program: ProgramLike) -> None:
        self._program = program
        self._scheduler = program.host.scheduler

    def join(self, context: Context) -> None:
        """Note a context of the program."""
        self._program.contexts.append(context)

    def adopt(self, node: Any, arguments: Arguments) -> None:
        """Set the parameters of a node that the host prefers, and the level of its log, if it is the root's."""
        node._parameter_store_.preferred = self._program.preferred_parameters
        logger = node.get_logger().name
        for name, level in arguments.log_levels:
            if not name and not get_logger_level(logger):
                set_logger_level(logger, level)

    def time_base(self, given: TimeBase | None) -> TimeBase:
        """Return the program's time, whatever is given."""
        return self._program.time

    def argv(self) -> list[str]:
        """Return the program's command line."""
        return self._program.argv

    def transport(self, given: Any) -> Any:
        """Open a session of its own for a context, whatever is given."""
        return self._program.host.connect(self._program.name)

    def begin_logging(self, arguments: Arguments, time_base: TimeBase) -> None:
        """Set the levels of loggers by name; the root's is that of this program's nodes, as they come."""
        for name, level in arguments.log_levels:
            if name:
                set_logger_level(name, level)

    def make_inbox(self, *, parked: bool) -> Inbox:
        """Make the mailbox at which an executor waits, or the one for what waits while no executor has it."""
        return ParkedInbox(self._scheduler.due) if parked else HostedInbox(self._scheduler.due)

    def make_loop_inbox(self, rouse: Callable[[], object], *, threaded: bool) -> Inbox:
        """Make the inbox of a node on an event loop: no other thread delivers, whatever the network."""
        return HostedLoopInbox(self._scheduler.due, rouse)

    def make_sweeper(self) -> Sweeper:
        """Make one that does nothing: what arrives is delivered at once."""
        sweeper = super().make_sweeper()
        sweeper.close()
        return sweeper

    def make_pool(self, size: int) -> Executor:
        """Make the threads in which callbacks of a multi-threaded executor run."""
        return HostedPool(self._program, size)

    def make_driver(self, executor: SingleThreadedExecutor) -> HostDriver:
        """Make the driver by which the host runs the executor's callbacks."""
        return HostDriver(executor, self._program)

    def run_aside(self, function: Callable[[], object]) -> None:
        """Call a function in this turn: no signal breaks into a hosted program."""
        function()


def abandon(context: Context) -> None:
    """Drop a context as SIGKILL would: no shutdown callbacks, nothing published."""
    context._ok, context._closed, context._callbacks = False, True, []
    for node in list(context._nodes.values()):
        rosout.keep_to_itself(node.get_logger().name)
    transport, context._transport = context._transport, None
    if transport is not None:
        transport.close()
