"""Wait for one message of a topic."""

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
    """Subscribe, and wait until a message comes; (True, message), or (False, None) when none came.

    It waits `time_to_wait` seconds, for ever when that is negative, or until the context ends. Nothing needs to spin
    the node, and no other callback runs meanwhile; so it may be called in a callback, for a message from elsewhere.
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
