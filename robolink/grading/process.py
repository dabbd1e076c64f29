"""Child process for a student's program, as its parent sees it: output is bounded, and nothing of it is left.

Its answer is signed. The key comes over standard input before any code of a program runs: it guards against what a
program writes in a file, its own or a rival's; a program that looks through the memory of its own process finds it.
"""

from __future__ import annotations

import contextlib
import hashlib
import hmac
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import IO, NamedTuple

from robolink.grading import keeper
from robolink.grading.mistakes import Mistake, line_of
from robolink.supervisor.processes.guardian import marked, signal_group
from robolink.supervisor.processes.lifeline import Lifeline
from robolink.system import clocks, waits
from robolink.system.files import read_plain
from robolink.system.processes import own_command

MOST_PRINTED = 20_000
"""Most bytes of what a program prints that are stored."""

MARK = "ROBOLINK_APART"
"""Environment variable by which the processes are found that a program has started and left."""

SETTINGS = {
    "PYTHONHASHSEED": "0",
    "PYTHONIOENCODING": "utf-8",
    "PYTHONUNBUFFERED": "1",  # what it prints is not lost when it is killed
    "OPENBLAS_NUM_THREADS": "1",
}
"""Environment variables of each child."""

TEMPORARY = ("TMPDIR", "TEMP", "TMP")
"""Environment variables with the folder for temporary files: a child that is killed leaves some."""

TRACE = "trace.txt"
"""Name of the file, beside the answer, into which a child that stands still writes where it stands."""

STOP_WITHIN = 0.2
"""Period in seconds of the looks whether a process shall stop."""

LARGEST = 8 * 2**20
"""Most bytes of an answer: it comes from a process in which a student's program runs."""

KEY = 32
"""Bytes of a key."""
SIGNATURE = 32
"""Bytes of a signature, which is before what it signs."""

_KEEPER = [sys.executable, "-I", "-S", keeper.__file__] if sys.platform == "linux" else []
"""Words before the command line of a child."""

_PLACE = re.compile(r'^  File "(.*)", line (\d+) in ', re.MULTILINE)


class Ended(NamedTuple):
    """Outcome of a child process."""

    answer: bytes
    """Answer that it wrote; nothing if it wrote none, or somebody else did."""
    printed: str
    mistake: Mistake
    """Mistake that explains a missing answer."""


def run_apart(
    words: Sequence[str],
    file: Path,
    longest: float,
    *,
    stop: threading.Event | None = None,
    variables: Mapping[str, str] = MappingProxyType({}),
) -> Ended:
    """Run a command of robolink's in a process of its own; end it, and all that it has started.

    It works in a temporary folder, and has another one for its temporary files. The path of the file for its answer is
    the last word of its command line.

    Args:
        words: Words of the command line, after `robolink`.
        file: The student's file, for the line at which it stands still.
        longest: Seconds after which it is killed.
        stop: Event that ends the process before its time; None for none.
        variables: Environment variables of it, beside those of this process.
    """
    with tempfile.TemporaryDirectory(prefix="robolink-apart-", ignore_cleanup_errors=True) as scratch:
        answer, work, temporary = (Path(scratch, each) for each in ("answer.json", "work", "temporary"))
        work.mkdir()
        temporary.mkdir()
        command = [*own_command(), *words, str(answer)]
        environ = {**os.environ, **variables, **dict.fromkeys(TEMPORARY, str(temporary))}
        key = new_key()
        printed, in_time = _run(command, key, work, environ, longest, stop or threading.Event())
        return Ended(opened(_content(answer), key), printed, why_no_answer(answer.with_name(TRACE), file, in_time))


def _run(
    command: Sequence[str], key: bytes, work: Path, environ: Mapping[str, str], longest: float, stop: threading.Event
) -> tuple[str, bool]:
    """Run a process to its end, or kill it; return what it printed, and whether it ended by itself."""
    lifeline = Lifeline()
    printed: list[bytes] = []
    try:
        variables, options = lifeline.options()
        since = clocks.time_of_day()
        with subprocess.Popen(
            [*_KEEPER, *command],
            cwd=work,
            env={**environ, **SETTINGS, **variables, MARK: f"apart:{lifeline.mark}"},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            **options,
        ) as process:
            assert process.stdout is not None
            reader = threading.Thread(target=_keep, args=(process.stdout, printed), daemon=True)
            try:
                reader.start()
                _hand_over(key, process)
                in_time = _wait(process, longest, stop)
            finally:
                _kill(process, lifeline.mark, since)
                waits.join(reader, 1.0)
    finally:
        lifeline.close()
    return b"".join(printed)[:MOST_PRINTED].decode("utf-8", errors="replace"), in_time


