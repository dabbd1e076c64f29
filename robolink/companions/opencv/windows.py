"""Stand-ins for OpenCV's functions that need a window system: programs that call them go on without one."""

from __future__ import annotations

import functools
import os
import re
import socket
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from robolink import logging
from robolink.exceptions import RobolinkError
from robolink.image.arrays import to_message
from robolink.image.encodings import ImageError
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.interfaces.std_msgs.msg import Header
from robolink.publisher import Publisher
from robolink.running.defaults import get_defaults
from robolink.running.timebase import SystemTime
from robolink.utilities import get_default_context

KEYLESS = -1
"""Return value of `waitKey` if no key was pressed in its time."""

FOR_A_KEY = 0.05
"""Time in seconds that `waitKey(0)` waits: for ever would be no going on, and not at all would be a busy loop."""

_NOTHING = (
    "addText",
    "createButton",
    "displayOverlay",
    "displayStatusBar",
    "moveWindow",
    "resizeWindow",
    "setMouseCallback",
    "setWindowProperty",
    "setWindowTitle",
    "startWindowThread",
)
"""Functions that only change how a window looks, or tell of what somebody does in it."""


class Trackbar:
    """A trackbar that nobody can move: a value within limits, and the function that is called when it is set.

    Args:
        value: The first value.
        most: The largest value; the least is 0.
        on_change: Function that is called with each new value.
    """

    def __init__(self, value: int, most: int, on_change: Callable[[int], Any] | None) -> None:
        self.least, self.most, self.on_change = 0, most, on_change
        self.value = self.clipped(value)

    def clipped(self, value: int) -> int:
        """Return the nearest value within the limits.

        Args:
            value: The requested value.
        """
        return max(self.least, min(self.most, int(value)))


