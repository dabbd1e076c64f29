"""Warnings about files in formats of others: what their own readers skip or repair is read so here too, and told."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Callable, Iterable, Iterator

from robolink.exceptions import nearest
from robolink.system.terminal import shown


class FileWarning(UserWarning):
    """Something in a file is ignored, left out or guessed; the text begins with the file's name."""


@contextlib.contextmanager
def warnings_to(tell: Callable[[str], object]) -> Iterator[None]:
    """Call `tell` with each `FileWarning`, as text, that is given inside of the block; other warnings pass."""
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always", FileWarning)
        yield
    for each in found:
        if issubclass(each.category, FileWarning):
            tell(str(each.message))
        else:
            warnings.warn_explicit(each.message, each.category, each.filename, each.lineno)


def unknown_key(key: object, known: Iterable[str]) -> str:
    """Return the sentence about a key that the format's own reader ignores, with the nearest known one."""
    return f"unknown key '{shown(str(key), 40)}'{nearest(str(key), known)}: ignored"
