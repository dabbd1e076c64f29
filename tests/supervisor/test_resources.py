"""What processes use is measured for each group, and cores are given or refused in words."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import msgspec
import psutil
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.cli.launching import launchers as commands
from robolink.cli.main import main
from robolink.supervisor.control.client import running as launchers
from robolink.supervisor.control.server import Control
from robolink.supervisor.monitoring.resources import (
    Figures,
    Identity,
    Meter,
    Taken,
    Usage,
    line_of_figures,
    look_at_groups,
    shown_memory,
)
from robolink.supervisor.processes.affinity import CoreError, check_cores, ranges, set_affinity, usable_cores
from tests.support.launchers import FakeSupervisor, own_runtime_folder

PATIENCE = 30.0
linux_only = pytest.mark.skipif(sys.platform != "linux", reason="threads are kept on cores one by one there")

PARENT = """
import subprocess, sys
text = "import sys; print('ready', flush=True); sys.stdin.read()"
child = subprocess.Popen([sys.executable, "-c", text], stdin=subprocess.PIPE)
sys.stdin.read()
child.communicate()
"""


@pytest.fixture
def parent() -> Iterator[subprocess.Popen[bytes]]:
    """A process group of two processes."""
    with subprocess.Popen(
        [sys.executable, "-c", PARENT], stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stdout.readline().strip() == b"ready"
        yield process
        process.stdin.close()


# --- measuring ------------------------------------------------------------------------------------------------


class Machine:
    """Processes by group whose figures a test sets, and a clock."""

    def __init__(self) -> None:
        self.now = 100.0
        self.groups: dict[int, dict[Identity, Taken]] = {}

    def meter(self) -> Meter:
        return Meter(lambda groups: {each: dict(self.groups.get(each, {})) for each in groups}, lambda: self.now)


def test_cpu_is_known_from_the_second_look_on() -> None:
    machine = Machine()
    meter = machine.meter()
    machine.groups = {7: {(7, 1.0): Taken(3.0, 1000), (8, 2.0): Taken(1.0, 500)}}
    assert meter.measure([7]) == {7: Usage(None, 1500, 2)}
    machine.now += 2.0
    machine.groups = {7: {(7, 1.0): Taken(3.5, 1200), (8, 2.0): Taken(1.1, 500)}}
    assert meter.measure([7])[7].cpu == pytest.approx(30.0)


def test_a_process_that_is_new_has_worked_since_the_last_look() -> None:
    machine = Machine()
    meter = machine.meter()
    machine.groups = {7: {(7, 1.0): Taken(3.0, 1)}}
    meter.measure([7])
    machine.now += 1.0
    machine.groups = {7: {(7, 1.0): Taken(3.0, 1), (8, 100.5): Taken(0.25, 1)}}
    assert meter.measure([7])[7].cpu == pytest.approx(25.0)


def test_a_number_that_is_used_again_is_another_process() -> None:
    machine = Machine()
    meter = machine.meter()
    machine.groups = {7: {(7, 1.0): Taken(500.0, 1)}}
    meter.measure([7])
    machine.now += 1.0
    machine.groups = {7: {(7, 100.1): Taken(0.5, 1)}}
    assert meter.measure([7])[7].cpu == pytest.approx(50.0)


def test_what_has_ended_is_left_out() -> None:
    machine = Machine()
    assert machine.meter().measure([7]) == {}


@pytest.mark.processes
def test_a_real_group_is_all_that_a_process_started(parent: subprocess.Popen[bytes]) -> None:
    found = look_at_groups([parent.pid])[parent.pid]
    assert len(found) == 2
    assert (parent.pid, psutil.Process(parent.pid).create_time()) in found
    assert all(taken.memory > 1_000_000 for taken in found.values())


@pytest.mark.processes
def test_a_process_that_is_no_more_uses_nothing(parent: subprocess.Popen[bytes]) -> None:
    parent.communicate()
    assert Meter().measure([parent.pid]) == {}


def test_our_own_work_is_seen() -> None:
    """The clock is ours: what is counted is the processor's time."""
    now = 0.0
    meter = Meter(clock=lambda: now)
    group = os.getpid()
    if sys.platform != "win32":
        group = os.getpgrp()
    meter.measure([group])
    until = time.process_time() + 0.1
    while time.process_time() < until:
        pass
    now = 1.0
    cpu = meter.measure([group])[group].cpu
    assert cpu is not None
    assert cpu >= 5.0


