"""Writes of the MCAP writer, cut: each is applied up to a random byte, onto the file as it was before.

    python -m tests.support.mcap_cuts --cuts 1000        and with --compression zstd
    python -m tests.support.mcap_cuts --power 1000       power cuts: of the pages since the last sync any are there

For each cut it says what robolink reads, what the other readers open unrepaired, and whether `reindex` makes the file
whole for them. It ends with 1 if robolink lost anything older than the write, or a repaired file was not read.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from robolink.bag.mcap import Reader, Writer, reindex
from robolink.bag.mcap.disk import DiskFile
from robolink.bag.mcap.records import Buffer
from tests.support.mcap_readers import Found, Readers

PAGE = 4096
SMALL = 64
"""Size up to which a write is one of those that show something."""
CHUNK = 48 * 1024
ROOM = 1 << 18


class Write(NamedTuple):
    """A write into the file, a truncation of it (`data` is None), or a part of a sync (`at` is negative)."""

    at: int
    data: bytes | None


SYNC, BEGIN_SYNC, END_SYNC = Write(-1, None), Write(-2, None), Write(-3, None)
"""A sync, and one on a thread: all that was written before its beginning is on the disk from its end on."""
SMALLEST = 1e-9
"""A time that has always passed, in seconds."""


class Recorded(DiskFile):
    """A file whose writes are noted."""

    log: list[Write]

    def put(self, data: Buffer, at: int) -> None:
        self.log.append(Write(at, bytes(data)))
        super().put(data, at)

    def save(self) -> None:
        self.log.append(SYNC)

    def cut(self, size: int) -> None:
        self.log.append(Write(size, None))
        super().cut(size)


class Run(NamedTuple):
    """A run of the writer: the file as it was made, and all that was written to it then."""

    image: bytes
    writes: list[Write]
    messages: int


class SlowSave:
    """A thread's saves as a disk of varying speed makes them: each takes until the writer has asked some times."""

    def __init__(self, log: list[Write]) -> None:
        self.log, self.left = log, 0
        self.chance = random.Random(2)

    def is_free(self) -> bool:
        if self.left == 1:
            self.log.append(END_SYNC)
        self.left -= self.left > 0
        return self.left == 0

    def start(self) -> None:
        self.log.append(BEGIN_SYNC)
        self.left = self.chance.choice((1, 1, 2, 5, 20))

    def wait(self) -> None:
        if self.left:
            self.log.append(END_SYNC)
        self.left = 0


def run(folder: Path, compression: str, count: int, sync: str, large: tuple[int, int] = (2737, 90_000)) -> Run:
    """Write messages of all sizes, on channels that come from time to time, and close the file.

    `large` says which messages are large, and their size: (each how many, bytes). `sync` is ``"never"``, ``"strict"``
    (writing waits for the disk) or ``"thread"``.
    """
    log: list[Write] = []
    images: list[bytes] = []
    path = folder / "run.mcap"

    def create(path: Path, pieces: Iterable[tuple[int, Buffer]], durable: bool) -> DiskFile:
        file = Recorded.create(path, pieces, durable=False)
        assert isinstance(file, Recorded)
        file.log = log
        images.append(path.read_bytes())
        return file

    chance = random.Random(3)
    with Writer(
        path,
        compression=compression,
        chunk_size=CHUNK,
        flush_every=SMALLEST,
        sync_every={"never": 0.0, "strict": SMALLEST, "thread": 2 * SMALLEST}[sync],
        room=ROOM,
        create=create,
    ) as writer:
        if sync == "thread":
            writer._saving = SlowSave(log)  # type: ignore[assignment]
        channels: list[int] = []
        for number in range(count):
            if number % 100 == 0 and len(channels) < 30:
                for each in range(3):
                    schema = writer.add_schema(f"a/msg/T{number}_{each}", "ros2msg", b"uint8[] data\n" * 20)
                    channels.append(writer.add_channel(schema, f"/t{number}_{each}", "cdr"))
            size = 20 if number % 7 else 1500
            if number % large[0] == 0:
                size = large[1]
            time = 10**9 + number * 1000
            writer.write(channels[number % len(channels)], time, time, number, chance.randbytes(size))
            if number % 11 == 0:
                writer.tick()
    path.unlink()
    return Run(images[0], log, count)


