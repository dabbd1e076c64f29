"""Progress bar of commands that take long, for a person at a terminal."""

from __future__ import annotations

import sys
from typing import Any

from robolink.system import clocks

LONG = 2.0
"""Delay until a person is shown the progress, in seconds of real time."""


class Progress:
    """Progress bar on standard error, which appears once a person has waited for a while."""

    def __init__(self, total: float, unit: str) -> None:
        self.shown = 0.0
        self._total, self._unit = total, unit
        self._bar: Any = None
        self._begin = 0.0

    def show(self, done: float) -> None:
        """Set the progress to `done`, in the unit of `total`."""
        self.shown = done
        if self._bar is not None:
            self._bar.update(self._task, completed=done)
        elif sys.stderr is not None and sys.stderr.isatty() and clocks.monotonic() - self._begin > LONG:
            self._open()
            self.show(done)

    def _open(self) -> None:
        from rich import progress
        from rich.console import Console

        columns = (
            progress.BarColumn(),
            progress.TextColumn(f"{{task.completed:.0f}} of {{task.total:.0f}} {self._unit}"),
        )
        self._bar = progress.Progress(
            *columns, progress.TimeRemainingColumn(), console=Console(stderr=True), transient=True
        )
        self._task = self._bar.add_task("", total=self._total)
        self._bar.start()

    def __enter__(self) -> Progress:
        self._begin = clocks.monotonic()
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.stop()
