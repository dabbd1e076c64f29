"""Transform buffer of a node: a BufferCore that can wait, serves its frames, and is cleared when time goes back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robolink.clock import Clock, ClockChange, JumpHandle, JumpThreshold, TimeJump
from robolink.duration import Duration
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.tf2_msgs.srv import FrameGraph
from robolink.logging import get_logger
from robolink.task import Future
from robolink.tf2.buffer_interface import BufferInterface
from robolink.tf2.core import LOGGER, BufferCore, nanoseconds
from robolink.tf2.waiting import PendingLookup, Source, Waits

if TYPE_CHECKING:
    from robolink.node import Node


class Buffer(BufferCore, BufferInterface):
    """Transform buffer: the transforms of the last seconds, by frame. A TransformListener fills it.

    When the clock of its node, or of a listener's, jumps back by more than 1 s or changes its source, all but the
    static transforms are removed. All methods may be called from any thread.

    Times are `Time` or `builtin_interfaces/msg/Time`; zero means the latest time at which the whole chain of transforms
    is known.

    Args:
        cache_time: Duration for which transforms are kept; 10 s by default. Static ones are kept for ever.
        node: Node that offers the service ``tf2_frames`` with all frames as YAML, and whose clock is watched. Without
            it there is no service.

    Raises:
        TypeError: if `cache_time` is not a duration.
    """

    def __init__(self, cache_time: Duration | None = None, node: Node | None = None) -> None:
        BufferCore.__init__(self, cache_time)
        BufferInterface.__init__(self)
        self._waits = Waits()
        self._watched: dict[Clock, JumpHandle] = {}
        self.clock = Clock() if node is None else node.get_clock()
        self._watch(self.clock)
        self.jump_handle = self._watched[self.clock]
        if node is not None:
            self.srv = node.create_service(FrameGraph, "tf2_frames", self._on_frames_requested)

    def _on_frames_requested(self, request: FrameGraph.Request, response: FrameGraph.Response) -> FrameGraph.Response:
        response.frame_yaml = self.all_frames_as_yaml()
        return response

    def _watch(self, clock: Clock) -> None:
        if clock not in self._watched:
            back = JumpThreshold(min_forward=None, min_backward=Duration(seconds=-1), on_clock_change=True)
            self._watched[clock] = clock.create_jump_callback(back, post_callback=self.time_jump_callback)

    def time_jump_callback(self, time_jump: TimeJump) -> None:
        """Remove all but the static transforms, since their stamps are of another time; `time_jump` is ignored."""
        changed = time_jump.clock_change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED)
        what = "The clock has another source now." if changed else "Detected jump back in time."
        get_logger(LOGGER).warning(f"{what} Clearing tf buffer.")
        self.clear()

    # Input

    def add_source(self, listener: Source) -> None:
        """Register a `listener` that fills this buffer: it goes on during a wait, and its clock is watched."""
        self._waits.sources.add(listener)
        self._watch(listener.node.get_clock())

    def remove_source(self, listener: Source) -> None:
        """Unregister a `listener`."""
        sources, clock = self._waits.sources, listener.node.get_clock()
        sources.discard(listener)
        if clock is not self.clock and all(each.node.get_clock() is not clock for each in sources):
            self._watched.pop(clock).unregister()

    def _set(self, given: Any, authority: str, *, static: bool) -> bool:
        taken = super()._set(given, authority, static=static)
        if taken:
            self._waits.notify()
        return taken

    # At once, or within a timeout

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration = Duration(),  # noqa: B008 - tf2's signature
    ) -> TransformStamped:
        """Return the transform that takes coordinates in `source_frame` to coordinates in `target_frame`.

        A callback may wait, too: the listener's subscriptions go on meanwhile.

        Args:
            target_frame: Name of the frame to which data are transformed.
            source_frame: Name of the frame in which data are given.
            time: Time of the transform; zero means the latest.
            timeout: Longest wait for the transform; zero does not wait.

        Returns:
            The transform: `header.frame_id` is the target, `child_frame_id` the source, `header.stamp` its time.

        Raises:
            LookupException: if a frame is unknown.
            ConnectivityException: if no chain of transforms connects the frames.
            ExtrapolationException: if the buffer has no data at this time.
            InvalidArgumentException: if a name is empty or begins with a slash.
            ExternalShutdownException: if the context ends during the wait.
            TypeError: if `time` or `timeout` is of another type.
        """
        self._wait(self._simple(target_frame, source_frame, time), timeout)
        return self.lookup_transform_core(target_frame, source_frame, time)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> TransformStamped:
        """Return the transform from `source_frame` at one time to `target_frame` at another.

        Args:
            target_frame: Name of the frame to which data are transformed.
            target_time: Time at which the target frame is taken; zero means the latest.
            source_frame: Name of the frame in which data are given.
            source_time: Time at which the source frame is taken; zero means the latest.
            fixed_frame: Name of a frame that does not move between the two times, such as ``map`` or ``odom``.
            timeout: Longest wait for the transform; zero does not wait.

        Returns:
            The transform: `header.frame_id` is the target, `child_frame_id` the source, `header.stamp` the target's
            time.

        Raises:
            LookupException: if a frame is unknown.
            ConnectivityException: if no chain of transforms connects the frames.
            ExtrapolationException: if the buffer has no data at one of the times.
            InvalidArgumentException: if a name is empty or begins with a slash.
            ExternalShutdownException: if the context ends during the wait.
            TypeError: if a time or `timeout` is of another type.
        """
        requested = (target_frame, target_time, source_frame, source_time, fixed_frame)
        self._wait(self._full(*requested), timeout)
        return self.lookup_transform_full_core(*requested)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration = Duration(),  # noqa: B008
        return_debug_tuple: bool = False,
    ) -> Any:
        """True if `lookup_transform` would succeed with these arguments.

        Args:
            target_frame: Name of the frame to which data are transformed.
            source_frame: Name of the frame in which data are given.
            time: Time of the transform; zero means the latest.
            timeout: Longest wait for the transform; zero does not wait.
            return_debug_tuple: True returns a tuple of the answer and the reason why not ('' if it would succeed).

        Raises:
            ExternalShutdownException: if the context ends during the wait.
            TypeError: if `time` or `timeout` is of another type.
        """
        lookup = self._simple(target_frame, source_frame, time)
        self._wait(lookup, timeout)
        return lookup.can() if return_debug_tuple else lookup.can()[0]

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
        return_debug_tuple: bool = False,
    ) -> Any:
        """True if `lookup_transform_full` would succeed with these arguments.

        Args:
            target_frame: Name of the frame to which data are transformed.
            target_time: Time at which the target frame is taken; zero means the latest.
            source_frame: Name of the frame in which data are given.
            source_time: Time at which the source frame is taken; zero means the latest.
            fixed_frame: Name of a frame that does not move between the two times.
            timeout: Longest wait for the transform; zero does not wait.
            return_debug_tuple: True returns a tuple of the answer and the reason why not ('' if it would succeed).

        Raises:
            ExternalShutdownException: if the context ends during the wait.
            TypeError: if a time or `timeout` is of another type.
        """
        lookup = self._full(target_frame, target_time, source_frame, source_time, fixed_frame)
        self._wait(lookup, timeout)
        return lookup.can() if return_debug_tuple else lookup.can()[0]

    def _wait(self, lookup: PendingLookup, timeout: Duration) -> None:
        span = nanoseconds(timeout, "timeout")
        if span > 0 and not lookup.settled():
            self._waits.wait(lookup, span)

    # Later

    async def lookup_transform_async(self, target_frame: str, source_frame: str, time: Any) -> TransformStamped | None:
        """Wait for a transform in a coroutine, and return it; see `lookup_transform`.

        Args:
            target_frame: Name of the frame to which data are transformed.
            source_frame: Name of the frame in which data are given.
            time: Time of the transform; zero means the latest.

        Raises:
            TransformException: if the transform cannot come any more, as when `time` is too long ago.
        """
        return await self.wait_for_transform_async(target_frame, source_frame, time)

    async def lookup_transform_full_async(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> TransformStamped | None:
        """Wait for a transform in a coroutine, and return it; see `lookup_transform_full`.

        Args:
            target_frame: Name of the frame to which data are transformed.
            target_time: Time at which the target frame is taken; zero means the latest.
            source_frame: Name of the frame in which data are given.
            source_time: Time at which the source frame is taken; zero means the latest.
            fixed_frame: Name of a frame that does not move between the two times.

        Raises:
            TransformException: if the transform cannot come any more, as when a time is too long ago.
        """
        requested = (target_frame, target_time, source_frame, source_time, fixed_frame)
        return await self.wait_for_transform_full_async(*requested)

    def wait_for_transform_async(self, target_frame: str, source_frame: str, time: Any) -> Future[TransformStamped]:
        """Return a future of a transform, without waiting.

        Args:
            target_frame: Name of the frame to which data are transformed.
            source_frame: Name of the frame in which data are given.
            time: Time of the transform; zero means the latest.

        Returns:
            A future of the transform. It fails with ExtrapolationException once `time` is too long ago.
        """
        return self._waits.future(self._simple(target_frame, source_frame, time))

    def wait_for_transform_full_async(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Future[TransformStamped]:
        """Return a future of a transform between two times, without waiting; see `lookup_transform_full`.

        Args:
            target_frame: Name of the frame to which data are transformed.
            target_time: Time at which the target frame is taken; zero means the latest.
            source_frame: Name of the frame in which data are given.
            source_time: Time at which the source frame is taken; zero means the latest.
            fixed_frame: Name of a frame that does not move between the two times.

        Returns:
            A future of the transform. It fails with ExtrapolationException once a time is too long ago.
        """
        return self._waits.future(self._full(target_frame, target_time, source_frame, source_time, fixed_frame))

    def _simple(self, *requested: Any) -> PendingLookup:
        return PendingLookup(
            lambda: self.can_transform_core(*requested),
            lambda: self._is_gone(*requested),
            lambda: self.lookup_transform_core(*requested),
        )

    def _full(self, target: str, target_time: Any, source: str, source_time: Any, fixed: str) -> PendingLookup:
        requested = (target, target_time, source, source_time, fixed)
        return PendingLookup(
            lambda: self.can_transform_full_core(*requested),
            lambda: self._is_gone(target, fixed, target_time) or self._is_gone(fixed, source, source_time),
            lambda: self.lookup_transform_full_core(*requested),
        )
