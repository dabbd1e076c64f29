"""Check of parameter files: sections of a file that none of the nodes takes that are given it."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

from robolink.arguments.parameter_file import read_parameter_file
from robolink.arguments.untaken import untaken
from robolink.exceptions import DocumentError
from robolink.launch.entry import Entry
from robolink.workspace.find import YAML


def section_notes(entries: Iterable[Entry]) -> Iterator[str]:
    """Yield a line about each section of a parameter file whose name is misspelt, as far as that shows.

    A file that a node without a name reads itself is left out: the node tells of it.
    """
    given = [each for each in entries if each.source is not None]
    for file in dict.fromkeys(path for each in given for path in sorted(each.files) if path.name.endswith(YAML)):
        takers = [each for each in given if file in each.files]
        if any(os.fspath(file) in each.node.args for each in takers):
            continue
        try:
            overrides = read_parameter_file(file)
        except (DocumentError, OSError):  # it is a launch file
            continue
        for text in untaken(overrides, [each.full_name for each in takers]):
            yield f"{file.name}: {text}"
