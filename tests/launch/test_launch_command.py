"""`robolink launch`: what is launched, with which arguments, what is shown instead, and what is asked of others."""

from __future__ import annotations

import json
import sys
import threading
from pathlib import Path
from typing import Any

import pytest

from robolink.cli.main import COMPLETION, main
from robolink.launch.lookup import find
from robolink.supervisor import Process
from robolink.workspace import VARIABLE
from tests.support.commands import Command
from tests.support.launched_systems import said

Captured = pytest.CaptureFixture[str]


# --- arguments ------------------------------------------------------------------------------------------------


def test_arguments_are_given_behind_the_file(home: Path, started: list[list[Process]], capsys: Captured) -> None:
    assert said(capsys, "talk", "loud:=a:=b", "word:=bye") == (7, "", "")
    [[process]] = started
    assert process.argv[-2:] == ["-p", 'word:="bye"']


BAD = [
    ((), 2, "launch what? --list shows what there is (see 'robolink launch --help')"),
    (("word:=bye",), 2, "launch what? --list shows what there is (see 'robolink launch --help')"),
    (("talk", ":=x"), 2, "an argument has a name, as in speed:=0.5, got ':=x' (see"),
    (("talk", "a", "b"), 2, "what is 'b'? an argument is given as NAME:=VALUE (see"),
    (("talk", "word=a=b"), 2, "what is 'word=a=b'? an argument is given as word:=a=b (see"),
    (("gazebo_ros", "gazebo.launch.py"), 1, "gazebo_ros gazebo.launch.py is not here: Gazebo, a simulator in C++; "),
    (("talk", "bye"), 1, "no package named 'talk' in the workspace (an argument is given as NAME:=VALUE)"),
    (("talk",), 1, "{home}/configs/talk.yaml:4:8: arguments.loud: 'loud' must be given: loud:=VALUE"),
    (("talk", "loud:=1", "wrd:=x"), 1, "{home}/configs/talk.yaml:3:3: arguments.wrd: no argument is called 'wrd'"),
    (("talk", "loud:=1", "word:=x"), 1, "{home}/configs/talk.yaml:3:9: arguments.word: 'word' is one of hello, bye"),
    (("tlk",), 1, "no launch file named 'tlk' in {home} or robolink itself (did you mean 'talk'?)"),
    (("talker",), 1, "'talker' is a node, and no launch file: robolink run talker"),
    (("robot.launch.py",), 1, "no launch file named 'robot.launch.py' in {home} or robolink itself"),
    (("stop", "a", "b", "c"), 2, "ask what? stop [NAME] [NODE] or restart [NAME] NODE, with the names that --status"),
    (("restart",), 2, "ask what? stop [NAME] [NODE] or restart [NAME] NODE, with the names that --status shows (see"),
    (("talk", "--graph=png"), 2, "Invalid value for '--graph': 'png' is none of mermaid, dot (see"),
    (("none", "--graph", "svg"), 2, "--graph draws mermaid or dot, not 'svg' (see"),
    (("--graph", "nne"), 1, "no launch file named 'nne' in {home} or robolink itself (did you mean 'none'?)"),
    (("none", "--duration", "nan"), 2, "Invalid value for '--duration': expected 0 to 1e+09 seconds, got nan"),
]


@pytest.mark.parametrize(("args", "code", "line"), BAD)
def test_what_is_wrong_is_one_line(home: Path, capsys: Captured, args: tuple[str, ...], code: int, line: str) -> None:
    found, out, err = said(capsys, *args)
    assert (found, out) == (code, "")
    assert err.startswith("robolink: " + line.format(home=home))
    assert err.count("\n") == 1


