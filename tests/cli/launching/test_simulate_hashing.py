"""`robolink simulate` in processes of their own: hashes of texts are the same in each, all else is as ever."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from robolink.cli.launching import hashing
from robolink.cli.main import main
from tests.support.commands import ROBOLINK
from tests.support.simulations import workspace

SETS = '''
"""Publishes the order of a set of texts, and the words of standard input."""

import os

from robolink import Node
from robolink.interfaces.std_msgs.msg import String


class Sets(Node):
    def __init__(self, **options):
        super().__init__("sets", **options)
        self.words = self.create_publisher(String, "words", 10)
        self.create_timer(0.1, self.tick)

    def tick(self):
        self.words.publish(String(data=" ".join({f"text {number}" for number in range(20)})))
        if self.get_clock().now().nanoseconds > 1_950_000_000:
            raise ValueError(f"read {os.read(0, 9)}")
'''

INTERRUPTED = "import _thread\n" + SETS.replace("raise ValueError", "_thread.interrupt_main() #").replace('"""', "'''")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    workspace(tmp_path, orders="nodes:\n  - {node: sets}\n", interrupts="nodes:\n  - {node: interrupted}\n")
    (tmp_path / "nodes" / "sets.py").write_text(SETS)
    (tmp_path / "nodes" / "interrupted.py").write_text(INTERRUPTED)
    return tmp_path


def simulated(folder: Path, *args: str, **environ: str) -> subprocess.CompletedProcess[str]:
    plain = {name: value for name, value in os.environ.items() if name != hashing.SEED}
    return subprocess.run(
        [*ROBOLINK, "--network", "off", "simulate", *args],
        cwd=folder,
        env={**plain, **environ},
        input="it",
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


@pytest.mark.processes
def test_two_processes_order_sets_of_texts_alike(folder: Path) -> None:
    first, again = (simulated(folder, "orders", "--duration", "0.5") for _ in range(2))
    other = simulated(folder, "orders", "--duration", "0.5", PYTHONHASHSEED="5")
    assert first.stdout.splitlines()[-1] == again.stdout.splitlines()[-1] != other.stdout.splitlines()[-1]
    assert "  /words" in first.stdout


@pytest.mark.processes
def test_exit_codes_and_standard_input_are_handed_on(folder: Path) -> None:
    done = simulated(folder, "orders", "--duration", "3", "--json")
    assert done.returncode == 1
    assert "read b'it'" in done.stdout.splitlines()[-1]
    assert simulated(folder, "interrupts", "--duration", "1e9").returncode == 130
    assert simulated(folder, "orders", "--duration", "nan").returncode == 2


@pytest.fixture
def begun(monkeypatch: pytest.MonkeyPatch) -> list[tuple[list[str], str]]:
    """The commands as which this process, that of `robolink simulate follow`, would begin anew."""
    became: list[tuple[list[str], str]] = []
    began = ["python", "-X", "dev", "-m", "robolink", "simulate", "follow"]
    mine = SimpleNamespace(
        flags=SimpleNamespace(hash_randomization=1), orig_argv=began, executable="/bin/python", platform="linux"
    )
    monkeypatch.setattr(hashing, "sys", mine)
    monkeypatch.setattr(hashing, "_become", lambda command, environ: became.append((command, environ[hashing.SEED])))
    monkeypatch.delenv(hashing.SEED, raising=False)
    return became


def test_python_begins_anew_with_its_own_options(begun: list[tuple[list[str], str]]) -> None:
    hashing.begin_steadily(["simulate", "follow"])
    assert begun == [(["/bin/python", "-X", "dev", "-m", "robolink", "simulate", "follow"], "0")]


def test_it_does_not_where_that_is_not_wanted(
    begun: list[tuple[list[str], str]], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    hashing.begin_steadily(["run", "simulate"])
    hashing.begin_steadily(["simulate", "lab"])  # the words of something else
    assert main(["simulate", "follow", "--duration", "nan"]) == 2
    mine = vars(hashing)["sys"]
    mine.orig_argv = ["python", "-", "simulate", "follow"]
    hashing.begin_steadily(["simulate", "follow"])
    mine.orig_argv = ["python", "-m", "robolink", "simulate", "follow"]
    monkeypatch.setenv(hashing.SEED, "random")
    hashing.begin_steadily(["simulate", "follow"])
    assert begun == []


def test_a_process_that_cannot_begin_anew_goes_on(
    begun: list[tuple[list[str], str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(command: list[str], environ: dict[str, str]) -> None:
        begun.append((command, environ[hashing.SEED]))
        raise FileNotFoundError

    monkeypatch.setattr(hashing, "_become", fail)
    hashing.begin_steadily(["simulate", "follow"])
    assert len(begun) == 1, "nothing was begun, so nothing failed"


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="there is no becoming another process")
def test_a_ctrl_c_that_comes_in_between_is_told_in_order(tmp_path: Path) -> None:
    interrupting = (
        "import os, signal, sys\n"
        "from robolink.cli.main import main\n"
        "become = os.execve\n"
        "def interrupted(*given): os.kill(os.getpid(), signal.SIGINT); become(*given)\n"
        "os.execve = interrupted\n"
        "sys.exit(main())\n"
    )
    plain = {name: value for name, value in os.environ.items() if name != hashing.SEED}
    command = [sys.executable, "-c", interrupting, "simulate", "follow", "--duration", "1e9"]
    done = subprocess.run(command, env=plain, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")


@pytest.mark.processes
def test_a_process_stands_in_for_another_where_it_cannot_become_it() -> None:
    code = (
        "import os, sys; from robolink.cli.launching.hashing import stand_in_for as s; "
        "sys.exit(s(sys.argv[1:], os.environ))"
    )
    child = [sys.executable, "-c", "print(input()); raise SystemExit(7)"]
    done = subprocess.run(
        [sys.executable, "-c", code, *child], input="it\n", capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (7, "it\n", "")


def test_windows_codes_of_32_bits_are_an_int_of_pythons(monkeypatch: pytest.MonkeyPatch) -> None:
    """`os._exit(0xC0000005)` is an OverflowError."""
    ended: list[int] = []
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(os, "_exit", ended.append)
    monkeypatch.setattr(hashing, "stand_in_for", lambda command, environ: 0xC0000005)
    hashing._begin_anew(["x"], {})
    assert [each % 2**32 for each in ended] == [0xC0000005]
    assert -(2**31) <= ended[0] < 2**31
