"""Participants of a host's scheduler: threads that wait, jobs, the mailboxes of executors; and Protocols of the rest.

A Protocol says what those below need of a program, of its host and of the scheduler, so that no two modules of this
room import each other.
"""

from __future__ import annotations

import _thread
import itertools
import math
import random
import threading
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from types import ModuleType
from typing import Any, Protocol
from weakref import WeakSet

from robolink.exceptions import RobolinkError
from robolink.host.real_waits import RealWaits
from robolink.running.defaults import Defaults, place_of_defaults, use_defaults
from robolink.running.entity import Receiver
from robolink.running.inbox import Inbox
from robolink.running.timebase import TimeBase, VirtualTime
from robolink.transport.base import Transport

ACTS, CALLBACKS, OUTSIDE = 0, 1, 2
"""Ranks of what is due at one moment; whoever runs the host from outside comes when all else is done."""


class Killed(BaseException):
    """Raised in code of a killed program, wherever it waits, to unwind it."""


class HostError(RobolinkError, RuntimeError):
    """A host cannot go on; its text names the program that keeps it from doing so."""


class HostLike(Protocol):
    """Host as seen by what its programs live in."""

    @property
    def scheduler(self) -> SchedulerLike:
        """The scheduler of all its programs."""

    @property
    def connect(self) -> Callable[[str], Transport]:
        """Opens the network session of a program, by its name."""

    def note_real_time(self, program: ProgramLike, what: str, place: str) -> None:
        """Record a use of real time, once."""


class DriverLike(Protocol):
    """Driver of an executor as seen by whoever wakes it."""

    inbox: HostedInbox


class ProgramLike(Protocol):
    """Program as seen by the scheduler, the patches and its platform."""

    name: str
    argv: list[str]
    env: dict[str, str | None]
    time: TimeBase
    chance: random.Random
    """Generator of its entropy."""
    defaults: Defaults
    main_module: ModuleType | None
    """Its ``__main__``, if it is a script."""
    handlers: dict[int, Any]
    """Its handlers of signals, by number."""
    loops: WeakSet[Any]
    """Its event loops of asyncio."""
    contexts: list[Any]
    has_begun: bool
    has_waited: bool

    @property
    def host(self) -> HostLike:
        """The host that runs it."""

    @property
    def driver(self) -> DriverLike | None:
        """The driver of its Node classes' executor."""

    @property
    def preferred_parameters(self) -> Mapping[str, Any]:
        """Values that the host prefers for parameters of its nodes."""

    @property
    def is_over(self) -> bool:
        """True once it has ended, in whatever way."""

    def begin(self) -> None:
        """Make its nodes, or run its script."""

    def interrupt(self) -> None:
        """Ask it to end, as Ctrl-C does."""

    def end(self, error: BaseException | None = None) -> None:
        """End it in order, because of this error."""

    def give_up(self, error: BaseException) -> None:
        """Count it as crashed, since code of it does not go on."""


class ViewLike(Protocol):
    """View of the process that is shown to the program whose turn it is."""

    shown: ProgramLike | None
    env: dict[str, str | None]

    def show(self, program: ProgramLike | None) -> None:
        """Show what is this program's, or the process's own."""


class SchedulerLike(Protocol):
    """Scheduler as seen by those who wait in it."""

    due: deque[Any]
    heap: list[tuple[int, int, int, int, Any]]
    serial: itertools.count[int]
    runners: Runners
    outside: Runner
    defaults: Defaults
    time: VirtualTime
    real_waits: RealWaits

    @property
    def view(self) -> ViewLike:
        """View of the process that programs have."""

    def at(self, time_ns: int, thing: Any) -> None:
        """Run a job, or end a wait, at a moment of the host's time."""

    def runner(self) -> Runner | None:
        """Return the calling thread, if it takes turns."""

    def wait(
        self, inbox: HostedInbox | None = None, holds: Callable[[], bool] | None = None, until: int | None = None
    ) -> None:
        """Let all others go on until something arrives, `holds()`, or the host's time is `until`."""

    def leave(self, me: Runner) -> None:
        """Hand on for good: this thread ends."""


class Turn(Protocol):
    """A task of a thread of the host."""

    def run(self, runner: Runner) -> None:
        """Do it, in this thread."""


