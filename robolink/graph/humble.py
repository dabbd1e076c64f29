"""Humble's dialect of the wire: where the others put a type's hash, it says that there is none.

A topic therefore has two keys, the one with the hash and Humble's. An end that sees a Humble peer at the other end
uses both keys from then on, and stays with both, since who came once may come again. Where two such ends meet, each
message comes twice, with the same attachment.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import NamedTuple

from robolink.exceptions import RobolinkError, nearest
from robolink.transport.base import Sample
from robolink.wire import NO_HASH, EndpointToken, gid_in, is_attachment

VARIABLE = "ROBOLINK_ROS_DISTRO"
DISTROS = ("humble", "iron", "jazzy", "kilted", "lyrical", "rolling")

MOST_REMEMBERED = 4096
"""Number of messages back among which a copy is recognized."""


class DistroError(RobolinkError, ValueError):
    """ROBOLINK_ROS_DISTRO is none of ROS 2's distributions."""


def is_requested(environ: Mapping[str, str]) -> bool:
    """True if ROBOLINK_ROS_DISTRO asks for Humble's dialect throughout. Raises DistroError for an unknown one."""
    requested = environ.get(VARIABLE, "").strip().lower()
    if requested and requested not in DISTROS:
        raise DistroError(
            f"{VARIABLE}: no distribution '{requested[:80]}'{nearest(requested, DISTROS)}: {', '.join(DISTROS)}"
        )
    return requested == "humble"


class FromHumbleKey(NamedTuple):
    """Sample that arrived on a topic's Humble key."""

    sample: Sample

    @property
    def attachment(self) -> bytes:
        """Attachment of the sample."""
        return self.sample.attachment


class CopyError(RobolinkError):
    """A message has been, or will be, received on the topic's other key."""


class Copies:
    """Filter of duplicates: recognizes the messages that come on two keys, so that each is taken once."""

    def __init__(self, endpoint_of: Callable[[bytes], EndpointToken | None]) -> None:
        self._endpoint_of = endpoint_of
        self._seen: dict[bytes, None] = {}
        self._lock = threading.Lock()  # callbacks of a reentrant group run side by side

    def comes_twice(self, attachment: bytes) -> bool:
        """True if a message of Humble's key comes to the other key too, as far as its sender is known."""
        if not is_attachment(attachment):
            return False
        sender = self._endpoint_of(gid_in(attachment))
        return sender is not None and sender.type_hash != NO_HASH

    def check(self, attachment: bytes) -> None:
        """Raise CopyError for a message that was here before: then its sender was not known yet."""
        with self._lock:
            if attachment in self._seen:
                raise CopyError
            self._seen[attachment] = None
            if len(self._seen) > MOST_REMEMBERED:
                del self._seen[next(iter(self._seen))]
