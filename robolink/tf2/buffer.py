"""The buffer that programs use: a BufferCore that can wait, serves its frames, and forgets when time goes back."""

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
from robolink.tf2.waiting import News, Question

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.tf2.transform_listener import TransformListener


class Buffer(BufferCore, BufferInterface):
    """Transforms of the last `cache_time`, ten seconds by default. A TransformListener fills it.

    Given a node, it answers the service ``tf2_frames`` there. When the clock of that node, or of a listener's, jumps
    back, all but the static transforms are forgotten.
    """

    def __init__(self, cache_time: Duration | None = None, node: Node | None = None) -> None:
        BufferCore.__init__(self, cache_time)
        BufferInterface.__init__(self)
        self._news = News()
        self._watched: dict[Clock, JumpHandle] = {}
        self.clock = Clock() if node is None else node.get_clock()
        self._watch(self.clock)
        self.jump_handle = self._watched[self.clock]
        if node is not None:
            self.srv = node.create_service(FrameGraph, "tf2_frames", self._on_frames_asked)

    def _on_frames_asked(self, request: FrameGraph.Request, response: FrameGraph.Response) -> FrameGraph.Response:
        response.frame_yaml = self.all_frames_as_yaml()
        return response

    def _watch(self, clock: Clock) -> None:
        if clock not in self._watched:
            back = JumpThreshold(min_forward=None, min_backward=Duration(seconds=-1), on_clock_change=True)
            self._watched[clock] = clock.create_jump_callback(back, post_callback=self.time_jump_callback)

    def time_jump_callback(self, time_jump: TimeJump) -> None:
        """Forget all that moves, since its stamps are of another time."""
        changed = time_jump.clock_change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED)
        what = "The clock has another source now." if changed else "Detected jump back in time."
        get_logger(LOGGER).warning(f"{what} Clearing tf buffer.")
        self.clear()

    # What comes in

    def fed_by(self, listener: TransformListener) -> None:
        """Know a listener that fills this buffer: who waits lets it go on, and its clock is watched."""
        self._news.sources.add(listener)
        self._watch(listener.node.get_clock())

    def not_fed_by(self, listener: TransformListener) -> None:
        """Forget a listener."""
        sources, clock = self._news.sources, listener.node.get_clock()
        sources.discard(listener)
        if clock is not self.clock and all(each.node.get_clock() is not clock for each in sources):
            self._watched.pop(clock).unregister()

    def _set(self, given: Any, authority: str, *, static: bool) -> bool:
        taken = super()._set(given, authority, static=static)
        if taken:
            self._news.tell()
        return taken

    # At once, or within a timeout

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration = Duration(),  # noqa: B008 - tf2's signature
    ) -> TransformStamped:
        """Give the transform that takes what is given in `source_frame` to `target_frame`, at a time, 0 the latest.

        It is waited for `timeout` at most; in a callback too, since the listener's subscriptions go on meanwhile.
        Raises LookupException, ConnectivityException, ExtrapolationException or InvalidArgumentException.
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
        """Give the transform from `source_frame` at one time to `target_frame` at another.

        `fixed_frame` is what stands still between the two times; for the rest see `lookup_transform`.
        """
        asked = (target_frame, target_time, source_frame, source_time, fixed_frame)
        self._wait(self._full(*asked), timeout)
        return self.lookup_transform_full_core(*asked)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration = Duration(),  # noqa: B008
        return_debug_tuple: bool = False,
    ) -> Any:
        """Say whether `lookup_transform` would succeed; with `return_debug_tuple` also why not."""
        question = self._simple(target_frame, source_frame, time)
        self._wait(question, timeout)
        return question.can() if return_debug_tuple else question.can()[0]

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
        """Say whether `lookup_transform_full` would succeed; with `return_debug_tuple` also why not."""
        question = self._full(target_frame, target_time, source_frame, source_time, fixed_frame)
        self._wait(question, timeout)
        return question.can() if return_debug_tuple else question.can()[0]

    def _wait(self, question: Question, timeout: Duration) -> None:
        span = nanoseconds(timeout, "timeout")
        if span > 0 and not question.settled():
            self._news.wait(question, span)

    # Later

    async def lookup_transform_async(self, target_frame: str, source_frame: str, time: Any) -> TransformStamped | None:
        """Give the transform once it is there; see `lookup_transform`."""
        return await self.wait_for_transform_async(target_frame, source_frame, time)

    async def lookup_transform_full_async(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> TransformStamped | None:
        """Give the transform once it is there; see `lookup_transform_full`."""
        asked = (target_frame, target_time, source_frame, source_time, fixed_frame)
        return await self.wait_for_transform_full_async(*asked)

    def wait_for_transform_async(self, target_frame: str, source_frame: str, time: Any) -> Future[TransformStamped]:
        """Give a future of the transform. It fails with ExtrapolationException once `time` is too long ago."""
        return self._news.future(self._simple(target_frame, source_frame, time))

    def wait_for_transform_full_async(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Future[TransformStamped]:
        """Give a future of the transform; see `lookup_transform_full` and `wait_for_transform_async`."""
        return self._news.future(self._full(target_frame, target_time, source_frame, source_time, fixed_frame))

    def _simple(self, *asked: Any) -> Question:
        return Question(
            lambda: self.can_transform_core(*asked),
            lambda: self._is_gone(*asked),
            lambda: self.lookup_transform_core(*asked),
        )

    def _full(self, target: str, target_time: Any, source: str, source_time: Any, fixed: str) -> Question:
        asked = (target, target_time, source, source_time, fixed)
        return Question(
            lambda: self.can_transform_full_core(*asked),
            lambda: self._is_gone(target, fixed, target_time) or self._is_gone(fixed, source, source_time),
            lambda: self.lookup_transform_full_core(*asked),
        )
