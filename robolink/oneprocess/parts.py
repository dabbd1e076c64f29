"""Who takes turns in a host: threads that wait, things to do, and the inboxes at which executors wait."""

from __future__ import annotations

import _thread
import threading
from collections import deque
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, Protocol

from robolink.defaults import Defaults, use_defaults
from robolink.inbox import Inbox

if TYPE_CHECKING:
    from robolink.oneprocess.executor import HostedExecutor
    from robolink.oneprocess.program import Program
    from robolink.oneprocess.turns import Turns


class Killed(BaseException):
    """What code meets, wherever it waits, whose program was killed: nothing of it goes on."""


class Turn(Protocol):
    """Something that a thread of the host is to do."""

    def run(self, runner: Runner) -> None:
        """Do it, in this thread."""


class Job:
    """A function to be called for a program, or for the host itself."""

    version = 0

    def __init__(self, program: Program | None, act: Callable[[], object]) -> None:
        self.program, self.act = program, act

    def run(self, runner: Runner) -> None:
        """Call it."""
        runner.enter(self.program)
        self.act()


class Wait:
    """A thread that waits: at an inbox, for a condition, for a moment, or for whichever of these comes first."""

    __slots__ = ("error", "holds", "inbox", "runner", "version")

    def __init__(self, runner: Runner, inbox: HostedInbox | None, holds: Callable[[], bool] | None) -> None:
        self.runner, self.inbox, self.holds = runner, inbox, holds
        self.version = 0
        """1 once it is over."""
        self.error: BaseException | None = None
        """What to raise where it waits."""

    def is_over(self) -> bool:
        """Whether the condition holds, or asking for it failed."""
        try:
            return self.holds is not None and self.holds()
        except BaseException as error:  # noqa: BLE001 - it is raised where it was waited for
            self.error = error
            return True


class Runner:
    """A thread that runs when it is its turn."""

    def __init__(self, turns: Turns, program: Program | None = None) -> None:
        self.turns, self.program = turns, program
        self.turn: Turn | None = None
        """What it is to do when it is resumed."""
        self.wait: Wait | None = None
        self.thread: threading.Thread | None = None
        """The thread that this is; None for whoever runs the host."""
        self.is_host = False
        """Whether it is one of the host's threads: each program's main one, in turn."""
        self.free = False
        """Whether it runs beside the one whose turn it is: a thread that the host knows nothing of."""
        self.killed = False
        self.is_real = False
        """Whether it waits just now by Python's own means, for something that comes at once."""
        self.is_daemon = False
        """Whether it is a thread that does not keep its program from ending."""
        self.is_idle = False
        """Whether it waits for work that somebody may give it."""
        self.is_done = False
        """Whether the program's thread has come to its end."""
        self.defaults: Defaults | None = None
        self._resumed = _thread.allocate_lock()
        self._resumed.acquire()
        self.resume, self.park = self._resumed.release, self._resumed.acquire

    def enter(self, program: Program | None, *, shows: bool = True) -> None:
        """Run this program's code from now on; `shows`: with what it sees of the process."""
        defaults = self.turns.defaults if program is None else program.defaults
        if self.defaults is not defaults:
            self.program, self.defaults = program, defaults
            use_defaults(defaults)
        if shows and self.turns.surroundings.shown is not program:
            self.turns.surroundings.show(program)


class Runners:
    """The threads that take turns, but for whoever runs the host; and which of them the calling one is."""

    def __init__(self) -> None:
        self._all: list[Runner] = []
        self._here = threading.local()

    def __iter__(self) -> Iterator[Runner]:
        return iter(self._all)

    def add(self, runner: Runner) -> None:
        """Have a thread take turns."""
        self._all.append(runner)

    def remove(self, runner: Runner) -> None:
        """Have a thread take turns no more."""
        self._all.remove(runner)

    def belong(self, runner: Runner) -> None:
        """Know the calling thread by this runner."""
        self._here.runner = runner

    def here(self) -> Runner | None:
        """Give the calling thread, if it is known."""
        found: Runner | None = getattr(self._here, "runner", None)
        return found

    def is_hosts(self) -> bool:
        """Whether the calling thread is one of the host's, each of which is a program's main one in turn."""
        runner = self.here()
        return runner is not None and runner.is_host

    def waiting(self, program: Program) -> list[Runner]:
        """Give the threads in which code of a program waits."""
        return [each for each in self._all if each.program is program and each.wait is not None]


class HostedInbox(Inbox):
    """Where an executor of a program waits: what arrives is delivered at once, and gives the executor a turn."""

    def __init__(self, due: deque[Any]) -> None:
        self.lock = threading.RLock()
        self.executor: HostedExecutor | None = None
        """Who is given the turn, if the host runs it; else it is the thread that waits here."""
        self.waiter: Wait | None = None
        self.queued = 0
        """How many turns of this inbox are due."""
        self._due = due
        self._arrival = self._make_arrival(due)
        self.empty = _nothing_waits

    def _make_arrival(self, due: deque[Any]) -> Callable[[Any, Any], None]:
        append = due.append

        def arrive(target: Any, content: Any) -> None:
            target.deliver(content)
            self.queued += 1
            append(self)

        return arrive

    def wake(self) -> None:
        """Give whoever waits here a turn."""
        self.queued += 1
        self._due.append(self)

    def sweep(self) -> None:
        """Do nothing: all has been delivered."""

    clear = sweep

    def run(self, runner: Runner) -> None:
        """Have the executor run one callback, if it is one of the host's."""


class ParkedInbox(HostedInbox):
    """Where what arrives is left for entities that no executor has."""

    def _make_arrival(self, due: deque[Any]) -> Callable[[Any, Any], None]:
        return _deliver

    def wake(self) -> None:
        """Do nothing: nobody waits here."""


def _deliver(target: Any, content: Any) -> None:
    target.deliver(content)


def _nothing_waits() -> bool:
    return True
