"""Benchmark of the simulator beside others: cost of a scan, and real-time factor of a whole world.

    python benchmarks/simulator.py [--rounds 7] [--seconds 10]

Peers take part where they are installed (`pip install ir-sim mujoco pyrobosim`); pymunk always is. All see the same
worlds from the same places, by turns, on one thread. Figures of one machine at one moment mean little; the ratios of
one run carry over. At the end comes how exact it is (`exactness.py`); a hundred robots over the network are
measured by `fleet.py`.
"""

from __future__ import annotations

import argparse
import itertools
import math
import statistics
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks import exactness
from benchmarks.lidars import PEERS, Place, Scan, installed, irsim_world
from benchmarks.worlds import maze, room
from robolink import Context, Node, VirtualTime, logging
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.sim import Pose, World, WorldDescription
from robolink.sim.sensing.lidar import Beams, distances, distances_batch
from robolink.sim.sensing.scene import fixed_circles, fixed_segments, standing
from robolink.sim.sensors import Lidar
from robolink.task import Future
from robolink.world_node import Runner, Simulation

WORLDS = {"room": room, "maze": maze}
BEAMS = (360, 1080)
ROBOTS = (1, 10, 100)
REACH = 12.0
PLACES = 100
"""Places from which each scanner looks in a round; slow ones look from the first only."""

SLOW = ("pyrobosim", "at once")
WARM_UP = 1.0
"""Simulated seconds that run before the clock is looked at: codecs are made at the first message."""
LIDAR_GOALS = {"pymunk": {360: 15.0, 1080: 30.0}, "MuJoCo": {360: 2.0, 1080: 2.0}}
GOALS = {"alone": {1: 500.0, 10: 100.0, 100: 12.0}, "with messages": {1: 150.0, 10: 20.0, 100: 6.0}}
THOUSAND, THOUSAND_GOAL = 1000, 2.0
SHOWN = ("room", "maze")


# --- Lidar ------------------------------------------------------------------------------------------------------------


def lidars(rounds: int) -> None:
    """Print the cost of a scan, for each world and number of beams."""
    print("Lidar: microseconds a scan, and how many times as long as robolink's")
    for (name, world), beams in itertools.product(WORLDS.items(), BEAMS):
        description = world()
        segments = fixed_segments(description)
        places = free_places(description, PLACES)
        scanners = {"robolink": own_scanner(description, beams)}
        scanners |= {"at once": batch(description, beams, places)}
        scanners |= {peer.name: peer.make(segments, beams, REACH) for peer in PEERS if installed(peer.module)}
        took = {each: 1e6 * statistics.median(times) for each, times in by_turns(scanners, places, rounds).items()}
        own, together = took.pop("robolink"), took.pop("at once") / PLACES
        print(f"  {name}, {len(segments)} segments, {beams} beams: {own:.0f}, of {PLACES} at once {together:.0f} each")
        for peer, microseconds in took.items():
            goal = LIDAR_GOALS.get(peer, {}).get(beams) if name == "room" or peer == "pymunk" else None
            print(f"    {peer:10} {microseconds:9.0f}   {said(microseconds / own, goal)}")


def batch(description: WorldDescription, beams: int, places: Sequence[Place]) -> Scan:
    """Look from all places at once, whatever place is asked for."""
    table, poses = Beams(Lidar("scan", beams=beams)), np.array(places)
    around = standing(fixed_segments(description), fixed_circles(description))
    return lambda _: distances_batch(table, poses, around)


def own_scanner(description: WorldDescription, beams: int) -> Scan:
    """Robolink's own way: all beams at once."""
    table = Beams(Lidar("scan", beams=beams))
    around = standing(fixed_segments(description), fixed_circles(description))
    return lambda place: distances(table, Pose(*place), around)


def by_turns(scanners: dict[str, Scan], places: Sequence[Place], rounds: int) -> dict[str, list[float]]:
    """Return the seconds a scan of each scanner in each round; its first scan of a round does not count."""
    took: dict[str, list[float]] = {name: [] for name in scanners}
    for _ in range(rounds):
        for name, scan in scanners.items():
            seen = places[:1] if name in SLOW else places
            scan(places[0])
            begin = time.perf_counter()
            for place in seen:
                scan(place)
            took[name].append((time.perf_counter() - begin) / len(seen))
    return took


def free_places(description: WorldDescription, count: int) -> list[Place]:
    """Return places at which nothing is, the same each time."""
    world, random = World(description), np.random.default_rng(1)
    width, height = description.world.size or (10.0, 10.0)
    found: list[Place] = []
    while len(found) < count:
        x, y, theta = random.uniform((0.0, 0.0, -math.pi), (width, height, math.pi)).tolist()
        if world.nearest_wall_distance(x, y) > 0.3:
            found.append((x, y, theta))
    return found


