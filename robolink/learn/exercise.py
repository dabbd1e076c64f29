"""Exercises: a text, a given file, a check and hints, in a folder for each, in English and Portuguese."""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from msgspec import Struct

from robolink.documents.yamlfile import load, read_text
from robolink.exceptions import NotFoundError, RobolinkError
from robolink.grading.languages import Language

BUILT_IN = Path(__file__).parent / "exercises"
"""Folder of the exercises that come with robolink."""

SETTINGS, CHECK = "exercise.yaml", "check.py"
GIVEN = ("given.py", "given.yaml")
"""Names of the file that a student gets: a program or a launch file."""

LONGEST_NAME = 60
"""Most letters of an exercise's name."""

_NAME = re.compile(r"(?:\d+_)?([a-z][a-z0-9_]*)")
_COMMENT = re.compile(r"^([ \t]*)# \{(\w+)\}[ \t]*$", re.MULTILINE)


class ExerciseError(RobolinkError, ValueError):
    """A folder that should hold exercises does not; the text names the file and what to do."""


class Text(Struct, forbid_unknown_fields=True, frozen=True):
    """Text in both languages; one that is missing is replaced by the other."""

    en: str = ""
    pt: str = ""

    def __getitem__(self, language: Language) -> str:
        return (self.pt or self.en) if language == "pt" else (self.en or self.pt)


class Outcome(Struct, forbid_unknown_fields=True, frozen=True):
    """Sentences for one thing that a check looks at: if it is as it should be, and if not."""

    good: Text
    bad: Text

    def __iter__(self) -> Iterator[Text]:
        return iter((self.good, self.bad))


class Settings(Struct, forbid_unknown_fields=True, frozen=True):
    """Content of an exercise.yaml."""

    title: Text
    text: Text
    results: dict[str, Outcome]
    hints: list[Text] = []
    comments: dict[str, Text] = {}


@dataclass(frozen=True)
class Exercise:
    """An exercise: its name, its folder, and the file that a student begins with."""

    name: str
    folder: Path
    given: Path

    @functools.cached_property
    def settings(self) -> Settings:
        """Content of its exercise.yaml, read when it is first asked for. Raises DocumentError if it has a mistake."""
        return load(self.folder / SETTINGS, Settings)

    @property
    def file(self) -> str:
        """Name of the student's file."""
        return self.folder.name + self.given.suffix

    def title(self, language: Language) -> str:
        """Return the title."""
        return self.settings.title[language]

    def text(self, language: Language) -> str:
        """Return the task in a few lines."""
        return self.settings.text[language].strip()

    def given_text(self, language: Language) -> str:
        """Return the file that a student begins with: the task as a comment, then the program."""
        head = "\n".join(f"# {line}".rstrip() for line in [self.title(language), "", *self.text(language).splitlines()])
        return f"{head}\n\n{self._in_language(read_text(self.given), language)}"

    def _in_language(self, program: str, language: Language) -> str:
        """Replace the comments that are placeholders: `# {todo}` by the comment `todo` of exercise.yaml."""

        def filled(found: re.Match[str]) -> str:
            comment = self.settings.comments.get(found[2])
            if comment is None:
                raise ExerciseError(f"{self.given}: no comment '{found[2]}' in {SETTINGS}")
            return "\n".join(f"{found[1]}# {line}" for line in comment[language].strip().splitlines())

        return _COMMENT.sub(filled, program)


def read_exercise(folder: Path) -> Exercise:
    """Find an exercise.

    Args:
        folder: Its folder, with exercise.yaml, check.py and a given file; its name is the exercise's, after a number.

    Raises:
        ExerciseError: (a ValueError) if a file is missing, or the folder's name is not a name.
    """
    named = _NAME.fullmatch(folder.name)
    if named is None:
        raise ExerciseError(f"{folder}: an exercise's folder is called like 01_stop: digits, then small letters")
    given = next((folder / each for each in GIVEN if (folder / each).is_file()), None)
    for name in (SETTINGS, CHECK):
        if not (folder / name).is_file():
            raise ExerciseError(f"{folder} has no {name}: `robolink learn new` makes an exercise with all its files")
    if given is None:
        raise ExerciseError(f"{folder} has no {' or '.join(GIVEN)}, the file that a student begins with")
    return Exercise(named[1], folder, given)


def read_course(folder: Path | None = None) -> list[Exercise]:
    """Find all exercises of a folder, in the order of their folders' names.

    Args:
        folder: The folder; None is that of the exercises that come with robolink.

    Raises:
        ExerciseError: (a ValueError) if there is none, one is not complete, or two have the same name.
    """
    place = BUILT_IN if folder is None else folder
    found = sorted(each.parent for each in place.glob(f"*/{SETTINGS}"))
    if not found:
        raise ExerciseError(f"{place} has no exercises: folders with an {SETTINGS} in each")
    course = [read_exercise(each) for each in found]
    folders: dict[str, Path] = {}
    for each in course:
        if each.name in folders:
            raise ExerciseError(f"{each.folder} and {folders[each.name]} are both '{each.name}': rename one of them")
        folders[each.name] = each.folder
    return course


def chosen(course: list[Exercise], name: str) -> Exercise:
    """Return the exercise of a name, a number, or a student's file. Raises NotFoundError with the nearest name."""
    bare = re.sub(r"\.(py|yaml)$", "", Path(name).name)
    for each in course:
        number = each.folder.name.partition("_")[0]
        is_number = bare.isdecimal() and number.isdecimal() and bare.lstrip("0") == number.lstrip("0")
        if is_number or bare in (each.name, each.folder.name):
            return each
    raise NotFoundError("exercise", name, [each.name for each in course])
