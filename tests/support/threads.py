"""Helpers for tests of multi-threaded executors: services that answer, and topics with numbers."""

from __future__ import annotations

from robolink import Node
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.qos import HistoryPolicy, QoSProfile

PATIENCE = 30.0
EVERY_ONE = QoSProfile(history=HistoryPolicy.KEEP_ALL)
ASK = Trigger.Request()


def answer(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
    response.success = True
    return response


def publish(node: Node, topic: str, count: int) -> None:
    publisher = node.create_publisher(Int32, topic, EVERY_ONE)
    for number in range(count):
        publisher.publish(Int32(data=number))
