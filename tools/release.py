"""Release: changes/ becomes a section of the changelog; version, changelog and citation are checked against the tag.

python tools/release.py collect 0.3.0            writes the section of CHANGELOG.md, and removes the fragments
python tools/release.py v0.3.0 > notes.md        prints the section, if all agree
"""

from __future__ import annotations

import re
import sys
from datetime import date
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
VERSION = re.compile(r'^version = "(.+)"$', re.MULTILINE)
CITED = re.compile(r"^version: (.+)$", re.MULTILINE)
KINDS = ("Added", "Changed", "Removed", "Fixed")
ENTRY = re.compile(r"^- (?=\*\*)", re.MULTILINE)
KIND = re.compile(rf"\*\*({'|'.join(KINDS)})\*\*: \S")


def fragments(root: Path = ROOT) -> list[Path]:
    """List the files of changes/, in the order of their names; the README is not one of them."""
    return sorted(each for each in (root / "changes").glob("*.md") if each.name != "README.md")


def entries(root: Path = ROOT) -> list[str]:
    """Return the entries of all fragments, in the order of their kinds.

    Args:
        root: Folder with changes/.

    Raises:
        ValueError: If a fragment has anything but entries, each with its kind.
    """
    found: list[str] = []
    for path in fragments(root):
        before, *texts = ENTRY.split(path.read_text(encoding="utf-8"))
        bad = [each for each in texts if not KIND.match(each)]
        if before.strip() or bad or not texts:
            kinds = ", ".join(f"**{each}**" for each in KINDS)
            raise ValueError(f"changes/{path.name}: an entry begins with '- ', then one of {kinds}, then ': '")
        found += [each.strip() for each in texts]
    return sorted(found, key=lambda entry: KINDS.index(entry[2:].partition("*")[0]))


def collect(version: str, today: date, root: Path = ROOT) -> None:
    """Move the fragments into a new section of the changelog.

    Args:
        version: Such as 0.3.0.
        today: Date of the release.
        root: Folder with changes/ and CHANGELOG.md.

    Raises:
        ValueError: If changes/ has none, or one is not made of entries.
    """
    if not fragments(root):
        raise ValueError("changes/ has no fragments: there is nothing to release")
    section = "\n".join(f"- {each}" for each in entries(root))
    path = root / "CHANGELOG.md"
    head, mark, rest = path.read_text(encoding="utf-8").partition("\n## ")
    path.write_text(f"{head}\n## {version} ({today.isoformat()})\n\n{section}\n{mark}{rest}", encoding="utf-8")
    for each in fragments(root):
        each.unlink()


def notes(tag: str, root: Path = ROOT) -> str:
    """Return the changelog's section for a tag.

    Args:
        tag: Such as v0.2.0.
        root: Folder with pyproject.toml, CHANGELOG.md and CITATION.cff.

    Raises:
        ValueError: If one of the three names another version, or the section says something twice.
    """
    version = tag.removeprefix("v")
    for name, pattern in (("pyproject.toml", VERSION), ("CITATION.cff", CITED)):
        found = pattern.search((root / name).read_text(encoding="utf-8"))
        if found is None or found[1] != version:
            raise ValueError(f"{name}: the version is {found[1] if found else 'missing'}, the tag is {tag}")
    sections = re.split(r"^## ", (root / "CHANGELOG.md").read_text(encoding="utf-8"), flags=re.MULTILINE)
    for section in sections[1:]:
        title, _, text = section.partition("\n")
        if title.split(" ")[0].strip("[]") == version:
            if repeated := twice(text):
                raise ValueError(f"CHANGELOG.md: '{repeated}' stands twice in the section of {version}")
            return text.strip() + "\n"
    raise ValueError(f"CHANGELOG.md: no section '## {version}': run python tools/release.py collect {version}")


def twice(section: str) -> str:
    """Return the first heading or entry that a section has twice, if any: two changes were merged by hand."""
    found = re.findall(r"^(?:###+|[ ]*-) (.*)$", section, re.MULTILINE)
    return next((each for each in found if found.count(each) > 1), "")


def main(words: list[str]) -> int:
    """Collect the fragments, or print the notes of a release; return the exit code."""
    try:
        if len(words) == 2 and words[0] == "collect":
            collect(words[1], date.today())
        elif len(words) == 1:
            sys.stdout.write(notes(words[0]))
        else:
            sys.stderr.write("usage: python tools/release.py collect VERSION | TAG\n")
            return 2
    except ValueError as error:
        sys.stderr.write(f"{error}\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
