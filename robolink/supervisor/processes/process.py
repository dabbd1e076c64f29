"""One child process in a process group of its own: start it, read its lines, stop it, put the terminal back."""

from __future__ import annotations

import contextlib
import errno
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import IO, Any, Protocol

from robolink.exceptions import RobolinkError
from robolink.supervisor.policy import Rules, Step
from robolink.supervisor.processes.fork_server import Forked, ForkServer
from robolink.supervisor.processes.guardian import is_alive, signal_group
from robolink.supervisor.processes.lifeline import Lifeline
from robolink.system import clocks
from robolink.system.processes import Variables, environment_with, windows_line

_LONGEST_LINE = 1 << 20
"""Longest line, in bytes; a longer one is printed in pieces."""
_PIECE = 65_536
"""Longest piece of a stream that is read at once, in bytes."""
_LAST_WORDS = 1.0
"""Longest wait for output after a process has ended, in seconds: in the pipe or from its own children."""
_LEFT_BEHIND = 1.0
"""Time between SIGTERM and SIGKILL for processes that outlive the one that started them, in seconds."""


class ProcessStartError(RobolinkError, OSError):
    """A program cannot be started; the text names it and the reason."""


@dataclass(frozen=True)
class Process:
    """Description of a child process.

    Args:
        name: Unique name, shown before its lines.
        argv: The command and its arguments.
        env: Variables that are added to this process's environment; None takes one out.
        cwd: Its working directory; None for this process's.
        interactive: True if it reads this process's standard input; the others read `input`.
        input: Bytes on its standard input.
        rules: Restart rules and the meaning of its end.
        cpu: Numbers of the cores (from 0) on which it may run; empty for all.
        holds_interrupts: True if a Ctrl-C waits until it calls `watch_lifeline`, so that no traceback shows from
            which import Python was torn.
        base: Environment to which `env` is added; None is this process's at its start.
        apart: True keeps its output and its errors apart, and hands on what it writes at once, in pieces that need not
            end with a line. Its standard input, unless `input` has any, is a pipe that nobody writes to.
        terminal: True lets its output and errors, if they are apart, be terminals, where the system has such: it may
            write in colour then.
    """

    name: str
    argv: Sequence[str]
    env: Variables = field(default_factory=dict)
    cwd: str | os.PathLike[str] | None = None
    interactive: bool = False
    input: bytes = b""
    rules: Rules = field(default_factory=Rules)
    cpu: Sequence[int] = ()
    holds_interrupts: bool = False
    base: Mapping[str, str] | None = None
    apart: bool = False
    terminal: bool = False


class OnLine(Protocol):
    """Receiver of what a process writes."""

    def __call__(self, name: str, line: bytes, fd: int | None = None) -> None:
        """Handle a line of the process `name`, or a piece of its output (1) or its errors (2), if these are apart."""


