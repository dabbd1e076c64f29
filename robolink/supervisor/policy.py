"""Restart policy of a system: rules of its processes, and a pure state machine: events in, actions out.

Times are seconds of any one clock and there are no processes here, so that the same decisions are made for real
processes, for nodes in virtual time, and in tests.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Literal, TypeAlias

# Rules

RespawnWhen: TypeAlias = Literal["never", "on_failure", "always"]
OnExit: TypeAlias = Literal["shutdown", "ignore"]
Severity: TypeAlias = Literal["DEBUG", "INFO", "WARN", "ERROR", "FATAL"]
"""Severity of a line, in ROS's words."""
NO_LIMIT = 10**9
"""Number of restarts, and of seconds, that stands for no limit."""


class Step(IntEnum):
    """Escalation steps of stopping a process."""

    INTERRUPT = 0
    TERMINATE = 1
    KILL = 2
    GIVE_UP = 3


@dataclass(frozen=True)
class Restarts:
    """Restart rule of a process that ends by itself: `when` says never, after any end, or after any but exit code 0.

    Exponential backoff: it waits `delay` seconds, twice as long each time (up to `delay_max`), until the process has
    once run for `within` seconds. After `most` restarts in the last `within` seconds it is given up.
    """

    when: RespawnWhen = "never"
    delay: float = 1.0
    delay_max: float = 30.0
    most: int = 5
    within: float = 60.0

    def wants(self, returncode: int) -> bool:
        """True if a process that ended with this `returncode`, as `Popen` has it, is to be restarted."""
        return self.when == "always" or (self.when == "on_failure" and returncode != 0)

    def pause(self, streak: int) -> float:
        """Return the backoff in seconds after `streak` restarts in a row that did not last."""
        longest = max(self.delay, self.delay_max)
        return min(longest, self.delay * 2.0 ** min(streak, 60))


@dataclass(frozen=True)
class Rules:
    """Rules of one process: `respawn` for restarts, `on_exit` for the meaning of its end for the system.

    One that is `held` starts only when it is released. `awaits` are the processes without which it will never be
    released; it may wait for other things besides. `patience` is the time from SIGINT to SIGTERM, and from there to
    SIGKILL, in seconds, when it alone is stopped; None is that of the whole system.
    """

    respawn: Restarts = field(default_factory=Restarts)
    on_exit: OnExit = "shutdown"
    held: bool = False
    awaits: frozenset[str] = frozenset()
    patience: tuple[float, float] | None = None


def exit_code(returncode: int) -> int:
    """Convert a `Popen` return code to a shell's exit code: 128 + N for a process killed by signal N."""
    return 128 - returncode if returncode < 0 else returncode


def described(returncode: int) -> str:
    """Describe a return code in words: `ended with exit code 3`, `was killed by SIGSEGV`."""
    if returncode == 0:
        return "has ended"
    if returncode in _WINDOWS_ENDS:
        return f"ended by {_WINDOWS_ENDS[returncode]} (0x{returncode:08X})"
    if returncode > 0:
        return f"ended with exit code {returncode}"
    try:
        return f"was killed by {signal.Signals(-returncode).name}"
    except ValueError:
        return f"was killed by signal {-returncode}"


_CONTROL_C_EXIT = 0xC000013A
_WINDOWS_ENDS = {
    0xC0000005: "an access violation",
    0xC000001D: "an illegal instruction",
    0xC0000094: "a division by zero",
    0xC00000FD: "a stack overflow",
    0xC0000135: "a DLL that was not found",
    _CONTROL_C_EXIT: "Ctrl-C",
    0xC0000374: "a damaged heap",
    0xC0000409: "a damaged stack, or abort()",
}
"""Names of the Windows return codes (NTSTATUS) that would be a signal elsewhere."""


