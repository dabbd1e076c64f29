"""Kills (SIGKILL) of a process that writes an MCAP file at 10 MB/s, at random moments; each file is opened as it is.

    python -m tests.support.mcap_kills --kills 100           and with --compression zstd

It says how much was lost: the time from the last message that can be read to the kill. It ends with 1 if a reader
could not open a file, or more than 0.3 s were lost.
"""

from __future__ import annotations

import argparse
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

from robolink.bag.mcap import Reader, Writer
from tests.support.mcap_readers import Readers

RATE = 10e6
"""Bytes a second."""
SIZE = 1500
"""Bytes of a message: those of a laser scan."""
CHANNELS = 30
LONGEST_LOSS = 0.3
TICK = 16
"""Messages after which the writer ticks."""


class Kill(NamedTuple):
    """A file after a kill."""

    lost: float
    """Seconds from the last message to the kill."""
    messages: int
    wrong: dict[str, object]
    """Readers that did not find all messages, with what they found."""


def write(path: Path, compression: str) -> None:
    """Write messages at the rate until the process is killed."""
    data = random.Random(1).randbytes(SIZE)
    with Writer(path, compression=compression) as writer:
        channels = [
            writer.add_channel(
                writer.add_schema(f"a/msg/T{number}", "ros2msg", b"uint8[] data\n" * 20), f"/t{number}", "cdr"
            )
            for number in range(CHANNELS)
        ]
        sys.stdout.write("ready\n")
        sys.stdout.flush()
        began, number = time.monotonic(), 0
        while True:
            now = time.time_ns()
            writer.write(channels[number % CHANNELS], now, now, number, data)
            number += 1
            if number % TICK == 0:
                writer.tick()
                time.sleep(max(0.0, began + number * SIZE / RATE - time.monotonic()))


def kill(path: Path, seconds: float, compression: str, readers: Readers) -> Kill:
    """Kill a writer after some seconds, and try the readers on its file."""
    command = [sys.executable, "-m", "tests.support.mcap_kills", "--write", str(path), "--compression", compression]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        time.sleep(seconds)
        at = time.time_ns()
        process.kill()
    with Reader(path) as reader:
        last = reader.statistics.end_time
        expected = reader.statistics.message_count
        wrong: dict[str, object] = {} if reader.is_whole else {"robolink": reader.problems}
    for name, found in ({"robolink, read": readers.own(path)} | readers.others(path)).items():
        if found != expected:
            wrong[name] = found
    return Kill((at - last) / 1e9, expected, wrong)


def main(words: list[str]) -> int:
    """Kill writers as the words ask for; return the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--compression", default="", choices=["", "zstd", "lz4"])
    parser.add_argument("--write", type=Path, help=argparse.SUPPRESS)
    options = parser.parse_args(words)
    if options.write:
        write(options.write, options.compression)
    chance = random.Random(5)
    with tempfile.TemporaryDirectory() as folder, Readers() as readers:
        path = Path(folder) / "killed.mcap"
        kills = []
        for _ in range(options.kills):
            kills.append(kill(path, 0.2 + chance.random() * 1.3, options.compression, readers))
            path.unlink()
        wrong = [each.wrong for each in kills if each.wrong]
        without = f" (without @mcap/core: {readers.without})" if readers.without else ""
    lost = sorted(each.lost for each in kills)
    print(f"{len(kills)} kills, {sum(each.messages for each in kills)} messages{without}")  # noqa: T201
    print(f"lost at most {lost[-1]:.3f} s, in the middle {lost[len(lost) // 2]:.3f} s")  # noqa: T201
    print(f"not opened as they are: {len(wrong)} {wrong[:3] or ''}")  # noqa: T201
    return 1 if wrong or lost[-1] > LONGEST_LOSS else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
