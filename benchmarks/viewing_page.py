"""Measure the page of `robolink view` in headless Chromium: frames a second, and stamp to paint, for 100 robots.

    python benchmarks/viewing_page.py [--robots 100] [--seconds 15] [--picture FILE]

The robots (benchmarks/robots.py) are one process, the server another, and Chromium runs beside them. A paint counts for
each robot's scan and odometry that becomes visible with it: from its stamp to the end of the frame's drawing, by the
clock of this machine.
"""

from __future__ import annotations

import argparse
import itertools
import math
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import psutil

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.robots import RATE, Fleet  # noqa: E402 - found only now
from tests.support.browser import Browser, chromium  # noqa: E402
from tests.support.domains import free_domain  # noqa: E402

ARRIVALS = """globalThis.arrived_ = []; for (let i = 0; i < 10; i++) robolink.listen(`/r${i}/scan`, { every: (view) => {
  const stamp = view.getInt32(4, true) * 1000 + view.getUint32(8, true) / 1e6;
  arrived_.push(performance.timeOrigin + performance.now() - stamp);
} }); 0"""
"""Ages of the scans of some robots as they reach the page."""

FIRST = """(() => { const timer = setInterval(() => {
  if (!(globalThis.robolink?.store.messages > 0)) return;
  globalThis.first_ = performance.now();
  clearInterval(timer);
}, 2); })()"""
"""Time from the start of the navigation to the first message that the page has, in milliseconds, to 2 ms."""

OPENINGS = 5
"""Number of times that the page is opened for that."""

SETTLE = 5.0
"""Seconds after the first data that do not count: modules are compiled, and the view fits."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robots", type=int, default=100)
    parser.add_argument("--seconds", type=float, default=15.0)
    parser.add_argument("--picture", type=Path)
    parser.add_argument("--publish", action="store_true", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.publish:
        publish(args.robots)
    elif chromium is None:
        sys.exit("chromium is not installed: apt-get install chromium")
    else:
        with free_domain() as domain:
            measure(args, dict(os.environ, ROS_DOMAIN_ID=str(domain)))


def publish(robots: int) -> None:
    """Publish scans, odometry and transforms until the process is ended; what is late is not made up for."""
    import robolink
    from robolink import Node

    robolink.init()
    fleet = Fleet(Node("robots"), robots, staggered=True)
    begin, turn = time.perf_counter(), 0
    while True:
        fleet.publish()
        turn += 1
        time.sleep(max(0.0, begin + turn / RATE - time.perf_counter()))


def measure(args: argparse.Namespace, environment: dict[str, str]) -> None:
    view = subprocess.Popen(
        [sys.executable, "-m", "robolink", "view", "--no-browser", "--port", "0"],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        cwd=ROOT,
    )
    again = [sys.executable, __file__, "--publish", "--robots", str(args.robots)]
    robots = subprocess.Popen(again, env=environment, cwd=ROOT)
    try:
        assert view.stdout is not None
        address = view.stdout.readline().split()[-1]
        with Browser() as browser:
            shown = [opened(browser, address) for _ in range(OPENINGS)]
            browser.wait(f"robolink.tf.nodes.size >= {args.robots}")
            time.sleep(SETTLE)
            report(browser, args, watched(browser, args.seconds, view.pid, robots.pid), shown)
    finally:
        robots.kill()
        view.terminate()
        for each in (robots, view):
            each.wait(10)


def opened(browser: Browser, address: str) -> float:
    """Open the page anew, and return the seconds until it had data."""
    browser.open("about:blank")
    browser.wait("location.href == 'about:blank'")
    script = browser.call("Page.addScriptToEvaluateOnNewDocument", source=FIRST)["identifier"]
    browser.open(address)
    found = float(browser.wait("globalThis.first_")) / 1000
    browser.call("Page.removeScriptToEvaluateOnNewDocument", identifier=script)
    return found


def watched(browser: Browser, seconds: float, server: int, robots: int) -> dict[str, Any]:
    """Run for some seconds, and return the page's figures and the CPU of each part as a share of one core."""
    pages = [psutil.Process(browser.pid), *psutil.Process(browser.pid).children(recursive=True)]
    parts = {"server": [psutil.Process(server)], "robots": [psutil.Process(robots)], "chromium": pages}
    before = {name: sum(map(spent, each)) for name, each in parts.items()}
    idle = psutil.cpu_times()
    browser.js(ARRIVALS)
    browser.js(
        "robolink.painted = []; globalThis.frames_ = []; globalThis.before_ = robolink.store.messages;"
        "robolink.on('frame', (now, work) => frames_.push([now, work])); 0"
    )
    begin = time.perf_counter()
    time.sleep(seconds)
    took = time.perf_counter() - begin
    reported = browser.js(
        "({ painted: robolink.painted, arrived: arrived_, frames: frames_,"
        " messages: robolink.store.messages - before_ })"
    )
    after = psutil.cpu_times()
    cpu = {name: (sum(map(spent, each)) - before[name]) / took for name, each in parts.items()}
    return {**reported, "cpu": cpu, "seconds": took, "idle": (after.idle - idle.idle) / took / (os.cpu_count() or 1)}


def spent(process: psutil.Process) -> float:
    times = process.cpu_times()
    return float(times.user + times.system)


def share(values: list[float], part: float) -> float:
    values = sorted(values)
    return values[min(len(values) - 1, int(part * len(values)))] if values else math.nan


def report(browser: Browser, args: argparse.Namespace, reported: dict[str, Any], shown: list[float]) -> None:
    frames = reported["frames"]
    gaps = [after[0] - before[0] for before, after in itertools.pairwise(frames)]
    span = (frames[-1][0] - frames[0][0]) / 1000
    print(f"{args.robots} robots, {reported['messages'] / reported['seconds']:.0f} messages/s")
    print(f"  first data: p50 {share(shown, 0.5):.2f} s, at most {max(shown):.2f} s after the page was opened")
    print(f"  frames: {len(gaps) / span:.1f} a second; gap p50 {share(gaps, 0.5):.1f} p99 {share(gaps, 0.99):.1f} ms")
    work = [each[1] for each in frames]
    print(f"  work of a frame: p50 {share(work, 0.5):.1f} p99 {share(work, 0.99):.1f} ms")
    arrived = reported["arrived"]
    print(f"  stamp to arrival in the page: p50 {share(arrived, 0.5):.1f} p99 {share(arrived, 0.99):.1f} ms")
    for kind in sorted({each[0] for each in reported["painted"]}):
        ages = [each[1] for each in reported["painted"] if each[0] == kind]
        within = sum(age <= 50 for age in ages) / len(ages)
        print(
            f"  stamp to paint, {kind}: p50 {share(ages, 0.5):.1f} p99 {share(ages, 0.99):.1f} ms;"
            f" {100 * within:.2f} % within 50 ms ({len(ages)})"
        )
    cpu = ", ".join(f"{name} {100 * value:.0f} %" for name, value in reported["cpu"].items())
    print(f"  CPU of a core: {cpu}; machine idle {100 * reported['idle']:.0f} %")
    if args.picture:
        browser.screenshot(args.picture)
    if browser.problems:
        print("  the page's console:", browser.problems[:3])


if __name__ == "__main__":
    main()
