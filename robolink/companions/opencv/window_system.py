"""Window systems: whether OpenCV can open a window here, asked without opening one."""

from __future__ import annotations

import os
import re
import socket
import sys
from pathlib import Path
from types import ModuleType

PATIENCE = 2.0
"""Longest wait for an X server on another machine, in seconds."""

_X_PORT = 6000
"""TCP port of the first display of an X server."""


def lack_of_windows(cv2: ModuleType) -> str:
    """Return why OpenCV cannot open windows here, as a clause; '' if it can, or if that is not known.

    Args:
        cv2: The module cv2.
    """
    framework = _framework(cv2)
    if not framework:
        return "opencv-python-headless has none"
    if sys.platform in ("win32", "darwin"):
        return ""
    platforms = _bundled_platforms(cv2)
    asked = re.split("[:;]", os.environ.get("QT_QPA_PLATFORM", ""))[0] if platforms else ""
    if asked not in ("", "xcb"):
        return "" if asked in platforms else f"its Qt has no platform '{asked}', which QT_QPA_PLATFORM names"
    display = os.environ.get("DISPLAY", "")
    if display:
        return "" if _answers(display) else f"nobody answers at DISPLAY={display}"
    if os.environ.get("WAYLAND_DISPLAY") and (not platforms or "wayland" in platforms):
        return ""
    return "there is no DISPLAY"


def _framework(cv2: ModuleType) -> str:
    """Return what OpenCV makes its windows with, such as QT; '' if it was built without windows."""
    ask = getattr(cv2, "currentUIFramework", None)
    if ask is not None:
        return str(ask())
    found = re.search(r"GUI:\s+(\w+)", cv2.getBuildInformation())  # before OpenCV 4.6
    return "" if found is None or found[1] == "NONE" else found[1]


def _bundled_platforms(cv2: ModuleType) -> set[str]:
    """Return the names of the platforms of the Qt that pip's package brings: xcb; none if it is the system's Qt."""
    folder = Path(cv2.__file__ or "").parent / "qt" / "plugins" / "platforms"
    return {each.stem.removeprefix("libq") for each in folder.glob("libq*.so")}


def _answers(display: str) -> bool:
    """Return False if it is certain that no X server listens at a display such as ``:0`` or ``host:10.0``."""
    found = re.fullmatch(r"(?:\w+/)?(?P<host>[^:/]*):(?P<number>\d{1,4})(?:\.\d+)?", display)
    if found is None:
        return True
    host, number = found["host"], int(found["number"])
    if host in ("", "unix"):
        path = f"/tmp/.X11-unix/X{number}"
        return _connects(f"\0{path}") or _connects(path)
    return _connects((host, _X_PORT + number))


def _connects(address: str | tuple[str, int]) -> bool:
    """Return True if a server accepts a connection at a path or at a host and port."""
    try:
        if isinstance(address, tuple):
            socket.create_connection(address, PATIENCE).close()
            return True
        if sys.platform == "win32":  # never asked there, and it has no such sockets
            return True
        with socket.socket(socket.AF_UNIX) as link:
            link.settimeout(PATIENCE)
            link.connect(address)
            return True
    except OSError:
        return False