class Child:
    """A running process with its whole process group.

    Args:
        process: Its description.
        lifeline: Pipe by which it notices the end of this process.
        server: Fork server that starts it if it can; None starts it directly.
    """

    def __init__(self, process: Process, lifeline: Lifeline, server: ForkServer | None = None) -> None:
        self._terminal = Terminal() if process.interactive else None
        try:
            with _standard_input(process) as stdin, _interrupts_held(process.holds_interrupts):
                forked = None if server is None else _forked(process, stdin, lifeline, server)
                self._popen: Forked | subprocess.Popen[bytes] = forked or _started(process, stdin, lifeline)
        except (OSError, ValueError) as error:
            reason = _why(error, process.argv[0])
            raise ProcessStartError(f"cannot start {process.name} ({process.argv[0]}): {reason}") from None
        self.name = process.name
        self.group = self._popen.pid
        self._has_ended = False

    def watch(self, on_line: OnLine, on_exit: Callable[[str, int], None]) -> None:
        """Call `on_line` with each line, then `on_exit` with the return code, on background threads.

        At its exit nothing is left of its process group either, nor is it ever signalled again: the id may be
        another's by then.
        """
        readers = [threading.Thread(target=each, daemon=True) for each in self._reading(on_line)]
        for each in readers:
            each.start()
        threading.Thread(target=self._wait, args=(readers, on_exit), daemon=True).start()

    def ask(self, step: Step) -> None:
        """Send the signal of a step to the process group; a paused one is resumed, since it could not obey."""
        if self._has_ended:
            return
        if sys.platform != "win32":
            signal_group(self.group, _SIGNALS[step])
            signal_group(self.group, signal.SIGCONT)
        elif step is Step.INTERRUPT:
            with suppress(OSError):  # it has just ended; or there is no console, and only the next step reaches it
                self._popen.send_signal(signal.CTRL_BREAK_EVENT)
        else:
            self._popen.terminate()

    def signal(self, number: int) -> None:
        """Send a signal to the process group; on Windows whatever it is ends the process."""
        if self._has_ended:
            return
        if sys.platform != "win32":
            signal_group(self.group, signal.Signals(number))
        elif number == signal.SIGINT:
            self.ask(Step.INTERRUPT)
        else:
            self._popen.terminate()

    def pause(self) -> None:
        """Pause the process group (SIGSTOP)."""
        if sys.platform != "win32" and not self._has_ended:
            signal_group(self.group, signal.SIGSTOP)

    def resume(self) -> None:
        """Resume a paused process group."""
        if sys.platform != "win32" and not self._has_ended:
            signal_group(self.group, signal.SIGCONT)

    def is_left(self) -> bool:
        """True if the process, or another of its group, still runs."""
        return not self._has_ended and is_alive(self.group)

    def _reading(self, on_line: OnLine) -> Iterator[Callable[[], None]]:
        """Yield the readers of each stream, to its end."""
        output, errors = self._popen.stdout, getattr(self._popen, "stderr", None)
        assert output is not None
        if errors is None:
            yield partial(self._read, output, on_line)
            return
        yield partial(self._read_pieces, output, 1, on_line)
        yield partial(self._read_pieces, errors, 2, on_line)

    def _read(self, output: IO[bytes], on_line: OnLine) -> None:
        with output:
            while line := output.readline(_LONGEST_LINE):
                on_line(self.name, line)

    def _read_pieces(self, output: IO[bytes], fd: int, on_line: OnLine) -> None:
        with output, suppress(OSError):  # the end of a terminal is an error
            while piece := os.read(output.fileno(), _PIECE):
                on_line(self.name, piece, fd)

    def _wait(self, readers: Sequence[threading.Thread], on_exit: Callable[[str, int], None]) -> None:
        returncode = self._popen.wait()
        self._has_ended = True
        _end_rest(self.group)
        if self._terminal is not None:
            self._terminal.put_back()
        if (stdin := getattr(self._popen, "stdin", None)) is not None:
            with suppress(OSError):
                stdin.close()
        deadline = clocks.monotonic() + _LAST_WORDS
        for each in readers:
            each.join(max(0.0, deadline - clocks.monotonic()))
        on_exit(self.name, returncode)


def _started(process: Process, stdin: IO[bytes] | int | None, lifeline: Lifeline) -> subprocess.Popen[bytes]:
    variables, options = lifeline.options()
    with _streams(process) as (stdout, stderr, masters):
        popen = subprocess.Popen(
            windows_line(process.argv) if sys.platform == "win32" else list(process.argv),
            env=environment_with({**process.env, **variables}, _plain_output(process.base)),
            cwd=process.cwd,
            stdin=stdin,
            stdout=stdout,
            stderr=stderr,
            **options,
            **_own_group(),
        )
    if masters:
        popen.stdout, popen.stderr = (open(each, "rb", 0) for each in masters)  # noqa: PTH123, SIM115 - readers close it
    return popen


@contextmanager
def _streams(process: Process) -> Iterator[tuple[int, int, list[int]]]:
    """Yield the standard output and errors of a process, and for terminals the ends at which they are read."""
    if not (process.terminal and process.apart) or sys.platform == "win32":
        yield subprocess.PIPE, subprocess.PIPE if process.apart else subprocess.STDOUT, []
        return
    pairs = [os.openpty() for _ in range(2)]
    try:
        yield pairs[0][1], pairs[-1][1], [master for master, _ in pairs]
    except BaseException:
        for master, _ in pairs:
            os.close(master)
        raise
    finally:
        for _, slave in pairs:
            os.close(slave)