def test_figures_on_a_line_name_the_busiest() -> None:
    usage = {f"n{index}": Usage(float(index), 10_000_000, 1) for index in range(8)}
    named = ", ".join(f"n{index} {index} % 10 MB" for index in (7, 6, 5, 4, 3, 2))
    assert line_of_figures(usage) == f"28 % of a core, 80 MB: {named}, 2 more"


@pytest.mark.parametrize(("memory", "shown"), [(0, "0 MB"), (46_400_000, "46 MB"), (12_340_000_000, "12.3 GB")])
def test_memory_is_written_short(memory: int, shown: str) -> None:
    assert shown_memory(memory) == shown


@pytest.mark.processes
def test_figures_come_by_themselves_and_end(parent: subprocess.Popen[bytes]) -> None:
    supervisor = FakeSupervisor("talker")
    supervisor.runs(pid=parent.pid)
    said = threading.Event()
    lines: list[str] = []

    def say(line: str) -> None:
        lines.append(line)
        said.set()

    before = set(threading.enumerate())
    with Figures(supervisor.status, say, every=0.01):
        assert said.wait(PATIENCE)
    assert set(threading.enumerate()) <= before
    assert re.fullmatch(r"(\d+) % of a core, (\d+) MB: talker \1 % \2 MB", lines[0])


# --- robolink launch --top ------------------------------------------------------------------------------------


