"""Read a launch file."""

from __future__ import annotations

import os

from robolink.launch.checks import check
from robolink.launch.copies import copies
from robolink.launch.description import LaunchDescription
from robolink.yamlfile import Document, read


def read_launch_file(path: str | os.PathLike[str], *, text: str | None = None) -> Document[LaunchDescription]:
    """Read a launch file (or `text` in its place) and check all that can be checked without looking at nodes.

    Raises `DocumentError` with `file:line:column`.
    """
    document = read(path, LaunchDescription, text=text)
    check(document, copies(document))
    return document
