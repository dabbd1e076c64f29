"""Transcripts: what a program prints on both streams and how it ends, without what differs from run to run."""

from __future__ import annotations

import contextlib
import os
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

LIMIT = 60.0
"""The seconds that a program may take; the slowest takes eight on a machine of its own."""
FLOOD = 500_000
"""The bytes that a program may write on each stream; the longest transcript has 70,000."""

_OTHERS_SETTINGS = ("ROS_", "ROBOLINK_", "ZENOH_", "RCUTILS_", "RMW_", "FASTDDS_", "FASTRTPS_", "PYTHON", "COVERAGE_")

_MASKS = [
    # What only one of the two says, on account of how it is built.
    (r"\x1b\[.*DATAWRITER.*\n", ""),
    (r"\n?\n>>> \[rcutils\|error_handling(?s:.*?)\n<<<\n", "\n"),
    (r"Exception ignored in: <function Executor.__del__.*\nTraceback.*\nAttributeError.*\n", ""),
    # What the C library logs beside the error that it raises.
    (r"\[ERROR\] \[[\d.]+\] \[rcl\]: Failed to parse global arguments\n", ""),
    (r"\[WARN\] \[[\d.]+\] \[rcl\]: (?:Namespace|Node name) not remapped .*\n", ""),
    (r"\[WARN\] \[[\d.]+\] \[rcl_lifecycle\]: No transition matching .*\n", ""),
    # What an EventsExecutor logs beside the exception that it raises: the frames, as of a traceback.
    (r"(\[WARN\] .*: Error occurred at:\n)(?:  .*\n)*\n?", r"\1"),
    # Where a warning points to: the caller, or a line of the library.
    (r"(?m)^\S+?:\d+: (\w+Warning): .*\n(?:(?:\t- |Use the Single).*\n)*(?:  .*\n)?", r"<\1>\n"),
    (r"robolink\.spinning\.", "rclpy."),
    (r"(<|<class ')robolink\.", r"\1rclpy."),
    (r"/\S+/site-packages/(robolink|rclpy)/(\S+):\d+:", r"rclpy/\2:"),
    (r"RuntimeWarning: Enable tracemalloc .*\n", ""),
    # Times, addresses, numbers of processes and random names.
    (r"\b\d{10}\.\d{6,9}\b", "<time>"),
    (r"\b1[6-9]\d{17}\b", "<ns>"),
    (r"0x[0-9a-f]{6,}", "0x<addr>"),
    (r"Goal ID: \[[\d ]+\]", "Goal ID: <id>"),
    (r"\bgoal [0-9a-f]{32}\b", "goal <id>"),
    (r"GID: (?:[0-9a-f]{2}\.?){16}", "GID: <gid>"),
    (r"\b\d+(?=_\d{13,}\.log)", "<pid>"),
    (r"\x1b", "<esc>"),
]


@dataclass(frozen=True)
class Header:
    """The first lines of a program, which say how it is run: ``# args: ...``, ``# env: A=B``, ``# signal: INT 0.4``.

    Signals go to the program so many seconds after it printed ``READY``.
    """

    args: list[str] = field(default_factory=list)
    env: dict[str, str] = field(default_factory=dict)
    signals: list[tuple[str, float]] = field(default_factory=list)


def header(program: Path) -> Header:
    found = Header()
    for line in program.read_text(encoding="utf-8").splitlines():
        key, colon, rest = line.removeprefix("# ").partition(": ")
        if not line.startswith("# ") or not colon:
            break
        words = shlex.split(rest.replace("$HERE", str(program.parent)))
        if key == "args":
            found.args.extend(words)
        elif key == "env":
            found.env.update(dict(word.split("=", 1) for word in words))
        elif key == "signal":
            found.signals.append((words[0], float(words[1])))
    return found


def transcript(program: Path, command: Sequence[str], domain: int, *, limit: float = LIMIT) -> str:
    """Run a program in its own folder and return what it printed: streams, exit code, one below the other.

    It ends in ``--- exit hangs`` if it was killed at the limit, and in ``--- exit floods`` if it wrote too much.
    """
    head = header(program)
    folders = {"ROS_LOG_DIR": str(program.parent / "log"), "PYTHONPATH": str(program.parent)}
    # Files rather than pipes: nobody has to read while it runs, and a child that outlives it keeps nobody waiting.
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        process = subprocess.Popen(
            [*command, str(program), *head.args],
            env=environment(domain) | folders | head.env,
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=err,
            cwd=program.parent,
            start_new_session=True,
        )
        try:
            end = _watch(process, (out, err), head.signals, limit)
        finally:
            _kill(process)  # and what it started
        most = 1000 if end == "floods" else FLOOD
        printed, told = (_written(stream, most) for stream in (out, err))
    return _clean(f"--- stdout\n{printed}--- stderr\n{_without_tracebacks(told)}--- exit {end}\n", program.parent)


def _watch(
    process: subprocess.Popen[bytes], streams: Sequence[IO[bytes]], signals: list[tuple[str, float]], limit: float
) -> str:
    """Wait until a program ends, has had its time or has written too much; send it its signals meanwhile."""
    waiting, ready = list(signals), None
    end = time.monotonic() + limit
    while process.poll() is None:
        now = time.monotonic()
        if now > end:
            return "hangs"
        if any(os.fstat(stream.fileno()).st_size > FLOOD for stream in streams):
            return "floods"
        if waiting and ready is None and _is_ready(streams[0]):
            ready = now
        if waiting and ready is not None and now >= ready + waiting[0][1]:
            process.send_signal(signal.Signals[f"SIG{waiting.pop(0)[0]}"])
        time.sleep(0.01)
    return str(process.returncode)


def _is_ready(stream: IO[bytes]) -> bool:
    """True if a program has said so; the file's own position, at which the program writes, stays."""
    return sys.platform != "win32" and b"READY\n" in os.pread(stream.fileno(), FLOOD, 0)


def _written(stream: IO[bytes], most: int) -> str:
    stream.seek(0)
    text = stream.read(most).decode(errors="replace")
    return text if not text or text.endswith("\n") else text + "\n"


def environment(domain: int = 0) -> dict[str, str]:
    """Return this process's environment without settings of ROS 2, Python and robolink, on loopback and a domain."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(_OTHERS_SETTINGS)}
    return kept | {
        "ROS_DOMAIN_ID": str(domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "PYTHONDONTWRITEBYTECODE": "1",
        "PYTHONUNBUFFERED": "1",
    }


def _kill(process: subprocess.Popen[bytes]) -> None:
    if sys.platform == "win32":
        process.kill()
    else:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def _without_tracebacks(text: str) -> str:
    """Each traceback as its first line and its last: the frames between are the libraries' own."""
    lines, inside = [], False
    for line in text.splitlines():
        if line.startswith("Traceback (most recent call last)"):
            inside = True
            lines.append("Traceback ...")
        elif not inside or (line.strip() and not line[0].isspace()):
            inside = False
            lines.append(re.sub(r'  File "[^"]*", line \d+', "  File", line))
    return "".join(line + "\n" for line in lines)


def _clean(text: str, folder: Path) -> str:
    text = text.replace(str(folder), "<here>")
    for pattern, mask in _MASKS:
        text = re.sub(pattern, mask, text)
    return text
