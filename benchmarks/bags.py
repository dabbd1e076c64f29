"""Benchmark of MCAP files: messages written and read a second, beside mcap and rosbags in the same run, by turns.

    python benchmarks/bags.py [--rounds 5] [--compression zstd] [--folder FOLDER] [--only Twist]

The best round of each counts. robolink ticks every 64 messages, as its recorder does, so that its file can be opened
at any moment; the others write theirs at the end only. `file` is its MCAP writer alone, `bag` the BagWriter that
programs use, with metadata.yaml. robolink checks the CRC of each chunk that it reads; mcap does so where it is asked
to (`mcap crc`), and rosbags never.
"""

from __future__ import annotations

import argparse
import random
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from mcap.reader import make_reader
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Reader as RosbagsReader
from rosbags.rosbag2 import Writer as RosbagsWriter
from rosbags.typesys import Stores, get_typestore

from robolink.bag.mcap import Reader, Writer
from robolink.bag.reader import open_bag
from robolink.bag.topic import BagTopic, message_definition
from robolink.bag.writer import BagWriter
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import Image, LaserScan
from robolink.message import Message, encode

TICK = 64
STEP = 1_000_000
"""Nanoseconds from one message to the next."""


class Work(NamedTuple):
    """Messages that are written: some different ones by turns."""

    name: str
    cls: type[Message]
    messages: list[bytes]
    total: int

    def each(self) -> Iterator[tuple[int, bytes]]:
        """Return the messages with their number."""
        return ((number, self.messages[number % len(self.messages)]) for number in range(self.total))

    @property
    def size(self) -> int:
        """Size of all data in bytes."""
        return sum(map(len, self.messages)) * self.total // len(self.messages)


def works() -> list[Work]:
    """Return the messages to write: Twists, scans of 360 beams, and images of 1 MB and of 6 MB."""
    chance = random.Random(1)
    twists = [Twist() for _ in range(1000)]
    for each in twists:
        each.linear.x, each.angular.z = chance.random(), chance.random()
    scans = [LaserScan(ranges=[3 + chance.gauss(0, 0.01) for _ in range(360)]) for _ in range(100)]
    image = Image(height=578, width=605, step=1815, encoding="rgb8", data=chance.randbytes(1_049_070))
    large = Image(height=1080, width=1920, step=5760, encoding="rgb8", data=chance.randbytes(6_220_800))
    return [
        Work("Twist", Twist, [encode(each) for each in twists], 200_000),
        Work("LaserScan", LaserScan, [encode(each) for each in scans], 40_000),
        Work("Image 1 MB", Image, [encode(image)], 200),
        Work("Image 6 MB", Image, [encode(large)], 60),
    ]


def write_bag(path: Path, work: Work, compression: str) -> None:
    """Write with robolink's BagWriter, which makes a folder with one file and metadata.yaml."""
    with BagWriter(path, compression=compression) as writer:
        text = message_definition(work.cls)
        topic = writer.add_topic(BagTopic("/probe", work.cls.__ros_type__, message_definition=text))
        for number, data in work.each():
            writer.write(topic, number * STEP, number * STEP, number, data)
            if number % TICK == 0:
                writer.tick()


def write_file(path: Path, work: Work, compression: str) -> None:
    """Write with robolink's writer of MCAP files."""
    with Writer(path, compression=compression) as writer:
        schema = writer.add_schema(work.cls.__ros_type__, "ros2msg", message_definition(work.cls).encode())
        channel = writer.add_channel(schema, "/probe", "cdr")
        for number, data in work.each():
            writer.write(channel, number * STEP, number * STEP, number, data)
            if number % TICK == 0:
                writer.tick()


def write_mcap(path: Path, work: Work, compression: str) -> None:
    """Write with mcap."""
    with path.open("wb") as file:
        writer = McapWriter(file, compression=CompressionType[compression.upper() or "NONE"])
        writer.start("ros2")
        text = message_definition(work.cls).encode()
        channel = writer.register_channel(
            "/probe", "cdr", writer.register_schema(work.cls.__ros_type__, "ros2msg", text)
        )
        for number, data in work.each():
            writer.add_message(channel, number * STEP, data, number * STEP, number)
        writer.finish()  # type: ignore[no-untyped-call]


