"""The command `robolink simulate`: what it prints, its exit codes, what is told of wrong usage, and many seeds."""

from __future__ import annotations

import json
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.simulate.repeat import run_seeds
from tests.support.simulations import workspace

ROUGH = "messages:\n  - {topic: /chatter, loss: 0.2}\n"
UNLUCKY = '''
"""Fails when it draws a small number."""

import random

from robolink import Node


class Unlucky(Node):
    def __init__(self, **options):
        super().__init__("unlucky", **options)
        self.create_timer(0.1, self.tick)

    def tick(self):
        if (drawn := random.random()) < 0.02:
            raise ValueError(f"drew {drawn:.6f}")
'''

INTERRUPTER = '''
"""Does what Ctrl-C does."""

import _thread

from robolink import Node


class Interrupter(Node):
    def __init__(self, **options):
        super().__init__("interrupter", **options)
        self.create_timer(1.0, _thread.interrupt_main)
'''

PRINTER = '''
"""Prints something that is no line."""

from robolink import Node


class Printer(Node):
    def __init__(self, **options):
        super().__init__("printer", **options)
        print("no line", end="")
'''


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    workspace(
        tmp_path,
        fails="nodes:\n  - {node: talker, parameters: {fails_at: 21}}\n",
        fast="arguments: {count: -1}\nnodes:\n  - {node: talker, parameters: {fails_at: '{count}'}}\n",
        gambles="nodes:\n  - {node: unlucky}\n",
        interrupts="nodes:\n  - {node: interrupter}\n",
    )
    (tmp_path / "nodes" / "interrupter.py").write_text(INTERRUPTER)
    (tmp_path / "nodes" / "unlucky.py").write_text(UNLUCKY)
    (tmp_path / "configs" / "faults").mkdir()
    (tmp_path / "configs" / "faults" / "rough.yaml").write_text(ROUGH)
    monkeypatch.delenv("ROBOLINK_WORKSPACE", raising=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_summary_ends_with_the_hash(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "talk", "--duration", "3", "--faults", "rough", "--seed", "2"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("talk: 3 s in ")
    assert lines[0].endswith(" times as fast as life; seed 2")
    assert "  /chatter                 30" in lines
    assert any(line.startswith("fault {topic: /chatter, loss: 0.2}: ") and line.endswith(" of 30") for line in lines)
    assert len(lines[-1].removeprefix("hash ")) == 64


def test_json_is_one_object_on_the_last_line(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "talk", "--duration", "3", "--json"]) == 0
    out = capsys.readouterr().out
    result = json.loads(out.splitlines()[-1])
    assert result["messages"]["/chatter"] == 30
    assert (result["file"], result["seed"], result["failures"], len(result["hash"])) == ("talk", 0, [], 64)


def test_what_nodes_print_is_no_json(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "nodes" / "printer.py").write_text(PRINTER)
    (folder / "configs" / "prints.yaml").write_text("nodes:\n  - {node: printer}\n")
    assert main(["simulate", "prints", "--duration", "1", "--json"]) == 0
    out, err = capsys.readouterr()
    assert json.loads(out)["file"] == "prints"
    assert err == "no line"


@pytest.mark.processes
def test_two_processes_have_the_same_hash(folder: Path) -> None:
    runs = run_seeds(
        lambda seed: ["simulate", "talk", "--duration", "2", "--faults", "rough", "--json"], [1, 2], workers=2
    )
    hashes = [each.result.hash for each in runs if each.result is not None]
    assert len(hashes) == 2
    assert hashes[0] == hashes[1]


@pytest.mark.processes
def test_garbage_is_collected_once_nodes_are_made(folder: Path) -> None:
    (folder / "nodes" / "printer.py").write_text(
        PRINTER.replace('"no line", end=""', "gc.isenabled()").replace(
            "from robolink import Node", "import gc\n\nfrom robolink import Node"
        )
    )
    (folder / "configs" / "prints.yaml").write_text("nodes:\n  - {node: printer}\n")
    command = [sys.executable, "-m", "robolink", "simulate", "prints", "--duration", "0.1"]
    shown = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert shown.splitlines()[0] == "True"


def test_a_node_that_fails_is_told_and_the_exit_code_is_1(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "fails", "--duration", "3"]) == 1
    out, err = capsys.readouterr()
    assert "failed: talker ended with exit code 1 at 2.100 s: ZeroDivisionError: it was to fail" in out
    assert "ZeroDivisionError" in err


