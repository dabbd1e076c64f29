"""The robot systems as users start them: what the robots do is measured from /odom and the world files."""

from __future__ import annotations

import itertools
import math
import re
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

import pytest

from robolink import Context, Node
from robolink.exceptions import ExternalShutdownException
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.sim import load_world
from robolink.sim.geometry import fixed_circles, fixed_segments, nearest_wall_distance
from robolink.workspace import find_world
from tests.commands import PATIENCE, TERMINAL, Command
from tests.domains import free_domain

pytestmark = pytest.mark.processes

MIDDLE = (3.0, 2.5)
"""A point of the cornered room that the path along its walls leads around; it is far from all of them."""


class Sample(NamedTuple):
    """What /odom says: seconds since the epoch, metres, m/s."""

    time: float
    x: float
    y: float
    speed: float


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

    def go_on(self, seconds: float) -> Sample:
        """Wait until the robot's time has gone on by so much."""
        since = self.samples[-1].time
        return self.wait(lambda each: each.time >= since + seconds)

    def is_alone(self) -> bool:
        """Wait until there is no other node on the domain."""
        graph = self.context.graph
        return graph.wait_for(lambda: {each.node_name for each in graph.nodes()} == {"witness"}, PATIENCE)

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


# --- what is measured -----------------------------------------------------------------------------------------


def clearances(samples: list[Sample], world: str) -> list[float]:
    """The distance from the robot's centre to the nearest wall or fixed obstacle, in metres."""
    description = load_world(find_world(world))
    segments, circles = fixed_segments(description), fixed_circles(description)
    return [nearest_wall_distance(segments, circles, each.x, each.y) for each in samples]


def radius_of_robot(world: str) -> float:
    return load_world(find_world(world)).robots[0].shape.outer_radius()


def length(samples: list[Sample]) -> float:
    return sum(math.dist(one[1:3], other[1:3]) for one, other in itertools.pairwise(samples))


def laps(samples: list[Sample], middle: tuple[float, float]) -> float:
    """How often the path leads around a point, counter-clockwise."""
    bearings = [math.atan2(each.y - middle[1], each.x - middle[0]) for each in samples]
    turns = (other - one for one, other in itertools.pairwise(bearings))
    return sum((turn + math.pi) % math.tau - math.pi for turn in turns) / math.tau


def rms(values: list[float]) -> float:
    return math.sqrt(sum(value * value for value in values) / len(values))


def test_the_measures_are_right() -> None:
    ring = [Sample(0.0, math.cos(angle / 50), math.sin(angle / 50), 0.0) for angle in range(630)]
    assert length(ring) == pytest.approx(12.58, abs=0.01)
    assert laps(ring, (0.0, 0.5)) == pytest.approx(2.0, abs=0.05)
    assert laps(ring, (2.0, 0.0)) == pytest.approx(0.0, abs=0.1)
    assert rms([3.0, -4.0]) == pytest.approx(3.5355, abs=1e-4)
    assert clearances([Sample(0.0, 3.0, 0.9, 0.0)], "corners") == pytest.approx([0.9])


# --- launch wander and launch follow --------------------------------------------------------------------------


def ran_for(command: Command, witness: Watched, seconds: float) -> None:
    """Wait for its orderly end, and see that it reported in time and left nothing behind."""
    code = command.end(seconds + PATIENCE)
    report = [line.text for line in command.lines]
    assert (code, command.errors) == (0, []), report
    assert command.left() == []
    assert witness.is_alone()
    assert time.monotonic() - command.started >= seconds
    for said in (r"robot at \(\S+, \S+\) heading", r"driving|turning|following"):
        first = next(line for line in command.lines if re.search(said, line.text))
        assert first.seconds < 5.0
    assert not [line for line in report if "ran into" in line or "in contact" in line]
    assert len(witness.samples) > 0.9 * 50 * (seconds - 5.0)


@pytest.mark.timeout(180)
def test_wander_and_follow_drive_their_robots_well_side_by_side() -> None:
    with ExitStack() as stack:
        wander_domain, follow_domain = (stack.enter_context(free_domain()) for _ in range(2))
        wanderer, follower = (stack.enter_context(watched(each)) for each in (wander_domain, follow_domain))
        follow = stack.enter_context(Command(follow_domain, "launch", "follow", "--duration", "120"))
        wander = stack.enter_context(Command(wander_domain, "launch", "wander", "--duration", "60"))

        ran_for(wander, wanderer, 60.0)
        assert length(wanderer.samples) >= 8.0
        assert min(clearances(wanderer.samples, "obstacles")) > radius_of_robot("obstacles")

        ran_for(follow, follower, 120.0)
        distances = clearances(follower.samples, "corners")
        settled = follower.samples[0].time + 30.0
        errors = [
            distance - 0.5 for each, distance in zip(follower.samples, distances, strict=True) if each.time > settled
        ]
        assert laps(follower.samples, MIDDLE) >= 1.0
        assert rms(errors) < 0.1
        assert min(distances) > radius_of_robot("corners")


# --- launch teleop --------------------------------------------------------------------------------------------


def test_pub_drives_the_robot_of_launch_teleop_until_it_is_killed() -> None:
    with free_domain() as domain, watched(domain) as witness, Command(domain, "launch", "teleop") as teleop:
        there = witness.wait(lambda each: True)
        assert there.speed == pytest.approx(0.0)
        pub = "pub", "/cmd_vel", "Twist", "{linear: {x: 0.3}}", "-r", "10"
        with Command(domain, *pub) as driver:
            driving = witness.wait(lambda each: math.dist(each[1:3], there[1:3]) > 0.3)
            assert driving.speed == pytest.approx(0.3, abs=0.01)
            driver.kill()
            killed = time.time()
        stopped = witness.wait(lambda each: abs(each.speed) < 1e-3)
        assert 0.3 < stopped.time - killed < 1.2
        assert len(teleop.left()) >= 3 or not Path("/proc/self/environ").exists()
        teleop.interrupt()
        assert teleop.end() == 0
    assert any("drive with: robolink pub /cmd_vel Twist" in line.text for line in teleop.lines)
    assert (teleop.left(), driver.errors, teleop.errors) == ([], [], [])


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no pseudo-terminals for a test to type on")
def test_keys_drive_the_robot_of_launch_teleop() -> None:
    shell = 'trap : INT; "$@"; echo code $?; stty -a'
    terminal = (sys.executable, "-c", TERMINAL, "/bin/sh", "-c", shell, "sh", sys.executable, "-m", "robolink")
    with (
        free_domain() as domain,
        watched(domain) as witness,
        Command(domain, "launch", "teleop", program=terminal, has_input=True) as teleop,
    ):
        teleop.wait_for("drive with w a s d")
        there = witness.wait(lambda each: True)
        for _ in range(20):
            teleop.press("w")
            witness.go_on(0.1)
        assert witness.samples[-1].speed == pytest.approx(0.3, abs=0.01)
        assert math.dist(witness.samples[-1][1:3], there[1:3]) > 0.3
        witness.wait(lambda each: abs(each.speed) < 1e-3)
        teleop.press("\x03")
        teleop.wait_for("code 0")
        teleop.wait_for(" icanon")
        assert teleop.end() == 0
    assert teleop.left() == []
