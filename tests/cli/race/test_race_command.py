"""robolink race: tables for people, as JSON and as CSV."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.cli.race import RACES
from robolink.grading.languages import STUDENT_FILE
from robolink.grading.mistakes import Mistake
from robolink.race import apart, races
from robolink.race.result import Result

Captured = pytest.CaptureFixture[str]
RESULTS = {
    "a.py": Result("a.py", 41.5, 1.0, 0, "ab" * 32),
    "b.py": Result("b.py", None, 0.31, 2, "cd" * 32),
    "c.py": Result("c.py", mistake=Mistake("exception", "NameError: name 'x\x1b[2J'", 4, "    x")),
}


@pytest.fixture(autouse=True)
def _english(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LC_ALL", "C")


@pytest.fixture
def three(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for each in RESULTS:
        (tmp_path / each).write_text("")

    def race_all(
        race: races.Race, programs: Sequence[str], seed: int, *, on_done: Callable[[Result], object]
    ) -> list[Result]:
        found = [RESULTS[each] for each in programs]
        for each in found:
            on_done(each)
        return found

    monkeypatch.setattr(apart, "race_all", race_all)


def test_its_races_are_those_that_there_are() -> None:
    assert list(RACES) == list(races.RACES)


@pytest.mark.usefixtures("three")
def test_a_table_for_people(capsys: Captured) -> None:
    assert main(["race", "line", "c.py", "b.py", "a.py", "--seed", "7"]) == 0
    out, err = capsys.readouterr()
    assert out.splitlines() == [
        "line, seed 7: the time of one lap along the line, and 5 s for each contact",
        "  1  a.py          41.50 s   0 contacts  abababababababab",
        "  -  b.py   31% of the way   2 contacts  cdcdcdcdcdcdcdcd",
        "  -  c.py  your program stopped with an error at line 4: NameError: name 'x\\x1b[2J'",
    ]
    wrong = "your program stopped with an error at line 4: NameError: name 'x\\x1b[2J'"
    assert err == f"c.py: {wrong}\nb.py is done\na.py is done\n"


@pytest.mark.usefixtures("three")
def test_a_table_in_portuguese(capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    told = [
        "line, semente 7: o tempo de uma volta pela linha, e mais 5 s por contato",
        "  1  a.py          41.50 s   0 contatos  abababababababab",
        "  -  b.py   31% do caminho   2 contatos  cdcdcdcdcdcdcdcd",
        "  -  c.py  seu programa parou com um erro na linha 4: NameError: name 'x\\x1b[2J'",
    ]
    words = ["race", "line", "c.py", "b.py", "a.py", "--seed", "7"]
    assert main([*words, "--language", "pt"]) == 0
    out, err = capsys.readouterr()
    assert out.splitlines() == told
    wrong = "seu programa parou com um erro na linha 4: NameError: name 'x\\x1b[2J'"
    assert err == f"c.py: {wrong}\nb.py terminou\na.py terminou\n"
    monkeypatch.setenv("LC_ALL", "pt_BR.UTF-8")
    assert main(words) == 0
    assert capsys.readouterr().out.splitlines() == told
    monkeypatch.setenv("LC_ALL", "C")
    Path(STUDENT_FILE).write_text('{"language": "pt"}', encoding="utf-8")
    assert main(words) == 0
    assert capsys.readouterr().out.splitlines() == told


@pytest.mark.usefixtures("three")
def test_tables_for_programs_are_english_in_any_language(capsys: Captured) -> None:
    for kind in ("--json", "--csv"):
        words = ["race", "line", "c.py", "a.py", kind]
        assert main(words) == 0
        english = capsys.readouterr().out
        assert main([*words, "--language", "pt"]) == 0
        assert capsys.readouterr().out == english


@pytest.mark.usefixtures("three")
def test_a_student_without_a_program_has_a_line(
    tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    for student, files in {"ana": ["line.py"], "eva": ["x.py", "y.py"], "rui": []}.items():
        (tmp_path / "turma" / student).mkdir(parents=True)
        for each in files:
            (tmp_path / "turma" / student / each).write_text("x = 1\n")
    monkeypatch.setitem(RESULTS, str(Path("turma", "ana", "line.py")), RESULTS["a.py"])
    assert main(["race", "line", "turma"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [each.split()[:2] for each in lines[1:]] == [
        ["1", "a.py"],
        ["-", str(Path("turma", "eva"))],
        ["-", str(Path("turma", "rui"))],
    ]
    assert lines[-1].endswith("no line.py here, nor one other Python file alone")
    assert main(["race", "line", "turma", "--csv"]) == 0
    out, err = capsys.readouterr()
    assert len(out.splitlines()) == 2
    assert "rui: no line.py here" in err


@pytest.mark.usefixtures("three")
def test_a_table_for_programs(capsys: Captured) -> None:
    assert main(["race", "maze", "a.py", "--json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert row["score"] == 41.5
    assert row["hash"] == "ab" * 32
    assert main(["race", "maze", "a.py", "--csv"]) == 0
    assert capsys.readouterr().out.splitlines()[1] == f"1,a.py,41.5,s,1.0,0,1,{'ab' * 32},"


@pytest.mark.usefixtures("three")
def test_a_name_that_is_not_utf_8_is_escaped(capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(RESULTS, "a.py", Result("caf\udce9\n.py", 41.5, 1.0, 0, "ab" * 32))
    assert main(["race", "maze", "a.py", "--json"]) == 0
    (row,) = json.loads(capsys.readouterr().out)
    assert row["program"] == "caf\udce9\n.py"
    assert main(["race", "maze", "a.py"]) == 0
    assert capsys.readouterr().out.splitlines()[1].startswith("  1  caf\\udce9\\n.py  ")


@pytest.mark.usefixtures("three")
def test_a_race_goes_on_if_nobody_listens(capsys: Captured, monkeypatch: pytest.MonkeyPatch) -> None:
    def closed(text: str, **options: bool) -> None:
        raise BrokenPipeError

    monkeypatch.setattr("robolink.cli.race.tell", closed)
    assert main(["race", "maze", "a.py", "b.py"]) == 0
    assert "b.py" in capsys.readouterr().out


@pytest.mark.usefixtures("three")
def test_wrong_usage(capsys: Captured) -> None:
    assert main(["race", "lime", "a.py"]) == 2
    assert "'lime' is none of line, maze, follow (did you mean 'line'?)" in capsys.readouterr().err
    assert main(["race", "line", "a.py", "--json", "--csv"]) == 2
    assert main(["race", "line", "aa.py"]) == 1
    assert capsys.readouterr().err.endswith("robolink: no file named 'aa.py' (did you mean 'a.py'?)\n")