def test_arguments_and_parameters_are_given(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "fast", "count:=5", "--duration", "3"]) == 1
    assert "at 0.500 s" in capsys.readouterr().out
    assert main(["simulate", "fast", "count:=5", "--set", "talker.fails_at:=-1", "--duration", "3"]) == 0


@pytest.mark.parametrize(
    ("words", "told", "code"),
    [
        (["tolk"], " or robolink itself (did you mean 'talk'?)", 1),
        (["talk", "--faults", "ruogh"], "no faults file named 'ruogh' in ", 1),
        (["talk", "--set", "taker.x:=1"], "no node named 'taker' in the launch file (did you mean 'talker'?)", 1),
        (["talk", "--set", "talker.x"], "--set: expected NODE.PARAMETER:=VALUE, got 'talker.x' (see 'robolink ", 2),
        (["talk", "--set", "talker.x:=[1"], "--set talker.x:1:3: expected ',' or ']'", 1),
        (["talk", "--duration", "nan"], "'--duration': expected 0 to 1e+09 seconds, got nan", 2),
        (["talk", "--duration", "-1"], "'--duration': expected 0 to 1e+09 seconds, got -1", 2),
        (["talk", "--seed", "-1"], "Invalid value for '--seed': -1 is not in the range", 2),
        (["talk", "--fail-on", "contct"], "'contct' is none of contact, error, real-time (did you mean 'contact'?)", 2),
        (["count:=1"], "simulate what?", 2),
    ],
)
def test_wrong_usage_is_one_line(
    folder: Path, words: list[str], told: str, code: int, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["simulate", "--duration", "1", *words]) == code
    out, err = capsys.readouterr()
    assert out == ""
    assert told in err
    assert err.count("\n") == 1


def test_a_fault_on_an_unknown_node_is_told_with_its_place(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    faults = folder / "wrong.yaml"
    faults.write_text("crashes:\n  - {node: taker, at: 1}\n")
    assert main(["simulate", "talk", "--faults", str(faults)]) == 1
    assert capsys.readouterr().err == (
        f"robolink: {faults}:2:12: crashes[0].node: no node named 'taker' (did you mean 'talker'?)\n"
    )


def test_a_fault_on_an_unknown_topic_is_told_after_the_summary(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "wrong.yaml").write_text("messages:\n  - {topic: [/chatter, /chater], loss: 0.5}\n")
    assert main(["simulate", "talk", "--duration", "1", "--faults", "wrong.yaml"]) == 1
    told = "no topic '/chater' was received by any node (did you mean '/chatter'?)"
    assert f"failed: {{topic: [/chatter, /chater], loss: 0.5}} met something, but {told}" in capsys.readouterr().out


CAMERA = '''
"""Would declare its rate once it is configured."""

from robolink.lifecycle import LifecycleNode


class Camera(LifecycleNode):
    def __init__(self, **options):
        super().__init__("camera", **options)
'''


def test_a_parameter_that_no_node_declares_is_a_failure(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "nodes" / "camera.py").write_text(CAMERA)
    (folder / "configs" / "films.yaml").write_text("nodes: [{node: camera}, {node: talker, namespace: ada}]\n")
    assert main(["simulate", "films", "--duration", "1", "--set", "talker.fails_a:=3", "--set", "camera.rate:=3"]) == 1
    failed = [each for each in capsys.readouterr().out.splitlines() if each.startswith("failed: ")]
    expected = "parameter 'fails_a' was given to ada/talker, which has not declared it (did you mean 'fails_at'?)"
    assert failed == [f"failed: {expected}"]


@pytest.mark.processes
def test_a_seed_that_fails_is_told_and_fails_again_by_itself(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "gambles", "--duration", "2.00000001", "--repeat", "4", "--seed", "3"]) == 1
    *told, last = capsys.readouterr().out.splitlines()
    assert last == f"{4 - len(told) // 2} of 4 seeds passed"
    assert 0 < len(told) // 2 < 4
    line, replay = told[:2]
    words = shlex.split(replay)
    assert words[:4] == ["robolink", "simulate", "gambles", "--duration"]
    assert words[4] == "2.00000001"
    again = subprocess.run([sys.executable, "-m", *words], capture_output=True, text=True, timeout=60, check=False)
    assert again.returncode == 1
    assert f"failed: {line.partition(' failed: ')[2]}" in again.stdout


