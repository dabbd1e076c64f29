"""Signatures of the answers of child processes: a program that writes an answer of its own has not the key.

The key comes over standard input before any code of a program runs. It guards against what a program writes in a file,
its own or a rival's; a program that looks through the memory of its own process finds it.
"""

from __future__ import annotations

import contextlib
import hashlib
import hmac
import os
import sys

KEY = 32
"""Bytes of a key."""
SIGNATURE = 32
"""Bytes of a signature, which is before what it signs."""


def new_key() -> bytes:
    """Return a key for one child process."""
    return os.urandom(KEY)


def take_key() -> bytes:
    """Return the key that this process got over its standard input, which is empty from then on; b"" if it got none."""
    key = b""
    with contextlib.suppress(OSError, ValueError):
        while len(key) < KEY and (part := os.read(0, KEY - len(key))):
            key += part
        nothing = os.open(os.devnull, os.O_RDONLY)
        os.dup2(nothing, 0)
        os.close(nothing)
        sys.stdin = open(0, encoding="utf-8", closefd=False)  # noqa: SIM115 - as long as the process
    return key


def signed(answer: bytes, key: bytes) -> bytes:
    """Return an answer with its signature before it."""
    return hmac.digest(key, answer, hashlib.sha256) + answer


def opened(content: bytes, key: bytes) -> bytes:
    """Return the answer in what was written; b"" if another one than the key's holder has written it."""
    signature, answer = content[:SIGNATURE], content[SIGNATURE:]
    return answer if hmac.compare_digest(signature, hmac.digest(key, answer, hashlib.sha256)) else b""