def _hand_over(key: bytes, process: subprocess.Popen[bytes]) -> None:
    assert process.stdin is not None
    with contextlib.suppress(OSError):  # it has ended already
        process.stdin.write(key)
        process.stdin.close()


def _wait(process: subprocess.Popen[bytes], longest: float, stop: threading.Event) -> bool:
    """Wait until a process ends; return False if it has to be ended."""
    deadline = clocks.monotonic() + longest
    while not stop.is_set() and clocks.monotonic() < deadline:
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(STOP_WITHIN)
            return True
    return False


def _keep(stream: IO[bytes], printed: list[bytes]) -> None:
    """Read a stream to its end, and keep its beginning."""
    left = MOST_PRINTED
    with contextlib.suppress(OSError, ValueError):
        while part := os.read(stream.fileno(), 65536):
            if left > 0:
                printed.append(part[:left])
                left -= len(part)


def _kill(process: subprocess.Popen[bytes], mark: str, since: float) -> None:
    """End a process and all that it has started, in other sessions too where the system can tell (Linux)."""
    if sys.platform == "linux":
        with contextlib.suppress(OSError, subprocess.TimeoutExpired):
            process.terminate()  # it is the keeper, which knows them all
            process.wait(keeper.PATIENCE + 1.0)
    else:
        kill_descendants(process.pid, since)
    if sys.platform == "win32":
        with contextlib.suppress(OSError):
            process.kill()
        return
    signal_group(process.pid, signal.SIGKILL)
    for group in marked(mark):
        signal_group(group, signal.SIGKILL)


def kill_descendants(pid: int, since: float) -> None:
    """End what a process has started, and what that has started in turn: else it would keep the output open.

    On Windows these are found as well when the process has ended: who is left keeps the number of its parent.

    Args:
        pid: Number of the process.
        since: Time of day, in seconds, at which it began: what is older had a parent that had this number before.
    """
    import psutil

    parents: dict[int, list[psutil.Process]] = {}
    for each in psutil.process_iter(["ppid", "create_time"]):
        if (each.info["create_time"] or 0.0) >= since:
            parents.setdefault(each.info["ppid"], []).append(each)
    found = list(parents.get(pid, ()))
    for each in found:  # it grows meanwhile
        found += (child for child in parents.get(each.pid, ()) if child not in found)
    for each in found:
        with contextlib.suppress(psutil.Error, OSError):
            each.kill()


def _content(path: Path) -> bytes:
    """Return the bytes of a file that the child wrote; none if it wrote none."""
    try:
        return read_plain(path, LARGEST)  # the program may have put a FIFO there
    except OSError:
        return b""


def why_no_answer(trace: Path, file: Path, in_time: bool) -> Mistake:
    """Return why a process wrote no answer: it stood still, and no other thread of it could run, or it died.

    Args:
        trace: File with the trace of a process that stood still.
        file: The student's file.
        in_time: Whether it ended by itself.
    """
    text = _content(trace).decode("ascii", errors="replace")
    if not text:
        return Mistake("ended all" if in_time else "stuck somewhere")
    name = str(file).encode("ascii", "backslashreplace").decode()  # as faulthandler writes it
    line = next((int(found[2]) for found in _PLACE.finditer(text) if found[1] == name[: len(found[1])]), 0)
    return Mistake("stuck", "", line, line_of(file, line)) if line else Mistake("stuck somewhere")


def new_key() -> bytes:
    """Return a key for one child process."""
    return os.urandom(KEY)


def take_key() -> bytes:
    """Return the key that this process got over its standard input, which is empty from then on; b"" if it got none."""
    key = b""
    with contextlib.suppress(OSError, ValueError):
        while len(key) < KEY and (part := os.read(0, KEY - len(key))):
            key += part
        nothing = os.open(os.devnull, os.O_RDONLY)
        os.dup2(nothing, 0)
        os.close(nothing)
        sys.stdin = open(0, encoding="utf-8", closefd=False)  # noqa: SIM115 - as long as the process
    return key


def signed(answer: bytes, key: bytes) -> bytes:
    """Return an answer with its signature before it."""
    return hmac.digest(key, answer, hashlib.sha256) + answer


def opened(content: bytes, key: bytes) -> bytes:
    """Return the answer in what was written; b"" if another one than the key's holder has written it."""
    signature, answer = content[:SIGNATURE], content[SIGNATURE:]
    return answer if hmac.compare_digest(signature, hmac.digest(key, answer, hashlib.sha256)) else b""
