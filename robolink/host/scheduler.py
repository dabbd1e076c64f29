"""Cooperative scheduler of a host: one thread runs at a time, and the order of turns is deterministic.

What is due is done in the order in which it became due. When nothing is, the conditions that threads wait for are
looked at; then time jumps to the next moment that somebody waits for. Executors of Node classes share the thread that
decides all this, so that no thread is switched between their callbacks; a callback that waits keeps its thread, and
another takes its place.
"""

from __future__ import annotations

import contextlib
import itertools
import threading
from collections import deque
from collections.abc import Callable
from heapq import heappop, heappush
from typing import Any

from robolink.host.background_threads import BackgroundThreads
from robolink.host.call_sites import name_of, where_is, where_waits
from robolink.host.participants import CALLBACKS, OUTSIDE, HostedInbox, HostError, Job, Killed, Runner, Runners, Wait
from robolink.host.patches.environment import ProcessView
from robolink.host.real_waits import RealWaits
from robolink.host.threads import Worker, end_thread, tell_of
from robolink.running.defaults import get_defaults
from robolink.running.timebase import VirtualTime
from robolink.system import clocks
from robolink.system.waits import A_WHILE

PATIENCE = 60.0
"""Real seconds that a program's code may run without waiting, before `HostError` is raised."""

INTERRUPT_PATIENCE = 5.0
"""Real seconds from Ctrl-C until code that does not go on is left to itself."""

LAST_WAIT = 1.0
"""Real seconds that a thread has to end at the close, before it is left to itself."""

_real_join = threading.Thread.join


