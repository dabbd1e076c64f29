"""Static files of the page, and the HTTP headers that they are sent with."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

PAGE = Path(__file__).parents[1] / "page"

TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".ico": "image/x-icon",
    ".json": "application/json",
    ".webmanifest": "application/manifest+json",
}
"""Content types by suffix; other files are not served."""

HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' blob: data:;"
        " frame-ancestors 'none'; base-uri 'none'; form-action 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
    "Connection": "close",
}
"""Headers of every answer."""


_COMMENT = re.compile(rb"^[ \t]*(?://.*|/\*\*(?:[^*]|\*(?!/))*\*/[ \t]*)$", re.MULTILINE)
"""Comments of a script that have their lines to themselves."""


class File(NamedTuple):
    """A file of the page."""

    content_type: str
    body: bytes


def find(path: str, folder: Path = PAGE) -> File | None:
    """Return a file by its path in an address, `/` for the page itself; None if the page has no such file.

    The path is looked up among those that are there, so no path leads out of the folder.
    """
    name = "index.html" if path == "/" else path.removeprefix("/")
    for each in folder.rglob("*"):
        if each.relative_to(folder).as_posix() == name and each.suffix in TYPES and each.is_file():
            return File(TYPES[each.suffix], _lean(each))
    return None


def _lean(file: Path) -> bytes:
    """Return what a browser needs of a file: a script without its comments, each line where it was."""
    body = file.read_bytes()
    if file.suffix != ".js":
        return body
    return _COMMENT.sub(lambda found: b"\n" * found.group().count(b"\n"), body)
