"""The single-threaded executors of hosted programs: the host runs their callbacks in turn, without switching threads.

A program of Node classes has one that the host runs until the program ends. A script's is the host's as long as the
script spins it: the script's thread waits meanwhile, and goes on with what came out of the spinning.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast

from robolink.entity import NOTHING, Entity
from robolink.executors import POLL_NS, SingleThreadedExecutor
from robolink.oneprocess.parts import HostedInbox, Job, Runner
from robolink.timer import Timer

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.oneprocess.hosted import HostedContext
    from robolink.oneprocess.program import Program


class HostedExecutor(SingleThreadedExecutor):
    """The host may run a callback of it while it `is_free`."""

    inbox: HostedInbox

    def __init__(self, *, context: Context | None = None) -> None:
        super().__init__(context=context)
        self.program: Program = cast("HostedContext", self._context).program
        self.is_free = False
        """Whether the host may run a callback: while somebody spins it, and no callback is under way."""
        self.inbox.executor = self
        self.inbox.run = self.step  # type: ignore[method-assign] # in place of a method that would only call it
        self._turns = self.program.host.the_turns
        self._surroundings = self._turns.surroundings
        self._is_lent = False
        self._stepper: Runner | None = None
        self._spinner: Runner | None = None
        self._stop: Callable[[], bool] | None = None
        self._outcome: BaseException | None = None
        self._has_ended = False
        self._taken: Any = None

    # What code of the program sees

    @property
    def spinning(self) -> bool:
        """Whether it runs callbacks."""
        return self._is_lent or super().spinning

    @property
    def spins_here(self) -> bool:
        """Whether the calling thread is in a callback."""
        return (self._stepper is not None and self._stepper is self._turns.runner()) or super().spins_here

    def schedule(self, timer: Timer, left: int) -> None:
        """Have a timer made ready in `left` nanoseconds of the program's steady time."""
        if left <= 0 and timer._period == 0:
            left = POLL_NS  # as often as possible is every millisecond: else time would stand still
        time, turns = self._context.time, self._turns
        due = turns.time._now + left if time is turns.time else time.on_base(time.steady() + left)
        turns.schedule(due, timer)

    def poll(self, entity: Entity) -> None:
        """Make an entity ready again in a moment."""
        self._turns.at(self._turns.time.now() + POLL_NS, Job(self.program, lambda: self.post(entity)))

    # Being spun

    def release(self) -> None:
        """Have callbacks run until the program ends: its nodes are made."""
        self._is_lent = self.is_free = True
        self.wake()

    def withdraw(self) -> None:
        """Have no more callbacks run."""
        self._is_lent = self.is_free = False

    def _spin(self, deadline: int | None = None, stop: Callable[[], bool] | None = None, *, once: bool = False) -> None:
        """Run callbacks, as `Executor._spin`: have the host do so, unless it is for one, or within another one."""
        if once or self._is_lent or self._stepper is not None:
            super()._spin(deadline, stop, once=once)
            return
        self._spinner, self._stop, self._outcome, self._has_ended = self._turns.runner(), stop, None, False
        try:
            self._wait_while_lent(deadline)
        finally:
            self.withdraw()
            self._spinner = self._stop = None
        if not self._rests():  # the time is over, but not the callback that is under way
            self._turns.wait(holds=self._rests)
        self._raise_outcome()

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
            if not self._context.ok() or self._is_shutdown:
                if not self._is_shutdown:
                    self.check_end()
                return
            self._is_lent, self.is_free = True, self._stepper is None
            self.wake()
            self._turns.wait(until=until)

    # Running

    def step(self, runner: Runner) -> None:
        """Run one callback, if one is ready."""
        if self.asked:
            self._ask_waitables()
        entity = self._take_first()
        program = self.program
        if runner.defaults is not program.defaults:
            runner.enter(program, shows=False)
        if self._surroundings.env is not program.env:
            self._surroundings.show(program)
        if entity is None:
            if self._is_at_end():
                self._let_go()
            return
        self.is_free, self._stepper = False, runner
        try:
            self.run(entity, self._taken)
        except BaseException as error:  # noqa: BLE001 - whoever spins meets it
            self._stepper = None
            self._end(error)
            return
        self._stepper = None
        if not self._context._ok or self._is_shutdown or (self._stop is not None and self._stop()):
            self._end()
            return
        self.is_free = self._is_lent
        if (self.ready or self._blocked) and not self.inbox.queued:
            self.inbox.wake()

    def _take_first(self) -> Entity | None:
        """Take as `_take` does, without its lock: nobody else runs; give the entity, and keep what it gave."""
        if self._blocked:
            self._unblock()
        ready = self.ready
        while ready:
            entity = ready.popleft()
            group = entity.gate
            if group.can_execute(entity) and group.beginning_execution(entity):
                self._taken = entity.take()
                if self._taken is not NOTHING:
                    return entity
                group.ending_execution(entity)
            else:
                self._blocked.append(entity)
        return None

    def _is_at_end(self) -> bool:
        return not self._context._ok or self._is_shutdown or (self._stop is not None and self._stop())

    def _end(self, error: BaseException | None = None) -> None:
        """Have the spinning end after a callback, with what it raised."""
        if self.program.executor is self:
            self.withdraw()
            self.program.end(error)
        else:
            self._outcome, self._has_ended = error, True
            self._let_go()

    def _let_go(self) -> None:
        """Let whoever spins look whether to go on."""
        self.is_free = False
        if self.program.executor is self:
            self._end()
        elif self._spinner is not None and self._spinner.wait is not None:
            self._turns.due.append(self._spinner.wait)
