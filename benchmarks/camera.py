"""Benchmark of the simulated camera: how long an image takes, how exact it is, and what a robot with a camera costs.

    python benchmarks/camera.py [--only speed|exact|virtual|real] [--poses 200] [--seconds 60]

`speed` renders the painted laboratory from five places, and the walls of a map of 3,000 segments, with the message.
MuJoCo renders as large a scene beside it where it is installed with OSMesa or EGL (MUJOCO_GL). `exact` compares depths
with rays in double precision, and the corners and places of tags, as OpenCV finds them, with the truth. `virtual` is a
robot with a camera of 320 x 240 at 10 Hz, lidar and odometry in virtual time, all of which is heard. `real` is a world
that publishes images at 30 Hz to another process. Least times say what an image costs; medians what it took here.
"""

from __future__ import annotations

import argparse
import math
import random
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import psutil

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from benchmarks.mujoco_camera import mujoco_camera  # noqa: E402 - found only now
from robolink import Context, Node, VirtualTime, logging  # noqa: E402
from robolink.executors import SingleThreadedExecutor  # noqa: E402
from robolink.image import to_message  # noqa: E402
from robolink.interfaces.nav_msgs.msg import Odometry  # noqa: E402
from robolink.interfaces.sensor_msgs.msg import Image, LaserScan  # noqa: E402
from robolink.interfaces.std_msgs.msg import Header  # noqa: E402
from robolink.parameter import Parameter  # noqa: E402
from robolink.sim import Shot, WorldDescription, load_world  # noqa: E402
from robolink.sim.description import Wall  # noqa: E402
from robolink.sim.rendering.canvas import write_depths  # noqa: E402
from robolink.sim.rendering.pinhole import Pinhole, View, view_from  # noqa: E402
from robolink.sim.rendering.renderer import (  # noqa: E402
    Backdrop,
    Renderer,
    Setting,
    Shooter,
)
from robolink.sim.scene.scenery import scenery  # noqa: E402
from robolink.sim.scene.solids import Cylinder, Surfaces  # noqa: E402
from robolink.sim.sensors import Camera  # noqa: E402
from robolink.task import Future  # noqa: E402
from robolink.workspace import find_node, load_node  # noqa: E402
from robolink.world_node.prepared import PreparedImage, Stamp  # noqa: E402
from tests.support.raycasting import depths, rays  # noqa: E402
from tests.support.tag_views import tag_errors  # noqa: E402

GOALS = {(160, 120): 2.0, (320, 240): 3.5, (640, 480): 8.0}
"""Milliseconds that an image of the laboratory may take."""

VIEWS = (
    (1.0, 1.0, 0.25, 0.5, 0.0),
    (4.0, 6.5, 0.25, -0.9, 0.0),
    (8.0, 3.0, 0.25, 2.2, 0.0),
    (5.2, 4.2, 0.2, 1.57, 0.44),
    (2.0, 6.0, 0.25, -0.3, 0.17),
)
"""Places of the camera: x, y, z in metres, yaw and pitch in radians."""

PAINT = """
paint:
  - {line: [[1, 2], [5, 2], [5, 6.5], [1, 6.5]], closed: true, radius: 0.8, width: 0.05, colour: yellow}
  - {line: [[6.4, 0.5], [9.6, 0.5]]}
signs:
  - {tag: 36h11/3, pose: [10, 6, 3.1416], z: 0.5, size: 0.192}
  - {tag: 36h11/7, pose: [6, 1.5, 3.1416], z: 0.5, size: 0.192}
  - {tag: 36h11/11, pose: [4, 8, -1.5708], z: 0.5, size: 0.192}
  - {tag: 36h11/12, pose: [5, 5.2, 3.1416], z: 0.35, size: 0.3}
"""

