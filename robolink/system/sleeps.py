"""Exact sleeps of the threads of this process."""

from __future__ import annotations

import functools


@functools.cache
def sleep_exactly() -> bool:
    """Let the threads that are there now sleep as long as they say; the first call decides.

    Linux adds 50 us to each sleep of a thread, so that wake-ups fall together, unless it is told otherwise (`proc(5)`,
    `/proc/PID/timerslack_ns`).

    Returns:
        True if they do; False on other systems, where a sleep may be longer by milliseconds.
    """
    from pathlib import Path  # 3 ms that a node without floods does not pay

    try:
        for thread in Path("/proc/self/task").iterdir():
            Path(f"/proc/{thread.name}/timerslack_ns").write_text("1", encoding="ascii")
    except OSError:
        return False
    return True
