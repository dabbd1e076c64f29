"""Driver of single-threaded executors in a host, which runs their callbacks in turn, without switching threads.

The host runs the executor of a program of Node classes until the program ends. It runs a script's executor as long as
the script spins it: the script's thread waits meanwhile, and goes on with the outcome of the spinning.
"""

from __future__ import annotations

from collections.abc import Callable
from heapq import heappush
from types import CoroutineType
from typing import TYPE_CHECKING, Any, cast

from robolink.executors import Executor, SingleThreadedExecutor
from robolink.host.participants import CALLBACKS, HostedInbox, Job, ProgramLike, Runner
from robolink.running.entity import NOTHING, Entity
from robolink.running.ready_queue import HELD
from robolink.running.waiting import POLL_NS
from robolink.task import asyncio_loop

if TYPE_CHECKING:
    import asyncio


class HostDriver:
    """Runs the callbacks of one executor: the host may run one while its inbox `is_free`."""

    def __init__(self, executor: SingleThreadedExecutor, program: ProgramLike) -> None:
        self.program = program
        self.inbox = cast(HostedInbox, executor.inbox)
        self._executor, self._context = executor, executor.context
        self._queue = executor._queue_
        self._own_run = None if type(executor).run is Executor.run else executor.run
        self._run: Callable[[Entity, Any], None] | None = self._own_run
        """Function that runs a callback; None for `Executor.run`."""
        self._queue.keep_time_by(self)
        self._defaults, self._env = program.defaults, program.env
        self._scheduler = program.host.scheduler
        self._view, self._host_time, self._time = self._scheduler.view, self._scheduler.time, executor.context.time
        self._heap, self._next_serial = self._scheduler.heap, self._scheduler.serial.__next__
        self.is_lent = False
        """True while somebody spins the executor, or its program's nodes are made."""
        self._stepper: Runner | None = None
        self._spinner: Runner | None = None
        self._stop: Callable[[], bool] | None = None
        self._outcome: BaseException | None = None
        self._has_ended = False
        self._loop: asyncio.AbstractEventLoop | None = None
        """The event loop of asyncio within which the executor is spun, if any."""
        self.inbox.run = _step(self)

    # What code of the program sees

    def runs_here(self) -> bool:
        """True if the calling thread is in a callback."""
        return self._stepper is not None and self._stepper is self._scheduler.runner()

    def schedule(self, timer: Any, left: int) -> None:
        """Make a timer ready in `left` nanoseconds of the program's steady time."""
        if left <= 0 and timer._period == 0:
            left = POLL_NS  # as often as possible is every millisecond: else time would stand still
        time = self._time
        due = self._host_time._now + left if time is self._host_time else time.on_base(time.steady() + left)
        serial = self._next_serial  # for Python 3.11 a function in an attribute, no method
        heappush(self._heap, (due, CALLBACKS, serial(), timer.version, timer))

    def postpone(self, task: Entity) -> None:
        """Run the next part of a task in a moment."""
        self._scheduler.at(self._scheduler.time.now() + POLL_NS, Job(self.program, lambda: self._queue.post(task)))

    # Being spun

    def release(self) -> None:
        """Start running callbacks, until the program ends: its nodes are made."""
        self.is_lent = self.inbox.is_free = True
        self.inbox.wake()

    def withdraw(self) -> None:
        """Run no more callbacks."""
        self.is_lent = self.inbox.is_free = False

    def spin(self, deadline: int | None, stop: Callable[[], bool] | None) -> bool:
        """Wait while the host runs callbacks, until `stop()` or the deadline; False at once within another spinning."""
        if self.is_lent or self._stepper is not None:
            return False
        self._spinner, self._stop, self._outcome, self._has_ended = self._scheduler.runner(), stop, None, False
        self._loop = asyncio_loop()
        if self._loop is not None:
            self._run = self._run_within_loop
        try:
            self._wait_while_lent(deadline)
        finally:
            self.withdraw()
            self._spinner = self._stop = self._loop = None
            self._run = self._own_run
        if not self._rests():  # the time is over, but not the callback that is under way
            self._scheduler.wait(holds=self._rests)
        self._raise_outcome()
        return True

    def _run_within_loop(self, entity: Entity, taken: Any) -> None:
        """Run one callback as in the thread that spins, in which an event loop runs."""
        import asyncio

        asyncio._set_running_loop(self._loop)
        try:
            self._executor.run(entity, taken)
        finally:
            asyncio._set_running_loop(None)

    def _rests(self) -> bool:
        return self._stepper is None

    def _raise_outcome(self) -> None:
        outcome, self._outcome = self._outcome, None
        if outcome is not None:
            raise outcome

    def _wait_while_lent(self, deadline: int | None) -> None:
        time = self._context.time
        until = None if deadline is None else time.on_base(deadline)
        while not self._has_ended and (deadline is None or time.steady() < deadline):
            if self._stop is not None and self._stop():
                return
            if not self._context.ok() or self._executor._is_shutdown:
                if not self._executor._is_shutdown:
                    self._executor.check_end()
                return
            self.is_lent, self.inbox.is_free = True, self._stepper is None
            self.inbox.wake()
            self._scheduler.wait(until=until)

    # Running

    def _take_and_run(self, runner: Runner) -> bool:
        """Run the callback whose turn it is; False if there is none."""
        found = self._queue.take()
        if found is None:
            self._check_end()
            return False
        self.inbox.is_free, self._stepper = False, runner
        run = self._run or self._executor.run
        run(*found)
        return True

    def _has_run(self, entity: Entity, outcome: Any) -> bool:
        """Go on after the turn of an entity that was ready alone, by its outcome; False if no callback was run."""
        if outcome is not HELD and outcome is not NOTHING:
            if isinstance(outcome, CoroutineType):
                self._executor.run_coroutine(entity, outcome)
            return True
        if outcome is HELD:
            self._queue.hold_back(entity)
        self._stepper, self.inbox.is_free = None, self.is_lent
        self._check_end()
        return False

    def _check_end(self) -> None:
        """Let the spinning thread go if, with nothing ready, it is to end."""
        if self._is_at_end():
            self._let_go()

    def _is_at_end(self) -> bool:
        if not self._context._ok or self._executor._is_shutdown:
            return True
        return self._stop is not None and self._stop()

    def _end(self, error: BaseException | None = None) -> None:
        """End the spinning after a callback, with the exception that it raised."""
        if self.program.driver is self:
            self.withdraw()
            self.program.end(error)
        else:
            self._outcome, self._has_ended = error, True
            self._let_go()

    def _let_go(self) -> None:
        """Wake the thread that spins, to check if it goes on."""
        self.inbox.is_free = False
        if self.program.driver is self:
            self._end()
        elif self._spinner is not None and self._spinner.wait is not None:
            self._scheduler.due.append(self._spinner.wait)


