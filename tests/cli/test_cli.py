"""The command line: what starts, what ends it, and that every mistake is one line on stderr."""

from __future__ import annotations

import functools
import io
import json
import os
import signal
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

import pytest

import robolink.cli.main
from robolink import Context
from robolink.cli.main import main
from robolink.cli.shared.commands import NOUNS
from robolink.executors import SingleThreadedExecutor
from robolink.extensions.optional import is_here
from robolink.supervisor import Supervisor
from robolink.transport.memory import MemoryTransport
from robolink.workspace import VARIABLE
from tests.support.started import PATIENCE, TALKER, Write, outcome, posix_only, started, wait_for

# --- help and wrong usage -------------------------------------------------------------------------------------

HERE = {name: entry for name, entry in NOUNS.items() if is_here(entry.module)}
"""Commands that this copy has: an annex may have been deleted (tools/without_annex.py)."""


def test_the_installed_command_is_this_one() -> None:
    (command,) = entry_points(group="console_scripts", name="robolink")
    assert command.load() is main, "pyproject.toml's entry point has moved, or is not installed: make .venv/.ready"


def test_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    shown = capsys.readouterr().out
    listed = {name: entry for name, entry in HERE.items() if not entry.hidden}
    assert all(f"\n  {name} " in shown and entry.help in shown for name, entry in listed.items())
    assert "wtf" not in shown


