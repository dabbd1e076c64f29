"""A student's folder: files are written once, progress is kept, and nothing of the student's is lost."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest

from robolink.exceptions import DocumentError, NotFoundError
from robolink.grading.languages import STUDENT_FILE
from robolink.learn.exercise import Exercise, ExerciseError, chosen, read_course, read_exercise
from robolink.learn.folder import (
    NoFolderError,
    Progress,
    StudentFolder,
    Watch,
    find_folder,
    load_progress,
    save_progress,
    start_folder,
    the_folder,
)
from robolink.learn.lines import listed
from robolink.supervisor.monitoring.file_watch import Changes

DEEP = b'{"x":' + b"[" * 100_000


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> StudentFolder:
    monkeypatch.chdir(tmp_path)
    made = start_folder("mine", language="pt")
    made.write()
    monkeypatch.chdir(tmp_path / "mine")
    return made


def test_start_writes_what_is_missing_and_nothing_else(folder: StudentFolder) -> None:
    first = folder.file_of(folder.course[0])
    assert first.read_text(encoding="utf-8") == folder.course[0].given_text("pt")
    first.write_text("mine", encoding="utf-8")
    folder.file_of(folder.course[1]).unlink()
    assert start_folder().write() == [folder.course[1].file]
    assert first.read_text(encoding="utf-8") == "mine"


@pytest.mark.skipif(sys.platform == "win32", reason="it lets few people make links")
def test_a_link_that_leads_nowhere_is_there_already(folder: StudentFolder) -> None:
    path = folder.file_of(folder.course[0])
    path.unlink()
    path.symlink_to("nowhere")
    assert start_folder().write() == []
    assert folder.reset(folder.course[0]) is not None
    assert path.is_file()
    assert not path.is_symlink()


def test_two_commands_at_once_lose_nothing_of_each_other(folder: StudentFolder) -> None:
    one, other = the_folder(), the_folder()  # `watch` in one terminal, for example, and `check` in another
    one.finish(folder.course[0])
    other.next_hint(folder.course[1])
    one.finish(folder.course[2])
    other.speak("en")
    assert the_folder().progress == Progress(
        "en", "", [folder.course[0].name, folder.course[2].name], {folder.course[1].name: 1}
    )


def test_progress_that_was_broken_meanwhile_is_written_again(folder: StudentFolder) -> None:
    folder.finish(folder.course[0])
    (folder.path / STUDENT_FILE).write_text("{")
    folder.finish(folder.course[1])
    assert the_folder().done == 2


def test_a_full_disk_leaves_no_half_of_a_file(folder: StudentFolder, monkeypatch: pytest.MonkeyPatch) -> None:
    exercise = folder.course[0]
    folder.file_of(exercise).write_text("mine")
    folder.file_of(folder.course[1]).unlink()
    before = {each.name: each.read_bytes() for each in folder.path.iterdir()}
    write = Path.write_bytes

    def full(path: Path, data: bytes) -> int:
        write(path, data[:10])
        raise OSError(28, "No space left on device", str(path))

    monkeypatch.setattr(Path, "write_bytes", full)
    for act in (folder.write, lambda: folder.reset(exercise), lambda: folder.finish(exercise)):
        with pytest.raises(OSError, match=r"No space left.*(\.py|learn\.json)'"):
            act()
    assert {each.name: each.read_bytes() for each in folder.path.iterdir()} == before


def test_progress_is_kept(folder: StudentFolder) -> None:
    assert folder.next == folder.course[0]
    folder.finish(folder.course[0])
    again = the_folder()
    assert again.language == "pt"
    assert again.done == 1
    assert again.next == folder.course[1]
    lines = list(listed(again))
    assert lines[0] == f"1 de {len(folder.course)} exercícios feitos"
    with pytest.raises(NotFoundError, match=r"^não há exercício chamado 'helo' \(você quis dizer 'hello'\?\)$"):
        folder.chosen("helo")
    assert lines[1].startswith("  ✓ ")
    assert lines[2].startswith("  → ")


def test_all_done(folder: StudentFolder) -> None:
    for each in folder.course:
        folder.finish(each)
    assert folder.next is None
    assert folder.chosen() == folder.course[-1]
    assert list(listed(folder))[-1] == "Todos os exercícios estão feitos. Muito bem!"


def test_hints_come_step_by_step(folder: StudentFolder) -> None:
    exercise = folder.course[0]
    count = len(exercise.settings.hints)
    numbers = [the_folder().next_hint(exercise) for _ in range(count + 2)]
    assert numbers == [*range(1, count + 1), count, count]


def test_reset_keeps_what_was_there(folder: StudentFolder) -> None:
    exercise = folder.course[0]
    path = folder.file_of(exercise)
    for number, text in enumerate(("one", "two"), 1):
        path.write_text(text, encoding="utf-8")
        folder.finish(exercise)
        kept = folder.reset(exercise)
        assert kept is not None
        assert kept.name == f"{path.stem}.mine{number if number > 1 else ''}.py"
        assert kept.read_text(encoding="utf-8") == text
        assert path.read_text(encoding="utf-8") == exercise.given_text("pt")
        assert the_folder().done == 0
    path.unlink()
    assert folder.reset(exercise) is None


def test_language_is_kept(folder: StudentFolder) -> None:
    the_folder().speak("en")
    assert the_folder().language == "en"


def test_without_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert find_folder() is None
    with pytest.raises(NoFolderError, match="robolink learn start"):
        the_folder()


@pytest.mark.parametrize(
    "content",
    [b"", b"{", b"[]", b'{"language": "fr"}', b'{"done": 3}', b"\xff\xfe", b"{}" * 10, b'{"x":' + b"[" * 100_000],
)
def test_progress_that_cannot_be_read_is_one_line(content: bytes, tmp_path: Path) -> None:
    (tmp_path / STUDENT_FILE).write_bytes(content)
    with pytest.raises(DocumentError, match="delete this file") as told:
        load_progress(tmp_path)
    assert "\n" not in str(told.value)


def test_progress_survives_a_round_trip(tmp_path: Path) -> None:
    progress = Progress("pt", "", ["hello"], {"hello": 2})
    save_progress(tmp_path, progress)
    assert load_progress(tmp_path) == progress
    assert [each.name for each in tmp_path.iterdir()] == [STUDENT_FILE]


@pytest.mark.parametrize("count", [-5, 10**18])
def test_hints_that_somebody_has_counted(count: int, folder: StudentFolder) -> None:
    exercise = folder.course[0]
    save_progress(folder.path, Progress(hints={exercise.name: count}))
    assert 1 <= the_folder().next_hint(exercise) <= len(exercise.settings.hints)


@pytest.mark.parametrize("name", ["hello", "02_hello", "02_hello.py", "some/where/02_hello.py", "2", "02"])
def test_an_exercise_has_several_names(name: str) -> None:
    assert chosen(read_course(), name).name == "hello"


def test_an_unknown_name_has_the_nearest() -> None:
    with pytest.raises(NotFoundError, match="did you mean 'hello'"):
        chosen(read_course(), "helo")


def test_a_folder_without_exercises(tmp_path: Path) -> None:
    with pytest.raises(ExerciseError, match="has no exercises"):
        read_course(tmp_path)
    (tmp_path / "01_x").mkdir()
    with pytest.raises(ExerciseError, match=r"has no exercise\.yaml"):
        read_exercise(tmp_path / "01_x")
    (tmp_path / "BAD NAME").mkdir()
    with pytest.raises(ExerciseError, match="is called like 01_stop"):
        read_exercise(tmp_path / "BAD NAME")


def test_a_number_of_any_length_is_a_name(folder: StudentFolder) -> None:
    with pytest.raises(NotFoundError, match="não há exercício chamado"):
        folder.chosen("1" * 5000)
    assert folder.chosen("0002").name == "hello"


def test_two_exercises_of_one_name(tmp_path: Path) -> None:
    for each in ("01_stop", "02_stop"):
        shutil.copytree(read_course()[0].folder, tmp_path / each)
    with pytest.raises(ExerciseError, match=r"02_stop and .*01_stop are both 'stop'"):
        read_course(tmp_path)


def test_given_files_that_cannot_be_read(tmp_path: Path) -> None:
    shutil.copytree(read_course()[0].folder, tmp_path / "01_stop")
    given = tmp_path / "01_stop" / "given.py"
    given.write_bytes(b"# \xe7\n")
    with pytest.raises(DocumentError, match=r"given\.py:1:3: not UTF-8 text"):
        read_exercise(given.parent).given_text("en")
    with given.open("wb") as file:
        file.truncate(10**10)
    with pytest.raises(DocumentError, match="longer than"):
        read_exercise(given.parent).given_text("en")


def test_what_is_saved_is_checked_again(folder: StudentFolder) -> None:
    stamps: dict[Path, tuple[int, int, int]] = {folder.file_of(each): (1, 1, 1) for each in folder.course}
    checked: list[Exercise] = []
    watch = Watch(folder, checked.append, changes=Changes(stamps.get))
    watch.look()
    assert checked == []
    stamps[folder.file_of(folder.course[1])] = (2, 1, 1)
    watch.look()
    assert checked == []  # it may not be written to its end
    watch.look()
    watch.look()
    assert checked == [folder.course[1]]
