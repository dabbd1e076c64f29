"""Paths as users write them: home folders, and looks at files that never raise."""

from __future__ import annotations

import os
from pathlib import Path


def expanded(path: str | os.PathLike[str]) -> Path:
    """Return a path with `~` replaced by the home folder; as it is where that is not known, as for `~nobody-here`."""
    try:
        return Path(path).expanduser()
    except RuntimeError:
        return Path(path)


def is_file(path: Path) -> bool:
    """True if there is such a file, and this user may know of it; `Path.is_file` raises where that is not so."""
    try:
        return path.is_file()
    except (OSError, ValueError):  # a folder that may not be entered; a name that is too long, or none at all
        return False
