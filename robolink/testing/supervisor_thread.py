"""Thread that runs a supervisor, for the processes of one launch under test."""

from __future__ import annotations

import functools
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress
from dataclasses import replace
from typing import TYPE_CHECKING

from robolink.context import Context
from robolink.exceptions import RobolinkError
from robolink.launch.planning import Launched, as_process, processes
from robolink.launch.readiness import Readiness
from robolink.launch.ros.stage import ProcessStage
from robolink.supervisor import Process, Supervisor
from robolink.supervisor.events import Event, Exited, Status
from robolink.supervisor.policy import Rules
from robolink.system import clocks, waits

if TYPE_CHECKING:
    from robolink.launch import Entry
    from robolink.launch.entry import Direct
    from robolink.supervisor.director import Director

ANSWER_TIMEOUT = 5.0
"""Timeout of a supervisor's answer to a request, in seconds."""


class Launch:
    """The processes of one launch file, or of one node that was started `alone` and is called so, under a supervisor.

    The supervisor has a thread. `on_exit` is called, on another one, with each process that ends.
    """

    def __init__(
        self,
        entries: Sequence[Entry],
        domain: int,
        network: str,
        on_exit: Callable[[Exited], object],
        alone: str = "",
        direct: Direct | None = None,
    ) -> None:
        launched = processes(entries)
        self._launched = {alone: replace(launched[0], name=alone)} if alone else {each.name: each for each in launched}
        self.names = list(self._launched)
        self._readiness = Readiness({each.name: each.held_by for each in self._launched.values()})
        self._env = {
            "ROBOLINK_TRANSPORT": "zenoh",
            "ROBOLINK_NETWORK": network,
            "ROS_DOMAIN_ID": str(domain),
        }
        self._on_exit, self._alone = on_exit, bool(alone)
        self._stack = ExitStack()
        self._start_anew(list(self._launched.values()), direct)

    def _start_anew(self, launched: Sequence[Launched], direct: Direct | None = None) -> None:
        mine = [self._process(each) for each in launched]
        director = None if direct is None else functools.partial(self._director, direct)
        self.supervisor = Supervisor(mine, output=sys.stderr, on_event=self._on_event, director=director)
        self.thread = threading.Thread(target=self._run, name="system under test", daemon=True)

    def _director(self, direct: Direct, supervisor: Supervisor) -> Director[Process]:
        return direct(self._stack.enter_context(ProcessStage(supervisor, self._added, self._make_context)))

    def _make_context(self) -> Context:
        """Return the context of the launcher's own node, on the domain of the test."""
        from robolink.transport import open_network

        domain = int(self._env["ROS_DOMAIN_ID"])
        context = Context(transport=open_network(domain, self._env["ROBOLINK_NETWORK"]))
        context.init([], domain_id=domain)
        return context

    def _added(self, entries: list[Entry]) -> list[Process]:
        """Return the processes of entries that a launch file adds while its system runs."""
        launched = processes(entries)
        self._launched.update((each.name, each) for each in launched)
        self.names += [each.name for each in launched if each.name not in self.names]
        return [self._process(each) for each in launched]

    def _process(self, launched: Launched) -> Process:
        made = as_process(launched)
        rules = Rules(on_exit="ignore") if self._alone else made.rules
        return replace(made, env={**made.env, **self._env}, rules=rules)

    def begin(self) -> None:
        """Start the processes."""
        self.thread.start()

    def _run(self) -> None:
        try:
            with self._stack:
                self.supervisor.run()
        except RobolinkError as error:
            for name in self.names:
                self._on_exit(Exited(name, 0, 127, "could not be started", str(error), 0.0))

    def _on_event(self, event: Event) -> None:
        if isinstance(event, Exited):
            self._on_exit(event)

    def awaited_nodes(self) -> int:
        """Return the number of nodes to be announced: those of the processes that run and wait for nothing."""
        running = {each.name for each in self.supervisor.status() if each.state in ("waiting", "running")}
        return sum(len(each.members) for name, each in self._launched.items() if name in running)

    def pid(self, name: str) -> int | None:
        """Return the id of a process that runs; None of another."""
        return self._status(name).pid

    def _status(self, name: str) -> Status:
        return next(each for each in self.supervisor.status() if each.name == name)

    def stop(self, name: str) -> None:
        """End a process in order; the others go on."""
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
        deadline = clocks.monotonic() + ANSWER_TIMEOUT
        while self._status(name).state == "running" and clocks.monotonic() < deadline:
            time.sleep(0.001)
        with suppress(ProcessLookupError):
            if sys.platform == "win32":
                os.kill(pid, signal.SIGTERM)
            else:
                os.killpg(pid, signal.SIGKILL)

    def restart(self, name: str) -> None:
        """Start a process anew; one whose system has ended with it gets a system of its own."""
        if all(each.pid is None for each in self.supervisor.status()):
            waits.join(self.thread, ANSWER_TIMEOUT)
        if self.thread.is_alive():
            self.supervisor.restart(name)
            return
        self._alone = True
        self._start_anew([self._launched[name]])
        self.begin()

    @property
    def waits(self) -> bool:
        """True while a process waits for something else."""
        return bool(self._readiness.held)

    def hear(self, text: str, alive: bool) -> bool:
        """Start the processes that a new or lost token allows to start; False for a token that nothing waits for."""
        for name in self._readiness.note_token(text, alive):
            self.supervisor.release(name)
        return self._readiness.knows(text)
