"""Reading ahead: order, errors and an early end are as they are without a thread."""

from __future__ import annotations

import itertools
import threading
from pathlib import Path

import pytest

from robolink.bag.mcap import Reader, Writer
from robolink.bag.mcap.blocks import ALONE, LARGE, Block, loaded
from robolink.bag.mcap.records import Buffer

BLOCKS = [Block(each, 1, each, each, size=LARGE) for each in range(7)]


def content(block: Block) -> bytes:
    return bytes([block.at])


@pytest.mark.parametrize("count", range(8))
@pytest.mark.parametrize("size", [LARGE, 1])
def test_what_is_loaded_comes_in_the_order_of_the_blocks(count: int, size: int) -> None:
    blocks = [each._replace(size=size) for each in BLOCKS[:count]]
    assert list(loaded(blocks, content)) == [content(each) for each in blocks]


def test_a_thread_loads_one_block_ahead_and_no_more() -> None:
    threads: list[str] = []

    def load(block: Block) -> Buffer:
        threads.append(threading.current_thread().name)
        return content(block)

    found = loaded(BLOCKS, load)
    for _ in range(ALONE):
        next(found)
    assert threads == [threading.current_thread().name] * ALONE
    next(found)
    found.close()  # type: ignore[attr-defined]  # it is a generator; the thread ends with it
    assert len(threads) == ALONE + 2
    assert all(each.startswith("bag-ahead") for each in threads[ALONE:])
    assert not [each for each in threading.enumerate() if each.name.startswith("bag-ahead")]


def test_an_error_comes_where_its_block_would() -> None:
    def load(block: Block) -> Buffer:
        if block.at == 4:
            raise OSError("the disk is gone")
        return content(block)

    found = loaded(BLOCKS, load)
    assert list(itertools.islice(found, 4)) == [content(each) for each in BLOCKS[:4]]
    with pytest.raises(OSError, match="the disk is gone"):
        next(found)


@pytest.mark.parametrize("reverse", [False, True])
def test_two_iterators_of_a_file_do_not_disturb_each_other(tmp_path: Path, reverse: bool) -> None:
    with Writer(tmp_path / "a.mcap", compression="zstd", chunk_size=1000) as writer:
        channel = writer.add_channel(0, "/a", "cdr")
        for number in range(100):
            writer.write(channel, number, number, number, bytes([number]) * 300)
    expected = [(each, bytes([each]) * 300) for each in range(100)]
    with Reader(tmp_path / "a.mcap") as reader:
        pairs = zip(reader.messages(reverse=reverse), reader.messages(reverse=reverse), strict=True)
        found = [[(each.sequence, bytes(each.data)) for each in pair] for pair in pairs]
    assert [one for one, _ in found] == [two for _, two in found] == (expected[::-1] if reverse else expected)