def write_rosbags(path: Path, work: Work, compression: str) -> None:
    """Write with rosbags, which makes a folder with one file."""
    writer = RosbagsWriter(path, version=9, storage_plugin=StoragePlugin.MCAP)
    if compression:
        writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    with writer:
        typestore = get_typestore(Stores.ROS2_HUMBLE)
        connection = writer.add_connection("/probe", work.cls.__ros_type__, typestore=typestore)
        for number, data in work.each():
            writer.write(connection, number * STEP, data)


def read_bag(path: Path) -> int:
    """Read with robolink's reader of bags, in order of log time."""
    with open_bag(path) as bag:
        return sum(1 for _ in bag.messages())


def read_file(path: Path) -> int:
    """Read with robolink's reader of MCAP files, in order of log time."""
    with Reader(path) as reader:
        return sum(1 for _ in reader.messages())


def read_mcap(path: Path, crc: bool = False) -> int:
    """Read with mcap, in order of log time."""
    with path.open("rb") as file:
        return sum(1 for _ in make_reader(file, validate_crcs=crc).iter_messages())


def read_mcap_crc(path: Path) -> int:
    """Read with mcap, which checks the CRC of each chunk then."""
    return read_mcap(path, crc=True)


def read_rosbags(path: Path) -> int:
    """Read with rosbags, in order of log time."""
    with RosbagsReader(path) as reader:
        return sum(1 for _ in reader.messages())


WRITERS: dict[str, Callable[[Path, Work, str], None]] = {
    "bag": write_bag,
    "file": write_file,
    "mcap": write_mcap,
    "rosbags": write_rosbags,
}
READERS: dict[str, Callable[[Path], int]] = {
    "bag": read_bag,
    "file": read_file,
    "mcap": read_mcap,
    "mcap crc": read_mcap_crc,
    "rosbags": read_rosbags,
}


def timed(call: Callable[[], object]) -> float:
    """Return the seconds that a call takes."""
    begin = time.perf_counter()
    call()
    return time.perf_counter() - begin


def remove(path: Path) -> None:
    """Remove a file or a folder, if it is there."""
    if path.is_dir():
        shutil.rmtree(path)
    path.unlink(missing_ok=True)


def measure(work: Work, folder: Path, rounds: int, compression: str) -> None:
    """Write and read by turns, and print the best of each."""
    written: dict[str, float] = dict.fromkeys(WRITERS, float("inf"))
    read: dict[str, float] = dict.fromkeys(READERS, float("inf"))
    names = [each for each in WRITERS if not (each == "rosbags" and compression == "lz4")]
    for _ in range(rounds):
        for name in names:
            path = folder / f"{name}.mcap"
            remove(path)
            seconds = timed(lambda path=path, write=WRITERS[name]: write(path, work, compression))  # type: ignore[misc]
            written[name] = min(written[name], seconds)
        for name in READERS:
            path = folder / "file.mcap"
            seconds = timed(lambda path=path, count=READERS[name]: count(path))  # type: ignore[misc]
            read[name] = min(read[name], seconds)
    for verb, found in (("written", written), ("read", read)):
        for name, seconds in found.items():
            if seconds < float("inf"):
                rate, speed = work.total / seconds, work.size / seconds / 1e6
                print(f"{work.name:10} {verb:8} {name:9} {rate:10,.0f} messages/s {speed:8,.0f} MB/s")


def main() -> None:
    """Measure each kind of message."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--compression", default="", choices=["", "zstd", "lz4"])
    parser.add_argument("--folder", help="where the files are written: /dev/shm leaves the disk out")
    parser.add_argument("--only", help="beginning of the name of what is written, such as Twist or Image")
    options = parser.parse_args()
    print(f"compression: {options.compression or 'none'}; the files that are read are robolink's")
    with tempfile.TemporaryDirectory(dir=options.folder) as name:
        for work in works():
            if not work.name.startswith(options.only or ""):
                continue
            measure(work, Path(name), options.rounds, options.compression)


if __name__ == "__main__":
    main()
