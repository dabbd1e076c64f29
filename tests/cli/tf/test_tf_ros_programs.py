"""tf2_echo, tf2_monitor and view_frames: the arguments of ROS 2's programs, and what they write."""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

import pytest

from robolink import Node
from robolink.cli.tf import ros_programs, watch
from robolink.exceptions import RobolinkError
from robolink.tf2 import StaticTransformBroadcaster
from tests.support.seen_by_commands import press_ctrl_c, when_said
from tests.support.transforms import transform

Captured = pytest.CaptureFixture[str]


@pytest.fixture
def words(monkeypatch: pytest.MonkeyPatch, node: Node) -> list[str]:
    """The command line after the program's name; and there is a transform."""
    StaticTransformBroadcaster(node).sendTransform(transform("map", "base", 0, (1, 2, 0)))
    argv = ["program"]
    monkeypatch.setattr(sys, "argv", argv)
    return argv


def test_tf2_echo_takes_two_frames_and_a_rate(
    words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    words += ["map", "base", "20", "--ros-args", "-p", "use_sim_time:=true"]
    when_said(monkeypatch, watch, "say", press_ctrl_c)
    with pytest.raises(KeyboardInterrupt):
        ros_programs.tf2_echo()
    assert "- Translation: [1.000, 2.000, 0.000]" in capsys.readouterr().out


def test_tf2_monitor_shows_a_chain(words: list[str], monkeypatch: pytest.MonkeyPatch, capsys: Captured) -> None:
    words += ["map", "base"]
    when_said(monkeypatch, watch, "say", press_ctrl_c)
    with pytest.raises(KeyboardInterrupt):
        ros_programs.tf2_monitor()
    assert capsys.readouterr().out == "Gathering data on map -> base for 10 seconds...\n"


def test_a_reader_that_has_enough_ends_them_quietly(words: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    def break_pipe(text: str) -> None:
        raise BrokenPipeError

    words += ["map", "base"]
    for module, program in ((watch, ros_programs.tf2_echo), (watch, ros_programs.tf2_monitor)):
        when_said(monkeypatch, module, "say", break_pipe)
        program()


def test_view_frames_writes_a_graph(
    words: list[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: Captured
) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: None)
    monkeypatch.chdir(tmp_path)
    words += ["-t", "0.2"]
    ros_programs.view_frames()
    (file,) = tmp_path.iterdir()
    assert re.fullmatch(r"frames_\d{4}-\d\d-\d\d_\d\d\.\d\d\.\d\d\.gv", file.name)
    assert '"map" -> "base"[label="Broadcaster: /lab/robot' in file.read_text()
    said = capsys.readouterr().out.splitlines()
    assert said == [
        "Listening to tf data for 0.2 seconds...",
        f"{file.name} has the graph; a PDF needs Graphviz: dot -Tpdf {file.name} -o {file.stem}.pdf",
    ]


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="the stand-in for Graphviz is a shell script")
def test_view_frames_draws_where_graphviz_is(
    words: list[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: Captured
) -> None:
    dot = tmp_path / "dot"
    dot.write_text('#!/bin/sh\ncp "$2" "$4"\n')
    dot.chmod(0o755)
    monkeypatch.setattr(shutil, "which", lambda name: str(dot))
    monkeypatch.chdir(tmp_path)
    words += ["--wait-time=0.2", "-o", "mine.pdf"]
    ros_programs.view_frames()
    assert (tmp_path / "mine.pdf").read_text() == (tmp_path / "mine.gv").read_text()
    assert capsys.readouterr().out.endswith("mine.pdf and mine.gv have the graph\n")


@pytest.mark.parametrize(
    ("program", "given", "said"),
    [
        (ros_programs.tf2_echo, ["map"], "expected two frames and perhaps a rate, got 1 words"),
        (ros_programs.tf2_echo, ["map", "base", "fast"], "RATE: expected a number above 0, got 'fast'"),
        (ros_programs.tf2_monitor, ["map"], "expected two frames or none, got 1 words"),
        (ros_programs.view_frames, ["--wait", "1"], "no such option: --wait"),
        (ros_programs.view_frames, ["-t", "nan"], "-t: expected a number above 0, got 'nan'"),
    ],
)
def test_other_arguments_are_one_line(words: list[str], program: object, given: list[str], said: str) -> None:
    words += given
    with pytest.raises(RobolinkError, match=re.escape(said)):
        program()  # type: ignore[operator]