def test_arguments_are_shown(home: Path, capsys: Captured) -> None:
    shown = "word  What it says. (default: hello; one of hello, bye)\nloud  (must be given)\n"
    assert said(capsys, "talk", "--show-args") == said(capsys, "talk", "-s") == (0, shown, "")
    assert said(capsys, "none", "-s") == (0, "none has no arguments\n", "")
    assert json.loads(said(capsys, "talk", "-s", "--json")[1]) == [
        {"name": "word", "default": "hello", "description": "What it says.", "choices": ["hello", "bye"]},
        {"name": "loud", "default": None, "description": "", "choices": []},
    ]


def test_a_package_has_launch_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "src" / "my_robot"
    (package / "launch").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>my_robot</name></package>")
    (package / "setup.py").write_text("from setuptools import setup\nsetup(name='my_robot')\n")
    file = package / "launch" / "robot.launch.yaml"
    file.write_text("nodes: [node: world]")
    other = package / "launch" / "parts" / "other.launch.py"
    other.parent.mkdir()
    for each in (other, package / "launch" / "robot.launch.py", package / "launch" / "__init__.py"):
        each.write_text("")
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path)
    for name in ("robot", "robot.launch", "robot.launch.yaml"):
        assert find(["my_robot", name]).samefile(file)
    assert find(["my_robot", "robot.launch.py"]).samefile(package / "launch" / "robot.launch.py")
    assert find(["my_robot", "other"]).samefile(other)
    with pytest.raises(
        LookupError, match=r"no launch file named 'robt' in package my_robot, which has robot.launch.yaml"
    ):
        find(["my_robot", "robt"])


# --- launching ------------------------------------------------------------------------------------------------


def test_nodes_are_watched_and_measured(
    home: Path, monkeypatch: pytest.MonkeyPatch, started: list[list[Process]], capsys: Captured
) -> None:
    entered: list[tuple[str, Any]] = []

    def fake(kind: str) -> Any:
        class Fake:
            def __init__(self, what: Any, **settings: Any) -> None:
                self.what = what

            def __enter__(self) -> None:
                entered.append((kind, self.what))

            def __exit__(self, *_: object) -> None:
                entered.append((kind, "left"))

        return Fake

    monkeypatch.setattr("robolink.supervisor.monitoring.file_watch.Watch", fake("watch"))
    monkeypatch.setattr("robolink.supervisor.monitoring.resources.Figures", fake("figures"))
    assert said(capsys, "none", "--watch", "--top") == (7, "", "")
    assert entered[0] == ("watch", {"talker": [home / "nodes" / "talker.py"]})
    assert [each[0] for each in entered] == ["watch", "figures", "figures", "watch"]
    assert [each.rules.on_exit for [each] in started] == ["ignore"]


def test_a_core_that_is_not_there_is_told_before_anything_starts(home: Path, capsys: Captured) -> None:
    (home / "configs" / "none.yaml").write_text("nodes: [{node: talker, cpu: 4095}]")
    code, out, err = said(capsys, "none")
    assert (code, out) == (1, "")
    assert err.startswith(f"robolink: {home}/configs/none.yaml:1:29: nodes[0].cpu: core 4095 is not there")


def test_a_system_of_nothing_is_told_of(home: Path, started: list[list[Process]], capsys: Captured) -> None:
    (home / "configs" / "none.yaml").write_text("nodes: [{node: talker, if: false}]")
    line = f"robolink: {home}/configs/none.yaml: `if` and `unless` leave nothing to start\n"
    assert said(capsys, "none") == (0, "", line)
    assert started == []
    assert said(capsys, "none", "--graph") == (0, "flowchart LR\n", "")
    assert said(capsys, "none", "--validate")[0] == 0


