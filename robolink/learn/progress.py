"""Progress of a student: what is done, how many hints were shown, and the language; kept in a file of their folder."""

from __future__ import annotations

from pathlib import Path

import msgspec
from msgspec import Struct

from robolink.exceptions import DocumentError
from robolink.learn.languages import Language
from robolink.system.whole_files import write_whole

FILE = ".robolink_learn.json"
"""Name of the file, by which a student's folder is known."""

LARGEST = 1_000_000
"""Most bytes of such a file."""


class Progress(Struct):
    """Content of the file."""

    language: Language = "en"
    source: str = ""
    """Folder of a teacher's exercises; '' for those that come with robolink."""
    done: list[str] = []
    """Names of the exercises that are done."""
    hints: dict[str, int] = {}
    """Number of hints that were shown, by exercise."""

    def finish(self, name: str) -> None:
        """Note that an exercise is done."""
        if name not in self.done:
            self.done.append(name)

    def forget(self, name: str) -> None:
        """Note that an exercise is as it was at the beginning."""
        self.done = [each for each in self.done if each != name]
        self.hints.pop(name, None)

    def next_hint(self, name: str, most: int) -> int:
        """Count a hint, and return its number, from 1 on; `most` again after the last, and 0 if there are none."""
        self.hints[name] = min(max(self.hints.get(name, 0), 0) + 1, most)
        return self.hints[name]


def load_progress(folder: Path) -> Progress:
    """Read the progress of a folder. Raises DocumentError if the file cannot be read."""
    path = folder / FILE
    try:
        with path.open("rb") as file:
            return msgspec.json.decode(file.read(LARGEST), type=Progress)
    except (OSError, msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise DocumentError(
            f"{reason}; delete this file and run `robolink learn start {folder}`: your programs stay", str(path)
        ) from None


def save_progress(folder: Path, progress: Progress) -> None:
    """Write the progress of a folder, as a whole or not at all. Raises OSError."""
    write_whole(folder / FILE, msgspec.json.format(msgspec.json.encode(progress)) + b"\n")
