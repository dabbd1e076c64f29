"""Subscriber to a simulated robot's /odom: its samples so far, and waiting for more."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from robolink import Context, Node
from robolink.exceptions import ExternalShutdownException
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.nav_msgs.msg import Odometry
from tests.support.commands import PATIENCE
from tests.support.long_runs import Sample


class Watched:
    """What /odom of a domain has said, and waiting for more."""

    def __init__(self, domain: int) -> None:
        self.samples: list[Sample] = []
        self.context = Context()
        self.context.init([], domain_id=domain)
        self._news = threading.Condition()
        self._node = Node("witness", context=self.context)
        self._node.create_subscription(Odometry, "/odom", self._on_odom, 1000)
        self._thread = threading.Thread(target=self._spin)
        self._thread.start()

    def _spin(self) -> None:
        with SingleThreadedExecutor(context=self.context) as executor:
            executor.add_node(self._node)
            try:
                executor.spin()
            except ExternalShutdownException:
                return

    def _on_odom(self, odom: Odometry) -> None:
        stamp, place = odom.header.stamp, odom.pose.pose.position
        sample = Sample(stamp.sec + stamp.nanosec * 1e-9, place.x, place.y, odom.twist.twist.linear.x)
        with self._news:
            self.samples.append(sample)
            self._news.notify_all()

    def wait(self, condition: Callable[[Sample], bool], patience: float = PATIENCE) -> Sample:
        """Wait for a new sample for which it holds."""
        with self._news:
            seen = len(self.samples)
            assert self._news.wait_for(lambda: any(map(condition, self.samples[seen:])), patience), "it never held"
            return next(filter(condition, self.samples[seen:]))

    def find(self, condition: Callable[[Sample], bool]) -> Sample:
        """Give the first sample for which it holds; wait for it when there is none yet."""
        with self._news:
            assert self._news.wait_for(lambda: any(map(condition, self.samples)), PATIENCE), "it never held"
            return next(filter(condition, self.samples))

    def go_on(self, seconds: float) -> Sample:
        """Wait until the robot's time has gone on by so much."""
        since = self.samples[-1].time
        return self.wait(lambda each: each.time >= since + seconds)

    def wait_until_alone(self) -> None:
        """Wait until there is no other node on the domain."""
        graph = self.context.graph
        alone = graph.wait_for(lambda: {each.node_name for each in graph.nodes()} == {"witness"}, PATIENCE)
        assert alone, f"these are there: {graph.nodes()}"

    def close(self) -> None:
        self.context.shutdown()
        self._thread.join(PATIENCE)


@contextmanager
def watched(domain: int) -> Iterator[Watched]:
    witness = Watched(domain)
    try:
        yield witness
    finally:
        witness.close()
