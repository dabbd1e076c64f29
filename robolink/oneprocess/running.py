"""Run the nodes of a launch file in this process, in real time: `robolink launch FILE --in-process`."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING

from robolink.launch import processes
from robolink.oneprocess.host import Host
from robolink.oneprocess.supervision import Supervision
from robolink.terminal import fit

if TYPE_CHECKING:
    from robolink.launch import Entry

AGES = 10.0**9
"""Seconds; nobody waits longer."""


def run(entries: Sequence[Entry], *, duration: float | None = None) -> int:
    """Run a system until a program ends whose end is the system's, Ctrl-C, or for `duration` seconds; the exit code.

    The nodes talk within this process, which is in nobody's network. Raises DocumentError, before anything is started,
    for a command, which needs a process of its own.
    """
    launched = processes(entries)
    for each in launched:
        if each.command:
            reason = "a command needs a process of its own: launch without --in-process"
            raise each.entries[0].error(["run"], reason)
    host = Host(virtual=False)
    supervision = Supervision(host, launched, say=_say, ends=duration)
    with _signals(host, supervision), host:
        supervision.begin()
        host.run_until(lambda: supervision.is_over, AGES)
    return supervision.policy.code


def _say(text: str) -> None:
    print(f"[launch] {fit(text)}\n", end="", flush=True)  # noqa: T201 - it is for people; in one go, as nodes print too


@contextmanager
def _signals(host: Host, supervision: Supervision) -> Iterator[None]:
    """Have Ctrl-C and its like end the system in order while this lasts; only a main thread can."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def handle(number: int, frame: FrameType | None) -> None:
        host.at(host.now, lambda: supervision.interrupt(in_hurry=number in _HURRYING))

    before = {each: signal.signal(each, handle) for each in (*_HURRYING, *_ENDING)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


_HURRYING = [signal.SIGINT]
_ENDING = [signal.SIGTERM]
if sys.platform == "win32":
    _HURRYING += [signal.SIGBREAK]
else:
    _ENDING += [signal.SIGHUP]
