"""OpenCV in programs that robolink runs: they go on without a window system, and learn where names have gone."""

from __future__ import annotations

import functools
import sys
from types import ModuleType
from typing import NoReturn

from robolink.companions.opencv.windows import NoWindows, lack_of_windows
from robolink.text.suggestions import imports_a_name


def prepare(cv2: ModuleType) -> None:
    """Prepare the module cv2, which has just been imported, for a program.

    Where windows work, its functions stay as they are. Elsewhere those that need windows do without. Names that
    OpenCV has no more get an AttributeError that tells what to do.

    Args:
        cv2: The module.
    """
    if lack_of_windows(cv2):
        NoWindows(cv2).replace_functions()
    advise(cv2)


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
"""Advice by name in cv2."""

_SINCE_4_7 = (
    "OpenCV has it no more since 4.7, and this is {version}: write {instead}, or run the program with"
    " pip install 'opencv-contrib-python<4.7' 'numpy<2'"
)
_ARUCO = {
    "CharucoBoard_create": "cv2.aruco.CharucoBoard((columns, rows), ...)",
    "DetectorParameters_create": "cv2.aruco.DetectorParameters()",
    "Dictionary_get": "cv2.aruco.getPredefinedDictionary(...)",
    "GridBoard_create": "cv2.aruco.GridBoard((columns, rows), ...)",
    "detectMarkers": "cv2.aruco.ArucoDetector(dictionary, parameters).detectMarkers(image)",
    "drawAxis": "cv2.drawFrameAxes(...)",
    "drawMarker": "cv2.aruco.generateImageMarker(...)",
    "estimatePoseSingleMarkers": "cv2.solvePnP(..., flags=cv2.SOLVEPNP_IPPE_SQUARE) for each marker",
    "interpolateCornersCharuco": "cv2.aruco.CharucoDetector(board).detectBoard(image)",
}
"""Names of today by name in cv2.aruco."""


def advise(cv2: ModuleType) -> None:
    """Let the module cv2, and its part cv2.aruco, answer for names that they had once.

    Args:
        cv2: The module.
    """
    for module in (cv2, getattr(cv2, "aruco", None)):
        if module is not None and "__getattr__" not in vars(module):
            version = getattr(cv2, "__version__", "unknown")
            module.__getattr__ = functools.partial(lost_name, module, version)  # type: ignore[method-assign]


def lost_name(module: ModuleType, version: str, name: str) -> NoReturn:
    """Raise an error for a name that cv2 or cv2.aruco lacks, with advice if it had it once.

    To be the module's `__getattr__` itself, since it looks at who called that.

    Args:
        module: The module.
        version: OpenCV's version.
        name: The name that was looked up.

    Raises:
        AttributeError: always; ImportError in `from cv2 import NAME`.
    """
    full = module.__name__
    text = f"module '{full}' has no attribute '{name}'"
    if full == "cv2" and name in _LOST:
        text += f": {_LOST[name].format(name=name, version=version)}"
    elif full.endswith("aruco") and name in _ARUCO:
        text += f": {_SINCE_4_7.format(version=version, instead=_ARUCO[name])}"
    if imports_a_name(sys._getframe(1)):  # Python drops the text of an AttributeError there
        raise ImportError(text, name=full)
    raise AttributeError(text)
