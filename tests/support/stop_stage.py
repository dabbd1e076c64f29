"""A launched system with its page, a node that sends commands at 50 Hz, and a record of how fast the robot goes."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from types import TracebackType
from typing import NamedTuple

from robolink import Context, Node
from robolink.control.stop_lock import QOS, TOPIC
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.std_msgs.msg import Bool
from tests.support.commands import Command
from tests.support.view_clients import until

PERIOD = 0.02
"""Period of the commands of another node, in seconds."""

STANDS = 1e-3
"""Speed below which a robot stands, in m/s and rad/s."""

CIRCLE = Twist(linear=Vector3(x=0.2), angular=Vector3(z=1.0))
"""Command that needs little room."""


class Speed(NamedTuple):
    """Speed of the robot when a message arrived: the larger of m/s and rad/s."""

    at: float
    stamp: float
    """Time of the world, in seconds: it stands still where the machine has no time for the world."""
    value: float


class Stood(NamedTuple):
    """Times in seconds after which the robot stood for good."""

    pressed: float
    """Since STOP was pressed: with the browser, the page, the server and the network."""
    said: float
    """Since STOP was said on its topic."""
    simulated: float
    """Since then, in the time of the world."""


class Stage:
    """A launched system, and a view of it whose process can be killed.

    Args:
        domain: Domain of all of it.
        name: Name of the launch file.
    """

    def __init__(self, domain: int, name: str) -> None:
        self.domain, self.name = domain, name
        self.launch = Command(domain, "launch", name, merged=True)
        self.view = self.open_view()
        self.context = Context()
        self.context.init(args=[], domain_id=domain, initialize_logging=False)
        self.node = Node("other", context=self.context)
        self.speeds: list[Speed] = []
        self.node.create_subscription(Odometry, "/odom", self._on_odometry, 100)
        self.said_at: list[float] = []
        """When a true was heard on the topic of STOP."""
        self.node.create_subscription(Bool, TOPIC, self._on_stop, QOS)
        self._commands = self.node.create_publisher(Twist, "/cmd_vel", 10)
        self._ended = threading.Event()
        self._executor = SingleThreadedExecutor(context=self.context)
        self._executor.add_node(self.node)
        self._threads = [threading.Thread(target=each) for each in (self._executor.spin, self._send)]
        for each in self._threads:
            each.start()

    def open_view(self) -> Command:
        """Start a server of the page."""
        return Command(self.domain, "view", "--no-browser", "--port", "0", merged=True)

    def kill_view(self) -> None:
        """Kill the server of the page as hard as it goes."""
        with self.view:
            self.view.kill()

    def address(self) -> str:
        """Return the address of the page, once it is there."""
        line = self.view.wait_for("http://").text
        return next(each for each in line.split() if each.startswith("http://"))

    def _send(self) -> None:
        while not self._ended.wait(PERIOD):
            self._commands.publish(CIRCLE)

    def _on_odometry(self, odometry: Odometry) -> None:
        twist = odometry.twist.twist
        stamp = odometry.header.stamp.sec + odometry.header.stamp.nanosec / 1e9
        fastest = max(map(abs, (twist.linear.x, twist.linear.y, twist.angular.z)))
        self.speeds.append(Speed(time.monotonic(), stamp, fastest))

    def _on_stop(self, message: Bool) -> None:
        if message.data:
            self.said_at.append(time.monotonic())

    def drives(self) -> None:
        """Wait until the robot moves."""
        self.speeds.clear()
        until(lambda: bool(self.speeds) and self.speeds[-1].value > 0.1, 60.0)

    def stands_after(self, press: Callable[[], object], hold: float) -> Stood:
        """Press STOP, and return how soon the robot stood; it is watched for `hold` seconds from then on."""
        self.speeds.clear()
        self.said_at.clear()
        begin = time.monotonic()
        press()
        until(lambda: bool(self.speeds) and self.speeds[-1].value < STANDS)
        end = time.monotonic() + hold
        until(lambda: time.monotonic() > end, hold + 10.0)
        seen = list(self.speeds)
        moving = [each for each in seen if each.value >= STANDS and each.at > begin]
        assert seen[-1].at > end - 0.5, "nothing more was heard of the robot"
        if not moving:
            return Stood(0.0, 0.0, 0.0)
        last, said = moving[-1], self.said_at[0]
        then = max((each.stamp for each in seen if each.at <= said), default=seen[0].stamp)
        return Stood(last.at - begin, max(0.0, last.at - said), max(0.0, last.stamp - then))

    def close(self) -> None:
        self._ended.set()
        self._executor.shutdown()
        for each in self._threads:
            each.join(10.0)
        self.context.try_shutdown()
        for command in (self.view, self.launch):
            if command.process.poll() is None:
                command.interrupt()
            with command:
                command.end()

    def __enter__(self) -> Stage:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
