"""A recording that goes on in a terminal: its keys, its lines and its figures."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.bag.background_spin import BackgroundSpin
from robolink.bag.information import size_text
from robolink.bag.recording import Figures, Recording, RecordSettings
from robolink.bag.recording.services import ServedRecording
from robolink.bag.selection import Selection
from robolink.cli.bag.progress_line import ProgressLine
from robolink.cli.shared.output import complain, say, say_json
from robolink.cli.shared.session import opened
from robolink.cli.shared.terminal import keys
from robolink.exceptions import ExternalShutdownException
from robolink.logging import LoggingSeverity
from robolink.node import Node
from robolink.system import clocks

if TYPE_CHECKING:
    from robolink.context import Context


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
    """Return the numbers of dropped and lost messages, in short; '' for none."""
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


LOOK = 0.2
"""Time in seconds from one look at what has ended the recording to the next."""

SHOW = 0.5
"""Time in seconds from one progress line to the next."""


class Request(NamedTuple):
    """Options of `bag record`, besides those of the recording."""

    node_name: str = "rosbag2_recorder"
    log_level: str = "info"
    keys: bool = True
    json: bool = False
    enclave: str = ""


def run(path: str | Path, selection: Selection, settings: RecordSettings, request: Request) -> int:
    """Record until Ctrl-C, SIGTERM, or until the bag can no longer be written; return the code.

    After the service `~/stop` it waits for `~/record`.

    Raises BagError (a ValueError) if the bag cannot be made, SelectionError if nothing is selected.
    """
    with opened(request.enclave) as context, ProgressLine() as line:
        command = _Command(context, path, selection, settings, request)
        try:
            command.run(line)
        except (KeyboardInterrupt, ExternalShutdownException):  # the usual end: Ctrl-C, or SIGTERM
            pass
        finally:
            command.end(line)
        return command.reported()


class _Command:
    """One run of the command."""

    def __init__(
        self, context: Context, path: str | Path, selection: Selection, settings: RecordSettings, request: Request
    ) -> None:
        self._context, self._request, self._settings = context, request, settings
        self._node = Node(request.node_name, context=context, start_parameter_services=False)
        self._logger = self._node.get_logger()
        self._logger.set_level(LoggingSeverity[request.log_level.upper()])
        self._served = ServedRecording(self._node, path, selection, settings)
        self._has_said: Recording | None = None
        """The last recording of which the summary was printed."""

    def run(self, line: ProgressLine) -> None:
        """Record until something ends it."""
        steered = keys() if self._request.keys else contextlib.nullcontext(_wait)
        with BackgroundSpin(self._node), steered as read:
            self._served.start()
            self._greet()
            shown, before, shown_at = self._served.recording, self._served.recording.figures(), 0.0
            while not self._is_over():
                self._obey(read(LOOK))
                recording = self._served.recording
                if not recording.is_running:
                    line.clear()
                    if not self._is_over():  # else the bag is still to be closed
                        self._tell(recording)
                elif clocks.monotonic() - shown_at >= SHOW:
                    shown_at, now = clocks.monotonic(), recording.figures()
                    line.show(progress(now, before if recording is shown else now))
                    shown, before = recording, now

    def end(self, line: ProgressLine) -> None:
        """Close the bag."""
        line.clear()
        recording = self._served.recording
        if recording.has_started and recording is not self._has_said:
            recording.stop()
            self._logger.info("Recording stopped")

    def reported(self) -> int:
        """Print how it went, and return the exit code."""
        self._tell(self._served.recording)
        error = self._served.recording.figures().error
        return complain(f"the recording has ended: {error}") if error else 0

    def _tell(self, recording: Recording) -> None:
        """Print, once, how a recording went that has ended."""
        if recording is self._has_said:
            return
        self._has_said, figures = recording, recording.figures()
        if self._request.json:
            say_json(as_data(figures))
        else:
            for each in summary(figures):
                say(each)

    def _is_over(self) -> bool:
        return not self._context.ok() or self._served.is_over

    def _greet(self) -> None:
        if self._request.keys:
            self._logger.info("Press SPACE for pausing/resuming")
        if not self._settings.use_sim_time:
            self._logger.info("Listening for topics...")
        if self._settings.start_paused:
            self._logger.info("Wait for recording: Press SPACE to start.")
        elif not (self._settings.snapshot_mode or self._settings.use_sim_time):
            self._logger.info("Recording...")

    def _obey(self, key: str) -> None:
        if key == " ":
            self._served.toggle_paused()
        elif key == "s" and self._settings.snapshot_mode and self._served.recording.is_running:
            taken = self._served.recording.snapshot()
            self._logger.info("Snapshot written" if taken else "There is nothing to write yet")


def _wait(seconds: float) -> str:
    time.sleep(seconds)
    return ""
