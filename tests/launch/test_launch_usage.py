"""One rule for launching and simulating: what cannot be said at all exits with 2, what the system says no to with 1."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.workspace import VARIABLE

NODE = "from robolink import Node\n\n\nclass Talker(Node):\n    pass\n"
FILE = "arguments: {count: {default: 1, choices: [1, 2]}}\nnodes: [{node: talker, parameters: {count: '{count}'}}]\n"


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in ("nodes", "configs"):
        (tmp_path / folder).mkdir()
    (tmp_path / "nodes" / "talker.py").write_text(NODE)
    (tmp_path / "configs" / "talk.yaml").write_text(FILE)
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(tmp_path)


WRONG_USAGE = [
    [],
    ["count:=1"],
    ["talk", ":=1"],
    ["talk", "count=1"],
    ["talk", "a", "b"],
    ["talk", "--duration", "soon"],
    ["talk", "--duration", "-1"],
    ["talk", "--no-such-option"],
]
"""Wrong for any launch file."""
WRONG_HERE = [
    ["tolk"],
    ["talk", "cuont:=1"],
    ["talk", "count:=3"],
    ["talk", "count:=[1"],
    ["talk", "--workspace", "nowhere"],
]
"""What the files say no to, or YAML."""
SETTINGS = [
    (["--set", "talker"], 2),
    (["--set", "talker.count=1"], 2),
    (["--set", "tolker.count:=1"], 1),
    (["--set", "talker.count:=[1"], 1),
    (["--faults", "nope"], 1),
    (["--fail-on", "nothing"], 2),
    (["--repeat", "-1"], 2),
]
ASKED = [
    (["stop", "a", "b", "c"], 2),
    (["restart"], 2),
    (["restart", "a", "b", "c"], 2),
    (["--status", "a", "b"], 2),
    (["talk", "--graph", "png"], 2),
    (["--validate"], 2),
    (["tolk", "--validate"], 1),
    (["tolk", "--show-args"], 1),
]
CASES = [
    *(([verb, *words], 2) for verb in ("launch", "simulate") for words in WRONG_USAGE),
    *(([verb, *words], 1) for verb in ("launch", "simulate") for words in WRONG_HERE),
    *((["simulate", "talk", *words], code) for words, code in SETTINGS),
    *((["launch", *words], code) for words, code in ASKED),
]


@pytest.mark.parametrize(("words", "code"), CASES, ids=lambda each: " ".join(each) if isinstance(each, list) else "")
def test_the_exit_code_says_whose_mistake_it_is(
    words: list[str], code: int, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words) == code
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("robolink: ")
    assert err.count("\n") == 1
    assert (f"(see 'robolink {words[0]} --help')" in err) is (code == 2)
