"""Reading ahead: while the messages of a chunk are taken, a thread loads the next one, so that nobody waits for it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor

from robolink.bag.mcap.blocks import Block
from robolink.bag.mcap.records import Buffer

ALONE = 2
"""Number of chunks that are loaded without a thread: most look-ups need no more."""
LARGE = 1 << 20
"""Size from which on a chunk is loaded ahead, in bytes; compressed ones always are, since unpacking takes longer."""

Load = Callable[[Block], Buffer | None]


def loaded(blocks: Sequence[Block], load: Load) -> Iterator[Buffer | None]:
    """Iterate over what `load` returns for each block, in their order; a thread may call it."""
    yield from map(load, blocks[:ALONE])
    if any(_is_slow(each) for each in blocks[ALONE:]):
        with ThreadPoolExecutor(1, "bag-ahead") as pool:
            yield from _ahead(blocks[ALONE:], load, pool)
    else:
        yield from map(load, blocks[ALONE:])


def _ahead(blocks: Sequence[Block], load: Load, pool: ThreadPoolExecutor) -> Iterator[Buffer | None]:
    coming: Future[Buffer | None] = pool.submit(load, blocks[0])
    for following in blocks[1:]:
        found = coming.result()
        coming = pool.submit(load, following)
        yield found
    yield coming.result()


def _is_slow(block: Block) -> bool:
    return bool(block.compression) or block.size >= LARGE