class Job:
    """A function to be called for a program, or for the host itself."""

    version = 0

    def __init__(self, program: ProgramLike | None, act: Callable[[], object]) -> None:
        self.program, self.act = program, act

    def run(self, runner: Runner) -> None:
        """Call it."""
        runner.enter(self.program)
        self.act()


class Wait:
    """Wait of a thread: at an inbox, for a condition, for a moment, or for whichever of these comes first."""

    __slots__ = ("error", "holds", "inbox", "runner", "version")

    def __init__(self, runner: Runner, inbox: HostedInbox | None, holds: Callable[[], bool] | None) -> None:
        self.runner, self.inbox, self.holds = runner, inbox, holds
        self.version = 0
        """1 once it is over."""
        self.error: BaseException | None = None
        """Exception to raise where it waits."""

    def is_over(self) -> bool:
        """Return True if the condition holds, or evaluating it failed."""
        try:
            return self.holds is not None and self.holds()
        except BaseException as error:  # noqa: BLE001 - it is raised where it was waited for
            self.error = error
            return True


class Runner:
    """Thread that takes turns: it runs when the scheduler resumes it."""

    def __init__(self, scheduler: SchedulerLike, program: ProgramLike | None = None) -> None:
        self.scheduler, self.program = scheduler, program
        self.turn: Turn | None = None
        """Task to do when it is resumed."""
        self.wait: Wait | None = None
        self.thread: threading.Thread | None = None
        """The thread itself; None for whoever runs the host."""
        self.is_host = False
        """True for the host's worker threads, each of which is a program's main thread, in turn."""
        self.free = False
        """True while it runs beside the scheduled thread: the host knows nothing of it, or cannot stop it."""
        self.killed = False
        self.is_real = False
        """True while it waits by Python's own means, for something that comes at once."""
        self.is_daemon = False
        """True for a daemon thread of a program."""
        self.is_idle = False
        """True while it waits for work, in a pool."""
        self.is_done = False
        """True once the program's thread has ended."""
        self.defaults: Defaults | None = None
        self.place: list[Defaults] = []
        """Place of the thread's defaults: setting them here takes a tenth of the time."""
        self._resumed = _thread.allocate_lock()
        self._resumed.acquire()
        self.resume, self.park = self._resumed.release, self._resumed.acquire

    def enter(self, program: ProgramLike | None, *, shows: bool = True) -> None:
        """Run this program's code from now on; `shows`: with its view of the process."""
        defaults = self.scheduler.defaults if program is None else program.defaults
        if self.defaults is not defaults:
            self.program, self.defaults = program, defaults
            use_defaults(defaults)
        if shows and self.scheduler.view.shown is not program:
            self.scheduler.view.show(program)


class Runners:
    """Registry of the threads that take turns, but for the one that runs the host."""

    def __init__(self) -> None:
        self._all: list[Runner] = []
        self._here = threading.local()

    def __iter__(self) -> Iterator[Runner]:
        return iter(self._all)

    def add(self, runner: Runner) -> None:
        """Register a thread."""
        self._all.append(runner)

    def remove(self, runner: Runner) -> None:
        """Remove a thread, which takes turns no more."""
        self._all.remove(runner)

    def belong(self, runner: Runner) -> None:
        """Register the calling thread as this runner."""
        self._here.runner, runner.place = runner, place_of_defaults()

    def here(self) -> Runner | None:
        """Return the calling thread, if it is registered."""
        found: Runner | None = getattr(self._here, "runner", None)
        return found

    def is_hosts(self) -> bool:
        """Return True in one of the host's worker threads, each of which is a program's main one in turn."""
        runner = self.here()
        return runner is not None and runner.is_host

    def waiting(self, program: ProgramLike) -> list[Runner]:
        """Return the threads in which code of a program waits."""
        return [each for each in self._all if each.program is program and each.wait is not None]


class _Place:
    """Place where a target's sink delivers: the inbox of its executor, and its `schedule`; None while none has it."""

    __slots__ = ("inbox", "schedule")

    def __init__(self, inbox: HostedInbox | None, schedule: Callable[[HostedInbox], object]) -> None:
        self.inbox, self.schedule = inbox, schedule


