"""Subscription to a topic of images for commands: each image goes to a function, until there were enough."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.cli.shared.graph import matching_qos
from robolink.cli.shared.messages import message_type
from robolink.cli.shared.output import tell
from robolink.cli.shared.session import node_of, opened
from robolink.context import Context
from robolink.exceptions import RobolinkError, nearest
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.sensor_msgs.msg import CompressedImage, Image
from robolink.system import clocks
from robolink.task import Future
from robolink.wire import EndpointKind

TOLD_AFTER = 2.0
"""Delay until a note that a topic is waited for, in seconds."""


class NoImageError(RobolinkError, TimeoutError):
    """No image came in time, or the topic has none."""


def each_image(topic: str, count: int | None, timeout: float | None, take: Callable[[Any], None]) -> None:
    """Call a function with each image of a topic.

    Args:
        topic: Name of the topic.
        count: So many images; None until Ctrl-C.
        timeout: Longest time without an image, in seconds; None waits for ever.
        take: The function.

    Raises:
        NoImageError: if the topic is of another type, or no image came in time. What `take` raises ends it, too.
    """
    with opened() as context:
        node = node_of(context)
        name = node.resolve_topic_name(topic)
        _wait_for(context, name, timeout)
        msg_type = message_type(context, name)
        if msg_type not in (Image, CompressedImage):
            raise NoImageError(f"{name} is of {msg_type.__ros_type__}, and holds no images")
        taker = _Taker(count, take)
        node.create_subscription(msg_type, name, taker.on_image, matching_qos(context, name))
        with SingleThreadedExecutor(context=context) as executor:
            executor.add_node(node)
            while not taker.done.done():
                before = taker.taken
                executor.spin_until_future_complete(taker.next, timeout_sec=timeout)
                if taker.taken == before and not taker.done.done():
                    if not context.ok():
                        raise KeyboardInterrupt
                    raise NoImageError(f"no image on {name} within {timeout or 0:g} s")
            taker.done.result()


class _Taker:
    """Receiver of images; `next` is done at each, `done` at the last or an error."""

    def __init__(self, count: int | None, take: Callable[[Any], None]) -> None:
        self.count, self.take, self.taken = count, take, 0
        self.next, self.done = Future[None](), Future[None]()

    def on_image(self, message: Any) -> None:
        """Take an image, unless there were enough. An error ends the command, not only the callback."""
        if self.done.done():
            return
        self.taken += 1
        try:
            self.take(message)
            if self.taken == self.count:
                self.done.set_result(None)
        except (RobolinkError, OSError) as error:
            self.done.set_exception(error)
        ended, self.next = self.next, Future[None]()
        ended.set_result(None)


def _wait_for(context: Context, name: str, timeout: float | None) -> None:
    """Wait until somebody publishes the topic. Raises NoImageError after the timeout, and KeyboardInterrupt."""
    graph, begin, told = context.graph, clocks.monotonic(), False

    def published() -> bool:
        return bool(graph.endpoints(EndpointKind.PUBLISHER, name=name)) or not context.ok()

    while not published():
        spent = clocks.monotonic() - begin
        if timeout is not None and spent >= timeout:
            near = nearest(name, {each.name for each in graph.endpoints(EndpointKind.PUBLISHER)})
            raise NoImageError(f"nobody publishes {name}{near}, and {timeout:g} s have passed")
        graph.wait_for(published, 0.5 if timeout is None else min(0.5, timeout - spent))
        if not told and clocks.monotonic() - begin > TOLD_AFTER:
            tell(f"waiting for somebody to publish {name}")
            told = True
    if not context.ok():
        raise KeyboardInterrupt
