"""Check of a release before it is published: version, changelog and citation agree with the tag; prints its notes.

Usage: python tools/release.py v0.2.0 > notes.md
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
VERSION = re.compile(r'^version = "(.+)"$', re.MULTILINE)
CITED = re.compile(r"^version: (.+)$", re.MULTILINE)


def notes(tag: str, root: Path = ROOT) -> str:
    """Return the changelog's section for a tag.

    Args:
        tag: Such as v0.2.0.
        root: Folder with pyproject.toml, CHANGELOG.md and CITATION.cff.

    Raises:
        ValueError: If one of the three names another version, or the section says something twice.
    """
    wanted = tag.removeprefix("v")
    for name, pattern in (("pyproject.toml", VERSION), ("CITATION.cff", CITED)):
        found = pattern.search((root / name).read_text(encoding="utf-8"))
        if found is None or found[1] != wanted:
            raise ValueError(f"{name}: the version is {found[1] if found else 'missing'}, the tag is {tag}")
    sections = re.split(r"^## ", (root / "CHANGELOG.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    for section in sections[1:]:
        title, _, text = section.partition("\n")
        if title.split(" ")[0].strip("[]") == wanted:
            if repeated := twice(text):
                raise ValueError(f"CHANGELOG.md: '{repeated}' stands twice in the section of {wanted}")
            return text.strip() + "\n"
    raise ValueError(f"CHANGELOG.md: no section '## {wanted}': rename 'Unreleased' and begin a new one")


def twice(section: str) -> str:
    """Return the first heading or entry that a section has twice, if any: two changes were merged by hand."""
    found = re.findall(r"^(?:###+|[ ]*-) (.*)$", section, re.MULTILINE)
    return next((each for each in found if found.count(each) > 1), "")


def main(words: list[str]) -> int:
    """Print the notes of a release; return the exit code."""
    if len(words) != 1:
        sys.stderr.write("usage: python tools/release.py TAG\n")
        return 2
    try:
        sys.stdout.write(notes(words[0]))
    except ValueError as error:
        sys.stderr.write(f"{error}\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
