"""Run of `robolink bag play`: a node with rosbag2's services, keys, a progress line, and an end in order."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from robolink.bag.background_spin import BackgroundSpin
from robolink.bag.playing import PlaySettings
from robolink.bag.playing.services import ServedPlayer
from robolink.cli.bag.progress_line import ProgressLine
from robolink.cli.shared.output import tell
from robolink.cli.shared.session import opened
from robolink.cli.shared.terminal import keys
from robolink.exceptions import ExternalShutdownException
from robolink.logging import LoggingSeverity
from robolink.node import Node
from robolink.system import clocks

if TYPE_CHECKING:
    from robolink.context import Context

LOOK = 0.2
"""Time in seconds from one look for keys to the next."""

STEP = 0.1
"""Part of the rate by which a key changes it."""


class Request(NamedTuple):
    """Options of `bag play`, besides those of the player."""

    node_name: str = "rosbag2_player"
    log_level: str = "info"
    keys: bool = True
    progress_rate: float = 3.0
    """Progress lines in a second; 0 is one for each look, below 0 none."""
    remappings: Sequence[str] = ()
    enclave: str = ""


def run(paths: Sequence[str], settings: PlaySettings, request: Request) -> int:
    """Play until the end of the bags, Ctrl-C, SIGTERM or the service `~/stop`; return the exit code.

    Raises BagError and PlayError (ValueErrors) for bags that cannot be played.
    """
    with opened(request.enclave) as context, ProgressLine() as line:
        command = _Command(context, paths, settings, request)
        try:
            command.run(line)
        except (KeyboardInterrupt, ExternalShutdownException):  # a usual end: Ctrl-C, or SIGTERM
            pass
        finally:
            line.clear()
            command.end()
        return 0


class _Command:
    """One run of the command."""

    def __init__(self, context: Context, paths: Sequence[str], settings: PlaySettings, request: Request) -> None:
        arguments = [word for each in request.remappings for word in ("-r", each)]
        self._context, self._request = context, request
        self._node = Node(
            request.node_name,
            context=context,
            cli_args=["--ros-args", *arguments] if arguments else None,
            start_parameter_services=False,
        )
        self._logger = self._node.get_logger()
        self._logger.set_level(LoggingSeverity[request.log_level.upper()])
        self._served = ServedPlayer(self._node, paths, settings)
        self._player, self._playback = self._served.player, self._served.playback
        self._reported = 0

    def run(self, line: ProgressLine) -> None:
        """Play until something ends it."""
        steered = keys() if self._request.keys else contextlib.nullcontext(self._waited)
        with BackgroundSpin(self._node), steered as read:
            self._greet()
            self._served.start()
            shown_at = -1e9
            while not self._player.ended.is_set() and self._context.ok():
                self._obey(read(LOOK))
                rate = self._request.progress_rate
                if rate >= 0 and (not rate or clocks.monotonic() - shown_at >= 1 / rate):
                    shown_at = clocks.monotonic()
                    line.show(self._progress())
                self._tell_problems()

    def end(self) -> None:
        """Close the bags."""
        self._served.close()
        self._tell_problems()

    def _waited(self, seconds: float) -> str:
        self._player.wait(seconds)
        return ""

    def _greet(self) -> None:
        self._logger.info(f"Set rate to {self._playback.rate:g}")
        if self._request.keys:
            for key, action in (
                ("SPACE", "Pause/Resume"),
                ("CURSOR_RIGHT", "Play Next Message"),
                ("CURSOR_UP", "Increase Rate 10%"),
                ("CURSOR_DOWN", "Decrease Rate 10%"),
            ):
                self._logger.info(f"Press {key} for {action}")

    def _obey(self, key: str) -> None:
        playback = self._playback
        if key == " ":
            playback.toggle_paused()
            self._logger.info("Pausing play." if playback.is_paused else "Resuming play.")
        elif key in ("right", "s"):
            if not playback.is_paused:
                self._logger.warning("Called play next, but not in paused state.")
            else:
                playback.play_next()
        elif key in ("up", "down"):
            playback.set_rate(playback.rate * (1 + STEP if key == "up" else 1 - STEP))
            self._logger.info(f"Set rate to {playback.rate:g}")

    def _progress(self) -> str:
        """Return the progress line, in rosbag2's words."""
        playback = self._playback
        state = "Paused" if playback.is_paused else "Delayed" if playback.is_waiting else "Running"
        done = max(0, playback.time - playback.start_time) / 1e9
        total = (playback.last_time - playback.start_time) / 1e9
        return (
            f"Playback Progress: Bag Time {playback.time / 1e9:.6f}  Duration {done:.2f}/{total:.2f}"
            f"  Rate {playback.rate:g}  [{state}]"
        )

    def _tell_problems(self) -> None:
        """Write the files that could not be read, each once."""
        problems = self._player.problems
        for each in problems[self._reported :]:
            tell(each)
        self._reported = len(problems)