@pytest.fixture
def folder(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    with own_runtime_folder(monkeypatch) as made:
        yield made


class Output(io.StringIO):
    """Standard output on which a line can be waited for."""

    def __init__(self, *, on_terminal: bool = False) -> None:
        super().__init__()
        self.on_terminal = on_terminal
        self.changed = threading.Condition()

    def isatty(self) -> bool:
        return self.on_terminal

    def write(self, text: str) -> int:
        with self.changed:
            self.changed.notify_all()
            return super().write(text)

    def wait_for(self, text: str, times: int = 1) -> None:
        with self.changed:
            assert self.changed.wait_for(lambda: self.getvalue().count(text) >= times, PATIENCE), self.getvalue()


@pytest.mark.processes
@pytest.mark.parametrize("on_terminal", [False, True])
def test_top_shows_a_table_until_the_launcher_ends(
    on_terminal: bool, folder: Path, parent: subprocess.Popen[bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    output = Output(on_terminal=on_terminal)
    monkeypatch.setattr(sys, "stdout", output)
    monkeypatch.setenv("TERM", "xterm")
    supervisor = FakeSupervisor("talker", "listener")
    supervisor.runs(pid=parent.pid, restarts=2)
    with ThreadPoolExecutor(1) as pool:
        with Control(supervisor, name="follow"):
            done = pool.submit(commands.top, every=0.01)
            output.wait_for("NODE", times=2)
        done.result(PATIENCE)
    text = output.getvalue()
    rows = [line.split() for line in text.splitlines()]
    assert any(row[:1] == ["talker"] and row[2:3] == ["%"] and row[-2:] == ["2", "running"] for row in rows)
    assert any(row[:2] == ["listener", "-"] and row[-1] == "running" for row in rows)
    assert text.rstrip().endswith("has ended")
    assert ("\x1b[" in text) == on_terminal


@pytest.mark.processes
def test_top_as_json_is_an_object_a_line(
    folder: Path, parent: subprocess.Popen[bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    output = Output()
    monkeypatch.setattr(sys, "stdout", output)
    supervisor = FakeSupervisor("talker", "listener")
    supervisor.runs(pid=parent.pid, restarts=2)
    with ThreadPoolExecutor(1) as pool:
        with Control(supervisor, name="follow"):
            done = pool.submit(commands.top, "follow", json=True, every=0.01)
            output.wait_for("\n")
        done.result(PATIENCE)
    first = msgspec.json.decode(output.getvalue().splitlines()[0])
    talker, listener = first["nodes"]
    assert (talker["name"], talker["pid"], talker["restarts"], talker["processes"]) == ("talker", parent.pid, 2, 2)
    assert talker["memory"] > 1_000_000
    assert talker["cpu"] >= 0.0
    assert (listener["cpu"], listener["memory"]) == (None, None)


@pytest.mark.processes
def test_commands_that_ask_import_nothing_heavy(folder: Path) -> None:
    program = (
        "import sys; from robolink.cli.main import main; main(['launch', '--status']);"
        "print(*(each for each in ('zenoh', 'numpy', 'rich', 'psutil') if each in sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == "no launcher is running\n\n"
    assert launchers() == []
    assert main(["launch", "--status"]) == 0


# --- cores ----------------------------------------------------------------------------------------------------


def test_the_cores_of_this_machine_are_allowed() -> None:
    assert usable_cores()
    check_cores(usable_cores())


@pytest.mark.parametrize(
    ("cores", "text"),
    [
        ([99_999], r"core 99999 is not there: this machine offers cores? 0"),
        ([0, 88_888, 99_999], r"cores 88888, 99999 are not there: this machine offers"),
        ([-1], r"core -1 is not there"),
        ([], r"no core is named"),
    ],
)
def test_a_core_that_is_not_there_is_refused(cores: list[int], text: str) -> None:
    with pytest.raises(CoreError, match=text):
        check_cores(cores)


def test_looking_for_cores_leaves_us_where_we_are() -> None:
    if sys.platform != "linux":  # here, where the types of macOS, which lack what follows, are checked
        pytest.skip("looking moves nobody there")
    before = psutil.Process().cpu_affinity()
    assert before
    assert set(usable_cores()) >= set(before)
    assert psutil.Process().cpu_affinity() == before


@pytest.mark.processes
def test_a_process_is_kept_on_a_core(parent: subprocess.Popen[bytes]) -> None:
    if sys.platform == "darwin":
        pytest.skip("macOS keeps no process on a core")
    core = usable_cores()[-1]
    assert set_affinity(parent.pid, [core]) == ""
    assert psutil.Process(parent.pid).cpu_affinity() == [core]


@pytest.mark.processes
def test_all_threads_of_a_process_are_kept_on_it() -> None:
    if sys.platform != "linux":
        pytest.skip("threads are kept on cores one by one there")
    text = (
        "import sys, threading; threading.Thread(target=sys.stdin.read).start();"
        "print(threading.enumerate()[-1].native_id, flush=True)"
    )
    command = [sys.executable, "-c", text]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        thread = int(process.stdout.readline())
        assert thread != process.pid
        core = usable_cores()[-1]
        assert set_affinity(process.pid, [core]) == ""
        assert psutil.Process(process.pid).cpu_affinity() == [core]
        assert os.sched_getaffinity(thread) == {core}
        process.communicate()


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "darwin", reason="macOS keeps no process on a core")
def test_a_process_that_has_ended_is_no_trouble(parent: subprocess.Popen[bytes]) -> None:
    parent.communicate()
    assert set_affinity(parent.pid, usable_cores()) == ""


@pytest.mark.processes
@linux_only
def test_why_it_cannot_be_is_said(parent: subprocess.Popen[bytes]) -> None:
    assert set_affinity(parent.pid, [4000]).startswith("cpu: cannot keep it on core 4000: ")


def test_where_it_cannot_be_at_all_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "platform", "darwin")
    assert set_affinity(os.getpid(), [0]).startswith("cpu: this system keeps no process on a core")
    check_cores([0])


@given(st.sets(st.integers(0, 200), min_size=1))
def test_ranges_name_each_core_once(cores: set[int]) -> None:
    text = ranges(sorted(cores)).removeprefix("cores ").removeprefix("core ")
    named: list[int] = []
    for part in text.split(", "):
        first, _, last = part.partition("-")
        named += range(int(first), int(last or first) + 1)
    assert named == sorted(cores)
