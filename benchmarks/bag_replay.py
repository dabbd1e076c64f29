"""Benchmark of replays: a bag of `follow` into `wall_follower` in virtual time, and the jitter in real time.

python benchmarks/bag_replay.py [--seconds 60] [--rounds 3]
"""

from __future__ import annotations

import argparse
import hashlib
import statistics
import tempfile
import time
from pathlib import Path

from robolink import Context, Node, logging
from robolink.bag.playing import Player, PlaySettings
from robolink.bag.reader import open_bag
from robolink.bag.selection import Selection
from robolink.message import encode
from robolink.testing import System


def record(path: Path, seconds: float) -> int:
    """Record `follow` for so many seconds of virtual time; return the number of messages."""
    with System(seed=1) as system:
        system.launch("follow")
        recording = system.record(path, ["/scan", "/odom", "/cmd_vel"])
        system.run(seconds)
        return recording.stop().message_count


def replay(path: Path, seconds: float) -> tuple[float, list[bytes]]:
    """Replay the bag into a wall follower; return the time that it took, and its commands."""
    begin = time.perf_counter()
    with System(seed=1) as system:
        system.start("wall_follower")
        commands = system.messages("/cmd_vel")
        system.play(path, ["/scan", "/odom"])
        system.run(seconds + 0.5)
        given = [encode(each) for each in commands]
    return time.perf_counter() - begin, given


def jitter(path: Path, seconds: float) -> list[float]:
    """Play scans and odometry in real time; return how late each message was published, in milliseconds."""
    late: list[float] = []
    context = Context(transport="memory")
    context.init([])
    with context:
        node = Node("rosbag2_player", context=context)
        chosen = Selection(topics=("/scan", "/odom"))
        player = Player(node, [path], PlaySettings(duration=seconds, selection=chosen))
        playback, deliver = player.playback, player.playback._deliver

        def timed(message: object, at: int) -> None:
            late.append((time.monotonic_ns() - playback._head.due(at)) / 1e6)
            deliver(message, at)  # type: ignore[arg-type]

        playback._deliver = timed
        player.start()
        player.wait()
        player.close()
    return late


def main() -> None:
    """Print the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--rounds", type=int, default=3)
    given = parser.parse_args()
    logging.set_logger_level("", logging.LoggingSeverity.ERROR)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "follow"
        print(f"recorded {record(path, given.seconds)} messages in {given.seconds:g} s of virtual time")
        with open_bag(path) as bag:
            recorded = [bytes(each.data) for each in bag.messages(["/cmd_vel"])]
        for _ in range(given.rounds):
            took, commands = replay(path, given.seconds)
            same = sum(one == other for one, other in zip(recorded, commands, strict=False))
            digest = hashlib.sha256(b"".join(commands)).hexdigest()[:16]
            print(f"replayed in {took:.3f} s: {same} of {len(recorded)} commands byte-equal, sha256 {digest}")
        late = sorted(jitter(path, 10.0))
        print(
            f"in real time {len(late)} messages were late by {statistics.median(late):.3f} ms (median),"
            f" {late[int(len(late) * 0.99)]:.3f} ms (99 %), {late[-1]:.3f} ms (most)"
        )


if __name__ == "__main__":
    main()