def _step(driver: HostDriver) -> Callable[[Runner], None]:
    """Return the function that runs one callback, if one is ready.

    A closure, and with what it calls written out, since every callback of every program comes here.
    """
    program, defaults, env, view = driver.program, driver._defaults, driver._env, driver._view
    queue, inbox, context, executor = driver._queue, driver.inbox, driver._context, driver._executor
    ready, turns, blocked = queue.ready, queue.turns, queue.blocked

    def step(runner: Runner) -> None:
        if runner.defaults is not defaults:
            runner.program, runner.defaults = program, defaults
            runner.place[0] = defaults
            if view.env is not env:
                view.show(program)
        if queue.pollables:
            queue.poll()
        try:
            # A round of one, as usual; without the lock: one thread runs at a time, and what arrives takes none either.
            if len(ready) == 1 and not blocked and not turns and driver._run is None:
                entity = ready.popleft()
                queue._ran_tasks, queue._took = False, True
                inbox.is_free, driver._stepper = False, runner
                outcome = entity.turn()
                has_run = outcome is None or driver._has_run(entity, outcome)
            else:
                has_run = driver._take_and_run(runner)
        except BaseException as error:  # noqa: BLE001 - whoever spins meets it
            driver._stepper = None
            driver._end(error)
            return
        if not has_run:
            return
        driver._stepper = None
        if (driver._stop is not None or not context._ok or executor._is_shutdown) and driver._is_at_end():
            driver._end()
            return
        inbox.is_free = driver.is_lent
        if not inbox.queued and (ready or turns or blocked):
            inbox.wake()

    return step