class NoWindows:
    """The functions of a module cv2 that can open no windows.

    Windows have names, trackbars keep their values, no key is ever pressed, and images go to `robolink view`. One line
    in the log says so. A program that finds a display after all, which it has started itself, gets OpenCV's functions.

    Args:
        cv2: The module.
    """

    def __init__(self, cv2: ModuleType) -> None:
        self._cv2 = cv2
        self._images = ShownImages()
        self._sizes: dict[str, tuple[int, int]] = {}
        self._trackbars: dict[tuple[str, str], Trackbar] = {}
        self._is_reported = False
        self._still_none: bool | None = None

    def replace_functions(self) -> None:
        """Put these functions in the place of the module's own: of those that it has."""
        ours: dict[str, Callable[..., Any]] = {
            **dict.fromkeys(_NOTHING, self._nothing),
            **{name: getattr(self, f"_{name}") for name in _OWN},
            "waitKeyEx": self._waitKey,
        }
        for name, function in ours.items():
            theirs = getattr(self._cv2, name, None)
            if theirs is not None:
                setattr(self._cv2, name, self._chosen(name, theirs, function))

    def _chosen(self, name: str, theirs: Callable[..., Any], ours: Callable[..., Any]) -> Callable[..., Any]:
        """Return a function that decides at its call, since there may be a display by then."""

        @functools.wraps(theirs, assigned=("__name__", "__doc__"), updated=())
        def call(*args: Any, **kwargs: Any) -> Any:
            if self._still_none is None:
                self._still_none = bool(lack_of_windows(self._cv2))
            if not self._still_none:
                return theirs(*args, **kwargs)
            if name in _TELLING:
                self._tell(name)
            return ours(*args, **kwargs)

        return call

    def _tell(self, name: str) -> None:
        """Warn once, with what to do instead."""
        if self._is_reported:
            return
        self._is_reported = True
        topic = self._images.topic("WINDOW")
        instead = f"'robolink view' shows its images, on {topic}" if topic else "cv2.imwrite writes images into files"
        reason = lack_of_windows(self._cv2)
        logging.get_logger("cv2").warning(f"cv2.{name}: no windows ({reason}). The program goes on; {instead}")

    def _nothing(self, *args: Any, **kwargs: Any) -> None:
        """Do nothing."""

    # The functions, with OpenCV's names and arguments

    def _imshow(self, winname: str, mat: Any) -> None:
        image = mat.get() if hasattr(mat, "get") else mat  # a UMat
        if not getattr(image, "size", 0):
            raise self._cv2.error(f"imshow: the image for window '{winname}' is empty")
        self._sizes[winname] = (image.shape[1], image.shape[0])
        self._images.show(winname, image)

    def _namedWindow(self, winname: str, flags: int = 0) -> None:
        self._sizes.setdefault(winname, (0, 0))

    def _destroyWindow(self, winname: str) -> None:
        self._sizes.pop(winname, None)
        self._images.close(winname)
        self._trackbars = {key: bar for key, bar in self._trackbars.items() if key[1] != winname}

    def _destroyAllWindows(self) -> None:
        for name in list(self._sizes):
            self._destroyWindow(name)

    def _waitKey(self, delay: int = 0) -> int:
        self._images.show_to_newcomers()
        seconds = delay / 1000 if delay > 0 else FOR_A_KEY
        get_defaults().time.sleep(round(seconds * 1e9))
        return KEYLESS

    def _pollKey(self) -> int:
        self._images.show_to_newcomers()
        return KEYLESS

    def _getWindowProperty(self, winname: str, prop_id: int) -> float:
        return 1.0 if winname in self._sizes and prop_id == self._cv2.WND_PROP_VISIBLE else -1.0

    def _getWindowImageRect(self, winname: str) -> tuple[int, int, int, int]:
        return (0, 0, *self._sizes.get(winname, (0, 0)))

    def _selectROI(self, *args: Any, **kwargs: Any) -> tuple[int, int, int, int]:
        return (0, 0, 0, 0)  # as when it is cancelled

    def _selectROIs(self, *args: Any, **kwargs: Any) -> tuple[()]:
        return ()

    def _createTrackbar(
        self,
        trackbarName: str,
        windowName: str,
        value: int,
        count: int,
        onChange: Any = None,
    ) -> None:
        self._sizes.setdefault(windowName, (0, 0))
        self._trackbars[trackbarName, windowName] = Trackbar(value, count, onChange)

    def _getTrackbarPos(self, trackbarname: str, winname: str) -> int:
        found = self._trackbars.get((trackbarname, winname))
        return -1 if found is None else found.value

    def _setTrackbarPos(self, trackbarname: str, winname: str, pos: int) -> None:
        found = self._trackbars.get((trackbarname, winname))
        if found is None or found.clipped(pos) == found.value:
            return
        found.value = found.clipped(pos)
        if found.on_change is not None:
            found.on_change(found.value)

    def _setTrackbarMin(self, trackbarname: str, winname: str, minval: int) -> None:
        found = self._trackbars.get((trackbarname, winname))
        if found is not None:
            found.least = minval
            self._setTrackbarPos(trackbarname, winname, found.value)

    def _setTrackbarMax(self, trackbarname: str, winname: str, maxval: int) -> None:
        found = self._trackbars.get((trackbarname, winname))
        if found is not None:
            found.most = maxval
            self._setTrackbarPos(trackbarname, winname, found.value)


_OWN = (
    "createTrackbar",
    "destroyAllWindows",
    "destroyWindow",
    "getTrackbarPos",
    "getWindowImageRect",
    "getWindowProperty",
    "imshow",
    "namedWindow",
    "pollKey",
    "selectROI",
    "selectROIs",
    "setTrackbarMax",
    "setTrackbarMin",
    "setTrackbarPos",
    "waitKey",
)
"""Functions with a method above."""

_TELLING = {"imshow", "namedWindow", "createTrackbar", "setMouseCallback", "selectROI", "selectROIs"}
"""Functions that want a window to be seen; the others need none, such as `destroyAllWindows` at a program's end."""


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
    platform = re.split("[:;]", os.environ.get("QT_QPA_PLATFORM", ""))[0] if platforms else ""
    if platform not in ("", "xcb"):
        return "" if platform in platforms else f"its Qt has no platform '{platform}', which QT_QPA_PLATFORM names"
    display = os.environ.get("DISPLAY", "")
    if display:
        return "" if _answers(display) else f"nobody answers at DISPLAY={display}"
    if os.environ.get("WAYLAND_DISPLAY") and (not platforms or "wayland" in platforms):
        return ""
    return "there is no DISPLAY"


