"""Optional parts: what is there without a folder that an installation lacks, and the one line that says so."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.cli.shared.commands import NOUNS, Entry
from robolink.extensions import optional
from robolink.extensions.optional import MissingPartError, is_here, page, part
from robolink.sim import worldfile

GONE = "robolink.gone_annex"


@pytest.fixture
def without(monkeypatch: pytest.MonkeyPatch) -> None:
    """An installation without `robolink view` and the reader of Webots' worlds."""
    monkeypatch.setitem(NOUNS, "view", Entry(GONE, NOUNS["view"].help))
    monkeypatch.setattr(optional, "PAGE", f"{GONE}:page_of")
    monkeypatch.setitem(worldfile.FORMATS, ".wbt", f"{GONE}:load")


def test_parts_are_modules_and_packages() -> None:
    assert is_here("robolink.extensions")
    assert is_here("robolink.extensions.optional:part")
    assert not is_here(f"{GONE}:anything")
    assert part("robolink.extensions.optional:part", "it") is part
    with pytest.raises(MissingPartError, match="it is not part of this installation"):
        part(f"{GONE}:it", "it")


@pytest.mark.usefixtures("without")
def test_a_command_that_is_not_there_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["view"]) == 1
    assert capsys.readouterr().err == "robolink: 'robolink view' is not part of this installation of robolink\n"
    assert main(["--help"]) == 0
    listed = capsys.readouterr().out
    assert "\n  topic " in listed
    assert "\n  view " not in listed


@pytest.mark.annex("view")
def test_a_command_without_its_page_is_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """robolink/view alone was deleted, and its command is there."""
    from robolink.cli.view.ros_programs import rviz2

    monkeypatch.setattr(optional, "PAGE", f"{GONE}:page_of")
    assert main(["view", "--no-browser"]) == 1
    assert main(["view", "--bag", "gone.mcap"]) == 1
    error = "robolink: 'robolink view' is not part of this installation of robolink\n"
    assert capsys.readouterr().err == 2 * error
    with pytest.raises(MissingPartError):
        rviz2()


@pytest.mark.slow
@pytest.mark.usefixtures("without")
def test_what_needs_a_page_says_that_there_is_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(MissingPartError, match="'robolink view' is not part"):
        page(None)
    file = tmp_path / "one.yaml"
    file.write_text("nodes: [{node: walker}]\n")
    assert main(["launch", str(file), "--view"]) == 1
    error = "--view ('robolink view') is not part of this installation of robolink\n"
    assert capsys.readouterr().err == f"robolink: {error}"


@pytest.mark.usefixtures("without")
def test_a_world_whose_reader_is_not_there_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "a.wbt"
    file.write_text("#VRML_SIM R2023b utf8\n")
    assert main(["world", "check", str(file)]) == 1
    out = capsys.readouterr()
    assert "the reader of .wbt files is not part of this installation" in out.out + out.err
