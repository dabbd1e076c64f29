"""A system that was launched in one shell is seen, restarted and stopped from another, and follows its files."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.launch.beside import files_of, roots_of, settings_of
from robolink.launch.command import doubled
from robolink.launch.planning import processes
from robolink.launch.reading.entries import read_launch_file
from robolink.supervisor import Supervisor
from robolink.supervisor.control.server import Control
from tests.support.commands import PATIENCE, Command
from tests.support.launchers import files_in, own_runtime_folder

pytestmark = pytest.mark.processes
posix_only = pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL is POSIX's")

PROGRAM = """
import signal
import sys
import time
import word

for each in (signal.SIGINT, signal.SIGTERM):
    signal.signal(each, lambda *_: sys.exit(0))
print(word.WORD, sys.argv[1], flush=True)
while True:
    time.sleep(0.1)
"""

SYSTEM = """
nodes:
  - {{name: one, run: ["{python}", "{program}", first]}}
  - {{name: two, run: ["{python}", "{program}", second]}}
"""


@pytest.fixture
def folder(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    with own_runtime_folder(monkeypatch) as made:
        monkeypatch.setenv("ROBOLINK_LOG_DIR", str(made / "log"))
        yield made


@pytest.fixture
def system(tmp_path: Path) -> Path:
    """A launch file with two programs that run until they are told to end."""
    program = tmp_path / "program.py"
    program.write_text(PROGRAM)
    (tmp_path / "word.py").write_text("WORD = 'hello'\n")
    path = tmp_path / "pair.yaml"
    path.write_text(SYSTEM.format(python=Path(sys.executable).as_posix(), program=program.as_posix()))
    return path


def launched(path: Path, *options: str) -> Command:
    command = Command(0, "launch", str(path), *options, merged=True)
    try:
        command.wait_for("hello")
        command.wait_for("hello")
    except BaseException:
        command.kill()
        raise
    return command


def test_a_system_is_asked_and_stopped_from_another_shell(
    folder: Path, system: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with launched(system) as command:
        assert main(["launch", "restart", "two"]) == 0
        command.wait_for("[two] hello second")
        capsys.readouterr()
        assert main(["launch", "--status", "--json"]) == 0
        (told,) = json.loads(capsys.readouterr().out)
        assert (told["launch"], told["pid"], told["file"]) == ("pair", command.process.pid, str(system.resolve()))
        found = [(each["name"], each["state"], each["restarts"]) for each in told["nodes"]]
        assert found == [("one", "running", 0), ("two", "running", 1)]
        assert main(["launch", "stop"]) == 0
        assert command.end() == 0
        assert command.left() == []
    assert [each for each in files_in(folder) if each.startswith("launch-")] == []


@posix_only
def test_a_launcher_that_was_killed_leaves_nothing_behind(folder: Path, system: Path) -> None:
    with launched(system) as command:
        assert [each for each in files_in(folder) if each.startswith("launch-")]
        command.kill()
        deadline = time.monotonic() + PATIENCE
        while command.left() and time.monotonic() < deadline:
            time.sleep(0.05)
    assert [each for each in files_in(folder) if each.startswith("launch-")] == []


ORDERLY = """
import pathlib
import time

try:
    print("hello", flush=True)
    while True:
        time.sleep(0.02)
except KeyboardInterrupt:
    pathlib.Path(__file__).with_suffix(".orderly").touch()
"""


@posix_only
def test_a_launcher_that_another_one_launched_ends_in_order_when_that_is_killed(folder: Path, tmp_path: Path) -> None:
    program = tmp_path / "program.py"
    program.write_text(ORDERLY)
    inner, outer = tmp_path / "inner.yaml", tmp_path / "outer.yaml"
    inner.write_text(f"nodes: [{{name: program, run: ['{sys.executable}', '{program}']}}]")
    outer.write_text(f"nodes: [{{name: inner, run: ['{sys.executable}', -m, robolink, launch, '{inner}']}}]")
    with Command(0, "launch", str(outer), merged=True) as command:
        command.wait_for("[inner] [program] hello")
        command.kill()
        deadline = time.monotonic() + PATIENCE
        while command.left() and time.monotonic() < deadline:
            time.sleep(0.05)
    assert program.with_suffix(".orderly").exists()


def test_a_saved_file_starts_what_imports_it_anew(folder: Path, system: Path) -> None:
    word = system.with_name("word.py")
    with launched(system, "--watch") as command:
        word.write_text("WORD = (\n")
        command.wait_for("word.py:1:")
        word.with_suffix(".new").write_text("WORD = 'mended'\n")
        word.with_suffix(".new").replace(word)
        command.wait_for("mended")
        command.wait_for("mended")
        os.utime(system)
        command.wait_for("pair.yaml has changed: that counts when the system is started anew")
        command.interrupt()
        assert command.end() == 0


def test_figures_come_between_the_output(folder: Path, system: Path) -> None:
    with launched(system, "--top") as command:
        line = command.wait_for(" of a core, ")
        assert line.text.startswith("[launch] ")
        assert "one " in line.text
        assert "two " in line.text
        command.interrupt()
        assert command.end() == 0


def test_what_a_system_is_made_of(tmp_path: Path) -> None:
    texts = {
        "nodes/talker.py": "from robolink import Node\nclass Talker(Node): ...\n",
        "configs/all.yaml": "include: [{file: part.yaml}]\n",
        "configs/part.yaml": (
            "groups:\n- parameters: shared.yaml\n  nodes:\n"
            "  - {node: talker, parameters: own.yaml}\n"
            "  - {node: talker, name: second, process: p}\n"
            "  - {node: talker, name: third, process: p}\n"
        ),
        "configs/shared.yaml": "/**:\n  ros__parameters: {speed: 1.0}\n",
        "configs/own.yaml": "/**:\n  ros__parameters: {size: 1.0}\n",
        "src/pack/package.xml": "<package><name>pack</name></package>",
        "src/pack/pack/__init__.py": "",
    }
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    found = processes(read_launch_file(tmp_path / "configs/all.yaml"))
    talker = tmp_path / "nodes/talker.py"
    assert files_of(found) == {"talker": [talker], "p": [talker, talker]}
    assert roots_of(found) == [tmp_path / "src/pack"]
    assert sorted(each.name for each in settings_of(found)) == ["all.yaml", "own.yaml", "part.yaml", "shared.yaml"]


def test_a_second_launch_of_the_same_nodes_is_told_of_the_first(folder: Path) -> None:
    nodes = ["/a", "/b", "/c", "/d"]
    with Control(Supervisor([]), name="first", nodes=nodes, domain=7):
        (line,) = doubled(["/x", "/a", "/c", "/d"], 7)
        assert line.startswith(f"first (pid {os.getpid()}) has nodes of the same names, /a and /c and 1 more: both are")
        assert list(doubled(nodes, 8)) == list(doubled(["/x"], 7)) == []
    assert list(doubled(nodes, 7)) == []
