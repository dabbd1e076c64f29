"""What launch files and worlds say of themselves, in the lists that commands show."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robolink.cli.main import main
from robolink.workspace import built_in_workspace, list_launches, list_worlds, purpose_of


@pytest.mark.parametrize(
    ("text", "purpose"),
    [
        ("# A robot wanders.\nnodes: []\n", "A robot wanders"),
        ("# One sentence. And more.\nnodes: []\n", "One sentence"),
        ("# Goes on\n# in a second line of 1.5 m; then more\nnodes: []\n", "Goes on in a second line of 1.5 m"),
        ("# yaml-language-server: $schema=x.json\n# A room.\nworld: {}\n", "A room"),
        ("---\n\n# A room\n\n# Another comment\n", "A room"),
        ("#\n# No first line\n", ""),
        ("# Comment\ndescription: Of its own. All of it\nnodes: []\n", "Of its own. All of it"),
        ("description: 'quoted'\n", "quoted"),
        ("# Comment\ndescription: >\n  folded\n", "Comment"),
        ("nodes: []\n# Too late\n", ""),
        ("# Windows\r\nnodes: []\r\n", "Windows"),
        ("# \x1b[2Jcleared\n", "\\x1b[2Jcleared"),
        ("# " + "long " * 50, ("long " * 20)[:97].rstrip() + "..."),
        ("", ""),
    ],
)
def test_the_purpose_is_a_description_or_the_first_sentence_of_the_first_comment(
    text: str, purpose: str, tmp_path: Path
) -> None:
    file = tmp_path / "a.yaml"
    file.write_bytes(text.encode())
    assert purpose_of(file) == purpose


@given(head=st.one_of(st.binary(), st.text(alphabet="#\n\r -description:.;%a1\x9b\u202e").map(str.encode)))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_bytes_have_one_short_line_or_none(head: bytes, tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_bytes(head)
    purpose = purpose_of(tmp_path / "a.yaml")
    assert len(purpose) <= 100
    assert purpose.isprintable()


def test_what_cannot_be_read_has_none(tmp_path: Path) -> None:
    (tmp_path / "a.wbt").write_text("#VRML_SIM R2023b utf8\n")
    (tmp_path / "folder.yaml").mkdir()
    assert [purpose_of(tmp_path / each) for each in ("a.wbt", "folder.yaml", "gone.yaml")] == ["", "", ""]
    if sys.platform != "win32":
        os.mkfifo(tmp_path / "fifo.yaml")
        assert purpose_of(tmp_path / "fifo.yaml") == ""


def test_all_that_comes_along_tells_its_purpose() -> None:
    here = built_in_workspace()
    assert [
        each for each in [*list_launches(workspace=here), *list_worlds(workspace=here)] if not purpose_of(each)
    ] == []


def test_the_lists_show_it(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(built_in_workspace())
    assert main(["launch", "--list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "walker       A humanoid walks a square in steps of 0.3 m" in lines
    assert main(["world", "list"]) == 0
    assert "empty_room  A room with nothing in it" in capsys.readouterr().out.splitlines()
    assert main(["world", "list", "--json"]) == 0
    found = {each["name"]: each["description"] for each in json.loads(capsys.readouterr().out)}
    assert found["empty_room"] == "A room with nothing in it"
