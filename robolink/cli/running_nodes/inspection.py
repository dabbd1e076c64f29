"""Inspection of nodes: makes them on a network of their own, in stopped time, and reports their endpoints.

A Node class is made. A `main()` or script is run until its node would wait for the first time, which is when it spins:
then it is reported, and this process ends, since nothing is known of how such a program would go on.
"""

from __future__ import annotations

import os
import queue
import sys
import threading
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any, NoReturn

import msgspec

from robolink.arguments.command_line import CHILD_PARAMETER, WIDE_PARAMETER
from robolink.cli.running_nodes import runner
from robolink.context import Context
from robolink.exceptions import (
    InvalidParameterTypeException,
    InvalidParameterValueException,
    NameValidationException,
    RobolinkError,
)
from robolink.launch.looking.look import End, Job, Look, Request
from robolink.running.timebase import VirtualTime
from robolink.system.processes import set_environment
from robolink.transport.memory import Bus, MemoryTransport
from robolink.utilities import set_default_context
from robolink.wire import EndpointToken, NodeToken, graph_pattern, parse_token
from robolink.workspace import NodeSource, find_node, load_node
from robolink.workspace.load import make_node, runs_itself

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.running.inbox import Inbox


SETTLED = 0.1
"""Time in seconds from the entry of an AsyncNode until its program has made what it makes at its start."""


def run(request: Request) -> NoReturn:
    """Report each node on standard output and end the process; early, after a node that would go on by itself."""
    runner.take_names()
    os.environ["ROBOLINK_TRANSPORT"] = "memory://look"  # for a context that a program makes for itself
    tell = _reporter()
    for job in request.jobs:
        _Inspection(job, tell, request.patience).look()
    os._exit(0)  # whatever threads the nodes have left


def _reporter() -> Callable[[Look], None]:
    """Return a function that writes to standard output; other output, also to standard error, is discarded."""
    own = os.dup(1)
    silence = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(silence, stream)

    def tell(look: Look) -> None:
        line = msgspec.json.encode(look) + b"\n"
        while line:
            line = line[os.write(own, line) :]

    return tell


class _Inspection:
    """Inspection of one node."""

    def __init__(self, job: Job, tell: Callable[[Look], None], patience: float) -> None:
        self._job = job
        self._tell = tell
        self._patience = patience
        self._lock = threading.Lock()
        self._bus = Bus()
        self._nodes: list[Node] = []
        self._refused: dict[str, str] = {}

    def look(self) -> None:
        """Make the node, and report it once."""
        limit = threading.Timer(self._patience, self._end, [f"it is not made after {self._patience:g} s"])
        limit.daemon = True
        limit.start()
        before = dict(os.environ)
        set_environment(self._job.env)
        try:
            self._start_with_what_it_takes()
        except (Exception, SystemExit, KeyboardInterrupt) as error:  # noqa: BLE001 - it is anybody's code
            self._lock.acquire()
            self._tell(self._seen(error=_words(error)))
        finally:
            limit.cancel()
            os.environ.clear()
            os.environ.update(before)

    def _start_with_what_it_takes(self) -> None:
        source, args = find_node(self._job.node), self._job.args
        while True:
            try:
                return self._start(source, args)
            except (InvalidParameterTypeException, InvalidParameterValueException) as error:
                name, before = str(error.parameters), args
                args = _without(args, name)
                if args == before:
                    raise
                self._refused[name] = _words(error, source)

    def _start(self, source: NodeSource, args: Sequence[str]) -> None:
        self._bus, self._nodes = Bus(), []
        context = _Watched(self._nodes, MemoryTransport(bus=self._bus), self._end)
        set_default_context(context)
        sys.argv = [str(source.path or source.name), *args]
        found = load_node(source)
        if isinstance(found, type):
            context.init(sys.argv)
            _make(found)
            self._lock.acquire()
            self._tell(self._seen())
        else:
            found()
            self._end("its program ends by itself, without ever waiting")

    def _end(self, unseen: str = "") -> NoReturn:
        """Report what there is now, and end the process; from any thread."""
        self._lock.acquire()  # for good: one line is told
        self._tell(self._seen(unseen=unseen))
        os._exit(0)

    def _seen(self, *, error: str = "", unseen: str = "") -> Look:
        texts = MemoryTransport(bus=self._bus).tokens(graph_pattern())
        tokens = [parse_token(each) for each in texts]
        declared = {name for node in self._nodes for name in node._declared_so_far_}
        return Look(
            nodes=sorted({each.full_node_name for each in tokens if isinstance(each, NodeToken)}),
            ends=sorted(_end(each) for each in tokens if isinstance(each, EndpointToken)),
            declared=sorted(declared),
            refused=self._refused,
            is_open=any(_is_open(each) for each in self._nodes),
            error=error,
            unseen=unseen,
        )


