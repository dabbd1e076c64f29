"""Import hook of OpenCV: the module cv2 is prepared when a program that robolink runs imports it, and not before."""

from __future__ import annotations

import importlib
import sys
from types import ModuleType

from robolink.workspace.modules import FINDER

_ROOM = "robolink.companions.opencv"
"""Module that prepares it, which is imported then."""


def prepare_opencv() -> None:
    """Prepare cv2 for programs: at its import, or now if it has been imported. A second call does nothing."""
    if "cv2" in FINDER.changes:
        return
    FINDER.change("cv2", _prepare)
    loaded = sys.modules.get("cv2")
    if loaded is not None and hasattr(loaded, "imshow"):
        _prepare(loaded)


def _prepare(cv2: ModuleType) -> None:
    importlib.import_module(_ROOM).prepare(cv2)