def test_ctrl_c_ends_a_run_with_the_summary_so_far(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "interrupts", "--duration", "1e9"]) == 130
    out = capsys.readouterr().out
    assert "warning: interrupted at " in out
    assert len(out.splitlines()[-1].removeprefix("hash ")) == 64


@pytest.mark.processes
def test_ctrl_c_ends_many_seeds_with_those_that_are_done() -> None:
    def interrupt(run: object) -> None:
        raise KeyboardInterrupt

    (run,) = run_seeds(lambda seed: ["simulate", "--json"], range(9), workers=1, on_done=interrupt)
    assert (run.seed, run.result) == (0, None)


@pytest.mark.processes
def test_many_seeds_as_json(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "talk", "--duration", "1", "--repeat", "2", "--json"]) == 0
    summary = json.loads(capsys.readouterr().out.splitlines()[-1])
    assert (summary["seeds"], summary["failed"], len(summary["hash"])) == (2, [], 64)
    assert [each["seed"] for each in summary["results"]] == [0, 1]


THREADS = ["OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"]
ENVIRONED = '''
"""Fails with what stands in its environment."""

import os

from robolink import Node


class Environed(Node):
    def __init__(self, **options):
        super().__init__("environed", **options)
        raise ValueError(" ".join(f"{name}={os.environ.get(name)}" for name in (THREADS)))
'''


@pytest.mark.processes
@pytest.mark.parametrize(("given", "threads"), [({}, "1111"), ({"OMP_NUM_THREADS": "3"}, "1131")])
@pytest.mark.parametrize("many", [[], ["--repeat", "1"]])
def test_algebra_has_one_thread_unless_somebody_says_more(
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    given: dict[str, str],
    threads: str,
    many: list[str],
) -> None:
    for name in (*THREADS, "PYTHONHASHSEED"):
        monkeypatch.delenv(name, raising=False)
    for name, value in given.items():
        monkeypatch.setenv(name, value)
    names = [*THREADS, "PYTHONHASHSEED"]
    (folder / "nodes" / "environed.py").write_text(ENVIRONED.replace("(THREADS)", repr(names)))
    (folder / "configs" / "environed.yaml").write_text("nodes:\n  - {node: environed}\n")
    assert main(["simulate", "environed", "--duration", "1", *many]) == 1
    expected = [*threads, "0" if many else "None"]
    assert " ".join(f"{name}={value}" for name, value in zip(names, expected, strict=True)) in capsys.readouterr().out


@pytest.mark.processes
def test_numpy_is_imported_after_its_threads_are_counted(folder: Path) -> None:
    code = (
        "import sys, robolink.cli.launching.simulate as command\n"
        "count = command._compute_in_one_thread\n"
        "def counted():\n    assert 'numpy' not in sys.modules; print('counted'); count()\n"
        "command._compute_in_one_thread = counted\n"
        "from robolink.cli.main import main; sys.exit(main(['simulate', 'talk', '--duration', '0.1']))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("counted\n")