class _Standing(VirtualTime):
    """Stopped time: the first wait of an executor calls `on_wait`, which ends the process."""

    def __init__(self, on_wait: Callable[[], NoReturn]) -> None:
        super().__init__(1_000_000_000)
        self._on_wait = on_wait

    def wait(self, inbox: Inbox, until: int | None) -> Any:
        """End the process instead of waiting."""
        self._on_wait()

    def take(self, source: queue.SimpleQueue[Any], until: int | None) -> Any:
        """Take an item from the queue; end the process if it is empty."""
        try:
            return source.get_nowait()
        except queue.Empty:
            self._on_wait()


class _Watched(Context):
    """A context that records its nodes, and in which every wait succeeds at once."""

    def __init__(self, nodes: list[Node], transport: MemoryTransport, on_wait: Callable[[], NoReturn]) -> None:
        super().__init__(transport=transport, time=_Standing(on_wait))
        self._made, self._on_wait = nodes, on_wait

    def track_node(self, node: Any) -> None:
        """Record a node."""
        self._made.append(node)
        super().track_node(node)

    def make_loop_inbox(self, rouse: Callable[[], object]) -> Inbox:
        """Make the inbox of a node that begins to run on an event loop: a while later it waits for the first time."""
        import asyncio

        asyncio.get_running_loop().call_later(SETTLED, self._on_wait)
        return super().make_loop_inbox(rouse)

    def wait_until(self, is_there: Callable[[], bool], timeout_sec: float | None) -> bool:
        """Return True at once: so a loop ends in which a node waits for another one."""
        return True


def _make(node_class: type) -> None:
    """Make a node as its program would: an AsyncNode within an event loop."""
    if not runs_itself(node_class):
        make_node(node_class)
        return
    import asyncio

    async def make() -> None:
        make_node(node_class)

    asyncio.run(make())


def _end(token: EndpointToken) -> End:
    return End(token.kind.value, token.name, token.type_name, token.type_hash, token.full_node_name)


def _is_open(node: Node) -> bool:
    from robolink.lifecycle.managed_entity import ManagedEntity  # it declares more when it is configured

    return node._allow_undeclared_parameters or isinstance(node, ManagedEntity)


def _without(args: Sequence[str], name: str) -> list[str]:
    """Return the arguments without the parameter of that name."""
    without: list[str] = []
    rest, flags = iter(args), ("-p", WIDE_PARAMETER, CHILD_PARAMETER)
    for each in rest:
        value = next(rest, "") if each in flags else ""
        if not value.startswith(f"{name}:="):
            without += [each, value] if each in flags else [each]
    return without


def _words(error: BaseException, source: NodeSource | None = None) -> str:
    """Return an error as one line, with the line of the user's code."""
    if isinstance(error, SystemExit):
        return f"it ends its process with exit code {error.code}"
    if isinstance(error, NameValidationException):
        return f"invalid {error.name_type} '{error.name[:200]}': {error.error_msg}"
    text = " ".join(str(error).split())
    if not isinstance(error, RobolinkError):
        text = f"{type(error).__name__}: {text}" if text else type(error).__name__
    place = _place(error.__traceback__)
    return f"{text} (at {place})" if place else text


def _place(trace: TracebackType | None) -> str:
    """Return the last line of the user's own code in a traceback, as `file:line`."""
    place = ""
    while trace is not None:
        if not runner.is_ours(trace):
            place = f"{trace.tb_frame.f_code.co_filename}:{trace.tb_lineno}"
        trace = trace.tb_next
    return place
