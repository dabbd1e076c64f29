"""What the nodes of a launch file are made of, seen without running them: their topics, services and parameters.

A child process makes them, since it is anybody's code that runs then: it may raise, hang, or take its process with it.
What is seen is what there is when a node is made, or when its program would begin to wait.
"""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from typing import IO, Any

import msgspec

from robolink.exceptions import RobolinkError
from robolink.launch.planning import arguments, environment
from robolink.launch.reading.entry import Entry
from robolink.own_command import own_command
from robolink.supervisor.rules import described

COMMAND = "look-into"
"""What `robolink` is asked to do then; no command for people."""

PATIENCE = 10.0
"""Seconds that a node may take to be made."""

_GRACE = 10.0
"""Seconds more, for a process that cannot even notice that its time is over."""


_HELD_UP = "it holds up its whole process when it is made"


class LookError(RobolinkError, ValueError):
    """What came on standard input is no list of nodes to look into."""


class Job(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A node to look into: what `find_node` finds, its program's arguments, and its environment."""

    node: str
    args: list[str]
    env: dict[str, str] = {}


class End(msgspec.Struct, frozen=True, order=True):
    """A publisher, subscription, service or client: `kind` as `wire.EndpointKind` spells it."""

    kind: str
    name: str
    type: str
    hash: str
    node: str
    """The full name of the node that has it."""


class Look(msgspec.Struct, frozen=True):
    """What was seen of a node, or of the several that its program makes."""

    nodes: list[str] = []
    """Full names."""
    ends: list[End] = []
    declared: list[str] = []
    """The names of its parameters."""
    refused: dict[str, str] = {}
    """Why it does not take a parameter that it was given."""
    is_open: bool = False
    """Whether it takes parameters that it has not declared, or may declare more later."""
    error: str = ""
    """Why it cannot be made."""
    unseen: str = ""
    """Why it was not looked into, or not to the end."""


class Request(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """What the child process is asked."""

    jobs: list[Job]
    patience: float


def looks_of(entries: Iterable[Entry], patience: float = PATIENCE) -> dict[str, Look]:
    """Look into the nodes of a system; give what was seen by their entries' names. Commands are not looked into."""
    nodes = [each for each in entries if each.source is not None]
    jobs = [Job(each.source.spec, list(arguments(each)), environment(each)) for each in nodes if each.source]
    return {each.name: look for each, look in zip(nodes, look_into(jobs, patience), strict=True)}


def look_into(jobs: Sequence[Job], patience: float = PATIENCE) -> list[Look]:
    """Look into nodes, each for at most `patience` seconds."""
    found: list[Look] = []
    while len(found) < len(jobs):
        before, is_held_up = len(found), threading.Event()
        with _child(Request(list(jobs[before:]), patience)) as child:
            found.extend(islice(_lines(child, patience, is_held_up), len(jobs) - before))
            if is_held_up.is_set():
                found.append(Look(error=_HELD_UP))
            elif len(found) == before:  # it ended within the first
                found.append(Look(error=_end_of(child)))
    return found


def read(text: bytes) -> Request:
    """Read what is asked on standard input. Raises `LookError`."""
    try:
        return msgspec.json.decode(text, type=Request)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise LookError(f"standard input: expected nodes to look into, in JSON: {error}") from None


@contextlib.contextmanager
def _child(request: Request) -> Iterator[subprocess.Popen[bytes]]:
    """Start the process that looks; what it starts itself ends with it."""
    with tempfile.TemporaryFile() as asked:
        asked.write(msgspec.json.encode(request))
        asked.seek(0)
        child = subprocess.Popen(
            [*own_command(), COMMAND],
            stdin=asked,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            **_APART,
        )
        with child:
            try:
                yield child
            finally:
                _kill(child)


def _lines(child: subprocess.Popen[bytes], patience: float, is_held_up: threading.Event) -> Iterator[Look]:
    """Yield what the child tells, until it ends or is killed, since it was silent for too long."""
    output: IO[bytes] | None = child.stdout
    assert output is not None

    def give_up() -> None:
        is_held_up.set()
        _kill(child)

    while True:
        limit = threading.Timer(patience + _GRACE, give_up)
        limit.daemon = True
        limit.start()
        try:
            line = output.readline()
        finally:
            limit.cancel()
        if not line.endswith(b"\n"):
            return
        yield msgspec.json.decode(line, type=Look)


def _end_of(child: subprocess.Popen[bytes]) -> str:
    """Say how a child ended whose output has ended."""
    with contextlib.suppress(subprocess.TimeoutExpired):
        return f"its process {described(child.wait(_GRACE))} while it was made"
    return _HELD_UP


_APART: dict[str, Any] = {"start_new_session": True}
if sys.platform == "win32":
    _APART = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}


def _kill(child: subprocess.Popen[bytes]) -> None:
    """Kill the child, and what it has started where that can be told."""
    with contextlib.suppress(OSError):
        if sys.platform == "win32":
            child.kill()
        else:
            os.killpg(child.pid, signal.SIGKILL)