def is_orderly(returncode: int, step: Step, cause: str = "") -> bool:
    """True if a process that had been requested to stop by `step` ended in an orderly way.

    An uncaught KeyboardInterrupt is orderly too, and so is a Python that is interrupted before its program began: it
    may turn that into any error.
    """
    obeyed = {0, 128 + signal.SIGINT, 128 + signal.SIGTERM}
    if sys.platform == "win32":
        obeyed |= {_CONTROL_C_EXIT, 1} if step >= Step.TERMINATE else {_CONTROL_C_EXIT}
    return exit_code(returncode) in obeyed or cause.startswith(("KeyboardInterrupt", "Fatal Python error: init_"))


# State machine

_ECHO = 0.2
"""Debounce time of interrupts, in seconds: a terminal and a wrapper may both deliver the same one."""

State: TypeAlias = Literal["held", "waiting", "running", "stopping", "stopped", "ended"]
"""Process states. Held: not released yet; waiting: for its (re)start; stopped: on request; ended: by itself."""


@dataclass(frozen=True)
class Start:
    """Action: start the process `name`, which does not run."""

    name: str


@dataclass(frozen=True)
class Ask:
    """Action: ask the process `name` to stop."""

    name: str
    step: Step


@dataclass(frozen=True)
class Say:
    """Action: print a line to the user; `severity` is for its colour, and no part of what is decided."""

    text: str
    severity: Severity = field(default="INFO", compare=False)


Action: TypeAlias = "Start | Ask | Say"


@dataclass
class Tracked:
    """State of one process; read-only for others."""

    name: str
    rules: Rules
    state: State
    since: float = 0.0
    """Time at which it came into its state."""
    starts: int = 0
    returncode: int | None = None
    """Last return code; None before the first end."""
    cause: str = ""
    """Cause of the last end, in words; empty if unknown."""
    due: float | None = None
    """Time of its restart, or of the next step of stopping it; None if nothing is planned."""
    step: Step | None = None
    """Last step by which it was requested to stop; None if it was not."""
    is_restart: bool = False
    """True if it is to be restarted once it has stopped."""
    streak: int = 0
    respawned: list[float] = field(default_factory=list)

    @property
    def is_alive(self) -> bool:
        """True while it runs, requested to stop or not."""
        return self.state in ("running", "stopping")

    @property
    def restarts(self) -> int:
        """Number of restarts, for whatever reason."""
        return max(0, self.starts - 1)


