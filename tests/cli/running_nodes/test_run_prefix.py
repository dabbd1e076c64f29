"""robolink run --prefix: another program runs the node."""

from __future__ import annotations

import sys

import pytest

from robolink.cli.main import main
from robolink.cli.running_nodes import prefix
from robolink.system.processes import own_command
from tests.support.commands import Command
from tests.support.started import Write

PYTHON = sys.executable


def test_a_prefix_is_a_command_line() -> None:
    line = prefix.command_line(f"'{PYTHON}' -x 'a b'" if sys.platform != "win32" else f"{PYTHON} -x", ["run", "x"])
    assert line[0] == PYTHON
    assert line[-2 - len(own_command()) :] == [*own_command(), "run", "x"]
    assert prefix.command_line("python3 -m pdb", ["run", "x"]) == [PYTHON, "-m", "pdb", "-m", "robolink", "run", "x"]


@pytest.mark.parametrize(
    ("given", "report"),
    [
        ("no_such_program -x", "no program named 'no_such_program'"),
        ("", "expected a command"),
        ("'", "expected a"),
    ],
)
def test_what_is_none_is_one_line(given: str, report: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "--prefix", given, "first_node"]) == 1
    err = capsys.readouterr().err
    assert (report in err, err.count("\n")) == (True, 1)


def test_all_words_go_behind_it(monkeypatch: pytest.MonkeyPatch) -> None:
    ran: list[list[str]] = []

    def run(before: str, words: list[str]) -> int:
        ran.append([before, *words])
        return 7

    monkeypatch.setattr(prefix, "run", run)
    words = "--prefix gdb pkg exe --rate 5 -p a:=1 --workspace w -- --prefix x --ros-args -r b:=c"
    assert main(["run", *words.split()]) == 7
    expected = "gdb run --workspace w pkg exe --rate 5 -- --prefix x --ros-args -p a:=1 --ros-args -r b:=c"
    assert ran == [expected.split()]


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="there is no env")
def test_a_program_runs_behind_it(write: Write) -> None:
    write("nodes/tell.py", "import os, sys\nprint(os.environ['TOLD'], sys.argv[1:])\n")
    with Command(0, "run", "--prefix", "env TOLD=yes", "tell", "a", "-p", "b:=1") as command:
        assert command.wait_for("yes").text == "yes ['a', '--ros-args', '-p', 'b:=1']"
        assert command.end() == 0