def _framework(cv2: ModuleType) -> str:
    """Return the library with which OpenCV makes its windows, such as QT; '' if it was built without windows."""
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
        if sys.platform == "win32":  # never called there, and it has no such sockets
            return True
        with socket.socket(socket.AF_UNIX) as link:
            link.settimeout(PATIENCE)
            link.connect(address)
            return True
    except OSError:
        return False


class ShownImages:
    """The images of a program's windows, each on a topic ``/NODE/imshow/WINDOW`` of its first node.

    They are sent while somebody listens only. In virtual time there are no topics: whether a machine has a screen must
    not change what a simulation publishes.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._publishers: dict[str, tuple[Any, Publisher[Image]]] = {}
        self._unseen: dict[str, Any] = {}

    def topic(self, window: str) -> str:
        """Return the topic of a window; '' if the program has no node yet, or runs in virtual time.

        Args:
            window: The topic's last word.
        """
        node = _first_node()
        return "" if node is None else f"{node.get_fully_qualified_name()}/imshow/{window}"

    def show(self, window: str, image: Any) -> None:
        """Send an image, or keep it for who comes later.

        Args:
            window: Name of the window.
            image: Array of (rows, columns) or (rows, columns, channels).
        """
        with self._lock:
            publisher = self._publisher(window)
            if publisher is None or not publisher.get_subscription_count():
                self._unseen[window] = image
                return
            self._unseen.pop(window, None)
            self._send(publisher, image)

    def show_to_newcomers(self) -> None:
        """Send the images that nobody has seen yet, if somebody listens now."""
        for window, image in list(self._unseen.items()):
            self.show(window, image)

    def close(self, window: str) -> None:
        """Forget a window and its topic.

        Args:
            window: Name of the window.
        """
        with self._lock:
            self._unseen.pop(window, None)
            node, publisher = self._publishers.pop(window, (None, None))
            if node is not None and publisher is not None:
                node.destroy_publisher(publisher)

    def _publisher(self, window: str) -> Publisher[Image] | None:
        node = _first_node()
        owner, found = self._publishers.get(window, (None, None))
        if node is None or owner is node:
            return found if node is not None else None
        try:
            made: Publisher[Image] = node.create_publisher(Image, self._free_topic(window), 1)
        except RobolinkError:  # its context ends just now, or it may not publish there
            return None
        self._publishers[window] = (node, made)
        return made

    def _free_topic(self, window: str) -> str:
        """Return a topic's name for a window, whose name may be any text, that no other window has."""
        name = re.sub(r"[^A-Za-z0-9]+", "_", window).strip("_") or "window"
        name = f"window_{name}" if name[0].isdigit() else name
        taken = {each.topic_name.rpartition("/")[2] for _, each in self._publishers.values()}
        names = (name if number == 1 else f"{name}_{number}" for number in range(1, len(taken) + 2))
        return f"~/imshow/{next(each for each in names if each not in taken)}"

    @staticmethod
    def _send(publisher: Publisher[Image], image: Any) -> None:
        node = _first_node()
        stamp = node.get_clock().now().to_msg() if node is not None else None
        try:
            publisher.publish(to_message(_shades(image), "", Header() if stamp is None else Header(stamp=stamp)))
        except RobolinkError:  # an image that no topic takes, or the end of the context: a window shows nothing either
            return


def _first_node() -> Any:
    """Return the program's first node, None if it has none or runs in virtual time."""
    context = get_default_context()
    if not context.ok() or not isinstance(context.time, SystemTime):
        return None
    return next(iter(context.nodes), None)


def _shades(image: Any) -> Any:
    """Return an image as imshow shows it, in 8 bits: floats from 0 to 1 are black to white, 16 bits lose the lower 8.

    Raises ImageError for numbers that imshow does not show.
    """
    if image.dtype == np.uint8:
        return image
    if image.dtype == np.uint16:
        return (image >> 8).astype(np.uint8)
    if image.dtype == np.int8:
        return (image.astype(np.int16) + 128).astype(np.uint8)
    if image.dtype.kind == "f":
        return np.clip(np.nan_to_num(image) * 255.0, 0.0, 255.0).round().astype(np.uint8)
    raise ImageError(f"imshow shows no images of {image.dtype}")
