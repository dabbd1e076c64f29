"""Parallel runs of a simulation with many seeds, a process each, so that a failure repeats when run alone."""

from __future__ import annotations

import os
import signal
import subprocess
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import suppress

import msgspec

from robolink.simulate.result import SimulationResult
from robolink.system import clocks
from robolink.system.processes import own_command
from robolink.system.waits import A_WHILE

INTERRUPTED = (130, -signal.SIGINT, 0xC000013A)
"""Exit codes of a process that Ctrl-C has ended; the last is that of Windows for one that had not begun."""

PATIENCE = 1.0
"""Real seconds that processes have to end after Ctrl-C, before they are killed."""


class SeedRun(msgspec.Struct, frozen=True):
    """Outcome of one seed: its result, or the error that kept it from having one."""

    seed: int
    result: SimulationResult | None = None
    error: str = ""
    interrupted: bool = False
    """True if Ctrl-C reached its process, too."""

    @property
    def failures(self) -> list[str]:
        """Reasons why it counts as failed; none if it does not."""
        return [self.error] if self.result is None else self.result.failures


def run_seeds(
    words: Callable[[int], Sequence[str]],
    seeds: Iterable[int],
    *,
    workers: int,
    on_done: Callable[[SeedRun], object] = lambda run: None,
) -> list[SeedRun]:
    """Run `robolink WORDS`, which print a result in JSON last, for each seed.

    Ctrl-C ends this early, with the outcomes until then; no process is left.

    Args:
        words: Returns the words of the command line for a seed.
        seeds: Seeds to be run.
        workers: Number of processes that run at a time.
        on_done: Called with each outcome as its process ends.

    Returns:
        The outcomes in the order of the seeds.
    """
    running = _Running()
    started: list[Future[SeedRun]] = []
    runs: dict[Future[SeedRun], SeedRun] = {}
    with ThreadPoolExecutor(max_workers=workers) as pool:
        try:
            started += [pool.submit(running.run, seed, [*own_command(), *words(seed)]) for seed in seeds]
            for each in _as_completed(started):
                if not (run := each.result()).interrupted:
                    runs[each] = run
                    on_done(run)
        except BaseException as error:
            running.end()
            pool.shutdown(wait=True, cancel_futures=True)
            if not isinstance(error, KeyboardInterrupt):
                raise
    return [runs[each] for each in started if each in runs]


def _as_completed(started: Sequence[Future[SeedRun]]) -> Iterator[Future[SeedRun]]:
    """Yield the futures as they complete; in waits that a Ctrl-C can come between."""
    left = set(started)
    while left:
        done, left = wait(left, A_WHILE, FIRST_COMPLETED)
        yield from done


class _Running:
    """Set of running processes, so that none is left."""

    def __init__(self) -> None:
        self._processes: set[subprocess.Popen[bytes]] = set()
        self._lock = threading.Lock()
        self._ended = False

    def run(self, seed: int, command: Sequence[str]) -> SeedRun:
        with self._lock:
            if self._ended:
                return SeedRun(seed, error="not run")
            process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                env={"PYTHONHASHSEED": "0", **os.environ},  # each run of the same seeds is the same, also with sets
            )
            self._processes.add(process)
        out, err = process.communicate()
        with self._lock:
            self._processes.discard(process)
        return _outcome(seed, process.returncode, out, err)

    def end(self) -> None:
        """Start no more, and kill all that run after PATIENCE: a Ctrl-C that reached them too ends them in order."""
        with self._lock:
            self._ended = True
            running = list(self._processes)
        deadline = clocks.monotonic() + PATIENCE
        for each in running:
            with suppress(subprocess.TimeoutExpired):
                each.wait(max(0.0, deadline - clocks.monotonic()))
            each.kill()


def _outcome(seed: int, code: int, out: bytes, err: bytes) -> SeedRun:
    if code in INTERRUPTED:
        return SeedRun(seed, error="interrupted", interrupted=True)
    lines = out.splitlines()
    try:
        return SeedRun(seed, msgspec.json.decode(lines[-1] if lines else b"", type=SimulationResult))
    except msgspec.DecodeError:
        message = err.decode(errors="replace").strip().rpartition("\n")[2]
        return SeedRun(seed, error=message or f"its process ended with exit code {code}")