@pytest.mark.processes
def test_what_waits_for_what_has_ended_ends_it(home: Path, domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    (home / "nodes" / "gone.py").write_text("print('gone')")
    (home / "configs" / "vain.yaml").write_text(
        "nodes: [{node: gone, on_exit: ignore}, {node: talker, start_after: gone}]"
    )
    with Command(domain, "launch", "vain", folder=home, merged=True) as launched:
        launched.wait_for("nothing runs any more, and talker waits for gone, which has ended")
        assert launched.end() == 1


@pytest.mark.processes
def test_a_node_that_waits_is_not_restarted(home: Path, capsys: Captured) -> None:
    program = f"run: ['{sys.executable}', -c, 'print(\"up\")'], on_exit: ignore"
    (home / "configs" / "none.yaml").write_text(
        f"nodes: [{{{program}, name: py}}, {{node: talker, start_after: {{topic: never}}}}]"
    )
    with Command(0, "launch", "none", folder=home, merged=True) as launched:
        launched.wait_for("up")
        why = "it is not started yet, since it waits for something else"
        line = f"robolink: 'talker' of 'none' is not restarted: {why}\n"
        assert said(capsys, "restart", "talker") == (1, "", line)
        launched.interrupt()
        assert launched.end() == 0


@pytest.mark.processes
def test_events_are_printed_one_a_line_and_nothing_else(home: Path, capsys: Captured) -> None:
    program = f"run: ['{sys.executable}', -c, 'print(\"a word\")']"
    (home / "configs" / "none.yaml").write_text(f"nodes:\n- {program}\n  name: py\n")
    code, out, err = said(capsys, "none", "--json")
    events = [json.loads(each) for each in out.splitlines()]
    assert (code, err) == (0, "")
    assert [each["event"] for each in events if each["event"] != "said"] == ["started", "output", "exited", "ended"]
    assert [each["line"] for each in events if each["event"] == "output"] == ["a word"]


@pytest.mark.processes
def test_what_waits_starts_when_what_it_waits_for_is_there(home: Path, domain: int) -> None:
    (home / "configs" / "late.yaml").write_text(
        """
nodes:
- {node: talker, name: last, start_after: {topic: heard/there}, parameters: {word: last}}
- {node: listener, namespace: heard, start_after: [talker], remappings: {chatter: /chatter}}
- {node: talker, start_after: other}
- {node: talker, name: other, namespace: /, remappings: {chatter: /heard/there}, parameters: {word: first}}
"""
    )
    with Command(domain, "launch", "late", folder=home) as launched:
        launched.wait_for("[other] up first")
        launched.wait_for("[heard/listener] listening")
        if "[last] up last" not in [each.text for each in launched.lines]:
            launched.wait_for("[last] up last")
        launched.interrupt()
        assert launched.end() == 0
    lines = [each.text for each in launched.lines]
    assert lines.index("[other] up first") < lines.index("[talker] up hi") < lines.index("[heard/listener] listening")
    assert "[last] up last" in lines
    assert launched.errors == []


@pytest.mark.processes
def test_a_launcher_that_holds_nothing_has_no_thread_for_it(home: Path, capsys: Captured) -> None:
    program = "import threading; print(threading.active_count())"
    (home / "configs" / "none.yaml").write_text(f"nodes: [run: ['{sys.executable}', -c, '{program}']]")
    names: list[str] = []
    seen = threading.Event()

    class Output:
        def write(self, text: str) -> None:
            names.extend(each.name for each in threading.enumerate())
            seen.set()

        def flush(self) -> None: ...

        def isatty(self) -> bool:
            return False

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "stdout", Output())
        assert main(["launch", "none"]) == 0
    assert seen.is_set()
    assert "launch readiness" not in names


# --- completion -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "offered"),
    [
        ("robolink launch ta", ["talk"]),
        ("robolink launch talk ", ["word:=", "loud:="]),
        ("robolink launch talk w", ["word:="]),
        ("robolink launch talk --graph m", ["mermaid"]),
        ("robolink launch nothing ", []),
    ],
)
def test_names_and_arguments_are_completed(
    home: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured, line: str, offered: list[str]
) -> None:
    for name, value in {COMPLETION: "complete_bash", "COMP_WORDS": line, "COMP_CWORD": str(line.count(" "))}.items():
        monkeypatch.setenv(name, value)
    main([])
    out, err = capsys.readouterr()
    assert sorted(out.split()) == sorted(offered)
    assert err == ""
