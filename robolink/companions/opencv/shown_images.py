"""Topics of the images that a program shows in windows, where there are none: `robolink view` lists them."""

from __future__ import annotations

import re
import threading
from typing import Any

import numpy as np

from robolink.exceptions import RobolinkError
from robolink.image.arrays import to_message
from robolink.image.encodings import ImageError
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.interfaces.std_msgs.msg import Header
from robolink.publisher import Publisher
from robolink.running.timebase import SystemTime
from robolink.utilities import get_default_context


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