class HostedInbox(Inbox):
    """Inbox of an executor in a host: what arrives is delivered at once, and schedules the executor."""

    def __init__(self, due: deque[Any], *, is_executors: bool = True) -> None:
        self.lock = threading.RLock()
        self.is_executors = is_executors
        """True if who waits here is an executor, which looks by itself whether its program was interrupted."""
        self.is_free = False
        """True while the host may run a callback of the executor: somebody spins it, and no callback is under way."""
        self.waiter: Wait | None = None
        """The wait of the thread that waits here, and runs the callbacks itself."""
        self.queued = 0
        """Number of turns of this inbox that are due."""
        self.empty = _nothing_waits
        self.run: Callable[[Runner], object] = _nothing_runs
        """Function that runs one callback, in this thread: the step of the executor's driver, once it has one."""
        self._due = due
        self._place: HostedInbox | None = self
        self._schedule: Callable[[HostedInbox], object] = due.append

    def sink(self, target: Any) -> Any:
        """Return the sink of a target: a function in Python, since no foreign thread calls it."""
        place = _Place(self._place, self._schedule)
        is_plain = isinstance(target, Receiver) and target.straight
        sink = _mailbox_sink(target, place) if is_plain else _sink(target.deliver, place)
        sink.place = place  # type: ignore[attr-defined]
        return sink

    def take_over(self, sink: Any) -> None:
        """Redirect an existing sink here."""
        sink.place.inbox, sink.place.schedule = self._place, self._schedule

    def wake(self) -> None:
        """Schedule the executor, or the thread that waits here."""
        self.queued += 1
        self._due.append(self)

    def sweep(self) -> None:
        """Do nothing: all has been delivered."""

    clear = sweep


def _nothing_runs(runner: Runner) -> None:
    """Run no callback: the executor is not the host's to run."""


class ParkedInbox(HostedInbox):
    """Inbox of entities without an executor: what arrives stays in their mailboxes."""

    def __init__(self, due: deque[Any]) -> None:
        super().__init__(due)
        self._place = None

    def wake(self) -> None:
        """Do nothing: nobody waits here."""


class HostedLoopInbox(HostedInbox):
    """Inbox of a node on an event loop: what arrives is delivered at once, and `rouse` lets the loop look into it."""

    def __init__(self, due: deque[Any], rouse: Callable[[], object]) -> None:
        super().__init__(due, is_executors=False)
        self.wake = rouse  # type: ignore[method-assign,assignment] # a call less
        self._schedule = lambda inbox: rouse()


def _sink(deliver: Callable[[Any], None], place: _Place) -> Callable[[Any], None]:
    def arrive(content: Any) -> None:
        deliver(content)
        inbox = place.inbox
        if inbox is not None:
            inbox.queued += 1
            schedule = place.schedule  # for Python 3.11 a function in an attribute, no method
            schedule(inbox)

    return arrive


def _mailbox_sink(target: Receiver, place: _Place) -> Callable[[Any], None]:
    """Return the `_sink` of a plain mailbox, with its `put` and what that calls written out: nearly all come here."""
    mailbox, put = target.mailbox, target.deliver
    waiting, most, append = mailbox.waiting, mailbox.waiting.maxlen, mailbox.waiting.append

    def arrive(content: Any) -> None:
        if len(waiting) == most:
            put(content)
        else:
            append(content)
            if not mailbox.listed and (queue := target._queue_) is not None:  # `become_ready`
                mailbox.listed = queue.in_rounds and not target.lane
                queue.ready.append(target)
        inbox = place.inbox
        if inbox is not None:
            inbox.queued += 1
            schedule = place.schedule  # for Python 3.11 a function in an attribute, no method
            schedule(inbox)

    return arrive


def _nothing_waits() -> bool:
    return True


def runner_of(program: ProgramLike | None) -> Runner | None:
    """Return the calling thread, if it runs this program's code in virtual time; None leaves it to Python."""
    if program is None:
        return None
    scheduler = program.host.scheduler
    runner = scheduler.runner()
    return None if runner is None or runner.is_real or runner is scheduler.outside else runner


def wait_until(time: TimeBase, holds: Callable[[], bool], seconds: float | None) -> None:
    """Let the others go on until `holds()`, for so many seconds at most; None is for ever."""
    if seconds is not None and seconds <= 0:
        time.pass_on()
    else:
        time.wait_until(holds, None if seconds is None else time.steady() + math.ceil(seconds * 1e9))
