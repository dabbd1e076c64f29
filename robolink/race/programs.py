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
    for student in (each for each in folder.iterdir() if each.is_dir() and not each.name.startswith((".", "_"))):
        own = student / f"{race}.py"
        files = sorted(student.glob("*.py"))
        if own.is_file():
            yield own
        elif len(files) == 1:
            yield files[0]
