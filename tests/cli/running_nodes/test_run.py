"""robolink run: node classes and scripts, their arguments, exit codes and errors."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.cli.running_nodes.run import ros_flags
from tests.support.started import PATIENCE, TALKER, Write, outcome, posix_only, started, wait_for


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


@pytest.mark.processes
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


ASYNC_TALKER = """
import asyncio
from rclpy.experimental import AsyncNode

class Talker(AsyncNode):
    def __init__(self):
        super().__init__("talker")
        self.word = self.declare_parameter("word", "hi").value
        self.create_timer(0.001, self.tick)

    async def tick(self):
        await asyncio.sleep(0)
        print("up", self.get_fully_qualified_name(), 1 / len(self.word), flush=True)
        await asyncio.Event().wait()
"""


@pytest.mark.processes
@posix_only
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_asynchronous_node_class_runs_until_it_is_interrupted(write: Write, number: int) -> None:
    write("nodes/talker.py", ASYNC_TALKER)
    with started("run", "talker", "--namespace", "robot", "-p", "word:=ho") as process:
        assert wait_for(process, "up") == "up /robot/talker 0.5"
        process.send_signal(number)
        assert process.communicate(timeout=PATIENCE) == ("", "")
        assert process.returncode == 0


@pytest.mark.processes
def test_what_a_callback_of_an_asynchronous_node_class_raises_is_shown_alone(write: Write) -> None:
    write("nodes/talker.py", ASYNC_TALKER)
    code, out, err = outcome("run", "talker", "-p", "word:=''")
    assert (code, out) == (1, "")
    assert err.splitlines()[-1] == "ZeroDivisionError: division by zero"
    assert "Group" not in err


@pytest.mark.processes
def test_a_script_gets_its_own_arguments_and_gives_its_exit_code(write: Write) -> None:
    script = write("say.py", "import sys\ndef main():\n    print(sys.argv[1:], flush=True)\n    return 7\n")
    code, out, err = outcome("run", f"{script}:main", "one", "--", "--two", "-p", "--ros-args", "-r", "a:=b")
    assert (code, err) == (7, "")
    assert out == "['one', '--two', '-p', '--ros-args', '-r', 'a:=b']\n"


@pytest.mark.processes
@posix_only
def test_words_that_do_nothing_are_told_of(write: Write) -> None:
    write("nodes/talker.py", TALKER)
    with started("run", "talker", "word:=ho", "my_world.wbt") as process:
        assert wait_for(process, "up") == "up /talker hi"
        process.send_signal(signal.SIGINT)
        first, second = process.communicate(timeout=PATIENCE)[1].splitlines()
    assert first == "robolink: 'word:=ho' does nothing without an option: -p word:=ho sets a parameter, -r renames"
    assert second.startswith("robolink: nobody reads 'my_world.wbt': ")


@pytest.mark.processes
@pytest.mark.parametrize(
    ("end", "code", "said"), [("sys.exit(3)", 3, ""), ("sys.exit('sorry')", 1, "sorry\n"), ("sys.exit()", 0, "")]
)
def test_a_script_may_exit_by_itself(write: Write, end: str, code: int, said: str) -> None:
    script = write("say.py", f"import sys\nif __name__ == '__main__':\n    {end}\n")
    assert outcome("run", str(script)) == (code, "", said)


@pytest.mark.processes
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


@pytest.mark.processes
def test_an_error_in_the_users_code_is_shown_from_there_on(write: Write) -> None:
    tick = "    def tick(self):\n        {}['x']\n"
    path = write("nodes/talker.py", TALKER + "        self.create_timer(0.01, self.tick)\n" + tick)
    code, _, err = outcome("run", "talker")
    assert code == 1
    lines = err.splitlines()
    assert lines[0] == "Traceback (most recent call last):"
    assert lines[1].startswith(f'  File "{path.resolve()}", line')
    assert lines[-1] == "KeyError: 'x'"
    assert "/robolink/" not in err
    assert err.count("Traceback") == 1


@pytest.mark.processes
@pytest.mark.parametrize("where", ["        self.named()\n", "        self.create_timer(0.01, self.named)\n"])
def test_a_misspelt_name_is_told_with_the_nearest(write: Write, where: str) -> None:
    write("nodes/talker.py", TALKER + where + "    def named(self):\n        speed = 1\n        return sped\n")
    code, _, err = outcome("run", "talker")
    assert code == 1
    assert err.splitlines()[-1] == "NameError: name 'sped' is not defined. Did you mean: 'speed'?"


@pytest.mark.processes
def test_what_the_users_code_asked_for_in_vain_is_told_with_its_line(write: Write) -> None:
    path = write("nodes/talker.py", TALKER + "        self.resolve_topic_name('a b')\n")
    line = path.read_text().count("\n")
    code, _, err = outcome("run", "talker")
    assert (code, err.count("\n")) == (1, 1)
    assert err.startswith("robolink: invalid topic name 'a b': must not contain")
    assert err.endswith(f"(at {path.resolve()}:{line})\n")


@pytest.mark.processes
def test_what_a_callback_asked_for_in_vain_is_told_once(write: Write) -> None:
    tick = "    def tick(self):\n        self.resolve_topic_name('a b')\n"
    write("nodes/talker.py", TALKER + "        self.create_timer(0.01, self.tick)\n" + tick)
    code, _, err = outcome("run", "talker")
    assert code == 1
    assert (err.count("\n"), err.count("robolink: invalid topic name")) == (1, 1)


@pytest.mark.processes
def test_a_node_that_forgets_its_base_class_is_told_so(write: Write) -> None:
    path = write("nodes/bare.py", "from robolink import Node\nclass Bare(Node):\n    def __init__(self): pass\n")
    code, out, err = outcome("run", str(path))
    assert (code, out) == (1, "")
    assert err == "robolink: Bare.__init__ must call super().__init__('bare') before all else\n"


@pytest.mark.processes
def test_a_main_that_wants_arguments_is_told_so(write: Write) -> None:
    path = write("nodes/bare.py", "def main(args): pass\n")
    code, out, err = outcome("run", str(path))
    assert (code, out) == (1, "")
    assert err == "robolink: main() needs 'args': give a default value, as in main(args=None)\n"


@pytest.mark.processes
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


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["run", "other.py"], "no node named 'other.py' in {here}"),
        (["run", "text.py"], "no node named 'text.py' in {here} (did you mean 'text.py.txt'?)"),
        (["run", "wide.py"], "{here}/wide.py is in UTF-16: save it in UTF-8"),
        (["run", "carefull.py"], "no node named 'carefull.py' (did you mean 'careful.py'?)"),
        (
            ["run", "careful.py"],
            "Careful has no __init__ of its own: _init_ is to be __init__, with two _ on each side",
        ),
        (["run", "nameless.py"], "Nameless has no __init__ of its own, which gives the node its name"),
        (["run", "hall.yaml"], "'hall.yaml' is a world, and no node: robolink run world -p world:=hall.yaml"),
        (["run", "lap.yaml"], "'lap.yaml' is a launch file, and no node: robolink launch lap.yaml"),
        (
            ["launch", "hall.yaml"],
            (
                "{here}/hall.yaml:1:1: world: unknown key 'world' in a launch file: is this a world? "
                "robolink run world -p world:=FILE shows one"
            ),
        ),
    ],
)
def test_mistakes_of_a_first_day_are_told_with_what_to_do(
    words: list[str], told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    head = "from robolink import Node\n\n\n"
    (tmp_path / "careful.py").write_text(f"{head}class Careful(Node):\n    def _init_(self):\n        pass\n")
    (tmp_path / "nameless.py").write_text(f"{head}class Nameless(Node):\n    pass\n")
    (tmp_path / "text.py.txt").write_text(head)
    (tmp_path / "wide.py").write_text(head, encoding="utf-16")
    (tmp_path / "hall.yaml").write_text("world: {name: hall, size: [2, 2]}\nrobots: []\n")
    (tmp_path / "lap.yaml").write_text("nodes: []\n")
    monkeypatch.chdir(tmp_path)
    assert main(words) == 1
    assert capsys.readouterr().err.splitlines()[0] == f"robolink: {told.format(here=tmp_path)}"
