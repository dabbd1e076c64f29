"""Processes that a fork server starts are the supervisor's own, as if it had started each of them directly."""

from __future__ import annotations

import functools
import io
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from queue import SimpleQueue

import pytest

from robolink.launch.command import FORK_SERVER, NODES_PER_CORE, _fork_server, launch
from robolink.launch.reading.entries import read_launch_file
from robolink.supervisor import Process, Supervisor
from robolink.supervisor.processes import fork_server
from robolink.supervisor.processes.fork_server import ForkServer
from robolink.supervisor.processes.guardian import signal_group
from robolink.supervisor.processes.lifeline import Lifeline
from robolink.supervisor.processes.process import Child
from robolink.system.processes import own_command
from robolink.workspace import VARIABLE
from tests.support.supervised import INTERRUPT, KILL, PATIENCE

KILLED, STOPPED = 9, 19
"""Numbers of SIGKILL and, on Linux, SIGSTOP."""

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(sys.platform != "linux", reason="processes are forked on Linux only"),
]

SCRIPT = """
import os, signal, sys, threading, time

def main():
    kind, *words = sys.argv[1:]
    if kind == "facts":
        print(os.getppid(), os.getsid(0) == os.getpid(), repr(sys.stdin.read()), os.environ.get("ROBOLINK_WORKSPACE"))
        print(sys.argv[2:], sys.orig_argv[-1], open("/proc/self/cmdline").read().rstrip(chr(0)).replace(chr(0), " "))
        files = [os.path.realpath("/proc/self/fd/" + each) for each in os.listdir("/proc/self/fd")]
        files = sum(".so." not in each for each in files)  # libffi holds its own file open
        print(files, threading.active_count(), signal.pthread_sigmask(0, []), os.getcwd())
        print("to standard error", file=sys.stderr)
    elif kind == "end":
        sys.exit(int(words[0]))
    elif kind == "signal":
        os.kill(os.getpid(), int(words[0]))
    else:
        print("ready", flush=True)
        while True:
            time.sleep(0.02)
"""


@pytest.fixture
def server() -> Iterator[ForkServer]:
    with closing(ForkServer(own_command(), [FORK_SERVER], [VARIABLE])) as made:
        yield made


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "script.py"
    path.write_text(SCRIPT)
    return path


def asked(script: Path, *words: str, name: str = "a", env: dict[str, str] | None = None) -> Process:
    argv = [*own_command(), "run", f"{script}:main", "--", *words]
    return Process(name, argv, env=env or {}, holds_interrupts=True)


def run(server: ForkServer | None, *processes: Process) -> tuple[int, list[str]]:
    output = io.StringIO()
    start = functools.partial(Child, server=server)
    code = Supervisor(processes, output=output, start=start, patience=PATIENCE).run()
    return code, output.getvalue().splitlines()


class Started:
    """A child whose lines and whose end can be awaited."""

    def __init__(self, process: Process, lifeline: Lifeline, server: ForkServer) -> None:
        self.child = Child(process, lifeline, server)
        self.lines: SimpleQueue[bytes] = SimpleQueue()
        self.codes: SimpleQueue[int] = SimpleQueue()
        self.child.watch(lambda name, line, fd=None: self.lines.put(line), lambda name, code: self.codes.put(code))

    def line(self) -> str:
        return self.lines.get(timeout=PATIENCE).decode().strip()

    def code(self) -> int:
        return self.codes.get(timeout=PATIENCE)


def parent(pid: int) -> int:
    return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])


def server_of(server: ForkServer) -> subprocess.Popen[bytes]:
    assert server._process is not None
    return server._process


def test_it_finds_what_a_process_finds_that_was_started_directly(script: Path, server: ForkServer) -> None:
    process = asked(script, "facts", "a word", "b", env={VARIABLE: str(script.parent)})
    _, direct = run(None, process)
    code, forked = run(server, process)
    assert code == 0
    shown = " ".join(process.argv)
    assert f"[a] ['a word', 'b'] b {shown}" in forked
    assert direct == forked
    assert forked[0] == f"[a] {os.getpid()} True '' {script.parent}"
    assert forked[3:] == ["[a] to standard error", "[launch] a has ended"]
    server_of(server)  # it was this that started it


@pytest.mark.parametrize(("words", "code"), [(("end", "3"), 3), (("signal", "15"), 143), (("signal", "9"), 137)])
def test_how_it_ends_is_known(words: tuple[str, ...], code: int, script: Path, server: ForkServer) -> None:
    assert run(server, asked(script, *words))[0] == code
    server_of(server)


def test_many_are_children_of_the_supervisor_and_obey_it(script: Path, server: ForkServer) -> None:
    with closing(Lifeline()) as lifeline:
        started = [Started(asked(script, "wait", name=f"n{i}"), lifeline, server) for i in range(4)]
        for each in started:
            assert each.line() == "ready"
            assert parent(each.child.group) == os.getpid()
        started[0].child.ask(INTERRUPT)
        assert started[0].code() == 130
        started[1].child.ask(KILL)
        assert started[1].code() == -KILLED
    for each in started[2:]:  # their lifeline has ended
        assert each.code() == 130


