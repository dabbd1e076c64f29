"""Names that OpenCV had once, with what programs use today."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import NoReturn

from robolink.text.suggestions import imports_a_name

_BEFORE_5 = "OpenCV 5 has no {name} any more, and this is {version}: pip install 'opencv-python<5'"
_LOST = {
    **dict.fromkeys(
        ("CascadeClassifier", "HOGDescriptor", "groupRectangles", "CASCADE_SCALE_IMAGE", "CASCADE_DO_CANNY_PRUNING"),
        _BEFORE_5,
    ),
    **dict.fromkeys(
        ("xfeatures2d", "ximgproc", "face", "legacy", "bgsegm"),
        "cv2.{name} is in another package: pip uninstall opencv-python, then pip install opencv-contrib-python",
    ),
    "cv": "cv2.cv ended with OpenCV 2, and this is {version}: its constants are in cv2, without 'CV_'",
}
"""Advice by name; ArUco's changes are told by OpenCV's own manual."""


def lost_name(cv2: ModuleType, name: str) -> NoReturn:
    """Raise an error for a name that the module cv2 lacks, with advice if it had it once.

    To be called by the module's `__getattr__` itself, since it looks at who called that.

    Args:
        cv2: The module.
        name: The name that was asked for.

    Raises:
        AttributeError: always; ImportError in `from cv2 import NAME`.
    """
    text = f"module 'cv2' has no attribute '{name}'"
    if name in _LOST:
        version = getattr(cv2, "__version__", "unknown")
        text += f": {_LOST[name].format(name=name, version=version)}"
    if imports_a_name(sys._getframe(2)):  # Python drops the text of an AttributeError there
        raise ImportError(text, name="cv2")
    raise AttributeError(text)