def _forked(process: Process, stdin: IO[bytes] | int | None, lifeline: Lifeline, server: ForkServer) -> Forked | None:
    """Return the process as the server has forked it; None if it cannot, or may not."""
    if process.cwd is not None or process.interactive or not process.holds_interrupts:
        return None
    if process.apart or process.terminal or process.base is not None:
        return None
    if not server.can_become(process.argv, process.env):
        return None
    with ExitStack() as stack:
        file = stack.enter_context(Path(os.devnull).open("rb")) if stdin is None or isinstance(stdin, int) else stdin
        return server.fork(process.argv, process.env, file.fileno(), lifeline, _plain_output())


def _why(error: OSError | ValueError, program: str) -> str:
    """Return why a program cannot be started; of a script, systems do not say that its interpreter is missing."""
    why = error.errno if isinstance(error, OSError) and error.filename == program else None
    if why in (errno.ENOEXEC, errno.ENOENT) and Path(program).is_file():
        return "its first line names no program that runs it, as '#!/bin/sh' does (with a line end of Unix)"
    if why == errno.E2BIG:
        return "it is given more than a command line and an environment hold: hand what is long over in a file"
    return str(error)


def _end_rest(group: int) -> None:
    """Stop the rest of the group of a process that has just ended; until then its id cannot be reused."""
    if sys.platform != "win32" and signal_group(group, signal.SIGTERM):
        deadline = clocks.monotonic() + _LEFT_BEHIND
        while is_alive(group):
            if clocks.monotonic() > deadline:
                signal_group(group, signal.SIGKILL)
                return
            time.sleep(0.02)


@contextmanager
def _standard_input(process: Process) -> Iterator[IO[bytes] | int | None]:
    """Yield a process's standard input: an unnamed file, since writing to a pipe might block."""
    if not process.input:
        nothing = subprocess.PIPE if process.apart else subprocess.DEVNULL
        yield None if process.interactive else nothing
        return
    with tempfile.TemporaryFile() as file:
        file.write(process.input)
        file.seek(0)
        yield file


@contextmanager
def _interrupts_held(is_on: bool) -> Iterator[None]:
    """Block SIGINT while the block runs: a process that is started then inherits that; our own waits as long."""
    if not is_on or sys.platform == "win32":
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _plain_output(base: Mapping[str, str] | None = None) -> dict[str, str]:
    """Return this process's environment, or another `base`, with Python's output unbuffered and in UTF-8.

    On Windows it would write to a pipe in the country's own letters. Elsewhere a terminal may want other than UTF-8.
    """
    encoding = {"PYTHONIOENCODING": "utf-8"} if sys.platform == "win32" else {}
    return {**encoding, **(os.environ if base is None else base), "PYTHONUNBUFFERED": "1"}


def _own_group() -> dict[str, Any]:
    """Return the `Popen` options that keep the terminal's Ctrl-C away from the process: the supervisor sends it one.

    On POSIX that is a session of its own, not only a group: such a process may even read our terminal, for
    which a background group would be stopped (SIGTTIN).
    """
    options: dict[str, Any] = {"start_new_session": True}
    if sys.platform == "win32":
        options = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}
    return options


_SIGNALS = {Step.INTERRUPT: signal.SIGINT, Step.TERMINATE: signal.SIGTERM}
if sys.platform != "win32":
    _SIGNALS[Step.KILL] = signal.SIGKILL


class Terminal:
    """Snapshot of the settings of the terminal at standard input, for `put_back`; empty where there is none."""

    def __init__(self) -> None:
        self._found: list[Any] | None = None
        if sys.platform != "win32" and os.isatty(0):
            import termios

            self._found = termios.tcgetattr(0)

    def put_back(self) -> None:
        """Restore the settings, unless the terminal is another job's now, as after `bg`: then the shell does it."""
        if sys.platform != "win32" and self._found is not None:
            import termios

            with contextlib.suppress(OSError, termios.error):  # it is gone
                if os.tcgetpgrp(0) == os.getpgrp():
                    termios.tcsetattr(0, termios.TCSANOW, self._found)
