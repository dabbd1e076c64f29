"""Figures of a recording in words: the progress line, and the lines at the end."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from robolink.bag.information import size_text
from robolink.bag.recording import Figures

MOST_NAMED = 3
"""Most topics with losses that the progress line names."""


def progress(now: Figures, before: Figures) -> str:
    """Return the progress line: time, messages, size, rate since a moment ago, and what was dropped and lost."""
    spent = now.seconds - before.seconds
    rate = (now.messages - before.messages) / spent if spent > 0 else 0.0
    speed = (now.bytes - before.bytes) / spent if spent > 0 else 0.0
    parts = [
        "[paused]" if now.paused else "[recording]",
        clock(now.seconds),
        f"{now.messages:,} messages ({rate:,.0f}/s)",
        f"{size_text(now.bytes)} ({size_text(round(speed))}/s)",
        f"{now.topics} topics",
        *losses(now),
    ]
    return "  ".join(parts)


def summary(figures: Figures) -> list[str]:
    """Return the lines for the end of a recording."""
    first = (
        f"{figures.path}: {figures.messages:,} messages of {figures.topics} topics in {clock(figures.seconds)},"
        f" {size_text(figures.bytes)}"
    )
    rows = [
        (f"dropped, since they came faster than they could be written: {name}", count)
        for name, count in figures.dropped.items()
    ]
    rows += [(f"lost on the way: {name}", count) for name, count in figures.lost.items()]
    return [first, *(f"  {text} {count:,}" for text, count in rows)]


def as_data(figures: Figures) -> dict[str, Any]:
    """Return figures for JSON."""
    return {**figures._asdict(), "path": str(figures.path)}


def losses(figures: Figures) -> list[str]:
    """Return what was dropped and lost, in short; nothing where nothing was."""
    return [*_named("dropped", figures.dropped), *_named("lost", figures.lost)]


def _named(what: str, counts: Mapping[str, int]) -> list[str]:
    if not counts:
        return []
    worst = sorted(counts, key=lambda name: -counts[name])[:MOST_NAMED]
    more = f" and {len(counts) - len(worst)} more" if len(counts) > len(worst) else ""
    return [f"{what} {sum(counts.values()):,} ({', '.join(f'{name} {counts[name]:,}' for name in worst)}{more})"]


def clock(seconds: float) -> str:
    """Return a time as `12.3 s`, `2:03 min` or `1:02:03 h`."""
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(int(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02} h" if hours else f"{minutes}:{rest:02} min"
