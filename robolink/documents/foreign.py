"""Warnings about files in formats of others: what their own readers skip or repair is read so here too, and told."""

from __future__ import annotations

import contextlib
import sys
import warnings
from collections.abc import Callable, Collection, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TextIO

from robolink.exceptions import DocumentError, nearest
from robolink.system.terminal import shown

if TYPE_CHECKING:
    from robolink.documents.yamlfile import Document


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


def unknown_key(key: object, known: Collection[str]) -> str:
    """Return the sentence about a key that the format's own reader ignores, with the nearest known one."""
    return f"unknown key '{shown(str(key), 40)}'{nearest(str(key), known)}: ignored"


def warn(about: DocumentError | str) -> None:
    """Emit a `FileWarning` about a place in a file."""
    warnings.warn(str(about), FileWarning, stacklevel=3)


def warn_of_unknown_keys(
    document: Document[Any], data: object, known: Collection[str], path: Sequence[str | int] = ()
) -> None:
    """Emit a `FileWarning` for each key of a mapping, at `path` in a YAML file, that the format's reader ignores."""
    for key in data if isinstance(data, dict) else ():
        if key not in known:
            warn(document.error([*path, key], unknown_key(key, known), key=True))


@contextlib.contextmanager
def in_a_line() -> Iterator[None]:
    """Show each `FileWarning` on standard error in one line, as commands do, without the place in Python's code."""
    with warnings.catch_warnings():
        before = warnings.showwarning

        def show(
            message: Warning | str,
            category: type[Warning],
            filename: str,
            lineno: int,
            file: TextIO | None = None,
            line: str | None = None,
        ) -> None:
            if issubclass(category, FileWarning):
                print(f"robolink: {message}", file=file or sys.stderr)
            else:
                before(message, category, filename, lineno, file, line)

        warnings.simplefilter("always", FileWarning)
        warnings.showwarning = show
        yield
