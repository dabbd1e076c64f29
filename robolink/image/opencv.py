"""Late import of OpenCV, for what numpy alone does not do: JPEG and other files, Bayer patterns, YUV, colour maps."""

from __future__ import annotations

import importlib
import re
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

from robolink.image.encodings import ImageError

OLDEST = (4, 8)
"""First version of OpenCV that robolink is made for."""

_INSTALL = "pip install opencv-python"


def opencv(purpose: str) -> Any:
    """Return the module cv2.

    Args:
        purpose: What it is for, as the subject of a sentence: "JPEG".

    Raises:
        ImageError: if OpenCV is not installed, cannot be loaded, or is too old; the text tells what to install.
    """
    try:
        cv2 = importlib.import_module("cv2")
    except ModuleNotFoundError as error:
        if error.name != "cv2":
            raise _unloadable(purpose, error) from None
        raise ImageError(f"{purpose} needs OpenCV, which is not installed: {_INSTALL}") from None
    except (ImportError, AttributeError) as error:  # the second: one that was built for another numpy
        raise _unloadable(purpose, error) from None
    version = str(getattr(cv2, "__version__", ""))
    if tuple(int(each) for each in re.findall(r"\d+", version)[:2]) < OLDEST:
        raise ImageError(f"{purpose} needs OpenCV 4.8 to 5, and {version or 'some other cv2'} is installed: {_INSTALL}")
    return cv2


def lacking(error: BaseException) -> ImageError | None:
    """Return the error that tells what to install, if `error` is a program's failed import of OpenCV; else None."""
    if not isinstance(error, ImportError):
        return None
    frames = [each for each, _ in traceback.walk_tb(error.__traceback__)]
    modules = [each.f_globals.get("__name__", "") for each in frames]
    others = ("robolink.", "runpy", "importlib", "cv2")
    files = [each.f_code.co_filename for each, name in zip(frames, modules, strict=True) if not name.startswith(others)]
    program = Path(files[-1]).name if files else "this program"
    if error.name is None and modules and _is_of_opencv(modules[-1]):  # it is for another numpy, which says so again
        return _unloadable(program, error)
    if not _is_of_opencv(error.name or ""):
        return None
    try:
        opencv(program)
    except ImageError as reason:
        return reason
    return None


def _is_of_opencv(module: str) -> bool:
    return module.partition(".")[0] == "cv2"


def _unloadable(purpose: str, error: Exception) -> ImageError:
    reason = " ".join(str(error).split())[:200]
    return ImageError(
        f"{purpose} needs OpenCV, which is installed but cannot be loaded ({reason}):"
        " pip uninstall opencv-python, then pip install -U opencv-python-headless"
    )


def call(purpose: str, function: Callable[..., Any], *args: Any) -> Any:
    """Return the result of a function of OpenCV. Raises ImageError, in one line, for what it refuses.

    Args:
        purpose: What is done, as the end of a sentence: "decode the image".
        function: The function.
        args: Its arguments.
    """
    try:
        return function(*args)
    except Exception as error:
        if type(error).__name__ != "error":  # cv2.error, whichever cv2 that is
            raise
        reason = " ".join(str(getattr(error, "err", "") or error).split())[:200]
        raise ImageError(f"OpenCV could not {purpose}: {reason}") from None
