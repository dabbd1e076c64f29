"""Programs of a race: files, names of nodes, and folders of students with a program in each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from robolink.exceptions import NotFoundError
from robolink.workspace import find_node


def programs_of(race: str, words: Iterable[str]) -> list[str]:
    """Return the programs that words of a command line stand for.

    A folder stands for the Python files in it, and for one of each folder in it: `RACE.py`, or the only one.

    Args:
        race: Name of the race.
        words: Files, folders, or names of nodes as `robolink run` finds them.

    Raises:
        NotFoundError: if a word is none of them, or nothing is found in a folder.
    """
    return [program for word in words for program in _of_word(race, word)]


def without_program(race: str, words: Iterable[str]) -> list[str]:
    """Return the students' folders in which there is no program for a race, or nobody knows which of several it is.

    Args:
        race: Name of the race.
        words: Files, folders, or names of nodes, as for `programs_of`.
    """
    students = [student for word in words if Path(word).is_dir() for student in _students(Path(word))]
    return sorted(str(each) for each in students if _own(race, each) is None)


def _of_word(race: str, word: str) -> list[str]:
    path = Path(word)
    if path.is_dir():
        found = sorted(map(str, _in_folder(race, path)))
        if not found:
            raise NotFoundError("program", f"*.py or */{race}.py", [], word)
        return found
    if path.is_file():
        return [word]
    if path.suffix == ".py" or len(path.parts) > 1:
        raise NotFoundError("file", word, (str(each) for each in path.parent.glob("*.py")))
    find_node(word)  # raises with the nearest name
    return [word]


def _in_folder(race: str, folder: Path) -> Iterator[Path]:
    yield from (each for each in folder.glob("*.py") if each.is_file())
    yield from (own for student in _students(folder) if (own := _own(race, student)) is not None)


def _students(folder: Path) -> list[Path]:
    return [each for each in folder.iterdir() if each.is_dir() and not each.name.startswith((".", "_"))]


def _own(race: str, student: Path) -> Path | None:
    """Return the program of a student's folder; None if there is none, or nobody knows which."""
    own = student / f"{race}.py"
    files = [own] if own.is_file() else list(student.glob("*.py"))
    return files[0] if len(files) == 1 else None
