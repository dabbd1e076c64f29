"""Programs under test that are processes: what stands for one, and the supervisor that runs those of one launch."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING

from robolink.exceptions import RobolinkError
from robolink.launch.command import Launched, as_process, processes
from robolink.supervisor import Process, Supervisor
from robolink.supervisor.events import Event, Exited, Status
from robolink.supervisor.rules import Rules
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.graph import Graph
    from robolink.launch import Entry
    from robolink.launch.readiness import Awaited


TOLD_WITHIN = 5.0
"""Seconds in which a supervisor does what it is asked to."""


class RemoteNode:
    """A node in another process, by its name: what it does is seen by topics, services and log lines."""

    def __init__(self, program: str, full_name: str) -> None:
        self.program, self._full_name = program, full_name

    def get_fully_qualified_name(self) -> str:
        """Give namespace and name."""
        return self._full_name

    def get_name(self) -> str:
        """Give the node's name."""
        return self._full_name.rpartition("/")[2]

    def get_namespace(self) -> str:
        """Give the node's namespace, with its leading slash."""
        return self._full_name.rpartition("/")[0] or "/"


class Launch:
    """The processes of one launch file, or of one node that was started `alone` and is called so, under a supervisor.

    That has a thread. `on_exit` is called, on another one, with each process that ends.
    """

    def __init__(
        self, entries: Sequence[Entry], domain: int, network: str, on_exit: Callable[[Exited], object], alone: str = ""
    ) -> None:
        launched = processes(entries)
        self._launched = {alone: replace(launched[0], name=alone)} if alone else {each.name: each for each in launched}
        self.names = list(self._launched)
        self.held = {each.name: each.held_by for each in self._launched.values() if each.held_by}
        self._env = {
            "ROBOLINK_TRANSPORT": "zenoh",
            "ROBOLINK_NETWORK": network,
            "ROS_DOMAIN_ID": str(domain),
        }
        self._on_exit, self._alone = on_exit, bool(alone)
        self._start_anew(list(self._launched.values()))

    def _start_anew(self, launched: Sequence[Launched]) -> None:
        mine = [self._process(each) for each in launched]
        self.supervisor = Supervisor(mine, output=sys.stderr, on_event=self._on_event)
        self.thread = threading.Thread(target=self._run, name="system under test", daemon=True)

    def _process(self, launched: Launched) -> Process:
        made = as_process(launched)
        rules = Rules(on_exit="ignore") if self._alone else made.rules
        return replace(made, env={**made.env, **self._env}, rules=rules)

    def begin(self) -> None:
        """Start the processes."""
        self.thread.start()

    def _run(self) -> None:
        try:
            self.supervisor.run()
        except RobolinkError as error:
            for name in self.names:
                self._on_exit(Exited(name, 0, 127, "could not be started", str(error), 0.0))

    def _on_event(self, event: Event) -> None:
        if isinstance(event, Exited):
            self._on_exit(event)

    def awaited_nodes(self) -> int:
        """Say how many nodes are to be announced: those of the processes that run and wait for nothing."""
        running = {each.name for each in self.supervisor.status() if each.state in ("waiting", "running")}
        return sum(len(each.members) for name, each in self._launched.items() if name in running)

    def pid(self, name: str) -> int | None:
        """Give the number of a process that runs."""
        return self._status(name).pid

    def _status(self, name: str) -> Status:
        return next(each for each in self.supervisor.status() if each.name == name)

    def stop(self, name: str) -> None:
        """Have a process end in order; the others go on."""
        self.supervisor.stop_one(name)

    def kill(self, name: str) -> None:
        """Kill a process and all that it has started, as hard as it goes; the others go on.

        The supervisor is told before that it shall end, since else the launch file's rules would follow; meanwhile it
        stands still, so that it has no last words.
        """
        pid = self.pid(name)
        if pid is None:
            return
        if sys.platform != "win32":
            os.killpg(pid, signal.SIGSTOP)
        self.supervisor.stop_one(name)
        deadline = time.monotonic() + TOLD_WITHIN
        while self._status(name).state == "running" and time.monotonic() < deadline:
            time.sleep(0.001)
        with suppress(ProcessLookupError):
            if sys.platform == "win32":
                os.kill(pid, signal.SIGTERM)
            else:
                os.killpg(pid, signal.SIGKILL)

    def restart(self, name: str) -> None:
        """Start a process anew; one whose system has ended with it gets a system of its own."""
        if all(each.pid is None for each in self.supervisor.status()):
            self.thread.join(TOLD_WITHIN)
        if self.thread.is_alive():
            self.supervisor.restart(name)
            return
        self._alone = True
        self._start_anew([self._launched[name]])
        self.begin()

    def release_what_may_start(self, graph: Graph) -> None:
        """Start what waits for something that is there now."""
        for name, awaited in list(self.held.items()):
            if all(_is_there(each, graph) for each in awaited):
                del self.held[name]
                self.supervisor.release(name)


def _is_there(awaited: Awaited, graph: Graph) -> bool:
    if awaited.kind == "node":
        return any(each.full_node_name in awaited.names for each in graph.nodes())
    kind = EndpointKind.PUBLISHER if awaited.kind == "topic" else EndpointKind.SERVICE
    return any(graph.count(kind, each) for each in awaited.names)
