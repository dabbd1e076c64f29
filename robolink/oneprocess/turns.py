"""Whose turn it is: of all threads of a host one runs at a time, and hands on in an order that repeats.

What is due is done in the order in which it became due. When nothing is, the conditions that threads wait for are
looked at; then time jumps to the next moment that somebody waits for. Executors of Node classes share the thread that
decides all this, so that no thread is switched between their callbacks; a callback that waits keeps its thread, and
another takes its place.
"""

from __future__ import annotations

import contextlib
import heapq
import itertools
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.defaults import get_defaults
from robolink.exceptions import RobolinkError
from robolink.oneprocess.beside import Beside
from robolink.oneprocess.parts import HostedInbox, Job, Killed, Runner, Runners, Wait
from robolink.oneprocess.places import name_of, where_is, where_waits
from robolink.oneprocess.surroundings import Surroundings
from robolink.oneprocess.threads import end_thread, tell_of
from robolink.oneprocess.workers import Worker

if TYPE_CHECKING:
    from robolink.oneprocess.host_time import HostTime
    from robolink.timer import Timer

ACTS, CALLBACKS, OUTSIDE = 0, 1, 2
"""What comes first of what is due at one moment; whoever runs the host from outside comes when all else is done."""

PATIENCE = 60.0
"""Real seconds that a program's code may take without waiting, before `HostError` tells of it."""

INTERRUPT_PATIENCE = 5.0
"""Real seconds after Ctrl-C in which a program's code must go on, before it is left to itself."""

LAST_WAIT = 1.0
"""Real seconds in which a thread that is to end must have done so, before it is left to itself."""

_real_join = threading.Thread.join


class HostError(RobolinkError, RuntimeError):
    """A host cannot go on; the text says which program keeps it from doing so."""


