"""Run one program in a process group of its own: start it, read its lines, ask it to stop."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, Any

from robolink.exceptions import RobolinkError
from robolink.supervisor.processes.guardian import is_alive, signal_group
from robolink.supervisor.processes.lifeline import Lifeline
from robolink.supervisor.processes.terminal import Terminal
from robolink.supervisor.rules import Rules, Step

_LONGEST_LINE = 1 << 20
"""Bytes; a longer line is printed in pieces."""
_LAST_WORDS = 1.0
"""Seconds that the output of a process may go on behind its end, in the pipe or from its own children."""
_LEFT_BEHIND = 1.0
"""Seconds that processes have which outlive the one that started them, between SIGTERM and SIGKILL."""


class ProcessStartError(RobolinkError, OSError):
    """A program cannot be started; the text names it and says why."""


@dataclass(frozen=True)
class Process:
    """What to run: a command, under a name; `env` is added to our own environment.

    An `interactive` process reads our standard input, the others what `input` holds. `rules` say what its end means,
    `cpu` on which cores (from 0) it may run; none means on all. A Ctrl-C waits for one that `holds_interrupts` until
    it calls `watch_lifeline`: nobody wants to read from which import Python was torn.
    """

    name: str
    argv: Sequence[str]
    env: Mapping[str, str] = field(default_factory=dict)
    cwd: str | os.PathLike[str] | None = None
    interactive: bool = False
    input: bytes = b""
    rules: Rules = field(default_factory=Rules)
    cpu: Sequence[int] = ()
    holds_interrupts: bool = False


class Child:
    """A process that was started, with everything that it starts in turn: its process group."""

    def __init__(self, process: Process, lifeline: Lifeline) -> None:
        variables, options = lifeline.options()
        self._terminal = Terminal() if process.interactive else None
        try:
            with _standard_input(process) as stdin, _interrupts_held(process.holds_interrupts):
                self._popen = subprocess.Popen(
                    list(process.argv),
                    env={**_plain_output(), **process.env, **variables},
                    cwd=process.cwd,
                    stdin=stdin,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.STDOUT,
                    **options,
                    **_own_group(),
                )
        except (OSError, ValueError) as error:
            reason = _why(error, process.argv[0])
            raise ProcessStartError(f"cannot start {process.name} ({process.argv[0]}): {reason}") from None
        self.name = process.name
        self.group = self._popen.pid
        self._has_ended = False

    def watch(self, on_line: Callable[[str, bytes], None], on_exit: Callable[[str, int], None]) -> None:
        """Call `on_line` with each line, then `on_exit` with the return code, on threads of our own.

        At its exit nothing is left of its process group either, nor is it ever asked again: the number may be
        another's by then.
        """
        output = self._popen.stdout
        assert output is not None
        reader = threading.Thread(target=self._read, args=(output, on_line), daemon=True)
        reader.start()
        threading.Thread(target=self._wait, args=(reader, on_exit), daemon=True).start()

    def ask(self, step: Step) -> None:
        """Ask the process group to stop, the harder the later the step; one that was paused cannot obey: it goes on."""
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

    def pause(self) -> None:
        """Hold the process group where it stands."""
        if sys.platform != "win32" and not self._has_ended:
            signal_group(self.group, signal.SIGSTOP)

    def resume(self) -> None:
        """Let a paused process group go on."""
        if sys.platform != "win32" and not self._has_ended:
            signal_group(self.group, signal.SIGCONT)

    def is_left(self) -> bool:
        """Whether the process, or another of its group, still runs."""
        return not self._has_ended and is_alive(self.group)

    def _read(self, output: IO[bytes], on_line: Callable[[str, bytes], None]) -> None:
        with output:
            while line := output.readline(_LONGEST_LINE):
                on_line(self.name, line)

    def _wait(self, reader: threading.Thread, on_exit: Callable[[str, int], None]) -> None:
        returncode = self._popen.wait()
        self._has_ended = True
        _end_rest(self.group)
        if self._terminal is not None:
            self._terminal.put_back()
        reader.join(_LAST_WORDS)
        on_exit(self.name, returncode)


def _why(error: OSError | ValueError, program: str) -> str:
    """Say why a program cannot be started; of a script that is there, systems only say that something is not."""
    why = error.errno if isinstance(error, OSError) and error.filename == program else None
    if why in (errno.ENOEXEC, errno.ENOENT) and Path(program).is_file():
        return "its first line names no program that runs it, as '#!/bin/sh' does (with a line end of Unix)"
    if why == errno.E2BIG:
        return "it is given more than a command line and an environment hold: hand what is long over in a file"
    return str(error)


def _end_rest(group: int) -> None:
    """End what a process that has just ended left in its group; while there is any, its number is no other's."""
    if sys.platform != "win32" and signal_group(group, signal.SIGTERM):
        deadline = time.monotonic() + _LEFT_BEHIND
        while is_alive(group):
            if time.monotonic() > deadline:
                signal_group(group, signal.SIGKILL)
                return
            time.sleep(0.02)


@contextmanager
def _standard_input(process: Process) -> Iterator[IO[bytes] | int | None]:
    """Give what a process reads: a file without a name rather than a pipe, for which somebody would have to wait."""
    if not process.input:
        yield None if process.interactive else subprocess.DEVNULL
        return
    with tempfile.TemporaryFile() as file:
        file.write(process.input)
        file.seek(0)
        yield file


@contextmanager
def _interrupts_held(wanted: bool) -> Iterator[None]:
    """Have what is started meanwhile begin with SIGINT blocked, which it inherits; ours waits as long."""
    if not wanted or sys.platform == "win32":
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _plain_output() -> dict[str, str]:
    """Give our environment, with which Python prints each line at once, and in UTF-8, as consoles take it.

    On Windows it would write to a pipe in the country's own letters. Elsewhere a terminal may want other than UTF-8.
    """
    encoding = {"PYTHONIOENCODING": "utf-8"} if sys.platform == "win32" else {}
    return {**encoding, **os.environ, "PYTHONUNBUFFERED": "1"}


def _own_group() -> dict[str, Any]:
    """Keep our Ctrl-C away from the process, so that it gets one, from us, and its children with it.

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