class Scheduler:
    """Hands the turn from thread to thread, and moves virtual time."""

    def __init__(self, host_time: VirtualTime) -> None:
        self.time = host_time
        self.due: deque[Any] = deque()
        """Ready queue: inboxes, waits and jobs that have a turn, in order."""
        self.heap: list[tuple[int, int, int, int, Any]] = []
        """Heap of timers, waits and jobs that have a moment: (time, rank, serial, version, thing)."""
        self.outside = Runner(self)
        """The thread that made the host and runs it."""
        self.holder = self.outside
        self.switches = 0
        """Number of switches from thread to thread."""
        self.picks = 0
        """Number of picks of the next turn; it changes as long as the host goes on."""
        self.defaults = get_defaults()
        self.view = ProcessView()
        self.background = BackgroundThreads()
        self.real_waits = RealWaits()
        self.failure: BaseException | None = None
        self.serial = itertools.count()
        self._waits: dict[Wait, None] = {}
        self._watch: Wait | None = None
        """The wait of the thread outside."""
        self._asking: Wait | None = None
        """The same, if it has a condition, or an error is to be raised there."""
        self._spare: list[Runner] = []
        self.runners = Runners()
        self._foreign: deque[tuple[Wait, int | None]] = deque()
        self.patience = PATIENCE
        self._closing = False

    # When

    def at(self, time_ns: int, thing: Any, rank: int = CALLBACKS) -> None:
        """Schedule a job, or the end of a wait, for a moment of the host's time."""
        heappush(self.heap, (time_ns, rank, next(self.serial), thing.version, thing))

    # Waiting

    def runner(self) -> Runner | None:
        """Return the calling thread, if it takes turns."""
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
        error, wait.error = wait.error, None  # else it would keep all these frames until the wait's moment
        if error is not None:
            raise error

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
        if self.view.shown is not me.program:
            self.view.show(me.program)

    def _go_on_with(self, turn: Any) -> None:
        """Hand on the turn from outside, and wait until it is back; Ctrl-C breaks in anywhere."""
        try:
            self._hand_to(turn)
            while not self.outside.park(timeout=A_WHILE):  # on Windows Ctrl-C does not break into a wait
                continue
        except BaseException:  # Ctrl-C: leave when the turn has come back
            self._call_back()
            raise

    def _call_back(self) -> None:
        """Take the turn back: as soon as it is handed on, or from code that does not go on."""
        ends = clocks.monotonic() + INTERRUPT_PATIENCE
        try:
            self.fail(HostError("interrupted"))
            is_back = False
            while not is_back and clocks.monotonic() < ends:
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
        """Run turns; after handing on to a thread that waited, be spare until there is work again."""
        self.runners.belong(me)
        me.park()
        while not self._closing:
            turn = self._do_turns(me, me.turn)
            if turn is None:
                return
            self._spare.append(me)
            self._hand_to(turn)
            me.park()
            me.defaults = None  # others have shown their programs meanwhile

    def _do_turns(self, me: Runner, turn: Any) -> Wait | None:
        """Run turns until it is that of a thread that waited; None when this thread is to end."""
        due, pick, look_further = self.due, self._pick, self._look_further
        while type(turn) is not Wait:
            try:
                run = turn.run  # for Python 3.11 a function in an attribute, no method
                run(me)
            except Killed:
                pass
            except BaseException as error:  # noqa: BLE001 - what is not a program's is told whoever runs the host
                self.fail(error)
            if (me.killed or me.free) and self._is_at_end(me):
                return None
            if self._asking is None:  # `_pick` written out for the usual cases
                if not due:
                    turn = look_further()
                    if turn is not None:
                        self.picks += 1
                        continue
                elif type(turn := due[0]) is HostedInbox and turn.is_free:
                    due.popleft()
                    self.picks += 1
                    turn.queued -= 1
                    continue
            turn = pick()
        return turn

    def _is_at_end(self, me: Runner) -> bool:
        """Return True if this thread is to end: the host is closed, or the turn was taken from it."""
        me.killed = self._closing
        if me.free:
            self.runners.remove(me)
        return self._closing or me.free

    # What blocks

    def at_work(self) -> tuple[Runner | None, int]:
        """Return the program's thread whose turn it is, and a number that changes as the host goes on."""
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
        self.background.add(blocked)
        self._hand_to(self._pick())

    def give_up(self, stuck: Runner) -> None:
        """Raise an error outside about a thread that does not go on, and leave that one to itself."""
        stuck.free = True
        if (wait := self._watch) is not None:
            what = f"has kept all others waiting for {self.patience:g} s of real time"
            wait.error = HostError(f"{name_of(stuck)} {what}: {where_is(stuck)}")
            self._take_turn(stuck, wait.error)
            self.outside.resume()

    def tell_of_standstill(self, last: Runner) -> None:
        """Raise an error outside about time that stands still: some code always has something to do."""
        text = f"time has stood still for {self.patience:g} s of real time: somebody always has something to do"
        self.fail(HostError(f"{text}, just now {name_of(last)}"))

    def _take_turn(self, stuck: Runner, error: HostError) -> None:
        """Take the turn from a thread that goes on by itself, whose program counts as crashed; resume outside."""
        stuck.free = True
        self._watch = self._asking = self.failure = None
        self.holder = self.outside
        if stuck.program is not None:
            stuck.program.give_up(error)

    def _is_news(self) -> bool:
        """Return True if threads that take no turns have brought something to do."""
        is_answered = self._asking is not None and self._asking.is_over()
        has_more = self.failure is not None or bool(self.due or self._foreign)
        return is_answered or has_more or any(map(Wait.is_over, self._waits))

    def until_next(self) -> int | None:
        """Return the nanoseconds to the next moment that somebody waits for; None if nobody does."""
        heap = self.heap
        while heap and heap[0][4].version != heap[0][3]:
            heappop(heap)
        return heap[0][0] - self.time._now if heap else None

    def pass_time(self, nanoseconds: int) -> bool:
        """Move time by so much, as real time has. Return True if there is something to do."""
        self.time._now += nanoseconds
        self.picks += 1  # for the watchdog: the host does go on
        return self._is_news()

    def fail(self, error: BaseException) -> None:
        """Raise this error in the thread that runs the host."""
        self.failure = self.failure or error
        self._asking = self._watch

    def leave(self, me: Runner) -> None:
        """Hand on for good: this thread ends, without looking who is next: somebody may join it."""
        self.runners.remove(me)
        if not self._closing and not me.free:
            self._hand_to(Job(None, lambda: None))

    def _pick(self) -> Any:
        """Return the next turn: a wait that is over, or something to run."""
        self.picks += 1
        due = self.due
        while True:
            if self._asking is not None and (self.failure is not None or self._asking.is_over()):
                return self._back_outside()
            while due:
                turn = due.popleft()
                if type(turn) is HostedInbox:
                    turn.queued -= 1
                    if turn.is_free:
                        return turn
                    turn = turn.waiter
                if turn is not None and self._may_have_turn(turn):
                    return turn
            turn = self._look_further()
            if turn is not None:
                return turn

    def _may_have_turn(self, turn: Any) -> bool:
        """Return True for a job, or a wait that is not over; a thread that is free is resumed beside the others."""
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
        """Check conditions when nothing is due, then jump to the next moment. Return the next turn, if it is known."""
        if self._foreign:
            self._take_in_foreign()
        if self._waits:
            self.due.extend(itertools.islice(filter(Wait.is_over, self._waits), 1))
        if self.due or (self.background.threads and self.background.go_on(self._is_news)):
            return None
        if self.real_waits.waiting and self.real_waits.go_on(self):
            return None
        heap, time = self.heap, self.time
        while heap:
            time_ns, _, _, version, thing = heappop(heap)
            if thing.version == version:
                if time_ns > time._now:
                    time._now = time_ns
                if type(thing) is Wait or type(thing) is Job:
                    self.due.append(thing)
                    return None
                return self._turn_of_timer(thing._queue_, thing, time_ns)
        self._nothing_to_come()
        return None

    def _turn_of_timer(self, queue: Any, timer: Any, time_ns: int) -> Any:
        """Return the turn of a timer that is due, if it is known; what is due there next joins it in one round."""
        if queue is None:
            return None
        queue.ready.append(timer)
        heap = self.heap
        while heap and heap[0][0] == time_ns:
            other = heap[0][4]
            if type(other) is Wait or type(other) is Job or other._queue_ is not queue:
                break
            if heappop(heap)[3] == other.version:
                queue.ready.append(other)
        inbox = queue.inbox
        if inbox.is_free:
            return inbox
        inbox.wake()
        return None

    def _take_in_foreign(self) -> None:
        for _ in range(len(self._foreign)):
            wait, until = self._foreign.popleft()
            if wait.runner in self.runners:  # the turn was taken from it, and it is back
                self.background.remove(wait.runner)
            self._note(wait, until)

    def _nothing_to_come(self) -> None:
        """Raise a deadlock as an error outside; not while a thread that is free may still bring something."""
        if self.background:
            return
        those = (each for each in self.runners if each.wait and each.program and not each.is_idle)
        error = HostError("; ".join(["all programs wait for ever, and nothing is to come", *map(where_waits, those)]))
        if self._watch is None:
            raise error
        self.fail(error)

    # The end

    def close(self) -> None:
        """End all threads of the host; where they wait, `Killed` is raised."""
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
        self.view.close()
