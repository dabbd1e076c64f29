"""Thread-safe buffer of transforms between frames: the API of ROS 2's tf2_py."""

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
from robolink.tf2.rigid import Rigid, Velocity, compose, signed, velocity_of
from robolink.tf2.tree import Tree
from robolink.time import Time

CACHE_TIME = 10 * S_TO_NS
"""Default time for which transforms are kept, in ns."""

LOGGER = "tf2_buffer"
"""Name of the logger of all buffers."""

MOST_COMPLAINTS = 1000
"""Upper bound of the kinds of refused transforms that are counted."""

ROLES = ("target", "source", "fixed")
"""Names of the frame arguments of a look-up, in their order."""


class BufferCore:
    """Transforms of the last seconds, by frame; static ones for ever.

    Times are `Time`, `builtin_interfaces/msg/Time`, or any object with `nanoseconds`; zero means the latest time at
    which the whole chain is known. All methods may be called from any thread.

    Args:
        cache_time: Duration for which transforms are kept; 10 s by default.

    Raises:
        TypeError: if `cache_time` is not a duration.
    """

    def __init__(self, cache_time: Any = None) -> None:
        self._tree = Tree(CACHE_TIME if cache_time is None else nanoseconds(cache_time, "a duration"))
        self._authorities: dict[str, str] = {}
        self._refused: dict[tuple[str, str], int] = {}
        self._lock = threading.RLock()

    # Input

    def set_transform(self, transform: Any, authority: str) -> None:
        """Insert a transform. An invalid one (no frame, a loop, not a number, too old) is ignored with a warning.

        Args:
            transform: A TransformStamped.
            authority: Name of its source, for warnings and lists of frames.

        Raises:
            TypeError: if `transform` is not a TransformStamped.
        """
        self._set(transform, authority, static=False)

    def set_transform_static(self, transform: Any, authority: str) -> None:
        """Insert a transform that holds at every time. An invalid one is ignored with a warning.

        Args:
            transform: A TransformStamped.
            authority: Name of its source, for warnings and lists of frames.

        Raises:
            TypeError: if `transform` is not a TransformStamped.
        """
        self._set(transform, authority, static=True)

    def _set(self, given: Any, authority: str, *, static: bool) -> bool:
        """Insert a transform; True if it was valid."""
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
            reported = f"{count} of them so far" if count > 1 else "the next ones are only counted"
            get_logger(LOGGER).warning(
                f"{what}: ignored the transform from '{parent}' to '{child}' of '{authority}': {why} ({reported})"
            )

    def clear(self) -> None:
        """Remove all transforms but the static ones; the frames stay known."""
        with self._lock:
            self._tree.clear()

    # Queries

    def lookup_transform_core(self, target_frame: str, source_frame: str, time: Any) -> TransformStamped:
        """Return the transform that takes coordinates in `source_frame` to `target_frame`, without waiting.

        Args:
            target_frame: Name of the frame to which data are transformed.
            source_frame: Name of the frame in which data are given.
            time: Time of the transform; zero means the latest.

        Raises:
            LookupException: if a frame is unknown.
            ConnectivityException: if no chain of transforms connects the frames.
            ExtrapolationException: if the buffer has no data at this time.
            InvalidArgumentException: if a name is empty or begins with a slash.
            TypeError: if `time` is of another type.
        """
        return _message(target_frame, source_frame, *self._lookup(target_frame, source_frame, nanoseconds(time)))

    def lookup_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> TransformStamped:
        """Return the transform from `source_frame` at one time to `target_frame` at another, without waiting.

        Args:
            target_frame: Name of the frame to which data are transformed.
            target_time: Time at which the target frame is taken; zero means the latest.
            source_frame: Name of the frame in which data are given.
            source_time: Time at which the source frame is taken; zero means the latest.
            fixed_frame: Name of a frame that does not move between the two times.

        Raises:
            TransformException: any of `lookup_transform_core`.
            TypeError: if a time is of another type.
        """
        with self._lock:
            self._check_all("lookupTransform", target_frame, source_frame, fixed_frame)
            there, _ = self._lookup(fixed_frame, source_frame, nanoseconds(source_time))
            here, stamp = self._lookup(target_frame, fixed_frame, nanoseconds(target_time))
        return _message(target_frame, source_frame, signed(compose(here, there)), stamp)

    def can_transform_core(self, target_frame: str, source_frame: str, time: Any) -> tuple[bool, str]:
        """Return if `lookup_transform_core` would succeed now, and the reason why not.

        Args:
            target_frame: Name of the frame to which data are transformed.
            source_frame: Name of the frame in which data are given.
            time: Time of the transform; zero means the latest.

        Returns:
            True and '', or False and the reason.
        """
        try:
            with self._lock:
                self._tree.path(target_frame, source_frame, nanoseconds(time), "canTransform argument")
        except TransformException as error:
            return False, str(error)
        return True, ""

    def can_transform_full_core(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> tuple[bool, str]:
        """Return if `lookup_transform_full_core` would succeed now, and the reason why not.

        Args:
            target_frame: Name of the frame to which data are transformed.
            target_time: Time at which the target frame is taken; zero means the latest.
            source_frame: Name of the frame in which data are given.
            source_time: Time at which the source frame is taken; zero means the latest.
            fixed_frame: Name of a frame that does not move between the two times.

        Returns:
            True and '', or False and the reason.
        """
        try:
            with self._lock:
                self._check_all("canTransform", target_frame, source_frame, fixed_frame)
        except TransformException as error:
            return False, str(error)
        can, why = self.can_transform_core(target_frame, fixed_frame, target_time)
        return self.can_transform_core(fixed_frame, source_frame, source_time) if can else (can, why)

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """Return the latest time at which the whole chain between two frames is known; zero if all of it is static.

        Args:
            target_frame: Name of one frame.
            source_frame: Name of the other.

        Raises:
            TransformException: any of `lookup_transform_core`.
        """
        with self._lock:
            self._check_all("get_latest_common_time", target_frame, source_frame)
            return Time(nanoseconds=self._tree.path(target_frame, source_frame, LATEST, "get_latest_common_time")[1])

    def _is_gone(self, target: str, source: str, time: Any) -> bool:
        """True if data of that time would be refused now as too old, by every transform of the chain."""
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
        """Return the mean velocity of a frame's origin in another frame.

        Args:
            tracking_frame: Name of the frame that moves.
            observation_frame: Name of the frame in which it moves, and along whose axes the velocity is given.
            time: Middle of the interval; zero means the latest.
            averaging_interval: Duration over which the mean is taken.

        Returns:
            Linear velocity in m/s and angular velocity in rad/s, each a tuple of x, y, z.

        Raises:
            InvalidArgumentException: if the interval holds no two known times.
            TransformException: any of `lookup_transform_core`.
        """
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
        """Return the mean velocity of a point that is fixed to a moving frame.

        Args:
            tracking_frame: Name of the frame that moves.
            observation_frame: Name of the frame in which it moves.
            reference_frame: Name of the frame along whose axes the velocity is given.
            reference_point: Coordinates x, y, z in m of the point, in `reference_point_frame`.
            reference_point_frame: Name of the frame of the point's coordinates.
            time: Middle of the interval; zero means the latest.
            averaging_interval: Duration over which the mean is taken.

        Returns:
            Linear velocity in m/s and angular velocity in rad/s, each a tuple of x, y, z.

        Raises:
            InvalidArgumentException: if the interval holds no two known times.
            TransformException: any of `lookup_transform_core`.
        """
        latest = self.get_latest_common_time(observation_frame, tracking_frame).nanoseconds
        frames = tracking_frame, observation_frame, reference_frame, reference_point_frame
        spans = nanoseconds(time), nanoseconds(averaging_interval, "a duration"), latest
        return velocity_of(lambda *requested: self._lookup(*requested)[0], frames, reference_point, spans)

    # All of it

    def all_frames_as_yaml(self) -> str:
        """Return all frames as YAML: parent, authority, rate, first and last time."""
        return listing.as_yaml(self._known())

    def all_frames_as_string(self) -> str:
        """Return a line for each frame with its parent."""
        with self._lock:
            return listing.as_text(self._tree.caches)

    def get_all_frame_names(self) -> list[str]:
        """Return the names of all frames that were ever seen."""
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
        """Return the frames on the way from source to target, by way of the fixed frame."""
        names = [source_frame]
        ways = ((fixed_frame, source_frame, source_time), (target_frame, fixed_frame, target_time))
        for target, source, time in ways:
            with self._lock:
                names += self._tree.chain(target, source, nanoseconds(time), "chain argument")[1:]
        return names


def nanoseconds(span: Any, what: str = "time") -> int:
    """Return a Time, a Duration or the message of either in ns; `what` names it in errors. Raises TypeError else."""
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