class Policy:
    """State machine of a whole system: it ends on request, with its last process, or with one whose end counts.

    `ends` is the time at which the system ends by itself; it may still be set before `begin`. While it stops, processes
    are requested to by the next step every `patience` seconds. Call `begin` first; carry out the returned actions in
    order.
    """

    def __init__(self, rules: Mapping[str, Rules], *, ends: float | None = None, patience: float = 5.0) -> None:
        self.processes = {name: _tracked(name, each) for name, each in rules.items()}
        self.step: Step | None = None
        """Last step by which the whole system was requested to stop; None if it was not."""
        self.ends = ends
        self.expects_more = False
        """True while further processes may be added, so that the system goes on without any."""
        self._patience = patience
        self._code: int | None = None
        self._is_requested = False
        self._requested_at = 0.0

    @property
    def alive(self) -> list[str]:
        """Names of the processes that run."""
        return [name for name, each in self.processes.items() if each.is_alive]

    @property
    def is_over(self) -> bool:
        """True once no process runs and none will."""
        if self.step is Step.GIVE_UP:
            return True
        coming = self.expects_more or any(each.state in ("held", "waiting") for each in self.processes.values())
        return not self.alive and (self.step is not None or not coming)

    @property
    def deadline(self) -> float | None:
        """Time at which `woken` is to be called if nothing else happens before; None if not at all."""
        if self.is_over:
            return None
        if self.step is not None:
            return self._requested_at + self._patience_of_all(self.step)
        due = [each.due for each in self.processes.values() if each.due is not None]
        return min(due if self.ends is None else [*due, self.ends], default=None)

    @property
    def code(self) -> int:
        """Exit code of the system.

        It is the code of the process whose end was the system's: the first whose end is not ignored, or else the
        last of all; 128 + N when signal N killed it. After an orderly stop on request it is 0; when a process ended
        in disorder on the way, the first such one's.
        """
        return self._code or 0

    def begin(self, now: float) -> list[Action]:
        """Start the system: all processes that are not held."""
        for each in self.processes.values():
            each.since = now
        return self._start_all(lambda each: each.state == "waiting" and each.due is None, now)

    def add(self, name: str, rules: Rules, now: float) -> list[Action]:
        """Add a process and start it, unless it is held or the system is ending."""
        each = self.processes[name] = _tracked(name, rules)
        each.since = now
        if self.step is not None:
            _move(each, "stopped", now)
            return []
        return self._start(each, now) if each.state == "waiting" else []

    def end(self, reason: str, code: int, now: float) -> list[Action]:
        """Handle that something other than a process or the user ends the system, with this exit code."""
        if self.step is not None:
            return []
        self._code = code
        return [Say(reason, "ERROR" if code else "INFO"), *self._harder(now)]

    def released(self, name: str, now: float) -> list[Action]:
        """Handle that the conditions of a held process are met."""
        return self._start_all(lambda each: each.name == name and each.state == "held", now)

    def exited(self, name: str, returncode: int, now: float, cause: str = "") -> list[Action]:
        """Handle the end of a process, with `Popen`'s return code: negative for a signal. `cause` is shown to users."""
        each = self.processes[name]
        if not each.is_alive:
            return []
        step, is_restart, ran = each.step, each.is_restart, now - each.since
        how = f"{name} {described(returncode)}{_why(each, returncode, cause, ran)}"
        _move(each, "ended" if step is None else "stopped", now)
        each.returncode, each.cause = returncode, cause
        if self.step is not None:
            return self._ended_on_the_way(how, returncode, is_orderly(returncode, step or Step.INTERRUPT, cause))
        if step is None:
            return self._ended(each, how, ran, now)
        report: list[Action] = [] if is_orderly(returncode, step, cause) else [_end(how, returncode)]
        if is_restart:
            return [*report, *self._start(each, now)]
        if self.is_over:
            self._code = exit_code(returncode) if report else 0
        return [*(report or [Say(f"{name} has stopped")]), *self._only_held(now)]

    def interrupted(self, now: float, *, in_hurry: bool = True) -> list[Action]:
        """Handle a request to end the system; if it is stopping already, `in_hurry` goes on to the next step."""
        if self.step is not None:
            is_echo = now - self._requested_at < _ECHO
            return self._harder(now) if in_hurry and not is_echo else []
        self._is_requested = True
        return [Say("stopping (Ctrl-C again to hurry)"), *self._harder(now)]

    def woken(self, now: float) -> list[Action]:
        """Handle that time has passed: due restarts, steps of stopping, and the end of the system."""
        if self.deadline is None or now < self.deadline:
            return []
        if self.step is not None:
            late = self._late(*self.alive, patience=self._patience_of_all(self.step))
            return [late, *self._harder(now)]
        if self.ends is not None and now >= self.ends:
            self._is_requested = True
            return self._harder(now)
        due = [each for each in self.processes.values() if each.due is not None and each.due <= now]
        return [
            action
            for each in due
            for action in (self._start(each, now) if each.state == "waiting" else self._one_harder(each, now))
        ]

    def restart(self, name: str, now: float) -> list[Action]:
        """Handle a request to restart a process: one that runs is stopped in order first, and that is not a failure."""
        each = self.processes[name]
        if why_not := self.why_not_restarted(name):
            return [Say(f"{name} is not restarted: {why_not}")]
        each.streak, each.respawned = 0, []
        if not each.is_alive:
            return [Say(f"starting {name}"), *self._start(each, now)]
        each.is_restart = True
        return [] if each.step is not None else [Say(f"restarting {name}"), *self._one_harder(each, now)]

    def why_not_restarted(self, name: str) -> str:
        """Return why `restart` would do nothing now; '' if it would do something."""
        if self.step is not None:
            return "the system is stopping"
        is_held = self.processes[name].state == "held"
        return "it is not started yet, since it waits for something else" if is_held else ""

    def stop_one(self, name: str, now: float, *, is_interrupted: bool = False) -> list[Action]:
        """Handle a request to stop one process; the others go on. Somebody else may have interrupted it already."""
        each = self.processes[name]
        if self.why_not_stopped(name):
            return []
        if each.is_restart:
            each.is_restart = False
            return [Say(f"{name} is not started again")]
        if each.state == "running":
            steps = self._one_harder(each, now)
            return [Say(f"stopping {name}"), *([] if is_interrupted else steps)]
        again = " again" if each.starts else ""
        _move(each, "stopped", now)
        return [Say(f"{name} is not started{again}"), *self._only_held(now)]

    def why_not_stopped(self, name: str) -> str:
        """Return why `stop_one` would do nothing now; '' if it would do something."""
        each = self.processes[name]
        if self.step is not None:
            return "the system is stopping"
        if each.state == "ended":
            return f"it {described(each.returncode or 0)}"
        if each.state == "stopped":
            return "somebody has stopped it already"
        return "it is being stopped already" if each.state == "stopping" and not each.is_restart else ""

    def _start_all(self, is_meant: Callable[[Tracked], bool], now: float) -> list[Action]:
        meant = [each for each in self.processes.values() if is_meant(each)]
        return [action for each in meant for action in self._start(each, now)]

    def _start(self, each: Tracked, now: float) -> list[Action]:
        if self.step is not None:
            return []
        _move(each, "running", now)
        each.starts += 1
        return [Start(each.name)]

    def _ended(self, each: Tracked, how: str, ran: float, now: float) -> list[Action]:
        """Handle the end of a process that was not requested to stop."""
        rule, code = each.rules.respawn, each.returncode or 0
        mark = ";" if ": " in how else ":"  # behind a cause or not
        if rule.wants(code):
            recent = each.respawned if rule.most < NO_LIMIT else []  # all of them would fill the memory
            each.respawned = [then for then in recent if now - then < rule.within]
            if len(each.respawned) < rule.most:
                return [_end(f"{how}{mark} {_respawn(each, ran, now)}", code)]
            within = "" if rule.within == NO_LIMIT else f" within {rule.within:g} s"
            how += f"{mark} given up after {rule.most} new start{'s' * (rule.most != 1)}{within}"
        if each.rules.on_exit == "ignore":
            self._code = exit_code(code) if self.is_over else None
            return [_end(how, code), *self._only_held(now)]
        self._code = exit_code(code)
        return [_end(how, code), *self._harder(now)]

    def _ended_on_the_way(self, how: str, returncode: int, is_fine: bool) -> list[Action]:
        if not self._is_requested or is_fine:
            return []
        self._code = self._code or exit_code(returncode)
        return [_end(how, returncode)]

    def _only_held(self, now: float) -> list[Action]:
        """Report it if all that is left waits for conditions that may never be met; end if they never will."""
        left = [each for each in self.processes.values() if each.state not in ("ended", "stopped")]
        if not left or any(each.state != "held" for each in left):
            return []
        vain = {each.name: gone for each in left if (gone := self._ended_for(each))}
        if len(vain) < len(left):
            names = ", ".join(each.name for each in left)
            return [Say(f"nothing runs any more; not started yet: {names}", "WARN")]
        self._code = 1
        reason = "; ".join(f"{name} waits for {gone}, which has ended" for name, gone in vain.items())
        return [Say(f"nothing runs any more, and {reason}", "ERROR"), *self._harder(now)]

    def _ended_for(self, held: Tracked) -> str:
        """Return the ended process for which a held one waits, directly or through others; '' for none."""
        seen, left = set[str](), [held.name]
        while left:
            name = left.pop(0)
            each = self.processes.get(name)
            if each is None or name in seen:
                continue
            if each.state == "ended":
                return name
            seen.add(name)
            left += sorted(each.rules.awaits) if each.state == "held" else []
        return ""

    def _harder(self, now: float) -> list[Action]:
        """Ask all that run to stop, but none by a step twice: that might disturb its orderly end."""
        self.step = Step.INTERRUPT if self.step is None else Step(min(self.step + 1, Step.GIVE_UP))
        self._requested_at = now
        if self.step is Step.GIVE_UP:
            self._code = self._code or exit_code(-9)
            return []
        requests: list[Action] = []
        for each in self.processes.values():
            if each.is_alive and (each.step is None or each.step < self.step):
                _move(each, "stopping", now)
                each.step = self.step
                requests.append(Ask(each.name, self.step))
        return requests

    def _one_harder(self, each: Tracked, now: float) -> list[Action]:
        if each.step is None:
            _move(each, "stopping", now)
            late = []
            each.step = Step.INTERRUPT
        else:
            late = [self._late(each.name, patience=self._patience_of(each, each.step))]
            each.step = Step(each.step + 1)
        if each.step is Step.GIVE_UP:  # it stays as it is, and may still end
            each.step, each.due = Step.KILL, None
            return [Say(f"{each.name} cannot be killed", "ERROR")]
        each.due = now + self._patience_of(each, each.step)
        return [*late, Ask(each.name, each.step)]

    def _patience_of(self, each: Tracked, step: Step) -> float:
        """Return the time in seconds between this step of stopping a process, and the next."""
        own = each.rules.patience
        return self._patience if own is None or step > Step.TERMINATE else own[step]

    def _patience_of_all(self, step: Step) -> float:
        """Return the time in seconds between this step of stopping the system, and the next: the longest of all."""
        return max((self._patience_of(self.processes[name], step) for name in self.alive), default=self._patience)

    def _late(self, *names: str, patience: float | None = None) -> Say:
        seconds = self._patience if patience is None else patience
        return Say(f"still running after {seconds:g} s: {', '.join(names)}", "WARN")