def test_with_the_server_gone_they_go_on_and_the_next_ones_are_started_directly(
    script: Path, server: ForkServer
) -> None:
    with closing(Lifeline()) as lifeline:
        first = Started(asked(script, "wait"), lifeline, server)
        assert first.line() == "ready"
        server_of(server).kill()
        second = Started(asked(script, "wait", name="b"), lifeline, server)
        assert second.line() == "ready"
        assert server._process is None
        assert not server.can_become(asked(script, "wait").argv, {})
        for each in (first, second):
            each.child.ask(KILL)
            assert each.code() == -KILLED


@pytest.mark.parametrize("words", [["--version"], ["no-such-command"]])
def test_a_server_that_does_not_serve_is_done_without(words: list[str], script: Path) -> None:
    with closing(ForkServer(own_command(), words, [VARIABLE])) as server:
        assert run(server, asked(script, "end", "3"))[0] == 3
        assert server._process is None


@pytest.mark.parametrize(
    "begun",
    [
        "import threading, time; threading.Thread(target=time.sleep, args=(60,), daemon=True).start()",
        "import numpy.random",
    ],
)
def test_a_python_that_begins_with_more_than_a_fork_copies_does_not_serve(
    begun: str, script: Path, tmp_path: Path, server: ForkServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "sitecustomize.py").write_text(begun)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path), prepend=os.pathsep)
    assert run(server, asked(script, "end", "3"))[0] == 3
    assert server._process is None


def test_a_server_that_does_not_answer_holds_up_no_end(script: Path, server: ForkServer) -> None:
    """Somebody has paused it: without the user's wish to end, this would wait for half a minute."""
    with closing(Lifeline()) as lifeline:
        first = Started(asked(script, "wait"), lifeline, server)
        assert first.line() == "ready"
        paused = server_of(server)
        signal_group(paused.pid, STOPPED)
        server.is_end_requested = lambda: True
        begun = time.monotonic()
        second = Started(asked(script, "wait", name="b"), lifeline, server)
        assert time.monotonic() - begun < fork_server.PATIENCE
        assert second.line() == "ready"
        assert paused.returncode == -KILLED
    for each in (first, second):
        assert each.code() == 130


def test_a_launcher_tells_its_server_that_the_user_asks_for_the_end(
    script: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    end_requested: list[bool] = []

    def fork(server: ForkServer, *args: object) -> None:
        end_requested.append(server.is_end_requested())
        signal.raise_signal(signal.SIGTERM)
        end_requested.append(server.is_end_requested())

    count = NODES_PER_CORE * (os.cpu_count() or 1)
    nodes = "".join(f"  - {{node: '{script}:main', name: n{i}, args: [wait]}}\n" for i in range(count))
    file = tmp_path / "many.yaml"
    file.write_text(f"nodes:\n{nodes}")
    monkeypatch.setattr(ForkServer, "fork", fork)
    launch(read_launch_file(file, {}), file, on_event=lambda event: None)
    assert end_requested[:2] == [False, True]


def test_a_process_that_is_not_let_go_ends(script: Path, server: ForkServer, monkeypatch: pytest.MonkeyPatch) -> None:
    pids: list[int] = []
    waitpid = os.waitpid

    def not_ours(pid: int, options: int) -> tuple[int, int]:
        if pids:  # the server's own end
            return waitpid(pid, options)
        pids.append(pid)
        raise ChildProcessError

    devnull = os.open(os.devnull, os.O_RDONLY)
    with closing(Lifeline()) as lifeline, monkeypatch.context() as patched:
        patched.setattr(os, "waitpid", not_ours)
        process = asked(script, "wait")
        assert server.fork(process.argv, {}, devnull, lifeline, dict(os.environ)) is None
    os.close(devnull)
    assert os.waitstatus_to_exitcode(os.waitpid(pids[0], 0)[1]) == 0


def test_only_what_the_server_can_become_is_left_to_it(script: Path, server: ForkServer) -> None:
    argv = asked(script, "wait").argv
    assert server.can_become(argv, {VARIABLE: "x"})
    assert not server.can_become(argv, {"LANG": "C"})
    assert not server.can_become([sys.executable, "-c", ""], {})
    for unlike in (
        Process("a", argv, cwd=str(script.parent), holds_interrupts=True),
        Process("a", argv, interactive=True, holds_interrupts=True),
        Process("a", argv),
    ):
        with closing(Lifeline()) as lifeline:
            child = Child(unlike, lifeline, server)
            child.watch(lambda name, line, fd=None: None, lambda name, code: None)
            child.ask(KILL)
        assert server._process is None


def test_a_launcher_uses_one_for_many_nodes(script: Path) -> None:
    enough = NODES_PER_CORE * (os.cpu_count() or 1)
    many = [asked(script, "wait", name=f"n{i}") for i in range(enough)]
    assert _fork_server(many) is not None
    assert _fork_server(many[1:]) is None
    assert _fork_server([*many[1:], Process("b", ["sh"])]) is None
