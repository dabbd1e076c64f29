"""Runs the programs of a system in this process, each with a session, a clock and arguments of its own."""

from __future__ import annotations

import random
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

from robolink import compat, logging
from robolink.documents.yamlfile import spell
from robolink.exceptions import NotFoundError
from robolink.host.call_sites import RealTimeUse
from robolink.host.pace import Pace
from robolink.host.participants import HostError, ProgramLike
from robolink.host.patches.environment import process_as_before
from robolink.host.patches.install import adopt, install, uninstall
from robolink.host.program import Part, Program
from robolink.impl.log_output import output
from robolink.launch.shared_process import Member
from robolink.running.defaults import get_defaults
from robolink.running.timebase import TimeBase
from robolink.system.processes import Variables
from robolink.transport.base import Transport
from robolink.transport.memory import Bus, MemoryTransport
from robolink.workspace import find_node

if TYPE_CHECKING:
    from robolink.node import BaseNode

PATIENCE = 5.0
"""Seconds of virtual time from a program's interrupt to its kill."""

START_PATIENCE = 60.0
"""Timeout of `start_node`, in seconds of virtual time."""


class Host:
    """Runs the programs of a system in this process and in virtual time, so that each run is the same.

    Args:
        seed: Seed of Python's `random` and of each program's entropy.
        connect: Opens the network session of a program, by its name; a MemoryTransport on `bus` by default.
        clock: Returns the clock of a program, by its name and the host's time; the host's time itself by default.

    >>> with Host() as host:
    ...     talker = host.start_node(Talker)
    ...     host.run(10.0)
    """

    def __init__(
        self,
        *,
        seed: int = 0,
        connect: Callable[[str], Transport] | None = None,
        clock: Callable[[str, TimeBase], TimeBase] | None = None,
    ) -> None:
        self.seed = seed
        self.bus = Bus()
        self.connect: Callable[[str], Transport] = connect or self._session
        self.pace = Pace()
        self.time = self.pace.time
        self.scheduler = self.pace.scheduler
        self.programs: dict[str, Program] = {}
        self.on_exit: list[Callable[[Program], object]] = []
        """Callbacks, each called with a program that has ended, in whatever way."""
        self._clock = clock or (lambda name, time: time)
        self._begin = self.time.steady()
        self._environments: dict[tuple[tuple[str, str | None], ...], dict[str, str | None]] = {}
        self._random = random.getstate()
        self._stamps = output.now
        self._cleanup = ExitStack()
        self._cleanup.enter_context(process_as_before())
        self._is_closing = self._is_closed = False
        self.preferred_parameters: dict[str, Any] = {}
        """Values by parameter, for nodes started by name or file that declare it, have no other, and let it through."""
        self.real_time_use: list[RealTimeUse] = []
        """Uses of real time by programs, each once: program, what, and where in its code."""
        install()
        random.seed(seed)
        logging.set_time_source(self._now_here)

    def _session(self, name: str) -> Transport:
        return MemoryTransport(bus=self.bus)

    @property
    def now(self) -> float:
        """Seconds of virtual time since the host began."""
        return (self.time.steady() - self._begin) / 1e9

    def _now_here(self) -> int:
        """Return the time of the program whose code this is, or the host's, to stamp lines of the log."""
        program: Program | None = get_defaults().program
        return (self if program is None else program).time.now()

    # Programs

    def start(self, name: str, members: Sequence[Member], *, env: Variables | None = None) -> Program:
        """Start a program, called `name`, of some nodes, or of one script; give it.

        It begins at once, and goes on as the host runs. Raises NotFoundError for a node that there is not, and
        HostError for a program of this name that runs already.
        """
        return self._start(name, [_part(each) for each in members], env or {})

    def start_node(
        self,
        node_class: Callable[[], BaseNode],
        *,
        name: str = "",
        namespace: str = "",
        parameters: Mapping[str, Any] | None = None,
        remappings: Mapping[str, str] | None = None,
        args: Sequence[str] = (),
        called: str = "",
    ) -> Any:
        """Start a program of one Node class, `called` so, or as the node or its class is; give the node.

        `args` are words of its command line, before those that robolink reads. Raises what the class raises, and then
        there is no such program; HostError when the node is still not made after a minute, because it waits.
        """
        own = name or getattr(node_class, "__name__", "node")
        argv = [own, *args, "--ros-args", *_names(name, namespace)]
        for key, value in (parameters or {}).items():
            argv += ["-p", f"{key}:={spell(value)}"]
        for match, replacement in (remappings or {}).items():
            argv += ["-r", f"{match}:={replacement}"]
        called = called or f"{namespace.strip('/')}/{own}".lstrip("/")
        program = self.start_class(node_class, called, [own, *argv[1:]])
        called = program.name
        if not self.run_until(lambda: program.has_begun, START_PATIENCE):
            raise HostError(f"{called} is still not made after {START_PATIENCE:g} s: it waits while it is made")
        if program.error is not None:
            del self.programs[called]
            raise program.error
        if not program.nodes:
            raise HostError(f"{called} ended with exit code {program.returncode} while it was made")
        return program.nodes[0]

    def start_class(self, node_class: Callable[[], BaseNode], called: str, argv: Sequence[str] = ()) -> Program:
        """Start a program of one Node class, `called` so or nearly so; give it. It begins as the host runs."""
        called = self._free_name(called)
        adopt(sys.modules.get(getattr(node_class, "__module__", "")))
        return self._start(called, [Part((argv or [called])[0], node_class, list(argv) or [called])], {})

    def _free_name(self, name: str) -> str:
        names = (name if number == 1 else f"{name}_{number}" for number in range(1, len(self.programs) + 2))
        return next(each for each in names if each not in self.programs)

    def _start(self, name: str, parts: Sequence[Part], env: Variables) -> Program:
        self._check_open()
        before = self.programs.get(name)
        if before is not None and not before.is_over:
            raise HostError(f"{name} runs already")
        program = self.programs[name] = Program(self, name, parts, env, self._clock(name, self.time))
        self._begin_program(program)
        return program

    def _check_open(self) -> None:
        if self._is_closed:
            raise HostError("this host is closed: nothing runs in it any more")

    def _begin_program(self, program: Program) -> None:
        program.prepare()
        self.pace.begin(program)

    def program(self, name: str) -> Program:
        """Return a program by its name. Raises NotFoundError."""
        if name not in self.programs:
            raise NotFoundError("program", name, self.programs)
        return self.programs[name]

    # Time

    def run(self, seconds: float) -> None:
        """Run for so many seconds of virtual time. Raises HostError if the host is closed, as all that runs it does."""
        self._check_open()
        self.time.sleep(round(seconds * 1e9))

    def run_until(self, condition: Callable[[], bool], within: float) -> bool:
        """Run until `condition()`, checked after each callback, for `within` s at most. Return True if it came true."""
        self._check_open()
        return self.pace.run_until(condition, self.time.steady() + round(within * 1e9))

    def at(self, seconds: float, act: Callable[[], object]) -> None:
        """Call `act()` when the host is so many seconds old, before the callbacks that are due then."""
        self.pace.at(self._begin + round(seconds * 1e9), act)

    # Ends

    def interrupt(self, name: str) -> Program:
        """Interrupt a program as Ctrl-C does, and do not wait for its end."""
        program = self.program(name)
        self.pace.interrupt(program)
        return program

    def stop(self, name: str) -> Program:
        """End a program in order, as Ctrl-C does; kill it if it has not ended after five seconds."""
        program = self.program(name)
        if not program.is_over:
            self.interrupt(name)
            self.run_until(lambda: program.is_over, PATIENCE)
            program.kill()
        return program

    def crash(self, name: str) -> Program:
        """Kill a program at once, as SIGKILL kills a process: its session ends, nothing is published."""
        program = self.program(name)
        program.kill()
        return program

    def restart(self, name: str) -> Program:
        """Start a program again, with a new session and its arguments; stop it first if it runs."""
        self._check_open()
        program = self.stop(name)
        program.time = self._clock(name, self.time)
        self._begin_program(program)
        return program

    def shared(self, env: dict[str, str | None]) -> dict[str, str | None]:
        """Return an environment that is equal to this one: the same for all programs that have the same."""
        return self._environments.setdefault(tuple(sorted(env.items())), env)

    def note_real_time(self, program: ProgramLike, what: str, place: str) -> None:
        """Record a use of real time by a program, unless it is known already."""
        use = RealTimeUse(program.name, what, place)
        if use not in self.real_time_use:
            self.real_time_use.append(use)

    def note_exit(self, program: Program) -> None:
        """Call `on_exit` for a program that has ended."""
        for each in list(self.on_exit):
            each(program)

    def close(self) -> None:
        """End all programs in order, and all threads of the host."""
        if self._is_closing:
            return
        self._is_closing = True
        try:
            for name in reversed(list(self.programs)):
                self.stop(name)
        finally:
            self._is_closed = True
            self.pace.close()
            uninstall()
            logging.set_time_source(self._stamps)
            random.setstate(self._random)
            self._cleanup.close()

    def __enter__(self) -> Host:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _part(member: Member) -> Part:
    if compat.activate(compat.ALWAYS):
        compat.prepare_opencv()
    source = find_node(member.node)
    return Part(member.name, source, [str(source.path or source.name), *member.args])


def _names(name: str, namespace: str) -> list[str]:
    given = [f"__node:={name}"] if name else []
    if namespace:
        given.append(f"__ns:=/{namespace.strip('/')}")
    return [word for each in given for word in ("-r", each)]
