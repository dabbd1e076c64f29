"""Introspection of a launch file's nodes without running them: their topics, services and parameters.

A child process constructs them, since that runs the user's code: it may raise, hang, or crash its process.
A node is seen as it is after its constructor, or when its program would begin to wait.
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
from robolink.launch.entry import Entry
from robolink.supervisor.policy import described
from robolink.system.processes import own_command

COMMAND = "look-into"
"""Hidden sub-command of `robolink` for the child process; not for people."""

PATIENCE = 10.0
"""Timeout of a node's construction, in seconds."""

_GRACE = 10.0
"""Further timeout for a process that cannot even notice the first one, in seconds."""


_HELD_UP = "it holds up its whole process when it is made"


class LookError(RobolinkError, ValueError):
    """Standard input is not a list of nodes to inspect."""


class Job(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """A node to inspect: its `find_node` spec, its program's arguments, and changes of its environment."""

    node: str
    args: list[str]
    env: dict[str, str | None] = {}


class End(msgspec.Struct, frozen=True, order=True):
    """A publisher, subscription, service or client: `kind` as `wire.EndpointKind` spells it."""

    kind: str
    name: str
    type: str
    hash: str
    node: str
    """Full name of the node that owns it."""


class Look(msgspec.Struct, frozen=True):
    """Result of inspecting a program: its node, or the several that it makes."""

    nodes: list[str] = []
    """Full names of the nodes."""
    ends: list[End] = []
    declared: list[str] = []
    """Names of its declared parameters."""
    refused: dict[str, str] = {}
    """Reason for each given parameter that the node rejects, by name."""
    is_open: bool = False
    """True if it takes undeclared parameters, or may declare more later."""
    error: str = ""
    """Reason why the node cannot be constructed; empty if it can."""
    unseen: str = ""
    """Reason why the inspection is missing or incomplete; empty if it is complete."""


class Request(msgspec.Struct, forbid_unknown_fields=True, frozen=True):
    """Request to the child process."""

    jobs: list[Job]
    patience: float


def looks_of(entries: Iterable[Entry], patience: float = PATIENCE) -> dict[str, Look]:
    """Inspect the nodes of a system; return the results by entry name. Commands are not inspected.

    `patience` is the timeout of each node's construction, in seconds.
    """
    from robolink.launch.planning import arguments, environment  # the child process needs the types alone

    nodes = [each for each in entries if each.source is not None]
    jobs = [Job(each.source.spec, list(arguments(each)), environment(each)) for each in nodes if each.source]
    return {each.name: look for each, look in zip(nodes, look_into(jobs, patience), strict=True)}


def look_into(jobs: Sequence[Job], patience: float = PATIENCE) -> list[Look]:
    """Inspect nodes, each for at most `patience` seconds; return a result for each."""
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
    """Parse the request from standard input; raises `LookError` for anything else."""
    try:
        return msgspec.json.decode(text, type=Request)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise LookError(f"standard input: expected nodes to look into, in JSON: {error}") from None


@contextlib.contextmanager
def _child(request: Request) -> Iterator[subprocess.Popen[bytes]]:
    """Start the child process; its own children end with it."""
    with tempfile.TemporaryFile() as request_file:
        request_file.write(msgspec.json.encode(request))
        request_file.seek(0)
        child = subprocess.Popen(
            [*own_command(), COMMAND],
            stdin=request_file,
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
    """Yield the child's results until it ends, or is killed because it was silent for too long."""
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
    """Return how a child ended whose output has ended."""
    with contextlib.suppress(subprocess.TimeoutExpired):
        return f"its process {described(child.wait(_GRACE))} while it was made"
    return _HELD_UP


_APART: dict[str, Any] = {"start_new_session": True}
if sys.platform == "win32":
    _APART = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}


def _kill(child: subprocess.Popen[bytes]) -> None:
    """Kill the child, and its own children where they are known."""
    with contextlib.suppress(OSError):
        if sys.platform == "win32":
            child.kill()
        else:
            os.killpg(child.pid, signal.SIGKILL)
