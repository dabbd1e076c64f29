"""Robot with a service, a parameter, an action, transforms and a latched map of 10 MB, and a laptop that uses them all.

python -m tests.support.robot_and_laptop robot     # on one machine; prints `ready`, ends with its standard input
python -m tests.support.robot_and_laptop laptop    # on another; prints what it got, as JSON
"""

from __future__ import annotations

import json
import sys
import threading
import time
from typing import Any

import robolink
from robolink.action import ActionClient, ActionServer
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.parameter_client import AsyncParameterClient
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.task import Future
from robolink.tf2 import Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformListener
from robolink.time import Time
from tests.support.commands import PATIENCE
from tests.support.pulse import say
from tests.support.waits import wait_until

PLAY = "from tests.support import robot_and_laptop\nrobot_and_laptop.main()"
"""Program for `python -c` that plays one of the two."""

MAP = 10_000_000
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

ALL = {
    "service": "gone",
    "parameter": 0.5,
    "feedback": [[0, 1, 1], [0, 1, 1, 2], [0, 1, 1, 2, 3]],
    "result": [0, 1, 1, 2, 3],
    "transform": [1.0, 2.0],
    "map": MAP,
}
"""What the laptop gets when all works, but for the seconds that it took."""


class Robot(robolink.Node):
    """Serves `/go` and the action `/fibonacci`; publishes `/map`, and the transforms odom -> base -> lidar."""

    def __init__(self) -> None:
        super().__init__("robot")
        self.declare_parameter("speed", 0.5)
        self._map = self.create_publisher(OccupancyGrid, "map", LATCHED)
        self._map.publish(OccupancyGrid(data=bytes(MAP)))
        self._go = self.create_service(Trigger, "go", lambda _, __: Trigger.Response(success=True, message="gone"))
        self._action = ActionServer(self, Fibonacci, "fibonacci", self._count)
        self._mounted, self._moving = StaticTransformBroadcaster(self), TransformBroadcaster(self)
        self._mounted.sendTransform(self._transform("base", "lidar", 2.0))
        self._timer = self.create_timer(0.02, lambda: self._moving.sendTransform(self._transform("odom", "base", 1.0)))

    def _transform(self, parent: str, child: str, x: float) -> TransformStamped:
        made = TransformStamped(child_frame_id=child)
        made.header.frame_id, made.header.stamp = parent, self.get_clock().now().to_msg()
        made.transform.translation.x, made.transform.rotation.w = x, 1.0
        return made

    @staticmethod
    def _count(goal: Any) -> Any:
        sequence = [0, 1]
        while len(sequence) < goal.request.order:
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        goal.succeed()
        return Fibonacci.Result(sequence=sequence)


class Laptop(robolink.Node):
    """Uses all that the robot has."""

    def __init__(self) -> None:
        super().__init__("laptop")
        self._sizes: list[int] = []
        self.create_subscription(OccupancyGrid, "map", lambda message: self._sizes.append(len(message.data)), LATCHED)
        self._service = self.create_client(Trigger, "go")
        self._asking = AsyncParameterClient(self, "robot")
        self._action = ActionClient(self, Fibonacci, "fibonacci")
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self._feedback: list[list[int]] = []

    def use(self) -> dict[str, Any]:
        """Return what is there."""
        assert self._service.wait_for_service(PATIENCE)
        service = self._service.call_async(Trigger.Request())
        assert self._asking.wait_for_services(PATIENCE)
        parameter = self._asking.get_parameters(["speed"])
        assert self._action.wait_for_server(PATIENCE)
        goal = self._action.send_goal_async(
            Fibonacci.Goal(order=5), lambda message: self._feedback.append(list(message.feedback.sequence))
        )
        result = _answer(_answer(goal).get_result_async()).result.sequence
        wait_until(lambda: len(self._feedback) == 3 and bool(self._sizes))
        return {
            "service": _answer(service).message,
            "parameter": _answer(parameter).values[0].double_value,
            "feedback": self._feedback,
            "result": list(result),
            "transform": [self._x("odom", "base"), self._x("base", "lidar")],
            "map": self._sizes[0],
        }

    def _x(self, parent: str, child: str) -> float:
        wait_until(lambda: self._buffer.can_transform(parent, child, Time()))
        x: float = self._buffer.lookup_transform(parent, child, Time()).transform.translation.x
        return x


def _answer(future: Future[Any]) -> Any:
    wait_until(future.done)
    return future.result()


def main() -> None:
    """Play one of the two."""
    begin = time.monotonic()
    robolink.init()
    node = Robot() if "robot" in sys.argv else Laptop()
    spinning = threading.Thread(target=robolink.spin, args=(node,))
    spinning.start()
    if isinstance(node, Laptop):
        say(json.dumps(node.use() | {"seconds": round(time.monotonic() - begin, 2)}))
    else:
        say("ready")
        sys.stdin.read()
    robolink.shutdown()
    spinning.join()


if __name__ == "__main__":
    main()
