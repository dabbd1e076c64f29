"""Kills of a recorder (SIGKILL) at random moments, while 10 MB a second are recorded: each bag opens as it is.

    python -m tests.support.bag_kills --kills 100 [--seed 0]

A process publishes all the while. Each bag is opened, unrepaired, with robolink, mcap, rosbags and (where node has it)
@mcap/core; all have to find the same messages, of which none may be missing between the first and the last. What was
lost is the time from the last message of the bag to the kill. Ends with 1 if a bag does not open or lacks more than
0.3 s.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

from mcap.reader import make_reader
from rosbags.rosbag2 import Reader as RosbagsReader

from robolink import Context, Node
from robolink.bag.reader import open_bag
from robolink.interfaces.std_msgs.msg import UInt8MultiArray
from tests.support.domains import free_domain
from tests.support.mcap_readers import Readers

RATE, SIZE = 200, 50_000
"""Messages a second and their bytes: 10 MB a second."""
TOPIC = "/bytes"
MOST_LOST = 0.3
PATIENCE = 60.0


class Kill(NamedTuple):
    """Contents of one bag after the kill: its messages, by reader, and the seconds that it lacks."""

    counts: dict[str, int | str]
    lost: float
    seconds: float
    """Time that was recorded."""

    @property
    def is_good(self) -> bool:
        first = next(iter(self.counts.values()))
        return isinstance(first, int) and first > 0 and set(self.counts.values()) == {first} and self.lost <= MOST_LOST


def tell(text: str) -> None:
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


def publish() -> None:
    """Publish until standard input ends."""
    with Context() as context:
        publisher = Node("load", context=context).create_publisher(UInt8MultiArray, TOPIC, 10)
        message = UInt8MultiArray(data=bytes(random.Random(1).randbytes(SIZE)))
        tell("publishes")
        begin, sent = time.perf_counter(), 0
        while os.getppid() != 1:
            publisher.publish(message)
            sent += 1
            time.sleep(max(0.0, begin + sent / RATE - time.perf_counter()))


def kill_one(folder: Path, domain: int, after: float, readers: Readers) -> Kill:
    """Record, kill the recorder `after` so many seconds of recording, and open the bag."""
    bag = folder / "bag"
    words = ["bag", "record", TOPIC, "-o", str(bag), "--log-level", "error"]
    recorder = subprocess.Popen([sys.executable, "-m", "robolink", *words], env=_environment(domain))
    try:
        begin = _first_message(bag)
        time.sleep(after)
    finally:
        killed_at = time.time_ns()
        recorder.kill()
        recorder.wait()
    counts, last = _counts(bag, readers)
    shutil.rmtree(bag)
    return Kill(counts, (killed_at - last) / 1e9, (last - begin) / 1e9)


def _environment(domain: int) -> dict[str, str]:
    return os.environ | {"ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


def _first_message(bag: Path) -> int:
    """Wait until a live bag has a message, and return its time."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        if (bag / "metadata.yaml").exists():
            with open_bag(bag) as opened:
                if opened.counts.get(TOPIC):
                    return opened.start_time
        time.sleep(0.05)
    raise AssertionError("nothing is recorded")


def _counts(bag: Path, readers: Readers) -> tuple[dict[str, int | str], int]:
    """Return the number of messages that each reader finds, and the time of the last one."""
    (file,) = bag.glob("*.mcap")
    with open_bag(bag) as opened:
        found = [(each.sequence, each.publish_time, len(each.data)) for each in opened.messages()]
    numbers = [each[0] for each in found]
    counts: dict[str, int | str] = {"robolink": len(found)}
    if numbers != list(range(numbers[0], numbers[0] + len(numbers))):
        counts["robolink"] = "E:a message is missing"
    with file.open("rb") as stream:
        counts["mcap"] = sum(1 for _ in make_reader(stream, validate_crcs=True).iter_messages())
    with RosbagsReader(bag) as reader:
        counts["rosbags"] = sum(1 for _ in reader.messages())
    if not readers.without:
        counts["@mcap/core"] = readers.others(file)["@mcap/core"]
    return counts, found[-1][1]


def kills(count: int, seed: int = 0, longest: float = 1.5) -> list[Kill]:
    """Kill so many recorders, each within `longest` seconds of recording."""
    moments = random.Random(seed)
    done: list[Kill] = []
    with free_domain() as domain, tempfile.TemporaryDirectory() as folder, Readers() as readers:
        load = subprocess.Popen(
            [sys.executable, "-m", "tests.support.bag_kills", "--publish"],
            stdout=subprocess.PIPE,
            text=True,
            env=_environment(domain),
        )
        try:
            assert load.stdout is not None
            assert load.stdout.readline() == "publishes\n"
            for number in range(count):
                done.append(kill_one(Path(folder), domain, moments.uniform(0.0, longest), readers))
                tell(f"{number + 1}: {done[-1].counts}, lost {done[-1].lost:.3f} s")
        finally:
            load.kill()
            load.communicate()
    return done


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--publish", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.publish:
        publish()
        return 0
    done = kills(given.kills, given.seed)
    good = sum(each.is_good for each in done)
    lost = sorted(each.lost for each in done)
    readers = ", ".join(done[0].counts)
    tell(f"{good} of {len(done)} bags open with all readers ({readers}) and lack at most {MOST_LOST} s")
    tell(f"lost: median {lost[len(lost) // 2]:.3f} s, at most {lost[-1]:.3f} s")
    return 0 if good == len(done) else 1


if __name__ == "__main__":
    sys.exit(main())