ROBOT = """
walls: [{polyline: [[0, 0], [6, 0], [6, 5], [0, 5]], closed: true}]
obstacles: [{circle: 0.2, pose: [3, 2.5], colour: red}, {box: [0.4, 0.3], pose: [4, 1], colour: blue}]
paint: [{line: [[1, 1], [5, 1], [5, 4], [1, 4]], closed: true, radius: 0.8, width: 0.05, colour: yellow}]
robots:
  - name: robot
    pose: [1, 2.5]
    sensors: [{camera: camera, rate: RATE, width: WIDTH, height: HEIGHT, pitch: 15}, {lidar: scan}]
"""

LISTENER = """
import sys
import robolink
from robolink.interfaces.sensor_msgs.msg import Image

wanted, stamps = int(sys.argv[1]), []
robolink.init()
node = robolink.create_node("listener")
node.create_subscription(Image, "/camera/image_raw", lambda image: stamps.append(image.header.stamp), 10)
while len(stamps) < wanted:
    robolink.spin_once(node, timeout_sec=1.0)
robolink.shutdown()
times = [each.sec * 10**9 + each.nanosec for each in stamps]
print(round((times[-1] - times[0]) / 1e9 * float(sys.argv[2])) + 1 - len(times))
"""


def laboratory() -> WorldDescription:
    """Return the world lab with paint on its floor and tags on its walls."""
    text = (ROOT / "configs" / "worlds" / "lab.yaml").read_text(encoding="utf-8")
    return load_world(ROOT / "configs" / "worlds" / "lab.yaml", text=text + PAINT)