def apply(image: bytearray, write: Write, length: int | None = None) -> None:
    """Apply a write, or its first bytes, as a disk does."""
    if write.data is None:
        if write.at >= 0:
            del image[write.at :]
        return
    data = write.data[:length]
    if data and write.at > len(image):
        image.extend(bytes(write.at - len(image)))
    image[write.at : write.at + len(data)] = data


class Tally:
    """Results of the readers on the cut files.

    Args:
        readers: The readers.
        folder: Folder for the files.
    """

    def __init__(self, readers: Readers, folder: Path) -> None:
        self.readers, self.path = readers, folder / "cut.mcap"
        self.cuts: Counter[str] = Counter()
        self.unrepaired: Counter[tuple[str, str]] = Counter()
        """Cuts after which a reader cannot open the file as it is, by kind of write."""
        self.older: Counter[tuple[str, str]] = Counter()
        """Cuts after which it opens the file as it was at the flush before."""
        self.wrong: list[str] = []

    def own(self, image: bytes | bytearray) -> Found:
        """Messages that robolink reads of a file."""
        self.path.write_bytes(image)
        return self.readers.own(self.path)

    def try_cut(self, kind: str, image: bytearray, least: int, where: str) -> None:
        """Try the readers on a file that has at least these messages, then on the repaired one."""
        self.cuts[kind] += 1
        found = self.own(image)
        if isinstance(found, str) or not self._has_first(least):
            self.wrong.append(f"{where}: robolink reads {found}, not all {least} that are older")
            return
        for name, other in self.readers.others(self.path).items():
            if isinstance(other, str):
                self.unrepaired[kind, name] += 1
            elif other < least:
                self.older[kind, name] += 1
        reindex(self.path)
        with Reader(self.path) as reader:
            if not reader.is_whole or reader.statistics.message_count != found:
                self.wrong.append(f"{where}: repaired, it has {reader.statistics.message_count} instead of {found}")
        repaired = self.readers.others(self.path)
        if set(repaired.values()) != {found}:
            self.wrong.append(f"{where}: repaired, others read {repaired} instead of {found}")

    def _has_first(self, least: int) -> bool:
        with Reader(self.path) as reader:
            return {each.sequence for each in reader.messages()}.issuperset(range(least))

    def report(self) -> int:
        """Print what was found; return the exit code."""
        for kind, count in sorted(self.cuts.items()):
            bad = {name: number for (each, name), number in sorted(self.unrepaired.items()) if each == kind}
            old = {name: number for (each, name), number in sorted(self.older.items()) if each == kind}
            print(f"{kind}: {count} cuts; not opened as they are: {bad or 'none'}; as a flush before: {old or 'none'}")  # noqa: T201
        print(f"robolink or a repair was wrong: {len(self.wrong)} times")  # noqa: T201
        for line in self.wrong[:10]:
            print(f"  {line}")  # noqa: T201
        return 1 if self.wrong else 0


def cut_writes(tally: Tally, made: Run, cuts: int, seed: int = 7) -> None:
    """Cut writes at random bytes, spread evenly over all writes, and try the readers on each."""
    chance = random.Random(seed)
    puts = [number for number, each in enumerate(made.writes) if each.data is not None]
    chosen = Counter(chance.choices(puts, k=cuts - len(puts)) if cuts > len(puts) else [])
    chosen.update(puts if cuts >= len(puts) else chance.sample(puts, cuts))
    image = bytearray(made.image)
    least = 0
    for number, write in enumerate(made.writes):
        if chosen[number]:
            found = tally.own(image)  # all that is older than the write
            assert isinstance(found, int), found
            assert found >= least, "a whole write made the file poorer"
            least = found
        for _ in range(chosen[number]):
            assert write.data is not None
            length = chance.randrange(len(write.data))
            cut = bytearray(image)
            apply(cut, write, length)
            kind = "small write" if len(write.data) <= SMALL else "large write"
            tally.try_cut(kind, cut, least, f"write {number} of {len(write.data)} bytes, {length} there")
        apply(image, write)
    assert tally.own(image) == made.messages