def _tracked(name: str, rules: Rules) -> Tracked:
    return Tracked(name, rules, "held" if rules.held else "waiting")


def _move(each: Tracked, state: State, now: float) -> None:
    """Set the state of a process and clear its plans."""
    is_restart = each.is_restart and state == "stopping"
    each.state, each.since, each.due, each.step, each.is_restart = state, now, None, None, is_restart


def _end(how: str, returncode: int) -> Say:
    """Return the line about the end of a process."""
    return Say(how, "ERROR" if returncode else "INFO")


def _why(each: Tracked, returncode: int, cause: str, ran: float) -> str:
    """Return the cause as the end of a sentence: " as before" if it is the same as before a restart in vain."""
    is_in_vain = each.streak > 0 and ran < each.rules.respawn.within
    if cause and is_in_vain and (returncode, cause) == (each.returncode, each.cause):
        return " as before"
    return f": {cause}" if cause else ""


def _respawn(each: Tracked, ran: float, now: float) -> str:
    """Plan the restart of a process and return a text about it."""
    rule = each.rules.respawn
    each.streak = 0 if ran >= rule.within else each.streak
    pause = rule.pause(each.streak)
    each.streak += 1
    _move(each, "waiting", now)
    each.due = now + pause
    each.respawned.append(each.due)
    again = f"starting it again in {pause:g} s"
    if rule.most == NO_LIMIT:
        return again
    within = "" if rule.within == NO_LIMIT else f" within {rule.within:g} s"
    return f"{again} ({len(each.respawned)} of {rule.most}{within})"
