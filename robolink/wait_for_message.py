"""Waiting for one message of a topic."""

from __future__ import annotations

from typing import Literal, TypeVar

from robolink.callback_groups import ReentrantCallbackGroup
from robolink.exceptions import ExternalShutdownException
from robolink.executors import SingleThreadedExecutor
from robolink.message import Message
from robolink.node import Node
from robolink.qos import QoSProfile
from robolink.task import Future

MsgT = TypeVar("MsgT", bound=Message)


def wait_for_message(
    msg_type: type[MsgT],
    node: Node,
    topic: str,
    *,
    qos_profile: QoSProfile | int = 1,
    time_to_wait: float = -1,
) -> tuple[Literal[True], MsgT] | tuple[Literal[False], None]:
    """Subscribe, and wait until a message comes or the context ends.

    Nothing needs to spin the node, and no other callback runs meanwhile; so it may be called in a callback, for a
    message from elsewhere.

    Args:
        msg_type: Message class of the topic.
        node: Node that subscribes.
        topic: Name of the topic, relative to the node's namespace unless it begins with a slash; remapped.
        qos_profile: Quality of service; a number is the depth of a reliable, volatile KEEP_LAST profile.
        time_to_wait: Longest wait in seconds; negative waits for ever, 0 does not wait.

    Returns:
        (True, message), or (False, None) if none came.
    """
    first: Future[MsgT] = Future()

    def keep(message: MsgT) -> None:
        if not first.done():
            first.set_result(message)

    group = ReentrantCallbackGroup()  # the node's own may be busy with the very callback that waits here
    subscription = node.create_subscription(msg_type, topic, keep, qos_profile, callback_group=group)
    try:
        with SingleThreadedExecutor(context=node.context) as own:
            subscription.detach()  # it is not for the node's executor, which may be busy, or nobody spins it
            own.attach(subscription)
            own.spin_until_future_complete(first, timeout_sec=time_to_wait)
    except ExternalShutdownException:
        return False, None
    finally:
        node.destroy_subscription(subscription)
    message = first.result()
    return (False, None) if message is None else (True, message)