class Turns:
    """Hands the turn from thread to thread, and moves time."""

    def __init__(self, host_time: HostTime) -> None:
        self.time = host_time
        self.due: deque[Any] = deque()
        """Inboxes, waits and jobs that have a turn, in order."""
        self.heap: list[tuple[int, int, int, int, Any]] = []
        """Timers, waits and jobs that have a moment: (time, rank, serial, version, thing)."""
        self.outside = Runner(self)
        """Whoever made the host, and runs it."""
        self.holder = self.outside
        self.switches = 0
        """How often the turn went from thread to thread."""
        self.picks = 0
        """How often it was asked what is next."""
        self.defaults = get_defaults()
        self.surroundings = Surroundings()
        self.beside = Beside()
        self.failure: BaseException | None = None
        self._serial = itertools.count()
        self._waits: dict[Wait, None] = {}
        self._watch: Wait | None = None
        """What is waited for outside."""
        self._asking: Wait | None = None
        """The same, if it has a condition, or an error is to be told there."""
        self._spare: list[Runner] = []
        self.runners = Runners()
        self._foreign: deque[tuple[Wait, int | None]] = deque()
        self.patience = PATIENCE
        self._closing = False

    # When

    def at(self, time_ns: int, thing: Any, rank: int = CALLBACKS) -> None:
        """Have something done at a moment of the host's time: a job, or a wait that ends."""
        heapq.heappush(self.heap, (time_ns, rank, next(self._serial), thing.version, thing))

    def schedule(self, time_ns: int, timer: Timer) -> None:
        """Have a timer called at a moment of the host's time."""
        heapq.heappush(self.heap, (time_ns, CALLBACKS, next(self._serial), timer.version, timer))

    # Waiting

    def runner(self) -> Runner | None:
        """Give the calling thread, if it takes turns."""
        found = self.runners.here()
        if found is None and self.holder is self.outside:
            return self.outside
        return found

    def wait(
        self, inbox: HostedInbox | None = None, holds: Callable[[], bool] | None = None, until: int | None = None
    ) -> None:
        """Let all others go on until something arrives at `inbox`, `holds()`, or the host's time is `until`."""
        me = self.runner() or self._adopted()
        if me.killed:
            raise Killed
        wait = me.wait = Wait(me, inbox, holds)
        try:
            if me.free:
                self._foreign.append((wait, until))
                me.park()
            else:
                self._note(wait, until)
                self._let_others(me, wait)
        finally:
            wait.version, me.wait = 1, None
            self._waits.pop(wait, None)
            if inbox is not None and inbox.waiter is wait:
                inbox.waiter = None
        if wait.error is not None:
            raise wait.error

    def _note(self, wait: Wait, until: int | None) -> None:
        is_outside = wait.runner is self.outside
        if wait.runner.program is not None:
            wait.runner.program.has_waited = True
        if wait.inbox is not None:
            wait.inbox.waiter = wait
        if until is not None:
            self.at(until, wait, OUTSIDE if is_outside else CALLBACKS)
        if is_outside:
            self._watch = wait
            self._asking = None if wait.holds is None and self.failure is None else wait
        elif wait.holds is not None:
            self._waits[wait] = None

    def _let_others(self, me: Runner, wait: Wait) -> None:
        turn = self._pick()
        if turn is wait:
            return
        if me is self.outside:
            self._go_on_with(turn)
        else:
            self._hand_to(turn)
            me.park()
        if self.surroundings.shown is not me.program:
            self.surroundings.show(me.program)

    def _go_on_with(self, turn: Any) -> None:
        """Hand on the turn from outside, and have it back; Ctrl-C breaks in anywhere."""
        try:
            self._hand_to(turn)
            while not self.outside.park(timeout=0.5):  # on Windows Ctrl-C does not break into a wait
                continue
        except BaseException:  # Ctrl-C: leave when the turn has come back
            self._call_back()
            raise

    def _call_back(self) -> None:
        """Have the turn outside again: as soon as it is handed on, or take it from code that does not go on."""
        ends = time.monotonic() + INTERRUPT_PATIENCE
        try:
            self.fail(HostError("interrupted"))
            is_back = False
            while not is_back and time.monotonic() < ends:
                is_back = self.holder is self.outside  # looked at first: what it is resumed by comes at once
                is_back = self.outside.park(timeout=0.1) or is_back
        finally:  # also when Ctrl-C comes once more
            if (stuck := self.holder) is not self.outside:
                self._take_turn(stuck, HostError(f"{name_of(stuck)} did not go on after Ctrl-C: {where_is(stuck)}"))
            self._watch = self._asking = self.failure = None  # the next wait has nothing to do with it

    def _hand_to(self, turn: Any) -> None:
        """Let another thread go on: the one that waited, or one that does what is due."""
        self.switches += 1
        if type(turn) is Wait:
            runner = turn.runner
        else:
            runner = self._spare.pop() if self._spare else self._new_worker()
            runner.turn = turn
        self.holder = runner
        runner.resume()

    def _new_worker(self) -> Runner:
        worker = Worker(self, self._work)
        self.runners.add(worker.runner)
        return worker.runner

    def _adopted(self) -> Runner:
        """Make a runner of a thread that the host knows nothing of: it runs beside the others."""
        runner = Runner(self)
        runner.free = True
        self.runners.belong(runner)
        return runner

    # Going on

    def _work(self, me: Runner) -> None:
        """Do what is due; hand on to threads that waited, and be spare then."""
        self.runners.belong(me)
        me.park()
        while not self._closing:
            turn = self._do_turns(me, me.turn)
            if turn is None:
                return
            self._spare.append(me)
            self._hand_to(turn)
            me.park()

    def _do_turns(self, me: Runner, turn: Any) -> Wait | None:
        """Do what is due until it is the turn of a thread that waited; None when this thread is to end."""
        pick = self._pick
        while type(turn) is not Wait:
            try:
                turn.run(me)
            except Killed:
                pass
            except BaseException as error:  # noqa: BLE001 - what is no program's is told whoever runs the host
                self.fail(error)
            if (me.killed or me.free) and self._is_at_end(me):
                return None
            turn = pick()
        return turn

    def _is_at_end(self, me: Runner) -> bool:
        """Whether this thread is to end: the host is closed, or the turn was taken from it."""
        me.killed = self._closing
        if me.free:
            self.runners.remove(me)
        return self._closing or me.free

    # What blocks

    def at_work(self) -> tuple[Runner | None, int]:
        """Give the program's thread whose turn it is, and a number that changes as the host goes on."""
        holder = self.holder
        return (None if holder is self.outside else holder), self.picks

    def pass_over(self, blocked: Runner, note: Callable[[Runner], None]) -> None:
        """Take the turn from a thread that seems to wait for another one of its program, if there is one; note that."""
        others = (each for each in self.runners if each.program is blocked.program and each is not blocked)
        if blocked.program is None or not any(not each.is_done and not each.is_idle for each in others):
            return
        if self.holder is not blocked:  # it has gone on meanwhile
            return
        note(blocked)  # before anybody goes on: it may come to an end then
        self.beside.add(blocked)
        self._hand_to(self._pick())

    def give_up(self, stuck: Runner) -> None:
        """Tell whoever runs the host of a thread that does not go on, and leave that one to itself."""
        stuck.free = True
        if (wait := self._watch) is not None:
            what = f"has kept all others waiting for {self.patience:g} s of real time"
            wait.error = HostError(f"{name_of(stuck)} {what}: {where_is(stuck)}")
            self._take_turn(stuck, wait.error)
            self.outside.resume()

    def tell_of_standstill(self, last: Runner) -> None:
        """Tell whoever runs the host that somebody always has something to do, so that time never goes on."""
        text = f"time has stood still for {self.patience:g} s of real time: somebody always has something to do"
        self.fail(HostError(f"{text}, just now {name_of(last)}"))

    def _take_turn(self, stuck: Runner, error: HostError) -> None:
        """Take the turn outside, from a thread that goes on by itself; its program counts as crashed."""
        stuck.free = True
        self._watch = self._asking = self.failure = None
        self.holder = self.outside
        if stuck.program is not None:
            stuck.program.give_up(error)

    def _is_news(self) -> bool:
        """Whether threads that take no turns have brought something to do."""
        is_asked = self._asking is not None and self._asking.is_over()
        return is_asked or bool(self.due or self._foreign) or any(map(Wait.is_over, self._waits))

    def fail(self, error: BaseException) -> None:
        """Have whoever runs the host meet this error."""
        self.failure = self.failure or error
        self._asking = self._watch

    def leave(self, me: Runner) -> None:
        """Hand on for good: this thread ends, and has no time to look who is next: somebody may join it."""
        self.runners.remove(me)
        if not self._closing and not me.free:
            self._hand_to(Job(None, lambda: None))

    def _pick(self) -> Any:
        """Give what is next: a wait that is over, or something to do."""
        self.picks += 1
        due = self.due
        while True:
            if self._asking is not None and (self.failure is not None or self._asking.is_over()):
                return self._back_outside()
            while due:
                turn = due.popleft()
                if type(turn) is HostedInbox:
                    turn.queued -= 1
                    executor = turn.executor
                    if executor is not None and executor.is_free:
                        return turn
                    turn = turn.waiter
                if turn is not None and self._may_have_turn(turn):
                    return turn
            turn = self._look_further()
            if turn is not None:
                return turn

    def _may_have_turn(self, turn: Any) -> bool:
        """Whether this is a job, or a wait that is not over; a thread that is free goes on beside the others."""
        if type(turn) is not Wait:
            return True
        if turn.version:
            return False
        if turn.runner.free:
            turn.version = 1
            turn.runner.resume()
            return False
        if turn is self._watch:
            self._back_outside()
        return True

    def _back_outside(self) -> Wait:
        watch, error = self._watch, self.failure
        assert watch is not None
        self._watch = self._asking = self.failure = None
        watch.error = watch.error or error
        return watch

    def _look_further(self) -> Any:
        """When nothing is due: look at conditions, then jump to the next moment; give what is to do, if it is known."""
        if self._foreign:
            self._take_in_foreign()
        if self._waits:
            self.due.extend(itertools.islice(filter(Wait.is_over, self._waits), 1))
        if self.due or (self.beside and self.beside.go_on(self._is_news)):
            return None
        heap = self.heap
        while heap:
            time_ns, _, _, version, thing = heapq.heappop(heap)
            if thing.version == version:
                return self._advance(time_ns, thing)
        self._nothing_to_come()
        return None

    def _advance(self, time_ns: int, thing: Any) -> Any:
        """Jump to a moment; give what is to do then, if it is known."""
        if time_ns > self.time._now:
            self.time._now = time_ns
        if type(thing) is Wait or type(thing) is Job:
            self.due.append(thing)
            return None
        executor = thing.executor
        if executor is None:
            return None
        executor.ready.append(thing)
        if executor.is_free:
            return executor.inbox
        executor.wake()
        return None

    def _take_in_foreign(self) -> None:
        for _ in range(len(self._foreign)):
            wait, until = self._foreign.popleft()
            if wait.runner in self.runners:  # the turn was taken from it, and it is back
                self.beside.remove(wait.runner)
            self._note(wait, until)

    def _nothing_to_come(self) -> None:
        """Tell whoever runs the host that it would wait for ever; but one that is free may still bring something."""
        if self.beside:
            return
        those = (each for each in self.runners if each.wait and each.program and not each.is_idle)
        error = HostError("; ".join(["all programs wait for ever, and nothing is to come", *map(where_waits, those)]))
        if self._watch is None:
            raise error
        self.fail(error)

    # The end

    def close(self) -> None:
        """End all threads of the host; whoever waits meets `Killed`."""
        self._closing = True
        runners = list(self.runners)
        for runner in runners:
            tell_of(runner)
            if runner.wait is not None:
                runner.wait.error = Killed()
            runner.killed = True
        for runner in runners:
            with contextlib.suppress(RuntimeError):
                runner.resume()
            if runner.thread is not None:
                _real_join(runner.thread, LAST_WAIT)
                if runner.is_host and runner.thread.is_alive():
                    end_thread(runner.thread)
        self.surroundings.close()
