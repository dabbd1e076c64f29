"""Runs of races: the same score and hash each time, and a sentence for each program that fails."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import pytest

from robolink.exceptions import NotFoundError
from robolink.grading.mistakes import Mistake
from robolink.race.apart import programs_of, race_all, run_one
from robolink.race.driving import Drive
from robolink.race.races import RACES
from robolink.race.result import Result, as_csv, ranked, rows, table
from robolink.sim.worldfile import check_world

STANDS = """
import rclpy
from rclpy.node import Node


def main():
    rclpy.init()
    rclpy.spin(Node("stands"))


if __name__ == "__main__":
    main()
"""
FOLLOW, MAZE = RACES["follow"], RACES["maze"]


@pytest.mark.parametrize("race", RACES.values(), ids=RACES)
@pytest.mark.parametrize("seed", [0, 1, 12345])
def test_every_world_is_valid(race: object, seed: int, tmp_path: Path) -> None:
    (tmp_path / "world.yaml").write_text(race.world(seed))  # type: ignore[attr-defined]
    assert not check_world(tmp_path / "world.yaml").errors


@pytest.mark.slow
def test_the_same_seed_has_the_same_score_and_hash() -> None:
    first, again, other = (Drive(FOLLOW, "wall_follower", seed).run() for seed in (1, 1, 2))
    assert first == again
    assert first.score is not None
    assert first.score > 20.0
    assert first.contacts == 0
    assert other.hash != first.hash


@pytest.mark.slow
def test_a_maze_is_solved() -> None:
    result = Drive(MAZE, "wall_follower", 1).run()
    assert result.score is not None
    assert 50.0 < result.score < 300.0
    assert result.progress == 1.0


@pytest.mark.slow
def test_who_stands_has_no_score(tmp_path: Path) -> None:
    (tmp_path / "ana.py").write_text(STANDS)
    result = Drive(MAZE._replace(seconds=5.0), str(tmp_path / "ana.py"), 1).run()
    assert (result.score, result.progress, result.mistake) == (None, 0.0, None)
    assert Drive(FOLLOW._replace(seconds=5.0), str(tmp_path / "ana.py"), 1).run().score == 0.0


@pytest.mark.parametrize(
    ("text", "kind", "words"),
    [
        ("def main(:\n", "syntax", ""),
        (STANDS.replace("rclpy.init()", "rclpy.inti()"), "exception", "did you mean 'init'"),
        (STANDS.replace('rclpy.spin(Node("stands"))', "raise SystemExit(3)"), "ended", "exit code 3"),
    ],
)
def test_a_broken_program_is_told(text: str, kind: str, words: str, tmp_path: Path) -> None:
    file = tmp_path / "ana.py"
    file.write_text(text)
    result = Drive(FOLLOW._replace(seconds=5.0), str(file), 1).run()
    assert result.mistake is not None
    assert result.mistake.kind == kind
    assert words in result.mistake.text
    (_, line) = table(FOLLOW, [result], 1)
    assert "\n" not in line
    assert "ana.py" in line


@pytest.mark.processes
def test_several_run_side_by_side_and_none_ends_the_others(tmp_path: Path) -> None:
    (tmp_path / "stuck.py").write_text(STANDS.replace("    rclpy.init()", "    while True:\n        pass"))
    (tmp_path / "gone.py").write_text("import os\nos._exit(0)\n" + STANDS)
    done: list[str] = []
    programs = [str(tmp_path / "stuck.py"), "wall_follower", str(tmp_path / "gone.py")]
    stuck, good, gone = race_all(FOLLOW, programs, 1, on_done=lambda each: done.append(each.program))
    assert sorted(done) == sorted(programs)
    assert stuck.mistake is not None
    assert stuck.mistake.kind == "stuck"
    assert gone.mistake == Mistake("ended all")
    assert good.score is not None
    assert good == run_one(FOLLOW, "wall_follower", 1)


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="it has no sleep")
def test_what_interrupts_a_race_ends_its_programs(tmp_path: Path) -> None:
    (tmp_path / "broken.py").write_text("def main(:\n")
    (tmp_path / "waits.py").write_text("import subprocess\nsubprocess.run(['sleep', '60'])\n")

    def interrupt(result: Result) -> None:
        raise KeyboardInterrupt

    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        race_all(FOLLOW, [str(tmp_path / "broken.py"), str(tmp_path / "waits.py")], 1, on_done=interrupt)
    assert time.monotonic() - begin < 15.0, "it did not wait for the other, which ends after 20 s"


@pytest.mark.processes
def test_a_node_of_the_workspace_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for each in ("nodes", "configs"):
        (tmp_path / each).mkdir()
    (tmp_path / "nodes" / "my_racer.py").write_text("def main(:\n")
    monkeypatch.chdir(tmp_path)
    (program,) = programs_of("follow", ["my_racer"])
    result = run_one(FOLLOW, program, 1)
    assert result.program == "my_racer"
    assert result.mistake is not None
    assert (result.mistake.kind, result.mistake.line) == ("syntax", 1)


@pytest.mark.slow
def test_a_program_has_any_name_that_a_file_can_have(tmp_path: Path) -> None:
    for name in ("bare", "UPPER.PY", "a b.py", "two\nlines.py"):
        file = tmp_path / name
        file.write_text(STANDS)
        result = Drive(FOLLOW._replace(seconds=0.1), str(file), 1).run()
        assert (result.mistake, result.score) == (None, 0.0)
        assert len(list(table(FOLLOW, [result], 1))) == 2
        assert all("\n" not in line for line in table(FOLLOW, [result], 1))


def test_places() -> None:
    a, b, c = Result("a", 3.0), Result("b", 2.0), Result("c", 2.0)
    half, none = Result("half", progress=0.5), Result("none")
    broken = Result("broken", progress=0.9, mistake=Mistake("stuck"))
    order = [(place, each.program) for place, each in ranked(MAZE, [broken, none, a, half, b, c])]
    assert order == [(1, "b"), (1, "c"), (3, "a"), (0, "half"), (0, "none"), (0, "broken")]
    assert [each.program for _, each in ranked(FOLLOW, [a, b])] == ["a", "b"]


def test_a_table_as_csv_and_as_rows() -> None:
    results = [Result("b,1.py", 2.0, 1.0, 1, "ff"), Result('"a".py', mistake=Mistake("exception", "ValueError: x", 3))]
    text = as_csv(MAZE, results, 7).splitlines()
    assert text[0] == "place,program,score,unit,progress,contacts,seed,hash,error"
    assert text[1] == '1,"b,1.py",2.0,s,1.0,1,7,ff,'
    assert text[2].startswith(',"""a"".py",,s,0.0,0,7,,')
    assert text[2].endswith("at line 3: ValueError: x")
    assert rows(MAZE, results, 7)[1]["score"] is None


def test_programs_of_a_class(tmp_path: Path) -> None:
    for name in ("ana/maze.py", "ana/other.py", "bruno/mine.py", "carla/a.py", "carla/b.py", ".git/x.py", "davi.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("")
    found = programs_of("maze", [str(tmp_path), "wall_follower"])
    assert found == [str(tmp_path / each) for each in ("ana/maze.py", "bruno/mine.py", "davi.py")] + ["wall_follower"]


@pytest.mark.parametrize(
    ("word", "told"),
    [
        ("wall_folower", "did you mean 'wall_follower'"),
        ("nowhere/x.py", "no file named 'nowhere/x.py'"),
        (".", r"no program named '\*\.py or \*/maze\.py' in \."),
    ],
)
def test_a_word_that_is_no_program(word: str, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(NotFoundError, match=told):
        programs_of("maze", [word])