@pytest.mark.parametrize("command", HERE)
def test_every_command_has_help(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([command, "--help"]) == 0
    assert f"Usage: robolink {command}" in capsys.readouterr().out


@pytest.mark.processes
def test_help_imports_nothing_heavy() -> None:
    code = "import sys; from robolink.cli.main import main; main(['--help']); print(*sys.modules)"
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    loaded = set(shown.splitlines()[-1].split())
    assert "typer" in loaded
    # importlib.metadata is, since help lists what other packages add.
    assert not loaded & {"numpy", "zenoh", "msgspec", "yaml", "rich", "pymunk", "asyncio"}


@pytest.mark.parametrize(
    ("args", "report"),
    [
        (["lunch"], "no command named 'lunch' (did you mean 'launch'?) (see 'robolink --help')"),
        (["run"], "which node? --list shows them (see 'robolink run --help')"),
        (["launch"], "launch what? --list shows what there is (see 'robolink launch --help')"),
        (["run", "world", "--nam", "x"], "No such option: --nam"),
        (
            ["topic", "list", "--network", "lan"],
            "No such option: --network (for all commands it comes first: robolink --network NET topic list ...)",
        ),
        (["run", "world", "--name"], "Option '--name' requires an argument"),
        (["launch", "x", "--duration", "long"], "Invalid value for '--duration': 'long' is not a valid float"),
        (["launch", "x", "--duration", "-1"], "Invalid value for '--duration': expected 0 to 1e+09 seconds, got -1"),
        (["topic", "lst"], "no command named 'topic lst' (did you mean 'list'?) (see 'robolink topic --help')"),
        (["help"], "no command named 'help' (did you mean '--help'?)"),
        (["sim"], "no command named 'sim' (did you mean 'simulate'?)"),
        (["hz", "/scan"], "no command named 'hz' (did you mean 'topic hz'?)"),
        pytest.param(
            *(["list"], "no command named 'list' (did you mean 'pkg list', 'learn list', 'topic list' ...?)"),
            marks=pytest.mark.annex("learn"),
        ),
        pytest.param(
            ["rviz2"], "no command named 'rviz2' (did you mean 'run rviz2'?)", marks=pytest.mark.annex("view")
        ),
        (["wander"], "no command named 'wander' (did you mean 'launch wander'?)"),
        (["gazebo"], "no command named 'gazebo': Gazebo, a simulator in C++; 'robolink run world' simulates a robot"),
        (["ros2", "topic", "list"], "no command named 'ros2': robolink takes the words after it"),
        (["topic", "echo"], "Missing argument 'TOPIC' (see 'robolink topic echo --help')"),
    ],
)
def test_wrong_usage_is_one_line_and_2(args: list[str], report: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(args) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"robolink: {report}")
    assert err.count("\n") == 1


@pytest.mark.parametrize("args", [[], ["topic"]])
def test_a_noun_without_a_verb_is_helped(args: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(args) == 2
    assert "Commands:" in capsys.readouterr().err


def test_a_signal_before_the_spin_is_a_usual_end(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def make_an_executor_too_late(_: list[str]) -> int:
        with Context(transport=MemoryTransport("early signal")) as context:
            context.interrupt()
            SingleThreadedExecutor(context=context)
        return 0

    monkeypatch.setattr(robolink.cli.main, "_run", make_an_executor_too_late)
    assert main(["run", "talker"]) == 130
    assert capsys.readouterr().err == ""


def test_a_network_is_asked_for_before_the_command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ROBOLINK_NETWORK", "localhost")
    monkeypatch.setenv("ROBOLINK_NETWORK_ASKED_BY", "")
    assert main(["--network", "no/where", "topic", "list"]) == 1
    assert capsys.readouterr().err.startswith("robolink: --network: no network, host or file 'no/where'")
    assert main(["--network", "off", "topic", "list"]) == 0
    assert capsys.readouterr() == ("", "")


@pytest.mark.processes
def test_an_output_that_has_not_every_letter_gets_escapes_that_json_knows(
    write: Write, monkeypatch: pytest.MonkeyPatch
) -> None:
    (write("nodes/none.py", "").parents[1] / "interfaces/zoo/msg").mkdir(parents=True)
    (write("configs/none.yaml", "").parents[1] / "interfaces/zoo/msg/Owl.msg").write_text("# né 🦉\n", "utf-8")
    monkeypatch.setenv("PYTHONIOENCODING", "ascii")  # as cp1252 behind a pipe on Windows
    code, out, err = outcome("interface", "show", "--json", "zoo/msg/Owl")
    assert (code, err) == (0, "")
    assert "né 🦉" in json.loads(out)["text"]
    assert outcome("interface", "show", "zoo/msg/Owl")[:2] == (0, "# n\\u00e9 \\ud83e\\udd89\n")


def test_an_error_writes_nothing_that_a_terminal_obeys(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["topic", "info", "/a\x1b[2J\u202e\x9b"]) == 1
    assert "/a\\x1b[2J\\u202e\\u009b" in capsys.readouterr().err


def test_an_error_about_a_huge_argument_is_not_huge(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["topic", "hz", "/a", "--window", "9" + 100_000 * "a"]) == 2
    line = capsys.readouterr().err
    assert len(line) < 2000
    assert line.endswith("(see 'robolink topic hz --help')\n")


@pytest.mark.processes
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no disk that is always full")
def test_a_full_disk_behind_standard_output_is_one_line_and_1() -> None:
    environ = {**os.environ, "PYTHONUNBUFFERED": ""}
    command = [sys.executable, "-m", "robolink", "launch", "--list"]
    with Path("/dev/full").open("wb") as full:
        ended = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, check=False, timeout=PATIENCE, env=environ)
    assert (ended.returncode, ended.stderr) == (1, b"robolink: [Errno 28] No space left on device\n")


def test_the_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("robolink 0.")


# --- bad input ------------------------------------------------------------------------------------------------

BAD: list[tuple[list[str], str]] = [
    (["run", "talkr"], "no node named 'talkr' in {home} or robolink itself (did you mean 'talker'?)"),
    (["run", "nodes/talkr.py"], "no file named 'nodes/talkr.py' (did you mean 'nodes/talker.py'?)"),
    (["run", "talker:Talkr"], "no class or function named 'Talkr' in {home}/nodes/talker.py (did you mean 'Talker'?)"),
    (["run", "broken"], "{home}/nodes/broken.py:2:"),
    (["run", "talker", "--workspace", "nowhere"], "no workspace folder named 'nowhere'"),
    (["run", "talker", "--name", "a/b"], "Failed to parse ROS arguments: '-r __node:=a/b': node name 'a/b' must not"),
    (["run", "talker", "-p", "x"], "Failed to parse ROS arguments: '-p x': expected name:=value"),
    (["run", "talker", "-p", "word:=1"], "Trying to set parameter 'word' to '1' of type 'INTEGER', expecting type"),
    (["run", "talker", "-r", "x"], "Failed to parse ROS arguments: '-r x': expected from:=to"),
    (["run", "talker", "--params-file", "no.yaml"], "Failed to parse ROS arguments: '--params-file no.yaml': no file"),
    (
        ["run", "talker", "--ros-args", "--pram", "x"],
        "unknown ROS arguments: ['--pram', 'x'] (did you mean",
    ),
    (["run", "world", "-p", "world:=emptyroom"], "no world named 'emptyroom' in {home} or robolink itself (did you"),
    (["launch", "laap"], "no launch file named 'laap' in {home} or robolink itself (did you mean 'lap'?)"),
    (["launch", "lap"], "{home}/configs/lap.yaml:1:16: nodes[0].node: no node named 'talkr' in {home} or robolink"),
    (["launch", "configs/no.yaml"], "no file named 'configs/no.yaml'"),
]


@pytest.mark.parametrize(("args", "report"), BAD, ids=[" ".join(each[0]) for each in BAD])
def test_bad_input_is_one_line_and_1(
    args: list[str],
    report: str,
    write: Write,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("ROBOLINK_TRANSPORT", "memory")
    monkeypatch.setattr("sys.argv", list(sys.argv))
    monkeypatch.setattr("sys.path", list(sys.path))
    write("nodes/talker.py", TALKER)
    write("nodes/broken.py", "x = 1\ndef f(:\n")
    write("configs/lap.yaml", "nodes: [{node: talkr}]")
    monkeypatch.setenv(VARIABLE, "")
    assert main(args) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("robolink: " + report.format(home=tmp_path.resolve()))
    assert err.count("\n") == 1


# --- launch ---------------------------------------------------------------------------------------------------


@pytest.mark.processes
def test_a_system_starts_talks_and_ends_after_its_duration(
    write: Write, domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Output(io.StringIO):
        def has(self, *lines: str) -> bool:
            return set(lines) <= set(self.getvalue().splitlines())

    out, said = Output(), ["[far/other] up /far/other hi", "[talker] up /talker yes"]
    # A machine may take longer than its duration for the start of a system: here no time passes before.
    timed = functools.partial(Supervisor, clock=lambda: 2.0 if out.has(*said) else 0.0)
    monkeypatch.setattr("robolink.launch.command.Supervisor", timed)
    monkeypatch.setattr("sys.stdout", out)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
    write("nodes/talker.py", TALKER)
    write(
        "configs/pair.yaml",
        "nodes:\n- node: talker\n  parameters: {word: yes}\n- node: talker\n  name: other\n  namespace: far\n",
    )
    assert main(["launch", "pair", "--duration", "2"]) == 0
    assert sorted(out.getvalue().splitlines()) == said


@pytest.mark.processes
@posix_only
def test_ctrl_c_ends_a_system_quietly(write: Write, domain: int) -> None:
    write("nodes/talker.py", TALKER)
    write("configs/pair.yaml", "nodes:\n- node: talker\n")
    with started("launch", "pair", domain=domain) as process:
        wait_for(process, "up")
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0
    assert (out, err) == ("[launch] stopping (Ctrl-C again to hurry)\n", "")


@pytest.mark.processes
@posix_only
def test_a_system_starts_where_all_standard_streams_are_closed(write: Write) -> None:
    program = "import os; os.fstat(0); print('said'); open('done', 'w').close()"
    path = write("configs/one.yaml", f'nodes:\n- {{run: [python, -c, "{program}"], name: a, interactive: true}}\n')
    command = [sys.executable, "-m", "robolink", "launch", "one"]
    closed = subprocess.run(["/bin/sh", "-c", '"$@" <&- >&- 2>&-', "sh", *command], check=False, timeout=PATIENCE)
    assert closed.returncode == 0
    assert (path.parents[1] / "done").exists()


@pytest.mark.processes
def test_a_node_that_fails_ends_the_system_with_its_code(write: Write, domain: int) -> None:
    write("nodes/talker.py", TALKER)
    write("nodes/bad.py", "import sys\nif __name__ == '__main__':\n    print('oh no')\n    sys.exit(9)\n")
    write("configs/pair.yaml", "nodes:\n- node: talker\n- node: bad\n")
    code, out, _ = outcome("launch", "pair", domain=domain)
    assert code == 9
    assert "[bad] oh no" in out.splitlines()
    assert "[launch] bad ended with exit code 9" in out.splitlines()