# --- Whole worlds -----------------------------------------------------------------------------------------------------


def worlds(seconds: float) -> None:
    """Print how many times as fast as life worlds run, alone, with messages, and ir-sim's."""
    print(f"\nReal-time factor over {seconds:g} simulated seconds: 100 steps and odometries, 10 scans a second")
    for name, count in itertools.product(SHOWN, ROBOTS):
        description = WORLDS[name](robots=count)
        goals = {kind: goal[count] for kind, goal in GOALS.items()} if name == "room" else {}
        alone = max(simulate(description, seconds) for _ in range(3))
        print(f"  {name}, {count:3} robots: alone {said(alone, goals.get('alone'))}")
        with_messages = max(simulate_with_messages(description, seconds) for _ in range(3))
        print(f"{'':21} with messages {said(with_messages, goals.get('with messages'))}")
        if installed("irsim") and (name == "room" or count < 100):
            theirs = irsim_factor(description, count)
            print(f"{'':21} ir-sim {theirs:.3g}; robolink alone is {said(alone / theirs, 10.0)} times as fast")
    alone = max(simulate(maze(robots=THOUSAND), min(seconds, 2.0)) for _ in range(3))
    print(f"  maze, {THOUSAND} robots: alone {said(alone, THOUSAND_GOAL)}")


def simulate(description: WorldDescription, seconds: float) -> float:
    """Let all robots drive in circles, read odometry and what sensors have measured, and send nothing; the factor."""
    world = World(description)
    live(world, WARM_UP)
    begin = time.perf_counter()
    live(world, seconds)
    return seconds / (time.perf_counter() - begin)


def live(world: World, seconds: float) -> None:
    """Let a world go on for some simulated seconds."""
    robots = list(world.robots.values())
    for step in range(round(seconds * 1e9) // world.dt_ns):
        if step % 20 == 0:
            for robot in robots:
                robot.command(0.3, 0.5)
        world.step()
        world.readings()
        if step % 2 == 0:
            for robot in robots:
                robot.odometry  # noqa: B018 - what a node would send


def simulate_with_messages(description: WorldDescription, seconds: float) -> float:
    """Run the world's node in memory with a subscriber for each topic; give the real-time factor."""
    context = Context(transport="memory://benchmark", time=VirtualTime())
    context.init(args=[])
    with context, SingleThreadedExecutor(context=context) as executor:
        executor.add_node(world_node(context, description))
        listener = Node("listener", context=context)
        for topic, message_class in topics(description):
            listener.create_subscription(message_class, topic, lambda message: None, 10)
        executor.add_node(listener)
        executor.spin_until_future_complete(Future[None](), timeout_sec=WARM_UP)
        begin = time.perf_counter()
        executor.spin_until_future_complete(Future[None](), timeout_sec=seconds)
        return seconds / (time.perf_counter() - begin)


def world_node(context: Context, description: WorldDescription) -> Node:
    """Make a node that does what `nodes/world.py` does, with a world that is in no file."""
    node = Node("world", context=context)
    Runner(node, Simulation(node, description, 0, publish_clock=False, publish_map=True), 1.0)
    return node


def topics(description: WorldDescription) -> Iterator[tuple[str, type[Any]]]:
    """Return the topics of the robots, with their types."""
    yield "/tf", TFMessage
    for robot in description.robots:
        prefix = f"/{robot.name}/" if len(description.robots) > 1 else "/"
        yield f"{prefix}odom", Odometry
        yield f"{prefix}ground_truth", Odometry
        for sensor in robot.sensors:
            yield prefix + sensor.topic, LaserScan


def irsim_factor(description: WorldDescription, count: int) -> float:
    """Return ir-sim's real-time factor with steps of 0.1 s, over at least three of them and two seconds."""
    places = [(robot.pose.x, robot.pose.y, robot.pose.theta) for robot in description.robots]
    env = irsim_world(fixed_segments(description), places, 360, REACH)
    action = [np.array([[0.3], [0.5]])] * count
    begin, steps = time.perf_counter(), 0
    while steps < 3 or time.perf_counter() - begin < 2.0:
        env.step(action)
        steps += 1
    return steps * 0.1 / (time.perf_counter() - begin)


def said(factor: float, goal: float | None) -> str:
    """Say a factor, and whether a goal is met."""
    text = f"{factor:.3g} x"
    return text if goal is None else f"{text} (goal {goal:g}{'' if factor >= goal else ', NOT REACHED'})"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--seconds", type=float, default=10.0)
    options = parser.parse_args()
    logging.set_console_handler(None)
    absent = [peer.name for peer in PEERS if not installed(peer.module)]
    if absent:
        print(f"not installed, so not compared: {', '.join(absent)}\n")
    lidars(options.rounds)
    worlds(options.seconds)
    exactness.report()


if __name__ == "__main__":
    main()
