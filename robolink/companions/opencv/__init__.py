"""OpenCV in programs that robolink runs: they go on without a window system, and learn where names have gone."""

from __future__ import annotations

from types import ModuleType

from robolink.companions.opencv.lost_names import advise
from robolink.companions.opencv.window_system import lack_of_windows
from robolink.companions.opencv.windows import NoWindows


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
