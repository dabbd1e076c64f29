"""Limits on what a bag may unpack to: a file of a few kilobytes must take neither the memory nor the disk.

Data that is all zeros is packed a thousand times smaller and more, also honestly: a camera with its lid on, an empty
map. So a ratio alone decides nothing; it counts from a size on that is dangerous.
"""

from __future__ import annotations

LARGEST_PIECE = 4 << 30
"""Most bytes of a chunk or a message, however large it is packed."""
PIECE = 32 << 20
"""Bytes up to which a chunk or a message may have any ratio."""
PIECE_RATIO = 250
"""Most bytes for each packed byte of a chunk or a message that is larger."""
SMALL = 1 << 20
"""Bytes of a chunk up to which its messages are not counted."""
MESSAGES = 20_000
"""Messages that a chunk of any ratio may have."""
MESSAGES_RATIO = 8
"""Most messages for each packed byte of a chunk with more."""
FILE = 512 << 20
"""Bytes up to which all that is in a file may have any ratio."""
FILE_RATIO = 12_000
"""Most bytes for each byte of a file with more: a chunk with a black image of 6 MB takes 500 bytes with its indexes."""


def refusal_of_piece(packed: int, size: int) -> str:
    """Return the reason why a chunk or a message is not unpacked; '' if it may be.

    Args:
        packed: Its size as it is stored, in bytes.
        size: The size that it claims to have, in bytes.
    """
    if size > LARGEST_PIECE:
        return f"it claims to be {size} bytes: {LARGEST_PIECE} at most are unpacked"
    if size > max(PIECE, PIECE_RATIO * packed):
        most = f"from {PIECE} on {PIECE_RATIO} times as many are unpacked at most"
        return f"its {packed} bytes claim to be {size}: {most}"
    return ""


def most_messages(packed: int, size: int) -> int | None:
    """Return how many messages a chunk may have; None where its ratio is usual, and they need not be counted.

    Times and numbers that grow from message to message take a byte or two of each, however well they are packed.
    """
    return None if size <= max(SMALL, PIECE_RATIO * packed) else max(MESSAGES, MESSAGES_RATIO * packed)


def most_of_piece(packed: int) -> int:
    """Return to how many bytes a chunk or a message of `packed` bytes may unpack."""
    return min(LARGEST_PIECE, max(PIECE, PIECE_RATIO * packed))


def most_of_file(size: int) -> int:
    """Return to how many bytes all that is in a file of `size` bytes may unpack."""
    return max(FILE, FILE_RATIO * size)
