"""Number of threads with which Zenoh reads links: it asks an environment variable, before it opens its first session.

Zenoh's cache answers a late joiner of a latched topic on the reader's own thread, which waits for up to 5 s where a
large message goes to a process that stands still: as many such joiners as readers stop all that a process receives.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

READERS = 3
"""Number of threads that read, in place of Zenoh's two: one more takes 0.2 MB where messages come by several links."""

VARIABLE = "ZENOH_RUNTIME"
"""Zenoh's variable; where the user has set it, it stays as it is."""

_was_set = False


@contextmanager
def enough() -> Iterator[None]:
    """Set the number of readers while the first session of the process is opened; programs that it starts have none."""
    global _was_set
    if _was_set or VARIABLE in os.environ:
        yield
        return
    _was_set = True  # once: later there are threads of Zenoh's that may read the environment
    os.putenv(VARIABLE, f"(rx:(worker_threads:{READERS}))")  # not in `os.environ`: no program is to see it
    try:
        yield
    finally:
        os.unsetenv(VARIABLE)
