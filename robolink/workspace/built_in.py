"""Location of the workspace that comes with robolink, and of robolink's own modules."""

from __future__ import annotations

from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent
"""Folder of the package `robolink`."""


def built_in_workspace() -> Path:
    """Return the workspace that comes with robolink: inside the wheel, or the repository."""
    shared = PACKAGE / "share"
    return shared if shared.is_dir() else PACKAGE.parent
