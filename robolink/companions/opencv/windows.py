"""Stand-ins for OpenCV's functions that need a window system: programs that call them go on without one."""

from __future__ import annotations

import functools
from collections.abc import Callable
from types import ModuleType
from typing import Any

from robolink import logging
from robolink.companions.opencv.shown_images import ShownImages
from robolink.companions.opencv.window_system import lack_of_windows
from robolink.running.defaults import get_defaults

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
            value: The wanted value.
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
        self._is_told = False
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
        if self._is_told:
            return
        self._is_told = True
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
