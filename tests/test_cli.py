"""The command line: what starts, what ends it, and that every mistake is one line on stderr."""

from __future__ import annotations

import functools
import io
import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from robolink.cli import main
from robolink.cli.root import COMMANDS
from robolink.cli.run import ros_flags
from robolink.supervisor import Supervisor
from robolink.workspace import VARIABLE

posix_only = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals to send")
Write = Callable[[str, str], Path]
PATIENCE = 30.0

TALKER = """
from robolink import Node

class Talker(Node):
    '''Says what it is.'''
    def __init__(self):
        super().__init__("talker")
        word = self.declare_parameter("word", "hi").value
        print("up", self.get_fully_qualified_name(), word, flush=True)
"""


@pytest.fixture
def write(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Write:
    """Write a file of a workspace that is the working directory."""
    for folder in ("nodes", "configs"):
        (tmp_path / folder).mkdir()
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv(VARIABLE, raising=False)

    def write(name: str, text: str) -> Path:
        (tmp_path / name).write_text(text)
        return tmp_path / name

    return write


@contextmanager
def started(*args: str, domain: int = 0) -> Iterator[subprocess.Popen[str]]:
    """Run a command in a process of its own."""
    transport = {"ROS_DOMAIN_ID": str(domain)} if domain else {"ROBOLINK_TRANSPORT": "memory"}
    with subprocess.Popen(
        [sys.executable, "-m", "robolink", *args],
        env={**os.environ, **transport, "PYTHONUNBUFFERED": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def outcome(*args: str, domain: int = 0) -> tuple[int, str, str]:
    with started(*args, domain=domain) as process:
        out, err = process.communicate(timeout=PATIENCE)
        return process.returncode, out, err


def wait_for(process: subprocess.Popen[str], text: str) -> str:
    assert process.stdout is not None
    for line in process.stdout:
        if text in line:
            return line.strip()
    raise AssertionError(f"the process ended without '{text}': {process.communicate()[1]}")


# --- help and wrong usage -------------------------------------------------------------------------------------


def test_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    shown = capsys.readouterr().out
    listed = {name: entry for name, entry in COMMANDS.items() if not entry.hidden}
    assert all(f"\n  {name} " in shown and entry.help in shown for name, entry in listed.items())
    assert "wtf" not in shown


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([command, "--help"]) == 0
    assert f"Usage: robolink {command}" in capsys.readouterr().out


def test_help_imports_nothing_heavy() -> None:
    code = "import sys; from robolink.cli import main; main(['--help']); print(*sys.modules)"
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    loaded = set(shown.splitlines()[-1].split())
    assert "typer" in loaded
    assert not loaded & {"numpy", "zenoh", "msgspec", "yaml", "rich", "pymunk", "asyncio", "importlib.metadata"}


@pytest.mark.parametrize(
    ("args", "report"),
    [
        (["lunch"], "no command named 'lunch' (did you mean 'launch'?) (see 'robolink --help')"),
        (["run"], "which node? --list shows them (see 'robolink run --help')"),
        (["launch"], "launch what? --list shows what there is (see 'robolink launch --help')"),
        (["run", "world", "--nam", "x"], "No such option: --nam"),
        (["run", "world", "--name"], "Option '--name' requires an argument"),
        (["launch", "x", "--duration", "long"], "Invalid value for '--duration': 'long' is not a valid float"),
        (["launch", "x", "--duration", "-1"], "Invalid value for '--duration': expected 0 to 1e+09 seconds, got -1"),
        (["topic", "lst"], "No such command 'lst'. Did you mean 'list'? (see 'robolink topic --help')"),
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


def test_a_network_is_asked_for_before_the_command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ROBOLINK_NETWORK", "localhost")
    assert main(["--network", "nowhere", "topic", "list"]) == 1
    assert "no network or file 'nowhere'" in capsys.readouterr().err
    assert main(["--network", "off", "topic", "list"]) == 0
    assert capsys.readouterr() == ("", "")


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


# --- run ------------------------------------------------------------------------------------------------------


def test_options_are_spelled_as_ros_arguments() -> None:
    assert ros_flags("", "", [], [], []) == []
    assert ros_flags("a", "b", ["x:=1"], ["s:=t", "u:=v"], ["f.yaml"]) == [
        *("--ros-args", "-r", "__node:=a", "-r", "__ns:=/b", "-r", "s:=t", "-r", "u:=v"),
        *("--params-file", "f.yaml", "-p", "x:=1"),
    ]


def test_the_list_shows_names_and_purposes(write: Write, capsys: pytest.CaptureFixture[str]) -> None:
    write("nodes/talker.py", '"""Talk for ever.\n\nMore."""\n' + TALKER)
    write("nodes/broken.py", "def f(:\n")
    assert main(["run", "--list"]) == 0
    lines = [line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines()]
    assert ["talker", "Talk for ever."] in lines
    assert ["broken", "(cannot be read)"] in lines


def test_launch_files_are_listed(write: Write, capsys: pytest.CaptureFixture[str]) -> None:
    write("configs/lap.yaml", "nodes: []")
    assert main(["launch", "--list"]) == 0
    assert "lap" in capsys.readouterr().out.splitlines()


@posix_only
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_node_class_runs_until_it_is_interrupted(write: Write, number: int) -> None:
    write("nodes/talker.py", TALKER)
    options = ["--name", "t", "--namespace", "robot", "-p", "word:=ho", "--ros-args", "-p", "word:=hey"]
    with started("run", "talker", *options) as process:
        assert wait_for(process, "up") == "up /robot/t hey"
        process.send_signal(number)
        assert process.communicate(timeout=PATIENCE) == ("", "")
        assert process.returncode == 0


def test_a_script_gets_its_own_arguments_and_gives_its_exit_code(write: Write) -> None:
    script = write("say.py", "import sys\ndef main():\n    print(sys.argv[1:], flush=True)\n    return 7\n")
    code, out, err = outcome("run", f"{script}:main", "one", "--", "--two", "-p", "--ros-args", "-r", "a:=b")
    assert (code, err) == (7, "")
    assert out == "['one', '--two', '-p', '--ros-args', '-r', 'a:=b']\n"


@posix_only
def test_words_that_do_nothing_are_told_of(write: Write) -> None:
    write("nodes/talker.py", TALKER)
    with started("run", "talker", "word:=ho", "my_world.wbt") as process:
        assert wait_for(process, "up") == "up /talker hi"
        process.send_signal(signal.SIGINT)
        first, second = process.communicate(timeout=PATIENCE)[1].splitlines()
    assert first == "robolink: 'word:=ho' does nothing without an option: -p word:=ho sets a parameter, -r renames"
    assert second.startswith("robolink: nobody reads 'my_world.wbt': ")


@pytest.mark.parametrize(
    ("end", "code", "said"), [("sys.exit(3)", 3, ""), ("sys.exit('sorry')", 1, "sorry\n"), ("sys.exit()", 0, "")]
)
def test_a_script_may_exit_by_itself(write: Write, end: str, code: int, said: str) -> None:
    script = write("say.py", f"import sys\nif __name__ == '__main__':\n    {end}\n")
    assert outcome("run", str(script)) == (code, "", said)


@posix_only
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_script_that_lets_the_interrupt_pass_ends_quietly(write: Write, number: int, code: int) -> None:
    script = write("say.py", TALKER + "import robolink\nrobolink.init()\nrobolink.spin(Talker())\n" + GUARD)
    with started("run", str(script)) as process:
        wait_for(process, "up")
        process.send_signal(number)
        assert process.communicate(timeout=PATIENCE) == ("", "")
        assert process.returncode == code


GUARD = "if __name__ == '__main__': pass\n"


def test_an_error_in_the_users_code_is_shown_from_there_on(write: Write) -> None:
    tick = "    def tick(self):\n        {}['x']\n"
    path = write("nodes/talker.py", TALKER + "        self.create_timer(0.01, self.tick)\n" + tick)
    code, _, err = outcome("run", "talker")
    assert code == 1
    lines = err.splitlines()
    assert lines[0].endswith("[talker]: an exception in a callback ends the spinning:")
    assert lines[1] == "Traceback (most recent call last):"
    assert lines[2].startswith(f'  File "{path.resolve()}", line')
    assert lines[-1] == "KeyError: 'x'"
    assert "/robolink/" not in err
    assert err.count("Traceback") == 1


@pytest.mark.parametrize("where", ["        self.named()\n", "        self.create_timer(0.01, self.named)\n"])
def test_a_misspelt_name_is_told_with_the_nearest(write: Write, where: str) -> None:
    write("nodes/talker.py", TALKER + where + "    def named(self):\n        speed = 1\n        return sped\n")
    code, _, err = outcome("run", "talker")
    assert code == 1
    assert err.splitlines()[-1] == "NameError: name 'sped' is not defined. Did you mean: 'speed'?"


def test_what_the_users_code_asked_for_in_vain_is_told_with_its_line(write: Write) -> None:
    path = write("nodes/talker.py", TALKER + "        self.resolve_topic_name('a b')\n")
    line = path.read_text().count("\n")
    code, _, err = outcome("run", "talker")
    assert (code, err.count("\n")) == (1, 1)
    assert err.startswith("robolink: invalid topic name 'a b': must not contain")
    assert err.endswith(f"(at {path.resolve()}:{line})\n")


def test_what_a_callback_asked_for_in_vain_is_told_once(write: Write) -> None:
    tick = "    def tick(self):\n        self.resolve_topic_name('a b')\n"
    write("nodes/talker.py", TALKER + "        self.create_timer(0.01, self.tick)\n" + tick)
    code, _, err = outcome("run", "talker")
    assert code == 1
    assert "[talker]: an exception in a callback ends the spinning:" in err.splitlines()[0]
    assert "robolink: invalid" not in err


def test_a_node_that_forgets_its_base_class_is_told_so(write: Write) -> None:
    path = write("nodes/bare.py", "from robolink import Node\nclass Bare(Node):\n    def __init__(self): pass\n")
    code, out, err = outcome("run", str(path))
    assert (code, out) == (1, "")
    assert err == "robolink: Bare.__init__ must call super().__init__('bare') before all else\n"


def test_a_main_that_wants_arguments_is_told_so(write: Write) -> None:
    path = write("nodes/bare.py", "def main(args): pass\n")
    code, out, err = outcome("run", str(path))
    assert (code, out) == (1, "")
    assert err == "robolink: main() needs 'args': give a default value, as in main(args=None)\n"


@posix_only
def test_a_signal_in_a_slow_callback_is_no_fault_of_it(write: Write) -> None:
    # Python itself may notice a signal late that comes just before a long sleep: hence many short ones.
    tick = "    def tick(self):\n        import time; print('tick', flush=True)\n        while 1: time.sleep(0.02)\n"
    write("nodes/talker.py", TALKER + "        self.create_timer(0.01, self.tick)\n" + tick)
    for number in (signal.SIGINT, signal.SIGTERM):
        with started("run", "talker") as process:
            wait_for(process, "tick")
            process.send_signal(number)
            assert process.communicate(timeout=PATIENCE) == ("", "")
            assert process.returncode == 0


# --- launch ---------------------------------------------------------------------------------------------------


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


@posix_only
def test_a_system_starts_where_all_standard_streams_are_closed(write: Write) -> None:
    program = "import os; os.fstat(0); print('said'); open('done', 'w').close()"
    path = write("configs/one.yaml", f'nodes:\n- {{run: [python, -c, "{program}"], name: a, interactive: true}}\n')
    command = [sys.executable, "-m", "robolink", "launch", "one"]
    closed = subprocess.run(["/bin/sh", "-c", '"$@" <&- >&- 2>&-', "sh", *command], check=False, timeout=PATIENCE)
    assert closed.returncode == 0
    assert (path.parents[1] / "done").exists()


def test_a_node_that_fails_ends_the_system_with_its_code(write: Write, domain: int) -> None:
    write("nodes/talker.py", TALKER)
    write("nodes/bad.py", "import sys\nif __name__ == '__main__':\n    print('oh no')\n    sys.exit(9)\n")
    write("configs/pair.yaml", "nodes:\n- node: talker\n- node: bad\n")
    code, out, _ = outcome("launch", "pair", domain=domain)
    assert code == 9
    assert "[bad] oh no" in out.splitlines()
    assert "[launch] bad ended with exit code 9" in out.splitlines()
