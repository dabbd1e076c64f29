"""robolink launch in place of a launch: validate, draw and list, and ask launchers that run."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest

from robolink.cli.launching import launch as cli
from robolink.cli.launching import launchers
from robolink.cli.main import main
from robolink.supervisor import Process
from tests.support.launched_systems import said

Captured = pytest.CaptureFixture[str]


@pytest.mark.processes
def test_a_launch_file_is_validated(home: Path, capsys: Captured) -> None:
    file = home / "configs" / "none.yaml"
    assert said(capsys, "none", "--validate") == (0, f"no mistake found in {file}\n", "")
    assert json.loads(said(capsys, "none", "--validate", "--json")[1]) == {"mistakes": [], "notes": []}
    file.write_text(f"nodes:\n- {{node: talker, parameters: {{wrd: x}}}}\n- run: ['{sys.executable}']\n  name: py\n")
    line = f"{file}:2:31: nodes[0].parameters.wrd: 'talker' declares no parameter 'wrd' (did you mean 'word'?)\n"
    assert said(capsys, "none", "--validate") == (1, line, "robolink: py was not looked into: it is a command\n")
    code, out, err = said(capsys, "none", "--validate", "--json")
    [mistake] = json.loads(out)["mistakes"]
    assert (code, err) == (1, "")
    assert (mistake["file"], mistake["line"], mistake["column"]) == (str(file), 2, 31)


def test_a_launch_file_that_cannot_be_read_has_a_mistake(home: Path, capsys: Captured) -> None:
    (home / "configs" / "none.yaml").write_text("nods: []")
    code, out, err = said(capsys, "none", "--validate")
    assert (code, err) == (1, "robolink: no node was looked into: that comes when its file is right\n")
    assert out.startswith(f"{home}/configs/none.yaml:1:1: nods: unknown key 'nods'")
    assert json.loads(said(capsys, "none", "--validate", "--json")[1])["mistakes"][0]["line"] == 1


@pytest.mark.processes
def test_a_system_is_drawn(home: Path, capsys: Captured) -> None:
    (home / "configs" / "none.yaml").write_text(f"nodes: [node: talker, run: ['{sys.executable}'], node: gone.py]")
    (home / "configs" / "none.yaml").write_text("nodes: [node: talker, node: gone.py]")
    (home / "gone.py").write_text("raise ValueError('no')")
    code, out, err = said(capsys, "none", "--graph")
    assert code == 0
    assert err.startswith("robolink: gone is drawn as far as it was made: ValueError: no (at")
    assert out == (
        "flowchart LR\n"
        '    n0["/talker"]\n'
        '    n1["/gone"]\n'
        '    p0(["/chatter<br/>std_msgs/msg/String"])\n'
        "    n0 --> p0\n"
    )
    assert said(capsys, "none", "--graph", "dot")[1].startswith("digraph system {\n")


@pytest.mark.parametrize(
    ("args", "spelled"),
    [
        (["a", "--graph"], ["a", "--graph=mermaid"]),
        (["--graph", "a"], ["--graph=mermaid", "a"]),
        (["--graph", "dot", "a"], ["--graph", "dot", "a"]),
        (["--graph=dot", "a"], ["--graph=dot", "a"]),
        ([], []),
    ],
)
def test_the_format_of_a_graph_may_be_left_out(args: list[str], spelled: list[str]) -> None:
    assert cli.spelled_out(args) == spelled


ASKED = [
    (("--status",), ("status", "", False)),
    (("--status", "talk", "--json"), ("status", "talk", True)),
    (("--top",), ("top", "", False)),
    (("--status", "--top", "talk", "--json"), ("top", "talk", True)),
    (("stop",), ("stop",)),
    (("stop", "talk"), ("stop", "talk")),
    (("stop", "talk", "talker"), ("stop_one", "talker", "talk")),
    (("restart", "r0/talker"), ("restart", "r0/talker")),
    (("restart", "talk", "talker"), ("restart", "talker", "talk")),
]


@pytest.mark.parametrize(("args", "call"), ASKED)
def test_what_runs_elsewhere_is_asked(monkeypatch: pytest.MonkeyPatch, args: tuple[str, ...], call: Any) -> None:
    calls: list[tuple[Any, ...]] = []
    for name in ("status", "top", "stop", "stop_one", "restart"):

        def note(*words: str, name: str = name, **named: bool) -> None:
            calls.append((name, *words, *named.values()))

        monkeypatch.setattr(launchers, name, note)
    assert main(["launch", *args]) == 0
    assert calls == [call]


def test_a_launch_file_may_be_called_stop(home: Path, started: list[list[Process]], capsys: Captured) -> None:
    (home / "configs" / "stop.yaml").write_text("nodes: [node: talker]")
    assert said(capsys, "configs/stop.yaml")[0] == 7
    assert len(started) == 1


@pytest.mark.parametrize(
    ("args", "folder"),
    [
        ("talk --record", cli.BY_DATE),
        ("talk --record lap", "lap"),
        ("--record talk", cli.BY_DATE),
        ("--duration 5 --record talk", cli.BY_DATE),
        ("talk --duration 5 --record lap --top", "lap"),
        ("talk --record word:=x", cli.BY_DATE),
        ("talk --record --top", cli.BY_DATE),
        ("talk --record=lap", "lap"),
    ],
)
def test_the_folder_of_a_record_may_be_left_out(args: str, folder: str) -> None:
    words = cli.with_folder(args.split())
    index = next(index for index, each in enumerate(words) if each.startswith("--record"))
    assert (words[index].partition("=")[2] or words[index + 1]) == folder
    given = [each for each in args.split() if each not in ("--record", "--record=lap", "lap")]
    assert [each for each in words if not each.startswith("--record") and each != "lap"] == given