def crashes(made: Run, count: int, seed: int = 7) -> Iterator[tuple[bytearray, bytearray, str]]:
    """Yield files after power cuts, and as they were at the last sync: any pages since then are there, and any size."""
    chance = random.Random(seed)
    points = Counter(chance.choices(range(1, len(made.writes)), k=count))
    safe, live = bytearray(made.image), bytearray(made.image)
    dirty: set[int] = set()
    sizes: list[int] = []
    begun = bytearray(live), 0
    later: set[int] = set()
    for number, write in enumerate(made.writes):
        if write == SYNC:
            safe, sizes, begun, later = bytearray(live), [], (bytearray(live), 0), set()
            dirty.clear()
        elif write == BEGIN_SYNC:
            begun, later = (bytearray(live), len(sizes)), set()
        elif write == END_SYNC:
            safe, sizes, dirty = begun[0], sizes[begun[1] :], set(later)
        else:
            apply(live, write)
            sizes.append(len(live))
            if write.data:
                pages = range(write.at // PAGE, (write.at + len(write.data) - 1) // PAGE + 1)
                dirty.update(pages)
                later.update(pages)
        for _ in range(points[number]):
            yield _crashed(safe, live, dirty, chance.choice([len(safe), *sizes]), chance), safe, f"after {number}"


def _crashed(safe: bytearray, live: bytearray, dirty: set[int], size: int, chance: random.Random) -> bytearray:
    image = bytearray(safe)
    share = chance.random()
    for page in sorted(dirty):
        # A disk grows only with its last page: file systems write data before the size that makes it seen.
        is_last = page == (size - 1) // PAGE and size > len(safe)
        start, end = page * PAGE, min((page + 1) * PAGE, len(live))
        if start < end and (is_last or chance.random() < share):
            if len(image) < end:
                image.extend(bytes(end - len(image)))
            image[start:end] = live[start:end]
    if len(image) < size:
        image.extend(bytes(size - len(image)))
    del image[size:]
    return image


def cut_power(tally: Tally, made: Run, cuts: int) -> None:
    """Try the readers after power cuts, of a file that is synced now and then."""
    before, least = b"", 0
    tally.readers.gaps = True
    for image, safe, where in crashes(made, cuts):
        if bytes(safe) != before:
            before = bytes(safe)
            found = tally.own(safe)
            assert isinstance(found, int), found
            least = found
        tally.try_cut("power cut", image, least, where)


def main(words: list[str]) -> int:
    """Cut writes as the words ask for; return the exit code."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--cuts", type=int, default=0, help="cuts inside of writes")
    parser.add_argument("--power", type=int, default=0, help="power cuts")
    parser.add_argument("--compression", default="", choices=["", "zstd", "lz4"])
    parser.add_argument("--messages", type=int, default=1700)
    options = parser.parse_args(words)
    code = 0
    memory = "/dev/shm" if Path("/dev/shm").is_dir() else None
    with tempfile.TemporaryDirectory(dir=memory) as name, Readers() as readers:
        if readers.without:
            print(f"without @mcap/core: {readers.without}")  # noqa: T201
        folder = Path(name)
        if options.cuts:
            tally = Tally(readers, folder)
            cut_writes(tally, run(folder, options.compression, options.messages, "never"), options.cuts)
            code |= tally.report()
        for sync in ("strict", "thread") if options.power else ():
            print(f"sync: {sync}")  # noqa: T201
            tally = Tally(readers, folder)
            cut_power(tally, run(folder, options.compression, options.messages, sync), options.power)
            code |= tally.report()
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
