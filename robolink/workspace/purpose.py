"""Purpose of a launch file or a world, from its own first words: for lists of what there is."""

from __future__ import annotations

import re
from pathlib import Path

from robolink.system.patterns import late
from robolink.system.terminal import fit

_HEAD = 4096
"""Bytes at a file's beginning that are searched."""
_LONGEST = 100
_DESCRIPTION = late(r"^description: +(?![>|&*!])['\"]?(.+?)['\"]?\s*$", re.MULTILINE)
_COMMENT = late(r"\A(?:(?:#[ \t]*yaml-language-server:.*|---.*|%.*|[ \t]*)\n)*((?:#[ \t]?\S.*(?:\n|\Z))+)")
_FIRST_SENTENCE = late(r".+?(?=[.;:]*(?:[.;]\s|\Z))", re.DOTALL)


def purpose_of(path: Path) -> str:
    """Return the purpose of the YAML file at `path`: its `description`, else its first comment's first sentence; or ''.

    It is one line, fit for a terminal. A file that cannot be read has none, nor has a world of Webots.
    """
    try:
        if path.suffix == ".wbt" or not path.is_file():
            return ""
        with path.open("rb") as file:
            head = file.read(_HEAD).decode("utf-8", errors="replace").replace("\r\n", "\n")
    except OSError:
        return ""
    if described := _DESCRIPTION.search(head):
        return _shortened(described[1])
    comment = _COMMENT.match(head)
    if comment is None:
        return ""
    lines = (line.removeprefix("#").removeprefix(" ") for line in comment[1].splitlines())
    sentence = _FIRST_SENTENCE.match("\n".join(lines).strip())
    return _shortened(sentence[0]) if sentence else ""


def _shortened(text: str) -> str:
    line = fit(" ".join(text.split()), lines=False)
    return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 3].rstrip()}..."
