"""Programs of tf2_ros and tf2_tools by their own names and arguments: tf2_echo, tf2_monitor and view_frames."""

from __future__ import annotations

import contextlib
import math
import shutil
import subprocess
import sys
import time
from pathlib import Path

from robolink.cli.shared.output import say
from robolink.cli.tf import tree, watch
from robolink.exceptions import RobolinkError
from robolink.system import clocks
from robolink.utilities import remove_ros_args

ECHO_USAGE = "tf2_echo SOURCE_FRAME TARGET_FRAME [RATE]"
FRAMES_USAGE = "view_frames [--wait-time SECONDS] [-o NAME]"
DRAWN_WITHIN = 60.0
"""Timeout of Graphviz, in seconds."""


class UsageError(RobolinkError, ValueError):
    """Arguments that a program does not take."""


def tf2_echo() -> None:
    """Show where a frame is in another, again and again: `tf2_echo SOURCE_FRAME TARGET_FRAME [RATE]`."""
    words = remove_ros_args(sys.argv)[1:]
    if len(words) not in (2, 3):
        raise UsageError(f"expected two frames and perhaps a rate, got {len(words)} words: {ECHO_USAGE}")
    rate = _number("RATE", words[2]) if len(words) == 3 else 1.0
    with contextlib.suppress(BrokenPipeError):  # `| head` has enough: no error of this program
        watch.echo(words[0], words[1], watch.Request(rate))


def tf2_monitor() -> None:
    """Show who publishes transforms, how often and how late: `tf2_monitor [SOURCE_FRAME TARGET_FRAME]`."""
    words = remove_ros_args(sys.argv)[1:]
    if len(words) not in (0, 2):
        raise UsageError(
            f"expected two frames or none, got {len(words)} words: tf2_monitor [SOURCE_FRAME TARGET_FRAME]"
        )
    source, target = words or ("", "")
    with contextlib.suppress(BrokenPipeError):
        watch.monitor(source, target, 10.0, json=False)


def view_frames() -> None:
    """Write the tree of frames as a graph, and as a PDF where Graphviz is: `view_frames [--wait-time S] [-o NAME]`."""
    wait, name = _frames_arguments(remove_ros_args(sys.argv)[1:])
    say(f"Listening to tf data for {wait:g} seconds...")
    graph = Path(f"{name}.gv")
    links = list(tree.listened(wait).links.values())
    graph.write_text(tree.graph(links, clocks.now()) + "\n", encoding="utf-8")
    program = shutil.which("dot")
    if program is None:
        say(f"{graph} has the graph; a PDF needs Graphviz: dot -Tpdf {graph} -o {name}.pdf")
        return
    command = [program, "-Tpdf", str(graph), "-o", f"{name}.pdf"]
    subprocess.run(command, check=True, timeout=DRAWN_WITHIN)
    say(f"{name}.pdf and {graph} have the graph")


def _frames_arguments(words: list[str]) -> tuple[float, str]:
    wait, name = 5.0, f"frames_{time.strftime('%Y-%m-%d_%H.%M.%S')}"
    rest = iter(words)
    for each in rest:
        flag, _, given = each.partition("=")
        value = given or next(rest, "")
        if flag in ("--wait-time", "-t"):
            wait = _number(flag, value)
        elif flag in ("--output", "-o") and value:
            name = value.removesuffix(".pdf").removesuffix(".gv")
        else:
            raise UsageError(f"no such option: {each}; {FRAMES_USAGE}")
    return wait, name


def _number(what: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0.0 < value < 1e6:
        raise UsageError(f"{what}: expected a number above 0, got '{text}'")
    return value
