"""Runs the programs of a system in this process, each with a session, a clock and arguments of its own."""

from __future__ import annotations

import random
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any

from robolink import compat, logging
from robolink.defaults import get_defaults
from robolink.exceptions import NotFoundError
from robolink.impl.log_output import output
from robolink.launch.together import Member
from robolink.oneprocess import real_time_use
from robolink.oneprocess.kept import process_as_before
from robolink.oneprocess.program import Part, Program
from robolink.oneprocess.real_time import RealPace
from robolink.oneprocess.real_time_use import RealTimeUse
from robolink.oneprocess.turns import HostError, Turns
from robolink.oneprocess.virtual import VirtualPace
from robolink.timebase import TimeBase
from robolink.transport.base import Transport
from robolink.transport.memory import Bus, MemoryTransport
from robolink.workspace import find_node
from robolink.yamlfile import spell

if TYPE_CHECKING:
    from robolink.node import Node

PATIENCE = 5.0
"""Seconds that a program has to end after it was asked to, before it is killed."""

START_PATIENCE = 60.0
"""Seconds within which `start_node` must have its node."""


class Host:
    """Runs the programs of a system in this process: in virtual time, of which each run is the same.

    `connect` gives the session on the network of a program by its name, a MemoryTransport on `bus` by default;
    `clock` the time of a program, by its name and the host's time. `seed` begins Python's `random`.

    >>> with Host() as host:
    ...     talker = host.start_node(Talker)
    ...     host.run(10.0)
    """

    def __init__(
        self,
        *,
        virtual: bool = True,
        seed: int = 0,
        connect: Callable[[str], Transport] | None = None,
        clock: Callable[[str, TimeBase], TimeBase] | None = None,
    ) -> None:
        self.seed = seed
        self.bus = Bus()
        self.connect: Callable[[str], Transport] = connect or self._session
        self.pace: VirtualPace | RealPace = VirtualPace() if virtual else RealPace()
        self.time: TimeBase = self.pace.time
        self.turns: Turns | None = self.pace.turns
        self.programs: dict[str, Program] = {}
        self.on_exit: list[Callable[[Program], object]] = []
        """Called with each program that has ended, in whatever way."""
        self._clock = clock or (lambda name, time: time)
        self._begin = self.time.steady()
        self._environments: dict[tuple[tuple[str, str], ...], dict[str, str]] = {}
        self._random = random.getstate()
        self._stamps = output.now
        self._kept = ExitStack()
        self._kept.enter_context(process_as_before())
        self._is_closing = self._is_closed = False
        self.wishes: dict[str, Any] = {}
        """Values by parameter, for nodes started by name or file that declare it, have no other, and let it through."""
        self.real_time_use: list[RealTimeUse] = []
        """What programs did by real time, each thing once: program, what, and where in its code."""
        real_time_use.install()
        random.seed(seed)
        logging.set_time_source(self._now_here)

    def _session(self, name: str) -> Transport:
        session = MemoryTransport(bus=self.bus)
        session.threaded = self.turns is None
        return session

    @property
    def the_turns(self) -> Turns:
        """Who decides whose turn it is. Raises HostError in real time, in which nobody does."""
        if self.turns is None:
            raise HostError("only in virtual time do programs take turns")
        return self.turns

    @property
    def now(self) -> float:
        """Seconds since the host began."""
        return (self.time.steady() - self._begin) / 1e9

    def _now_here(self) -> int:
        """Give the time of the program whose code this is, or the host's."""
        program: Program | None = get_defaults().program
        return (self if program is None else program).time.now()

    # Programs

    def start(self, name: str, members: Sequence[Member], *, env: Mapping[str, str] | None = None) -> Program:
        """Start a program, called `name`, of some nodes, or of one script; give it.

        It begins at once, and goes on as the host runs. Raises NotFoundError for a node that there is not, and
        HostError for a program of this name that runs already.
        """
        return self._start(name, [_part(each) for each in members], env or {})

    def start_node(
        self,
        node_class: Callable[[], Node],
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
        called = self._free_name(called or f"{namespace.strip('/')}/{own}".lstrip("/"))
        real_time_use.adopt(sys.modules.get(getattr(node_class, "__module__", "")))
        program = self._start(called, [Part(own, node_class, argv)], {})
        if not self.run_until(lambda: program.has_begun, START_PATIENCE):
            raise HostError(f"{called} is still not made after {START_PATIENCE:g} s: it waits while it is made")
        if program.error is not None:
            del self.programs[called]
            raise program.error
        if not program.nodes:
            raise HostError(f"{called} ended with exit code {program.returncode} while it was made")
        return program.nodes[0]

    def _free_name(self, name: str) -> str:
        names = (name if number == 1 else f"{name}_{number}" for number in range(1, len(self.programs) + 2))
        return next(each for each in names if each not in self.programs)

    def _start(self, name: str, parts: Sequence[Part], env: Mapping[str, str]) -> Program:
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
        """Give a program by its name. Raises NotFoundError."""
        if name not in self.programs:
            raise NotFoundError("program", name, self.programs)
        return self.programs[name]

    # Time

    def run(self, seconds: float) -> None:
        """Let so many seconds pass. Raises HostError for a host that is closed, as all that lets time pass does."""
        self._check_open()
        if self.turns is not None:
            self.time.sleep(round(seconds * 1e9))
        else:
            self.run_until(lambda: False, seconds)

    def run_until(self, condition: Callable[[], bool], within: float) -> bool:
        """Let time pass until `condition()`, which is asked after each callback; whether it came true in `within` s."""
        self._check_open()
        return self.pace.run_until(condition, self.time.steady() + round(within * 1e9))

    def at(self, seconds: float, act: Callable[[], object]) -> None:
        """Call `act()` when the host is so many seconds old, before what callbacks are due then."""
        self.pace.at(self._begin + round(seconds * 1e9), act)

    # Ends

    def interrupt(self, name: str) -> Program:
        """Ask a program to end in order, as Ctrl-C does, and do not wait for its end."""
        program = self.program(name)
        self.pace.interrupt(program)
        return program

    def stop(self, name: str) -> Program:
        """Have a program end in order, as Ctrl-C does; one that has not ended after five seconds is killed."""
        program = self.program(name)
        if not program.is_over:
            self.interrupt(name)
            self.run_until(lambda: program.is_over, PATIENCE)
            program.kill()
        return program

    def crash(self, name: str) -> Program:
        """Have a program gone at once, as if its process were killed: its session ends, nothing is said."""
        program = self.program(name)
        program.kill()
        return program

    def restart(self, name: str) -> Program:
        """Start a program anew, once more with a session and arguments of its own; stop it first if it runs."""
        self._check_open()
        program = self.stop(name)
        program.time = self._clock(name, self.time)
        self._begin_program(program)
        return program

    def shared(self, env: dict[str, str]) -> dict[str, str]:
        """Give an environment that is equal to this one: the same for all programs that have the same."""
        return self._environments.setdefault(tuple(sorted(env.items())), env)

    def note_real_time(self, program: Program, what: str, place: str) -> None:
        """Note what a program did by real time, and where, unless that is known already."""
        use = RealTimeUse(program.name, what, place)
        if use not in self.real_time_use:
            self.real_time_use.append(use)

    def note_exit(self, program: Program) -> None:
        """Tell of a program's end."""
        for each in list(self.on_exit):
            each(program)
        self.pace.note_exit()

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
            real_time_use.uninstall()
            logging.set_time_source(self._stamps)
            random.setstate(self._random)
            self._kept.close()

    def __enter__(self) -> Host:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _part(member: Member) -> Part:
    compat.activate(compat.ALWAYS)
    source = find_node(member.node)
    return Part(member.name, source, [str(source.path or source.name), *member.args])


def _names(name: str, namespace: str) -> list[str]:
    given = [f"__node:={name}"] if name else []
    if namespace:
        given.append(f"__ns:=/{namespace.strip('/')}")
    return [word for each in given for word in ("-r", each)]
