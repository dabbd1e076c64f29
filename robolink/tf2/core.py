"""The buffer of transforms between frames: what tf2_py offers, for any thread."""

from __future__ import annotations

import math
import threading
from typing import Any

from robolink.constants import S_TO_NS
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.logging import get_logger
from robolink.tf2 import listing
from robolink.tf2.cache import LATEST
from robolink.tf2.exceptions import TransformException
from robolink.tf2.rigid import Rigid, compose, signed
from robolink.tf2.tree import Tree
from robolink.tf2.velocity import Velocity, velocity_of
from robolink.time import Time

CACHE_TIME = 10 * S_TO_NS
"""Nanoseconds for which transforms are kept."""

LOGGER = "tf2_buffer"

MOST_COMPLAINTS = 1000
"""Kinds of refused transforms that are counted."""

ROLES = ("target", "source", "fixed")


class BufferCore:
    """Transforms of the last `cache_time`, ten seconds by default; static ones for ever.

    Times are given as `Time`, as `builtin_interfaces/msg/Time`, or as anything with `nanoseconds`; zero is the
    latest time at which all transforms of the chain are known. All methods may be called from any thread.
    """

    def __init__(self, cache_time: Any = None) -> None:
        self._tree = Tree(CACHE_TIME if cache_time is None else nanoseconds(cache_time, "a duration"))
        self._authorities: dict[str, str] = {}
        self._refused: dict[tuple[str, str], int] = {}
        self._lock = threading.RLock()

    # What comes in

    def set_transform(self, transform: Any, authority: str) -> None:
        """Remember a TransformStamped; `authority` is who says so. One that cannot be is warned about and ignored.

        Raises TypeError for an object of another form.
        """
        self._set(transform, authority, static=False)

    def set_transform_static(self, transform: Any, authority: str) -> None:
        """Remember a TransformStamped that holds at every time; see `set_transform`."""
        self._set(transform, authority, static=True)

    def _set(self, given: Any, authority: str, *, static: bool) -> bool:
        """Take it in; whether it was taken."""
        try:
            parent, child = given.header.frame_id.removeprefix("/"), given.child_frame_id.removeprefix("/")
            stamp = nanoseconds(given.header.stamp)
            place, turn = given.transform.translation, given.transform.rotation
            rigid: Rigid = (place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w)
            with self._lock:
                wrong = self._tree.insert(parent, child, stamp, rigid, static=static)
                if wrong is None:
                    self._authorities[child] = authority
        except (AttributeError, TypeError) as error:
            raise TypeError(f"expected a TransformStamped, got {given!r:.100}: {error}") from None
        if wrong is not None:
            self._complain(wrong, parent, child, authority)
        return wrong is None

    def _complain(self, wrong: tuple[str, str], parent: str, child: str, authority: str) -> None:
        """Warn of the first, tenth, hundredth ... transform of a frame that is refused for the same reason."""
        what, why = wrong
        with self._lock:
            count = self._refused.pop((what, child), 0) + 1
            if len(self._refused) < MOST_COMPLAINTS:
                self._refused[what, child] = count
        if math.log10(count).is_integer():
            told = f"{count} of them so far" if count > 1 else "the next ones are only counted"
            get_logger(LOGGER).warning(
                f"{what}: ignored the transform from '{parent}' to '{child}' of '{authority}': {why} ({told})"
            )

    def clear(self) -> None:
        """Forget all transforms but the static ones; the frames stay known."""
        with self._lock:
            self._tree.clear()

    # What is asked

    def lookup_transform_core(self, target_frame: str, source_frame: str, time: Any) -> TransformStamped:
        """Give the transform that takes what is given in `source_frame` to `target_frame`.

        Raises LookupException, ConnectivityException, ExtrapolationException or InvalidArgumentException.
        """
        return _message(target_frame, source_frame, *self._lookup(target_frame, source_frame, nanoseconds(time)))

    def lookup_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> TransformStamped:
        """Give the transform from `source_frame` at one time to `target_frame` at another.

        `fixed_frame` is what stands still between the two times. Raises what `lookup_transform_core` raises.
        """
        with self._lock:
            self._check_all("lookupTransform", target_frame, source_frame, fixed_frame)
            there, _ = self._lookup(fixed_frame, source_frame, nanoseconds(source_time))
            here, stamp = self._lookup(target_frame, fixed_frame, nanoseconds(target_time))
        return _message(target_frame, source_frame, signed(compose(here, there)), stamp)

    def can_transform_core(self, target_frame: str, source_frame: str, time: Any) -> tuple[bool, str]:
        """Say whether `lookup_transform_core` would succeed now, and if not, why."""
        try:
            with self._lock:
                self._tree.path(target_frame, source_frame, nanoseconds(time), "canTransform argument")
        except TransformException as error:
            return False, str(error)
        return True, ""

    def can_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> tuple[bool, str]:
        """Say whether `lookup_transform_full_core` would succeed now, and if not, why."""
        try:
            with self._lock:
                self._check_all("canTransform", target_frame, source_frame, fixed_frame)
        except TransformException as error:
            return False, str(error)
        can, why = self.can_transform_core(target_frame, fixed_frame, target_time)
        return self.can_transform_core(fixed_frame, source_frame, source_time) if can else (can, why)

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """Give the latest time at which the whole chain is known; zero where all of it is static.

        Raises what `lookup_transform_core` raises.
        """
        with self._lock:
            self._check_all("get_latest_common_time", target_frame, source_frame)
            return Time(nanoseconds=self._tree.path(target_frame, source_frame, LATEST, "get_latest_common_time")[1])

    def _is_gone(self, target: str, source: str, time: Any) -> bool:
        """Whether data of that time would be refused now as too old, by every transform of the chain."""
        try:
            with self._lock:
                latest = self._tree.path(target, source, LATEST, "is_gone argument")[1]
        except TransformException:
            return False
        return LATEST != nanoseconds(time) < latest - self._tree.keep

    def _lookup(self, target: str, source: str, time: int) -> tuple[Rigid, int]:
        with self._lock:
            return self._tree.transform(target, source, time, "lookupTransform argument")

    def _check_all(self, asker: str, *frames: str) -> None:
        for role, frame in zip(ROLES, frames, strict=False):
            self._tree.check(frame, f"{asker} argument {role}_frame")

    # Velocities

    def lookupVelocityCore(  # noqa: N802 - tf2's name
        self, tracking_frame: str, observation_frame: str, time: Any, averaging_interval: Any
    ) -> Velocity:
        """Give how `tracking_frame` moves in `observation_frame`: m/s and rad/s, mean values over an interval."""
        return self.lookupVelocityFullCore(
            tracking_frame, observation_frame, observation_frame, (0, 0, 0), tracking_frame, time, averaging_interval
        )

    def lookupVelocityFullCore(  # noqa: N802 - tf2's name
        self,
        tracking_frame: str,
        observation_frame: str,
        reference_frame: str,
        reference_point: tuple[float, float, float],
        reference_point_frame: str,
        time: Any,
        averaging_interval: Any,
    ) -> Velocity:
        """Give that velocity along the axes of another frame and at another point than the frame's origin."""
        latest = self.get_latest_common_time(observation_frame, tracking_frame).nanoseconds
        frames = tracking_frame, observation_frame, reference_frame, reference_point_frame
        spans = nanoseconds(time), nanoseconds(averaging_interval, "a duration"), latest
        return velocity_of(lambda *asked: self._lookup(*asked)[0], frames, reference_point, spans)

    # All of it

    def all_frames_as_yaml(self) -> str:
        """Give each frame with its parent, who says so, how often, and from when to when, as YAML."""
        return listing.as_yaml(self._known())

    def all_frames_as_string(self) -> str:
        """Give a line for each frame that says which parent it has."""
        with self._lock:
            return listing.as_text(self._tree.caches)

    def get_all_frame_names(self) -> list[str]:
        """Give the names of all frames that were ever heard of."""
        with self._lock:
            return list(self._tree.caches)

    _getFrameStrings = get_all_frame_names  # noqa: N815 - tf2's name

    def _frameExists(self, frame_id_str: str) -> bool:  # noqa: N802 - tf2's name
        return frame_id_str in self._tree.caches

    def _allFramesAsDot(self, time: Any = None) -> str:  # noqa: N802 - tf2's name
        return listing.as_dot(self._known(), None if time is None else nanoseconds(time))

    def _known(self) -> list[listing.Frame]:
        with self._lock:
            return listing.known(self._tree.caches, self._authorities)

    def _chain(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> list[str]:
        """Give the frames on the way from source to target, by way of the fixed frame."""
        names = [source_frame]
        ways = ((fixed_frame, source_frame, source_time), (target_frame, fixed_frame, target_time))
        for target, source, time in ways:
            with self._lock:
                names += self._tree.chain(target, source, nanoseconds(time), "chain argument")[1:]
        return names


def nanoseconds(span: Any, what: str = "time") -> int:
    """Read a Time, a Duration or the message of either. Raises TypeError for anything else."""
    try:
        if hasattr(span, "nanoseconds"):
            return int(span.nanoseconds)
        return int(span.sec) * S_TO_NS + int(span.nanosec)
    except AttributeError:
        raise TypeError(f"{what} must have sec and nanosec, or nanoseconds; got {span!r:.60}") from None


def _message(target: str, source: str, rigid: Rigid, stamp: int) -> TransformStamped:
    message = TransformStamped()
    message.child_frame_id = source
    header, transform = message.header, message.transform
    header.frame_id = target
    header.stamp.sec, header.stamp.nanosec = divmod(stamp, S_TO_NS)
    place, turn = transform.translation, transform.rotation
    place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w = rigid
    return message