def outline(cells: int = 110, side: float = 0.25) -> WorldDescription:
    """Return the walls of a map of rooms with doors and things in them, about 3,000 segments, as a map has them."""
    drawn = random.Random(2)
    occupied = {(x, y) for x in range(cells) for y in range(cells) if not (x % 20 > 1 and y % 20 > 1)}
    occupied -= {(x, y) for x, y in occupied if 8 <= x % 20 < 12 or 8 <= y % 20 < 12}
    occupied |= {(drawn.randrange(cells), drawn.randrange(cells)) for _ in range(cells * cells // 36)}
    walls = []
    for x, y in sorted(occupied):
        sides = {(-1, 0): (0, 0, 0, 1), (1, 0): (1, 0, 1, 1), (0, -1): (0, 0, 1, 0), (0, 1): (0, 1, 1, 1)}
        for (dx, dy), (x1, y1, x2, y2) in sides.items():
            if (x + dx, y + dy) not in occupied:
                walls.append(Wall((((x + x1) * side, (y + y1) * side), ((x + x2) * side, (y + y2) * side))))
    return WorldDescription(walls=tuple(walls))


def setting_of(description: WorldDescription) -> tuple[Setting, Any]:
    """Return the shapes that a camera sees of a world, and the places of what moves, at the start."""
    seen = scenery(description)
    things = [(seen.movable[index], description.obstacles[index].start) for index in seen.movable]
    things += [(seen.robots[each.name], each.pose) for each in description.robots]
    places = np.array([(pose.x, pose.y, pose.theta) for _, pose in things]).reshape(-1, 3)
    return Setting(Backdrop(seen), [(row, surfaces) for row, (surfaces, _) in enumerate(things)]), places


def image_times(description: WorldDescription, size: tuple[int, int], views: list[View], runs: int = 30) -> list[float]:
    """Return the least milliseconds of an image at each view, with its message, and the median of all."""
    camera = Camera("camera", width=size[0], height=size[1])
    shooter, (setting, places), stamp = Shooter(camera, ""), setting_of(description), Stamp.of(0)
    least, every = [], []
    prepared = PreparedImage(to_message(np.zeros((size[1], size[0], 3), np.uint8), "rgb8", Header()))
    for view in views:
        times = []
        for _ in range(runs):
            begin = time.perf_counter()
            prepared.payload(stamp, Shot(shooter, setting, view, places, 0).image())
            times.append(1000 * (time.perf_counter() - begin))
        least.append(min(times))
        every += times
    return [statistics.mean(least), statistics.median(every)]


def speed() -> Iterator[str]:
    """Yield lines about the time of an image."""
    lab, views = laboratory(), [view_from(each[:3], *each[3:]) for each in VIEWS]
    peer = mujoco_camera(setting_of(lab), VIEWS)
    for size, goal in GOALS.items():
        least, median = image_times(lab, size, views)
        beside = f"; {peer(size)}" if peer is not None else ""
        yield f"lab, {size[0]} x {size[1]}: {least:.2f} ms, median {median:.2f} (goal {goal:g}){beside}"
    if peer is None:
        yield "MuJoCo is not installed here, or finds no OpenGL (MUJOCO_GL=osmesa or egl)"
    walls = outline()
    around = [view_from((15.2, 15.4, 0.25), turn * 0.9, 0.05) for turn in range(7)]
    for size in ((320, 240), (640, 480)):
        least, median = image_times(walls, size, around)
        reported = f"{least:.2f} ms, median {median:.2f}{' (goal 15)' if size == (320, 240) else ''}"
        yield f"{len(walls.walls):,} walls of a map, {size[0]} x {size[1]}: {reported}"


def exact(poses: int) -> Iterator[str]:
    """Yield lines about exactness."""
    lab = laboratory()
    surfaces = scenery(lab).fixed
    surfaces = Surfaces(surfaces.faces, (*surfaces.cylinders, Cylinder(4.5, 2.0, 0.15, 0.0, 0.5, (9, 9, 9))))
    setting = Setting(Backdrop(scenery(lab)._replace(fixed=surfaces)), ())
    renderer, found = Renderer(Pinhole(320, 240, 70.0)), np.empty((240, 320), np.float32)
    worst, typical = 0.0, list[float]()
    for x, y, z, yaw, pitch in VIEWS:
        canvas = renderer.render(setting, view_from((x, y, z), yaw, pitch), np.zeros((0, 3)))
        write_depths(canvas.inverse, 1e-3, 1e4, found)
        true, _ = depths(surfaces, (x, y, z), rays(320, 240, 70.0, yaw, pitch))
        seen = np.isfinite(true) & np.isfinite(found) & (true < 20.0)
        off = np.abs(found[seen] - true[seen])
        worst, typical = max(worst, float(off.max())), [*typical, float(np.median(off))]
    middle = 1e6 * statistics.median(typical)
    yield f"depth: off by {1000 * worst:.4f} mm at most (goal 0.1), median {middle:.3f} micrometres"
    for width, height, distance in (
        (640, 480, 0.4),
        (640, 480, 0.7),
        (640, 480, 1.0),
        (640, 480, 1.5),
        (320, 240, 1.0),
    ):
        yield f"tag at {distance:g} m, {width} x {height}: {tags_reported((width, height), distance, poses)}"


def tags_reported(size: tuple[int, int], distance: float, poses: int) -> str:
    """Return how far tags are off in random views."""
    corners, places, missed = tag_errors(size, distance, poses)
    mean, deviation = np.abs(corners.mean(axis=(0, 1))).max(), math.sqrt((corners**2).mean())
    off, worst = 1000 * np.median(places), 1000 * places.max()
    goal = " (goal 4)" if (*size, distance) == (640, 480, 1.0) else ""
    return (
        f"off by {off:.2f} mm in the median{goal}, {worst:.1f} at most; corners {mean:.3f} px in the mean (goal 0.05),"
        f" {deviation:.2f} rms; {missed} of {poses} missed"
    )


def written(folder: str, rate: float, size: tuple[int, int]) -> str:
    """Write the world of a robot with a camera, and return its path."""
    text = ROBOT.replace("RATE", f"{rate:g}").replace("WIDTH", str(size[0])).replace("HEIGHT", str(size[1]))
    (Path(folder) / "robot.yaml").write_text(text, encoding="utf-8")
    return str(Path(folder) / "robot.yaml")


def virtual(seconds: float) -> Iterator[str]:
    """Yield how much faster than life a robot with a camera is in virtual time, with somebody who hears all."""
    with tempfile.TemporaryDirectory() as folder:
        world, counts = written(folder, 10.0, (320, 240)), {Image: 0, LaserScan: 0, Odometry: 0}
        context = Context(transport="memory://benchmark", time=VirtualTime())
        context.init(args=[])
        with context, SingleThreadedExecutor(context=context) as executor:
            listener = Node("listener", context=context)

            def count(message: Any) -> None:
                counts[type(message)] += 1

            for kind, topic in ((Image, "/camera/image_raw"), (LaserScan, "/scan"), (Odometry, "/odom")):
                listener.create_subscription(kind, topic, count, 10)
            make: Any = load_node(find_node("world"))
            executor.add_node(listener)
            executor.add_node(make(context=context, parameter_overrides=[Parameter("world", value=world)]))
            begin = time.perf_counter()
            executor.spin_until_future_complete(Future(), timeout_sec=seconds)
            spent = time.perf_counter() - begin
    reported = ", ".join(f"{count} {kind.__name__}" for kind, count in counts.items())
    yield f"camera 320 x 240 at 10 Hz, lidar and odometry: {seconds / spent:.0f} times life (goal 25); heard {reported}"


def real(seconds: float) -> Iterator[str]:
    """Yield the share of a core of a world that publishes images at 30 Hz to another process, and what is lost."""
    for size in ((320, 240), (640, 480)):
        with tempfile.TemporaryDirectory() as folder:
            world = written(folder, 100.0 / 3.0, size)
            command = [sys.executable, "-m", "robolink", "run", "world", "-p", f"world:={world}"]
            simulating = subprocess.Popen(command, stderr=subprocess.DEVNULL, cwd=ROOT)
            try:
                yield _listened(psutil.Process(simulating.pid), size, round(seconds * 100 / 3))
            finally:
                simulating.terminate()
                simulating.wait()


def _listened(simulating: psutil.Process, size: tuple[int, int], count: int) -> str:
    """Let another process hear so many images; return what that took of the world's core."""
    words = [sys.executable, "-c", LISTENER, str(count), "33.333333"]
    subprocess.run([*words[:3], "10", words[4]], check=True, capture_output=True, cwd=ROOT)  # the world has started
    idle_from, begin = simulating.cpu_times(), time.perf_counter()
    time.sleep(3.0)
    idle, idle_time = simulating.cpu_times(), time.perf_counter() - begin
    alone = (idle.user + idle.system - idle_from.user - idle_from.system) / idle_time
    begin = time.perf_counter()
    heard = subprocess.run(words, check=True, capture_output=True, text=True, cwd=ROOT)
    after, spent = simulating.cpu_times(), count * 0.03
    cpu = (after.user + after.system - idle.user - idle.system - alone * (time.perf_counter() - begin - spent)) / spent
    return (
        f"{size[0]} x {size[1]} at 33 Hz to another process: {heard.stdout.strip()} of {count} lost (goal 0),"
        f" {100 * cpu:.1f} % of a core, {100 * (cpu - alone):.1f} of it for images (goal 15)"
    )


def main() -> None:
    """Print figures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=("speed", "exact", "virtual", "real"))
    parser.add_argument("--poses", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=60.0)
    options = parser.parse_args()
    logging.set_console_handler(None)
    parts: dict[str, Callable[[], Iterator[str]]] = {
        "speed": speed,
        "exact": lambda: exact(options.poses),
        "virtual": lambda: virtual(options.seconds),
        "real": lambda: real(min(options.seconds, 20.0)),
    }
    for name, part in parts.items():
        if options.only in (None, name):
            for line in part():
                print(line, flush=True)


if __name__ == "__main__":
    main()
